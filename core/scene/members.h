// Triangles and objects of lists: of pairs, of triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Triangles in at least one of the pairs; ascending, each once. triangles: number of triangles of
/// the scene.
std::vector<std::uint32_t> members_of(std::span<const TrianglePair> pairs, std::size_t triangles);

/// Objects that have one of these triangles (ascending).
std::uint64_t count_objects(const Scene& scene, std::span<const std::uint32_t> triangles);

/// Whether an object of the scene is tested against itself.
bool has_self(const Scene& scene);

}  // namespace farcull
