// Decides whether two triangles that intersect penetrate or merely touch.
//
// The lectures on CULLIDE and S-CULLIDE distinguish *penetrating* contacts, where the surfaces pass
// through each other, from *touching* contacts, which S-CULLIDE ignores. The exact definition here:
// two triangles that intersect *penetrate* iff their relative interiors meet and they do not lie in
// one plane; otherwise they *touch*. Equivalently, A and B penetrate iff 0 is an interior point of
// the Minkowski difference A - B. Then every translation that separates A and B is longer than some
// positive number. Triangles that touch are separated by arbitrarily short translations.
//
// Semantics and preconditions are those of verify/exact.h: any finite doubles are allowed, and a
// degenerate triangle is a segment or a point. The relative interior is the triangle without its
// edges, the segment without its ends, or the whole point. Two segments that meet lie in one plane,
// so they touch. A point touches every triangle that contains the point. Every decision is the
// exact sign of a determinant.
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
/// of corners does not matter. Neighbours (verify/exact.h) get no special treatment: if they meet
/// only in their shared part, they touch.
bool penetrate(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

struct ContactCounts {
  std::uint64_t touching = 0;
  std::uint64_t penetrating = 0;

  bool operator==(const ContactCounts&) const = default;
};

/// Counts the touching and the penetrating pairs. Precondition: the triangles of each pair
/// intersect. A repeated pair counts each time. threads: 0 counts as 1; the number changes no
/// answer. Throws std::logic_error if a pair names one triangle twice, or a triangle that the scene
/// does not have.
ContactCounts count_contacts(const Scene& scene, std::span<const TrianglePair> pairs,
                             unsigned threads = std::thread::hardware_concurrency());

// ---- kinds of contact ----
//
// contact_kind() returns how two triangles meet, as one of seven kinds. contact_shape() also
// returns the points in common. Two triangles A and B have exactly one kind: the first in the list
// below that fits (docs/record.md, "Kinds of contact"; docs/suite.md has the same labels). A
// segment has two corners (its ends) and one edge (itself); a point has one corner (itself).
// Neighbours get no special treatment: their shared part is a contact, too.

enum class ContactKind : std::uint8_t {
  apart,         // no point in common; the pair may be within a clearance
  equal,         // A and B are the same set of points
  touch_vertex,  // one point in common, which is a corner of A or of B
  touch_edge,    // one point in common, which is on an edge of A and on an edge of B
  coplanar,      // in one plane, and more than one point in common
  crossing,      // a point in common that is on no edge of A and on no edge of B;
                 // a segment crosses a triangle if it passes through the triangle's interior
  touch_face,    // a segment in common that is on an edge of A or of B
};

inline constexpr std::array kContactKinds = {ContactKind::apart,        ContactKind::equal,
                                             ContactKind::touch_vertex, ContactKind::touch_edge,
                                             ContactKind::coplanar,     ContactKind::crossing,
                                             ContactKind::touch_face};

/// Returns the label of a kind, such as "touch-vertex".
std::string_view name_of(ContactKind kind);
/// The inverse of name_of(); empty if no kind has this name.
std::optional<ContactKind> parse_contact_kind(std::string_view name);

/// How two triangles meet. Their common points form a convex set.
struct ContactShape {
  ContactKind kind = ContactKind::apart;
  int dimension = -1;  // of the common points: 0 a point, 1 a segment, 2 a polygon, -1 none
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
/// lowest corner comes first; the lower of the two adjacent corners comes second. This order is
/// that of the exact corners; rounding may make different corners equal. Symmetric; the order of
/// the triangles' corners does not matter.
std::vector<Vec3> contact_polygon(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns the kind of each pair, in the order given. threads: the number changes no answer; 0
/// counts as 1. Throws std::logic_error if a pair names a triangle that the scene does not have.
std::vector<ContactKind> contact_kinds(const Scene& scene, std::span<const TrianglePair> pairs,
                                       unsigned threads = std::thread::hardware_concurrency());

/// Like contact_kinds(), but returns the common points as well.
std::vector<ContactShape> contact_shapes(const Scene& scene, std::span<const TrianglePair> pairs,
                                         unsigned threads = std::thread::hardware_concurrency());

}  // namespace farcull
