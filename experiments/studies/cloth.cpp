// The study "cloth": every frame of a cloth that falls, at four stiffnesses, with every pair of
// triangles accounted for. The simulation takes hours where the cloth is fine and stiff, so its
// states are kept (scenes/cloth/cloth.h), and the stiffnesses take turns.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

constexpr int kResolution = 512;  // of far
constexpr long kTurn = 20;        // frames of one stiffness before the next has its turn
constexpr long kOfFar = 10;       // far looks at every tenth frame

std::vector<Point> grid(const GridChoice& choice) {
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

PointResult measure(const Point& point, Lab& lab) {
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
  counts.revoked = counts.promises && !record.promise.holds;
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

Study cloth_study() {
  return {.name = "cloth",
          .title = "A stiff cloth, frame by frame",
          .question =
              "Does a cloth of 20,000 triangles stay finite and its energy bounded at every "
              "stiffness, and is every pair of triangles that collides found in every frame?",
          .grid = grid,
          .measure = measure,
          .campaign = true};
}

}  // namespace farcull
