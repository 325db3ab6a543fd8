// The command line of a picture, from its values and back to text, and its checks.
#include "experiments/picture/arguments.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/gl/picture/picture.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/system/shell_word.h"

namespace farcull {
namespace {

constexpr long kUsualFrames = 30;
constexpr const char* kUsualView = "-0.45:-0.35:-0.82";

// The same under the name of an option of this command.
template <class Parse>
void as_option(const std::string& option, Parse parse) {
  try {
    parse();
  } catch (const Error& error) {
    throw Error(option, error.reason, error.remedy);
  }
}

// "cullide", or "cullide:128" where the panel says so.
std::string panel_word(const RunOptions& options) {
  std::string out = to_string(options.method);
  if (options.resolution > 0) out += fmt::format(":{}", options.resolution);
  return out;
}

}  // namespace

View camera(const PictureArguments& arguments) {
  View view = parse_view(arguments.view.empty() ? kUsualView : arguments.view);
  const Vec3 forward = view.rows.row(2);
  Vec3 up = parse_view(arguments.up.empty() ? "y" : arguments.up).rows.row(2);
  if (forward.cross(up).norm() < 1e-6) {
    if (!arguments.up.empty()) {
      throw Error("--up", "it is the direction that --view looks along",
                  "give another axis to one of them");
    }
    up = Vec3(0, 0, forward[1] > 0 ? 1 : -1);
  }
  const Vec3 right = forward.cross(up).normalized();
  view.rows << right.transpose(), right.cross(forward).transpose(), forward.transpose();
  return view;
}

FrameRange frames_of(const PictureArguments& arguments) {
  if (arguments.frames) return *arguments.frames;
  const bool motion = arguments.scene.size() == 1 && is_builtin_scene(arguments.scene.front());
  if (motion) return {0, kUsualFrames - 1};
  return {*arguments.frame, *arguments.frame};
}

std::string command_of(const PictureArguments& arguments) {
  std::string out = "farcull picture";
  const auto add = [&](const std::string& word) { out += " " + quoted(word); };
  const auto option = [&](const std::string& name, const std::string& value) {
    add(name);
    add(value);
  };
  for (const std::string& part : arguments.scene) add(part);
  const RunOptions& first = arguments.panels.front();
  if (arguments.panels.size() == 1) {
    option("--method", to_string(first.method));
    if (first.resolution > 0) option("--resolution", std::to_string(first.resolution));
  } else {
    std::string list;
    for (const RunOptions& options : arguments.panels)
      list += (list.empty() ? "" : ",") + panel_word(options);
    option("--compare", list);
  }
  for (const RunOptions& options : arguments.panels) {
    if (!fattens(options.method)) continue;
    const std::string radius = radius_text(options.radius);
    if (radius != "budget") option("--radius", radius);
    if (options.offset != "obb") option("--offset", options.offset);
    if (options.depth) option("--depth", *options.depth == DepthMode::fixed ? "fixed" : "fragment");
    break;
  }
  if (!first.device.empty()) option("--device", first.device);
  if (arguments.self) add("--self");
  if (arguments.frame) {
    const FrameRange range = frames_of(arguments);
    option("--frame", std::to_string(*arguments.frame));
    option("--frames", fmt::format("{}:{}", range.first, range.last));
  }
  if (!arguments.view.empty()) option("--view", arguments.view);
  if (!arguments.up.empty()) option("--up", arguments.up);
  if (arguments.zoom) add("--zoom");
  // Its value may be left out, so what begins with - would be taken for another option.
  if (arguments.depth_view) add("--view-depth=" + *arguments.depth_view);
  option("--size", fmt::format("{}x{}", arguments.width, arguments.height));
  return out;
}

void validate(const PictureArguments& arguments) {
  if (arguments.panels.empty() || arguments.panels.size() > kMostPanels) {
    throw Error("--compare", fmt::format("{} panels do not fit", arguments.panels.size()),
                fmt::format("name 1 to {} methods", kMostPanels));
  }
  for (const int side : {arguments.width, arguments.height}) {
    if (side >= 64 && side <= kMostPicture) continue;
    throw Error("--size", fmt::format("{} px is outside 64 .. {}", side, kMostPicture),
                "give the width and height of a panel in that range, as in 900x760");
  }
  for (const RunOptions& options : arguments.panels) {
    validate(options);
    if (!arguments.depth_view || draws(options.method)) continue;
    throw Error("--view-depth", to_string(options.method) + " stores no depth",
                "use --method " + method_names([](const Traits& t) { return t.draws; }));
  }
  as_option("--view", [&] { parse_view(arguments.view.empty() ? kUsualView : arguments.view); });
  as_option("--up", [&] { parse_view(arguments.up.empty() ? "y" : arguments.up); });
  camera(arguments);
  if (arguments.depth_view) as_option("--view-depth", [&] { parse_view(*arguments.depth_view); });
  if (!arguments.frame) {
    if (!arguments.frames) return;
    throw Error("--frames", "says of how many, not which", "give --frame F as well");
  }
  const FrameRange range = frames_of(arguments);
  if (*arguments.frame < range.first || *arguments.frame > range.last) {
    throw Error(
        "--frame",
        fmt::format("{} is none of the frames {} to {}", *arguments.frame, range.first, range.last),
        "give one of these, or other --frames");
  }
}

}  // namespace farcull
