// The built-in scenes one by one; builtin_scenes.cpp lists them. Generated ones use std::mt19937_64
// with fixed seeds and mappings of our own, since those of <random> differ between standard
// libraries.
#pragma once

#include <cstdint>

#include "core/scene.h"

namespace farcull {

Scene make_two_spheres();
Scene make_two_tori();
Scene make_random_soup(std::uint64_t seed);
Scene make_needles(std::uint64_t seed);
Scene make_degenerate();
Scene make_ground(std::uint64_t seed);
Scene make_crowd(std::uint64_t seed);
Scene make_far_apart();

/// For benchmarks; the counts are those of docs/bench.md.
Scene make_needles_layers(std::uint64_t seed);
Scene make_needles_crossed(std::uint64_t seed);
/// round(triangles / kFieldBlob) blobs, at least one.
Scene make_field(std::uint64_t triangles, std::uint64_t seed);
inline constexpr std::uint64_t kFieldBlob = 320;  // triangles of one blob

/// These throw Error where a packaged mesh cannot be read.
Scene make_two_bunnies();
Scene make_armadillo_elephant();
Scene make_dragon_bunny();
Scene make_near_copy();
Scene make_bunnies_far_apart();
/// One object that collides with itself.
Scene make_mannequin_devil();
Scene make_armadillo();
Scene make_bunny();

/// A square of two triangles parallel to the x-y plane.
struct Square {
  Vec3 centre;
  double side = 1;
};
/// Its four corners, counterclockwise seen from above; triangles are (0, 1, 2) and (0, 2, 3).
std::array<Vec3, 4> corners(const Square& square);

}  // namespace farcull
