// The tests of FAR pairs share this: the truth by exact tests of all pairs, and backends that are
// misled.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/pairs/backend.h"
#include "core/pairs/pairs.h"
#include "tests/core/scene/scenes.h"
#include "verify/exact.h"

namespace farcull::lab {

inline Scene with_self(Scene scene) {
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

// Every pair that counts and collides, neighbours included, by the definition: all pairs of
// triangles, exact tests.
inline std::vector<TrianglePair> truth_of(const Scene& scene, double clearance = 0) {
  const ExactResult exact = all_colliding_pairs(scene, {.clearance = clearance});
  std::vector<TrianglePair> pairs = exact.pairs;
  pairs.insert(pairs.end(), exact.neighbour_pairs.begin(), exact.neighbour_pairs.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

inline std::size_t missed(const std::vector<TrianglePair>& truth,
                          const std::vector<TrianglePair>& candidates) {
  return static_cast<std::size_t>(
      std::count_if(truth.begin(), truth.end(), [&](const TrianglePair& pair) {
        return !std::binary_search(candidates.begin(), candidates.end(), pair);
      }));
}

inline std::size_t missed(const Scene& scene, const PairSettings& settings, PairBackend& backend) {
  const PairResult result = find_pairs(scene, settings, backend);
  EXPECT_TRUE(std::is_sorted(result.candidates.begin(), result.candidates.end()));
  EXPECT_EQ(std::adjacent_find(result.candidates.begin(), result.candidates.end()),
            result.candidates.end());
  return missed(truth_of(scene, settings.clearance), result.candidates);
}

// A backend whose task is changed on the way in.
class Changed : public PairBackend {
 public:
  using Change = void (*)(PairTask&);
  explicit Changed(Change change) : change_(change), inner_(cpu_pair_backend(2)) {}
  std::string name() const override { return "changed"; }
  std::vector<TrianglePair> raw_pairs(const PairTask& task, PairCounts& counts) override {
    PairTask other = task;
    change_(other);
    return inner_->raw_pairs(other, counts);
  }

 private:
  Change change_;
  std::unique_ptr<PairBackend> inner_;
};

}  // namespace farcull::lab
