// farcull_report_fixture DIR [PART]: a store in DIR as the quick grids of all studies would leave
// it, with made-up numbers of the size of true ones, the same on every run. For tests of the
// report: they take a second instead of minutes, and no device. PART: `some` (each third point
// only), `shard` (a shard of two, with its own name), `foreign` (a study that no program has),
// `broken` (in each study the first row that promises missed something), `unconverged` (a step of
// the cloth did not converge, and nothing was missed).
//
// What is made up says so: the commit is "made-up".
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "experiments/studies/store.h"
#include "tests/lab/points.h"

namespace {

using namespace farcull;

// 0 to 1, from the point and the name of the number.
double unit(const PointKey& point, const std::string& name) {
  std::uint64_t hash = 1469598103934665603ULL;
  const auto mix = [&hash](const std::string& text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    hash = (hash ^ (hash >> 29)) * 0xbf58476d1ce4e5b9ULL;
  };
  for (const std::string& value : axis_values(point)) mix(value);
  mix(name);
  return static_cast<double>(hash >> 11) * 0x1p-53;
}

// Of 10^from to 10^to.
std::uint64_t between(const PointKey& point, const std::string& name, double from, double to) {
  return static_cast<std::uint64_t>(std::pow(10, from + (to - from) * unit(point, name)));
}

bool asks_library(const PointKey& point) {
  return (point.method.ends_with(" nearest") || point.method.ends_with(" objects")) &&
         !point.method.starts_with("farcull");
}

bool reliable(const PointKey& point) {
  return point.method != "voronoi" && !point.method.ends_with(" --widening 0") &&
         !asks_library(point) && point.method.find("cullide") == std::string::npos &&
         point.radius != kPublishedRadius && point.method.find("float") == std::string::npos &&
         point.depth_mode != DepthMode::fixed;
}

// As the method asks for it: "cullide @4px".
double mean_pixels(const PointKey& point) {
  const std::size_t at = point.method.find('@');
  return at == std::string::npos ? 0 : std::strtod(point.method.c_str() + at + 1, nullptr);
}

Measurement made_up(const PointKey& point) {
  PointKey scene;  // what depends on the scene alone
  scene.scene = point.scene;
  scene.frame = point.frame;
  const std::uint64_t colliding = between(scene, "colliding", 2, 4);
  const int pixels = std::max(point.resolution, 64);
  const std::uint64_t missed =
      reliable(point) ? 0
                      : std::min<std::uint64_t>(colliding, 30000 / static_cast<unsigned>(pixels));
  const double violations = reliable(point) ? 0 : 1000.0 * unit(point, "violations");
  // Exact offsets keep what boxes keep, or less.
  PointKey boxes = point;
  if (point.method == "far") boxes.offset = "obb";
  const std::uint64_t kept = between(boxes, "kept", 1, 3) / (point.offset == "exact" ? 2 : 1);
  Measurement out;
  out.device = "made-up renderer";
  out.counts = {{"colliding", colliding},
                {"missed", missed},
                {"colliding_triangles", colliding / 2},
                {"missed_triangles", missed / 2},
                {"wrong", reliable(point)       ? 0
                          : asks_library(point) ? colliding / 3
                                                : missed / 7},
                {"candidates", colliding + between(point, "candidates", 2, 4)},
                {"kept_triangles", colliding / 2 + kept},
                {"kept_objects", 2},
                {"object_triangles", colliding * 4},
                {"triangles", between(scene, "triangles", 4, 5)},
                {"objects", between(scene, "objects", 1, 3)},
                {"queries", between(point, "queries", 3, 5)},
                {"draws", between(point, "draws", 4, 6)},
                {"queries_saved", 10},
                {"draws_saved", 10},
                {"radius_px", 0.75},
                {"pixel_size", 0.01},
                {"left_by_boxes", colliding / 2 + kept},
                {"views_used", point.resolution > 0 ? 3 : 0},
                {"at_risk", colliding / 3},
                {"at_risk_bare", colliding / 2},
                {"promises", reliable(point)},
                {"scene_hash", "0123456789abcdef"},
                {"elements", between(point, "elements", 3, 4)},
                {"covered", between(point, "covered", 3, 4)},
                {"fragments", between(point, "fragments", 4, 6)},
                {"tests", between(point, "tests", 3, 5)},
                {"views", 3},
                {"points", 10000},
                {"violations", static_cast<std::uint64_t>(violations)},
                {"no_sample", static_cast<std::uint64_t>(violations / 3)},
                {"not_bounding", static_cast<std::uint64_t>(violations / 3)},
                {"rounded", static_cast<std::uint64_t>(violations / 3)},
                {"largest_px", violations > 0 ? unit(point, "largest") : 0.0},
                {"largest_steps", violations > 0 ? 2 * unit(point, "largest") : 0.0},
                {"placements", 1000},
                {"colliding_placements", 900},
                {"missed_placements", reliable(point) ? 0 : missed % 5},
                {"corner_px", 0.004},
                {"corner_cosine", 0.996},
                {"largest_miss_px", reliable(point) ? 0.0 : unit(point, "miss")},
                // Of the model, whose predictions are up to a third too large.
                {"positions", 4},
                {"missed_in_all", 4 * missed},
                {"missed_least", missed - missed / 9},
                {"missed_most", missed + missed / 9},
                {"expected", static_cast<double>(missed) * (1 + unit(point, "expected") / 3)},
                {"low", 0.5 * static_cast<double>(missed)},
                {"high", 1.5 * static_cast<double>(missed)},
                {"outside", 0},
                {"resolution", 200},
                {"mean_pixels", mean_pixels(point)},
                {"step_px", 0.001},
                {"budget_px", 0.75},
                // Of the cloth: it falls, and every step converges.
                {"total", 1.0 / (2.0 + static_cast<double>(point.frame))},
                {"slack", 1e-12},
                {"residual", 1e-6},
                {"iterations", between(scene, "iterations", 0, 2)},
                {"converged", true},
                {"accounted", 1'000'000},
                {"self_objects", 1},
                {"pixels_tenth", 0.1},
                {"pixels_half", between(scene, "pixels", 0, 3)},
                {"pixels_ninety", 2000.5},
                // Of potential neighbour sets, and of distances.
                {"with_nearest", colliding},
                {"nearest_pairs", colliding},
                {"missed_pairs", missed},
                {"object_pairs", 2 * colliding},
                {"triangle_pairs", 9 * kept},
                {"set_objects", 4 * colliding},
                {"median_objects", 3},
                {"most_objects", 20},
                {"set_triangles", kept * colliding},
                {"median_triangles", kept},
                {"most_triangles", 8 * kept},
                {"asked", colliding},
                {"answers", colliding},
                {"exact", colliding},
                {"lacking", 0},
                {"other_zero", 0},
                {"other_object", 0},
                {"largest_relative", asks_library(point) ? 1e-15 * unit(point, "error") : 0.0}};
  if (const std::size_t slash = point.scene.find('/'); slash != std::string::npos) {
    // Of a contestant: one part of its scores, as experiments/report/chapters/libraries.py reads
    // it.
    const std::string kind = point.scene.substr(slash + 1);
    nlohmann::json part = {kind == "pair"   ? "pairs/random"
                           : kind == "mesh" ? "meshes/some"
                                            : kind + "/all",
                           "0", "crossing", colliding, missed};
    for (int k = 2; k < 22; ++k) part.push_back(k == 13 ? colliding : 0);  // all are answered
    part.insert(part.end(), {0, 1e6, ""});
    out.counts["scores"] = nlohmann::json{part}.dump();
    out.counts["library"] = "x 1";
    out.counts["means"] = "closed";
  }
  const double ms = 0.5 * std::pow(10, 3 * unit(point, "ms"));
  out.times = {
      {"cull", ms}, {"exact", ms / 10}, {"build", ms / 10}, {"total", 1.1 * ms}, {"setup", 1.0}};
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> runs;
    for (int i = 3 * round; i < 3 * round + 3; ++i)
      runs.push_back(1.1 * ms * (0.9 + 0.2 * unit(point, "run" + std::to_string(i))));
    out.times["rounds"].push_back({{"ms", runs}, {"load", 0.01}, {"void", false}});
  }
  return out;
}

int make(const std::string& folder, const std::string& part) {
  std::filesystem::create_directories(folder);
  const bool shard = part == "shard";
  Store store(shard ? store_path(folder, 1, 2) : store_path(folder), Store::Access::write);
  Provenance provenance;
  provenance.started = "2001-02-03T04:05:06Z";
  provenance.commit = "made-up";
  provenance.gl_vendor = "made-up vendor";
  provenance.gl_renderer = "made-up renderer";
  provenance.gl_version = "4.5 <made-up> & \"quoted\"";
  provenance.cpu = "made-up processor";
  provenance.cpu_features = "fpu sse sse2 avx avx2";
  provenance.cores = 2;
  provenance.options = R"({"quick": true})";
  const std::int64_t run = store.begin_run(provenance);
  for (const Study& study : studies()) {
    Declaration declaration;
    declaration.study = part == "foreign" ? "unheard-of" : study.name;
    declaration.choice = {.quick = true, .seed = 1};
    if (shard) declaration.of = 2;
    declaration.points = keys_of(study.grid(declaration.choice));
    store.declare(declaration);
    bool broken = part != "broken";
    store.together([&] {
      for (std::size_t i = 0; i < declaration.points.size(); ++i) {
        if (part == "some" && i % 3 != 0) continue;
        if (shard && i % 2 != 0) continue;
        Measurement measurement = made_up(declaration.points[i]);
        // As a machine without the packaged meshes has it.
        if (declaration.points[i].scene == "mannequin-devil") {
          measurement = {};
          measurement.left_out = "the packaged meshes are not there <made-up>";
        }
        if (!broken && measurement.counts.value("promises", false)) {
          measurement.counts["missed"] = 1;
          measurement.counts["violations"] = 1;
          broken = true;
        }
        if (part == "unconverged" && i == 0 && declaration.study == "cloth")
          measurement.counts["converged"] = false;
        store.add(declaration.study, run, i, measurement);
      }
    });
    if (part == "foreign") break;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fputs("usage: farcull_report_fixture DIR [some|shard|foreign|broken|unconverged]\n",
               stderr);
    return 2;
  }
  try {
    return make(argv[1], argc > 2 ? argv[2] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
