// The common points of two triangles: the half-spaces that bound one cut the other (Sutherland,
// Hodgman: Reentrant polygon clipping, 1974), in rational numbers, so that nothing is rounded. The
// corners of what is left say how the triangles meet.
#include "verify/contact_kind.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/parallel.h"
#include "verify/squared_distance.h"
#include "verify/contact.h"
#include "verify/exact.h"
#include "verify/rational.h"

namespace farcull {
namespace {

using rational::between;
using rational::dot;
using rational::minus;
using rational::Q;
using rational::Q3;

using Corners = std::array<Vec3, 3>;

constexpr std::array<std::string_view, kContactKinds.size()> kNames = {
    "apart", "equal", "touch-vertex", "touch-edge", "coplanar", "crossing", "touch-face"};

Q3 cross(const Q3& u, const Q3& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

bool is_zero(const Q3& u) { return sgn(u[0]) == 0 && sgn(u[1]) == 0 && sgn(u[2]) == 0; }

bool less(const Vec3& p, const Vec3& q) {
  return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
}

/// The corners of the set of points, sorted: three, two or one.
std::vector<Vec3> corners_of(const Corners& t) {
  std::vector<Vec3> out(t.begin(), t.end());
  std::sort(out.begin(), out.end(), less);
  switch (shape(t)) {
    case Shape::point:
      out.resize(1);
      break;
    case Shape::segment:
      out = {out.front(), out.back()};
      break;
    case Shape::triangle:
      break;
  }
  return out;
}

/// The points p with normal . (p - at) = 0, or those where it is not negative.
struct Bound {
  Q3 normal;
  Q3 at;
  bool plane;

  Q value(const Q3& p) const { return dot(normal, minus(p, at)); }
};

/// A triangle, segment or point as the hull of its corners, and as the points within its bounds.
class Hull {
 public:
  explicit Hull(const Corners& t) {
    for (const Vec3& p : corners_of(t)) corners_.push_back(rational::exact(p));
    if (corners_.size() == 3) {
      bound_triangle();
    } else if (corners_.size() == 2) {
      bound_segment();
    } else {
      for (int axis = 0; axis < 3; ++axis) bounds_.push_back({unit(axis), corners_[0], true});
    }
  }

  const std::vector<Q3>& corners() const { return corners_; }
  const std::vector<Bound>& bounds() const { return bounds_; }
  bool is_triangle() const { return corners_.size() == 3; }
  bool is_corner(const Q3& p) const {
    return std::find(corners_.begin(), corners_.end(), p) != corners_.end();
  }
  /// Whether a point of the hull is on an edge. A segment is all edge.
  bool on_edge(const Q3& p) const {
    return !is_triangle() || std::any_of(bounds_.begin(), bounds_.end(), [&](const Bound& bound) {
      return !bound.plane && sgn(bound.value(p)) == 0;
    });
  }
  /// Precondition: is_triangle().
  bool plane_holds(const Hull& other) const {
    return std::all_of(other.corners_.begin(), other.corners_.end(),
                       [&](const Q3& p) { return sgn(bounds_[0].value(p)) == 0; });
  }

 private:
  static Q3 unit(int axis) {
    Q3 out;
    out[axis] = 1;
    return out;
  }
  void bound_triangle() {
    const Q3 n = cross(minus(corners_[1], corners_[0]), minus(corners_[2], corners_[0]));
    bounds_.push_back({n, corners_[0], true});
    for (int i = 0; i < 3; ++i) {
      const Q3 edge = minus(corners_[(i + 1) % 3], corners_[i]);
      bounds_.push_back({cross(n, edge), corners_[i], false});
    }
  }
  /// Two planes through the segment's line, and one at each end. d x e is not 0 for a unit vector e
  /// along another axis than one in which d is not 0, and d x (d x e) is perpendicular to both.
  void bound_segment() {
    const Q3 d = minus(corners_[1], corners_[0]);
    int axis = 0;
    while (sgn(d[axis]) == 0) ++axis;
    const Q3 u = cross(d, unit((axis + 1) % 3));
    bounds_.push_back({u, corners_[0], true});
    bounds_.push_back({cross(d, u), corners_[0], true});
    bounds_.push_back({d, corners_[0], false});
    bounds_.push_back({minus(corners_[0], corners_[1]), corners_[1], false});
  }

  std::vector<Q3> corners_;
  std::vector<Bound> bounds_;
};

/// The part of a convex polygon where sign * value >= 0. The polygon is the list of its corners in
/// turn; two corners are a segment, one a point; a corner may stand there more than once.
std::vector<Q3> cut(const std::vector<Q3>& polygon, const Bound& bound, int sign) {
  std::vector<Q> values;
  for (const Q3& p : polygon) values.push_back(sign * bound.value(p));
  std::vector<Q3> out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const std::size_t next = (k + 1) % polygon.size();
    if (sgn(values[k]) >= 0) out.push_back(polygon[k]);
    if (sgn(values[k]) * sgn(values[next]) < 0) {
      out.push_back(between(polygon[k], polygon[next], Q(values[k] / (values[k] - values[next]))));
    }
  }
  return out;
}

/// Corners of the intersection, sorted, each once.
std::vector<Q3> common_points(const Hull& a, const Hull& b) {
  std::vector<Q3> points = a.corners();
  for (const Bound& bound : b.bounds()) {
    points = cut(points, bound, 1);
    if (bound.plane) points = cut(points, bound, -1);
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// Of sorted points. The first and the last of points on one line are its ends.
int dimension_of(const std::vector<Q3>& points) {
  if (points.size() <= 2) return static_cast<int>(points.size()) - 1;
  const Q3 along = minus(points.back(), points.front());
  const bool line = std::all_of(points.begin(), points.end(), [&](const Q3& p) {
    return is_zero(cross(along, minus(p, points.front())));
  });
  return line ? 1 : 2;
}

/// In one plane. Precondition: they have two points in common, so two segments lie on one line.
bool coplanar(const Hull& a, const Hull& b) {
  if (a.is_triangle()) return a.plane_holds(b);
  return !b.is_triangle() || b.plane_holds(a);
}

ContactKind kind_of(const Hull& a, const Hull& b, const std::vector<Q3>& common) {
  if (common.empty()) return ContactKind::apart;
  if (a.corners() == b.corners()) return ContactKind::equal;
  if (common.size() == 1) {
    const Q3& p = common.front();
    if (a.is_corner(p) || b.is_corner(p)) return ContactKind::touch_vertex;
    return a.on_edge(p) && b.on_edge(p) ? ContactKind::touch_edge : ContactKind::crossing;
  }
  if (coplanar(a, b)) return ContactKind::coplanar;
  // Two triangles in two planes with a segment in common, on the line L of both planes. An edge
  // that meets L in one point ends the triangle's part of L there, so that point is no middle of
  // the segment. So if the middle is on an edge, the edge lies on L, and all of the segment is on
  // it.
  const Q3 middle = between(common.front(), common.back(), Q(1, 2));
  return a.on_edge(middle) || b.on_edge(middle) ? ContactKind::touch_face : ContactKind::crossing;
}

Vec3 rounded_point(const Q3& p) {
  const auto nearest = [](const Q& x) { return rounded_quotient(x.get_num(), x.get_den(), 0); };
  return {nearest(p[0]), nearest(p[1]), nearest(p[2])};
}

/// answer(corners of a, corners of b) for each pair, on threads.
template <class Answer>
auto answers(const Scene& scene, std::span<const TrianglePair> pairs, unsigned threads,
             const Answer& answer) {
  for (const TrianglePair& pair : pairs) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size())
      throw std::logic_error("contact kinds: a pair names a triangle that the scene lacks");
  }
  constexpr std::size_t kLeast = 64;  // pairs that pay for a thread
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
  for (const ContactKind kind : kContactKinds) {
    if (name_of(kind) == name) return kind;
  }
  return std::nullopt;
}

ContactKind contact_kind(const Corners& a, const Corners& b) {
  if (contact_of(a, b) == Contact::penetrating) return ContactKind::crossing;
  const Hull s(a), t(b);
  return kind_of(s, t, common_points(s, t));
}

ContactShape contact_shape(const Corners& a, const Corners& b) {
  const Hull s(a), t(b);
  const std::vector<Q3> common = common_points(s, t);
  ContactShape out{.kind = kind_of(s, t, common), .dimension = dimension_of(common)};
  if (out.dimension == 0 || out.dimension == 1)
    out.ends = {rounded_point(common.front()), rounded_point(common.back())};
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
