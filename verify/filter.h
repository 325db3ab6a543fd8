// Decides about two triangles in plain doubles. A forward error bound proves each answer. If
// rounding leaves a doubt, the answer is `unknown`, and exact arithmetic decides (verify/exact).
//
// These filters decide most pairs that reach the exact tests, so they are fast: they allocate
// nothing, do not change the rounding mode, and branch only to return an answer early.
//
// Preconditions: finite coordinates of any magnitude; round to nearest; subnormals are not flushed;
// products and sums are not contracted to fused operations.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/scene/scene.h"
#include "verify/rounding.h"

namespace farcull {

/// Corners of pair.b are prefetched this many pairs ahead. Corners of pair.a are mostly in the
/// cache.
inline constexpr std::size_t kAhead = 8;

/// Decides whether the distance of the triangles is at most `clearance` (finite, >= 0). Uses only
/// the planes of the triangles.
/// - yes: the triangles cross.
/// - no: one triangle is on one side of the other's plane and farther from it than the clearance;
///   or the clearance is 0 and the triangles miss each other along the common line of their planes.
/// - unknown: a triangle is degenerate, the triangles touch without crossing, or rounding leaves a
///   doubt.
Triage filter_planes(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                     double clearance = 0);

/// Decides whether the triangles (v, a1, a2) and (v, b1, b2) share more than v.
Triage filter_beyond_vertex(const Vec3& v, const Vec3& a1, const Vec3& a2, const Vec3& b1,
                            const Vec3& b2);

/// Decides whether (p, q, r) and (p, q, s) share more than the segment from p to q. Never `yes`,
/// since doubles do not prove that four points lie in one plane.
Triage filter_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s);

/// Decides whether the distance is at most `clearance` (> 0), by two points close to each other and
/// the direction between them. Does not look for points where an edge crosses a face. `unknown` if
/// distance and clearance differ by less than about 1e-14 of the pair's extent.
Triage filter_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance);

/// Sets answers[i] to the answer of filter_planes() about pairs[i] and the clearance. The answers
/// are the same on every instruction set (core/native/canvas.h). Fast if successive pairs have the
/// same a. Preconditions: those at the top of this file; answers.size() == pairs.size(); every
/// index is in range.
void filter_pairs(const Scene& scene, std::span<const TrianglePair> pairs, double clearance,
                  std::span<Triage> answers);

}  // namespace farcull
