// Joins what runs on all tiles of a scene have found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace farcull {

/// Whether `farcull merge` takes the file for the record of a tile: its name ends in .json.
bool is_tile_record(const std::string& path);

struct MergedTiles {
  std::uint64_t tiles = 0;
  std::uint64_t rows = 0;             // of the list
  std::uint64_t false_negatives = 0;  // of all accountings
  bool verified = false;              // every tile has an accounting
  bool promises = true;               // every tile promises to miss nothing (docs/record.md)
  std::string json;                   // the record of the whole: counts and times, docs/tiles.md
};

/// Reads the records that `farcull run --tiles K/N --json FILE --pairs LIST` wrote and the lists
/// beside them, and writes the list of the whole scene to `out`: byte for byte that of one run. A
/// file appears there only when everything was read to its end and proved whole. The lists are
/// merged from their beginnings on, so the memory is at most 64 MiB, or 4 KiB for each list, and
/// the records. Throws Error naming the file where a record or a list is missing, is none, or was
/// cut short or changed since; where a tile is there twice or not at all; where two records differ
/// in scene, number of tiles, cuts, options, columns or commit; where the tiles do not hold all
/// triangles of the scene; and where `out` cannot be written or is a file that is read.
/// other: a path to which the caller will write, which must not be a file that is read either.
MergedTiles merge_tiles(const std::vector<std::string>& records, const std::string& out,
                        const std::string& other = "");

}  // namespace farcull
