// Patches: how FAR tests an object against itself (docs/reliability.md, "Self-collision by FAR").
// The triangles of the object are cut into patches. In the passes each patch counts as an object of
// its own (an owner, core/cull/cull.h). Pairs of triangles in different patches are culled by
// drawing, pairs inside a patch by boxes alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

struct Patches {
  std::uint32_t size = 0;            // a patch has at most this many triangles
  std::uint32_t count = 0;           // number of patches of all marked objects
  bool cut = false;                  // some marked object has more than one patch
  std::vector<std::uint32_t> owner;  // per triangle of the scene: the number of its patch if
                                     // its object is marked `self`, else of its object. Objects
                                     // share no owner; later objects have larger numbers.
};

/// Returns the triangles of objects that are marked `self`, ascending.
std::vector<std::uint32_t> triangles_of_marked(const Scene& scene);

/// Returns the usual patch size: a sixteenth of the largest number of `marked` triangles in one
/// object, but at least 256 and at most 4096. marked: some of triangles_of_marked(), ascending.
std::uint32_t usual_patch_size(const Scene& scene, std::span<const std::uint32_t> marked);

/// Cuts the `marked` triangles of each object, in the order of spatial_order(), into patches of
/// `size`. The last patch of an object may be smaller. Other triangles of a marked object belong to
/// its first patch. boxes: per triangle of the scene. size: 1 or more.
Patches cut_patches(const Scene& scene, std::span<const Box> boxes,
                    std::span<const std::uint32_t> marked, std::uint32_t size);

/// Returns the pairs a < b that are left to test, sorted, each once. Their boxes overlap. Either
/// the triangles have different owners and are in `live`, or they are in one patch of a marked
/// object. A pair of different owners is left out if a bit proves that it does not meet (theorem
/// 2): L of the earlier owner's triangle, or F of the later owner's triangle. boxes: per triangle
/// of the scene. live, bits: as in CullResult, of culling by patches.owner; empty bits: no bit is
/// set. neighbours: false leaves out pairs of one object that share a vertex index.
std::vector<TrianglePair> join_patches(const Scene& scene, std::span<const Box> boxes,
                                       const Patches& patches, std::span<const std::uint32_t> live,
                                       std::span<const std::uint8_t> bits, bool neighbours = true);

/// Pairs, divided into those that drawing may remove and the others.
struct PairsToDraw {
  std::vector<TrianglePair> drawn;  // of different owners, without a common vertex
  // All others: pairs with one owner, and pairs with a common vertex, which no view can separate.
  std::vector<TrianglePair> other;
};
/// Divides the pairs. owner: per triangle of the scene; see CullSettings::owners.
PairsToDraw split_pairs(const Scene& scene, std::span<const TrianglePair> pairs,
                        std::span<const std::uint32_t> owner);

/// Removes each pair of different owners if a bit proves that it does not meet (theorem 2): L of
/// the earlier owner's triangle, or F of the later owner's triangle. bits: as CullResult::bits.
void remove_cleared(std::span<const std::uint8_t> bits, std::span<const std::uint32_t> owner,
                    std::vector<TrianglePair>& pairs);

}  // namespace farcull
