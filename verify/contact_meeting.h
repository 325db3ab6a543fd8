// Describes how two triangles meet. Only sources of verify/contact.h use this file.
#pragma once

#include <array>
#include <optional>

#include "verify/contact.h"

namespace farcull {

/// A common point of two triangles, given by corner numbers: 0 to 2 are the corners of a, 3 to 5
/// those of b. If from == to, the point is this corner. Otherwise the edge between these corners
/// meets a plane in the point. If axis < 0, the plane goes through the three corners `other`. If
/// axis >= 0, the plane goes through the first two of these corners, parallel to the axis.
struct Place {
  int from = 0, to = 0;
  std::array<int, 3> other = {};
  int axis = -1;       // >= 0 only if the triangles lie in one plane
  unsigned lines = 0;  // if the triangles lie in one plane: bit k is set if the place is on the
                       // line of edge k (from corner k to the next corner of its triangle)
};

struct Meeting {
  ContactKind kind = ContactKind::apart;
  int dimension = -1;                // as ContactShape::dimension
  int count = 0;                     // number of places
  std::array<Place, 6> places = {};  // the corners of the common part, each once, unsorted
};

/// Returns how a and b meet. Returns nothing iff a or b is a segment or a point. Only signs of
/// determinants decide. places: if false, the places of a common segment are left out.
std::optional<Meeting> meeting_of(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                                  bool places);

/// Computes contact_shape() of a and b. Precondition: a or b is a segment or a point.
ContactShape contact_shape_of_segments(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace farcull
