// Reads a suite of labelled triangle pairs and meshes, and decides labels. docs/suite.md has the
// format. Reading checks all but whether triangles meet: check_suite() (writer.h) decides that.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// How two closed triangles meet. docs/suite.md defines the kinds; a pair has exactly one.
/// unlabelled is for pairs in other people's lists whose answer is not decided.
enum class SuiteKind : std::uint8_t {
  apart,
  touch_vertex,
  touch_edge,
  touch_face,
  crossing,
  coplanar,
  equal,
  neighbours_meet,   // they share vertices, and meet in more than these and the edge between them
  neighbours_apart,  // they share vertices, and do not meet in more
  unlabelled
};

/// As in a list of pairs: "touch-vertex"; "?" for unlabelled.
std::string to_string(SuiteKind kind);
/// The inverse; empty if no kind has this name.
std::optional<SuiteKind> parse_suite_kind(std::string_view name);
/// Whether a pair of this kind collides. Precondition: not unlabelled.
bool collides(SuiteKind kind);

/// Corner `a` (0 to 2) of the first triangle and corner `b` of the second are one vertex of a mesh.
struct SharedCorner {
  std::uint8_t a = 0;
  std::uint8_t b = 0;
  auto operator<=>(const SharedCorner&) const = default;
};

struct SuitePair {
  std::uint64_t id = 0;  // counts from 0 in its file
  long line = 0;         // in the file that was read, from 1; 0 if it was made
  double parameter = 0;  // the family's number; 0 if it has none
  /// Ascending, each once; empty for triangles that are not neighbours in a mesh.
  std::vector<SharedCorner> shared;
  SuiteKind kind = SuiteKind::unlabelled;
  std::array<Vec3, 3> a, b;  // finite corners; either triangle may be degenerate
};

/// One file of pairs.
struct SuitePairs {
  std::string family;
  std::vector<SuitePair> pairs;
};

/// Reads a file of pairs. Throws Error naming the file, the line and a remedy if the file cannot be
/// read, does not end with a newline, or has another form: another first line, IDs that do not
/// count from 0, a word that is no number or no kind, a shared corner whose coordinates differ, a
/// kind of neighbours without shared corners or shared corners with another kind, too few or too
/// many words.
SuitePairs read_pairs(const std::string& path);
/// The same for a text in memory; `name` stands for the path in errors.
SuitePairs parse_pairs(std::string_view text, const std::string& name);

/// A colliding pair of a mesh.
struct SuiteMeshPair {
  TrianglePair pair;         // of SuiteMesh::scene
  std::uint32_t shared = 0;  // vertices shared by index, 0 to 3; 0 in different objects
  auto operator<=>(const SuiteMeshPair&) const = default;
};

struct SuiteMesh {
  std::string name;  // of the folder
  std::string family;
  double parameter = 0;
  bool self = false;      // every object is tested against itself too
  std::string note = {};  // the comments of mesh.txt, without "# ", with newlines between them
  Scene scene;            // objects "0", "1", ... in order; each is `self` where the mesh is
  bool labelled = true;   // false: there is no pairs.csv, and `pairs` is empty
  std::vector<SuiteMeshPair> pairs;  // all that collide, ascending, each once
};

/// Reads a folder of a mesh. Throws Error naming the file, the line and a remedy if a file is
/// missing or malformed, or a face is no triangle; and if a pair names no triangle of the mesh, is
/// of one object although `self` is no, is out of order, or has a `shared` that disagrees with the
/// indices.
SuiteMesh read_mesh(const std::string& folder);

/// How many vertices two triangles of one object share: indices in both triangles, each once.
std::uint32_t shared_vertices(const Scene& scene, const TrianglePair& pair);

/// The folder of a suite, by its suite.txt.
struct SuiteIndex {
  struct File {
    std::string path;  // relative to the folder
    std::uint64_t bytes = 0;
    std::string sha256;       // 64 lower-case hexadecimal digits
    std::uint64_t items = 0;  // pairs, or the triangles of an OBJ; 0 for mesh.txt
    bool operator==(const File&) const = default;
  };

  std::uint64_t seed = 0;
  std::string size;  // small or full
  std::string licence;
  std::vector<File> files;  // by path, ascending
  std::string sum;          // SHA-256 of all lines but the last: it names the whole suite

  std::vector<std::string> pair_files() const;    // their paths, as in "pairs/random.txt"
  std::vector<std::string> mesh_folders() const;  // as in "meshes/cloth-1"
};

/// Reads FOLDER/suite.txt and compares its sum. Throws Error naming the file, the line and a
/// remedy. Does not read the files that suite.txt names: check_files() does.
SuiteIndex read_suite(const std::string& folder);
/// The same for a text in memory; `name` stands for the path in errors.
SuiteIndex parse_suite(std::string_view text, const std::string& name);

/// Throws Error naming the first file of the suite that is missing or has another length or sum; or
/// the first file below pairs/ and meshes/ that the suite does not name.
void check_files(const std::string& folder, const SuiteIndex& index);

/// A line of a list of pairs or of questions that is no comment.
struct ListLine {
  std::string list;  // the name of the file
  long number = 0;   // from 1
  std::uint64_t id = 0;
  double parameter = 0;
  std::vector<std::string_view> words;  // all of the line; at least four

  /// The words from that one on as doubles.
  std::vector<double> coordinates(std::size_t from) const;
  /// Throws Error naming the file and the line.
  [[noreturn]] void fail(const std::string& reason) const;
};
/// Calls take() for each line of a list whose first line is `KIND 1 FAMILY`, and returns the
/// family. Throws Error for another first line, a text that does not end with a newline, and IDs
/// that do not count from 0.
std::string read_list(std::string_view text, const std::string& name, const std::string& kind,
                      const std::function<void(const ListLine&)>& take);

/// A finite double as C's %a prints it, such as 0x1.8p+1; empty for anything else.
std::optional<double> parse_hexadecimal(std::string_view word);
/// Appends a finite double as C's %a prints it, whatever the locale.
void append_hexadecimal(std::string& text, double value);

// Decides how two triangles meet, and which pairs of a mesh collide. Two exact oracles that share
// no code give each answer; a disagreement is an Error. So no label of the suite rests on one
// program alone.

/// How two closed triangles meet, as docs/suite.md defines the kinds. CGAL's predicates
/// (verify/exact), and the 38 directions and 21 points in integers (verify/certificate), decide
/// whether they meet. Their common points, as rational numbers, decide how; CGAL's predicates also
/// decide whether they cross (verify/contact). Throws Error naming `where` and `line` if two
/// answers differ. Precondition: finite coordinates.
SuiteKind decide_kind(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      const std::string& where, long line = 0);

/// The kind of a pair of neighbours: whether they meet in more than their shared corners and the
/// segments between these. By CGAL's predicates and by integers; throws Error as decide_kind().
SuiteKind decide_neighbours(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where, long line = 0);

/// decide_neighbours() if the pair has shared corners, else decide_kind().
SuiteKind decide(const SuitePair& pair, const std::string& where);

/// Every pair of corners at equal positions, ascending.
std::vector<SharedCorner> equal_corners(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// All colliding pairs of a mesh, ascending: a box join and CGAL's predicates find them, and the
/// checker of certificates proves the list with integers alone. Throws Error naming `where` if the
/// checker does not prove it. Also throws Error if an object that is tested against itself has two
/// vertices at one position: their triangles would be neighbours by position, but not by index.
std::vector<SuiteMeshPair> decide_mesh(const Scene& scene, const std::string& where);

}  // namespace farcull
