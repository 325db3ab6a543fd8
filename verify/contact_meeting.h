// How two triangles meet, by corners and edges. Only the sources of verify/contact.h use this file.
#pragma once

#include <array>
#include <optional>

#include "verify/contact.h"

namespace farcull {

/// A point that two triangles share, by numbers of corners: 0 to 2 are the corners of a, 3 to 5
/// those of b. If from == to, the point is this corner. Otherwise the point is where the edge
/// between these corners meets a plane. If the triangles lie in one plane, the plane is parallel to
/// `axis` and goes through the first two corners of `other`. If not, it goes through all three.
struct Place {
  int from = 0, to = 0;
  std::array<int, 3> other = {};
  int axis = -1;       // -1: none
  unsigned lines = 0;  // if the triangles lie in one plane: bit k is set if the place is on the
                       // line of edge k (from corner k to the next corner of its triangle)
};

struct Meeting {
  ContactKind kind = ContactKind::apart;
  int dimension = -1;                // as ContactShape::dimension
  int count = 0;                     // number of places
  std::array<Place, 6> places = {};  // the corners of the common part, each once, unsorted
};

/// Returns the meeting, decided by signs of determinants alone. Returns nothing iff a triangle is a
/// segment or a point. places: if false, the places of a common segment are left out.
std::optional<Meeting> meeting_of(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                                  bool places);

/// contact_shape() of two triangles. Precondition: at least one is a segment or a point.
ContactShape contact_shape_of_segments(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace farcull
