// A scene part by part, for those who cannot hold all of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Takes a part of a scene: some consecutive objects, each whole, as a valid scene of its own with
/// the whole scene's name. May change it.
using TakePart = std::function<void(Scene& part)>;

/// Calls take() with one part after the other. Together they are load_scene(arguments): the same
/// objects, names, triangles and doubles in the same order; only indices of vertices begin anew in
/// each part. A part is a mesh file, an object of a scene file, or some objects of the built-in
/// scene `field`; every other built-in scene, or one with suffixes, is a single part. Memory: the
/// largest part with its file, 256 MiB of meshes that a scene file names several times, and the
/// names of the objects of mesh and scene files. Returns the pairs of objects that the scene
/// ignores, in the numbers of the whole scene; parts ignore none. Throws Error as load_scene(),
/// perhaps after some parts, and what take() throws.
std::vector<ObjectPair> stream_scene(const std::vector<std::string>& arguments,
                                     const TakePart& take);

}  // namespace farcull
