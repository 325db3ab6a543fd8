// A plan is printed stage by stage, with the words that the record of the run uses as well.
#include "experiments/record/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {

std::string decision_of(const Stage& stage) {
  return stage.depends ? "depends" : stage.ran ? "runs" : "left out";
}

std::string plan_table(const Scene& scene, const Plan& plan) {
  Table table("lll");
  table.add({"stage", "", "why"});
  for (const Stage& stage : plan.stages())
    table.add({name_of(stage), decision_of(stage), reason_of(stage)});
  const RunOptions& options = plan.options;
  const auto self =
      static_cast<std::uint64_t>(std::count_if(scene.objects.begin(), scene.objects.end(),
                                               [](const Object& object) { return object.self; }));
  const std::string tested = self == 0 ? ""
                                       : fmt::format("self       {} tested against {}\n",
                                                     counted(self, "object is", "objects are"),
                                                     self == 1 ? "itself" : "themselves");
  return fmt::format("{}: {}, {}, {}{}\n{}\n{}", scene.name,
                     counted(scene.objects.size(), "object", "objects"),
                     counted(scene.triangles.size(), "triangle", "triangles"), describe(options),
                     options.full ? ", --full" : "",
                     default_method_line(options) + tested + not_asked_line(scene), table.text());
}

nlohmann::ordered_json plan_json(const Scene& scene, const Plan& plan) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Stage& stage : plan.stages()) {
    list.push_back(
        {{"step", name_of(stage)}, {"decision", decision_of(stage)}, {"reason", reason_of(stage)}});
  }
  const std::string nothing = nothing_to_test(scene).reason;
  return {{"scene", scene.name},
          {"objects", scene.objects.size()},
          {"triangles", scene.triangles.size()},
          {"nothing_to_test",
           nothing.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(nothing)},
          {"method", to_string(plan.options.method)},
          {"method_reason", method_reason(plan.options)},
          {"form", form_text(plan.options)},
          {"full", plan.options.full},
          {"steps", list}};
}

}  // namespace farcull
