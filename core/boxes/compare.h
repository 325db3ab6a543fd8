// Compares the triangles of two blocks (at most 16 triangles each) with vector instructions.
// Compares their axis-aligned boxes and, if these overlap often, also projections on normals.
//
// The box of a large oblique triangle reaches far from the triangle's plane. The triangle's normal
// can separate the triangle from small triangles in its box. Any direction may be used: if two
// triangles have a common point, their projections on the direction also have one. Normals are
// computed in floats, and a margin covers the rounding (docs/reliability.md, "Boxes of blocks").
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/boxes/block.h"
#include "core/scene/scene.h"

namespace farcull {

/// The vertex indices of the triangles of a block, by corner.
struct alignas(64) VertexBlock {
  std::array<std::array<std::uint32_t, kWide>, 3> corner;
};

/// The normals of the triangles of a block. A normal has length 1 up to rounding, or is 0.
/// [lo, hi]: the projection of each triangle on its own normal, grown by a margin.
struct alignas(64) NormalLanes {
  std::array<std::array<float, kWide>, 3> normal;
  std::array<float, kWide> lo, hi;
};
/// reach: upper bound of the distance between any corner and the origin. margin: the length by
/// which the projection of a triangle on its normal is grown at each end.
struct NormalMargin {
  float reach, margin;
};
/// Returns the margin, or empty if `reach` is too large or too small for floats. reach: the largest
/// absolute coordinate of the triangles' boxes, relative to the origin.
std::optional<NormalMargin> normal_margin(float reach, double clearance);
/// Computes the normals of 1 to kWide triangles.
void fill_normals(const Scene& scene, std::span<const std::uint32_t> triangles, const Vec3& origin,
                  const NormalMargin& margin, NormalLanes& out);

/// The pairs of triangles that a comparison finds. In each pair the smaller index comes first.
struct BlockFindings {
  std::vector<TrianglePair> pairs;    // pairs whose boxes overlap
  std::vector<TrianglePair> perhaps;  // pairs whose boxes only touch in floats
};
/// Two arrays with a common index: the elements of `first`, then those of `second`.
struct LaneSpans {
  std::span<const BlockLanes> first, second;
  const BlockLanes& operator[](std::uint32_t k) const {
    return k < first.size() ? first[k] : second[k - first.size()];
  }
};
/// Two blocks to compare. If a == b, the triangles of the block are compared with each other.
struct LanePair {
  std::uint32_t a, b;
  bool drops_neighbours;  // leaves out triangle pairs that share a vertex index
};
/// Compares blocks and appends to `out`. vertices, normals: one per element of `lanes`. If no pair
/// drops neighbours, `vertices` may be empty. If `normals` is empty, only boxes are compared.
void compare_blocks(const LaneSpans& lanes, std::span<const VertexBlock> vertices,
                    std::span<const NormalLanes> normals, std::span<const LanePair> pairs,
                    BlockFindings& out);

}  // namespace farcull
