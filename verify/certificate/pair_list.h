// Writes the list of the colliding pairs as text; a certificate names the list by the SHA-256 of
// these bytes. Also reads such lists, whoever wrote them: columns are found by their names, rows
// may be in any order.
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

/// The header object_a,triangle_a,object_b,triangle_b, with a fifth column `neighbours` if `self`:
/// if an object of the scene is tested against itself. Each line ends with a single newline.
std::string pair_list_header(bool self);

/// Numbers for lists of a scene that is a part of a whole scene: lists name objects and triangles
/// by their numbers in the whole scene.
struct ListNumbers {
  std::vector<std::uint64_t> objects;    // per object: its number in the whole scene, ascending
  std::vector<std::uint32_t> triangles;  // per triangle: its number within its whole object
  bool self = false;                     // an object of the whole scene is tested against itself
};

/// The lines of a list, pair after pair: 0-based, in decimal, triangles counted within their
/// object; `neighbours` is 1 for triangles of one object that share a vertex position, else 0.
class PairListRows {
 public:
  /// numbers: null for those of the scene itself; else they, as the scene, must outlive the object.
  explicit PairListRows(const Scene& scene, const ListNumbers* numbers = nullptr);
  /// Appends the line of a pair to `text`. Precondition: both triangles are of the scene.
  void append(const TrianglePair& pair, std::string& text) const;

 private:
  const Scene& scene_;
  const ListNumbers* numbers_;
  std::vector<std::uint32_t> owner_;
  bool self_;
};

/// The whole list: the header, then the lines of the pairs in the order given.
std::string pair_list(const Scene& scene, std::span<const TrianglePair> pairs);

/// SHA-256 of pair_list(), or of the list with these numbers: 64 lower-case hexadecimal digits.
/// Memory O(triangles), whatever the number of pairs.
std::string pair_list_hash(const Scene& scene, std::span<const TrianglePair> pairs,
                           const ListNumbers* numbers = nullptr);

/// A row of a list, as it stands there.
struct ListedPair {
  std::uint64_t line = 0;  // 1-based
  std::uint32_t frame = 0;
  std::array<std::uint32_t, 2> object{}, triangle{};
  std::optional<bool> neighbours;
};

struct GivenList {
  std::string name;                        // of the file
  bool has_frames = false;                 // a column `frame`
  std::vector<ListedPair> rows;            // in the order of the file
  std::vector<std::string> not_looked_at;  // names of the columns that are not read
};

/// Reads CSV: a first line that names the columns object_a, triangle_a, object_b and triangle_b in
/// any order, and may name `frame`, `neighbours` and others; then one line for each pair. Cells are
/// divided by commas and may be in double quotes; lines end with LF or CR LF; empty lines are
/// skipped. Throws Error naming `name`, the line and a remedy if a column is missing or named
/// twice, a line has more or fewer cells, or a cell is no whole number.
GivenList read_pair_list(std::string_view text, const std::string& name);

/// How a list differs from the list of the pairs that meet.
struct ListDifferences {
  std::uint64_t listed = 0;      // rows
  std::uint64_t wrong = 0;       // rows whose pair does not meet, was listed before, or has a wrong
                                 // entry in `neighbours`
  std::uint64_t missing = 0;     // pairs that meet and are in no row
  std::uint64_t wrong_line = 0;  // line of the first wrong row
  std::string wrong_reason;      // why it is wrong, as in "the pair is disjoint"
  std::optional<TrianglePair> wrong_pair;    // empty: the row names one triangle twice
  std::optional<TrianglePair> missing_pair;  // the first in the order of the scene

  bool none() const { return wrong == 0 && missing == 0; }
};

/// The pair of a row, a < b (a == b if the row names one triangle twice). Throws Error naming the
/// list and the line if the scene has no such object or triangle.
TrianglePair pair_of(const Scene& scene, const std::string& name, const ListedPair& row);

/// Compares rows with `meeting`: the pairs that meet (with a clearance: that are within it),
/// sorted, each once. The order of rows and of the triangles in a row does not matter. Throws Error
/// as pair_of().
ListDifferences find_differences(const Scene& scene, const std::string& name,
                                 std::span<const ListedPair> rows,
                                 std::span<const TrianglePair> meeting, double clearance = 0);

}  // namespace farcull
