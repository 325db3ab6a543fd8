// Labelled triangle pairs and meshes, and the functions that decide labels. docs/suite.md has the
// format of the files.
#pragma once

#include <array>
#include <cstdint>
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
  bool self = false;  // every object is tested against itself too
  Scene scene;        // objects "0", "1", ... in order; each is `self` where the mesh is
  std::vector<SuiteMeshPair> pairs;  // all that collide, ascending, each once
};

/// A finite double as C's %a prints it, such as 0x1.8p+1, whatever the locale.
std::string hexadecimal(double value);

/// How many vertices two triangles of one object share: indices in both triangles, each once.
std::uint32_t shared_vertices(const Scene& scene, const TrianglePair& pair);

// Decides how two triangles meet, and which pairs of a mesh collide. Two exact oracles that share
// no code give each answer, and an Error is thrown if they differ. So no label of the suite rests
// on one program alone.

/// How two closed triangles meet; docs/suite.md defines the kinds. Each answer is found in two
/// ways, and an Error naming `where` is thrown if they differ. Whether they meet: CGAL's predicates
/// (verify/exact), and integer arithmetic on 38 directions and 21 points (verify/certificate). How
/// they meet: their common points as rational numbers; CGAL's predicates (verify/contact) also
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

}  // namespace farcull
