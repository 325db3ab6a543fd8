// How many nearest neighbours the discrete Voronoi diagram loses, against its resolution: the
// tables of docs/results/voronoi.md. The truth of drawn scenes is computed in rationals, that of
// built-in ones as experiments/measure/neighbour_sets.h says.
//   farcull_voronoi_losses SCENES LARGEST [NAME...]
// SCENES: of each kind, drawn with the seeds 0, 1, ...; LARGEST: cells along the longest side, from
// 64 in doublings; NAME: of built-in scenes. Exits with 1 if the reliable form loses a neighbour.
#include <cinttypes>

#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "experiments/measure/neighbour_sets.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/voronoi.h"

namespace farcull {
namespace {

struct Sums {
  lab::Losses published, reliable;
  std::uint64_t pairs_of_objects = 0, named = 0, kept = 0;
  std::uint64_t pairs_of_triangles = 0, kept_triangles = 0;
  double published_ms = 0, reliable_ms = 0;
};

void add(const Scene& scene, const std::vector<exact_distance::Nearest>& truth, int resolution,
         Sums& sums) {
  const Stopwatch first;
  const VoronoiNeighbours published = voronoi_neighbours(scene, {.resolution = resolution});
  sums.published_ms += first.ms();
  const Stopwatch second;
  const VoronoiNeighbours reliable = reliable_neighbours(scene, {.resolution = resolution});
  sums.reliable_ms += second.ms();
  lab::count_losses(scene, truth, published.objects, sums.published);
  lab::count_losses(scene, truth, reliable.objects, sums.reliable);
  const std::uint64_t objects = scene.objects.size(), triangles = scene.triangles.size();
  sums.pairs_of_objects += objects * (objects - 1) / 2;
  sums.pairs_of_triangles += triangles * (triangles - 1) / 2;
  for (const Object& object : scene.objects) {
    const std::uint64_t own = object.triangle_count;
    sums.pairs_of_triangles -= own > 0 ? own * (own - 1) / 2 : 0;
  }
  sums.named += published.objects.size();
  sums.kept += reliable.objects.size();
  sums.kept_triangles += reliable.triangles.size();
}

// Returns how many neighbours the reliable form lost.
std::uint64_t drawn_table(std::uint64_t scenes, int largest) {
  const char* const kNames[lab::kNeighbourKinds] = {
      "any size", "segments and points", "needles", "sheets", "clusters", "copies"};
  std::printf(
      "| drawn scenes | cells | objects | lost, published | lost, reliable | pairs of objects | "
      "published | reliable | pairs of triangles | reliable | ms, published | ms, reliable |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  std::uint64_t lost = 0;
  for (int kind = 0; kind < lab::kNeighbourKinds; ++kind) {
    for (int resolution = 64; resolution <= largest; resolution *= 2) {
      Sums s;
      for (std::uint64_t seed = 0; seed < scenes; ++seed) {
        const Scene scene = lab::neighbours_scene(seed, kind);
        add(scene, exact_distance::nearest_neighbours(scene), resolution, s);
      }
      std::printf("| %s | %d | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %" PRIu64
                  " | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %.2f | %.2f |\n",
                  kNames[kind], resolution, s.published.objects, s.published.lost, s.reliable.lost,
                  s.pairs_of_objects, s.named, s.kept, s.pairs_of_triangles, s.kept_triangles,
                  s.published_ms / static_cast<double>(scenes),
                  s.reliable_ms / static_cast<double>(scenes));
      std::fflush(stdout);
      lost += s.reliable.lost;
    }
  }
  return lost;
}

std::uint64_t scene_table(const std::vector<std::string>& names, int largest) {
  std::printf(
      "| scene | cells | objects | lost, published | lost, reliable | published | reliable | "
      "triangles, reliable | ms, published | ms, reliable |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  std::uint64_t lost = 0;
  for (const std::string& name : names) {
    const Scene scene = make_builtin_scene(name);
    const std::vector<NearestObjects> truth = nearest_objects(scene);
    for (int resolution = 64; resolution <= largest; resolution *= 2) {
      double ms[2] = {};
      const auto measured = [&](NeighbourMethod method) {
        const Stopwatch watch;
        const NeighbourSets sets = diagram_sets(
            scene,
            {.method = method, .resolution = resolution, .most_pairs = VoronoiOptions{}.most_pairs},
            nullptr);
        ms[method == NeighbourMethod::voronoi_reliable] = watch.ms();
        return sizes_of(scene, sets, truth);
      };
      const NeighbourSizes published = measured(NeighbourMethod::voronoi);
      const NeighbourSizes reliable = measured(NeighbourMethod::voronoi_reliable);
      std::printf("| %s | %d | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %" PRIu64
                  " | %" PRIu64 " | %.0f | %.0f |\n",
                  name.c_str(), resolution, published.with_nearest, published.missed,
                  reliable.missed, published.object_pairs, reliable.object_pairs,
                  reliable.triangle_pairs, ms[0], ms[1]);
      std::fflush(stdout);
      lost += reliable.missed + reliable.missed_pairs;
    }
  }
  return lost;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  const long scenes = argc > 2 ? std::strtol(argv[1], nullptr, 10) : -1;
  const long largest = argc > 2 ? std::strtol(argv[2], nullptr, 10) : 0;
  if (scenes < 0 || largest < 64 || largest > farcull::kVoronoiLargest) {
    std::fprintf(stderr,
                 "farcull_voronoi_losses SCENES LARGEST [NAME...]: scenes of each kind; "
                 "cells along the longest side, 64 or more; built-in scenes\n");
    return 2;
  }
  const farcull::FloatingPointGuard guard;
  std::uint64_t lost = 0;
  if (scenes > 0)
    lost += farcull::drawn_table(static_cast<std::uint64_t>(scenes), static_cast<int>(largest));
  if (argc > 3) lost += farcull::scene_table({argv + 3, argv + argc}, static_cast<int>(largest));
  return lost == 0 ? 0 : 1;
}
