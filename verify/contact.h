// How two triangles that intersect do so: they penetrate, or they merely touch.
//
// The lectures on CULLIDE and S-CULLIDE distinguish *penetrating* contacts, where the surfaces pass
// through each other, from *touching* ones, which S-CULLIDE ignores. Here as an exact definition:
// two triangles penetrate iff their relative interiors meet and they do not lie in one plane. Two
// others that intersect touch. What this means: A and B penetrate iff 0 is an interior point of A -
// B, so a pair penetrates iff no translation below some length separates it, and touches iff
// arbitrarily short ones do (away from a plane between the two, or off their common plane).
//
// Semantics and preconditions as in verify/exact.h: the doubles as given, any finite ones; a
// degenerate triangle is the segment or the point that it is. The relative interior of a triangle
// is the triangle without its edges, that of a segment is the segment without its ends, and that of
// a point the point. Two segments that meet, and a point and anything that it meets, lie in one
// plane: they touch. Every decision is the sign of a determinant, evaluated exactly.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <thread>

#include "core/scene/scene.h"

namespace farcull {

enum class Contact : std::uint8_t { touching, penetrating };

/// The contact of two triangles that intersect. Symmetric; the order of corners does not matter.
/// Precondition: intersects(a, b) (not checked: triangles that share no point come out as
/// touching). Neighbours are treated as any other triangles: if they meet only in what they share,
/// they touch.
Contact contact_of(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

struct ContactCounts {
  std::uint64_t touching = 0;
  std::uint64_t penetrating = 0;

  bool operator==(const ContactCounts&) const = default;
};

/// Counts the contacts of pairs that intersect, each pair as often as it is given; 0 threads count
/// as 1, and their number changes no answer. Throws std::logic_error if a pair names a triangle
/// that the scene does not have or one triangle twice.
ContactCounts count_contacts(const Scene& scene, std::span<const TrianglePair> pairs,
                             unsigned threads = std::thread::hardware_concurrency());

}  // namespace farcull
