// Textbook tests of two triangles, written from the papers. Many programs use these tests, so they
// are the baseline of the study. T is float or double: each test rounds its input to T and computes
// in T.
//   T. Moeller: A Fast Triangle-Triangle Intersection Test. Journal of Graphics Tools 2(2), 1997.
//   P. Guigue, O. Devillers: Fast and Robust Triangle-Triangle Overlap Test Using Orientation
//   Predicates. Journal of Graphics Tools 8(1), 2003.
//   T. Moeller, B. Trumbore: Fast, Minimum Storage Ray/Triangle Intersection. JGT 2(1), 1997.
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

template <class T>
using Point = std::array<T, 3>;
template <class T>
using Corners = std::array<Point<T>, 3>;
template <class T>
using Flat = std::array<std::array<T, 2>, 3>;  // corners of a triangle in the plane

template <class T>
Point<T> operator-(const Point<T>& a, const Point<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class T>
Point<T> cross(const Point<T>& a, const Point<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class T>
T dot(const Point<T>& a, const Point<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Corners<T> rounded_to(const std::array<Vec3, 3>& triangle) {
  Corners<T> out;
  for (int i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) out[i][axis] = static_cast<T>(triangle[i][axis]);
  }
  return out;
}

template <class T>
int longest_axis(const Point<T>& v) {
  const T x = std::abs(v[0]), y = std::abs(v[1]), z = std::abs(v[2]);
  return x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
}

template <class T>
T orientation(const std::array<T, 2>& a, const std::array<T, 2>& b, const std::array<T, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// True if all of b lies strictly outside one edge of a.
template <class T>
bool separated_by_edge(const Flat<T>& a, const Flat<T>& b) {
  for (int i = 0; i < 3; ++i) {
    const auto &p = a[i], &q = a[(i + 1) % 3], &inside = a[(i + 2) % 3];
    const T own = orientation(p, q, inside);
    const auto beyond = [&](const std::array<T, 2>& point) {
      const T side = orientation(p, q, point);
      return own > 0 ? side < 0 : side > 0;
    };
    if (own != 0 && std::all_of(b.begin(), b.end(), beyond)) return true;
  }
  return false;
}

/// True if two coplanar triangles overlap. n: normal of their plane. Projects along n's main axis.
template <class T>
bool coplanar_overlap(const Point<T>& n, const Corners<T>& a, const Corners<T>& b) {
  const int drop = longest_axis(n);
  const auto flat = [drop](const Corners<T>& corners) {
    Flat<T> out;
    for (int i = 0; i < 3; ++i) out[i] = {corners[i][(drop + 1) % 3], corners[i][(drop + 2) % 3]};
    return out;
  };
  const Flat<T> first = flat(a), second = flat(b);
  return !separated_by_edge(first, second) && !separated_by_edge(second, first);
}

/// Returns signed distances of points from the plane of `of`, times |n|. n: normal of the plane.
template <class T>
std::array<T, 3> distances(const Point<T>& n, const Corners<T>& of, const Corners<T>& points) {
  const T d = -dot(n, of[0]);
  return {dot(n, points[0]) + d, dot(n, points[1]) + d, dot(n, points[2]) + d};
}

/// Returns the interval in which a triangle meets the line common to its plane and another plane.
/// p: coordinates of the corners along the line. d: signed distances of the corners from the other
/// plane. Precondition: d has a zero or both signs, and d is not (0, 0, 0).
template <class T>
std::array<T, 2> interval(const std::array<T, 3>& p, const std::array<T, 3>& d) {
  // Finds the corner that is alone on its side of the other plane.
  int alone = 0;
  if (d[0] * d[1] > 0) {
    alone = 2;
  } else if (d[0] * d[2] > 0) {
    alone = 1;
  } else if (d[1] * d[2] > 0 || d[0] != 0) {
    alone = 0;
  } else {
    alone = d[1] != 0 ? 1 : 2;
  }
  const int q = (alone + 1) % 3, r = (alone + 2) % 3;
  const T a = p[alone] + (p[q] - p[alone]) * d[alone] / (d[alone] - d[q]);
  const T b = p[alone] + (p[r] - p[alone]) * d[alone] / (d[alone] - d[r]);
  return {std::min(a, b), std::max(a, b)};
}

template <class T>
bool one_strict_sign(const std::array<T, 3>& d) {
  return (d[0] > 0 && d[1] > 0 && d[2] > 0) || (d[0] < 0 && d[1] < 0 && d[2] < 0);
}
template <class T>
bool all_zero(const std::array<T, 3>& d) {
  return d[0] == 0 && d[1] == 0 && d[2] == 0;
}

/// The test of Moeller 1997. Distances below epsilon count as 0, so that nearly coplanar triangles
/// are treated as coplanar.
template <class T>
bool moeller(const SuitePair& pair, T epsilon) {
  const Corners<T> a = rounded_to<T>(pair.a), b = rounded_to<T>(pair.b);
  const auto snapped = [epsilon](std::array<T, 3> d) {
    for (T& x : d) {
      if (std::abs(x) < epsilon) x = 0;
    }
    return d;
  };
  const Point<T> n1 = cross(a[1] - a[0], a[2] - a[0]), n2 = cross(b[1] - b[0], b[2] - b[0]);
  const std::array<T, 3> db = snapped(distances(n1, a, b));
  if (one_strict_sign(db)) return false;
  const std::array<T, 3> da = snapped(distances(n2, b, a));
  if (one_strict_sign(da)) return false;
  if (all_zero(da) || all_zero(db)) return coplanar_overlap(n1, a, b);
  // Projects the common line of the two planes on the coordinate axis nearest to its direction.
  const int axis = longest_axis(cross(n1, n2));
  const std::array<T, 2> first = interval<T>({a[0][axis], a[1][axis], a[2][axis]}, da);
  const std::array<T, 2> second = interval<T>({b[0][axis], b[1][axis], b[2][axis]}, db);
  return !(first[1] < second[0] || second[1] < first[0]);
}

/// Returns a determinant. Its sign tells on which side of the plane (a, b, c) the point d lies.
template <class T>
T side(const Point<T>& a, const Point<T>& b, const Point<T>& c, const Point<T>& d) {
  return dot(cross(b - a, c - a), d - a);
}

/// The corner of a triangle that is alone on its side of the other triangle's plane. negative: true
/// if this side is the negative side. Special case: one corner is on the plane, and the two other
/// corners are on one side. Then `corner` is the corner on the plane, and `negative` is true if the
/// two other corners are on the positive side.
struct Alone {
  int corner = 0;
  bool negative = false;
};
template <class T>
Alone alone_of(const std::array<T, 3>& s) {
  for (int i = 0; i < 3; ++i) {
    const T q = s[(i + 1) % 3], r = s[(i + 2) % 3];
    if (s[i] > 0 && q <= 0 && r <= 0) return {i, false};
    if (s[i] < 0 && q >= 0 && r >= 0) return {i, true};
  }
  // One corner is on the plane, and the two other corners are on one side.
  for (int i = 0; i < 3; ++i) {
    if (s[i] == 0) return {i, s[(i + 1) % 3] > 0};
  }
  return {};
}

/// Returns the triangle with this corner first. The orientation stays the same.
template <class T>
Corners<T> begun_at(const Corners<T>& t, int corner) {
  return {t[corner], t[(corner + 1) % 3], t[(corner + 2) % 3]};
}

/// The test of Guigue and Devillers 2003.
template <class T>
bool guigue_devillers(const SuitePair& pair) {
  Corners<T> a = rounded_to<T>(pair.a), b = rounded_to<T>(pair.b);
  std::array<T, 3> of_a, of_b;
  for (int i = 0; i < 3; ++i) {
    of_a[i] = side(b[0], b[1], b[2], a[i]);
    of_b[i] = side(a[0], a[1], a[2], b[i]);
  }
  if (one_strict_sign(of_a) || one_strict_sign(of_b)) return false;
  if (all_zero(of_a) || all_zero(of_b))
    return coplanar_overlap(cross(a[1] - a[0], a[2] - a[0]), a, b);
  const Alone in_a = alone_of(of_a), in_b = alone_of(of_b);
  a = begun_at(a, in_a.corner);
  b = begun_at(b, in_b.corner);
  // Orients each triangle so that the other triangle's lone corner is on the positive side.
  if (in_a.negative) std::swap(b[1], b[2]);
  if (in_b.negative) std::swap(a[1], a[2]);
  // True if the intervals on the common line overlap.
  return side(a[0], a[1], b[0], b[1]) <= 0 && side(a[0], a[2], b[2], b[0]) <= 0;
}

/// True if a segment meets a triangle in a point, by Moeller and Trumbore. False if the segment is
/// parallel to the triangle.
template <class T>
bool edge_meets_face(const Point<T>& from, const Point<T>& to, const Corners<T>& face) {
  const Point<T> along = to - from, e1 = face[1] - face[0], e2 = face[2] - face[0];
  const Point<T> p = cross(along, e2);
  const T det = dot(e1, p);
  if (det == 0) return false;
  const Point<T> s = from - face[0];
  const T u = dot(s, p) / det;
  const Point<T> q = cross(s, e1);
  const T v = dot(along, q) / det, t = dot(e2, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

template <class T>
bool edges_against_faces(const SuitePair& pair) {
  const Corners<T> a = rounded_to<T>(pair.a), b = rounded_to<T>(pair.b);
  for (int i = 0; i < 3; ++i) {
    if (edge_meets_face(a[i], a[(i + 1) % 3], b) || edge_meets_face(b[i], b[(i + 1) % 3], a))
      return true;
  }
  return false;
}

Contestant contestant(const std::string& name, const char* paper, Means means,
                      std::function<bool(const SuitePair&)> pair) {
  return {.card = {.name = name, .library = paper, .means = means, .degenerate = false},
          .pair = std::move(pair)};
}

constexpr const char* kMoeller = "Moeller 1997";

template <class T>
void add_textbook(std::vector<Contestant>& all, const std::string& type) {
  all.push_back(contestant("moeller-" + type, kMoeller, Means::crossing,
                           [](const SuitePair& pair) { return moeller<T>(pair, T(1e-6)); }));
  all.push_back(contestant("guigue-devillers-" + type, "Guigue, Devillers 2003", Means::closed,
                           guigue_devillers<T>));
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  std::vector<Contestant> all;
  add_textbook<float>(all, "float");
  add_textbook<double>(all, "double");
  all.push_back(contestant("moeller-double-0", kMoeller, Means::crossing,
                           [](const SuitePair& pair) { return moeller<double>(pair, 0); }));
  all.push_back(contestant("edge-face-double", "each edge against the other face", Means::crossing,
                           edges_against_faces<double>));
  return contest(argc, argv, all);
}
