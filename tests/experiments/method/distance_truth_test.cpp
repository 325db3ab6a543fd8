// The truth about distances that large scenes are compared with, against one that leaves out less.
#include "tests/experiments/method/distance_truth.h"

#include <gtest/gtest.h>

#include "experiments/scenes/builtin/scenes.h"
#include "tests/core/base/trials.h"

namespace farcull {
namespace {

using distance_lab::Answer;
using distance_truth::Nearest;
using enum DistancePairs;

// Of each object the first of its nearest others, from the distances of all objects.
std::vector<Answer> nearest_answers(const Scene& scene, const distance_lab::Truth& truth) {
  std::vector<Answer> out;
  const std::vector<Answer> all = truth.answers({.pairs = objects});
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const Answer* best = nullptr;
    for (const Answer& x : all) {
      const bool names = (x.objects.a == o) != (x.objects.b == o);
      if (names && (best == nullptr || x.squared < best->squared)) best = &x;
    }
    if (best != nullptr) out.push_back(*best);
  }
  return out;
}

void expect_same(const Scene& scene, const std::string& where) {
  const distance_lab::Truth slow(scene);
  distance_truth::Truth fast(scene);
  std::vector<Answer> answers;
  const auto count = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a; b < count; ++b) {
      if (a == b && !scene.objects[a].self) continue;
      const auto found = fast.nearest({a, b});
      if (!found) continue;
      answers.push_back({{a, b}, found->pairs.front(), found->squared});
      ASSERT_TRUE(std::ranges::is_sorted(found->pairs)) << where;
    }
  }
  EXPECT_EQ(answers, slow.answers({.pairs = objects})) << where;
  answers.clear();
  for (const Nearest& n : fast.nearest_of_each()) {
    const auto [a, b] = std::minmax(n.objects.a, n.objects.b);
    answers.push_back({{a, b}, n.pairs.front(), n.squared});
  }
  EXPECT_EQ(answers, nearest_answers(scene, slow)) << where;
}

TEST(DistanceTruth, IsThatOfComparingAllWithAll) {
  rational::Draws random(11);
  for (int k = 0; k < trials(60); ++k)
    expect_same(distance_lab::random_scene(random, 1 + random.below(5), 14), std::to_string(k));
  for (const char* name : {"degenerate", "slivers:12", "gap:12", "mixed:4"}) {
    for (const double diagonals : {0.0, 1e-12, 1.0, 1e3})
      expect_same(distance_lab::moved_apart(make_builtin_scene(name), diagonals), name);
  }
}

// All pairs that are as near: two rows of four squares at the distance 1.
TEST(DistanceTruth, HoldsAllPairsThatAreAsNear) {
  near_lab::GridScene grid;
  for (const int z : {0, 1}) {
    std::vector<near_lab::Corners<near_lab::Integer>> row;
    for (int x = 0; x < 8; x += 2) row.push_back({{{x, 0, z}, {x + 1, 0, z}, {x, 1, z}}});
    near_lab::add_object(grid, row);
  }
  near_lab::finish(grid, 0.25, 3, [] { return false; });
  distance_truth::Truth truth(grid.scene);
  const auto found = truth.nearest({0, 1});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->squared, distance_lab::Q(1, 16));
  EXPECT_EQ(found->pairs, (std::vector<TrianglePair>{{0, 4}, {1, 5}, {2, 6}, {3, 7}}));
  // Most pairs are left out.
  EXPECT_LT(truth.computed(), 16u);
}

}  // namespace
}  // namespace farcull
