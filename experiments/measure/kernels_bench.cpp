// farcull_kernels_bench [SCENE...] times single kernels by Google Benchmark. Inputs are drawn with
// a fixed seed, or come from the built-in scenes that are named.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "core/boxes/oriented.h"
#include "core/boxes/search.h"
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

// Times boxes and the exact tests on one frame, in one thread; `range` percent of the vertices
// moved since the previous frame. remembers: uses data kept from the previous frame.
void frame(benchmark::State& state, const char* name, bool self, bool remembers) {
  Scene scene = make_builtin_scene(name);
  for (Object& object : scene.objects) object.self = self;
  const auto moving = scene.vertices.size() * static_cast<std::size_t>(state.range(0)) / 100;
  const BoxesSettings settings{.neighbours = false};
  const ExactQuestion question{.threads = 1, .neighbours = false};
  FrameMemory kept;
  FrameDecider decider;
  double by = 1e-4;
  std::size_t pairs = 0;
  const auto show = [&] {
    FrameMemory* memory = remembers ? &kept : nullptr;
    if (remembers) memory->moved.update(scene);
    const BoxesPlan plan = plan_boxes(scene, settings, 1, memory);
    const auto found = find_boxes(scene, plan, memory).candidates;
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

// ---- Kernels of scenes: the least that a stage of boxes does for one of its items
// (experiments/report/floors.py). All but read_triangles() use a part of the scene that stays in
// caches.

/// A scene, and what boxes finds in it.
struct Prepared {
  Scene scene;
  BoxesPlan plan;
  std::vector<TrianglePair> candidates;
};
const Prepared& prepared(const std::string& name) {
  static std::map<std::string, Prepared> all;
  const auto [at, is_new] = all.try_emplace(name);
  Prepared& out = at->second;
  if (!is_new) return out;
  out.scene = make_builtin_scene(name);
  out.plan = plan_boxes(out.scene, {.neighbours = false}, 1);
  out.candidates = find_boxes(out.scene, out.plan).candidates;
  return out;
}

/// At most `count` items of the list, as stretches that lie evenly in it.
template <class Item>
std::vector<Item> some_of(const std::vector<Item>& list, std::size_t count) {
  constexpr std::size_t kStretches = 16;
  if (list.size() <= count) return list;
  std::vector<Item> out;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const auto from = list.begin() + static_cast<std::ptrdiff_t>(list.size() * k / kStretches);
    out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(count / kStretches));
  }
  return out;
}

void set_items(benchmark::State& state, std::size_t of_each) {
  if (of_each == 0) state.SkipWithError("the scene has no such item");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(of_each));
}

// Reads all triangles of the scene, in the order of the file. An item is a triangle.
void read_triangles(benchmark::State& state, const std::string& name) {
  const Scene& scene = prepared(name).scene;
  for (auto _ : state) {
    Corners sum = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (const auto& [i, j, k] : scene.triangles) {
      sum[0] += scene.vertices[i];
      sum[1] += scene.vertices[j];
      sum[2] += scene.vertices[k];
    }
    benchmark::DoNotOptimize(sum);
  }
  set_items(state, scene.triangles.size());
}

// Makes boxes of triangles in lanes. An item is a triangle.
void box_triangles(benchmark::State& state, const std::string& name) {
  const Scene& scene = prepared(name).scene;
  std::vector<std::uint32_t> all(scene.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<std::uint32_t> some = some_of(all, kCount);
  const std::size_t blocks = some.size() / kWide;
  UninitializedVector<BlockLanes> lanes(blocks);
  for (auto _ : state) {
    for (std::size_t k = 0; k < blocks; ++k)
      fill_lanes(scene, std::span(some).subspan(k * kWide, kWide), 0, Vec3::Zero(), lanes[k]);
    benchmark::ClobberMemory();
  }
  set_items(state, blocks * kWide);
}

// Sorts as many codes as the scene has blocks that meet others. An item is a code.
void order_blocks(benchmark::State& state, const std::string& name) {
  struct Coded {
    std::uint32_t code, block;
  };
  Random random(6);
  std::vector<Coded> given(prepared(name).plan.decision.blocks.triangles / kWide);
  for (Coded& one : given)
    one = {static_cast<std::uint32_t>(random.below(1 << 24)),
           static_cast<std::uint32_t>(&one - given.data())};
  std::vector<Coded> now(given.size()), next(given.size());
  for (auto _ : state) {
    const std::vector<Coded>* from = &given;
    for (int shift = 0; shift < 24; shift += 8) {
      std::array<std::uint32_t, 257> first{};
      const auto digit = [&](const Coded& one) { return one.code >> shift & 255; };
      for (const Coded& one : *from) ++first[digit(one) + 1];
      std::partial_sum(first.begin(), first.end(), first.begin());
      for (const Coded& one : *from) next[first[digit(one)]++] = one;
      now.swap(next);
      from = &now;
    }
    benchmark::DoNotOptimize(now.data());
    benchmark::ClobberMemory();
  }
  set_items(state, given.size());
}

// As many pairs of blocks as boxes compares at a time.
constexpr std::size_t kBlockPairs = 2048;

// Compares the boxes of the triangles of pairs of blocks. An item is a pair of blocks.
void compare_block_pairs(benchmark::State& state, const std::string& name) {
  const auto& [scene, plan, candidates] = prepared(name);
  const BlockPairs& all = plan.decision.blocks.pairs;
  BlockPairs some;
  const bool inside = all.inside.size() > all.between.size();
  (inside ? some.inside : some.between) = some_of(inside ? all.inside : all.between, kBlockPairs);
  if (plan.decision.blocks.oriented) {
    for (auto _ : state) {
      give_pairs_of_oriented(
          scene, *plan.decision.blocks.oriented, some, 0, false, 1,
          [](std::vector<TrianglePair>& found) { benchmark::DoNotOptimize(found.data()); });
    }
    return set_items(state, some.size());
  }
  if (some.size() == 0) return set_items(state, 0);
  const TriangleBlocks& blocks = *plan.decision.blocks.of;
  const std::vector<std::uint32_t> used = blocks_in(some, blocks.ranges.size());
  UninitializedVector<BlockLanes> lanes(used.size());
  UninitializedVector<VertexBlock> vertices(used.size());
  for (std::size_t k = 0; k < used.size(); ++k) {
    const TriangleBlock& range = blocks.ranges[used[k]];
    std::vector<std::uint32_t> own(range.count);
    vertices[k] = {};
    for (std::uint32_t i = 0; i < range.count; ++i) {
      own[i] = blocks.triangle(range.first + i);
      for (std::size_t c = 0; c < 3; ++c) vertices[k].corner[c][i] = scene.triangles[own[i]][c];
    }
    fill_lanes(scene, own, 0, blocks.origin, lanes[k]);
  }
  const auto place = [&](std::uint32_t block) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(used, block) - used.begin());
  };
  std::vector<LanePair> pairs;
  for (const BlockPair& pair : inside ? some.inside : some.between)
    pairs.push_back({place(pair.a), place(pair.b), inside});
  BlockFindings found;
  for (auto _ : state) {
    found.pairs.clear();
    found.perhaps.clear();
    compare_blocks({.first = lanes, .second = {}}, vertices, pairs, found);
    benchmark::DoNotOptimize(found.pairs.data());
  }
  set_items(state, pairs.size());
}

// Compares the box of a block with the sixteen boxes of another one that lies apart.
void compare_apart(benchmark::State& state) {
  UninitializedVector<BlockLanes> lanes(2);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto at = static_cast<float>(2 * k);
    lanes[k].bound = {{at, 0, 0, 0}, {at + 1, 1, 1, 0}};
    for (std::size_t lane = 0; lane < kWide; ++lane) lanes[k].boxes.set(lane, lanes[k].bound);
  }
  const std::vector<LanePair> pairs(kBlockPairs, {0, 1, false});
  BlockFindings found;
  for (auto _ : state) compare_blocks({.first = lanes, .second = {}}, {}, pairs, found);
  set_items(state, pairs.size());
}

// Filters candidates. An item is a candidate.
void filter_candidates(benchmark::State& state, const std::string& name) {
  const Prepared& of = prepared(name);
  const std::vector<TrianglePair> some = some_of(of.candidates, kCount);
  std::vector<Triage> answers(some.size());
  for (auto _ : state) {
    filter_pairs(of.scene, some, 0, answers);
    benchmark::ClobberMemory();
  }
  set_items(state, some.size());
}

void register_kernels(const std::string& name) {
  const auto add = [&](const std::string& kernel, auto* run) {
    benchmark::RegisterBenchmark((kernel + "/" + name).c_str(),
                                 [=](benchmark::State& state) { run(state, name); });
  };
  add("read_triangles", read_triangles);
  add("box_triangles", box_triangles);
  add("order_blocks", order_blocks);
  add("compare_block_pairs", compare_block_pairs);
  add("filter_candidates", filter_candidates);
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc > 1) benchmark::RegisterBenchmark("compare_apart", farcull::compare_apart);
  for (int k = 1; k < argc; ++k) farcull::register_kernels(argv[k]);
  benchmark::RunSpecifiedBenchmarks();
}
