// Scales each pair of triangles to integers once. Uses the big integers of GMP, since the square of
// a distance usually has many digits.
#include "verify/certificate/integer_distance.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "verify/certificate/integer_pair.h"
#include "verify/certificate/integer_witnesses.h"

namespace farcull {

using namespace integer;

enum class IntegerSurface : std::uint8_t { open, closed, oriented };

namespace {

constexpr int kFeatures = 7, kFirstEdge = 3, kFace = 6;

/// Constructs the only points of feature `of_a` of `a` and feature `of_b` of `b` that can be
/// nearest points, if no earlier pair of features has nearest points. Returns false if there are no
/// such points.
bool construct(PointSearch& on_a, PointSearch& on_b, const BigCorners& a, const BigCorners& b,
               int of_a, int of_b) {
  if (of_a < kFirstEdge) {
    on_a.corner(a, of_a);
    if (of_b < kFirstEdge) return on_b.corner(b, of_b);
    if (of_b == kFace) return on_b.foot_on_plane(b, a[of_a]);
    return on_b.foot_on_edge(b, of_b - 3, a[of_a]);
  }
  if (of_a == kFace && of_b == kFace) return false;
  if (of_b < kFirstEdge || of_a == kFace) return construct(on_b, on_a, b, a, of_b, of_a);
  if (of_b == kFace)
    return on_a.edge_and_plane(a, of_a - 3, b) && on_b.edge_and_plane(a, of_a - 3, b);
  return on_a.edge_and_edge(a, of_a - 3, b, of_b - 3) &&
         on_b.edge_and_edge(b, of_b - 3, a, of_a - 3);
}

// is_within() counts the crossings of a mesh and a ray from a point. The ray has the direction of
// the first axis. The ray starts at the point moved by e along the second axis and by e^2 along the
// third axis, where e > 0 is infinitely small. So the ray meets no edge, and one ray is enough. The
// sign of a polynomial in e is the sign of its nonzero coefficient of lowest degree.

/// Returns on which side of the ray the edge from p to q passes: the sign of the first coordinate
/// of (p - o) x (q - o), o = (0, e, e^2). p and q are relative to the point. Returns 0 only if p
/// and q have the same second and the same third coordinate.
int side_of_edge(const BigVector& p, const BigVector& q) {
  const int sign = cmp(mpz_class(p[1] * q[2]), mpz_class(p[2] * q[1]));
  if (sign != 0) return sign;
  const int first = cmp(p[2], q[2]);
  return first != 0 ? first : cmp(q[1], p[1]);
}

mpz_class determinant(const std::array<BigVector, 3>& t) {
  BigVector product;
  mpz_class out;
  cross(product, t[1], t[2]);
  dot(out, t[0], product);
  return out;
}

/// Returns false if the box of the triangle lies beside the ray from x or behind x, so that the ray
/// cannot cross the box. The comparisons are exact.
bool may_cross(const std::array<Vec3, 3>& t, const Vec3& x) {
  const auto& [p, q, r] = t;
  if (std::max({p.x(), q.x(), r.x()}) < x.x()) return false;
  for (int k = 1; k < 3; ++k) {
    if (std::min({p[k], q[k], r[k]}) > x[k] || std::max({p[k], q[k], r[k]}) < x[k]) return false;
  }
  return true;
}

/// Returns whether x is inside the closed mesh; empty if x lies on a triangle that the ray crosses.
std::optional<bool> is_within(const Scene& scene, const Object& object, const Vec3& x,
                              IntegerSurface mesh) {
  std::int64_t winding = 0, count = 0;
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const std::array<Vec3, 3> t = scene.corners(object.first_triangle + k);
    if (!may_cross(t, x)) continue;
    const ScaledPair pair = scaled({x, x, x}, t);  // pair.b: t relative to x
    const int side = side_of_edge(pair.b[0], pair.b[1]);
    if (side == 0 || side_of_edge(pair.b[1], pair.b[2]) != side ||
        side_of_edge(pair.b[2], pair.b[0]) != side) {
      continue;  // the ray misses t
    }
    // The ray meets the plane of t at distance determinant / n_x from x. Here n is a normal of t,
    // and the sign of n_x is `side`.
    const int ahead = sgn(determinant(pair.b));
    if (ahead == 0) return std::nullopt;
    if (ahead != side) continue;
    winding += side;
    ++count;
  }
  return mesh == IntegerSurface::oriented ? winding != 0 : count % 2 != 0;
}

using Place = std::array<double, 3>;

IntegerSurface mesh_of(const Scene& scene, const Object& object) {
  std::vector<std::tuple<Place, Place, bool>> edges;  // lower end, upper end, true if upwards
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const std::array<Vec3, 3> t = scene.corners(object.first_triangle + k);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::array<Place, 3> at;
    for (std::size_t i = 0; i < 3; ++i)
      at[i] = {t[i].x() + 0.0, t[i].y() + 0.0, t[i].z() + 0.0};  // turns -0.0 into 0.0
    for (std::size_t i = 0; i < 3; ++i) {
      const Place &from = at[i], &to = at[(i + 1) % 3];
      edges.emplace_back(std::min(from, to), std::max(from, to), from < to);
    }
  }
  std::ranges::sort(edges);
  // Sorting brings edges with the same two ends together.
  bool oriented = true;
  for (std::size_t i = 0; i < edges.size();) {
    const auto [lower, upper, up] = edges[i];
    std::size_t count = 0, upwards = 0;
    for (; i < edges.size() && std::get<0>(edges[i]) == lower && std::get<1>(edges[i]) == upper;
         ++i) {
      ++count;
      upwards += std::get<2>(edges[i]) ? 1 : 0;
    }
    if (count % 2 != 0) return IntegerSurface::open;
    oriented = oriented && 2 * upwards == count;
  }
  return oriented ? IntegerSurface::oriented : IntegerSurface::closed;
}

/// Returns one corner of each connected part of the mesh. Two triangles are in one part if they
/// share a vertex index, directly or through a chain of triangles.
std::vector<Vec3> corner_of_each_part(const Scene& scene, const Object& object) {
  const auto first = scene.triangles.begin() + object.first_triangle;
  const auto last = first + object.triangle_count;
  std::uint32_t most = 0;
  for (auto t = first; t != last; ++t) most = std::max({most, (*t)[0], (*t)[1], (*t)[2]});
  std::vector<std::uint32_t> leader(std::size_t{most} + 1);
  std::iota(leader.begin(), leader.end(), 0u);
  const auto leader_of = [&](std::uint32_t v) {
    while (leader[v] != v) v = leader[v] = leader[leader[v]];
    return v;
  };
  for (auto t = first; t != last; ++t) {
    leader[leader_of((*t)[1])] = leader_of((*t)[0]);
    leader[leader_of((*t)[2])] = leader_of((*t)[0]);
  }
  std::vector<bool> met(leader.size());
  std::vector<Vec3> out;
  for (auto t = first; t != last; ++t) {
    const std::uint32_t of = leader_of((*t)[0]);
    if (met[of]) continue;
    met[of] = true;
    out.push_back(scene.vertices[of]);
  }
  return out;
}

}  // namespace

bool is_rounded(const Vec3& x, const FractionPoint& point) {
  for (int k = 0; k < 3; ++k) {
    mpq_class exact(point.over[static_cast<std::size_t>(k)], point.under);
    exact.canonicalize();
    if (point.exponent >= 0) {
      exact <<= static_cast<mp_bitcnt_t>(point.exponent);
    } else {
      exact >>= static_cast<mp_bitcnt_t>(-point.exponent);
    }
    exact += mpq_class(point.from[k]);
    if (std::isnan(x[k]) || (x[k] == 0 && std::signbit(x[k]))) return false;
    if (!is_nearest_double(x[k], [&](double next) {
          return cmp(exact, mpq_class((rational(x[k]) + rational(next)) / 2));
        }))
      return false;
  }
  return true;
}

IntegerDistance integer_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  thread_local PointSearch on_a, on_b;
  const ScaledPair pair = scaled(a, b);
  for (int of_a = 0; of_a < kFeatures; ++of_a) {
    for (int of_b = 0; of_b < kFeatures; ++of_b) {
      // The construction is not trusted: the points count only if they lie in the triangles and
      // scalar products prove that they are nearest.
      if (!construct(on_a, on_b, pair.a, pair.b, of_a, of_b) ||
          !on_a.is_nearest(on_b, pair.a, pair.b) || !on_a.lies_in(pair.a) || !on_b.lies_in(pair.b))
        continue;
      IntegerDistance out;
      on_a.squared_distance(on_b, out.squared.over, out.squared.under);
      if (pair.exponent > 0) out.squared.over <<= 2 * pair.exponent;
      if (pair.exponent < 0) out.squared.under <<= -2 * pair.exponent;
      out.features = {static_cast<std::uint8_t>(of_a), static_cast<std::uint8_t>(of_b)};
      out.points = {FractionPoint{on_a.point(), on_a.scale(), pair.exponent, a[0]},
                    FractionPoint{on_b.point(), on_b.scale(), pair.exponent, a[0]}};
      return out;
    }
  }
  throw std::logic_error("integer_distance: no two features hold nearest points");
}

bool is_beyond(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Length& length,
               bool or_as_far) {
  if (or_as_far && length.squared.over == 0) return true;
  thread_local Scratch<mpz_class> s;
  const ScaledPair pair = scaled(a, b);
  Fraction limit = length.squared;
  if (pair.exponent > 0) limit.under <<= 2 * pair.exponent;
  if (pair.exponent < 0) limit.over <<= -2 * pair.exponent;
  const auto shows = [&](int direction) {
    make_direction(s, pair.a, pair.b, direction);
    return has_gap(s, pair.a, pair.b) && gap_reaches(s, limit.over, limit.under, or_as_far);
  };
  const int likely = likely_direction(a, b, length.above);
  if (shows(likely)) return true;
  return std::ranges::any_of(kByDegree, [&](int d) { return d != likely && shows(d); });
}

struct IntegerInside::OfObject {
  Box box = Box::empty();
  std::once_flag closed_found, corners_found;
  IntegerSurface mesh = IntegerSurface::open;
  std::vector<Vec3> corners;  // one corner of each connected part
};

IntegerInside::IntegerInside(const Scene& scene)
    : scene_(scene), objects_(new OfObject[scene.objects.size()]) {
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      for (const Vec3& p : scene.corners(object.first_triangle + k)) objects_[o].box.add(p);
    }
  }
}
IntegerInside::~IntegerInside() = default;

IntegerInside::Answer IntegerInside::contains(std::uint32_t outer, std::uint32_t inner) const {
  OfObject &in = objects_[inner], &out = objects_[outer];
  // An object that is inside a closed mesh is inside the mesh's box.
  const Box &x_box = in.box, &y_box = out.box;
  if ((x_box.lo.array() < y_box.lo.array()).any() || (x_box.hi.array() > y_box.hi.array()).any())
    return Answer::no;
  std::call_once(out.closed_found, [&] { out.mesh = mesh_of(scene_, scene_.objects[outer]); });
  if (out.mesh == IntegerSurface::open) return Answer::not_closed;
  std::call_once(in.corners_found,
                 [&] { in.corners = corner_of_each_part(scene_, scene_.objects[inner]); });
  for (const Vec3& x : in.corners) {
    const std::optional<bool> within = is_within(scene_, scene_.objects[outer], x, out.mesh);
    if (!within) return Answer::on;
    if (!*within) return Answer::no;
  }
  return Answer::yes;
}

std::optional<InsideClaim> IntegerInside::which(std::uint32_t a, std::uint32_t b) const {
  if (std::max(a, b) >= scene_.objects.size() || a == b)
    throw std::logic_error("IntegerInside: no two objects of the scene");
  const Answer a_in_b = contains(b, a);
  if (a_in_b == Answer::yes) return InsideClaim::a;
  const Answer b_in_a = contains(a, b);
  if (b_in_a == Answer::yes) return InsideClaim::b;
  if (a_in_b == Answer::on || b_in_a == Answer::on) return std::nullopt;
  const bool open = a_in_b == Answer::not_closed || b_in_a == Answer::not_closed;
  return open ? InsideClaim::not_closed : InsideClaim::none;
}

}  // namespace farcull
