// FAR cuts an object into patches to test it against itself (docs/reliability.md, "Self-collision
// by FAR"). A patch is a set of triangles. When drawing, each patch is treated like an object (an
// owner, core/cull/cull.h). Drawing culls pairs of triangles in different patches. Only boxes cull
// pairs of triangles inside a patch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

struct Patches {
  std::uint32_t size = 0;            // a patch has at most this many triangles
  std::uint32_t count = 0;           // number of patches of all marked objects
  bool cut = false;                  // true: some marked object has more than one patch
  std::vector<std::uint32_t> owner;  // per triangle of the scene: the number of its owner. Owners
                                     // are the patches of objects marked `self`, and the other
                                     // objects. Later objects have larger numbers.
};

/// Returns the triangles of objects that are marked `self`, ascending.
std::vector<std::uint32_t> triangles_of_marked(const Scene& scene);

/// Returns the default patch size: a sixteenth of the largest number of `marked` triangles in one
/// object, but at least 256 and at most 4096. marked: some of triangles_of_marked(), ascending.
std::uint32_t usual_patch_size(const Scene& scene, std::span<const std::uint32_t> marked);

/// Cuts the `marked` triangles of each object, in the order of spatial_order(), into patches of
/// `size` triangles. The last patch of an object may be smaller. The other triangles of an object
/// marked `self` belong to its first patch. boxes: per triangle of the scene. size: 1 or more.
Patches cut_patches(const Scene& scene, std::span<const Box> boxes,
                    std::span<const std::uint32_t> marked, std::uint32_t size);

/// Returns the pairs a < b of triangles that are left to test, sorted, each once. Their boxes
/// overlap, and either both triangles are in one patch of a marked object, or both are in `live`
/// and have different owners. Leaves out pairs that remove_cleared() removes. boxes: per triangle
/// of the scene. live, bits: members of the CullResult of culling by patches.owner; empty bits: no
/// bit is set. neighbours: false leaves out pairs of triangles of one object that share a vertex
/// index.
std::vector<TrianglePair> join_patches(const Scene& scene, std::span<const Box> boxes,
                                       const Patches& patches, std::span<const std::uint32_t> live,
                                       std::span<const std::uint8_t> bits, bool neighbours = true);

/// Pairs of triangles, divided into pairs that drawing may remove and other pairs.
struct PairsToDraw {
  std::vector<TrianglePair> drawn;  // pairs of different owners without a common vertex
  // All other pairs: drawing cannot separate triangles of one owner, or with a common vertex.
  std::vector<TrianglePair> other;
};
/// Divides the pairs into the two lists. owner: see CullSettings::owners.
PairsToDraw split_pairs(const Scene& scene, std::span<const TrianglePair> pairs,
                        std::span<const std::uint32_t> owner);

/// Removes each pair of different owners if a bit proves that its triangles do not meet (theorem
/// 2): L of the earlier owner's triangle, or F of the later owner's. bits: CullResult::bits.
void remove_cleared(std::span<const std::uint8_t> bits, std::span<const std::uint32_t> owner,
                    std::vector<TrianglePair>& pairs);

}  // namespace farcull
