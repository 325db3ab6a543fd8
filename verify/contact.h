// Decides whether two triangles that intersect penetrate or merely touch.
//
// The lectures on CULLIDE and S-CULLIDE distinguish *penetrating* contacts, where the surfaces pass
// through each other, from *touching* ones, which S-CULLIDE ignores. The exact definition here: two
// triangles penetrate iff their relative interiors meet and they do not lie in one plane. All other
// triangles that intersect touch. In other words, A and B penetrate iff 0 is an interior point of
// A - B: iff no translation shorter than some length separates them. They touch iff arbitrarily
// short translations separate them (away from a plane between them, or off their common plane).
//
// Semantics and preconditions as in verify/exact.h: the doubles as given, any finite ones; a
// degenerate triangle is the segment or the point that it is. The relative interior of a triangle
// is the triangle without its edges; of a segment, the segment without its ends; of a point, the
// point. Two segments that meet lie in one plane, so they touch; so do a point and whatever it
// meets. Every decision is the sign of a determinant, evaluated exactly.
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

/// Whether two triangles penetrate. False for triangles that share no point. Symmetric; the order
/// of corners does not matter. Neighbours are treated as any other triangles: if they meet only in
/// what they share, they touch.
bool penetrate(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

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

// ---- kinds of contact ----
//
// How two triangles meet, as one of seven kinds, and the points that they have in common. Every two
// triangles A and B have exactly one kind, the first that fits (docs/record.md, "Kinds of contact";
// the labels of docs/suite.md are the same). A segment has two corners (its ends) and one edge
// (itself); a point has one corner (itself). Neighbours are treated as any other triangles: the
// part that they share is a contact too.

enum class ContactKind : std::uint8_t {
  apart,         // no point in common: a pair that collides only by a clearance
  equal,         // the same set of points
  touch_vertex,  // one point in common, which is a corner of A or of B
  touch_edge,    // one point in common, which is on an edge of A and on an edge of B
  coplanar,      // in one plane, and more than one point in common
  crossing,      // a point in common that is on no edge of A and on no edge of B; a segment crosses
                 // a triangle where it goes through the triangle's inside
  touch_face,    // a segment in common that is on an edge of A or of B
};

inline constexpr std::array kContactKinds = {ContactKind::apart,        ContactKind::equal,
                                             ContactKind::touch_vertex, ContactKind::touch_edge,
                                             ContactKind::coplanar,     ContactKind::crossing,
                                             ContactKind::touch_face};

/// "touch-vertex" and so on, as in the labels of a suite.
std::string_view name_of(ContactKind kind);
/// The inverse of name_of(); empty if no kind has this name.
std::optional<ContactKind> parse_contact_kind(std::string_view name);

/// The kind, and the points in common. These are a convex set.
struct ContactShape {
  ContactKind kind = ContactKind::apart;
  int dimension = -1;  // of the common points: 0 a point, 1 a segment, 2 a polygon; -1 none
  /// World units. Dimension 1: the ends of the segment, the lexicographically lower one first, each
  /// coordinate rounded once to the nearest double; 0: the point, twice; else zeros.
  std::array<Vec3, 2> ends = {Vec3::Zero(), Vec3::Zero()};
  bool operator==(const ContactShape&) const = default;
};

/// The exact kind. Symmetric; the order of corners does not matter.
ContactKind contact_kind(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// The exact kind and common points; only `ends` are rounded. Symmetric; the order of corners does
/// not matter.
ContactShape contact_shape(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// The corners of the common polygon in order around it, each coordinate rounded once to the
/// nearest double; empty unless the points in common have dimension 2. The lexicographically lowest
/// corner comes first, and its lower neighbour second. The exact corners are compared; several of
/// them may be rounded to the same doubles. Symmetric; the order of corners does not matter.
std::vector<Vec3> contact_polygon(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// The kind of each pair, in the order given. 0 threads count as 1; their number changes no answer.
/// Throws std::logic_error if a pair names a triangle that the scene does not have.
std::vector<ContactKind> contact_kinds(const Scene& scene, std::span<const TrianglePair> pairs,
                                       unsigned threads = std::thread::hardware_concurrency());

/// The kind and the common points of each pair, as contact_kinds().
std::vector<ContactShape> contact_shapes(const Scene& scene, std::span<const TrianglePair> pairs,
                                         unsigned threads = std::thread::hardware_concurrency());

}  // namespace farcull
