// The lemmas as properties that every canvas has to pass, and twins that must fail. One suite for
// all canvases.
#pragma once

#include "experiments/lemma/lemma.h"
#include "offsets/offsets.h"
#include "tests/lab/canvas.h"
#include "verify/exact.h"

namespace farcull::lab {

constexpr std::uint64_t kSeed = 20040711;

inline std::vector<Fattener> fatteners() { return {obb_fattener(), minkowski_fattener()}; }

inline std::vector<LemmaRow> lemma_rows(const MakeCanvas& make, const Fattener& fattener,
                                        std::uint64_t points, bool displace,
                                        std::function<double(const Budget&, double)> radius,
                                        std::uint64_t seed = kSeed) {
  LemmaSettings settings;
  settings.points = points;
  settings.seed = seed;
  settings.displace = displace;
  settings.radius = std::move(radius);
  return lemma_experiment(*make(fattener), fattener, settings);
}

/// The radius with one term of the budget taken away.
inline double radius_without(const std::string& term, Budget b) {
  (term == "sampling" ? b.sampling
   : term == "input"  ? b.input
   : term == "double" ? b.double_
   : term == "vertex" ? b.vertex
                      : b.snap) = 0;
  return b.radius();
}

/// Lemmas 1 and 2: no point of any generator is violated at the budget radius, for both offsets,
/// also where double arithmetic displaces by all it may.
inline void expect_lemmas(const MakeCanvas& make, std::uint64_t points) {
  for (const Fattener& fattener : fatteners()) {
    for (const bool displace : {false, true}) {
      const auto budget = [](const Budget& b, double) { return b.radius(); };
      for (const LemmaRow& row :
           lemma_rows(make, fattener, points, displace, budget, test_seed(kSeed))) {
        SCOPED_TRACE(fattener.name + ", " + row.generator);
        EXPECT_GE(row.points, points / lemma_generators().size());
        EXPECT_EQ(row.no_sample, 0u);
        EXPECT_EQ(row.not_bounding, 0u);
      }
    }
  }
}

/// The twin: with the term gone, some point of the experiment is violated. Eighths of the points
/// are tried until one is.
inline void expect_term_needed(const MakeCanvas& make, const std::string& term,
                               std::uint64_t points) {
  for (const Fattener& fattener : fatteners()) {
    const auto without = [&term](const Budget& b, double) { return radius_without(term, b); };
    SCOPED_TRACE(term + ", " + fattener.name);
    std::uint64_t violations = 0;
    for (std::uint64_t part = 0; more_cases(part, 0, violations > 0, 100); ++part)
      violations = lemma_total(lemma_rows(make, fattener, points / 8, true, without, kSeed + part))
                       .violations();
  }
}

/// The twin of displacing each corner by itself: a fattener that moves a patch back by the error of
/// its first corner, for which the term "double" would be superfluous if all corners erred alike.
/// Where errors turn edges, points are lost; where each corner is moved back, none is. The corners
/// of this generator are next to whole numbers, so that a fraction tells the error.
inline void expect_turned_edges_noticed(const MakeCanvas& make, std::uint64_t points) {
  for (const Fattener& fattener : fatteners()) {
    for (const bool each : {false, true}) {
      Fattener undone = fattener;
      undone.fatten_inside = nullptr;
      undone.fatten = [fattener, each](const Patch& patch, double radius, const ProxyBounds& bounds,
                                       Drawables& out) {
        Patch back = patch;
        for (int i = 0; i < patch.count; ++i) {
          for (int k = 0; k < 2; ++k) {
            const double x = patch.corners[each ? i : 0][k];
            back.corners[i][k] -= std::copysign(kMaxDoubleError, x - std::round(x));
          }
        }
        fattener.fatten(back, radius, bounds, out);
      };
      LemmaSettings settings;
      settings.points = points;
      settings.generator = "exact pixel corners";
      settings.seed = kSeed;
      settings.displace = true;
      settings.radius = [](const Budget& b, double) { return radius_without("double", b); };
      const LemmaRow row = lemma_experiment(*make(undone), undone, settings).at(0);
      EXPECT_EQ(row.violations() > 0, !each)
          << fattener.name << ", " << row.violations() << " of " << row.points;
    }
  }
}

inline double violation_rate(const MakeCanvas& make, const std::string& generator,
                             std::function<double(const Budget&, double)> radius) {
  for (const LemmaRow& row : lemma_rows(make, obb_fattener(), 20'000, false, radius))
    if (row.generator == generator)
      return static_cast<double>(row.violations()) / static_cast<double>(row.points);
  ADD_FAILURE() << "no generator " << generator;
  return 0;
}

/// Pairs of triangles, one to a cell: store the first of each, ask the second; and the other way
/// round.
struct Pairs {
  std::vector<std::array<Vec3, 3>> first, second;
};

struct Seen {
  std::vector<std::uint8_t> forward, backward;
};

inline Seen ask_pairs(Canvas& canvas, const Fattener& fattener, const Pairs& pairs, const Window& w,
                      double factor) {
  const double radius = factor * budget_radius(canvas, w);
  std::vector<Patch> patches;
  for (const auto* side : {&pairs.first, &pairs.second})
    for (const auto& t : *side) patches.push_back(patch({t[0], t[1], t[2]}));
  const Drawables drawables = fattened(w, fattener, radius, patches);
  canvas.begin(w, drawables);
  const auto n = static_cast<std::uint32_t>(pairs.first.size());
  const auto pass = [&](std::uint32_t stored, std::uint32_t asked) {
    Pass p;
    p.slots = n;
    for (std::uint32_t i = 0; i < n; ++i) add(p.draws, drawables, stored + i, 0);
    for (std::uint32_t i = 0; i < n; ++i) add(p.draws, drawables, asked + i, i);
    p.steps = {{Verb::store, 0, n}, {Verb::ask, n, n}};
    return p;
  };
  return {canvas.run(pass(0, n)), canvas.run(pass(n, 0))};
}

inline Vec3 grid_point(Random& random, double reach) {
  return {random.grid(-reach, reach, 0x1p-8), random.grid(-reach, reach, 0x1p-8),
          random.grid(-reach, reach, 0x1p-8)};
}

/// Pairs that share an exact point: inside both, on edges, at corners; in cells of 96 px, at random
/// offsets that include pixel corners and centres.
inline Pairs touching_pairs(Random& random, int per_side) {
  Pairs pairs;
  for (int cell = 0; cell < per_side * per_side; ++cell) {
    const double half = 0.5 * per_side;
    Vec3 centre(96 * (cell % per_side - half) + 48, 96 * (cell / per_side - half) + 48, 0);
    if (random.below(2)) centre += 0.5 * Vec3(random.below(2), random.below(2), 0);
    if (random.below(2)) {
      centre +=
          Vec3(random.grid(-1, 1, 0x1p-8), random.grid(-1, 1, 0x1p-8), random.grid(-9, 9, 0x1p-8));
    }
    std::array<std::array<Vec3, 3>, 2> pair;
    for (auto& t : pair) {
      const double reach = std::exp2(random.between(-7, 3.5));
      const int kind = random.below(4);
      const Vec3 a = grid_point(random, reach), b = grid_point(random, reach);
      // The shared point, here the origin, as a combination of the corners with exact weights.
      if (kind == 0) t = {a, b, -(a + b)};      // the centroid
      if (kind == 1) t = {a, -a, b};            // on an edge
      if (kind == 2) t = {Vec3::Zero(), a, b};  // a corner
      if (kind == 3) t = {a, -a, -a};           // a segment through it
      for (Vec3& c : t) c += centre;
    }
    pairs.first.push_back(pair[0]);
    pairs.second.push_back(pair[1]);
  }
  return pairs;
}

/// Two segments that cross at 45 degrees close to a pixel's corner.
inline Pairs corner_pairs(Random& random, const Window& w) {
  Pairs pairs;
  for (int y = -w.height / 2 + 3; y < w.height / 2 - 3; y += 6) {
    for (int x = -w.width / 2 + 3; x < w.width / 2 - 3; x += 6) {
      const Vec3 q(x + random.grid(-0x1p-10, 0x1p-10, 0x1p-14),
                   y + random.grid(-0x1p-10, 0x1p-10, 0x1p-14), random.grid(-50, 50, 0x1p-8));
      const Vec3 u(0x1p-12, 0x1p-12, 0), v(0x1p-12, -0x1p-12, 0);
      pairs.first.push_back({q - u, q + u, q + u});
      pairs.second.push_back({q - v, q + v, q + v});
    }
  }
  return pairs;
}

inline int count_unseen(const Seen& seen) {
  return static_cast<int>(std::ranges::count(seen.forward, 0) +
                          std::ranges::count(seen.backward, 0));
}

/// Theorem 1: triangles that share a point see each other, whichever is stored; the twins without a
/// radius and with nine tenths of it do not.
inline void expect_theorem1(const MakeCanvas& make, int rounds) {
  for (const Fattener& fattener : fatteners()) {
    SCOPED_TRACE(fattener.name);
    Random random(test_seed(kSeed));
    const std::unique_ptr<Canvas> canvas = make(fattener);
    const Window w = window(960, 64);
    int unseen_without_radius = 0;
    for (int round = 0; more_cases(round, rounds, unseen_without_radius > 10); ++round) {
      const Pairs pairs = touching_pairs(random, 10);
      for (std::size_t i = 0; i < pairs.first.size(); ++i)
        ASSERT_TRUE(intersects(pairs.first[i], pairs.second[i]));
      EXPECT_EQ(count_unseen(ask_pairs(*canvas, fattener, pairs, w, 1)), 0) << "round " << round;
      if (unseen_without_radius <= 10)
        unseen_without_radius += count_unseen(ask_pairs(*canvas, fattener, pairs, w, 0));
    }

    const Window small = window(512, 64);
    const Pairs corners = corner_pairs(random, small);
    EXPECT_EQ(count_unseen(ask_pairs(*canvas, fattener, corners, small, 1)), 0);
    EXPECT_GT(count_unseen(ask_pairs(*canvas, fattener, corners, small, 0.9)), 0);
  }
}

/// Corollary 1: what is not seen is disjoint, by exact predicates.
inline void expect_corollary1(const MakeCanvas& make, int rounds) {
  for (const Fattener& fattener : fatteners()) {
    SCOPED_TRACE(fattener.name);
    Random random(test_seed(kSeed));
    const std::unique_ptr<Canvas> canvas = make(fattener);
    const Window w = window(960, 64);
    // A canvas that sees everything would pass, and so would pairs that do not intersect.
    int unseen = 0, intersecting = 0;
    for (int round = 0; more_cases(round, rounds, unseen > 50 && intersecting > 50); ++round) {
      Pairs pairs;
      for (int cell = 0; cell < 100; ++cell) {
        const Vec3 centre(96 * (cell % 10) - 432, 96 * (cell / 10) - 432, 0);
        const double reach = std::exp2(random.between(-4, 4));
        std::array<std::array<Vec3, 3>, 2> pair;
        for (auto& t : pair)
          for (Vec3& c : t) c = centre + grid_point(random, reach);
        pairs.first.push_back(pair[0]);
        pairs.second.push_back(pair[1]);
      }
      const Seen seen = ask_pairs(*canvas, fattener, pairs, w, 1);
      for (std::size_t i = 0; i < pairs.first.size(); ++i) {
        const bool meet = intersects(pairs.first[i], pairs.second[i]);
        intersecting += meet;
        for (const auto* answers : {&seen.forward, &seen.backward}) {
          unseen += !(*answers)[i];
          EXPECT_FALSE(meet && !(*answers)[i]) << "round " << round << ", pair " << i;
        }
      }
    }
  }
}

}  // namespace farcull::lab
