// Runs all cells in turn; a cell is a method at a resolution.
#include "experiments/measure/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

#include "commit.h"
#include "core/base/error.h"
#include "core/scene/scene.h"
#include "core/view/view.h"
#include "experiments/measure/harness.h"
#include "experiments/record/output.h"
#include "experiments/record/stage_words.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr const char* kAllMethods = "far,cullide,boxes,exact";
constexpr const char* kSelfMethods = "far,boxes,exact";
constexpr const char* kClearanceMethods = "boxes,exact";
constexpr const char* kUsualResolutions = "128,256,512,1024,2048";

// The resolutions of a method; only 0 for a method that does not draw.
std::vector<int> resolutions_of(const CompareArguments& arguments, Method method) {
  if (!draws(method)) return {0};
  std::vector<int> out;
  for (const std::string& text : split_list(arguments.resolutions.value_or(kUsualResolutions)))
    out.push_back(parse_resolution(text, "--resolutions"));
  return out;
}

// self: whether an object is tested against itself.
std::vector<RunOptions> cells_of(const CompareArguments& arguments, bool self) {
  std::vector<RunOptions> cells;
  const char* usual = arguments.options.clearance > 0 ? kClearanceMethods
                      : self                          ? kSelfMethods
                                                      : kAllMethods;
  for (const std::string& method : split_list(arguments.methods.value_or(usual))) {
    RunOptions options = arguments.options;
    options.method = parse_method(method, "--methods");
    options = with_fitting_form(options);
    if (self && !tests_self(options.method)) {
      throw Error("--methods",
                  method + " tests no object against itself, as one of the scene has to be",
                  "give " + method_names([](const Traits& t) { return t.tests_self; }));
    }
    for (const std::string& offset : split_list(arguments.offsets)) {
      if (fattens(options.method)) options.offset = offset;
      for (const int resolution : resolutions_of(arguments, options.method)) {
        options.resolution = resolution;
        validate(options);
        cells.push_back(options);
      }
      if (!fattens(options.method)) break;
    }
  }
  return cells;
}

// Refuses a resolution beyond the device before the first run, not after an hour of smaller ones.
// Every OpenGL 4.3 takes 8192 px, half of its 16384, so the device is opened only beyond that.
void require_room(const std::vector<RunOptions>& cells, Session& session) {
  int largest = 0;
  for (const RunOptions& cell : cells) {
    if (draws(cell.method)) largest = std::max(largest, cell.resolution);
  }
  if (largest <= 8192) return;
  const int limit = session.max_resolution();
  if (largest > limit) {
    throw Error("--resolutions",
                fmt::format("{} is outside 1 .. {}, the limit of this device", largest, limit),
                "choose resolutions in that range");
  }
}

}  // namespace

std::vector<Record> Comparison::median_records() const {
  std::vector<Record> out;
  for (const std::vector<Record>& repeats : runs) {
    std::vector<double> ms;
    for (const Record& record : repeats) ms.push_back(compared_ms(record));
    out.push_back(repeats[median_run(ms)]);
  }
  return out;
}

void validate(const CompareArguments& arguments) {
  parse_repeat(arguments.repeat);
  cells_of(arguments, arguments.self);
}

Comparison compare(const Scene& scene, const CompareArguments& arguments,
                   const Progress& progress) {
  const int repeats = parse_repeat(arguments.repeat);
  const std::vector<RunOptions> cells = cells_of(arguments, has_self(scene));
  Comparison out;
  out.runs.resize(cells.size());
  Session session(arguments.options.device);
  require_room(cells, session);
  measure_in_turns(cells.size(), {.counted = repeats}, [&](std::size_t i, int) {
    const std::string cell = describe(cells[i]) + ": ";
    const Progress named =
        progress ? [&](const ProgressStep& step) { progress(cell + text_of(step)); } : Progress{};
    out.runs[i].push_back(run(scene, cells[i], session, named));
    return compared_ms(out.runs[i].back());
  });
  return out;
}

nlohmann::ordered_json to_json(const Scene& scene, const Comparison& comparison) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::vector<Record>& repeats : comparison.runs) {
    for (const Record& record : repeats) rows.push_back(to_json(scene, record));
  }
  return {{"runs", rows}};
}

}  // namespace farcull
