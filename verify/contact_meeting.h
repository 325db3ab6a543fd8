// How two triangles meet, and where, without numbers. For the sources of verify/contact.h alone.
#pragma once

#include <array>
#include <optional>

#include "verify/contact.h"

namespace farcull {

/// A point that two triangles share, by numbers of corners: 0 to 2 are those of a, 3 to 5 those of
/// b. If from == to, the point is this corner. Else it is where the edge between these corners
/// meets a plane: the plane of the corners `other`; or, if the triangles lie in one plane, the
/// plane along `axis` through the first two corners of `other`.
struct Place {
  int from = 0, to = 0;
  std::array<int, 3> other = {};
  int axis = -1;       // -1: none
  unsigned lines = 0;  // triangles in one plane: bit k is set if the place is on the line of edge k
                       // (from corner k to the next one of its triangle)
};

struct Meeting {
  ContactKind kind = ContactKind::apart;
  int dimension = -1;                // as ContactShape::dimension
  int count = 0;                     // of places
  std::array<Place, 6> places = {};  // the corners of what the triangles share, each once, unsorted
};

/// The meeting, decided by signs of determinants alone; empty iff a triangle is a segment or a
/// point. places: if false, the places of a common segment are left out.
std::optional<Meeting> meeting_of(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                                  bool places);

/// contact_shape() of two triangles of which at least one is a segment or a point.
ContactShape contact_shape_of_segments(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace farcull
