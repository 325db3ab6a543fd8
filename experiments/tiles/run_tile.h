// Divides a scene that is too large for the memory into tiles, runs a method on one tile, and
// merges the results of all tiles (`farcull merge`). docs/tiles.md has the proof that each pair
// belongs to one tile.
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

/// The result of reading all parts. Needs memory for the boxes of at most 65,536 triangles, for 16
/// bytes for each entry of `sizes`, for the names, and for the ignored pairs.
struct Census {
  std::string name;
  std::uint64_t objects = 0, self_objects = 0, triangles = 0;
  double clearance = 0;             // world units, see take_census()
  std::vector<std::string> names;   // of the objects; empty unless take_census() keeps them
  std::vector<ObjectPair> ignored;  // ignored by the scene; sorted by in_order()
  /// Boxes of all triangles if there are at most 65,536. Otherwise boxes of some triangles, chosen
  /// by a fixed hash of the triangles' numbers. So the same scene gives the same sample everywhere.
  std::vector<Box> sample;
  /// For each series of consecutive objects with equal size_word(): the word, and the number of
  /// objects.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> sizes;

  /// The state of scene_hash() just before it hashes the coordinates.
  Fnv1a begun_hash() const;
};

/// Returns an object's number of triangles and `self` in one word, as scene_hash() hashes them.
std::uint64_t size_word(const Object& object);

/// Reads all parts. Two triangles at most `clearance` (world units) apart count as a pair. If
/// `names`, keeps the names of the objects. Passes on exceptions of `source`.
Census take_census(const SceneSource& source, double clearance, bool names = false);

/// Returns a scene without triangles that has the names of the objects and the ignored pairs.
Scene names_of(const Census& census);

struct Cuts {
  int axis = 0;
  std::vector<double> at;  // ascending, some may be equal; one fewer than tiles
  std::size_t tiles() const { return at.size() + 1; }
};

/// Returns cuts for this many tiles, by a fixed rule. On each axis, quantiles of the lower ends of
/// the sample's boxes serve as cuts. Chooses the axis whose fullest tile meets the fewest boxes of
/// the sample. Breaks a tie by the smallest sum over all tiles, and then by the order of the axes.
/// Only time and memory depend on the cuts. Precondition: tiles >= 1.
Cuts choose_cuts(const Census& census, std::size_t tiles);

/// Returns a text such as "x from 1.5 to below 3".
std::string interval_text(const Tile& tile);

/// Tile k of n, 1 <= k <= n.
struct TileNumber {
  std::size_t k = 1, n = 1;
};
/// Reads "K/N" with 1 <= K <= N <= kMostTiles. Throws Error naming --tiles.
TileNumber parse_tile(const std::string& text);
/// Reads "N", 1 to kMostTiles. Throws Error naming --tiles.
std::size_t parse_tiles(const std::string& text);
inline constexpr std::size_t kMostTiles = 10'000;

/// The triangles of a scene that meet a tile. Objects and triangles keep their order. Objects
/// without such a triangle and vertices that no triangle uses are left out.
struct TileScene {
  Scene scene;             // with the whole scene's name
  ListNumbers numbers;     // numbers of the objects and triangles in the whole scene
  std::uint64_t home = 0;  // number of triangles whose box begins in the tile
  std::string hash;        // scene_hash() of the whole scene
  std::string faces_hash;  // hash of the whole scene's source faces, which `hash` leaves out
};

/// Reads all parts of the scene and keeps the triangles that meet the tile at the clearance of the
/// census. So both triangles of each pair that belongs to the tile are kept. Needs memory for the
/// largest part and for the kept triangles. Throws Error naming the scene if an object's number of
/// triangles or `self` differs from the census, or if there are 2^31 or more kept triangles
/// or objects. Passes on exceptions of `source`.
TileScene gather_tile(const SceneSource& source, const Census& census, const Tile& tile);

/// Describes the whole scene, of which `part` is one tile, for certificates. `part` must outlive
/// the result.
WholeScene whole_scene(const Census& census, const Tile& tile, const TileScene& part);

struct TileQuestion {
  RunOptions options;  // of the method `boxes`, without a limit and with an empty `ignored`
  TileNumber number = {};
  /// Returns pairs of objects to ignore besides those that the scene ignores. Called with
  /// names_of(census). If empty, there are no such pairs.
  std::function<std::vector<ObjectPair>(const Scene& names)> ignored = {};
};

struct TileRun {
  TileNumber number;
  Census census;
  Cuts cuts;
  Tile tile;
  TileScene part;  // the name of part.scene has the whole scene's name and the tile's number
  Record record;   // record of the part; has only candidates and pairs that belong to the tile, but
                   // the accounting is of all pairs of the part
  std::uint64_t elsewhere = 0;           // candidates that belong to other tiles
  double read_ms = 0;                    // time of both readings of the scene
  std::vector<ObjectPair> ignored = {};  // ignored pairs of the whole scene and of the question
};

/// Reads the scene twice and finds the pairs that belong to the tile. The same scene, options and
/// number of tiles give the same cuts for every tile. Needs memory for the largest part of
/// `source`, and for a run on the tile's triangles. Throws Error as gather_tile(), plan() and
/// find() do. Throws std::logic_error if the options have another method than `boxes`, or a limit.
TileRun run_tile(const SceneSource& source, const TileQuestion& question, Session& session,
                 const Progress& progress = {});

/// Returns the list that `farcull run --pairs` would write for the whole scene, without the pairs
/// of other tiles.
std::string tile_list(const TileRun& run, PairColumns columns);

struct TileList {
  std::string text;  // result of tile_list()
  std::string file;  // path of the list, relative to the folder of the record
  PairColumns columns;
};

/// Returns the record as to_json() does, but about the whole scene and with the entry `tile`
/// (docs/tiles.md). list: null if no list is written; `farcull merge` then has nothing to join.
nlohmann::ordered_json tile_json(const TileRun& run, const TileList* list);

/// Returns nothing_to_test() for the whole scene.
NothingToTest nothing_to_test(const Census& census);

/// Returns lines of text: which tile the run is about, and which pairs the run does not cover.
std::string tile_lines(const TileRun& run);

// Joins the results of runs on all tiles of a scene.

/// True if `farcull merge` reads the file as the record of a tile: the file's name ends in .json.
bool is_tile_record(const std::string& path);

struct MergedTiles {
  std::uint64_t tiles = 0;
  std::uint64_t rows = 0;             // number of rows of the joined list
  std::uint64_t false_negatives = 0;  // sum over all accountings
  bool verified = false;              // every tile has an accounting
  bool guaranteed = true;             // every tile is guaranteed to miss nothing (docs/record.md)
};

/// Reads the records and lists that `farcull run --tiles K/N --json FILE --pairs LIST` wrote.
/// Writes the list of the whole scene to `out`, byte for byte as a single run writes it. `out`
/// appears only after all lists were read to their ends and found complete. Merges the lists while
/// reading, so memory is needed only for the records and a buffer for each list. Throws Error
/// naming the file if
/// - a record or a list is missing, is another kind of file, or was cut short or changed;
/// - a tile is given twice or not at all, or the tiles do not hold all triangles of the scene;
/// - two records differ in scene, number of tiles, cuts, options, columns or commit;
/// - `out` cannot be written, or is a file that is read.
MergedTiles merge_tiles(const std::vector<std::string>& records, const std::string& out);

}  // namespace farcull
