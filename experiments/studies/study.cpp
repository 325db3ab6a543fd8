// The list of studies.
#include "experiments/studies/study.h"

#include <variant>

#include "core/base/error.h"
#include "experiments/method/method.h"

namespace farcull {

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {
      scenes_study(),    accuracy_study(),  error_time_study(), radius_study(), offsets_study(),
      precision_study(), culling_study(),   stability_study(),  cloth_study(),  efficiency_study(),
      scaling_study(),   libraries_study(), proximity_study()};
  return all;
}

std::vector<Study> studies_of_all() {
  std::vector<Study> out = studies();
  std::erase_if(out, [](const Study& study) { return study.campaign; });
  return out;
}

Study on_devices(const Study& study) {
  Study out = study;
  out.grid = [grid = study.grid](const GridChoice& choice) {
    std::vector<Point> points = grid(choice);
    std::erase_if(points, [](const Point& point) {
      if (const auto* run = std::get_if<RunPoint>(&point))
        return !draws(run->method) && !chooses_views(run->method);
      const auto* lemma = std::get_if<LemmaPoint>(&point);
      return lemma == nullptr || lemma->worst;
    });
    return points;
  };
  return out;
}

const Study& study_named(const std::string& name) {
  std::string known;
  for (const Study& study : studies()) {
    if (study.name == name) return study;
    known += (known.empty() ? "" : ", ") + study.name;
  }
  throw Error("experiment", "'" + name + "' is no study", "name one of " + known + ", or all");
}

}  // namespace farcull
