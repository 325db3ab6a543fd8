// Cuts objects into patches along a Morton curve, and finds pairs inside each patch by boxes.
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
// which drawing cannot cull. Larger patches leave more pairs to box tests. If boxes separate
// triangles poorly, patches of a sixteenth of the object leave the fewest candidate pairs. Below
// kLeastPatch, nearly all triangles are at borders. Above kMostPatch, a patch has too many pairs.
constexpr std::uint32_t kPatches = 16;
constexpr std::uint32_t kLeastPatch = 256, kMostPatch = 4096;

bool share_a_vertex(const Scene& scene, const TrianglePair& pair) {
  return share_index(scene.triangles[pair.a], scene.triangles[pair.b]);
}

}  // namespace

std::vector<std::uint32_t> triangles_of_marked(const Scene& scene) {
  std::vector<std::uint32_t> out;
  for (const Object& object : scene.objects) {
    if (!object.self) continue;
    for (std::uint32_t i = 0; i < object.triangle_count; ++i)
      out.push_back(object.first_triangle + i);
  }
  return out;
}

namespace {

// Returns for each object the number of its triangles in the list. Precondition: `list` ascends.
std::vector<std::uint32_t> counts_in(const Scene& scene, std::span<const std::uint32_t> list) {
  std::vector<std::uint32_t> counts;
  auto at = list.begin();
  for (const Object& object : scene.objects) {
    const auto end =
        std::lower_bound(at, list.end(), object.first_triangle + object.triangle_count);
    counts.push_back(static_cast<std::uint32_t>(end - at));
    at = end;
  }
  return counts;
}

}  // namespace

std::uint32_t usual_patch_size(const Scene& scene, std::span<const std::uint32_t> marked) {
  const std::vector<std::uint32_t> counts = counts_in(scene, marked);
  const std::uint32_t largest = counts.empty() ? 0 : std::ranges::max(counts);
  return std::clamp(largest / kPatches, kLeastPatch, kMostPatch);
}

Patches cut_patches(const Scene& scene, std::span<const Box> boxes,
                    std::span<const std::uint32_t> marked, std::uint32_t size) {
  if (size == 0) throw std::logic_error("cut_patches: patches of no triangle");
  Patches out{.size = size, .owner = std::vector<std::uint32_t>(scene.triangles.size())};
  const std::vector<std::uint32_t> order = spatial_order(marked, owners(scene), boxes);
  const std::vector<std::uint32_t> counts = counts_in(scene, marked);
  std::uint32_t next = 0;  // the next unused owner number
  std::size_t at = 0;      // index of the next triangle in `order`
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    std::fill_n(out.owner.begin() + object.first_triangle, object.triangle_count, next);
    if (!object.self) {
      ++next;
      continue;
    }
    for (std::uint32_t i = 0; i < counts[o]; ++i) out.owner[order[at++]] = next + i / size;
    const std::uint32_t patches = std::max<std::uint32_t>(1, (counts[o] + size - 1) / size);
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
  if (!bits.empty()) remove_cleared(bits, patches.owner, pairs);
  // The triangles of marked objects, sorted by patch.
  std::vector<std::uint32_t> members = triangles_of_marked(scene);
  std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(owner(a), a) < std::pair(owner(b), b);
  });
  std::vector<std::uint32_t> alone(scene.triangles.size());  // each triangle is its own owner
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

PairsToDraw split_pairs(const Scene& scene, std::span<const TrianglePair> pairs,
                        std::span<const std::uint32_t> owner) {
  PairsToDraw out;
  for (const TrianglePair& pair : pairs) {
    const bool drawn = owner[pair.a] != owner[pair.b] && !share_a_vertex(scene, pair);
    (drawn ? out.drawn : out.other).push_back(pair);
  }
  return out;
}

void remove_cleared(std::span<const std::uint8_t> bits, std::span<const std::uint32_t> owner,
                    std::vector<TrianglePair>& pairs) {
  std::erase_if(pairs, [&](const TrianglePair& pair) {
    if (owner[pair.a] == owner[pair.b]) return false;
    const auto [earlier, later] =
        owner[pair.a] < owner[pair.b] ? pair : TrianglePair{pair.b, pair.a};
    return (bits[earlier] & kL) || (bits[later] & kF);
  });
}

}  // namespace farcull
