// Tiles of a scene that is too large for the memory: where it is cut, a run on one tile, and the
// work of `farcull merge`. docs/tiles.md has the proof that each pair belongs to one tile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/stage.h"
#include "core/scene/scene.h"
#include "experiments/method/run.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/scene_file.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/pair_list.h"
#include "verify/certificate/tile.h"

namespace farcull {

// The first reading of a scene that is too large for the memory: how many triangles it has and
// where they lie, and from that the cuts of its tiles.

/// Calls its argument with one part of a scene after the other, the same ones each time, and
/// returns the pairs of objects that the scene ignores, as stream_scene() does.
using SceneSource = std::function<std::vector<ObjectPair>(const TakePart&)>;

/// The result of reading all parts. Memory: 65,536 triangles, 16 bytes for each object whose
/// number of triangles is not that of the object before it, and the ignored pairs.
struct Census {
  std::string name;
  std::uint64_t objects = 0, self_objects = 0, triangles = 0;
  double clearance = 0;             // of the question, world units
  std::vector<std::string> names;   // of the objects; empty where they were not asked for
  std::vector<ObjectPair> ignored;  // by the scene, as in_order() gives them
  /// Boxes of all triangles if there are at most 65,536, else of those
  /// that a fixed hash of their numbers chooses. So the same scene gives the same sample
  /// everywhere.
  std::vector<Box> sample;
  /// The runs of objects with equal size_word(): the word, and how many objects.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> sizes;

  /// The state of scene_hash() after the part of the scene that comes before the coordinates.
  Fnv1a begun_hash() const;
};

/// An object's number of triangles and `self`, as scene_hash() hashes them before the coordinates.
std::uint64_t size_word(const Object& object);

/// clearance: at which two triangles still count (world units). names: whether to keep the names of
/// the objects. An exception of `source` is passed on.
Census take_census(const SceneSource& source, double clearance, bool names = false);

/// A scene without triangles, with the names of the objects and the ignored pairs.
Scene names_of(const Census& census);

/// Where a scene is cut.
struct Cuts {
  int axis = 0;
  std::vector<double> at;  // ascending, some may be equal; one fewer than tiles
  std::size_t tiles() const { return at.size() + 1; }
};

/// Cuts for this many tiles, by a fixed rule. On each axis the cuts are the quantiles of the places
/// where the boxes of the sample begin. The axis is the one whose fullest tile meets the fewest
/// triangles of the sample; among equals, the one with the fewest in all tiles, then the first.
/// Only time and memory depend on the cuts. Precondition: tiles >= 1.
Cuts choose_cuts(const Census& census, std::size_t tiles);

/// "x from 1.5 to below 3".
std::string interval_text(const Tile& tile);

/// Tile k of n, 1 <= k <= n.
struct TileNumber {
  std::size_t k = 1, n = 1;
};
/// "K/N" with 1 <= K <= N <= kMostTiles. Throws Error naming --tiles.
TileNumber parse_tile(const std::string& text);
/// "N", 1 to kMostTiles. Throws Error naming --tiles.
std::size_t parse_tiles(const std::string& text);
inline constexpr std::size_t kMostTiles = 10'000;

/// The triangles of a scene that meet a tile. Objects and triangles keep their order; objects
/// without such a triangle are left out, and so are vertices that no triangle uses.
struct TileScene {
  Scene scene;             // with the whole scene's name
  ListNumbers numbers;     // of its objects and triangles in the whole scene
  std::uint64_t home = 0;  // triangles whose box begins in the tile
  std::string hash;        // scene_hash() of the whole scene
  std::string faces_hash;  // of its source faces, which scene_hash() leaves out
};

/// Reads all parts of the scene and keeps the triangles that meet the tile at the clearance of the
/// census: both triangles of every pair that belongs to the tile are kept. Memory O(largest part +
/// triangles that meet the tile). Throws Error naming the scene if it differs from the
/// census in an object's number of triangles or self, and if 2^31 or more triangles and objects
/// meet the tile. An exception of `source` is passed on.
TileScene gather_tile(const SceneSource& source, const Census& census, const Tile& tile);

/// For certificates: the scene of which `part` is the tile. The part must outlive the result.
WholeScene whole_scene(const Census& census, const Tile& tile, const TileScene& part);

struct TileQuestion {
  RunOptions options;  // for the method boxes, no limit; `ignored` is empty
  TileNumber number = {};
  /// Returns the pairs of objects to ignore besides those that the scene ignores. Its argument is
  /// names_of() the census. Empty: no more pairs.
  std::function<std::vector<ObjectPair>(const Scene& names)> ignored = {};
};

struct TileRun {
  TileNumber number;
  Census census;
  Cuts cuts;
  Tile tile;
  TileScene part;  // its scene's name is that of the whole and the tile
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
/// null if no list is written; `farcull merge` then has nothing to join.
nlohmann::ordered_json tile_json(const TileRun& run, const TileList* list);

/// nothing_to_test() of the whole scene.
NothingToTest nothing_to_test(const Census& census);

/// The lines for people: which tile it is, and which pairs the run does not cover.
std::string tile_lines(const TileRun& run);

/// The largest resident memory of this process so far, MiB.
double peak_memory_mib();

// Joins the results of runs on all tiles of a scene.

/// Whether `farcull merge` takes the file for the record of a tile: its name ends in .json.
bool is_tile_record(const std::string& path);

struct MergedTiles {
  std::uint64_t tiles = 0;
  std::uint64_t rows = 0;             // of the list
  std::uint64_t false_negatives = 0;  // of all accountings
  bool verified = false;              // every tile has an accounting
  bool guaranteed = true;             // every tile is guaranteed to miss nothing (docs/record.md)
};

/// Reads the records that `farcull run --tiles K/N --json FILE --pairs LIST` wrote and the lists
/// beside them, and writes the list of the whole scene to `out`: byte for byte that of one run. A
/// file appears there only when everything was read to its end and proved whole. The lists are
/// merged from their beginnings on, so the memory is a buffer for each list, and the records.
/// Throws Error naming the file if a record or a list is missing, is no such file, or was cut short
/// or changed since; if a tile is given twice or not at all; if two records differ in scene, number
/// of tiles, cuts, options, columns or commit; if the tiles do not hold all triangles of the scene;
/// and if `out` cannot be written or is a file that is read.
MergedTiles merge_tiles(const std::vector<std::string>& records, const std::string& out);

}  // namespace farcull
