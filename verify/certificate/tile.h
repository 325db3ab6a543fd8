// A tile of a scene: a half-open interval of one axis. Says which triangles meet it, and which
// pairs of triangles belong to it. docs/tiles.md has the proof that each pair belongs to exactly
// one of the tiles that follow each other, and that both of its triangles meet this tile.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

namespace farcull {

/// The tile from .. to of an axis (0, 1 or 2), in world units: `from` belongs to it, `to` does not.
struct Tile {
  int axis = 0;
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  bool operator==(const Tile&) const = default;
};

/// Tile k of the cuts.size() + 1 tiles of an axis. Preconditions: the cuts ascend, some may be
/// equal; k <= cuts.size(). The first tile begins at minus infinity, the last ends at infinity.
inline Tile tile_of(int axis, std::span<const double> cuts, std::size_t k) {
  Tile out{.axis = axis};
  if (k > 0) out.from = cuts[k - 1];
  if (k < cuts.size()) out.to = cuts[k];
  return out;
}

/// Whether a place on the axis is in the tile. Exact: it only compares doubles.
inline bool holds(const Tile& tile, double at) { return at >= tile.from && at < tile.to; }

/// True if a triangle may be in a pair that belongs to the tile and whose boxes are at most
/// `clearance` apart. lo, hi: the ends of its box on the axis. The difference is rounded as that of
/// two boxes (box_pairs.h), and rounding is monotone, so no such triangle is left out.
inline bool meets(const Tile& tile, double lo, double hi, double clearance) {
  return lo < tile.to && tile.from - hi <= clearance;
}

/// True if a pair belongs to the tile: the later one of the two places where the boxes of its
/// triangles begin is in the tile.
inline bool owns(const Tile& tile, double lo_a, double lo_b) {
  return holds(tile, std::max(lo_a, lo_b));
}

}  // namespace farcull
