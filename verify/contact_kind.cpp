// Finds how two triangles meet if one of them is a segment or a point: cuts the segment or point by
// the half-spaces that bound the other triangle. All numbers are integers: a point has three
// numerators and one denominator. So nothing is rounded except the returned points. The functions
// that take lists of pairs are here, too.
#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "verify/closest_features.h"
#include "verify/contact_meeting.h"
#include "verify/exact.h"
#include "verify/squared_distance.h"

namespace farcull {
namespace {

using closest::cross;
using closest::dot;
using closest::minus;
using Corners = std::array<Vec3, 3>;
using Integers = std::array<mpz_class, 3>;

constexpr std::array<std::string_view, kContactKinds.size()> kNames = {
    "apart", "equal", "touch-vertex", "touch-edge", "coplanar", "crossing", "touch-face"};

/// The point x / w, times 2^Scaled::exponent. w > 0. The fractions need not be in lowest terms.
struct Point {
  Integers x;
  mpz_class w = 1;
};

/// Returns the sign of p - q in the lexicographic order.
int compare(const Point& p, const Point& q) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (const int sign = cmp(p.x[k] * q.w, q.x[k] * p.w); sign != 0) return sign;
  }
  return 0;
}

/// A plane (the points p with normal . p = offset) or a half-space (normal . p >= offset).
struct Bound {
  Integers normal;
  mpz_class offset;
  bool plane;

  Bound(const Integers& n, const Integers& at, bool is_plane)
      : normal(n), offset(dot(n, at)), plane(is_plane) {}
  /// Returns (normal . p - offset) times p.w.
  mpz_class value(const Point& p) const { return dot(normal, p.x) - offset * p.w; }
};

/// A triangle, segment or point: the hull of `corners` and the intersection of all `bounds`.
struct Hull {
  std::vector<Integers> corners;
  std::vector<Bound> bounds;

  Hull(const Corners& t, const Scaled::Corners& scaled) : corners(scaled.begin(), scaled.end()) {
    const Shape of = shape(t);
    std::sort(corners.begin(), corners.end());
    if (of == Shape::segment) corners = {corners.front(), corners.back()};
    if (of == Shape::point) corners.resize(1);
    const Integers first = minus(corners.back(), corners.front());
    if (of == Shape::triangle) {
      const Integers n = cross(minus(corners[1], corners[0]), first);
      bounds.emplace_back(n, corners[0], true);
      for (std::size_t i = 0; i < 3; ++i)
        bounds.emplace_back(cross(n, minus(corners[(i + 1) % 3], corners[i])), corners[i], false);
    } else if (of == Shape::segment) {
      // Let d be `first`, and e the unit vector along the axis after `axis`. Since d is not 0 along
      // `axis`, d x e is not 0. The vector d x (d x e) is perpendicular to d and to d x e.
      std::size_t axis = 0;
      while (sgn(first[axis]) == 0) ++axis;
      const Integers u = cross(first, unit((axis + 1) % 3));
      bounds.emplace_back(u, corners[0], true);
      bounds.emplace_back(cross(first, u), corners[0], true);
      bounds.emplace_back(first, corners[0], false);
      bounds.emplace_back(minus(corners[0], corners[1]), corners[1], false);
    } else {
      for (std::size_t axis = 0; axis < 3; ++axis)
        bounds.emplace_back(unit(axis), corners[0], true);
    }
  }

  bool is_corner(const Point& p) const {
    return std::ranges::any_of(corners, [&](const Integers& x) { return compare(p, {x}) == 0; });
  }
  /// True if p, a point of the hull, is on an edge. Every point of a segment is on an edge.
  bool on_edge(const Point& p) const {
    return corners.size() < 3 || std::ranges::any_of(bounds, [&](const Bound& bound) {
             return !bound.plane && sgn(bound.value(p)) == 0;
           });
  }

 private:
  static Integers unit(std::size_t axis) {
    Integers out;
    out[axis] = 1;
    return out;
  }
};

/// Cuts a segment to the part where sign * bound.value() >= 0. Returns false if nothing is left.
/// The new end is the sum of both old ends, each times |value()| of the other end. Since value() is
/// linear in (x, w), it is 0 at the new end.
bool cut(std::array<Point, 2>& ends, const Bound& bound, int sign) {
  const mpz_class first = sign * bound.value(ends[0]), last = sign * bound.value(ends[1]);
  if (first < 0 && last < 0) return false;
  if (first >= 0 && last >= 0) return true;
  Point& outside = ends[first < 0 ? 0 : 1];
  const Point& inside = ends[first < 0 ? 1 : 0];
  const mpz_class s = abs(first < 0 ? last : first), t = abs(first < 0 ? first : last);
  for (std::size_t k = 0; k < 3; ++k) outside.x[k] = s * outside.x[k] + t * inside.x[k];
  outside.w = s * outside.w + t * inside.w;
  return true;
}

/// Calls answer(corners of a, corners of b) for each pair, on several threads. Returns the answers.
template <class Answer>
auto answers(const Scene& scene, std::span<const TrianglePair> pairs, unsigned threads,
             const Answer& answer) {
  for (const TrianglePair& pair : pairs) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size())
      throw std::logic_error("contact kinds: a pair names a triangle that the scene lacks");
  }
  constexpr std::size_t kLeast = 64;  // fewer pairs are not worth a thread
  std::vector<decltype(answer(Corners(), Corners()))> out(pairs.size());
  for_chunks(pairs.size(), chunks_for(pairs.size(), kLeast, std::max(threads, 1u)),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i)
                 out[i] = answer(scene.corners(pairs[i].a), scene.corners(pairs[i].b));
             });
  return out;
}

}  // namespace

std::string_view name_of(ContactKind kind) { return kNames.at(static_cast<std::size_t>(kind)); }

std::optional<ContactKind> parse_contact_kind(std::string_view name) {
  const auto found = std::ranges::find(kContactKinds, name, name_of);
  return found == kContactKinds.end() ? std::nullopt : std::optional(*found);
}

ContactKind contact_kind(const Corners& a, const Corners& b) {
  const std::optional<Meeting> meeting = meeting_of(a, b, false);
  return meeting ? meeting->kind : contact_shape_of_segments(a, b).kind;
}

bool penetrate(const Corners& a, const Corners& b) {
  // Relative interiors of triangles in different planes meet iff the triangles have a common point
  // that is on no edge.
  return contact_kind(a, b) == ContactKind::crossing;
}

ContactCounts count_contacts(const Scene& scene, std::span<const TrianglePair> pairs,
                             unsigned threads) {
  if (std::ranges::any_of(pairs, [](const TrianglePair& pair) { return pair.a == pair.b; }))
    throw std::logic_error("count_contacts: a pair of one triangle");
  const std::vector<ContactKind> kinds = contact_kinds(scene, pairs, threads);
  const auto crossing =
      static_cast<std::uint64_t>(std::ranges::count(kinds, ContactKind::crossing));
  return {.touching = pairs.size() - crossing, .penetrating = crossing};
}

ContactShape contact_shape_of_segments(const Corners& a, const Corners& b) {
  if (shape(a) == Shape::triangle) return contact_shape_of_segments(b, a);
  const Scaled scaled(a, b);
  const Hull s(a, scaled.a), t(b, scaled.b);
  std::array<Point, 2> ends = {Point{s.corners.front()}, Point{s.corners.back()}};
  for (const Bound& bound : t.bounds) {
    if (!cut(ends, bound, 1) || (bound.plane && !cut(ends, bound, -1))) return {};
  }
  const int order = compare(ends[0], ends[1]);
  if (order > 0) std::swap(ends[0], ends[1]);
  ContactShape out{.kind = ContactKind::coplanar, .dimension = order == 0 ? 0 : 1};
  if (s.corners == t.corners) {
    out.kind = ContactKind::equal;
  } else if (order == 0 && (s.is_corner(ends[0]) || t.is_corner(ends[0]))) {
    out.kind = ContactKind::touch_vertex;
  } else if (order == 0) {
    out.kind = t.on_edge(ends[0]) ? ContactKind::touch_edge : ContactKind::crossing;
  }
  for (std::size_t i = 0; i < 2; ++i)
    out.ends[i] = rounded_point(ends[i].x, ends[i].w, scaled.exponent);
  return out;
}

std::vector<ContactKind> contact_kinds(const Scene& scene, std::span<const TrianglePair> pairs,
                                       unsigned threads) {
  return answers(scene, pairs, threads, contact_kind);
}

std::vector<ContactShape> contact_shapes(const Scene& scene, std::span<const TrianglePair> pairs,
                                         unsigned threads) {
  return answers(scene, pairs, threads, contact_shape);
}

}  // namespace farcull
