#include "core/plan.h"

#include <algorithm>
#include <numeric>

#include "core/box_join.h"
#include "core/parallel.h"

namespace farcull {

Plan make_plan(const Scene& scene, const PlanRules& rules) {
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
    const bool whole = rules.self && object.self && object.triangle_count > 1;
    if (whole) plan.regions.push_back(plan.object_boxes[o]);
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count;
         ++t) {
      const auto meets = [&](std::uint32_t partner) {
        return overlap(plan.triangle_boxes[t], plan.object_boxes[partner]);
      };
      if (rules.full || whole || std::any_of(partners[o].begin(), partners[o].end(), meets))
        plan.triangles.push_back(t);
    }
  }
  if (rules.full && plan.regions.empty() && !plan.triangles.empty()) {
    Box all = Box::empty();
    for (const Box& box : plan.object_boxes) all.add(box);
    plan.regions.push_back(all);
  }
  return plan;
}

}  // namespace farcull
