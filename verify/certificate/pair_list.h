// Writes the list of the colliding pairs as CSV. A certificate has the SHA-256 of this text. Also
// reads such lists from files. Columns are found by their names, and rows may be in any order.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Returns the line object_a,triangle_a,object_b,triangle_b with a newline. self: true if an object
/// of the scene is tested against itself; the line then has a fifth column `neighbours`.
std::string pair_list_header(bool self);

/// For a scene that is a part of a whole scene: the numbers of objects and triangles in the whole
/// scene. Lists contain these numbers.
struct ListNumbers {
  std::vector<std::uint64_t> objects;    // per object: number in the whole scene, ascending
  std::vector<std::uint32_t> triangles;  // per triangle: number within the whole object
  bool self = false;                     // an object of the whole scene is tested against itself
};

/// Writes the rows of a list. Numbers are decimal and 0-based. Triangles are numbered within their
/// object. `neighbours` is 1 for triangles of one object that share a vertex position, otherwise 0.
class PairListRows {
 public:
  /// numbers: null if the scene is a whole scene. The scene and *numbers must outlive this object.
  explicit PairListRows(const Scene& scene, const ListNumbers* numbers = nullptr);
  /// Appends the line of a pair to `text`. Precondition: both triangles are of the scene.
  void append(const TrianglePair& pair, std::string& text) const;

 private:
  const Scene& scene_;
  const ListNumbers* numbers_;
  std::vector<std::uint32_t> owner_;
  bool self_;
};

/// Returns the list: the header, then one row per pair in the given order.
std::string pair_list(const Scene& scene, std::span<const TrianglePair> pairs);

/// Returns the SHA-256 of pair_list() as 64 lower-case hexadecimal digits. numbers: not null if the
/// scene is a part of a whole scene. Memory O(triangles), whatever the number of pairs.
std::string pair_list_hash(const Scene& scene, std::span<const TrianglePair> pairs,
                           const ListNumbers* numbers = nullptr);

/// A row of a list, as read from the file.
struct ListedPair {
  std::uint64_t line = 0;  // line number in the file, 1-based
  std::uint32_t frame = 0;
  std::array<std::uint32_t, 2> object{}, triangle{};
  std::optional<bool> neighbours;
};

struct GivenList {
  std::string name;                        // name of the file
  bool has_frames = false;                 // true if there is a column `frame`
  std::vector<ListedPair> rows;            // in the order of the file
  std::vector<std::string> not_looked_at;  // names of columns that are ignored
};

/// Reads CSV. The first line names the columns object_a, triangle_a, object_b and triangle_b in any
/// order; it may name `frame`, `neighbours` and other columns. Each further line is a pair. Commas
/// separate cells; cells may be in double quotes; lines end with LF or CR LF; empty lines are
/// skipped. Throws Error naming `name`, the line and a remedy in these cases: a column is missing
/// or named twice, a line has more or fewer cells than the first line, a cell is no whole number.
GivenList read_pair_list(std::string_view text, const std::string& name);

/// How a list differs from the list of the pairs that meet.
struct ListDifferences {
  std::uint64_t listed = 0;      // number of rows
  std::uint64_t wrong = 0;       // rows whose pair does not meet or is repeated,
                                 // and rows with a wrong value of `neighbours`
  std::uint64_t missing = 0;     // pairs that meet and are in no row
  std::uint64_t wrong_line = 0;  // line of the first wrong row
  std::string wrong_reason;      // fault of the first wrong row, like "the pair is disjoint"
  std::optional<TrianglePair> wrong_pair;    // empty if the row names one triangle twice
  std::optional<TrianglePair> missing_pair;  // the first missing pair in sorted order

  bool none() const { return wrong == 0 && missing == 0; }
};

/// Returns the pair of a row with a < b; a == b if the row names one triangle twice. Throws Error
/// naming the list and the line if the scene has no such object or triangle.
TrianglePair pair_of(const Scene& scene, const std::string& name, const ListedPair& row);

/// Compares rows with `meeting`, all pairs that meet (with a clearance: all pairs at most the
/// clearance apart), sorted, each once. The order of rows does not matter, nor the order of the two
/// triangles in a row. Throws Error as pair_of() does.
ListDifferences find_differences(const Scene& scene, const std::string& name,
                                 std::span<const ListedPair> rows,
                                 std::span<const TrianglePair> meeting, double clearance = 0);

}  // namespace farcull
