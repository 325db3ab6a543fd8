// Pairs of runs whose boxes overlap, and the pairs of their triangles whose boxes do, on lanes
// (Google Highway): one box is compared with as many others at once as a vector holds.
//
// Boxes are taken relative to a common origin and rounded to float. Subtraction and rounding never
// decrease, so boxes that overlap still do; and where floats are less, so were the doubles. So no
// margin is needed, and only boxes that touch in floats are looked at again in doubles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/pairs/runs.h"

namespace farcull {

/// Sixteen boxes as columns: x0, y0, z0, x1, y1, z1. A missing one meets nothing.
struct alignas(64) BoxBlock {
  std::array<std::array<float, 16>, 6> column;
};
static_assert(kRun == 16);

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
  const Vec3& origin() const { return origin_; }
  const Tree& tree(std::uint32_t object) const { return trees_[object]; }
  const BoxBlock* blocks() const { return blocks_.data(); }
  std::uint32_t first_run(std::uint32_t object) const { return runs_->first[object]; }

 private:
  const Runs* runs_;
  Vec3 origin_;
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

/// The triangles of a run. What stands behind the last one is set to a box that meets nothing.
struct RunBlock {
  BoxBlock boxes;
  alignas(64) std::array<std::uint32_t, 16> triangles;
  std::array<float, 6> bound;  // of all of them
};
/// The vertex indices of the triangles of a run, by corner.
struct alignas(64) VertexBlock {
  std::array<std::array<std::uint32_t, 16>, 3> corner;
};
/// The block of a run of these triangles, grown by half the clearance (world units), relative to
/// the origin; their vertices too where `vertices` is not null.
void fill_block(const Scene& scene, std::span<const std::uint32_t> triangles, const Vec3& origin,
                double clearance, RunBlock& out, VertexBlock* vertices = nullptr);

/// What a comparison finds: pairs of triangles, the smaller one first.
struct RunFindings {
  std::vector<TrianglePair> certain;  // their boxes overlap
  std::vector<TrianglePair> perhaps;  // they touch in floats
};
/// Two blocks to compare; one with itself: each two of its triangles.
struct BlockPair {
  std::uint32_t a, b;
  bool drops_neighbours;  // leaves out pairs that share a vertex index
};
/// vertices: of all blocks; empty where no pair drops neighbours.
void compare_blocks(std::span<const RunBlock> blocks, std::span<const VertexBlock> vertices,
                    std::span<const BlockPair> pairs, RunFindings& out);

}  // namespace farcull
