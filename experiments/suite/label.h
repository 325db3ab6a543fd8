// Decides how two triangles meet, and which pairs of a mesh collide: each answer by two exact
// oracles that share no code, and a disagreement is an Error. So a label of the suite rests on no
// single program.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/suite/reader.h"

namespace farcull {

/// How two closed triangles meet, as docs/suite.md defines the kinds. CGAL's predicates
/// (verify/exact), the 38 directions and the 21 points in integers (verify/certificate) say whether
/// they do; the points that they have in common, as rational numbers, say how, and CGAL's
/// predicates once more whether they cross (verify/contact). Throws Error naming `where` and
/// `line` where two answers differ. Coordinates have to be finite.
SuiteKind decide_kind(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      const std::string& where, long line = 0);

/// The kind of a pair of neighbours: whether they meet in more than their shared corners and the
/// segments between these. By CGAL's predicates and by integers; throws Error as decide_kind().
SuiteKind decide_neighbours(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where, long line = 0);

/// decide_neighbours() where the pair has shared corners, else decide_kind().
SuiteKind decide(const SuitePair& pair, const std::string& where);

/// Every pair of corners at equal positions, ascending.
std::vector<SharedCorner> equal_corners(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// All colliding pairs of a mesh, ascending: CGAL's join of boxes and predicates find them, and the
/// checker of certificates proves the list with integers alone. Throws Error naming `where` where
/// it does not, and where two vertices of an object that is tested against itself are at one
/// position: by the indices their triangles would be no neighbours, by the positions they would.
std::vector<SuiteMeshPair> decide_mesh(const Scene& scene, const std::string& where);

}  // namespace farcull
