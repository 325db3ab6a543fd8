// Answers about two triangles from plain doubles alone, each proved by a forward error bound; where
// rounding leaves a doubt they say so, and exact arithmetic decides (verify/exact).
//
// No allocation, no change of the rounding mode, no branches on data but the answers: most pairs
// that reach the exact tests leave them here.
//
// Preconditions: finite coordinates of any magnitude; round to nearest, subnormals not flushed,
// products and sums not contracted.
#pragma once

#include <array>
#include <span>

#include "core/scene/scene.h"
#include "verify/rounding.h"

namespace farcull {

/// Is the distance of the triangles at most `clearance` (finite, >= 0)? Looks at their planes
/// alone: `yes` where they cross, `no` where one is on one side of the other's plane and farther
/// from it than the clearance; with clearance 0 also where they miss each other along the line of
/// the planes. Degenerate triangles and contacts without overlap are `unknown`, and so is what
/// nearly is one.
Triage filter_planes(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                     double clearance = 0);

/// Do the triangles (v, a1, a2) and (v, b1, b2) share more than v?
Triage filter_beyond_vertex(const Vec3& v, const Vec3& a1, const Vec3& a2, const Vec3& b1,
                            const Vec3& b2);

/// Do the triangles (p, q, r) and (p, q, s) share more than the segment from p to q? Never `yes`:
/// that takes four points in one plane.
Triage filter_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s);

/// The same for a clearance > 0, by two points close to each other and the direction between them.
/// It looks only at the boundaries of triangles that cross. `unknown` within about 1e-14 of the
/// extent of the pair.
Triage filter_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

/// answers[i]: that of filter_planes() about the triangles of pairs[i], a before b, and the
/// clearance; the same on every instruction set (core/native/lanes.h). As many answers as pairs.
/// Fast where successive pairs have the same a. Preconditions as above; every index is in
/// range.
void filter_pairs(const Scene& scene, std::span<const TrianglePair> pairs, double clearance,
                  std::span<Triage> answers);

}  // namespace farcull
