// The studies "stability" and "cloth": scenes that go to an extreme, and which methods still find
// what collides; and every frame of a cloth that falls, at four stiffnesses, with every pair of
// triangles accounted for. The simulation takes hours where the cloth is fine and stiff, so its
// states are kept (scenes/cloth/cloth.h), and the stiffnesses take turns.
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <stdexcept>
#include <variant>

#include "experiments/studies/point.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

using enum Method;

constexpr int kResolution = 512;
constexpr const char* kLibrary = "fcl-float";
constexpr long kFrames = 500;  // of the cloth

RunPoint drawn(const PointScene& scene, Method method, const char* offset = "") {
  RunPoint out{.scene = scene, .method = method, .offset = offset, .resolution = kResolution};
  if (method == far) out.radius = kBudgetRadius;
  return out;
}

void add_between_objects(std::vector<Point>& out, const PointScene& scene) {
  out.insert(out.end(), {drawn(scene, cullide), PeerPoint{scene, kLibrary},
                         drawn(scene, far, "obb"), drawn(scene, far, "exact"),
                         plain_point(scene, far_pairs), plain_point(scene, exact)});
}

void add_against_itself(std::vector<Point>& out, const PointScene& scene) {
  out.insert(out.end(), {drawn(scene, s_cullide), PeerPoint{scene, kLibrary},
                         plain_point(scene, far_pairs), plain_point(scene, exact)});
}

void add_built_in(std::vector<Point>& out, bool quick) {
  const auto add = [&](const std::string& name) { add_between_objects(out, NamedScene{name}); };
  const auto powers = [quick](int from, int to, int quick_step, int step) {
    std::vector<int> all;
    for (int i = from; i <= to; i += quick ? quick_step : step) all.push_back(i);
    return all;
  };
  const int slivers = quick ? 200 : 400, sheets = quick ? 6 : 8, large = quick ? 40 : 100,
            pairs = quick ? 216 : 512;
  for (const int k : powers(2, 12, 5, 2)) add(fmt::format("slivers:{}:1e{}", slivers, k));
  for (const int k : powers(1, 14, 6, 1)) add(fmt::format("stack:{}:1e-{}", sheets, k));
  for (const int k : powers(0, 12, 6, 2)) add(fmt::format("mixed:{}:1e{}", large, k));
  for (const char* sign : {"-", ""}) {
    for (const int k : powers(0, 12, 6, 3)) add(fmt::format("gap:{}:{}1e{}", pairs, sign, k));
    // A pixel of the widest view is 9e12 ulps.
    add(fmt::format("gap:{}:{}1e13", pairs, sign));
  }
  add(fmt::format("gap:{}:0", pairs));
  using Change = ChangedScene::Change;
  const std::string moved = quick ? "crowd:60" : "crowd:200";
  for (const int k : powers(0, 9, 3, 1))
    add_between_objects(out, ChangedScene{moved, Change::offset, k});
  for (const int k : powers(-9, 9, 9, 3))
    add_between_objects(out, ChangedScene{moved, Change::scale, k});
}

void add_cloth(std::vector<Point>& out, bool quick) {
  const std::vector<long> frames =
      quick ? std::vector<long>{40} : std::vector<long>{10, 25, 40, 60, 80, 100};
  for (const int k : {2, 4, 6, 8}) {
    const std::string name = fmt::format("cloth:{}:1e{}", quick ? 450 : 800, k);
    for (const long frame : frames) add_against_itself(out, MotionFrame{name, frame, kFrames});
    for (const long frame : frames) add_between_objects(out, ClothApart{name, frame});
  }
}

std::vector<Point> stability_grid(const GridChoice& choice) {
  std::vector<Point> out;
  add_built_in(out, choice.quick);
  add_cloth(out, choice.quick);
  return out;
}

// With the pairs at risk of a radius.
PointResult measure_with_risk(const RunPoint& run, Lab& lab) {
  PointResult out = measure_run(run, lab);
  auto* counts = std::get_if<RunCounts>(&out.counts);
  if (run.method != far || counts == nullptr) return out;
  RunPoint smaller = run;
  smaller.radius = RadiusRule{.factor = 0.9};
  counts->at_risk = std::get<RunCounts>(measure_run(smaller, lab).counts).missed;
  return out;
}

PointResult measure_stability(const Point& point, Lab& lab) {
  if (const auto* run = std::get_if<RunPoint>(&point)) return measure_with_risk(*run, lab);
  PointResult out = measure_peer(std::get<PeerPoint>(point), lab, 1);
  if (auto* counts = std::get_if<PeerCounts>(&out.counts)) {
    counts->colliding_triangles.reset();
    counts->library.reset();
    counts->promises = false;
    counts->scene_hash = scene_hash(lab.current());
    PointTimes& times = out.times;
    times.total = *times.build + *times.cull + *times.exact;
    times.total_min.reset();
    times.total_max.reset();
    times.totals.clear();
  }
  return out;
}

constexpr long kTurn = 20;   // frames of one stiffness before the next has its turn
constexpr long kOfFar = 10;  // far looks at every tenth frame

std::vector<Point> cloth_grid(const GridChoice& choice) {
  const int triangles = choice.quick ? 200 : 20000;
  const long frames = choice.quick ? 12 : 500;
  std::vector<Point> out;
  for (long begin = 0; begin < frames; begin += kTurn) {
    for (const int k : {2, 8, 4, 6}) {
      const std::string name = fmt::format("cloth:{}:1e{}", triangles, k);
      for (long frame = begin; frame < std::min(frames, begin + kTurn); ++frame) {
        const MotionFrame scene{name, frame, frames};
        out.emplace_back(plain_point(scene, Method::far_pairs));
        if (frame % kOfFar == 0)
          out.emplace_back(far_point(scene, "obb", kBudgetRadius, kResolution));
      }
    }
  }
  return out;
}

// The notes of the simulation, by their names in builtin/cloth.cpp.
double note(const FrameNotes& notes, const std::string& name) {
  for (const auto& [known, value] : notes.values) {
    if (known == name) return value;
  }
  throw std::logic_error("the cloth says nothing of " + name);
}

PointResult measure_cloth(const Point& point, Lab& lab) {
  const auto& of = std::get<RunPoint>(point);
  const Scene& scene = open_scene(of.scene, lab);
  const FrameNotes notes = lab.notes();
  RunOptions options = options_of(of, lab);
  options.verify = true;
  const Record record = run(scene, options, lab.session(), lab.progress());
  const Accounting& all = *record.verification;
  ClothCounts counts;
  counts.neighbours = record.collisions.neighbour_pairs.size();
  counts.missed = all.false_negatives;
  counts.colliding = record.collisions.pairs.size() + counts.neighbours + counts.missed;
  counts.candidates = record.found.count;
  counts.kept_triangles = record.found.triangle_count;
  counts.triangles = scene.triangles.size();
  counts.accounted = all.pairs_total;
  counts.by_boxes = all.certified_by_boxes;
  counts.by_predicates = all.certified_by_predicates;
  counts.promises = promises(record.options);
  if (counts.promises && !record.promise.holds) counts.revoked = true;
  counts.scene_hash = record.scene_hash;
  counts.kinetic = note(notes, "kinetic J");
  counts.total = note(notes, "total J");
  counts.slack = note(notes, "slack J");
  counts.residual = note(notes, "residual N");
  counts.iterations = static_cast<std::uint64_t>(note(notes, "iterations"));
  counts.converged = note(notes, "converged") != 0;
  return {.counts = counts,
          .times = {.cull = record.ms.cull,
                    .exact = record.ms.exact,
                    .total = record.ms.cull + record.ms.exact,
                    .setup = record.ms.setup},
          .device = answered(record)};
}

}  // namespace

Study stability_study() {
  return {.name = "stability",
          .title = "Scenes that go to an extreme",
          .question =
              "What is missed where cloth is stiff, triangles are slivers, gaps are ulps, "
              "sheets are stacked, sizes differ by far, or the scene is far away, tiny or "
              "huge, and how much does culling then still remove?",
          .grid = stability_grid,
          .measure = measure_stability,
          .library = library_of_peer};
}

Study cloth_study() {
  return {.name = "cloth",
          .title = "A stiff cloth, frame by frame",
          .question =
              "Does a cloth of 20,000 triangles stay finite and its energy bounded at every "
              "stiffness, and is every pair of triangles that collides found in every frame?",
          .grid = cloth_grid,
          .measure = measure_cloth,
          .campaign = true};
}

}  // namespace farcull
