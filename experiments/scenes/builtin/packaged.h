// The packaged meshes, which experiments/meshes.sh unpacks.
#pragma once

#include <string>

#include "experiments/scenes/mesh/mesh.h"

namespace farcull {

inline constexpr const char* kBunny = "bunny00.off";
inline constexpr const char* kDragon = "ChineseDragon-10kv.off";

/// The folder of the packaged meshes: the environment variable FARCULL_MESHES if it is set and not
/// empty, else the folder given when farcull was built.
std::string mesh_folder();

/// A file of mesh_folder(). Throws Error where it cannot be read.
Mesh packaged(const char* file);

}  // namespace farcull
