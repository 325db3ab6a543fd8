// Finds pairs of overlapping boxes with a tree: all at once, or in order and some at a time, so
// that memory does not grow with the number of pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/boxes/block.h"
#include "core/boxes/compare.h"
#include "core/boxes/triangle_blocks.h"
#include "core/scene/scene.h"

namespace farcull {

struct OrientedBlocks;  // core/boxes/oriented.h

/// All pairs a < b of `items` (indices into boxes and owners) that have different owners and closed
/// boxes that overlap, sorted. Exact: compares doubles only. Empty boxes overlap nothing. If there
/// are more than `most`, returns most + 1 of them. threads: 0 for as many as there are cores;
/// changes no answer.
std::vector<TrianglePair> box_join(std::span<const Box> boxes,
                                   std::span<const std::uint32_t> owners,
                                   std::span<const std::uint32_t> items,
                                   std::size_t most = SIZE_MAX, unsigned threads = 1);

/// Owners for box_join() with which it also finds pairs inside objects marked `self`: each triangle
/// of such an object is an owner of its own.
std::vector<std::uint32_t> join_owners(const Scene& scene);

/// A function that takes pairs: some thousands at a time, in no order, from several threads at
/// once. May change the list.
using TakePairs = std::function<void(std::vector<TrianglePair>& some)>;

/// All pairs a < b of items of different owners whose closed boxes overlap, in ascending order.
class OrderedPairs {
 public:
  /// Pairs of triangles of different objects, and of one object if it is `self`. Boxes are grown by
  /// half the clearance. Two triangles at the clearance or less are such a pair
  /// (core/boxes/block.h), so none that collides is left out.
  /// clearance: world units, finite, >= 0. ignored: as in_order() gives them; their pairs are left
  /// out. neighbours: false leaves out pairs of one object that share a vertex index. threads: 0
  /// for as many as there are cores; changes no answer. Memory O(items). The scene must outlive
  /// this object.
  OrderedPairs(const Scene& scene, double clearance, std::span<const ObjectPair> ignored,
               bool neighbours, unsigned threads);
  /// Pairs of `items`, as box_join(); boxes and owners are copied. threads: as above.
  OrderedPairs(std::span<const Box> boxes, std::span<const std::uint32_t> owners,
               std::span<const std::uint32_t> items, unsigned threads);

  /// Replaces `out` by about the next `most` pairs, fewer at the end. May exceed `most` by all
  /// pairs of one item per thread; may be empty before the end. Precondition: most > 0.
  void next(std::size_t most, std::vector<TrianglePair>& out);
  bool at_end() const { return next_ == items_.size(); }
  /// Gives all pairs to `take`, and returns their number. Precondition: next() was not called. If
  /// `take` throws, the exception is thrown again here, and some pairs were not given.
  std::uint64_t give(const TakePairs& take);
  /// All pairs that are left; if there are more than `most`, most + 1 of them.
  std::vector<TrianglePair> all(std::size_t most = SIZE_MAX);
  /// The share of the items whose pairs have been given, 0 .. 1.
  double share() const {
    return items_.empty() ? 1 : static_cast<double>(next_) / static_cast<double>(items_.size());
  }
  /// Number of blocks of sixteen boxes that items were compared with. Does not depend on the
  /// threads or on `most`, but is smaller for give() than for next().
  std::uint64_t compared() const { return compared_; }

 private:
  // The pairs of some items that follow one another. Kept from call to call, because the system
  // clears new memory, which takes longer than finding the pairs.
  struct Part {
    std::vector<TrianglePair> pairs;
    std::uint32_t done = 0;  // number of items whose pairs these are
    std::uint64_t compared = 0;
    bool complete = false;
    std::vector<std::uint32_t> found;
    std::vector<std::uint64_t> marks;
  };
  void append(std::uint32_t a, Part& part) const;             // pairs of item a, in order
  void append_of_leaf(std::uint32_t leaf, Part& part) const;  // pairs with later leaves
  void find(std::uint32_t leaf, std::uint32_t least, Part& part) const;
  std::uint32_t first_of_later_owners(std::uint32_t item) const;
  bool is_asked(const TrianglePair& pair) const;  // not ignored, not left out as neighbours

  void plant(std::vector<Box> boxes);  // makes the tree over the boxes of the items
  void drop_apart(std::vector<Box>& boxes);

  const Scene* scene_ = nullptr;        // not null if neighbours are left out
  std::vector<std::uint32_t> objects_;  // per triangle, if neighbours are left out
  std::optional<IgnoredObjects> ignored_;
  unsigned threads_;
  std::vector<std::uint32_t> owner_;  // per item
  std::vector<std::uint32_t> items_;  // ascending
  std::vector<std::uint32_t> order_;  // per leaf of the tree: the index of its item in items_
  std::vector<std::uint32_t> leaf_;   // per item: its leaf
  bool by_owner_ = false;             // leaves are grouped by owner, in order
  std::vector<WideBoxes<double>> blocks_;
  BoxTree<double> tree_;
  std::uint64_t compared_ = 0;
  std::uint32_t next_ = 0;      // the first item whose pairs have not been given
  std::uint32_t asked_ = 1024;  // items to search for at a time
  std::vector<Part> parts_;
};

/// The blocks of each object as a tree of boxes.
class BlockTrees {
 public:
  /// Objects with an empty region have no tree.
  BlockTrees(const TriangleBlocks& blocks, std::span<const Box> regions);
  /// Updates the trees after the boxes of these blocks (ascending, each once) have changed.
  /// Precondition: blocks.origin is unchanged, and every object has a tree.
  void update(const TriangleBlocks& blocks, std::span<const std::uint32_t> changed);

  /// Its leaves are the blocks of the object, counted from 0.
  const BoxTree<float>& tree(std::uint32_t object) const { return trees_[object]; }
  const WideBoxes<float>* nodes() const { return nodes_.data(); }
  std::uint32_t first_block(std::uint32_t object) const { return first_[object]; }

 private:
  std::vector<std::uint32_t> first_;  // as TriangleBlocks::first
  std::vector<BoxTree<float>> trees_;
  std::vector<WideBoxes<float>> nodes_;
};

/// Two blocks, as indices of TriangleBlocks.
struct BlockPair {
  std::uint32_t a, b;
  auto operator<=>(const BlockPair&) const = default;
};

/// Appends the pairs of a block from .. to - 1 (of object a) and a block of object b whose boxes
/// overlap. If a == b and not `twice`, only pairs whose first block is not after the second. Stops
/// after more than `most` pairs.
void pair_blocks(const BlockTrees& trees, std::uint32_t a, std::uint32_t b, std::uint32_t from,
                 std::uint32_t to, std::size_t most, std::vector<BlockPair>& out,
                 bool twice = false);

struct BlockPairs {
  std::vector<BlockPair> between;  // of different objects
  std::vector<BlockPair> inside;   // of one object that collides with itself; a <= b
  std::size_t size() const { return between.size() + inside.size(); }
};

/// The numbers of the blocks that occur in the pairs, ascending. blocks: number of all blocks.
std::vector<std::uint32_t> blocks_in(const BlockPairs& pairs, std::size_t blocks);

/// Pairs of blocks whose boxes overlap. If two triangles are at most the clearance apart, their
/// grown boxes have a common point, which lies in the boxes of their blocks. So their blocks are a
/// pair here.
struct BlockMeetings {
  std::shared_ptr<const TriangleBlocks> of;
  std::shared_ptr<const OrientedBlocks> oriented;  // null: only boxes along the axes are compared
  bool normals = false;                            // triangles are compared along their normals too
  BlockPairs pairs;
  std::vector<TrianglePair> kept;  // pairs of the last frame that are still right
  std::uint64_t overlaps = 0;      // pairs of blocks whose boxes overlap; `pairs` lacks those in
                                   // which nothing moved
  std::uint64_t meetings = 0;      // pairs of objects, or of one and itself, that blocks decide
  std::uint64_t triangles = 0;     // in all blocks that are in a pair
  bool moved = false;  // boxes were kept, and moved with their objects (core/boxes/rigid.h)
  bool empty() const { return meetings == 0; }
};

/// Gives to `take` the pairs a < b of triangles, of these pairs of blocks, whose boxes overlap.
/// Returns their number. Blocks share no triangle, so no pair is given twice unless a pair of
/// blocks is listed twice. along_normals: leaves out pairs in which the normal of one triangle
/// separates it from the other's box. neighbours: false leaves out pairs of one object that share a
/// vertex index. If `take` throws, the exception is thrown again here, and some pairs were not
/// given.
std::uint64_t give_pairs_of_some(const Scene& scene, const TriangleBlocks& blocks,
                                 const BlockPairs& pairs, bool along_normals, double clearance,
                                 bool neighbours, unsigned threads, const TakePairs& take);

/// Returns the pairs that `give(take)` gives to `take`, sorted.
std::vector<TrianglePair> sorted_pairs(
    unsigned threads, const std::function<std::uint64_t(const TakePairs& take)>& give);

/// Calls find(begin, end, findings) for portions of the numbers 0 .. count - 1. Gives to `take` all
/// `pairs` that `find` appends, and each pair of `perhaps` whose boxes overlap in doubles. Returns
/// how many it gave. Exceptions of `find` and `take` are thrown again here.
std::uint64_t give_findings(
    const Scene& scene, std::size_t count, double clearance, unsigned threads,
    const std::function<void(std::size_t begin, std::size_t end, BlockFindings& out)>& find,
    const TakePairs& take);

}  // namespace farcull
