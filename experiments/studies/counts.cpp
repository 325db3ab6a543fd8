// Converts typed counts and times to the names under which a store holds them.
#include "experiments/studies/counts.h"

#include <nlohmann/json.hpp>

namespace farcull {
namespace {

template <class Value>
void add(NamedCounts& out, const char* name, const std::optional<Value>& value) {
  if (value) out.push_back({name, *value});
}

NamedCounts named(std::monostate) { return {}; }

NamedCounts named(const RunCounts& c) {
  NamedCounts out = {{"colliding", c.colliding},
                     {"missed", c.missed},
                     {"missed_penetrating", c.missed_penetrating},
                     {"colliding_triangles", c.colliding_triangles},
                     {"missed_triangles", c.missed_triangles},
                     {"candidates", c.candidates},
                     {"kept_triangles", c.kept_triangles},
                     {"kept_objects", c.kept_objects},
                     {"triangles", c.triangles},
                     {"objects", c.objects},
                     {"promises", c.promises},
                     {"scene_hash", c.scene_hash}};
  if (c.revoked) out.push_back({"revoked", true});
  add(out, "at_risk", c.at_risk);
  add(out, "object_triangles", c.object_triangles);
  if (c.drawn) {
    out.insert(out.end(), {{"queries", c.drawn->queries},
                           {"draws", c.drawn->draws},
                           {"queries_saved", c.drawn->queries_saved},
                           {"draws_saved", c.drawn->draws_saved}});
  }
  if (c.radius) {
    out.insert(out.end(),
               {{"radius_px", c.radius->radius_px}, {"pixel_size", c.radius->pixel_size}});
  }
  if (c.fragments) {
    add(out, "elements", c.fragments->elements);
    add(out, "covered", c.fragments->covered);
    out.push_back({"fragments", c.fragments->fragments});
    add(out, "tests", c.fragments->tests);
    add(out, "views", c.fragments->views);
  }
  if (c.size) {
    out.insert(out.end(),
               {{"resolution", c.size->resolution}, {"mean_pixels", c.size->mean_pixels}});
  }
  if (c.neighbours) {
    out.insert(out.end(), {{"neighbour_candidates", c.neighbours->candidates},
                           {"neighbours", c.neighbours->colliding}});
  }
  return out;
}

NamedCounts named(const PeerCounts& c) {
  NamedCounts out = {{"colliding", c.colliding}, {"missed", c.missed}, {"wrong", c.wrong}};
  add(out, "colliding_triangles", c.colliding_triangles);
  out.insert(out.end(), {{"missed_triangles", c.missed_triangles},
                         {"candidates", c.candidates},
                         {"triangles", c.triangles},
                         {"objects", c.objects}});
  if (!c.library.empty()) out.push_back({"library", c.library});
  if (!c.scene_hash.empty())
    out.insert(out.end(), {{"promises", false}, {"scene_hash", c.scene_hash}});
  return out;
}

NamedCounts named(const LemmaCounts& c) {
  NamedCounts out = {{"points", c.points},
                     {"violations", c.violations},
                     {"no_sample", c.no_sample},
                     {"not_bounding", c.not_bounding},
                     {"rounded", c.rounded},
                     {"largest_px", c.largest_px},
                     {"largest_steps", c.largest_steps},
                     {"step_px", c.step_px},
                     {"radius_px", c.radius_px},
                     {"budget_px", c.budget_px},
                     {"promises", c.promises}};
  if (c.revoked) out.push_back({"revoked", true});
  return out;
}

NamedCounts named(const PlacementCounts& c) {
  return {{"placements", c.placements},
          {"colliding_placements", c.colliding_placements},
          {"missed_placements", c.missed_placements},
          {"colliding", c.colliding},
          {"missed", c.missed},
          {"largest_miss_px", c.largest_miss_px},
          {"radius_px", c.radius_px},
          {"budget_px", c.budget_px},
          {"promises", c.promises}};
}

NamedCounts named(const ClothCounts& c) {
  NamedCounts out = {{"colliding", c.colliding},
                     {"neighbours", c.neighbours},
                     {"missed", c.missed},
                     {"candidates", c.candidates},
                     {"kept_triangles", c.kept_triangles},
                     {"triangles", c.triangles},
                     {"accounted", c.accounted},
                     {"by_boxes", c.by_boxes},
                     {"by_predicates", c.by_predicates},
                     {"promises", c.promises},
                     {"scene_hash", c.scene_hash},
                     {"kinetic", c.kinetic},
                     {"total", c.total},
                     {"slack", c.slack},
                     {"residual", c.residual},
                     {"iterations", c.iterations},
                     {"converged", c.converged}};
  if (c.revoked) out.push_back({"revoked", true});
  return out;
}

NamedCounts named(const SceneCounts& c) {
  NamedCounts out = {{"triangles", c.triangles},       {"objects", c.objects},
                     {"self_objects", c.self_objects}, {"colliding", c.colliding},
                     {"neighbours", c.neighbours},     {"scene_hash", c.scene_hash}};
  if (c.pixels) {
    out.insert(out.end(), {{"pixels_tenth", c.pixels->tenth},
                           {"pixels_half", c.pixels->half},
                           {"pixels_ninety", c.pixels->ninety}});
  }
  return out;
}

NamedCounts named(const LibraryCounts& c) {
  NamedCounts out = {{"asked", c.asked},
                     {"answered", c.answered},
                     {"missed", c.missed},
                     {"wrong", c.wrong},
                     {"own_asked", c.own_asked},
                     {"own_missed", c.own_missed},
                     {"own_wrong", c.own_wrong},
                     {"refused", c.refused},
                     {"unanswered", c.unanswered},
                     {"crashed", c.crashed},
                     {"hung", c.hung},
                     {"no_memory", c.no_memory},
                     {"not_asked", c.not_asked},
                     {"timed", c.timed},
                     {"twice", c.twice},
                     {"differing", c.differing},
                     {"neighbours_left_out", c.neighbours_left_out},
                     {"promises", c.promises},
                     {"library", c.library},
                     {"means", c.means},
                     {"call", c.call},
                     {"says", c.says},
                     {"source", c.source},
                     {"use", c.use},
                     {"reason", c.reason},
                     {"scores", c.scores}};
  add(out, "first_missed", c.first_missed);
  add(out, "first_wrong", c.first_wrong);
  add(out, "first_death", c.first_death);
  for (const auto& [name, example] : {std::pair{"example_missed", &c.example_missed},
                                      std::pair{"example_wrong", &c.example_wrong},
                                      std::pair{"example_death", &c.example_death}}) {
    if (!example->empty()) out.push_back({name, *example});
  }
  return out;
}

NamedCounts named(const SetCounts& c) {
  const NeighbourSizes& s = c.sizes;
  return {{"with_nearest", s.objects},
          {"missed", s.missed},
          {"nearest_pairs", s.nearest_pairs},
          {"missed_pairs", s.missed_pairs},
          {"object_pairs", s.object_pairs},
          {"triangle_pairs", s.triangle_pairs},
          {"set_objects", s.set_objects},
          {"median_objects", s.median_objects},
          {"most_objects", s.most_objects},
          {"set_triangles", s.set_triangles},
          {"median_triangles", s.median_triangles},
          {"most_triangles", s.most_triangles},
          {"triangles", c.triangles},
          {"objects", c.all_objects},
          {"accounted", c.accounted},
          {"promises", c.promises},
          {"scene_hash", c.scene_hash}};
}

NamedCounts named(const DistanceCounts& c) {
  const DistanceErrors& e = c.errors;
  return {{"asked", c.asked},
          {"answers", e.answers},
          {"exact", e.exact},
          {"lacking", e.lacking},
          {"beyond", e.beyond_it},
          {"other_zero", e.other_zero},
          {"other_object", e.other_object},
          {"largest_relative", e.largest_relative},
          {"triangles", c.triangles},
          {"objects", c.objects},
          {"accounted", c.accounted},
          // Distances that are not the nearest double, and distances of nothing that was asked for.
          {"wrong", c.asked - e.exact + e.beyond_it},
          {"promises", c.promises},
          {"library", c.library},
          {"scene_hash", c.scene_hash}};
}

}  // namespace

NamedCounts named(const Counts& counts) {
  return std::visit([](const auto& of) { return named(of); }, counts);
}

Measurement stored(const PointResult& result) {
  Measurement out{.device = result.device, .left_out = result.left_out};
  for (const auto& [name, value] : named(result.counts))
    std::visit([&, &key = name](const auto& of) { (*out.counts)[key] = of; }, value);
  const PointTimes& t = result.times;
  const std::pair<const char*, std::optional<double>> times[] = {
      {"build", t.build}, {"cull", t.cull},           {"exact", t.exact},        {"total", t.total},
      {"setup", t.setup}, {"total_min", t.total_min}, {"total_max", t.total_max}};
  for (const auto& [name, ms] : times) {
    if (ms) out.times[name] = *ms;
  }
  if (!t.totals.empty()) out.times["totals"] = t.totals;
  return out;
}

bool breaks_promise(const Measurement& measurement) {
  const auto& counts = *measurement.counts;
  if (!counts.value("promises", false)) return false;
  // Of a contestant, silence breaks it as well.
  for (const char* count : {"missed", "missed_pairs", "wrong", "violations", "refused",
                            "unanswered", "not_asked", "crashed", "hung", "no_memory"}) {
    if (counts.value(count, std::uint64_t{0}) > 0) return true;
  }
  return false;
}

}  // namespace farcull
