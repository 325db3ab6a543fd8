// Pairs of runs whose boxes overlap, and the pairs of their triangles whose boxes do, on lanes
// (Google Highway): one box is compared with as many others at once as a vector holds.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/pairs/box_block.h"
#include "core/pairs/runs.h"

namespace farcull {

/// The runs of each object as a tree of boxes: sixteen boxes a block, one block a box of the next
/// level.
class RunTrees {
 public:
  /// Of the objects whose region is not empty; the others have no tree.
  RunTrees(const Runs& runs, std::span<const Box> regions);

  static constexpr int kMostLevels = 8;  // 2^31 triangles
  struct Tree {
    int levels = 0;  // the highest one is a single block; 0: no triangle
    std::array<std::size_t, kMostLevels> first{};  // of each level, into blocks
  };
  const Tree& tree(std::uint32_t object) const { return trees_[object]; }
  const BoxBlock* blocks() const { return blocks_.data(); }
  std::uint32_t first_run(std::uint32_t object) const { return runs_->first[object]; }

 private:
  const Runs* runs_;
  std::vector<Tree> trees_;
  std::vector<BoxBlock> blocks_;
};

/// Two runs, as indices of Runs.
struct RunPair {
  std::uint32_t a, b;
  auto operator<=>(const RunPair&) const = default;
};

/// Appends the pairs of a run in from .. to - 1 (of object a) and a run of object b whose boxes
/// overlap; of one object with itself those with a <= b. Stops where there are more than `most`.
void pair_runs(const RunTrees& trees, std::uint32_t a, std::uint32_t b, std::uint32_t from,
               std::uint32_t to, std::size_t most, std::vector<RunPair>& out);

/// The vertex indices of the triangles of a run, by corner.
struct alignas(64) VertexBlock {
  std::array<std::array<std::uint32_t, 16>, 3> corner;
};
void fill_vertices(const Scene& scene, std::span<const std::uint32_t> triangles, VertexBlock& out);

/// What a comparison finds: pairs of triangles, the smaller one first.
struct RunFindings {
  std::vector<TrianglePair> certain;  // their boxes overlap
  std::vector<TrianglePair> perhaps;  // they touch in floats
};
/// The blocks of `first`, and behind them those of `second`.
struct BlockSpans {
  std::span<const RunBlock> first, second;
  const RunBlock& operator[](std::uint32_t k) const {
    return k < first.size() ? first[k] : second[k - first.size()];
  }
};
/// Two blocks to compare; one with itself: each two of its triangles.
struct BlockPair {
  std::uint32_t a, b;
  bool drops_neighbours;  // leaves out pairs that share a vertex index
};
/// vertices: of all blocks; empty where no pair drops neighbours.
void compare_blocks(const BlockSpans& blocks, std::span<const VertexBlock> vertices,
                    std::span<const BlockPair> pairs, RunFindings& out);

}  // namespace farcull
