// Labelled triangle pairs, meshes and questions of a suite, and the functions that decide labels.
// docs/suite.md defines the format of the files.
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
  neighbours_meet,   // neighbours that meet in more than their shared vertices and the edge between
                     // these
  neighbours_apart,  // neighbours that meet only in their shared vertices and the edge between
                     // these
  unlabelled
};

/// The name in a list of pairs, such as "touch-vertex"; "?" for unlabelled.
std::string to_string(SuiteKind kind);
/// True if a pair of this kind collides. Precondition: not unlabelled.
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
  /// Corners that are one vertex of a mesh, ascending, each pair once; empty if not neighbours.
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
  std::uint32_t shared = 0;  // common vertices, 0 to 3; 0 in different objects
  auto operator<=>(const SuiteMeshPair&) const = default;
};

struct SuiteMesh {
  std::string name;  // of the folder
  std::string family;
  double parameter = 0;
  bool self = false;                 // each object is tested against itself
  Scene scene;                       // objects "0", "1", ... in order; each with the same `self`
  std::vector<SuiteMeshPair> pairs;  // all colliding pairs, ascending, each once
};

/// A finite double as C's %a prints it, such as 0x1.8p+1, whatever the locale.
std::string hexadecimal(double value);

// Two exact oracles that share no code decide each label, so that no label depends on one program
// alone.

/// Returns how two closed triangles meet; docs/suite.md defines the kinds. Two oracles decide
/// whether the triangles meet: CGAL's predicates (verify/exact), and integer arithmetic on 38
/// directions and 21 points (verify/certificate). The common points, as rational numbers, decide
/// how the triangles meet. CGAL's predicates (verify/contact) decide whether they cross. Throws
/// Error naming `where` if two oracles differ. Precondition: finite coordinates.
SuiteKind decide_kind(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      const std::string& where);

/// Returns the kind of a pair of neighbours: whether they meet in more than their shared corners
/// and the segments between these. CGAL's predicates and integer arithmetic decide. Throws Error as
/// decide_kind() does.
SuiteKind decide_neighbours(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where);

/// Calls decide_neighbours() if the pair has shared corners, else decide_kind().
SuiteKind decide(const SuitePair& pair, const std::string& where);

/// Returns every pair of corners at equal positions, ascending.
std::vector<SharedCorner> equal_corners(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns all colliding pairs of a mesh, ascending. A box join and CGAL's predicates find the
/// pairs. The checker of certificates proves the list with integers alone. Throws Error naming
/// `where` if the checker does not prove it. Also throws Error if an object that is tested against
/// itself has two vertices at one position: their triangles would be neighbours by position, but
/// not by index.
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

/// Returns questions for the distances of the first pairs of a family: as many as the small suite
/// has pairs of the family. Pairs with shared corners are left out.
SuiteQuestions questions_of(const SuitePairs& pairs);
/// Returns questions about the objects of a mesh: whether an object meets itself, and for closed
/// objects, whether points are inside and whether two objects clash. Leaves out questions that the
/// oracles cannot decide.
SuiteQuestions questions_of(const SuiteMesh& mesh, std::uint64_t seed);

// These functions decide labels of questions. Two programs that share no code decide each label.
// The functions throw Error naming `where` if the two programs differ.

/// Returns "LOW,HIGH": equal or neighbouring doubles, between which the distance of the triangles
/// lies. One program computes with exact fractions (verify/closest.h), the other with integers and
/// the directions of the certificate checker.
std::string decide_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where);
/// Returns for each point whether it is inside the closed object 0 of the scene or on its surface.
/// One program uses rays in rational numbers (verify/inside.h), the other integers
/// (verify/certificate/integer_distance.h).
std::vector<bool> decide_inside(const Scene& scene, const std::vector<Vec3>& points,
                                const std::string& where);
/// Returns whether the insides of the closed objects 0 and 1 overlap. True if a point inside both
/// objects is found; the oracles of decide_inside() check the point. False if an axis-aligned plane
/// lies between the objects. Empty if neither such a point nor such a plane is found.
std::optional<bool> decide_clash(const Scene& scene, const std::string& where);

}  // namespace farcull
