// Pairs of blocks whose boxes overlap, and the pairs of their triangles whose boxes do, on lanes
// (Google Highway): one box is compared with as many others at once as a vector holds.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/boxes/triangle_blocks.h"

namespace farcull {

/// The blocks of each object as a tree of boxes.
class BlockTrees {
 public:
  /// Objects with an empty region have no tree.
  BlockTrees(const TriangleBlocks& blocks, std::span<const Box> regions);

  /// Its leaves are the blocks of the object, counted from 0.
  const BoxTree<float>& tree(std::uint32_t object) const { return trees_[object]; }
  const WideBoxes<float>* nodes() const { return nodes_.data(); }
  std::uint32_t first_block(std::uint32_t object) const { return blocks_->first[object]; }

 private:
  const TriangleBlocks* blocks_;
  std::vector<BoxTree<float>> trees_;
  std::vector<WideBoxes<float>> nodes_;
};

/// Two blocks, as indices of TriangleBlocks.
struct BlockPair {
  std::uint32_t a, b;
  auto operator<=>(const BlockPair&) const = default;
};

/// Appends the pairs of a block in from .. to - 1 (of object a) and a block of object b whose boxes
/// overlap; if a and b are one object, those with a <= b. Stops after more than `most` pairs.
void pair_blocks(const BlockTrees& trees, std::uint32_t a, std::uint32_t b, std::uint32_t from,
                 std::uint32_t to, std::size_t most, std::vector<BlockPair>& out);

struct BlockPairs {
  std::vector<BlockPair> between;  // of different objects
  std::vector<BlockPair> inside;   // of one object that collides with itself; a <= b
  std::size_t size() const { return between.size() + inside.size(); }
};

/// The blocks of some pairs, ascending. blocks: number of blocks of the scene.
std::vector<std::uint32_t> blocks_in(const BlockPairs& pairs, std::size_t blocks);

/// Pairs of blocks whose boxes overlap. Two triangles that are at most the clearance apart have
/// grown boxes with a common point, which lies in the boxes of their blocks: so their blocks are a
/// pair here, or their objects are left to views.
struct BlockMeetings {
  std::shared_ptr<const TriangleBlocks> of;
  BlockPairs pairs;
  std::vector<TrianglePair> kept;  // pairs of the frame before that are right in this one too
  std::uint64_t overlaps = 0;   // pairs of blocks whose boxes overlap, also those in which nothing
                                // moved, which stand in no list
  std::uint64_t meetings = 0;   // of two objects, or of one with itself, that these decide
  std::uint64_t triangles = 0;  // in all blocks of a pair
  bool empty() const { return meetings == 0; }
};

/// The pairs a < b of triangles of some pairs of blocks whose boxes overlap, sorted, each once.
/// neighbours: false leaves out pairs of one object that share a vertex index.
std::vector<TrianglePair> pairs_of_some(const Scene& scene, const TriangleBlocks& blocks,
                                        const BlockPairs& pairs, double clearance, bool neighbours,
                                        unsigned threads);
/// The same for all pairs of the meetings, with the pairs that were kept.
std::vector<TrianglePair> pairs_of_blocks(const Scene& scene, const BlockMeetings& meetings,
                                          double clearance, bool neighbours, unsigned threads);

/// The vertex indices of the triangles of a block, by corner.
struct alignas(64) VertexBlock {
  std::array<std::array<std::uint32_t, kWide>, 3> corner;
};
/// Pairs of triangles that a comparison finds, the smaller one first.
struct BlockFindings {
  std::vector<TrianglePair> certain;  // their boxes overlap
  std::vector<TrianglePair> perhaps;  // they touch in floats
};
/// The lanes of `first`, and behind them those of `second`.
struct LaneSpans {
  std::span<const BlockLanes> first, second;
  const BlockLanes& operator[](std::uint32_t k) const {
    return k < first.size() ? first[k] : second[k - first.size()];
  }
};
/// Two of them to compare; one with itself: each two of its triangles.
struct LanePair {
  std::uint32_t a, b;
  bool drops_neighbours;  // leaves out pairs that share a vertex index
};
/// vertices: of all lanes; may be empty if no pair drops neighbours.
void compare_blocks(const LaneSpans& lanes, std::span<const VertexBlock> vertices,
                    std::span<const LanePair> pairs, BlockFindings& out);

}  // namespace farcull
