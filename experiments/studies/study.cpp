#include "experiments/studies/study.h"

#include <fmt/format.h>

#include "core/error.h"

namespace farcull {

const std::vector<std::string>& axis_names() {
  static const std::vector<std::string> names = {
      "scene",      "method",     "offset", "radius", "depth_format",
      "depth_mode", "resolution", "views",  "frame",  "seed"};
  return names;
}

std::vector<std::string> axis_values(const Point& point) {
  return {point.scene,
          point.method,
          point.offset,
          point.radius,
          point.depth_format,
          point.depth_mode,
          point.resolution > 0 ? std::to_string(point.resolution) : "",
          point.views,
          point.frame >= 0 ? std::to_string(point.frame) : "",
          point.seed > 0 ? std::to_string(point.seed) : ""};
}

std::string describe(const Point& point) {
  std::string out = point.scene;
  const auto add = [&out](const std::string& text) {
    if (!text.empty()) out += ", " + text;
  };
  add(point.method);
  add(point.offset);
  if (!point.radius.empty() && point.radius != "budget") add("radius " + point.radius);
  if (point.depth_format == "fixed24") add("24-bit depth");
  if (point.depth_mode == "fixed") add("fixed-function depth");
  if (point.resolution > 0) add(fmt::format("{} px", point.resolution));
  if (!point.views.empty()) add("views " + point.views);
  if (point.frame >= 0) add(fmt::format("frame {}", point.frame));
  if (point.seed > 0) add(fmt::format("seed {}", point.seed));
  return out;
}

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {accuracy_study(),   error_time_study(), radius_study(),
                                         offsets_study(),    precision_study(),  stability_study(),
                                         efficiency_study(), scaling_study()};
  return all;
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
