// The second reading of a scene: the triangles that meet a tile, as a scene of their own.
#pragma once

#include <cstdint>
#include <string>

#include "core/scene/scene.h"
#include "experiments/tiles/census.h"
#include "experiments/tiles/slab.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

/// The part of a scene that meets a tile. Objects and triangles keep their order; objects without a
/// triangle there are left out, and so are vertices that no triangle uses.
struct TileScene {
  Scene scene;             // with the whole scene's name
  ListNumbers numbers;     // of its objects and triangles in the whole scene
  std::uint64_t home = 0;  // triangles whose grown box begins in the tile
  std::string hash;        // scene_hash() of the whole scene
  std::string faces_hash;  // of its source faces, which scene_hash() leaves out
};

/// Reads all parts of the scene and keeps the triangles whose boxes, grown by half the clearance,
/// meet the tile: every pair that belongs to the tile (slab.h) is one of these triangles. Memory
/// O(largest part + triangles that meet the tile). Throws Error naming the scene where it differs
/// from the census in an object's number of triangles or self, and where 2^31 or more triangles and
/// objects meet the tile; and what `source` throws.
TileScene gather_tile(const SceneSource& source, const Census& census, const Slab& slab,
                      double clearance);

}  // namespace farcull
