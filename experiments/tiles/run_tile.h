// Divides a scene that is too large for the memory into tiles, runs a method on one tile, and
// merges the results of all tiles (`farcull merge`). docs/tiles.md proves that each pair belongs to
// exactly one tile.
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
// and samples their positions. The sample determines the cuts between tiles.

/// Passes the parts of a scene, always the same parts, to its argument one after the other. Returns
/// the pairs of objects that the scene ignores, as stream_scene() does.
using SceneSource = std::function<std::vector<ObjectPair>(const TakePart&)>;

/// The result of the first reading. Needs memory for the boxes of at most 65,536 triangles, for 16
/// bytes per entry of `sizes`, for the names, and for the ignored pairs.
struct Census {
  std::string name;
  std::uint64_t objects = 0, self_objects = 0, triangles = 0;
  double clearance = 0;             // world units; see take_census()
  std::vector<std::string> names;   // names of the objects, if take_census() keeps names
  std::vector<ObjectPair> ignored;  // pairs that the scene ignores, in the order of in_order()
  /// Boxes of all triangles if there are at most 65,536. Otherwise boxes of some triangles, chosen
  /// by a fixed hash of the triangle numbers. So the same scene always gives the same sample.
  std::vector<Box> sample;
  /// For each series of consecutive objects with equal size_word(): the word, and the number of
  /// objects.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> sizes;

  /// Returns the state of scene_hash() before the first coordinate is hashed.
  Fnv1a begun_hash() const;
};

/// Packs the number of triangles and `self` into one word, as scene_hash() hashes them.
std::uint64_t size_word(const Object& object);

/// Reads all parts. clearance: two triangles that are at most this far apart (world units) count as
/// a pair. names: true keeps the names of the objects. Passes on exceptions of `source`.
Census take_census(const SceneSource& source, double clearance, bool names = false);

/// Returns a scene without triangles that has the names of the objects and the ignored pairs.
Scene names_of(const Census& census);

struct Cuts {
  int axis = 0;
  std::vector<double> at;  // ascending, some may be equal; one cut fewer than tiles
  std::size_t tiles() const { return at.size() + 1; }
};

/// Returns cuts for this many tiles. The candidates on each axis are quantiles of the lower ends of
/// the sample's boxes. Chooses the axis whose fullest tile meets the fewest boxes of the sample.
/// Breaks a tie by the smallest sum over all tiles, then by the order of the axes. The cuts affect
/// only time and memory, not the result. Precondition: tiles >= 1.
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

/// The triangles of a scene that meet a tile. Objects and triangles keep their order. Omits
/// vertices that no such triangle uses, and objects without such a triangle.
struct TileScene {
  Scene scene;             // has the name of the whole scene
  ListNumbers numbers;     // numbers of the objects and triangles in the whole scene
  std::uint64_t home = 0;  // number of triangles whose box begins in the tile
  std::string hash;        // scene_hash() of the whole scene
  std::string faces_hash;  // hash of the whole scene's source faces, which `hash` leaves out
};

/// Reads all parts of the scene and keeps the triangles that meet the tile at the clearance of the
/// census. So both triangles of each pair that belongs to the tile are kept. Needs memory for the
/// largest part and for the kept triangles. Throws Error naming the scene if an object's number of
/// triangles or `self` differs from the census, or if the kept triangles and objects together are
/// 2^31 or more. Passes on exceptions of `source`.
TileScene gather_tile(const SceneSource& source, const Census& census, const Tile& tile);

/// Describes the whole scene for the certificate of one tile. part: the triangles of the tile; must
/// outlive the result.
WholeScene whole_scene(const Census& census, const Tile& tile, const TileScene& part);

struct TileQuestion {
  RunOptions options;  // method `boxes`, no limit, `ignored` empty
  TileNumber number = {};
  /// Returns further pairs of objects to ignore, besides the pairs that the scene ignores. Called
  /// with names_of(census). May be empty: no further pairs.
  std::function<std::vector<ObjectPair>(const Scene& names)> ignored = {};
};

struct TileRun {
  TileNumber number;
  Census census;
  Cuts cuts;
  Tile tile;
  TileScene part;  // name of part.scene: the name of the whole scene and the number of the tile
  Record record;   // only pairs of the tile, but the verification covers all pairs of `part`
  std::uint64_t elsewhere = 0;           // candidates that belong to other tiles
  double read_ms = 0;                    // time of both readings of the scene
  std::vector<ObjectPair> ignored = {};  // pairs that the scene or the question ignores
};

/// Reads the scene twice and finds the pairs that belong to the tile. The same scene, options and
/// number of tiles give the same cuts for every tile. Needs memory for the largest part of `source`
/// and for a run on the tile's triangles. Throws Error as gather_tile(), plan() and find() do.
/// Throws std::logic_error if the options have another method than `boxes`, or a limit.
TileRun run_tile(const SceneSource& source, const TileQuestion& question, Session& session,
                 const Progress& progress = {});

/// Returns the rows of the whole scene's list (`farcull run --pairs`) whose pairs belong to the
/// tile, with the header line.
std::string tile_list(const TileRun& run, PairColumns columns);

struct TileList {
  std::string text;  // result of tile_list()
  std::string file;  // path of the list, relative to the folder of the record
  PairColumns columns;
};

/// Returns the record as to_json() does, but with the whole scene's data and with the entry `tile`
/// (docs/tiles.md). list: null if no list is written; `farcull merge` then refuses the record.
nlohmann::ordered_json tile_json(const TileRun& run, const TileList* list);

/// Like nothing_to_test() of a Scene, but for the whole scene.
NothingToTest nothing_to_test(const Census& census);

/// Returns lines of text: the number and interval of the tile, and which pairs the run omits.
std::string tile_lines(const TileRun& run);

// Joins the results of runs on all tiles of a scene.

/// True if `farcull merge` reads the file as the record of a tile: the file's name ends in .json.
bool is_tile_record(const std::string& path);

struct MergedTiles {
  std::uint64_t tiles = 0;
  std::uint64_t rows = 0;             // rows of the joined list
  std::uint64_t false_negatives = 0;  // sum over the verifications of all tiles
  bool verified = false;              // true: every tile was verified
  bool guaranteed = true;             // true: each run guarantees to miss no pair (docs/record.md)
};

/// Reads the records and lists that `farcull run --tiles K/N --json FILE --pairs LIST` wrote.
/// Writes the list of the whole scene to `out`, byte for byte as a single run writes it. `out`
/// appears only after all lists were read completely and found correct. Merges the lists while
/// reading, so memory is needed only for the records and a buffer for each list. Throws Error
/// naming the file if
/// - a record or a list is missing, is another kind of file, or was cut short or changed;
/// - a tile is given twice or not at all, or the tiles do not hold all triangles of the scene;
/// - two records differ in scene, number of tiles, cuts, options, columns or commit;
/// - `out` cannot be written, or is one of the files that are read.
MergedTiles merge_tiles(const std::vector<std::string>& records, const std::string& out);

}  // namespace farcull
