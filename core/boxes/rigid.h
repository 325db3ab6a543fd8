// Objects that move as a whole. The triangles of an object are fixed in the object's own frame. So
// their blocks and the tree of boxes are made only once. Each motion is first applied to boxes, and
// then only to the vertices of blocks whose moved boxes overlap.
//
// No margin is needed. The coordinates of a moved box come from the same operations that move a
// vertex. Each operation is rounded monotonically, so the moved box contains every moved vertex
// (docs/reliability.md, "Objects that move as a whole").
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/boxes/block.h"
#include "core/boxes/meetings.h"
#include "core/boxes/triangle_blocks.h"
#include "core/scene/scene.h"

namespace farcull {

/// Moves a point p to r p + t. All numbers are finite. The matrix r may be any 3 x 3 matrix.
struct RigidMotion {
  std::array<double, 9> r = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  std::array<double, 3> t = {0, 0, 0};
};

/// Returns one coordinate of a moved point. Rounds after each product and each sum, in this order.
/// row: one of the three rows of r.
inline double moved_coordinate(const double* row, double x, double y, double z, double t) {
  return ((row[0] * x + row[1] * y) + row[2] * z) + t;
}
inline Vec3 moved(const RigidMotion& motion, const Vec3& p) {
  const double* const r = motion.r.data();
  return {moved_coordinate(r, p.x(), p.y(), p.z(), motion.t[0]),
          moved_coordinate(r + 3, p.x(), p.y(), p.z(), motion.t[1]),
          moved_coordinate(r + 6, p.x(), p.y(), p.z(), motion.t[2])};
}
/// Returns a closed box that contains moved(motion, p) for each point p of `box`. Preconditions:
/// the box is not empty, and the moved box is finite.
Box moved(const RigidMotion& motion, const Box& box);

/// The blocks of a scene and a tree for each object. Boxes are in the frame of their object.
struct RigidBlocks {
  /// The blocks, in the order of spatial_order(), without boxes and lanes. decide_by_motions() sets
  /// the members `objects` and `origin`.
  std::shared_ptr<TriangleBlocks> of;
  std::vector<std::uint32_t> object_of;     // per block
  std::vector<std::uint32_t> first_vertex;  // per block and one past the last: index in `vertices`
  std::vector<std::uint32_t> vertices;      // vertex indices of each block, each once per block
  std::vector<BoxTree<double>> trees;       // per object: tree over its blocks; boxes not grown
  std::vector<WideBoxes<double>> nodes;

  std::span<const std::uint32_t> vertices_of(std::uint32_t block) const {
    return std::span(vertices).subspan(first_vertex[block],
                                       first_vertex[block + 1] - first_vertex[block]);
  }
};

/// Makes the blocks and trees. threads: 0 for one per core.
RigidBlocks make_rigid_blocks(const Scene& scene, unsigned threads);

/// Decides for the moved objects as decide_by_blocks() does, but reads no vertices. Returns empty
/// if an object is tested against itself, a moved box may be infinite, or too many boxes overlap.
/// Then call decide_by_blocks() instead. motions: one per object. ignored: see find_meetings().
std::optional<BlockDecision> decide_by_motions(const Scene& scene,
                                               std::span<const RigidMotion> motions,
                                               double clearance,
                                               std::span<const ObjectPair> ignored,
                                               unsigned threads, RigidBlocks& blocks);

/// Moves the vertices of all blocks in the pairs, and writes them to scene.vertices. Does not write
/// other vertices. resting: all vertices of the scene, in the frames of their objects.
void move_vertices(std::span<const Vec3> resting, std::span<const RigidMotion> motions,
                   const RigidBlocks& blocks, const BlockPairs& pairs, unsigned threads,
                   Scene& scene);

}  // namespace farcull
