// The built-in scenes one by one; builtin_scenes.cpp lists them. Generated ones use std::mt19937_64
// with fixed seeds and mappings of our own, since those of <random> differ between standard
// libraries.
#pragma once

#include <cstdint>

#include "core/scene.h"
#include "experiments/builtin_scenes.h"
#include "experiments/mesh.h"

namespace farcull {

Scene make_two_spheres();
Scene make_two_tori();
Scene make_random_soup(std::uint64_t seed);
Scene make_degenerate();
Scene make_ground(std::uint64_t seed);
Scene make_far_apart();

/// size: slivers in each of the two oblique objects, bit for bit the same ones in a larger scene;
/// three in eight as many in each of the two along the axes.
BuiltScene make_needles(const SceneParameters& parameters, std::uint64_t seed);
/// size: objects; second: objects per unit of volume.
BuiltScene make_crowd(const SceneParameters& parameters, std::uint64_t seed);
inline constexpr double kUsualCrowdDensity = 400.0 / (12 * 12 * 12);

/// The scenes of the papers (CULLIDE, Graphics Hardware 2003; FAR, VRST 2004), which move. Without
/// frames they are what they are halfway. size: cylinders; triangles of a torus, as near as a grid
/// comes; leaves.
BuiltScene make_cylinders(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_torii(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_tree_leaves(const SceneParameters& parameters, std::uint64_t seed);
/// size: sheets.
BuiltScene make_shells(const SceneParameters& parameters, std::uint64_t seed);
/// Between neighbours in the stack of make_shells(), all over their surface.
inline constexpr double kShellGap = 0x1p-34;
/// size: triangles of the cloth, as near as a square grid comes; second: stiffness, N/m.
BuiltScene make_cloth(const SceneParameters& parameters);
/// size: triangles of the dragon. These throw Error where a packaged mesh cannot be read.
BuiltScene make_bunny_dragon(const SceneParameters& parameters);
BuiltScene make_breaking_dragon(const SceneParameters& parameters, std::uint64_t seed);
inline constexpr std::uint64_t kPackagedDragon = 19'994;  // triangles

/// What goes to an extreme by its second number, for the study "stability".
/// size: slivers of each object; second: aspect, the longest side over the height above it.
BuiltScene make_slivers(const SceneParameters& parameters, std::uint64_t seed);
/// size: sheets; second: from one to the next, in their widths, see stack_gap(). Every fourth leans
/// and crosses both neighbours.
BuiltScene make_stack(const SceneParameters& parameters);
/// The nearest power of two (in its exponent), so that no height of the stack is rounded.
double stack_gap(double wanted);
/// size: large triangles, with eight small ones at each; second: ratio of their sides.
BuiltScene make_mixed(const SceneParameters& parameters, std::uint64_t seed);
/// size: pairs; second: ulps of their coordinates, the nearest whole number, by which a vertex
/// stands above a face, or an edge above an edge: they collide where it is 0 or less.
BuiltScene make_gap(const SceneParameters& parameters);

/// For benchmarks; the counts are those of docs/bench.md.
Scene make_needles_layers(std::uint64_t seed);
Scene make_needles_crossed(std::uint64_t seed);
/// round(triangles / kFieldBlob) blobs, at least one.
Scene make_field(std::uint64_t triangles, std::uint64_t seed);
inline constexpr std::uint64_t kFieldBlob = 320;  // triangles of one blob

/// A file of mesh_folder(). Throws Error where it cannot be read.
Mesh packaged(const char* file);
inline constexpr const char* kBunny = "bunny00.off";
inline constexpr const char* kDragon = "ChineseDragon-10kv.off";

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
