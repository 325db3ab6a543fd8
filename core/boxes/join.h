// Finds pairs of overlapping boxes with a tree. Finds all pairs at once, or a limited number at a
// time so that memory does not grow with the number of pairs.
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

/// Returns all pairs a < b of `items` with different owners whose closed boxes overlap, sorted. If
/// there are more than `most` pairs, returns most + 1 of them. Compares boxes in doubles, without
/// rounding. Empty boxes overlap nothing. owners: per box, a number. items: indices into boxes and
/// owners. threads: 0 for one per core; the result does not depend on `threads`.
std::vector<TrianglePair> box_join(std::span<const Box> boxes,
                                   std::span<const std::uint32_t> owners,
                                   std::span<const std::uint32_t> items,
                                   std::size_t most = SIZE_MAX, unsigned threads = 1);

/// Returns the owner of each triangle for box_join(). The owner is the object, but each triangle of
/// an object marked `self` is its own owner. So box_join() also finds pairs inside such an object.
std::vector<std::uint32_t> join_owners(const Scene& scene);

/// A function that receives pairs: some thousands in each call, in no particular order. Several
/// threads may call the function at once. The function may change the list.
using TakePairs = std::function<void(std::vector<TrianglePair>& some)>;

/// Finds all pairs a < b with different owners and overlapping boxes. next() gives sorted pairs.
class OrderedPairs {
 public:
  /// Finds pairs of triangles of different objects, and pairs inside objects marked `self`. Boxes
  /// are grown by half the clearance (core/boxes/block.h). clearance: world units, finite, >= 0.
  /// ignored: pairs of objects whose triangles are not paired; a result of in_order(). neighbours:
  /// false leaves out pairs of triangles of one object that share a vertex index. threads: 0 for
  /// one per core; the pairs do not depend on `threads`. Uses O(items) memory. The scene must
  /// outlive this object.
  OrderedPairs(const Scene& scene, double clearance, std::span<const ObjectPair> ignored,
               bool neighbours, unsigned threads);
  /// Finds the same pairs as box_join(). Copies the boxes and owners.
  OrderedPairs(std::span<const Box> boxes, std::span<const std::uint32_t> owners,
               std::span<const std::uint32_t> items, unsigned threads);

  /// Sets `out` to about the next `most` pairs. `out` may have more pairs, because each thread
  /// finishes its last item. `out` may be empty before at_end() is true. Precondition: most > 0.
  void next(std::size_t most, std::vector<TrianglePair>& out);
  bool at_end() const { return next_ == items_.size(); }
  /// Gives all pairs to `take`, and returns their number. Precondition: next() was not called. If
  /// `take` throws, stops and rethrows the exception.
  std::uint64_t give(const TakePairs& take);
  /// Returns all pairs that next() has not given yet. If there are more than `most` pairs, returns
  /// most + 1 of them.
  std::vector<TrianglePair> all(std::size_t most = SIZE_MAX);
  /// Returns the fraction of the items whose pairs have been given, 0 .. 1.
  double share() const {
    return items_.empty() ? 1 : static_cast<double>(next_) / static_cast<double>(items_.size());
  }
  /// Returns how many times an item was compared with a block of sixteen boxes. The number does not
  /// depend on threads. give() needs fewer comparisons than next().
  std::uint64_t compared() const { return compared_; }

 private:
  // The pairs of some consecutive items. The object is kept from call to call, because getting new
  // memory from the system takes longer than finding the pairs.
  struct Part {
    std::vector<TrianglePair> pairs;
    std::uint32_t done = 0;  // number of items whose pairs are in `pairs`
    std::uint64_t compared = 0;
    bool complete = false;
    std::vector<std::uint32_t> found;
    std::vector<std::uint64_t> marks;
  };
  void append(std::uint32_t a, Part& part) const;  // appends item a's pairs with items b > a
  void append_of_leaf(std::uint32_t leaf, Part& part) const;  // appends pairs with later leaves
  void find(std::uint32_t leaf, std::uint32_t least, Part& part) const;
  std::uint32_t first_of_later_owners(std::uint32_t item) const;
  bool is_asked(const TrianglePair& pair) const;  // false: the pair is to be left out

  void plant(std::vector<Box> boxes);  // makes the tree over the boxes of the items
  void drop_apart(std::vector<Box>& boxes);

  const Scene* scene_ = nullptr;  // set only if neighbours are left out
  std::vector<std::uint32_t>
      objects_;  // per triangle: its object; set only if neighbours are left out
  std::optional<IgnoredObjects> ignored_;
  unsigned threads_;
  std::vector<std::uint32_t> owner_;  // per item: its owner
  std::vector<std::uint32_t> items_;  // ascending
  std::vector<std::uint32_t> order_;  // per leaf of the tree: the index of its item in items_
  std::vector<std::uint32_t> leaf_;   // per item: its leaf
  bool by_owner_ = false;             // leaves are grouped by owner, in order
  std::vector<WideBoxes<double>> blocks_;
  BoxTree<double> tree_;
  std::uint64_t compared_ = 0;
  std::uint32_t next_ = 0;      // the first item whose pairs have not been given
  std::uint32_t asked_ = 1024;  // next() finds the pairs of at most this many items
  std::vector<Part> parts_;
};

/// A tree of boxes for each object. The leaves are the boxes of the object's blocks.
class BlockTrees {
 public:
  /// regions: one per object. An object with an empty region gets no tree.
  BlockTrees(const TriangleBlocks& blocks, std::span<const Box> regions);
  /// Updates the trees after some boxes of blocks have changed. changed: the blocks with changed
  /// boxes, ascending. Preconditions: blocks.origin is unchanged, and every object has a tree.
  void update(const TriangleBlocks& blocks, std::span<const std::uint32_t> changed);

  /// Returns the object's tree. Leaf k is block k of the object.
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

/// Compares the blocks from .. to - 1 of object a with all blocks of object b. Appends the pairs
/// of blocks whose boxes overlap. If a == b and `twice` is false, appends only pairs (s, t) with
/// s <= t. Stops when `out` has more than `most` pairs.
void pair_blocks(const BlockTrees& trees, std::uint32_t a, std::uint32_t b, std::uint32_t from,
                 std::uint32_t to, std::size_t most, std::vector<BlockPair>& out,
                 bool twice = false);

struct BlockPairs {
  std::vector<BlockPair> between;  // pairs of blocks of different objects
  std::vector<BlockPair> inside;   // pairs of blocks of the same object; a <= b
  std::size_t size() const { return between.size() + inside.size(); }
};

/// Returns the blocks that occur in the pairs, ascending. blocks: the number of all blocks.
std::vector<std::uint32_t> blocks_in(const BlockPairs& pairs, std::size_t blocks);

/// Pairs of blocks whose boxes overlap. Two triangles at most the clearance apart are always in two
/// blocks of such a pair: the grown boxes of the triangles have a common point, and the boxes of
/// the blocks contain this point.
struct BlockMeetings {
  std::shared_ptr<const TriangleBlocks> of;
  std::shared_ptr<const OrientedBlocks> oriented;  // null: only boxes along the axes are compared
  bool normals = false;  // triangles are also compared along their normals
  BlockPairs pairs;
  std::vector<TrianglePair> kept;  // pairs of the last frame that are still valid
  std::uint64_t overlaps = 0;   // number of all overlapping pairs of blocks. `pairs` has only the
                                // pairs with a moved block if the last frame is reused
  std::uint64_t meetings = 0;   // number of pairs of objects (core/boxes/meetings.h)
  std::uint64_t triangles = 0;  // number of triangles in all blocks that are in a pair
  bool moved = false;  // boxes of blocks were moved with their objects (core/boxes/rigid.h)
  bool empty() const { return meetings == 0; }
};

/// For each pair of blocks in `pairs`, gives to `take` all pairs a < b of their triangles whose
/// boxes overlap. Returns the number of triangle pairs given. along_normals: true leaves out a pair
/// if the normal of one triangle separates the triangle from the box of the other triangle.
/// neighbours: false leaves out pairs of triangles of one object that share a vertex index.
/// Precondition: `pairs` lists each pair of blocks once. If `take` throws, stops and rethrows the
/// exception.
std::uint64_t give_pairs_of_some(const Scene& scene, const TriangleBlocks& blocks,
                                 const BlockPairs& pairs, bool along_normals, double clearance,
                                 bool neighbours, unsigned threads, const TakePairs& take);

/// Calls give(take) and returns all pairs that `give` passes to `take`, sorted, each once.
std::vector<TrianglePair> sorted_pairs(
    unsigned threads, const std::function<std::uint64_t(const TakePairs& take)>& give);

/// Calls find(begin, end, findings) for portions of the numbers 0 .. count - 1. Gives to `take` all
/// pairs of findings.pairs, and each pair of findings.perhaps whose boxes overlap in doubles.
/// Returns the number of pairs given. Rethrows exceptions of `find` and `take`.
std::uint64_t give_findings(
    const Scene& scene, std::size_t count, double clearance, unsigned threads,
    const std::function<void(std::size_t begin, std::size_t end, BlockFindings& out)>& find,
    const TakePairs& take);

}  // namespace farcull
