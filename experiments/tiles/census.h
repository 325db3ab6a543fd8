// The first reading of a scene that is too large for the memory: how many triangles it has and
// where they lie, and from that the cuts of its tiles.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/hash.h"
#include "core/scene/scene.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {

/// Calls its argument with one part of a scene after the other, the same ones each time, and
/// returns the pairs of objects that the scene ignores, as stream_scene() does.
using SceneSource = std::function<std::vector<ObjectPair>(const TakePart&)>;

/// What a reading of all parts tells. Memory: 65,536 triangles, 16 bytes for each object whose
/// number of triangles is not that of the object before it, and the ignored pairs.
struct Census {
  std::string name;
  std::uint64_t objects = 0, self_objects = 0, triangles = 0;
  std::vector<std::string> names;   // of the objects; empty where they were not asked for
  std::vector<ObjectPair> ignored;  // by the scene, as in_order() gives them
  /// Grown boxes of some triangles: all of them where there are at most 65,536, else those of which
  /// the numbers are chosen by a fixed hash. So the same scene gives the same sample everywhere.
  std::vector<Box> sample;
  /// size_word() of each object, and how often in a row.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> sizes;

  /// scene_hash() of the scene, up to the coordinates.
  Fnv1a begun_hash() const;
};

/// What scene_hash() hashes of an object before it comes to the coordinates.
std::uint64_t size_word(const Object& object);

/// clearance: as of grown_box(). names: of the objects are kept. Throws what `source` throws.
Census take_census(const SceneSource& source, double clearance, bool names = false);

/// A scene of the objects by their names alone.
Scene names_of(const Census& census);

/// Where a scene is cut.
struct Cuts {
  int axis = 0;
  std::vector<double> at;  // ascending, some may be equal; one fewer than tiles
  std::size_t tiles() const { return at.size() + 1; }
};

/// Cuts for this many tiles, by a fixed rule: on each axis the quantiles of the places where the
/// boxes of the sample begin; of the three axes the one whose fullest tile meets the fewest
/// triangles of the sample, then the one with the fewest in all tiles, then the first. Only time
/// and memory depend on them. Precondition: tiles >= 1.
Cuts choose_cuts(const Census& census, std::size_t tiles);

/// Triangles of a tile.
struct TileCount {
  std::uint64_t triangles = 0;  // that meet it
  std::uint64_t home = 0;       // whose box begins in it: each triangle of the scene in one tile
};
/// One more reading of the scene: the triangles of each tile. Memory O(tiles).
std::vector<TileCount> count_tiles(const SceneSource& source, const Cuts& cuts, double clearance);

}  // namespace farcull
