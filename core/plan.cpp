#include "core/plan.h"

#include <numeric>

#include "core/box_join.h"
#include "core/parallel.h"

namespace farcull {

Plan make_plan(const Scene& scene, bool self) {
  Plan plan;
  plan.triangle_boxes = triangle_boxes(scene);
  plan.object_boxes = object_boxes(scene, plan.triangle_boxes);

  std::vector<std::uint32_t> objects(scene.objects.size());
  std::iota(objects.begin(), objects.end(), 0u);
  // As owners of themselves, objects join like triangles.
  std::vector<std::vector<std::uint32_t>> partners(objects.size());
  for (const TrianglePair& pair : box_join(plan.object_boxes, objects, objects)) {
    partners[pair.a].push_back(pair.b);
    partners[pair.b].push_back(pair.a);
    plan.regions.push_back(intersection(plan.object_boxes[pair.a], plan.object_boxes[pair.b]));
  }
  for (const std::uint32_t o : objects) {
    const Object& object = scene.objects[o];
    const bool alone = self && object.self && object.triangle_count > 1;
    if (alone) plan.regions.push_back(plan.object_boxes[o]);
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count;
         ++t) {
      if (alone) {
        plan.triangles.push_back(t);
        continue;
      }
      for (const std::uint32_t partner : partners[o]) {
        if (overlap(plan.triangle_boxes[t], plan.object_boxes[partner])) {
          plan.triangles.push_back(t);
          break;
        }
      }
    }
  }
  return plan;
}

}  // namespace farcull
