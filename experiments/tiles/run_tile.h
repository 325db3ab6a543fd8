// Tiles of a scene that is too large for the memory: where it is cut, a run on one tile, and the
// work of `farcull merge`. docs/tiles.md has the proof that each pair belongs to one tile.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.h"
#include "experiments/method/run.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/scene_file.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/pair_list.h"
#include "verify/certificate/tile.h"

namespace farcull {

// A scene that is too large for the memory is read twice. The first reading counts the triangles
// and samples where they lie. The cuts between tiles follow from the sample.

/// Passes the parts of a scene to its argument, one after the other. Each call passes the same
/// parts. Returns the pairs of objects that the scene ignores, as stream_scene() does.
using SceneSource = std::function<std::vector<ObjectPair>(const TakePart&)>;

/// The result of reading all parts. Memory: the boxes of at most 65,536 triangles, 16 bytes for
/// each object whose number of triangles is not that of the object before it, and the ignored
/// pairs.
struct Census {
  std::string name;
  std::uint64_t objects = 0, self_objects = 0, triangles = 0;
  double clearance = 0;             // world units, see take_census()
  std::vector<std::string> names;   // of the objects; empty if take_census() was to leave them out
  std::vector<ObjectPair> ignored;  // of the scene, as in_order() gives them
  /// Boxes of all triangles if there are at most 65,536. Otherwise boxes of some triangles, chosen
  /// by a fixed hash of the triangles' numbers. So the same scene gives the same sample everywhere.
  std::vector<Box> sample;
  /// For each series of consecutive objects with equal size_word(): the word, and how many objects.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> sizes;

  /// The state of scene_hash() just before it hashes the coordinates.
  Fnv1a begun_hash() const;
};

/// An object's number of triangles and `self`, as scene_hash() hashes them before the coordinates.
std::uint64_t size_word(const Object& object);

/// clearance: two triangles that are at most this far apart count as a pair (world units). names:
/// whether to keep the names of the objects. An exception of `source` is passed on.
Census take_census(const SceneSource& source, double clearance, bool names = false);

/// A scene without triangles, with the names of the objects and the ignored pairs.
Scene names_of(const Census& census);

/// Where a scene is cut.
struct Cuts {
  int axis = 0;
  std::vector<double> at;  // ascending, some may be equal; one fewer than tiles
  std::size_t tiles() const { return at.size() + 1; }
};

/// Cuts for this many tiles, by a fixed rule. On each axis, quantiles of the lower ends of the
/// sample's boxes serve as cuts. The axis whose fullest tile meets the fewest boxes of the sample
/// is chosen. In a tie it is the axis with the smallest sum over all tiles, and in another tie the
/// first axis. Only time and memory depend on the cuts. Precondition: tiles >= 1.
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
  ListNumbers numbers;     // numbers of the objects and triangles in the whole scene
  std::uint64_t home = 0;  // triangles whose box begins in the tile
  std::string hash;        // scene_hash() of the whole scene
  std::string faces_hash;  // hash of the whole scene's source faces, which `hash` leaves out
};

/// Reads all parts of the scene and keeps the triangles that meet the tile at the clearance of the
/// census: both triangles of every pair that belongs to the tile are kept. Memory O(largest part +
/// triangles that meet the tile). Throws Error naming the scene if an object's number of triangles
/// or `self` differs from the census, or if the triangles and objects that meet the tile are 2^31
/// or more. An exception of `source` is passed on.
TileScene gather_tile(const SceneSource& source, const Census& census, const Tile& tile);

/// Describes the whole scene, of which `part` is one tile, for certificates. `part` must outlive
/// the result.
WholeScene whole_scene(const Census& census, const Tile& tile, const TileScene& part);

struct TileQuestion {
  RunOptions options;  // of the method `boxes`, without a limit and with an empty `ignored`
  TileNumber number = {};
  /// Returns pairs of objects to ignore in addition to those that the scene ignores. Its argument
  /// is names_of(census). No function: no such pairs.
  std::function<std::vector<ObjectPair>(const Scene& names)> ignored = {};
};

struct TileRun {
  TileNumber number;
  Census census;
  Cuts cuts;
  Tile tile;
  TileScene part;  // its scene is named after the whole scene and the tile
  Record record;   // of the part; its candidates and pairs are those that belong to the tile, but
                   // its accounting is about all pairs of the part
  std::uint64_t elsewhere = 0;           // candidates that belong to other tiles
  double read_ms = 0;                    // of both readings of the scene
  std::vector<ObjectPair> ignored = {};  // ignored pairs of the whole scene and of the question
};

/// Reads the scene twice and finds the pairs that belong to the tile. The same scene, options and
/// number of tiles give the same cuts for every tile. Memory: O(largest part), plus that of a run
/// on the triangles that meet the tile. Throws Error as gather_tile(), plan() and find() do. Throws
/// std::logic_error if the options have another method than `boxes`, or a limit.
TileRun run_tile(const SceneSource& source, const TileQuestion& question, Session& session,
                 const Progress& progress = {});

/// The list that `farcull run --pairs` would write for the whole scene, without the pairs of other
/// tiles.
std::string tile_list(const TileRun& run, PairColumns columns);

/// The list of a tile that goes to a file.
struct TileList {
  std::string text;  // of tile_list()
  std::string file;  // its path, as seen from the folder of the record
  PairColumns columns;
};

/// The record as to_json() gives it, but about the whole scene and with the entry `tile`
/// (docs/tiles.md). list: null if no list is written; `farcull merge` then has nothing to join.
nlohmann::ordered_json tile_json(const TileRun& run, const TileList* list);

/// nothing_to_test() of the whole scene.
NothingToTest nothing_to_test(const Census& census);

/// The lines for people: which tile it is, and which pairs the run does not cover.
std::string tile_lines(const TileRun& run);

// Joins the results of runs on all tiles of a scene.

/// True if `farcull merge` takes the file for the record of a tile: the file's name ends in .json.
bool is_tile_record(const std::string& path);

struct MergedTiles {
  std::uint64_t tiles = 0;
  std::uint64_t rows = 0;             // of the joined list
  std::uint64_t false_negatives = 0;  // sum over all accountings
  bool verified = false;              // every tile has an accounting
  bool guaranteed = true;             // every tile is guaranteed to miss nothing (docs/record.md)
};

/// Reads the records and lists that `farcull run --tiles K/N --json FILE --pairs LIST` wrote.
/// Writes the list of the whole scene to `out`, byte for byte as a single run writes it. `out`
/// appears only after all lists were read to their ends and found complete. The lists are merged
/// while they are read, so the memory is that of the records and a buffer for each list. Throws
/// Error naming the file if
/// - a record or a list is missing, is another kind of file, or was cut short or changed;
/// - a tile is given twice or not at all, or the tiles do not hold all triangles of the scene;
/// - two records differ in scene, number of tiles, cuts, options, columns or commit;
/// - `out` cannot be written, or is a file that is read.
MergedTiles merge_tiles(const std::vector<std::string>& records, const std::string& out);

}  // namespace farcull
