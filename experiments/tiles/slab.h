// A tile of a scene: a half-open interval of one axis. Which triangles meet it, and which pairs of
// triangles belong to it (docs/tiles.md has the proof that each pair belongs to exactly one).
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/boxes/block.h"
#include "core/scene/scene.h"

namespace farcull {

/// The tile from .. to of an axis (0, 1 or 2), in world units: `from` belongs to it, `to` does not.
struct Slab {
  int axis = 0;
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// Tile k of the cuts.size() + 1 tiles of an axis. Preconditions: the cuts ascend, some may be
/// equal; k <= cuts.size(). The first tile begins at minus infinity, the last ends at infinity.
inline Slab slab_of(int axis, std::span<const double> cuts, std::size_t k) {
  Slab out{.axis = axis};
  if (k > 0) out.from = cuts[k - 1];
  if (k < cuts.size()) out.to = cuts[k];
  return out;
}

/// Whether a place on the axis is in the tile. Exact: it only compares doubles.
inline bool holds(const Slab& slab, double at) { return at >= slab.from && at < slab.to; }

/// Whether a closed box has a place in the tile. Precondition: the box is not empty, and begins
/// below infinity.
inline bool meets(const Slab& slab, const Box& box) {
  return box.lo[slab.axis] < slab.to && box.hi[slab.axis] >= slab.from;
}

/// Whether the pair belongs to the tile: where the later one of the two triangles' boxes begins,
/// each grown by half the clearance (core/boxes/block.h).
inline bool owns(const Slab& slab, const Scene& scene, const TrianglePair& pair, double clearance) {
  return holds(slab, std::max(grown_box(scene, pair.a, clearance).lo[slab.axis],
                              grown_box(scene, pair.b, clearance).lo[slab.axis]));
}

}  // namespace farcull
