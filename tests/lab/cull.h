// What the tests of the CULLIDE family share: scenes of many small objects that shrink well, runs
// that remember every step, and the pixel-exact sense in which raw triangles collide.
#pragma once

#include <fmt/format.h>
#include <rapidcheck.h>

#include "core/cull/cull.h"
#include "offsets/offsets.h"
#include "tests/lab/scenes.h"
#include "verify/exact.h"
#include "verify/worst_canvas.h"

namespace farcull::lab {

/// A small triangle of one of twelve objects, on a grid, so that contacts and equal depths happen.
struct Small {
  int object;               // 0 .. 11
  std::array<int, 3> at;    // -5 .. 5 eighths
  std::array<int, 6> span;  // -4 .. 4 eighths, of two edges
};

inline rc::Gen<std::vector<Small>> small_triangles() {
  const auto one =
      rc::gen::map(rc::gen::tuple(rc::gen::inRange(0, 12),
                                  rc::gen::container<std::array<int, 3>>(rc::gen::inRange(-5, 6)),
                                  rc::gen::container<std::array<int, 6>>(rc::gen::inRange(-4, 5))),
                   [](const std::tuple<int, std::array<int, 3>, std::array<int, 6>>& t) {
                     return Small{std::get<0>(t), std::get<1>(t), std::get<2>(t)};
                   });
  return rc::gen::container<std::vector<Small>>(one);
}

/// Two more objects, of points, span the cube, so that every triangle is in a region.
inline Scene scene_of(const std::vector<Small>& triangles, bool self = false) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects(14);
  for (const Small& s : triangles) {
    std::array<Vec3, 3> t;
    for (int k = 0; k < 3; ++k) t[0][k] = s.at[k] * 0.125;
    for (int e = 0; e < 2; ++e)
      for (int k = 0; k < 3; ++k) t[1 + e][k] = t[0][k] + s.span[3 * e + k] * 0.125;
    objects[s.object].push_back(t);
  }
  for (int o = 12; o < 14; ++o) {
    const double x = o == 12 ? 1.125 : -1.125;
    objects[o] = {{Vec3(x, -1.125, -1.125), Vec3(x, -1.125, -1.125), Vec3(x, -1.125, -1.125)},
                  {Vec3(-x, 1.125, 1.125), Vec3(-x, 1.125, 1.125), Vec3(-x, 1.125, 1.125)}};
  }
  Scene scene = scene_of(objects);
  for (Object& object : scene.objects) object.self = self;
  return scene;
}

/// The same for runs without rapidcheck: `count` triangles by the seed.
inline std::vector<Small> random_small(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<Small> out(count);
  for (Small& s : out) {
    s.object = random.below(12);
    for (int& x : s.at) x = random.below(11) - 5;
    for (int& x : s.span) x = random.below(9) - 4;
  }
  return out;
}

/// Checks a property on `tests` inputs that grow to 60 elements, and on as many again until `seen`.
template <class Property, class Seen>
void expect_property(std::uint64_t seed, int tests, const Property& property, const Seen& seen) {
  for (std::uint64_t n = 0; more_cases(n, 1, seen()); ++n) {
    rc::detail::TestParams params;
    params.seed = test_seed(seed) + n;
    params.maxSuccess = tests;
    params.maxSize = 60;
    const auto result = rc::detail::checkTestable(property, rc::detail::TestMetadata{}, params);
    if (result.template is<rc::detail::SuccessResult>()) continue;
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    FAIL() << text.str();
  }
}

/// A primitive and a canvas for it.
struct Drawing {
  Fattener fattener;
  std::shared_ptr<Canvas> canvas;
};
inline Drawing raw_on_ideal(CanvasFault fault = CanvasFault::none) {
  const Fattener raw = raw_triangles();
  return {raw, std::make_shared<IdealCanvas>(raw.solid, fault)};
}
inline Drawing on_worst(const Fattener& fattener) {
  return {fattener, std::make_shared<WorstCanvas>(fattener.solid)};
}

struct StepRecord {
  std::string name;
  std::vector<std::uint8_t> bits;
  std::uint64_t draws, queries, draws_saved, queries_saved;
};

struct Trace {
  CullResult result;
  std::vector<StepRecord> steps;

  std::uint64_t draws() const { return steps.empty() ? 0 : steps.back().draws; }
  std::uint64_t queries() const { return steps.empty() ? 0 : steps.back().queries; }
};

inline CullSettings cull_settings(const Drawing& drawing, const std::string& views,
                                  int resolution) {
  CullSettings settings;
  settings.views = parse_views(views);
  settings.resolution = resolution;
  settings.fattener = drawing.fattener;
  return settings;
}

inline Trace run_by(const PassRule& rule, const Scene& scene, const Drawing& drawing,
                    CullSettings settings) {
  Trace run;
  settings.watch = [&](const CullStep& s) {
    const std::string name = fmt::format("level {}, {}, round {}, {} pass", s.level, s.view,
                                         s.round, s.first_pass ? "first" : "second");
    run.steps.push_back({name, s.bits, s.draws, s.queries, s.draws_saved, s.queries_saved});
  };
  run.result =
      cull_by(rule, scene, find_regions(scene, {.self = settings.self}), settings, *drawing.canvas);
  return run;
}

/// Whether b has all bits of a.
inline bool contains(const std::vector<std::uint8_t>& b, const std::vector<std::uint8_t>& a) {
  for (std::size_t t = 0; t < a.size(); ++t)
    if (a[t] & ~b[t]) return false;
  return true;
}

/// The first step of plain CULLIDE at which Quick-CULLIDE is behind in what it cleared, or ahead in
/// what it drew or asked; empty: none. Where Quick-CULLIDE has ended, its last step stands.
inline std::string first_step_behind(const Trace& quick, const Trace& plain) {
  for (std::size_t i = 0; i < plain.steps.size(); ++i) {
    if (quick.steps.empty()) return plain.steps[i].name;
    const StepRecord& p = plain.steps[i];
    const StepRecord& q = quick.steps[std::min(i, quick.steps.size() - 1)];
    if (i < quick.steps.size() && q.name != p.name) return "schedules part at " + p.name;
    if (!contains(q.bits, p.bits) || q.draws > p.draws || q.queries > p.queries) return p.name;
  }
  return "";
}

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// Pairs u < t of different owners of which, in every view, each is seen behind (or at, where
/// touching counts) the other alone: what culling on this canvas must keep, whatever it promises of
/// space.
inline Pairs conflicts(const Scene& scene, const Drawing& drawing, const CullSettings& settings) {
  const Regions plan = find_regions(scene, {.self = settings.self});
  std::vector<std::uint32_t> object = owners(scene);
  const std::size_t n = plan.triangles.size();
  std::vector<std::vector<std::uint8_t>> both(n, std::vector<std::uint8_t>(n, 1));
  for (const View& view : settings.views) {
    const auto window =
        plan.places.empty() ? std::nullopt : fit_window(view, plan.places, settings.resolution);
    if (!window) continue;
    FattenCounts counts;
    const Budget budget = budget_for(drawing.canvas->limits(),
                                     viewport_side(std::max(window->width, window->height)));
    const Drawables drawables =
        fatten(scene, plan.triangles, *window, drawing.fattener,
               drawing.fattener.name == "raw" ? 0 : budget.radius(), counts);
    drawing.canvas->begin(*window, drawables);
    for (std::uint32_t u = 0; u < n; ++u) {
      Pass pass;
      pass.touching = settings.touching;
      add(pass.draws, drawables, u, 0);
      const auto middle = static_cast<std::uint32_t>(pass.draws.size());
      for (std::uint32_t t = 0; t < n; ++t) add(pass.draws, drawables, t, t);
      pass.slots = static_cast<std::uint32_t>(n);
      pass.steps = {{Verb::store, 0, middle},
                    {Verb::ask, middle, static_cast<std::uint32_t>(pass.draws.size()) - middle}};
      const std::vector<std::uint8_t> seen = drawing.canvas->run(pass);
      for (std::uint32_t t = 0; t < n; ++t) {
        both[u][t] &= seen[t];
        both[t][u] &= seen[t];
      }
    }
  }
  Pairs out;
  for (std::uint32_t u = 0; u < n; ++u) {
    for (std::uint32_t t = u + 1; t < n; ++t) {
      const std::uint32_t a = plan.triangles[u], b = plan.triangles[t];
      const bool apart = object[a] != object[b] || (settings.self && scene.objects[object[a]].self);
      if (apart && both[u][t]) out.emplace(a, b);
    }
  }
  return out;
}

/// The pairs that intersect exactly, neighbours left out.
inline Pairs collisions(const Scene& scene) {
  Pairs out;
  for (const TrianglePair& p : all_colliding_pairs(scene, {.threads = 1}).pairs)
    out.emplace(p.a, p.b);
  return out;
}

/// How many of `pairs` have F on the later or L on the earlier triangle, at any step.
inline int wrongly_cleared(const Trace& run, const Pairs& pairs) {
  int wrong = 0;
  for (const auto& [u, t] : pairs) {
    wrong += std::ranges::any_of(run.steps, [u = u, t = t](const StepRecord& s) {
      return (s.bits[t] & kF) || (s.bits[u] & kL);
    });
  }
  return wrong;
}

}  // namespace farcull::lab
