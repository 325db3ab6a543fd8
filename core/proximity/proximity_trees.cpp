// ProximityTrees of near_pairs.h, in a file of its own because what it is built from includes that
// header. Each question is a search (core/proximity/search.h). Searches go on side by side; one
// that takes long is divided.
#include "core/proximity/near_pairs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "core/proximity/nearest.h"
#include "core/proximity/pairs_within.h"
#include "core/proximity/scene_trees.h"
#include "core/proximity/search.h"
#include "core/proximity/split.h"

namespace farcull {

struct ProximityTrees::State {
  State(const Scene& scene, unsigned thread_count)
      : trees(scene, thread_count), threads(thread_count) {}

  SceneTrees trees;
  unsigned threads;
  mutable std::atomic<std::uint64_t> box_pairs = 0, triangle_pairs = 0, kept = 0;

  std::vector<NearPairs> nearest(std::size_t k, double within, std::span<const NearHint> hints,
                                 bool all, const Progress& progress) const;
  void add(const ProximityCounts& counts) const {
    box_pairs += counts.box_pairs;
    triangle_pairs += counts.triangle_pairs;
    kept += counts.kept;
  }
};

ProximityTrees::ProximityTrees(const Scene& scene, unsigned threads)
    : state_(std::make_unique<State>(scene, threads)) {}
ProximityTrees::~ProximityTrees() = default;
ProximityTrees::ProximityTrees(ProximityTrees&&) noexcept = default;
ProximityTrees& ProximityTrees::operator=(ProximityTrees&&) noexcept = default;

namespace {

void check(const Scene& scene, std::span<const ObjectPair> questions, double within,
           std::size_t hints) {
  if (!(within >= 0)) throw std::logic_error("near_pairs: within is not a distance");
  if (hints != 0 && hints != questions.size()) {
    throw std::logic_error("near_pairs: as many hints as questions, or none");
  }
  for (const ObjectPair& q : questions) {
    if (q.a > q.b || q.b >= scene.objects.size()) {
      throw std::logic_error("near_pairs: no such pair of objects");
    }
  }
}

bool has(const Object& object, std::uint32_t triangle) {
  return triangle >= object.first_triangle &&
         triangle - object.first_triangle < object.triangle_count;
}
// The hint, if it is one: the first triangle of objects.a, the second one of objects.b.
bool fits(const Scene& scene, const ObjectPair& objects, const TrianglePair& hint) {
  return hint.a < hint.b && has(scene.objects[objects.a], hint.a) &&
         has(scene.objects[objects.b], hint.b);
}

}  // namespace

std::vector<NearPairs> ProximityTrees::near_pairs(
    std::span<const ObjectPair> questions, double within,
    std::span<const std::optional<TrianglePair>> hints, const Progress& progress) const {
  const SceneTrees& trees = state_->trees;
  check(trees.scene(), questions, within, hints.size());
  if (progress) progress("near pairs");
  const double limit = scaled_limit(trees, within);
  std::vector<NearPairs> out(questions.size());
  std::vector<Search> long_ones(questions.size());
  for_each_with_memory<SearchMemory>(
      questions.size(), state_->threads, [&](std::size_t k, SearchMemory& memory) {
        const ObjectPair& objects = questions[k];
        const TrianglePair* hint = hints.empty() || !hints[k] ? nullptr : &*hints[k];
        if (hint != nullptr && !fits(trees.scene(), objects, *hint)) hint = nullptr;
        Search search = begin_search(trees, objects, limit, hint, memory);
        go_on(trees, kRunPairsAtOnce, search, memory);
        if (search.open.empty()) {
          out[k] = answer(trees, search);
          state_->add(search.counts);
        } else {
          long_ones[k] = std::move(search);
        }
      });
  for (std::size_t k = 0; k < questions.size(); ++k) {
    Search& search = long_ones[k];
    if (search.open.empty()) continue;
    go_on_divided(trees, state_->threads, search);
    out[k] = answer(trees, search);
    state_->add(search.counts);
    search = Search();
  }
  return out;
}

std::vector<NearPairs> ProximityTrees::State::nearest(std::size_t k, double within,
                                                      std::span<const NearHint> hints, bool all,
                                                      const Progress& progress) const {
  if (!(within >= 0)) throw std::logic_error("nearest_objects: within is not a distance");
  if (progress) progress("nearest objects");
  const Scene& scene = trees.scene();
  std::vector<NearHint> good;
  for (const NearHint& hint : hints) {
    const ObjectPair& objects = hint.objects;
    const bool two = objects.a < objects.b && objects.b < scene.objects.size();
    if (two && fits(scene, objects, hint.triangles)) good.push_back(hint);
  }
  std::ranges::stable_sort(good, {}, &NearHint::objects);
  good.erase(std::ranges::unique(good, {}, &NearHint::objects).begin(), good.end());
  ProximityCounts counts;
  std::vector<NearPairs> out =
      farcull::nearest_objects(trees, k, scaled_limit(trees, within), good, all, threads, counts);
  add(counts);
  return out;
}

std::vector<NearPairs> ProximityTrees::nearest_objects(std::size_t k, double within,
                                                       const Progress& progress) const {
  return state_->nearest(k, within, {}, true, progress);
}

std::vector<NearPairs> ProximityTrees::nearest_objects(std::size_t k, double within,
                                                       std::span<const NearHint> hints,
                                                       const Progress& progress) const {
  return state_->nearest(k, within, hints, false, progress);
}

std::vector<TrianglePair> ProximityTrees::pairs_within(double within, std::size_t most,
                                                       const Progress& progress) const {
  if (!(within >= 0) || !std::isfinite(within))
    throw std::logic_error("pairs_within: within is not a distance");
  if (progress) progress("near pairs");
  ProximityCounts counts;
  std::vector<TrianglePair> out = farcull::pairs_within(
      state_->trees, scaled_limit(state_->trees, within), most, state_->threads, counts);
  state_->add(counts);
  return out;
}

ProximityCounts ProximityTrees::counts() const {
  return {state_->box_pairs, state_->triangle_pairs, state_->kept};
}

}  // namespace farcull
