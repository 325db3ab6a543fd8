// farcull_kernels_bench times single kernels by Google Benchmark. Inputs are drawn with a fixed
// seed.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/pairs/backend.h"
#include "core/pairs/grid.h"
#include "core/pairs/pairs.h"
#include "experiments/peers/peer.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "offsets/offsets.h"
#include "verify/exact.h"
#include "verify/filter.h"

namespace farcull {
namespace {

using shapes::Corners;
using shapes::Random;

constexpr std::size_t kCount = 1024;  // inputs that a case uses in turn, again and again

// Triangles of about `size` around places in a cube of the given half side.
std::vector<Corners> triangles(double half, double size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Corners> all(kCount);
  for (Corners& corners : all) {
    const Vec3 centre = random.in_cube(half);
    for (Vec3& p : corners) p = centre + size * random.in_ball();
  }
  return all;
}

interval::vec4 pixel_vertex(const Vec3& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0};
}

// Times all work for a triangle of some pixels: its bounds, a strip for each row, depths for each
// pixel. An item is the interval of depths of a pixel.
void interval_kernel(benchmark::State& state) {
  const std::vector<Corners> all = triangles(64, static_cast<double>(state.range(0)), 1);
  const interval::vec4 widen = {1e-4f, 1e-4f, 1e-4f, 0};
  std::size_t at = 0;
  std::int64_t intervals = 0;
  for (auto _ : state) {
    const Corners& corners = all[at++ % kCount];
    const interval::vec4 a = pixel_vertex(corners[0]);
    const interval::vec4 b = pixel_vertex(corners[1]);
    const interval::vec4 c = pixel_vertex(corners[2]);
    interval::vec4 lo, hi;
    interval::far_bounds(a, b, c, widen, lo, hi);
    const interval::vec4 margin = interval::far_margin(lo, hi, widen);
    for (float y = std::floor(lo.y); y <= hi.y; ++y) {
      interval::FarStrip strip;
      interval::far_strip(a, b, c, y - margin.y, y + 1 + margin.y, strip);
      for (float x = std::floor(lo.x); x <= hi.x; ++x) {
        float near, far;
        bool some = interval::far_depths(strip, x - margin.x, x + 1 + margin.x, near, far);
        benchmark::DoNotOptimize(some);
        benchmark::DoNotOptimize(near);
        benchmark::DoNotOptimize(far);
        ++intervals;
      }
    }
  }
  state.SetItemsProcessed(intervals);
}
BENCHMARK(interval_kernel)->Arg(1)->Arg(4)->Arg(16);

// Times where a line through the middle of a triangle enters and leaves the triangle's solid.
void solid_kernel(benchmark::State& state, const Fattener& fattener,
                  Solid (*solid_of)(const Corners&)) {
  std::vector<Solid> solids;
  const std::vector<Corners> all = triangles(64, 4, 2);
  for (const Corners& corners : all) solids.push_back(solid_of(corners));
  std::size_t at = 0;
  for (auto _ : state) {
    const std::size_t i = at++ % kCount;
    const Vec3 middle = (all[i][0] + all[i][1] + all[i][2]) / 3;
    float entry = 0, exit = 0;
    bool hit = fattener.solid.interval(static_cast<float>(middle.x()),
                                       static_cast<float>(middle.y()), solids[i], entry, exit);
    benchmark::DoNotOptimize(hit);
    benchmark::DoNotOptimize(entry);
    benchmark::DoNotOptimize(exit);
  }
  state.SetItemsProcessed(state.iterations());
}
Solid obb_solid(const Corners& corners) { return obb_of(corners, 0.75); }
Solid exact_solid(const Corners& corners) {
  return minkowski_solid(corners[0], corners[1], corners[2], 0.75);
}
BENCHMARK_CAPTURE(solid_kernel, obb, obb_fattener(), obb_solid);
BENCHMARK_CAPTURE(solid_kernel, exact, minkowski_fattener(), exact_solid);

// Times making the solid of a triangle.
void fatten_kernel(benchmark::State& state, Solid (*solid_of)(const Corners&)) {
  const std::vector<Corners> all = triangles(64, 4, 3);
  std::size_t at = 0;
  for (auto _ : state) benchmark::DoNotOptimize(solid_of(all[at++ % kCount]));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(fatten_kernel, obb, obb_solid);
BENCHMARK_CAPTURE(fatten_kernel, exact, exact_solid);

// Times deciding pairs of triangles of about size 1 at random places in a cube of side `range`: at
// 0 most pairs collide, at 4 few do.
template <class Decide>
void pair_kernel(benchmark::State& state, const Decide& decide) {
  const double half = static_cast<double>(state.range(0)) / 2;
  const std::vector<Corners> first = triangles(half, 1, 4);
  const std::vector<Corners> second = triangles(half, 1, 5);
  std::size_t at = 0;
  std::int64_t yes = 0;
  for (auto _ : state) {
    const std::size_t i = at++ % kCount;
    const auto answer = decide(first[i], second[i]);
    benchmark::DoNotOptimize(answer);
    yes += static_cast<int>(answer) == 1;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["yes"] =
      benchmark::Counter(static_cast<double>(yes), benchmark::Counter::kAvgIterations);
}
void filter_alone(benchmark::State& state) {
  pair_kernel(state, [](const Corners& a, const Corners& b) { return filter_planes(a, b); });
}
void exact_with_filter(benchmark::State& state) {
  pair_kernel(state, [](const Corners& a, const Corners& b) { return intersects(a, b); });
}
void exact_without_filter(benchmark::State& state) {
  pair_kernel(state, [](const Corners& a, const Corners& b) { return cgal_do_intersect(a, b); });
}
BENCHMARK(filter_alone)->Arg(0)->Arg(1)->Arg(4);
BENCHMARK(exact_with_filter)->Arg(0)->Arg(1)->Arg(4);
BENCHMARK(exact_without_filter)->Arg(0)->Arg(1)->Arg(4);

// Times far-pairs and the exact tests on one frame, in one thread; `range` percent of the vertices
// moved since the previous frame. remembers: uses data kept from the previous frame.
void frame(benchmark::State& state, const char* name, bool self, bool remembers) {
  Scene scene = make_builtin_scene(name);
  for (Object& object : scene.objects) object.self = self;
  const auto moving = scene.vertices.size() * static_cast<std::size_t>(state.range(0)) / 100;
  const auto backend = cpu_pair_backend(1);
  const PairSettings settings{.neighbours = false};
  const ExactQuestion question{.threads = 1, .neighbours = false};
  PairWorkspace workspace;
  FrameDecider decider;
  double by = 1e-4;
  std::size_t pairs = 0;
  const auto show = [&] {
    PairMemory* memory = remembers ? &workspace.memory : nullptr;
    if (remembers) memory->moved.update(scene);
    const PairPlan plan = plan_pairs(scene, settings, 1, memory);
    const auto found = find_pairs(scene, plan, *backend, workspace).candidates;
    pairs = (remembers ? decider.decide(scene, found, memory->moved, question)
                       : decide(scene, found, question))
                .pairs.size();
  };
  show();
  show();
  for (auto _ : state) {
    state.PauseTiming();
    for (std::size_t v = 0; v < moving; ++v) scene.vertices[v].x() += by;
    by = -by;
    state.ResumeTiming();
    show();
  }
  state.counters["pairs"] = static_cast<double>(pairs);
}
void percents(benchmark::internal::Benchmark* frames) {
  for (const int percent : {0, 1, 10, 100}) frames->Arg(percent);
  frames->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(frame, crumpled_by_itself, "crumpled", true, false)->Apply(percents);
BENCHMARK_CAPTURE(frame, crumpled_next, "crumpled", true, true)->Apply(percents);
BENCHMARK_CAPTURE(frame, spheres_by_itself, "spheres", false, false)->Apply(percents);
BENCHMARK_CAPTURE(frame, spheres_next, "spheres", false, true)->Apply(percents);

}  // namespace
}  // namespace farcull

BENCHMARK_MAIN();
