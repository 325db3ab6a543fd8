// Patches are runs of triangles along a Morton curve; each is joined with itself by boxes.
#include "core/cull/patches.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "core/boxes/join.h"
#include "core/cull/clusters.h"
#include "core/cull/pass.h"

namespace farcull {
namespace {

// Measured (docs/results/clusters.md, "Patches"). Smaller patches have more triangles at borders,
// which drawing keeps; larger ones leave more pairs to boxes. Where boxes are bad, a sixteenth of
// the object leaves the fewest candidates. The bounds keep the passes short: below, nearly all
// triangles are at borders; above, a patch may have all its pairs to test.
constexpr std::uint32_t kPatches = 16;
constexpr std::uint32_t kLeastPatch = 256, kMostPatch = 4096;

bool share_a_vertex(const Scene& scene, const TrianglePair& pair) {
  const auto& a = scene.triangles[pair.a];
  const auto& b = scene.triangles[pair.b];
  return std::any_of(a.begin(), a.end(),
                     [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

std::vector<std::uint32_t> triangles_of_marked(const Scene& scene) {
  std::vector<std::uint32_t> out;
  for (const Object& object : scene.objects) {
    if (!object.self) continue;
    for (std::uint32_t i = 0; i < object.triangle_count; ++i)
      out.push_back(object.first_triangle + i);
  }
  return out;
}

}  // namespace

std::uint32_t usual_patch_size(const Scene& scene) {
  std::uint32_t largest = 0;
  for (const Object& object : scene.objects) {
    if (object.self) largest = std::max(largest, object.triangle_count);
  }
  return std::clamp(largest / kPatches, kLeastPatch, kMostPatch);
}

Patches cut_patches(const Scene& scene, std::span<const Box> boxes, std::uint32_t size) {
  if (size == 0) throw std::logic_error("cut_patches: patches of no triangle");
  Patches out{.size = size, .owner = std::vector<std::uint32_t>(scene.triangles.size())};
  const std::vector<std::uint32_t> order =
      spatial_order(triangles_of_marked(scene), owners(scene), boxes);
  std::uint32_t next = 0;  // owner
  std::size_t at = 0;      // in `order`, where objects ascend
  for (const Object& object : scene.objects) {
    const std::uint32_t first = object.first_triangle, count = object.triangle_count;
    if (!object.self) {
      std::fill_n(out.owner.begin() + first, count, next++);
      continue;
    }
    for (std::uint32_t i = 0; i < count; ++i) out.owner[order[at++]] = next + i / size;
    const std::uint32_t patches = (count + size - 1) / size;
    out.count += patches;
    out.cut |= patches > 1;
    next += patches;
  }
  return out;
}

std::vector<TrianglePair> join_patches(const Scene& scene, std::span<const Box> boxes,
                                       const Patches& patches, std::span<const std::uint32_t> live,
                                       std::span<const std::uint8_t> bits, bool neighbours) {
  const auto owner = [&](std::uint32_t t) { return patches.owner[t]; };
  std::vector<TrianglePair> pairs = box_join(boxes, patches.owner, live);
  if (!bits.empty()) {
    std::erase_if(pairs, [&](const TrianglePair& pair) {
      const bool ordered = owner(pair.a) < owner(pair.b);
      const std::uint32_t earlier = ordered ? pair.a : pair.b, later = ordered ? pair.b : pair.a;
      return (bits[earlier] & kL) || (bits[later] & kF);
    });
  }
  // The triangles of marked objects, patch after patch.
  std::vector<std::uint32_t> members = triangles_of_marked(scene);
  std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(owner(a), a) < std::pair(owner(b), b);
  });
  std::vector<std::uint32_t> alone(scene.triangles.size());  // each triangle its own owner
  std::iota(alone.begin(), alone.end(), 0u);
  for (std::size_t from = 0, to = 0; from < members.size(); from = to) {
    while (to < members.size() && owner(members[to]) == owner(members[from])) ++to;
    const std::vector<TrianglePair> inside =
        box_join(boxes, alone, std::span(members).subspan(from, to - from));
    pairs.insert(pairs.end(), inside.begin(), inside.end());
  }
  if (!neighbours) {
    const std::vector<std::uint32_t> object = owners(scene);
    std::erase_if(pairs, [&](const TrianglePair& pair) {
      return object[pair.a] == object[pair.b] && share_a_vertex(scene, pair);
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace farcull
