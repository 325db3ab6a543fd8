// The generators of built-in scenes: each file gives the entries of its scenes. Generated scenes
// are drawn with core/base/random.h and fixed seeds, so that every platform makes the same doubles.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/mesh.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

/// Between neighbours in the stack of the scene "shells", all over their surface.
inline constexpr double kShellGap = 0x1p-34;

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

/// The scenes of the same names in contact_scenes(). size: triangles.
BuiltScene make_crumpled(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_rope(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_spheres(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_fans(const SceneParameters& parameters, std::uint64_t seed);
BuiltScene make_funnel(const SceneParameters& parameters, std::uint64_t seed);

/// A scene of two objects, the second one placed.
Scene two_objects(const std::string& name, const char* first, const Mesh& one, const char* second,
                  const Mesh& other, const Placement& placement = {});
/// The scene as its motion has it halfway.
BuiltScene halfway(BuiltScene built);

/// An entry whose scene does not move, or moves by `moved` of the scene without frames.
BuiltinScene made(BuiltinScene entry, Scene (*make)(), Motion (*moved)(const Scene&) = nullptr);
/// An entry that takes numbers, and of which nothing is random.
BuiltinScene taking(BuiltinScene entry, BuiltScene (*build)(const SceneParameters&));
/// An entry that is drawn with a seed: this one, or that of its parameters.
BuiltinScene drawn(BuiltinScene entry, std::uint64_t seed,
                   BuiltScene (*make)(const SceneParameters&, std::uint64_t));
BuiltinScene drawn(BuiltinScene entry, std::uint64_t seed, Scene (*make)(std::uint64_t));

/// `rest` is the scene without frames, whose objects share no vertex. The second object comes from
/// beside the first, goes through it and leaves on the other side.
Motion pass_through(const Scene& rest);
/// All objects breathe, out of step, while waves run along them.
Motion pulse(const Scene& rest);
/// Each object goes its own way, by up to its diagonal, and comes back.
Motion drift(const Scene& rest);

}  // namespace farcull
