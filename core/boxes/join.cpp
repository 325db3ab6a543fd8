// Finds pairs of overlapping boxes with a tree, item by item, several items in parallel. next()
// keeps only pairs (a, b) with b > a, so its result is sorted. If there are few owners, the leaves
// of the tree are grouped by owner, and an item is compared only with leaves of later owners.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/boxes/join.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/uninitialized.h"
#include "core/boxes/join.h"
#include "core/boxes/lanes-inl.h"
#include "core/scene/pair_sort.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

std::uint64_t find_leaves_here(const BoxTree<double>& tree, const WideBoxes<double>* blocks,
                               const Box& box, std::uint32_t least,
                               std::vector<std::uint32_t>& leaves) {
  return boxes::for_overlapping_leaves(tree, blocks, boxes::OneBox<double>(box), least,
                                       [&](std::uint32_t leaf) { leaves.push_back(leaf); });
}

void pair_blocks_here(const BlockTrees& trees, std::uint32_t a, std::uint32_t b, std::uint32_t from,
                      std::uint32_t to, std::size_t most, std::vector<BlockPair>& out, bool twice) {
  const std::uint32_t first_a = trees.first_block(a), first_b = trees.first_block(b);
  for (std::uint32_t block = from; block < to && out.size() <= most; ++block) {
    const std::uint32_t own = block - first_a;
    const boxes::OneBox<float> box(trees.nodes()[trees.tree(a).first[0] + own / kWide],
                                   own % kWide);
    boxes::for_overlapping_leaves(trees.tree(b), trees.nodes(), box, a == b && !twice ? own : 0,
                                  [&](std::uint32_t other) {
                                    out.push_back({block, first_b + other});
                                  });
  }
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

HWY_EXPORT(find_leaves_here);

namespace {

// Calls find(begin, end, memory, flush) for successive portions of 0 .. count - 1. Each thread has
// one Memory, and `find` appends pairs to memory.pairs. If this list is long, flush() gives the
// pairs to `take`. Gives the remaining pairs at the end. Returns the number of pairs given.
template <class Memory, class Take, class Find>
std::uint64_t give_portions(std::uint64_t count, std::uint64_t portion, std::size_t threads,
                            const Take& take, const Find& find) {
  constexpr std::size_t kMany = std::size_t{1} << 14;
  std::atomic<std::uint64_t> next = 0, given = 0;
  for_chunks(threads, threads, [&](std::size_t, std::size_t, std::size_t) {
    Memory memory;
    const auto give = [&](std::size_t least) {
      if (memory.pairs.size() < least) return;
      given += memory.pairs.size();
      take(memory.pairs);
      memory.pairs.clear();
    };
    try {
      for (;;) {
        stop_point();
        const std::uint64_t begin = next.fetch_add(portion);
        if (begin >= count) break;
        find(begin, std::min(count, begin + portion), memory, [&] { give(kMany); });
      }
      give(1);
    } catch (...) {
      next = count;  // makes the other threads end early
      throw;
    }
  });
  return given;
}

// If there are fewer items than this, a second thread costs more time than it saves.
constexpr std::size_t kLeast = 4096;
// all() finds about this many pairs at a time, so that the pairs are still in caches when copied.
constexpr std::size_t kPortion = std::size_t{1} << 18;

// True if owners never decrease along the items and there are at most kWide owners. In this case
// leaves are grouped by owner: this costs a few tree nodes, but skips overlaps inside an owner.
bool are_few(std::span<const std::uint32_t> owners) {
  std::size_t changes = 0;
  for (std::size_t k = 1; k < owners.size() && changes < kWide; ++k) {
    if (owners[k] < owners[k - 1]) return false;
    changes += owners[k] != owners[k - 1];
  }
  return changes < kWide;
}

// Sorts distinct numbers below 64 * marks.size(). To sort a long list, sets one bit of `marks` for
// each number. All bits of `marks` are 0 before and after.
void sort_marked(std::vector<std::uint32_t>& numbers, std::vector<std::uint64_t>& marks) {
  if (numbers.size() < marks.size() / 8) {
    std::ranges::sort(numbers);
    return;
  }
  for (const std::uint32_t number : numbers) marks[number / 64] |= std::uint64_t{1} << number % 64;
  std::size_t next = 0;
  for (std::uint32_t word = 0; word < marks.size(); ++word) {
    for (; marks[word] != 0; marks[word] &= marks[word] - 1)
      numbers[next++] = 64 * word + static_cast<std::uint32_t>(std::countr_zero(marks[word]));
  }
}

}  // namespace

std::vector<TrianglePair> box_join(std::span<const Box> boxes,
                                   std::span<const std::uint32_t> owners,
                                   std::span<const std::uint32_t> items, std::size_t most,
                                   unsigned threads) {
  return OrderedPairs(boxes, owners, items, threads).all(most);
}

std::vector<std::uint32_t> join_owners(const Scene& scene) {
  std::vector<std::uint32_t> out = owners(scene);
  const auto objects = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    if (scene.objects[out[t]].self) out[t] = objects + t;
  }
  return out;
}

OrderedPairs::OrderedPairs(const Scene& scene, double clearance,
                           std::span<const ObjectPair> ignored, bool neighbours, unsigned threads)
    : scene_(neighbours ? nullptr : &scene),
      objects_(neighbours ? std::vector<std::uint32_t>() : owners(scene)),
      threads_(threads),
      owner_(join_owners(scene)),
      items_(scene.triangles.size()) {
  if (!ignored.empty()) ignored_ = IgnoredObjects(scene, ignored);
  std::iota(items_.begin(), items_.end(), 0u);
  std::vector<Box> boxes(items_.size());
  for (std::uint32_t t = 0; t < boxes.size(); ++t) boxes[t] = grown_box(scene, t, clearance);
  plant(std::move(boxes));
}

OrderedPairs::OrderedPairs(std::span<const Box> boxes, std::span<const std::uint32_t> owners,
                           std::span<const std::uint32_t> items, unsigned threads)
    : threads_(threads), items_(items.begin(), items.end()) {
  std::erase_if(items_, [&](std::uint32_t item) { return boxes[item].is_empty(); });
  std::ranges::sort(items_);
  std::vector<Box> own;
  for (const std::uint32_t item : items_) {
    own.push_back(boxes[item]);
    owner_.push_back(owners[item]);
  }
  plant(std::move(own));
}

// Drops items that cannot have a pair: their box overlaps the box of no other owner. The box of an
// owner is the box around all its items. Precondition: are_few(owner_).
void OrderedPairs::drop_apart(std::vector<Box>& boxes) {
  std::vector<Box> of_owner;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    if (k == 0 || owner_[k] != owner_[k - 1]) of_owner.push_back(Box::empty());
    of_owner.back().add(boxes[k]);
  }
  std::size_t kept = 0, own = 0;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const bool last = k + 1 == boxes.size() || owner_[k + 1] != owner_[k];
    bool meets = false;
    for (std::size_t o = 0; o < of_owner.size(); ++o)
      meets |= o != own && overlap(boxes[k], of_owner[o]);
    own += last;
    if (!meets) continue;
    boxes[kept] = boxes[k];
    items_[kept] = items_[k];
    owner_[kept++] = owner_[k];
  }
  boxes.resize(kept);
  items_.resize(kept);
  owner_.resize(kept);
}

void OrderedPairs::plant(std::vector<Box> boxes) {
  by_owner_ = are_few(owner_);
  if (by_owner_) drop_apart(boxes);
  order_.resize(boxes.size());
  for (std::size_t from = 0, to = 0; from < boxes.size(); from = to) {
    to = by_owner_ ? first_of_later_owners(static_cast<std::uint32_t>(from)) : boxes.size();
    const auto order = std::span(order_).subspan(from, to - from);
    spatial_order(std::span(boxes).subspan(from, to - from), order);
    for (std::uint32_t& item : order) item += static_cast<std::uint32_t>(from);
  }
  std::vector<Box> leaves(boxes.size());
  for (std::size_t k = 0; k < leaves.size(); ++k) leaves[k] = boxes[order_[k]];
  std::vector<Box>().swap(boxes);  // frees memory; `leaves` has the boxes
  blocks_.resize(blocks_of_tree(leaves.size()));
  tree_ = make_tree<double>(leaves, blocks_, 0);
}

// Sets part.found to the items of the leaves >= `least` whose boxes overlap the box of `leaf`.
void OrderedPairs::find(std::uint32_t leaf, std::uint32_t least, Part& part) const {
  part.found.clear();
  const Box box = blocks_[tree_.first[0] + leaf / kWide].get(leaf % kWide);
  part.compared +=
      HWY_DYNAMIC_DISPATCH(find_leaves_here)(tree_, blocks_.data(), box, least, part.found);
  for (std::uint32_t& other : part.found) other = order_[other];
}

// Returns the first item of a later owner. Precondition: leaves are grouped by owner, in the order
// of the items. So the result is also the first leaf of a later owner.
std::uint32_t OrderedPairs::first_of_later_owners(std::uint32_t item) const {
  const auto behind = std::ranges::upper_bound(owner_, owner_[item]);
  return static_cast<std::uint32_t>(behind - owner_.begin());
}

void OrderedPairs::append(std::uint32_t a, Part& part) const {
  std::vector<std::uint32_t>& found = part.found;
  find(leaf_[a], by_owner_ ? first_of_later_owners(a) : 0, part);
  if (!by_owner_)
    std::erase_if(found, [&](std::uint32_t b) { return b <= a || owner_[a] == owner_[b]; });
  sort_marked(found, part.marks);
  for (const std::uint32_t b : found) {
    const TrianglePair pair{items_[a], items_[b]};
    if (is_asked(pair)) part.pairs.push_back(pair);
  }
}

void OrderedPairs::append_of_leaf(std::uint32_t leaf, Part& part) const {
  const std::uint32_t a = order_[leaf];
  find(leaf, by_owner_ ? first_of_later_owners(a) : leaf + 1, part);
  for (const std::uint32_t b : part.found) {
    if (owner_[a] == owner_[b]) continue;
    const TrianglePair pair{items_[std::min(a, b)], items_[std::max(a, b)]};
    if (is_asked(pair)) part.pairs.push_back(pair);
  }
}

bool OrderedPairs::is_asked(const TrianglePair& pair) const {
  if (ignored_ && (*ignored_)(pair)) return false;
  return scene_ == nullptr || objects_[pair.a] != objects_[pair.b] ||
         !share_index(scene_->triangles[pair.a], scene_->triangles[pair.b]);
}

std::vector<TrianglePair> OrderedPairs::all(std::size_t most) {
  std::vector<TrianglePair> pairs, some;
  while (!at_end() && pairs.size() <= most) {
    next(std::clamp<std::size_t>(most, 1, kPortion), some);
    // Reserves memory for the estimated number of all pairs, so that the list is rarely copied.
    // Reserves at least 2 times and at most 8 times the memory needed now.
    const std::size_t needed = pairs.size() + some.size();
    const double factor = std::clamp(1 / share(), 2.0, 8.0);
    if (needed > pairs.capacity())
      pairs.reserve(static_cast<std::size_t>(factor * static_cast<double>(needed)));
    pairs.insert(pairs.end(), some.begin(), some.end());
  }
  if (pairs.size() > most) pairs.resize(most + 1);
  return pairs;
}

std::uint64_t OrderedPairs::give(const TakePairs& take) {
  constexpr std::uint32_t kLeaves = 64;  // number of leaves that a thread takes at a time
  std::atomic<std::uint64_t> compared = 0;
  const std::uint64_t given = give_portions<Part>(
      items_.size(), kLeaves, chunks_for(items_.size(), kLeaves, threads_), take,
      [&](std::uint64_t begin, std::uint64_t end, Part& part, const auto& flush) {
        for (std::uint64_t leaf = begin; leaf < end; ++leaf) {
          append_of_leaf(static_cast<std::uint32_t>(leaf), part);
          flush();
        }
        compared += std::exchange(part.compared, 0);
      });
  next_ = static_cast<std::uint32_t>(items_.size());
  compared_ += compared;
  return given;
}

void OrderedPairs::next(std::size_t most, std::vector<TrianglePair>& out) {
  out.clear();
  if (at_end()) return;
  if (leaf_.empty()) {
    leaf_.resize(order_.size());
    for (std::uint32_t k = 0; k < order_.size(); ++k) leaf_[order_[k]] = k;
  }
  const auto left = static_cast<std::uint32_t>(items_.size()) - next_;
  const std::uint32_t asked = std::min(asked_, left);
  const std::size_t chunks = chunks_for(asked, 16, items_.size() < kLeast ? 1 : threads_);
  if (parts_.size() < chunks) parts_.resize(chunks);
  const std::size_t most_of_part = std::max<std::size_t>(most / chunks, 1);
  for_chunks(asked, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Part& part = parts_[chunk];
    part.pairs.clear();
    part.done = 0;
    part.compared = 0;
    part.marks.resize(items_.size() / 64 + 1);
    for (std::size_t k = begin; k < end && part.pairs.size() < most_of_part; ++k, ++part.done)
      append(next_ + static_cast<std::uint32_t>(k), part);
    part.complete = part.done == end - begin;
  });
  // Joins the parts in order, up to the first incomplete part. The next call continues from there.
  bool full = false;
  for (std::size_t chunk = 0; chunk < chunks && !full; ++chunk) {
    const Part& part = parts_[chunk];
    out.insert(out.end(), part.pairs.begin(), part.pairs.end());
    next_ += part.done;
    compared_ += part.compared;
    full = !part.complete;
  }
  if (full) {
    asked_ = std::max<std::uint32_t>(asked_ / 2, 1);
  } else if (out.size() < most / 4) {
    asked_ = std::min<std::uint32_t>(asked_ * 2, 1 << 16);
  }
}

HWY_EXPORT(pair_blocks_here);

void pair_blocks(const BlockTrees& trees, std::uint32_t a, std::uint32_t b, std::uint32_t from,
                 std::uint32_t to, std::size_t most, std::vector<BlockPair>& out, bool twice) {
  HWY_DYNAMIC_DISPATCH(pair_blocks_here)(trees, a, b, from, to, most, out, twice);
}

BlockTrees::BlockTrees(const TriangleBlocks& blocks, std::span<const Box> regions)
    : first_(blocks.first), trees_(blocks.objects.size()) {
  std::vector<FloatBox> leaves;
  for (std::uint32_t o = 0; o < trees_.size(); ++o) {
    if (regions[o].is_empty()) continue;
    leaves.resize(blocks.count(o));
    for (std::uint32_t k = 0; k < leaves.size(); ++k) leaves[k] = blocks.bound(o, k);
    const std::size_t at = nodes_.size();
    nodes_.resize(at + blocks_of_tree(leaves.size()));
    trees_[o] = make_tree<float>(leaves, nodes_, at);
  }
}

void BlockTrees::update(const TriangleBlocks& blocks, std::span<const std::uint32_t> changed) {
  std::vector<std::uint32_t> children;  // the nodes of one height whose boxes changed
  for (std::size_t begin = 0, end = 0; begin < changed.size(); begin = end) {
    const auto behind = std::ranges::upper_bound(first_, changed[begin]);
    const auto object = static_cast<std::uint32_t>(behind - first_.begin() - 1);
    BoxTree<float>& tree = trees_[object];
    children.clear();
    for (; end < changed.size() && changed[end] < *behind; ++end) {
      const std::uint32_t leaf = changed[end] - first_[object];
      nodes_[tree.first[0] + leaf / kWide].set(leaf % kWide, blocks.bound(object, leaf));
      children.push_back(leaf);
    }
    for (std::size_t height = 0; height < static_cast<std::size_t>(tree.levels); ++height) {
      std::size_t found = 0;  // number of parents, which overwrite the first entries of `children`
      for (const std::uint32_t child : children) {
        const std::uint32_t node = child / kWide;
        if (found > 0 && children[found - 1] == node) continue;
        children[found++] = node;
        FloatBox all = kNowhere;
        for (std::size_t k = 0; k < kWide; ++k) all.add(nodes_[tree.first[height] + node].get(k));
        if (height + 1 < static_cast<std::size_t>(tree.levels)) {
          nodes_[tree.first[height + 1] + node / kWide].set(node % kWide, all);
        } else {
          tree.box = all;
        }
      }
      children.resize(found);
    }
  }
}

std::vector<std::uint32_t> blocks_in(const BlockPairs& pairs, std::size_t blocks) {
  std::vector<std::uint8_t> used(blocks, 0);
  for (const BlockPair& pair : pairs.between) used[pair.a] = used[pair.b] = 1;
  for (const BlockPair& pair : pairs.inside) used[pair.a] = used[pair.b] = 1;
  std::vector<std::uint32_t> out;
  for (std::uint32_t block = 0; block < blocks; ++block) {
    if (used[block]) out.push_back(block);
  }
  return out;
}

namespace {

// The lanes of all blocks that occur in some pairs.
struct Lanes {
  std::vector<std::uint32_t> place;  // per block: index of its lanes, or TriangleBlocks::kNoLanes
  UninitializedVector<BlockLanes> more;  // the indices follow those of TriangleBlocks::lanes
};

// Calls work(block, triangles) for each block in `some`, with the triangles of the block.
template <class Work>
void for_triangles_of(const Scene& scene, const TriangleBlocks& blocks,
                      std::span<const std::uint32_t> some, unsigned threads, const Work& work) {
  for_chunks(some.size(), chunks_for(some.size(), 128, threads),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) {
                 std::array<std::uint32_t, kWide> triangles;
                 const TriangleBlock& range = blocks.ranges[some[k]];
                 for (std::uint32_t i = 0; i < range.count; ++i) {
                   triangles[i] = blocks.triangle(range.first + i);
                   prefetch(scene, triangles[i]);
                 }
                 work(some[k], std::span<const std::uint32_t>(triangles).first(range.count));
               }
             });
}

Lanes lanes_of(const Scene& scene, const TriangleBlocks& blocks, const BlockPairs& pairs,
               double clearance, unsigned threads) {
  Lanes out;
  out.place = blocks.lane_places();
  const auto given = static_cast<std::uint32_t>(blocks.lanes.size());
  std::vector<std::uint32_t> missing = blocks_in(pairs, blocks.ranges.size());
  std::erase_if(missing, [&](std::uint32_t block) { return out.place[block] != blocks.kNoLanes; });
  std::uint32_t next = given;
  for (const std::uint32_t block : missing) out.place[block] = next++;
  out.more.resize(missing.size());
  for_triangles_of(scene, blocks, missing, threads, [&](std::uint32_t block, const auto& own) {
    fill_lanes(scene, own, half_of(clearance), blocks.origin, out.more[out.place[block] - given]);
  });
  return out;
}

// Returns the vertex indices of blocks, indexed by Lanes::place. Sets only the blocks in `pairs`.
UninitializedVector<VertexBlock> vertices_of(const Scene& scene, const TriangleBlocks& blocks,
                                             const Lanes& lanes, std::span<const BlockPair> pairs,
                                             unsigned threads) {
  UninitializedVector<VertexBlock> out(blocks.lanes.size() + lanes.more.size());
  const std::vector<std::uint32_t> used =
      blocks_in({.between = {pairs.begin(), pairs.end()}, .inside = {}}, blocks.ranges.size());
  for_triangles_of(scene, blocks, used, threads, [&](std::uint32_t block, const auto& own) {
    for (std::uint32_t k = 0; k < kWide; ++k) {
      for (std::size_t c = 0; c < 3; ++c)
        out[lanes.place[block]].corner[c][k] = k < own.size() ? scene.triangles[own[k]][c] : 0;
    }
  });
  return out;
}

// Returns the normals of blocks, indexed by Lanes::place. Sets only the blocks in `pairs`. Returns
// an empty vector if the coordinates are too large or too small for floats.
UninitializedVector<NormalLanes> normals_of(const Scene& scene, const TriangleBlocks& blocks,
                                            const Lanes& lanes, const BlockPairs& pairs,
                                            double clearance, unsigned threads) {
  UninitializedVector<NormalLanes> out;
  const std::vector<std::uint32_t> used = blocks_in(pairs, blocks.ranges.size());
  const LaneSpans all{.first = blocks.lanes, .second = lanes.more};
  float reach = 0;
  for (const std::uint32_t block : used) {
    const FloatBox& bound = all[lanes.place[block]].bound;
    for (std::size_t k = 0; k < 3; ++k)
      reach = std::max({reach, std::abs(bound.lo[k]), std::abs(bound.hi[k])});
  }
  const auto margin = normal_margin(reach, clearance);
  if (!margin) return out;
  out.resize(blocks.lanes.size() + lanes.more.size());
  for_triangles_of(scene, blocks, used, threads, [&](std::uint32_t block, const auto& own) {
    fill_normals(scene, own, blocks.origin, *margin, out[lanes.place[block]]);
  });
  return out;
}

constexpr std::size_t kAtOnce = 2048;  // at most this many pairs of blocks are compared at a time

}  // namespace

std::uint64_t give_findings(
    const Scene& scene, std::size_t count, double clearance, unsigned threads,
    const std::function<void(std::size_t begin, std::size_t end, BlockFindings& out)>& find,
    const TakePairs& take) {
  constexpr std::size_t kLeastOfThread = 64;
  const std::size_t portion = std::clamp(count / 16, kLeastOfThread, kAtOnce);
  return give_portions<BlockFindings>(
      count, portion, chunks_for(count, kLeastOfThread, threads), take,
      [&](std::size_t begin, std::size_t end, BlockFindings& findings, const auto& flush) {
        find(begin, end, findings);
        for (const TrianglePair& pair : findings.perhaps) {
          if (boxes_meet(scene, pair, half_of(clearance))) findings.pairs.push_back(pair);
        }
        findings.perhaps.clear();
        flush();
      });
}

std::uint64_t give_pairs_of_some(const Scene& scene, const TriangleBlocks& blocks,
                                 const BlockPairs& some, bool along_normals, double clearance,
                                 bool neighbours, unsigned threads, const TakePairs& take) {
  const Lanes lanes = lanes_of(scene, blocks, some, clearance, threads);
  const UninitializedVector<NormalLanes> normals =
      along_normals ? normals_of(scene, blocks, lanes, some, clearance, threads)
                    : UninitializedVector<NormalLanes>();
  const auto give = [&](std::span<const BlockPair> part, std::span<const VertexBlock> vertices) {
    return give_findings(
        scene, part.size(), clearance, threads,
        [&](std::size_t begin, std::size_t end, BlockFindings& out) {
          std::array<LanePair, kAtOnce> pairs;
          for (std::size_t k = begin; k < end; ++k)
            pairs[k - begin] = {lanes.place[part[k].a], lanes.place[part[k].b], !vertices.empty()};
          compare_blocks({.first = blocks.lanes, .second = lanes.more}, vertices, normals,
                         std::span(pairs).first(end - begin), out);
        },
        take);
  };
  std::uint64_t given = give(some.between, {});
  if (neighbours) return given + give(some.inside, {});
  // Holds the vertex indices for only one part of the pairs at a time, to save memory.
  constexpr std::size_t kParts = 8, kLeastOfPart = std::size_t{1} << 16;
  const std::size_t part = std::max(some.inside.size() / kParts, kLeastOfPart);
  for (std::size_t from = 0; from < some.inside.size(); from += part) {
    const auto pairs =
        std::span(some.inside).subspan(from, std::min(part, some.inside.size() - from));
    given += give(pairs, vertices_of(scene, blocks, lanes, pairs, threads));
  }
  return given;
}

std::vector<TrianglePair> sorted_pairs(
    unsigned threads, const std::function<std::uint64_t(const TakePairs& take)>& give) {
  std::mutex mutex;
  std::vector<std::vector<TrianglePair>> parts;
  give([&](std::vector<TrianglePair>& some) {
    const std::scoped_lock lock(mutex);
    parts.push_back(std::move(some));
  });
  return sorted_unique(std::move(parts), threads);
}

}  // namespace farcull
#endif
