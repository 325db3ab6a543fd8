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

/// An answer: `pair` is said to be the first of the nearest of the objects a <= b, or one of all
/// pairs within a distance; a == b: of one object, neighbours (verify/exact.h) left out.
struct ClaimedDistance {
  std::uint32_t a = 0, b = 0;  // objects
  TrianglePair pair;           // a triangle of a and one of b
  double distance = 0;         // the root, rounded to the nearest double
  std::string squared;         // its square, "numerator/denominator" in lowest terms
  std::array<Vec3, 2> points;  // two nearest points, of a and of b, each coordinate rounded once
  std::array<std::uint8_t, 2> features{};     // on which they lie, numbered as in
                                              // verify/certificate/integer_distance.h
  InsideClaim inside = InsideClaim::unknown;  // unknown where the objects meet or are one
};

/// A question about the distances of a scene.
struct DistanceQuestion {
  /// objects: the nearest pair of every two objects, and of each object that is `self`. nearest:
  /// that of each object and its k nearest others; where several are as far, of the first ones.
  /// all: every pair of triangles, of different objects or of one that is `self`.
  enum class Kind : std::uint8_t { objects, nearest, all };
  Kind kind = Kind::objects;
  std::size_t k = 1;
  /// Nothing that is farther apart is asked for. World units, >= 0; finite with `all`.
  double within = std::numeric_limits<double>::infinity();
  bool inside = false;   // of objects that do not meet, whether one is inside; not with `all`
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
};

}  // namespace farcull
