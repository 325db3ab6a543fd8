#include "experiments/run_pairs.h"

#include <algorithm>
#include <utility>

#include "core/pair_view.h"

namespace farcull {
namespace {

std::vector<std::uint32_t> members(const Scene& scene, const std::vector<TrianglePair>& pairs) {
  std::vector<std::uint8_t> in(scene.triangles.size(), 0);
  for (const TrianglePair& pair : pairs) in[pair.a] = in[pair.b] = 1;
  std::vector<std::uint32_t> out;
  for (std::uint32_t t = 0; t < in.size(); ++t) {
    if (in[t] != 0) out.push_back(t);
  }
  return out;
}

}  // namespace

std::uint64_t count_objects(const Scene& scene, const std::vector<std::uint32_t>& triangles) {
  std::uint64_t objects = 0;
  std::size_t t = 0;
  for (const Object& object : scene.objects) {
    const std::size_t end = static_cast<std::size_t>(object.first_triangle) + object.triangle_count;
    const std::size_t before = t;
    while (t < triangles.size() && triangles[t] < end) ++t;
    objects += t > before;
  }
  return objects;
}

void run_far_pairs(const Scene& scene, Session& session, const Progress& progress,
                   RunRecord& record) {
  const RunOptions& options = record.options;
  // Boxes first where there is no device yet: they may decide.
  if (!session.has_pairs() && !options.full) {
    const Stopwatch planning;
    if (progress) progress("planning");
    if (pair_regions(scene, options.clearance).triangles.empty()) {
      record.ms.cull = planning.ms();
      record.device_note = "no two objects' boxes overlap, none collides with itself";
      record.stages.push_back({.name = "boxes",
                               .ran = true,
                               .reason = record.device_note,
                               .ms = record.ms.cull,
                               .in = scene.triangles.size(),
                               .unit = "triangles"});
      record.stages.push_back(
          {.name = "setup", .reason = "boxes decide: there is nothing to look at", .unit = ""});
      return;
    }
  }
  if (progress) progress("opening the device");
  const Stopwatch setup;
  PairDevice& device = session.pairs();
  record.device = device.gl;
  record.on_cpu = !device.gl;
  record.device_note = device.reason;
  if (device.gl) rely_on_device(session, Reliance::pairs, record);
  record.ms.setup = setup.ms();
  record.stages.push_back({.name = "setup",
                           .ran = true,
                           .reason = device.backend->name(),
                           .ms = record.ms.setup,
                           .unit = ""});

  const Stopwatch cull;
  PairSettings settings{.views = {},
                        .resolution = resolution_of(options),
                        .clearance = options.clearance,
                        .full = options.full};
  if (!views_of(options).empty()) settings.views = parse_views(views_of(options));
  PairResult result = find_pairs(scene, settings, *device.backend, progress);
  record.ms.cull = cull.ms();
  record.kept = std::move(result.candidates);
  record.candidate_pairs = record.kept.size();
  record.pair_views = std::move(result.views);
  record.stages.insert(record.stages.end(), result.stages.begin(), result.stages.end());

  record.pcs = members(scene, record.kept);
  record.pcs_triangles = record.pcs.size();
  record.pcs_objects = count_objects(scene, record.pcs);
}

}  // namespace farcull
