// The scene "field": blobs in the cells of a cube, one object each. It can be made object by
// object, so that the memory does not grow with it.
#pragma once

#include <cstdint>
#include <functional>

#include "core/scene/scene.h"
#include "experiments/scenes/builtin/built_scene.h"

namespace farcull {

/// The scene of about parameters.size triangles.
BuiltScene make_field(const SceneParameters& parameters, std::uint64_t seed);

/// Calls take() with one part of that scene after the other: some consecutive objects, whole, as a
/// scene called `name` that take() may change. Together they are the scene, bit by bit.
void stream_field(const SceneParameters& parameters, std::uint64_t seed, const std::string& name,
                  const std::function<void(Scene& part)>& take);

}  // namespace farcull
