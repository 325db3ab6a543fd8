// The data of the test suite: pairs of triangles, meshes and questions, each with its label (the
// right answer). Also the functions that compute labels. docs/suite.md defines the file format.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// How two closed triangles meet. Each pair has exactly one kind; docs/suite.md defines the kinds.
/// unlabelled: the kind is not computed yet.
enum class SuiteKind : std::uint8_t {
  apart,
  touch_vertex,
  touch_edge,
  touch_face,
  crossing,
  coplanar,
  equal,
  neighbours_meet,   // neighbours with common points outside their shared corners and shared edge
  neighbours_apart,  // neighbours without such common points
  unlabelled
};

/// Returns the name that files use, such as "touch-vertex"; "?" for unlabelled.
std::string to_string(SuiteKind kind);
/// True if a pair of this kind collides. Precondition: the kind is not `unlabelled`.
bool collides(SuiteKind kind);

/// Corner `a` (0 to 2) of the first triangle and corner `b` of the second are the same mesh vertex.
struct SharedCorner {
  std::uint8_t a = 0;
  std::uint8_t b = 0;
  auto operator<=>(const SharedCorner&) const = default;
};

struct SuitePair {
  std::uint64_t id = 0;  // position in the file, from 0
  double parameter = 0;  // parameter of the family; 0 if the family has no parameter
  /// Shared corners, ascending, each listed once; empty if the triangles are not neighbours.
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
  TrianglePair pair;         // triangle indices in SuiteMesh::scene
  std::uint32_t shared = 0;  // number of common vertices; 0 for triangles of different objects
  auto operator<=>(const SuiteMeshPair&) const = default;
};

struct SuiteMesh {
  std::string name;  // name of the folder of the mesh
  std::string family;
  double parameter = 0;
  bool self = false;                 // true: each object is tested against itself
  Scene scene;                       // objects "0", "1", ... in this order, with equal `self`
  std::vector<SuiteMeshPair> pairs;  // all colliding pairs, ascending, each once
};

/// Returns a finite double in the format %a of C's printf, such as 0x1.8p+1, in any locale.
std::string hexadecimal(double value);

// Two exact methods that share no code compute each label. So no label depends on one program.

/// Returns how two closed triangles meet; docs/suite.md defines the kinds. Whether the triangles
/// meet is decided twice: by CGAL's predicates (verify/exact) and by integer arithmetic
/// (verify/certificate). If they meet, their common points, computed as rational numbers, give the
/// kind. CGAL's predicates (verify/contact) check whether the kind is `crossing`. Throws Error
/// naming `where` if two results differ. Precondition: finite coordinates.
SuiteKind decide_kind(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      const std::string& where);

/// Returns neighbours_meet if the triangles have common points outside their shared corners and the
/// segments between shared corners, else neighbours_apart. Decided twice, by CGAL's predicates and
/// by integer arithmetic. Throws Error as decide_kind() does.
SuiteKind decide_neighbours(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where);

/// Calls decide_neighbours() if the pair has shared corners, else decide_kind().
SuiteKind decide(const SuitePair& pair, const std::string& where);

/// Returns every pair of corners at equal positions, ascending.
std::vector<SharedCorner> equal_corners(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns all colliding pairs of a mesh, ascending. A join of boxes finds candidates, and CGAL's
/// predicates test the candidates. The certificate checker then proves the list in integers. Throws
/// Error naming `where` if the proof fails. Also throws Error if an object that is tested against
/// itself has two vertices at one position: its triangles could be neighbours by position, but not
/// by index.
std::vector<SuiteMeshPair> decide_mesh(const Scene& scene, const std::string& where);

// ---- questions beyond "which triangles collide" ----

enum class SuiteQuestionKind : std::uint8_t { distance, self, inside, clash };

struct SuiteQuestion {
  std::uint64_t id = 0;
  double parameter = 0;
  SuiteQuestionKind kind = SuiteQuestionKind::distance;
  std::string label = {};                // right answer as written in the file; "?": unknown
  std::vector<std::string> paths = {};   // OBJ files, relative to the folder of the suite
  std::vector<double> coordinates = {};  // 18 for two triangles, 3 for a point, or none
};

/// One file of questions.
struct SuiteQuestions {
  std::string family = {};
  std::vector<SuiteQuestion> questions = {};
};

/// Returns the text of the file.
std::string questions_text(const SuiteQuestions& questions);

/// Returns questions about distances: one for each of the first 530 pairs of a family, without the
/// pairs that share corners. The small suite has 530 pairs of each family.
SuiteQuestions questions_of(const SuitePairs& pairs);
/// Returns questions about the objects of a mesh. For each object: does the object meet itself? For
/// closed objects: is a point inside (kind `inside`), and do the insides of two objects overlap
/// (kind `clash`)? Omits questions that cannot be decided.
SuiteQuestions questions_of(const SuiteMesh& mesh, std::uint64_t seed);

// The next functions compute labels of questions. Two implementations that share no code compute
// each label. If their results differ, the functions throw Error naming `where`.

/// Returns "LOW,HIGH" with LOW <= distance of the triangles <= HIGH. LOW and HIGH are equal or
/// adjacent doubles. One implementation computes the distance as an exact fraction
/// (verify/closest.h). The other uses integers and the directions of the certificate checker.
std::string decide_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where);
/// Returns one value per point: true if the point is inside object 0 of the scene or on the surface
/// of object 0. One implementation casts rays in rational numbers (verify/inside.h), the other uses
/// integers (verify/certificate/integer_distance.h). Precondition: object 0 is closed.
std::vector<bool> decide_inside(const Scene& scene, const std::vector<Vec3>& points,
                                const std::string& where);
/// Returns whether the insides of the closed objects 0 and 1 overlap. True if random sampling finds
/// a point inside both objects; decide_inside() checks this point. False if the bounding boxes do
/// not overlap, apart from their boundaries. Otherwise empty.
std::optional<bool> decide_clash(const Scene& scene, const std::string& where);

}  // namespace farcull
