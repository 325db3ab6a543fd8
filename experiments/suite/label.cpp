// Computes the labels (the right answers) of pairs, meshes and questions of the test suite.
//
// The kind of a pair follows from the intersection of the two triangles, which is convex. Each
// corner of the intersection is a corner of a triangle, a point where an edge crosses the other
// triangle's plane, or a point where two edges cross. These points are computed as rational
// numbers, so nothing is rounded.
#include "experiments/suite/label.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/integer_distance.h"
#include "verify/certificate/integer_pair.h"
#include "verify/closest.h"
#include "verify/contact.h"
#include "verify/exact.h"
#include "verify/inside.h"
#include "verify/rational.h"

namespace farcull {
namespace {

using rational::between;
using rational::cross;
using rational::dot;
using rational::minus;
using rational::Q;
using rational::Q3;

using Triangle = std::array<Q3, 3>;

constexpr std::array<const char*, 10> kKinds = {
    "apart",    "touch-vertex", "touch-edge",      "touch-face",       "crossing",
    "coplanar", "equal",        "neighbours-meet", "neighbours-apart", "?"};

constexpr const char* kReport = "one of the oracles is wrong; report ";

bool is_zero(const Q3& u) { return sgn(u[0]) == 0 && sgn(u[1]) == 0 && sgn(u[2]) == 0; }

Q3 edge(const Triangle& t, int i) { return minus(t[(i + 1) % 3], t[i]); }

Q3 normal(const Triangle& t) { return cross(edge(t, 0), edge(t, 1)); }

/// True if p is on one of the three closed edges.
bool on_edge(const Q3& p, const Triangle& t) {
  for (int i = 0; i < 3; ++i) {
    const Q3 e = edge(t, i);
    const Q3 w = minus(p, t[i]);
    if (!is_zero(cross(e, w))) continue;
    const Q along = dot(e, w);
    // An edge of length 0 contains only its end point.
    if (is_zero(e) ? is_zero(w) : along >= 0 && along <= dot(e, e)) return true;
  }
  return false;
}

/// True if p is in the closed triangle, which may be a segment or a point. n: the normal of the
/// triangle.
bool lies_in(const Q3& p, const Triangle& t, const Q3& n) {
  if (is_zero(n)) return on_edge(p, t);
  if (sgn(dot(n, minus(p, t[0]))) != 0) return false;
  for (int i = 0; i < 3; ++i) {
    if (sgn(dot(n, cross(edge(t, i), minus(p, t[i])))) < 0) return false;
  }
  return true;
}

/// All corners of the intersection of two triangles, and perhaps more points of the intersection.
/// Each point occurs once.
class CommonPoints {
 public:
  CommonPoints(const Triangle& a, const Triangle& b)
      : a_(a), b_(b), normal_a_(normal(a)), normal_b_(normal(b)) {
    for (const Q3& p : a) add(p);
    for (const Q3& p : b) add(p);
    add_through_plane(a, b, normal_b_);
    add_through_plane(b, a, normal_a_);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) add_of_edges(i, j);
    }
  }

  const std::vector<Q3>& points() const { return points_; }
  /// Returns the mean of the points, which is in the relative interior of the intersection.
  Q3 inner() const {
    Q3 out;
    for (const Q3& p : points_) {
      for (int k = 0; k < 3; ++k) out[k] += p[k];
    }
    for (Q& x : out) x /= static_cast<unsigned long>(points_.size());
    return out;
  }
  /// True if the triangles are the same set of points: each triangle contains all corners of the
  /// other triangle.
  bool all_of_both() const {
    return std::all_of(a_.begin(), a_.end(), [&](const Q3& p) { return has(p); }) &&
           std::all_of(b_.begin(), b_.end(), [&](const Q3& p) { return has(p); });
  }
  /// True if all six corners are in one plane. Precondition: at least two common points. If both
  /// normals are 0, both triangles are segments on one line, and the result is true.
  bool coplanar() const {
    const Q3& n = is_zero(normal_a_) ? normal_b_ : normal_a_;
    const auto in_plane = [&](const Q3& p) { return sgn(dot(n, minus(p, a_[0]))) == 0; };
    return std::all_of(a_.begin(), a_.end(), in_plane) &&
           std::all_of(b_.begin(), b_.end(), in_plane);
  }

 private:
  void add(const Q3& p) {
    if (!lies_in(p, a_, normal_a_) || !lies_in(p, b_, normal_b_)) return;
    if (!has(p)) points_.push_back(p);
  }
  bool has(const Q3& p) const {
    return std::find(points_.begin(), points_.end(), p) != points_.end();
  }
  /// Adds the points where edges of s cross the plane of t. n: the normal of t.
  void add_through_plane(const Triangle& s, const Triangle& t, const Q3& n) {
    if (is_zero(n)) return;
    for (int i = 0; i < 3; ++i) {
      const Q from = dot(n, minus(s[i], t[0]));
      const Q to = dot(n, minus(s[(i + 1) % 3], t[0]));
      if (sgn(from) * sgn(to) < 0) add(between(s[i], s[(i + 1) % 3], from / (from - to)));
    }
  }
  /// Adds the point where edge i of a and edge j of b meet, unless the edges are parallel.
  void add_of_edges(int i, int j) {
    const Q3 u = edge(a_, i);
    const Q3 v = edge(b_, j);
    const Q3 n = cross(u, v);
    const Q3 w = minus(b_[j], a_[i]);
    if (is_zero(n) || sgn(dot(w, n)) != 0) return;
    const Q along = dot(cross(w, v), n) / dot(n, n);
    if (along >= 0 && along <= 1) add(between(a_[i], a_[(i + 1) % 3], along));
  }

  const Triangle& a_;
  const Triangle& b_;
  Q3 normal_a_, normal_b_;
  std::vector<Q3> points_;
};

Triangle rational_triangle(const std::array<Vec3, 3>& t) {
  return {rational::exact(t[0]), rational::exact(t[1]), rational::exact(t[2])};
}

/// True if p is a corner of the triangle; for a segment, true if p is an end of the segment.
bool is_corner(const Q3& p, const Triangle& t) {
  if (std::find(t.begin(), t.end(), p) == t.end()) return false;
  if (!is_zero(normal(t))) return true;
  for (int i = 0; i < 3; ++i) {
    const Q along = dot(edge(t, i), minus(p, t[i]));
    if (along > 0 && along < dot(edge(t, i), edge(t, i))) return false;
  }
  return true;
}

SuiteKind kind_of_meeting(const std::array<Vec3, 3>& first, const std::array<Vec3, 3>& second,
                          bool& found) {
  const Triangle a = rational_triangle(first);
  const Triangle b = rational_triangle(second);
  const CommonPoints common(a, b);
  found = !common.points().empty();
  if (!found) return SuiteKind::apart;
  if (common.all_of_both()) return SuiteKind::equal;
  const bool one_point = common.points().size() == 1;
  const Q3 p = common.inner();
  if (one_point && (is_corner(p, a) || is_corner(p, b))) return SuiteKind::touch_vertex;
  if (one_point && on_edge(p, a) && on_edge(p, b)) return SuiteKind::touch_edge;
  if (!one_point && common.coplanar()) return SuiteKind::coplanar;
  // A single common point here means: one triangle is a segment through the inside of the other.
  // More common points form a segment; the triangles cross if its middle is on no edge.
  const bool inside = one_point || (!on_edge(p, a) && !on_edge(p, b));
  return inside ? SuiteKind::crossing : SuiteKind::touch_face;
}

void require_equal(bool one, bool other, const char* oracles, const std::string& where) {
  if (one != other)
    throw Error(where, fmt::format("{} disagree", oracles), kReport + std::string("the pair"));
}

/// Returns the number of vertices that two triangles of one object share by index.
std::uint32_t shared_vertices(const Scene& scene, const TrianglePair& pair) {
  const std::array<std::uint32_t, 3>& a = scene.triangles[pair.a];
  const std::array<std::uint32_t, 3>& b = scene.triangles[pair.b];
  std::uint32_t out = 0;
  for (int i = 0; i < 3; ++i) {
    const bool repeated = std::find(a.begin(), a.begin() + i, a[i]) != a.begin() + i;
    out += !repeated && std::find(b.begin(), b.end(), a[i]) != b.end();
  }
  return out;
}

/// Throws Error if the triangles of the object use two different vertices at the same position.
void require_distinct(const Scene& scene, const Object& object, const std::string& where) {
  std::map<std::array<double, 3>, std::uint32_t> at;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    for (const std::uint32_t v : scene.triangles[object.first_triangle + t]) {
      const Vec3& p = scene.vertices[v];
      if (at.try_emplace({p.x(), p.y(), p.z()}, v).first->second == v) continue;
      throw Error(where,
                  fmt::format("object {} has two vertices at ({}, {}, {})", object.name, p.x(),
                              p.y(), p.z()),
                  "join them, so that neighbours share an index wherever they share a position");
    }
  }
}

constexpr std::array<const char*, 4> kQuestions = {"distance", "self", "inside", "clash"};

const char* yes_or_no(bool yes) { return yes ? "yes" : "no"; }

Scene objects_of(const Scene& scene, const std::vector<std::size_t>& numbers, bool self) {
  Scene out;
  out.name = scene.name;
  for (const std::size_t o : numbers) {
    const Object& object = scene.objects[o];
    std::vector<std::uint32_t> faces(object.triangle_count);
    std::iota(faces.begin(), faces.end(), 0u);
    append_object(object.name, scene.vertices,
                  std::span(scene.triangles).subspan(object.first_triangle, object.triangle_count),
                  faces, out);
    out.objects.back().self = self;
  }
  return out;
}

Vec3 point_in(RandomDraws& draws, const Box& box) {
  Vec3 out;
  for (int k = 0; k < 3; ++k) out[k] = draws.between(box.lo[k], box.hi[k]);
  return out;
}

/// Returns a random point; parameters 1 to 3 make "inside" hard to decide. 0: anywhere in the box;
/// 1: on the axis-parallel line through a vertex, so that a ray can hit the vertex; 2: at a vertex;
/// 3: near the middle of a face.
Vec3 hard_point(RandomDraws& draws, const Scene& scene, const Box& box, int parameter) {
  const Object& object = scene.objects[0];
  const auto corners = scene.corners(object.first_triangle + draws.below(object.triangle_count));
  Vec3 p = point_in(draws, box);
  if (parameter == 1) {
    const int axis = draws.below(3);
    for (int k = 0; k < 3; ++k) {
      if (k != axis) p[k] = corners[0][k];
    }
  }
  if (parameter == 2) p = corners[0];
  if (parameter == 3) {
    p = (corners[0] + corners[1] + corners[2]) / 3;
    p[draws.below(3)] += std::ldexp(draws.sign() * (box.hi - box.lo).maxCoeff(), -draws.below(50));
  }
  return p;
}

SuiteQuestion about(SuiteQuestionKind kind, const SuiteMesh& mesh,
                    const std::vector<std::size_t>& objects, const std::string& label) {
  SuiteQuestion out{.parameter = mesh.parameter, .kind = kind, .label = label};
  for (const std::size_t o : objects)
    out.paths.push_back(fmt::format("meshes/{}/{}.obj", mesh.name, o));
  return out;
}

/// Returns whether the object meets itself. Empty if two vertices are at one position: triangles
/// may then be neighbours by position, but not by index.
std::optional<bool> decide_self(const Scene& scene, const std::string& where) {
  try {
    return !decide_mesh(scene, where).empty();
  } catch (const Error& error) {
    if (error.reason.find("has two vertices at") != std::string::npos) return {};
    throw;
  }
}

constexpr int kPoints = 24;              // questions "inside" for each closed object
constexpr std::size_t kDistances = 530;  // pairs per family, as in the small suite

}  // namespace

std::string to_string(SuiteKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

bool collides(SuiteKind kind) {
  return kind != SuiteKind::apart && kind != SuiteKind::neighbours_apart;
}

std::string hexadecimal(double value) {
  std::string text = std::signbit(value) ? "-0x" : "0x";
  std::array<char, 40> buffer;
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                         std::abs(value), std::chars_format::hex);
  return text.append(buffer.data(), end);
}

SuiteKind decide_kind(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      const std::string& where) {
  const bool meets = intersects(a, b);
  IntegerPair integers(a, b);
  require_equal(meets, !integers.separating_direction(),
                "CGAL's predicates and the directions in integers", where);
  require_equal(meets, integers.has_common_point(), "CGAL's predicates and the points in integers",
                where);
  if (!meets) return SuiteKind::apart;
  bool found = false;
  const SuiteKind kind = kind_of_meeting(a, b, found);
  require_equal(meets, found, "CGAL's predicates and the points in rational numbers", where);
  require_equal(penetrate(a, b), kind == SuiteKind::crossing,
                "CGAL's predicates and rational numbers, about whether the triangles cross,",
                where);
  return kind;
}

SuiteKind decide_neighbours(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where) {
  const bool meets = intersects_beyond_shared(a, b);
  require_equal(meets, IntegerPair(a, b).meets_beyond_shared(),
                "CGAL's predicates and integers, about neighbours,", where);
  return meets ? SuiteKind::neighbours_meet : SuiteKind::neighbours_apart;
}

SuiteKind decide(const SuitePair& pair, const std::string& where) {
  return pair.shared.empty() ? decide_kind(pair.a, pair.b, where)
                             : decide_neighbours(pair.a, pair.b, where);
}

std::vector<SharedCorner> equal_corners(const std::array<Vec3, 3>& a,
                                        const std::array<Vec3, 3>& b) {
  std::vector<SharedCorner> out;
  for (std::uint8_t i = 0; i < 3; ++i) {
    for (std::uint8_t j = 0; j < 3; ++j) {
      if (a[i] == b[j]) out.push_back({i, j});
    }
  }
  return out;
}

std::vector<SuiteMeshPair> decide_mesh(const Scene& scene, const std::string& where) {
  for (const Object& object : scene.objects) {
    if (object.self) require_distinct(scene, object, where);
  }
  const ExactResult found = all_colliding_pairs(scene);
  std::vector<TrianglePair> all = found.pairs;
  all.insert(all.end(), found.neighbour_pairs.begin(), found.neighbour_pairs.end());
  std::sort(all.begin(), all.end());
  const CheckResult checked = check_certificate(certificate_of_list(scene, all), scene);
  if (checked.verdict != Verdict::proved || checked.meeting != all) {
    throw Error(where,
                fmt::format("CGAL's predicates find {} colliding pairs, and the certificate "
                            "checker says: {} {}",
                            all.size(), to_string(checked.verdict), checked.reason),
                kReport + std::string("the mesh"));
  }
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<SuiteMeshPair> out;
  out.reserve(all.size());
  for (const TrianglePair& pair : all) {
    const bool one_object = owner[pair.a] == owner[pair.b];
    out.push_back({pair, one_object ? shared_vertices(scene, pair) : 0});
  }
  return out;
}

std::string questions_text(const SuiteQuestions& questions) {
  std::string out = "farcull-questions 1 " + questions.family + "\n";
  for (const SuiteQuestion& question : questions.questions) {
    out += fmt::format("{} {} {} {}", question.id, shortest(question.parameter),
                       kQuestions[static_cast<std::size_t>(question.kind)], question.label);
    for (const std::string& path : question.paths) out += " " + path;
    for (const double x : question.coordinates) out += " " + hexadecimal(x);
    out += "\n";
  }
  return out;
}

SuiteQuestions questions_of(const SuitePairs& pairs) {
  SuiteQuestions out{.family = pairs.family};
  const std::size_t count = std::min(pairs.pairs.size(), kDistances);
  for (std::size_t i = 0; i < count; ++i) {
    const SuitePair& pair = pairs.pairs[i];
    if (!pair.shared.empty()) continue;
    SuiteQuestion question{.id = out.questions.size(), .parameter = pair.parameter};
    question.label =
        decide_distance(pair.a, pair.b, fmt::format("pair {} of {}", pair.id, pairs.family));
    for (const auto* t : {&pair.a, &pair.b}) {
      for (const Vec3& p : *t)
        question.coordinates.insert(question.coordinates.end(), p.data(), p.data() + 3);
    }
    out.questions.push_back(std::move(question));
  }
  return out;
}

SuiteQuestions questions_of(const SuiteMesh& mesh, std::uint64_t seed) {
  using enum SuiteQuestionKind;
  SuiteQuestions out{.family = mesh.family};
  const auto add = [&](SuiteQuestion question) {
    question.id = out.questions.size();
    out.questions.push_back(std::move(question));
  };
  std::vector<std::size_t> closed;
  for (std::size_t o = 0; o < mesh.scene.objects.size(); ++o) {
    const Scene alone = objects_of(mesh.scene, {o}, true);
    if (const auto meets = decide_self(alone, mesh.name))
      add(about(self, mesh, {o}, yes_or_no(*meets)));
    if (!is_closed(alone, 0)) continue;
    closed.push_back(o);
    RandomDraws draws(seed_of_item(seed, mesh.name, o));
    const Box box = bounds(alone);
    std::vector<Vec3> points;
    for (int i = 0; i < kPoints; ++i) points.push_back(hard_point(draws, alone, box, i % 4));
    const std::vector<bool> labels = decide_inside(alone, points, mesh.name);
    for (int i = 0; i < kPoints; ++i) {
      SuiteQuestion question = about(inside, mesh, {o}, yes_or_no(labels[i]));
      question.parameter = i % 4;
      question.coordinates.assign(points[i].data(), points[i].data() + 3);
      add(std::move(question));
    }
  }
  for (std::size_t i = 0; i < closed.size(); ++i) {
    for (std::size_t k = i + 1; k < closed.size(); ++k) {
      const Scene both = objects_of(mesh.scene, {closed[i], closed[k]}, false);
      if (const auto meet = decide_clash(both, mesh.name))
        add(about(clash, mesh, {closed[i], closed[k]}, yes_or_no(*meet)));
    }
  }
  return out;
}

std::string decide_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double root = squared_distance(a, b).root();
  const auto beyond = [&](double length, bool or_equal) {
    return is_beyond(a, b, Length(square_of(length)), or_equal);
  };
  double low = root, high = root;
  if (beyond(root, false))
    high = std::nextafter(root, kInfinity);
  else if (!beyond(root, true))
    low = std::nextafter(root, -kInfinity);
  if (low < 0 || !std::isfinite(high) || !beyond(low, true) || beyond(high, false))
    throw Error(where, "fractions and directions disagree about the distance",
                kReport + std::string("the question"));
  return hexadecimal(low) + "," + hexadecimal(high);
}

std::vector<bool> decide_inside(const Scene& scene, const std::vector<Vec3>& points,
                                const std::string& where) {
  const Surface surface = surface_of(scene, 0);
  Scene with_points = scene;
  const std::array<std::array<std::uint32_t, 3>, 1> one_vertex{};
  const std::array<std::uint32_t, 1> face{};
  for (const Vec3& p : points)
    append_object("point", std::span(&p, 1), one_vertex, face, with_points);
  const auto before = static_cast<std::uint32_t>(scene.objects.size());
  const IntegerInside integers(with_points);
  std::vector<bool> out;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const bool by_rays = inside(scene, 0, points[i], surface) != Inside::no;
    // which() requires a point off the mesh, so points on the mesh are found first.
    bool by_integers = false;
    for (std::uint32_t t = 0; t < scene.objects[0].triangle_count && !by_integers; ++t) {
      const auto corners = scene.corners(scene.objects[0].first_triangle + t);
      const auto& [a, b, c] = corners;
      if ((points[i].array() < a.cwiseMin(b).cwiseMin(c).array()).any() ||
          (points[i].array() > a.cwiseMax(b).cwiseMax(c).array()).any())
        continue;
      by_integers = IntegerPair(corners, {points[i], points[i], points[i]}).has_common_point();
    }
    by_integers = by_integers || integers.which(0, before + i) == InsideClaim::b;
    if (by_rays != by_integers)
      throw Error(where, fmt::format("rays and integers disagree about point {}", i),
                  kReport + std::string("the question"));
    out.push_back(by_rays);
  }
  return out;
}

std::optional<bool> decide_clash(const Scene& scene, const std::string& where) {
  std::array<Scene, 2> alone = {objects_of(scene, {0}, false), objects_of(scene, {1}, false)};
  const Box common = intersection(bounds(alone[0]), bounds(alone[1]));
  if ((common.lo.array() >= common.hi.array()).any()) return false;
  constexpr int kTries = 256;
  RandomDraws draws(seed_of_item(0, "clash", 0));
  const std::array<Surface, 2> surfaces = {surface_of(alone[0], 0), surface_of(alone[1], 0)};
  for (int i = 0; i < kTries; ++i) {
    const Vec3 p = point_in(draws, common);
    bool both = true;
    for (int o = 0; o < 2; ++o) both = both && inside(alone[o], 0, p, surfaces[o]) == Inside::yes;
    if (!both) continue;
    for (int o = 0; o < 2; ++o) (void)decide_inside(alone[o], {p}, where);
    return true;
  }
  return {};
}

}  // namespace farcull
