// The list of studies.
#include "experiments/studies/study.h"

#include "core/base/error.h"

namespace farcull {

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {accuracy_study(), error_time_study(), radius_study(),
                                         offsets_study(),  precision_study(),  stability_study(),
                                         cloth_study(),    efficiency_study(), scaling_study()};
  return all;
}

std::vector<Study> studies_of_all() {
  std::vector<Study> out = studies();
  std::erase_if(out, [](const Study& study) { return study.campaign; });
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
