// A tile of a scene is a half-open interval of one axis. This file defines which triangles meet a
// tile, and which pairs of triangles belong to a tile. docs/tiles.md proves that each pair belongs
// to exactly one of the tiles of an axis, and that both triangles of the pair meet this tile.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

namespace farcull {

/// The interval [from, to) of an axis (0, 1 or 2), in world units.
struct Tile {
  int axis = 0;
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  bool operator==(const Tile&) const = default;
};

/// Returns tile k of the cuts.size() + 1 tiles of an axis, k <= cuts.size(). Precondition: the cuts
/// ascend (some may be equal). The first tile begins at minus infinity, the last ends at infinity.
inline Tile tile_of(int axis, std::span<const double> cuts, std::size_t k) {
  Tile out{.axis = axis};
  if (k > 0) out.from = cuts[k - 1];
  if (k < cuts.size()) out.to = cuts[k];
  return out;
}

/// True if the coordinate `at` is in the tile. Exact, since doubles are only compared.
inline bool holds(const Tile& tile, double at) { return at >= tile.from && at < tile.to; }

/// True if a triangle may be in a pair that belongs to the tile and whose boxes are at most
/// `clearance` apart. lo, hi: the ends of the triangle's box on the axis. The difference is rounded
/// as in box_pairs.h. Rounding is monotone, so no such triangle gives false.
inline bool meets(const Tile& tile, double lo, double hi, double clearance) {
  return lo < tile.to && tile.from - hi <= clearance;
}

/// True if a pair belongs to the tile: the larger of lo_a and lo_b is in the tile. lo_a, lo_b: the
/// lower ends of the boxes of the two triangles on the axis.
inline bool owns(const Tile& tile, double lo_a, double lo_b) {
  return holds(tile, std::max(lo_a, lo_b));
}

}  // namespace farcull
