// Decides whether two triangles that intersect penetrate or merely touch.
//
// The lectures on CULLIDE and S-CULLIDE distinguish *penetrating* contacts, where the surfaces pass
// through each other, from *touching* contacts, which S-CULLIDE ignores. The exact definition here:
// two triangles penetrate iff their relative interiors meet and they do not lie in one plane. All
// other triangles that intersect touch. In other words, A and B penetrate iff 0 is an interior
// point of A - B. Then only translations above some length separate A and B. Triangles that touch
// are separated by arbitrarily short translations.
//
// Semantics and preconditions as in verify/exact.h: any finite doubles; a degenerate triangle is a
// segment or a point. The relative interior is the triangle without its edges, the segment without
// its ends, or the whole point. Two segments that meet lie in one plane, so they touch. A point
// touches every triangle that it meets. Every decision is the sign of a determinant, evaluated
// exactly.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <thread>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// True if two triangles penetrate. False for triangles that share no point. Symmetric; the order
/// of corners does not matter. Neighbours are treated as any other triangles: if they meet only in
/// their shared part, they touch.
bool penetrate(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

struct ContactCounts {
  std::uint64_t touching = 0;
  std::uint64_t penetrating = 0;

  bool operator==(const ContactCounts&) const = default;
};

/// Counts the contacts of pairs that intersect, each pair as often as it is given. 0 threads count
/// as 1; the number of threads changes no answer. Throws std::logic_error if a pair names one
/// triangle twice, or a triangle that the scene does not have.
ContactCounts count_contacts(const Scene& scene, std::span<const TrianglePair> pairs,
                             unsigned threads = std::thread::hardware_concurrency());

// ---- kinds of contact ----
//
// contact_kind() returns how two triangles meet, as one of seven kinds. contact_shape() also
// returns the points in common. Every two triangles A and B have exactly one kind, the first that
// fits (docs/record.md, "Kinds of contact"; the labels of docs/suite.md are the same). A segment
// has two corners (its ends) and one edge (itself); a point has one corner (itself). Neighbours are
// treated as any other triangles: the part that they share is a contact too.

enum class ContactKind : std::uint8_t {
  apart,         // no point in common: a pair that collides only by a clearance
  equal,         // A and B are the same set of points
  touch_vertex,  // one point in common, which is a corner of A or of B
  touch_edge,    // one point in common, which is on an edge of A and on an edge of B
  coplanar,      // in one plane, and more than one point in common
  crossing,      // a point in common that is on no edge of A and on no edge of B;
                 // a segment crosses a triangle if it passes through the triangle's inside
  touch_face,    // a segment in common that is on an edge of A or of B
};

inline constexpr std::array kContactKinds = {ContactKind::apart,        ContactKind::equal,
                                             ContactKind::touch_vertex, ContactKind::touch_edge,
                                             ContactKind::coplanar,     ContactKind::crossing,
                                             ContactKind::touch_face};

/// Returns the kind's label in a suite, such as "touch-vertex".
std::string_view name_of(ContactKind kind);
/// The inverse of name_of(); empty if no kind has this name.
std::optional<ContactKind> parse_contact_kind(std::string_view name);

/// The kind, and the points in common, which are a convex set.
struct ContactShape {
  ContactKind kind = ContactKind::apart;
  int dimension = -1;  // of these points: 0 a point, 1 a segment, 2 a polygon, -1 none
  /// World units. Dimension 1: the ends of the segment, the lexicographically lower end first, each
  /// coordinate rounded once to the nearest double. Dimension 0: the point, twice. Otherwise zeros.
  std::array<Vec3, 2> ends = {Vec3::Zero(), Vec3::Zero()};
  bool operator==(const ContactShape&) const = default;
};

/// Returns the exact kind. Symmetric; the order of corners does not matter.
ContactKind contact_kind(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns the exact kind and the common points; only `ends` are rounded. Symmetric; the order of
/// corners does not matter.
ContactShape contact_shape(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns the corners of the common polygon in order around it, each coordinate rounded once to
/// the nearest double. Empty unless the points in common have dimension 2. The lexicographically
/// lowest corner comes first; the lower one of its two neighbours comes second. The exact corners
/// are compared; different corners may be rounded to the same doubles. Symmetric; the order of the
/// triangles' corners does not matter.
std::vector<Vec3> contact_polygon(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns the kind of each pair, in the order given. 0 threads count as 1; the number of threads
/// changes no answer. Throws std::logic_error if a pair names a triangle that the scene does not
/// have.
std::vector<ContactKind> contact_kinds(const Scene& scene, std::span<const TrianglePair> pairs,
                                       unsigned threads = std::thread::hardware_concurrency());

/// Like contact_kinds(), but returns the common points as well.
std::vector<ContactShape> contact_shapes(const Scene& scene, std::span<const TrianglePair> pairs,
                                         unsigned threads = std::thread::hardware_concurrency());

}  // namespace farcull
