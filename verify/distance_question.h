// A question about distances and its answers, in the form that the accounting takes
// (verify/distance_accounting.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "core/scene/scene.h"
#include "verify/certificate/integer_distance.h"

namespace farcull {

/// An answer: it claims that `pair` is the first of the nearest pairs of triangles of the objects
/// a <= b, or (with `all`) one of the pairs within the distance. With a == b both triangles are of
/// one object, and neighbours (verify/exact.h) are left out.
struct ClaimedDistance {
  std::uint32_t a = 0, b = 0;  // objects
  TrianglePair pair;           // a triangle of a and one of b
  double distance = 0;         // the root, rounded to the nearest double
  std::string squared;         // its square, "numerator/denominator" in lowest terms
  std::array<Vec3, 2> points;  // two nearest points, of a and of b, each coordinate rounded once
  std::array<std::uint8_t, 2> features{};     // the points lie on these, numbered as in
                                              // verify/certificate/integer_distance.h
  InsideClaim inside = InsideClaim::unknown;  // unknown if the objects meet, or if a == b
};

/// A question about the distances of a scene.
struct DistanceQuestion {
  /// objects: the nearest pair of every two objects, and of each object marked `self`.
  /// nearest: the nearest pair of each object with each of its k nearest other objects; of objects
  ///   equally far away, those with the lower index are nearer.
  /// all: every pair of triangles within the distance, of different objects or of a `self` object.
  enum class Kind : std::uint8_t { objects, nearest, all };
  Kind kind = Kind::objects;
  std::size_t k = 1;
  /// Nothing that is farther apart is asked for. World units, >= 0; finite with `all`.
  double within = std::numeric_limits<double>::infinity();
  bool inside = false;   // ask whether one of two disjoint objects is inside the other; not `all`
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
};

}  // namespace farcull
