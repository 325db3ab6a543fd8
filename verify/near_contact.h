// Finds the contact of two triangles within a distance: the exact or nearly exact distance, two
// nearest points, and the direction between them. Triangles are as in verify/exact.h.
#pragma once

#include <array>
#include <optional>

#include "verify/closest.h"
#include "verify/rounding.h"

namespace farcull {

/// A contact of triangles a and b, given by two nearest points: p of a and q of b.
struct NearContact {
  double distance = 0;         // world units; 0 if the triangles meet
  std::array<Vec3, 2> points;  // p and q; equal if the triangles meet
  std::array<Vec3, 2> weights =
      {};                           // p and q are the means of the corners with these weights, >= 0
  Vec3 normal = Vec3::Zero();       // (q - p) / |q - p|; zeros if the triangles meet
  std::array<Feature, 2> features;  // p and q lie on these features: the corners with weights > 0
};

/// Returns the contact with the points `closest`, given by closest_points(a, b). Distance, points
/// and weights are each rounded once. Each coordinate of the normal is off by at most 8 u of
/// itself, u = 2^-53.
NearContact exact_contact(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                          const Closest& closest);

/// contact_within() accepts a distance in doubles if its two bounds differ by at most this fraction
/// of the lower bound. Tests set a larger value, to show that answers are then wrong.
constexpr double kContactTolerance = 0x1p-33;

/// Returns the contact of triangles whose distance is at most `within` (finite, >= 0). Empty if
/// they are farther apart, which is decided exactly. planes: filter_planes(a, b, within). Doubles
/// give the contact if their error bounds suffice, otherwise exact_contact(). Errors, where R is
/// the largest difference of two coordinates on one axis:
/// - distance: at most 2^-32 of itself (subnormal: half of the last bit). It is 0 only if the
///   triangles meet or the exact distance is rounded to 0.
/// - points: each is in its triangle up to 2^-45 R and the rounding of its coordinates. Their
/// difference has the length `distance`, up to the same errors. Other points may be as near.
/// - weights: their sum is 1 up to 4 u. The weighted mean of the corners is the point, up to its
///   errors.
/// - normal: its difference from the exact normal, which is unique, is at most 2^-15 long.
std::optional<NearContact> contact_within(const std::array<Vec3, 3>& a,
                                          const std::array<Vec3, 3>& b, double within,
                                          Triage planes, double tolerance = kContactTolerance);

}  // namespace farcull
