// Two blocks of at most 16 triangles are compared on lanes: the boxes of their triangles along the
// axes and, where these overlap often, the triangles along their normals as well.
//
// The box of a large oblique triangle contains much that is far from its plane. Small triangles
// there are apart along the normal. If two triangles have a common point, their images under any
// linear map do, so any direction may be compared. Normals are computed in floats, and a margin
// covers the rounding (docs/reliability.md, "Boxes of blocks").
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

/// The normals of the triangles of a block, of length 1 up to rounding or 0, and where each
/// triangle begins and ends along its own normal, grown by a margin.
struct alignas(64) NormalLanes {
  std::array<std::array<float, kWide>, 3> normal;
  std::array<float, kWide> lo, hi;
};
/// Distances from the origin, and what triangles along their normals are grown by.
struct NormalMargin {
  float reach, margin;
};
/// reach: the largest coordinate of a box of a triangle, relative to the origin. Nothing if floats
/// are too coarse for these coordinates, or too small.
std::optional<NormalMargin> normal_margin(float reach, double clearance);
/// Computes the normals of at most kWide triangles, at least one.
void fill_normals(const Scene& scene, std::span<const std::uint32_t> triangles, const Vec3& origin,
                  const NormalMargin& margin, NormalLanes& out);

/// Pairs of triangles that a comparison finds, the smaller one first.
struct BlockFindings {
  std::vector<TrianglePair> pairs;    // their boxes overlap
  std::vector<TrianglePair> perhaps;  // they touch in floats
};
/// The lanes of `first`, and behind them those of `second`.
struct LaneSpans {
  std::span<const BlockLanes> first, second;
  const BlockLanes& operator[](std::uint32_t k) const {
    return k < first.size() ? first[k] : second[k - first.size()];
  }
};
/// Two blocks to compare. If a == b, every two triangles of the block are compared.
struct LanePair {
  std::uint32_t a, b;
  bool drops_neighbours;  // leaves out pairs that share a vertex index
};
/// vertices: of all lanes; may be empty if no pair drops neighbours. normals: of all lanes; empty:
/// only boxes are compared.
void compare_blocks(const LaneSpans& lanes, std::span<const VertexBlock> vertices,
                    std::span<const NormalLanes> normals, std::span<const LanePair> pairs,
                    BlockFindings& out);

}  // namespace farcull
