// Answers each question by a search (core/proximity/scene_trees.h). Searches run in parallel, and a
// long search is divided. nearest_objects() compares an object with other objects in the order of
// the gaps between their boxes, until a gap is above the k-th smallest upper bound so far.
// pairs_within() compares an object with the objects that have higher numbers.
#include "core/proximity/near_pairs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/boxes/join.h"
#include "core/proximity/scene_trees.h"

namespace farcull {
namespace {

double square_of_gap(const Box& a, const Box& b) {
  return (a.lo - b.hi).cwiseMax(b.lo - a.hi).cwiseMax(0).squaredNorm();
}

// Lists all objects, the given object included, in the order of the least gap between their parts
// and the parts of the given object. At equal gaps, the object with the lower number comes first.
// Gaps are in scaled units (core/proximity/scene_trees.h).
class Approach {
 public:
  Approach(const SceneTrees& trees, std::uint32_t object)
      : trees_(trees), parts_(trees.parts(object)) {
    for (std::uint32_t part = 0; part < parts_.size(); ++part)
      queue_.push({0, trees.objects().levels, 0, part});
  }
  // Returns false if no object is left, or if the squared gap of the next object is above the
  // limit.
  bool next(double square_limit, std::uint32_t& object) {
    while (!queue_.empty() && queue_.top().square <= square_limit) {
      const Node at = queue_.top();
      queue_.pop();
      if (at.height == 0) {
        object = at.k;
        if (parts_.size() == 1 && trees_.parts(object).size() == 1) return true;
        if (given_.insert(object).second) return true;
        continue;
      }
      const auto below = static_cast<std::size_t>(at.height - 1);
      const WideBoxes<double>& block = trees_.blocks()[trees_.objects().first[below] + at.k];
      for (std::uint32_t lane = 0; lane < kWide; ++lane) {
        const double square = square_of_gap(block.get(lane), parts_[at.part]);
        if (!(square <= square_limit)) continue;
        const std::uint32_t child = kWide * at.k + lane;
        const std::uint32_t k = at.height > 1 ? child : trees_.object(child);
        queue_.push({square, at.height - 1, k, at.part});
      }
    }
    return false;
  }

 private:
  struct Node {
    double square;
    int height;
    std::uint32_t k;                           // number of the node; at height 0, of the object
    std::uint32_t part;                        // a part of the given object
    bool operator<(const Node& other) const {  // the top of the queue is the nearest node
      if (square != other.square) return square > other.square;
      return height != other.height ? height < other.height : k > other.k;
    }
  };
  const SceneTrees& trees_;
  std::span<const Box> parts_;
  std::priority_queue<Node> queue_;
  std::unordered_set<std::uint32_t> given_;  // listed objects that another part could list again
};

struct Found {
  double lower = 0;  // lower bound of the distance, in scaled units
  double upper = 0;
  double limit = 0;
  NearPairs near;
};

void finish(const SceneTrees& trees, Search& search, SearchMemory& memory) {
  while (!search.open.empty()) {
    go_on(trees, kLeafPairsAtOnce, search, memory);
    require_room(trees, search);
  }
}

// Returns the k-th smallest upper bound of the searches, which bounds the k-th distance.
double kth_least_upper(std::span<const Search> searches, std::size_t k) {
  if (searches.size() < k) return std::numeric_limits<double>::infinity();
  std::vector<double> upper;
  for (const Search& search : searches) upper.push_back(search.upper);
  const auto kth = upper.begin() + static_cast<std::ptrdiff_t>(k - 1);
  std::ranges::nth_element(upper, kth);
  return *kth;
}

// The crowd: all triangles of a scene as one object. If very many parts of objects overlap, small
// objects (one leaf each) are compared with the crowd. Comparing them with each other object would
// take quadratic time.
struct Crowd {
  static constexpr std::size_t kOverlaps = 16;  // the crowd is used for more overlaps per object

  static bool is_small(const SceneTrees& trees, std::uint32_t object) {
    return trees.tree(object).leaves == 1;
  }
  static bool is(const SceneTrees& trees) {
    const auto objects = static_cast<std::uint32_t>(trees.scene().objects.size());
    std::vector<Box> parts;
    std::vector<std::uint32_t> owners;
    bool any_small = false;
    for (std::uint32_t o = 0; o < objects; ++o) {
      parts.insert(parts.end(), trees.parts(o).begin(), trees.parts(o).end());
      owners.resize(parts.size(), o);
      any_small |= is_small(trees, o);
    }
    if (!any_small) return false;
    std::vector<std::uint32_t> items(parts.size());
    std::iota(items.begin(), items.end(), 0u);
    const std::size_t most = kOverlaps * objects;
    return box_join(parts, owners, items, most).size() > most;
  }
  Crowd(const Scene& of, unsigned threads)
      : scene{.name = of.name,
              .vertices = of.vertices,
              .triangles = of.triangles,
              .source_face = {},
              .objects = {{of.name, 0, static_cast<std::uint32_t>(of.triangles.size()), false}}},
        trees(scene, threads),
        owner(owners(of)) {}

  Scene scene;
  SceneTrees trees;
  std::vector<std::uint32_t> owner;
};

struct NearestMemory {
  SearchMemory of_two;
  std::optional<SearchMemory> of_all;  // made at the first search in the crowd
};

// Returns the other objects that may be among an object's k nearest, in ascending order. Lowers
// `limit` to an upper bound of the k-th distance. ties: as in Others.
std::vector<std::uint32_t> others_near(const SceneTrees& trees, const Crowd& crowd,
                                       std::uint32_t object, std::size_t k, bool ties,
                                       double& limit, SearchMemory& memory,
                                       ProximityCounts& counts) {
  Others others{.all = &crowd.trees,
                .scene = trees.scene(),
                .owner = crowd.owner,
                .object = object,
                .k = k,
                .ties = ties};
  Search search = begin_search(trees, object, limit, others, memory);
  finish(trees, search, memory);
  search.filter();
  std::vector<std::uint32_t> out;
  for (const KeptPair& kept : search.kept) {
    const std::uint32_t other = others.other_of(kept.pair);
    if (trees.scene().objects[other].first_triangle < others.end) out.push_back(other);
  }
  std::ranges::sort(out);
  out.erase(std::ranges::unique(out).begin(), out.end());
  limit = search.bound();
  counts.add_work(search.counts);
  return out;
}

// Returns the other objects that may be among the k nearest of an object. crowd: null if the object
// is compared with each other object. hints: the hints that name the object, sorted. all: true to
// find all objects as near as the k-th; false to find only those with the lowest numbers.
std::vector<Found> found_by(const SceneTrees& trees, const Crowd* crowd, std::uint32_t object,
                            std::size_t k, double limit, std::span<const NearHint> hints, bool all,
                            NearestMemory& both, ProximityCounts& counts) {
  SearchMemory& memory = both.of_two;
  std::vector<Found> out;
  std::vector<Search> begun;  // one per hint, sorted by objects
  for (const NearHint& hint : hints) {
    begun.push_back(begin_search(trees, hint.objects, limit, &hint.triangles, memory));
    counts.triangle_pairs += begun.back().counts.triangle_pairs;
  }
  limit = std::min(limit, kth_least_upper(begun, k));
  std::vector<double> least;  // heap of the k smallest upper bounds
  const auto bound = [&] { return least.size() < k ? limit : std::min(limit, least.front()); };
  std::vector<std::uint32_t> near;
  if (crowd) {
    if (!both.of_all) both.of_all.emplace();
    near = others_near(trees, *crowd, object, k, all, limit, *both.of_all, counts);
  }
  std::optional<Approach> approach;
  if (!crowd) approach.emplace(trees, object);
  std::uint32_t other = 0;
  std::size_t meeting = 0, next = 0;
  const auto has_next = [&] {
    if (approach) return approach->next(near::square_limit(bound()), other);
    if (next == near.size()) return false;
    other = near[next++];
    return true;
  };
  while (has_next()) {
    if (other == object) continue;
    const ObjectPair objects = {std::min(object, other), std::max(object, other)};
    const double most = bound();
    const auto hinted = std::ranges::lower_bound(begun, objects, {}, &Search::objects);
    Search search;
    if (hinted != begun.end() && hinted->objects == objects) {
      search = std::move(*hinted);
      search.limit = most;
      search.counts = {};  // already added to `counts`
    } else {
      search = begin_search(trees, objects, most, nullptr, memory);
    }
    finish(trees, search, memory);
    Found found = {.limit = most, .near = answer(trees, search)};
    counts.add_work(search.counts);
    if (search.kept.empty()) continue;
    found.lower = std::ranges::min_element(search.kept, {}, &KeptPair::lower)->lower;
    found.upper = std::ranges::min_element(search.kept, {}, &KeptPair::upper)->upper;
    least.push_back(found.upper);
    std::ranges::push_heap(least);
    if (least.size() > k) {
      std::ranges::pop_heap(least);
      least.pop_back();
    }
    // Other objects with a gap of 0 come in ascending order. Once k objects meet this object, later
    // objects are no nearer, and have higher numbers.
    meeting += found.upper == 0;
    out.push_back(std::move(found));
    if (!all && meeting == k) break;
  }
  std::erase_if(out, [most = bound()](const Found& f) { return f.lower > most; });
  return out;
}

// Pairs of leaves (at most 16,384 pairs of triangles) examined between two calls of Count::add().
constexpr std::size_t kBetweenCounts = 64;

// Counts the pairs of all threads. add() throws `error` if the count exceeds `most`.
class Count {
 public:
  Count(std::size_t most, Error error) : most_(most), error_(std::move(error)) {}
  void add(std::size_t pairs) {
    if (found_.fetch_add(pairs) + pairs > most_) throw error_;
  }

 private:
  std::size_t most_;
  Error error_;
  std::atomic<std::size_t> found_ = 0;
};

void add_pairs(const SceneTrees& trees, const ObjectPair& objects, double limit, Count& count,
               SearchMemory& memory, ProximityCounts& counts, std::vector<TrianglePair>& out) {
  Search search = begin_search(trees, objects, limit, nullptr, memory);
  search.everything = true;
  while (!search.open.empty()) {
    go_on(trees, kBetweenCounts, search, memory);
    count.add(search.kept.size());
    for (const KeptPair& kept : search.kept) out.push_back(kept.pair);
    counts.kept += search.kept.size();
    search.kept.clear();
  }
  counts.add_work(search.counts);
}

// Calls visit(other) for each object with a higher number that has a part at most `limit` (scaled
// units) from a part of `object`. Calls visit(object) if the object is marked `self`.
template <class Visit>
void for_later_within(const SceneTrees& trees, std::uint32_t object, double limit,
                      const Visit& visit) {
  Approach approach(trees, object);
  std::uint32_t other = 0;
  while (approach.next(near::square_limit(limit), other)) {
    if (other > object || (other == object && trees.scene().objects[object].self)) visit(other);
  }
}

bool has(const Object& object, std::uint32_t triangle) {
  return triangle - object.first_triangle < object.triangle_count;
}
// True if hint.a < hint.b, hint.a is a triangle of objects.a, and hint.b is one of objects.b.
bool fits(const Scene& scene, const ObjectPair& objects, const TrianglePair& hint) {
  return hint.a < hint.b && has(scene.objects[objects.a], hint.a) &&
         has(scene.objects[objects.b], hint.b);
}

}  // namespace

Error too_many_within(std::size_t most, const std::string& what) {
  return Error("within",
               "has more than " + std::to_string(most) + " pairs of " + what +
                   ", which are too many to list",
               "give a smaller distance, or find the pairs without their distances, as collisions "
               "with {clearance}");
}

struct ProximityTrees::State {
  State(const Scene& scene, unsigned thread_count, Settle settle)
      : trees(scene, thread_count, std::move(settle)), threads(thread_count) {}

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

ProximityTrees::ProximityTrees(const Scene& scene, unsigned threads, Settle settle)
    : state_(std::make_unique<State>(scene, threads, std::move(settle))) {}
ProximityTrees::~ProximityTrees() = default;

std::vector<NearPairs> ProximityTrees::near_pairs(
    std::span<const ObjectPair> questions, double within,
    std::span<const std::optional<TrianglePair>> hints, const Progress& progress) const {
  const SceneTrees& trees = state_->trees;
  if (!(within >= 0)) throw std::logic_error("near_pairs: within is not a distance");
  if (!hints.empty() && hints.size() != questions.size())
    throw std::logic_error("near_pairs: as many hints as questions, or none");
  for (const ObjectPair& q : questions) {
    if (q.a > q.b || q.b >= trees.scene().objects.size())
      throw std::logic_error("near_pairs: no such pair of objects");
  }
  if (progress) progress(StageKind::near);
  const double limit = scaled_limit(trees, within);
  std::vector<NearPairs> out(questions.size());
  std::vector<std::unique_ptr<Search>> long_ones(questions.size());
  for_each_with_memory<SearchMemory>(
      questions.size(), state_->threads, [&](std::size_t k, SearchMemory& memory) {
        const ObjectPair& objects = questions[k];
        const TrianglePair* hint = hints.empty() || !hints[k] ? nullptr : &*hints[k];
        if (hint != nullptr && !fits(trees.scene(), objects, *hint)) hint = nullptr;
        Search search = begin_search(trees, objects, limit, hint, memory);
        go_on(trees, kLeafPairsAtOnce, search, memory);
        if (search.open.empty()) {
          out[k] = answer(trees, search);
          state_->add(search.counts);
        } else {
          long_ones[k] = std::make_unique<Search>(std::move(search));
        }
      });
  for (std::size_t k = 0; k < questions.size(); ++k) {
    if (!long_ones[k]) continue;
    Search& search = *long_ones[k];
    go_on_divided(trees, state_->threads, search);
    out[k] = answer(trees, search);
    state_->add(search.counts);
    long_ones[k].reset();
  }
  return out;
}

std::vector<NearPairs> ProximityTrees::State::nearest(std::size_t k, double within,
                                                      std::span<const NearHint> hints, bool all,
                                                      const Progress& progress) const {
  if (!(within >= 0)) throw std::logic_error("nearest_objects: within is not a distance");
  if (progress) progress(StageKind::near);
  if (k == 0) return {};
  const Scene& scene = trees.scene();
  std::vector<NearHint> good;
  for (const NearHint& hint : hints) {
    const ObjectPair& objects = hint.objects;
    const bool two = objects.a < objects.b && objects.b < scene.objects.size();
    if (two && fits(scene, objects, hint.triangles)) good.push_back(hint);
  }
  std::ranges::stable_sort(good, {}, &NearHint::objects);
  good.erase(std::ranges::unique(good, {}, &NearHint::objects).begin(), good.end());
  const std::size_t objects = scene.objects.size();
  std::vector<std::vector<NearHint>> hints_of(objects);
  for (const NearHint& hint : good) {
    hints_of[hint.objects.a].push_back(hint);
    hints_of[hint.objects.b].push_back(hint);
  }
  const double limit = scaled_limit(trees, within);
  std::vector<std::vector<Found>> found(objects);
  std::vector<ProximityCounts> parts(objects);
  std::unique_ptr<Crowd> crowd;
  if (Crowd::is(trees)) crowd = std::make_unique<Crowd>(scene, threads);
  for_each_with_memory<NearestMemory>(objects, threads, [&](std::size_t o, NearestMemory& memory) {
    const auto object = static_cast<std::uint32_t>(o);
    if (trees.tree(object).levels == 0) return;
    const Crowd* const asked = Crowd::is_small(trees, object) ? crowd.get() : nullptr;
    found[o] = found_by(trees, asked, object, k, limit, hints_of[o], all, memory, parts[o]);
  });
  std::vector<Found> founds;
  ProximityCounts counts;
  for (std::size_t o = 0; o < objects; ++o) {
    counts.add_work(parts[o]);
    std::ranges::move(found[o], std::back_inserter(founds));
  }
  // If two objects have found each other, the answer with the larger limit is kept. An answer has
  // all nearest pairs if the least distance is at most the answer's limit. This holds for one of
  // the two answers at least, so it holds for the answer with the larger limit.
  std::ranges::stable_sort(founds, [](const Found& x, const Found& y) {
    if (x.near.objects != y.near.objects) return x.near.objects < y.near.objects;
    return x.limit > y.limit;
  });
  std::vector<NearPairs> out;
  for (Found& f : founds) {
    if (!out.empty() && out.back().objects == f.near.objects) continue;
    counts.kept += f.near.pairs.size();
    out.push_back(std::move(f.near));
  }
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

std::vector<ObjectPair> ProximityTrees::objects_within(double within, std::size_t most) const {
  if (!(within >= 0)) throw std::logic_error("objects_within: within is not a distance");
  const SceneTrees& trees = state_->trees;
  const double limit = scaled_limit(trees, within);
  Count count(most, too_many_within(most, "objects"));
  std::vector<std::vector<ObjectPair>> found(trees.scene().objects.size());
  for_each_shared(found.size(), state_->threads, [&](std::size_t o) {
    const auto object = static_cast<std::uint32_t>(o);
    for_later_within(trees, object, limit, [&](std::uint32_t other) {
      count.add(1);
      found[o].push_back({object, other});
    });
    std::ranges::sort(found[o]);
  });
  std::vector<ObjectPair> out;
  for (const std::vector<ObjectPair>& pairs : found)
    out.insert(out.end(), pairs.begin(), pairs.end());
  return out;
}

std::vector<TrianglePair> ProximityTrees::pairs_within(double within, std::size_t most,
                                                       const Progress& progress,
                                                       std::size_t spare) const {
  if (!(within >= 0) || !std::isfinite(within))
    throw std::logic_error("pairs_within: within is not a distance");
  if (progress) progress(StageKind::near);
  const SceneTrees& trees = state_->trees;
  const double limit = scaled_limit(trees, within);
  Count count(most + spare, too_many_within(most, "triangles"));
  const std::size_t objects = trees.scene().objects.size();
  std::vector<std::vector<TrianglePair>> found(objects);
  std::vector<ProximityCounts> parts(objects);
  for_each_with_memory<SearchMemory>(
      objects, state_->threads, [&](std::size_t o, SearchMemory& memory) {
        const auto object = static_cast<std::uint32_t>(o);
        if (trees.tree(object).levels == 0) return;
        for_later_within(trees, object, limit, [&](std::uint32_t other) {
          add_pairs(trees, {object, other}, limit, count, memory, parts[o], found[o]);
        });
        std::ranges::sort(found[o]);
      });
  std::vector<TrianglePair> out;
  for (std::size_t o = 0; o < objects; ++o) {
    out.insert(out.end(), found[o].begin(), found[o].end());
    found[o] = {};
    state_->add(parts[o]);
  }
  return out;
}

ProximityCounts ProximityTrees::counts() const {
  return {state_->box_pairs, state_->triangle_pairs, state_->kept};
}

}  // namespace farcull
