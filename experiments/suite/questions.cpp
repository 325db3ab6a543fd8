// Makes the questions of a suite that are not about colliding pairs, and decides their labels.
#include "experiments/suite/questions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "verify/certificate/integer_distance.h"
#include "verify/certificate/integer_pair.h"
#include "verify/closest.h"
#include "verify/inside.h"

namespace farcull {
namespace {

constexpr const char* kReport = "one of the oracles is wrong; report the question";
constexpr std::array<const char*, 4> kKinds = {"distance", "self", "inside", "clash"};

std::size_t number_of(SuiteQuestionKind kind) { return static_cast<std::size_t>(kind); }

const char* yes_or_no(bool yes) { return yes ? "yes" : "no"; }

/// A scene of only the objects with these numbers.
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

/// Points where deciding "inside" is hard. parameter: 0 anywhere in the box; 1 straight above or
/// below a vertex, where a ray along an axis hits it; 2 at a vertex; 3 near the middle of a face.
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

/// Whether the object meets itself; empty if two of its vertices are at one position: then
/// triangles may be neighbours by position, but not by index.
std::optional<bool> decide_self(const Scene& scene, const std::string& where) {
  try {
    return !decide_mesh(scene, where).empty();
  } catch (const Error& error) {
    if (error.reason.find("has two vertices at") != std::string::npos) return {};
    throw;
  }
}

constexpr int kPoints = 24;              // per closed object
constexpr std::size_t kDistances = 530;  // per family of pairs, as many as the small suite has

}  // namespace

std::string questions_text(const SuiteQuestions& questions) {
  std::string out = "farcull-questions 1 " + questions.family + "\n";
  for (const SuiteQuestion& question : questions.questions) {
    out += fmt::format("{} {} {} {}", question.id, shortest(question.parameter),
                       kKinds[number_of(question.kind)], question.label);
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
  const auto at_least = [&](double length) {
    return is_beyond(a, b, Length(square_of(length)), true);
  };
  const auto more_than = [&](double length) {
    return is_beyond(a, b, Length(square_of(length)), false);
  };
  double low = root, high = root;
  if (more_than(root))
    high = std::nextafter(root, kInfinity);
  else if (!at_least(root))
    low = std::nextafter(root, -kInfinity);
  if (low < 0 || !std::isfinite(high) || !at_least(low) || more_than(high))
    throw Error(where, "fractions and directions disagree about the distance", kReport);
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
    // which() is right only for points off the mesh, so points on it are found first.
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
      throw Error(where, fmt::format("rays and integers disagree about point {}", i), kReport);
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
