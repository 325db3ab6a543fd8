// Looks for what a user should know besides the answer: meshes that a tolerance would close, and
// objects that may lie inside others.
#include "experiments/command/command.h"

#include <fmt/format.h>

#include <numeric>
#include <set>

#include "core/boxes/join.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/system/text_table.h"
#include "verify/inside.h"

namespace farcull {

std::vector<std::uint32_t> meeting_themselves(const Scene& scene, const Record& record) {
  std::set<std::uint32_t> found;
  for (const auto* pairs : {&record.collisions.pairs, &record.collisions.neighbour_pairs}) {
    for (const TrianglePair& pair : *pairs) {
      const std::uint32_t a = place_of(scene, pair.a).object;
      if (a == place_of(scene, pair.b).object) found.insert(a);
    }
  }
  return {found.begin(), found.end()};
}

std::string weld_lines(const Scene& scene, const std::vector<std::uint32_t>& objects) {
  constexpr std::uint64_t kMostTriangles = 4'000'000;
  constexpr std::size_t kMostLines = 3;
  std::uint64_t triangles = 0;
  for (const std::uint32_t o : objects) triangles += scene.objects[o].triangle_count;
  if (triangles > kMostTriangles) return "";
  std::string out;
  std::size_t lines = 0;
  for (const std::uint32_t o : objects) {
    const std::optional<WeldHint> hint = weld_hint(scene, scene.objects[o]);
    if (!hint) continue;
    out += fmt::format(
        "hint       {} is not closed: {}, one of them at {:.6g} {:.6g} {:.6g}. Their ends nearly\n"
        "           coincide; --weld {:.0e}*size closes it\n",
        scene.objects[o].name, counted(hint->open_edges, "open edge", "open edges"),
        hint->place.x(), hint->place.y(), hint->place.z(), hint->tolerance);
    if (++lines == kMostLines) break;
  }
  return out;
}

std::string nested_line(const Scene& scene, const Record& record) {
  // Pairs of objects whose boxes overlap. Below, one box has to lie in the other one.
  const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
  std::vector<std::uint32_t> all(boxes.size());
  std::iota(all.begin(), all.end(), 0u);
  constexpr std::size_t kMost = 1'000'000;
  const std::vector<TrianglePair> overlapping = box_join(boxes, all, all, kMost);
  if (overlapping.size() > kMost) return "";
  std::set<ObjectPair> meet;
  for (const TrianglePair& pair : record.collisions.pairs)
    meet.insert({place_of(scene, pair.a).object, place_of(scene, pair.b).object});
  meet.insert(record.options.ignored.begin(), record.options.ignored.end());
  std::map<std::uint32_t, bool> closed;
  std::uint64_t count = 0;
  std::string first;
  for (const auto& [a, b] : overlapping) {
    for (const auto& [in, out] : {ObjectPair{a, b}, ObjectPair{b, a}}) {
      if (!lies_within(boxes[in], boxes[out]) || meet.contains({a, b})) continue;
      if (!closed.contains(out)) closed[out] = is_closed(scene, out);
      if (!closed[out]) continue;
      if (count++ == 0) first = scene.objects[in].name + " in " + scene.objects[out].name;
      break;
    }
  }
  if (count == 0) return "";
  return fmt::format(
      "nested     {} may lie wholly inside a closed one, as {}. Surfaces that do\n"
      "           not meet are no collision; farcull distance says what lies inside\n",
      counted(count, "object", "objects"), first);
}

}  // namespace farcull
