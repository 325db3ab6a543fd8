// Labelled triangle pairs, meshes and questions of a suite, and the functions that decide labels.
// docs/suite.md has the format of the files.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// How two closed triangles meet. docs/suite.md defines the kinds; a pair has exactly one.
/// unlabelled: not decided yet.
enum class SuiteKind : std::uint8_t {
  apart,
  touch_vertex,
  touch_edge,
  touch_face,
  crossing,
  coplanar,
  equal,
  neighbours_meet,   // they share vertices, and meet in more than these and the edge between them
  neighbours_apart,  // they share vertices, and meet only in these and that edge
  unlabelled
};

/// The name in a list of pairs, such as "touch-vertex"; "?" for unlabelled.
std::string to_string(SuiteKind kind);
/// Whether a pair of this kind collides. Precondition: not unlabelled.
bool collides(SuiteKind kind);

/// Corner `a` (0 to 2) of the first triangle and corner `b` of the second are one vertex of a mesh.
struct SharedCorner {
  std::uint8_t a = 0;
  std::uint8_t b = 0;
  auto operator<=>(const SharedCorner&) const = default;
};

struct SuitePair {
  std::uint64_t id = 0;  // position in its file, from 0
  double parameter = 0;  // the family's parameter; 0 if it has none
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
  bool self = false;                 // every object is tested against itself too
  Scene scene;                       // objects "0", "1", ... in order; each with the same `self`
  std::vector<SuiteMeshPair> pairs;  // all colliding pairs, ascending, each once
};

/// A finite double as C's %a prints it, such as 0x1.8p+1, whatever the locale.
std::string hexadecimal(double value);

// Two exact oracles that share no code decide each label, so that no label of the suite rests on
// one program alone.

/// How two closed triangles meet; docs/suite.md defines the kinds. Throws Error naming `where` if
/// two oracles differ. Whether the triangles meet is decided by CGAL's predicates (verify/exact),
/// and by integer arithmetic on 38 directions and 21 points (verify/certificate). How they meet is
/// decided by their common points as rational numbers; CGAL's predicates (verify/contact) also
/// decide whether they cross. Precondition: finite coordinates.
SuiteKind decide_kind(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      const std::string& where);

/// The kind of a pair of neighbours: whether they meet in more than their shared corners and the
/// segments between these. By CGAL's predicates and in integers; throws Error as decide_kind().
SuiteKind decide_neighbours(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where);

/// decide_neighbours() if the pair has shared corners, else decide_kind().
SuiteKind decide(const SuitePair& pair, const std::string& where);

/// Every pair of corners at equal positions, ascending.
std::vector<SharedCorner> equal_corners(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// All colliding pairs of a mesh, ascending: a box join and CGAL's predicates find them, and the
/// checker of certificates proves the list with integers alone. Throws Error naming `where` if the
/// checker does not prove it. Also throws Error if an object that is tested against itself has two
/// vertices at one position: their triangles would be neighbours by position, but not by index.
std::vector<SuiteMeshPair> decide_mesh(const Scene& scene, const std::string& where);

// ---- questions beyond "which triangles collide" ----

enum class SuiteQuestionKind : std::uint8_t { distance, self, inside, clash };

struct SuiteQuestion {
  std::uint64_t id = 0;
  double parameter = 0;
  SuiteQuestionKind kind = SuiteQuestionKind::distance;
  std::string label = {};                // as in the file; "?" if it is not known
  std::vector<std::string> paths = {};   // of OBJ files, relative to the folder of the suite
  std::vector<double> coordinates = {};  // 18 of two triangles, 3 of a point, or none
};

/// One file of questions.
struct SuiteQuestions {
  std::string family = {};
  std::vector<SuiteQuestion> questions = {};
};

/// The text of a file of questions.
std::string questions_text(const SuiteQuestions& questions);

/// Asks for the distances of the first pairs of a family, as many as the small suite has. Pairs
/// with shared corners are left out.
SuiteQuestions questions_of(const SuitePairs& pairs);
/// Questions about the objects of a mesh: whether each meets itself; for closed ones, also whether
/// points are inside and whether two clash. There is no question where the oracles cannot decide.
SuiteQuestions questions_of(const SuiteMesh& mesh, std::uint64_t seed);

// As above, two programs that share no code decide each label. Throws Error naming `where` if they
// differ.

/// "LOW,HIGH": the distance of two triangles lies between these doubles, which are equal or
/// neighbours. Found in exact fractions (verify/closest.h), and in integers by the directions of
/// the certificate checker.
std::string decide_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where);
/// Whether each point is in the closed object 0 of the scene or on its surface. Found by rays in
/// rational numbers (verify/inside.h), and in integers (verify/certificate/integer_distance.h).
std::vector<bool> decide_inside(const Scene& scene, const std::vector<Vec3>& points,
                                const std::string& where);
/// Whether the insides of the closed objects 0 and 1 overlap. True if a point is found that is
/// inside both; the oracles of decide_inside() check it. False if an axis-aligned plane lies
/// between the objects. Empty if neither is found.
std::optional<bool> decide_clash(const Scene& scene, const std::string& where);

}  // namespace farcull
