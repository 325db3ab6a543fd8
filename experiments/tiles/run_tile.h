// A run on one tile of a scene: its pairs, in the numbers of the whole scene, and a record with
// which `farcull merge` joins the tiles.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "experiments/method/run.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/tiles/census.h"
#include "experiments/tiles/slab.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

/// Tile k of n, 1 <= k <= n.
struct TileNumber {
  std::size_t k = 1, n = 1;
};
/// "K/N" with 1 <= K <= N <= kMostTiles. Throws Error naming --tiles.
TileNumber parse_tile(const std::string& text);
/// "N", 1 to kMostTiles. Throws Error naming --tiles.
std::size_t parse_tiles(const std::string& text);
inline constexpr std::size_t kMostTiles = 10'000;

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

struct TileQuestion {
  RunOptions options;  // of far-pairs, without a limit; `ignored` is empty
  TileNumber tile = {};
  /// Which objects are ignored beside those that the scene ignores, as pairs of the objects of a
  /// scene that has the names alone; empty: none.
  std::function<std::vector<ObjectPair>(const Scene& names)> ignored = {};
};

struct TileRun {
  TileNumber tile;
  Census census;
  Cuts cuts;
  Slab slab;
  TileScene part;  // its scene is called after the whole and the tile
  Record record;   // of the part; its candidates and pairs are those that belong to the tile. The
                   // accounting is about all pairs of the part, whichever tile they belong to
  std::uint64_t elsewhere = 0;           // candidates that belong to other tiles
  double read_ms = 0;                    // of both readings of the scene
  std::vector<ObjectPair> ignored = {};  // of the whole scene, by itself and by the question
};

/// Reads the scene twice and finds the pairs that belong to the tile. The same scene, options and
/// number of tiles give the same cuts for every tile. Memory: O(largest part) and that of a run on
/// the triangles that meet the tile. Throws Error as plan() and find() do, naming the
/// scene where the second reading differs from the first or a tile has 2^31 triangles and objects,
/// and std::logic_error for another method or a limit.
TileRun run_tile(const SceneSource& source, const TileQuestion& question, Session& session,
                 const Progress& progress = {});

/// The list of the pairs, as `farcull run --pairs` writes it for the whole scene, without those of
/// other tiles.
std::string tile_list(const TileRun& run, PairColumns columns);

/// The list of a tile that goes to a file.
struct TileList {
  std::string text;  // of tile_list()
  std::string file;  // its path, as seen from the folder of the record
  PairColumns columns;
};

/// The record as to_json(), about the whole scene and with the entry `tile` (docs/tiles.md). list:
/// null where there is none, and then `farcull merge` has nothing to join.
nlohmann::ordered_json tile_json(const TileRun& run, const TileList* list);

/// As nothing_to_test() says of the whole scene.
NothingToTest nothing_to_test(const Census& census);

/// The lines for people: what the tile is, and what the run says nothing about.
std::string tile_lines(const TileRun& run);

/// The largest resident memory of this process so far, MiB.
double peak_memory_mib();

/// The table of `farcull plan --tiles`: the cuts, the triangles of each tile, and about how much
/// memory a run on it takes.
std::string tiles_table(const Census& census, const Cuts& cuts,
                        const std::vector<TileCount>& counts);
/// The same for programs.
nlohmann::ordered_json tiles_json(const Census& census, const Cuts& cuts,
                                  const std::vector<TileCount>& counts);

}  // namespace farcull
