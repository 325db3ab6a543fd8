#include "experiments/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/view.h"
#include "experiments/output.h"

namespace farcull {
namespace {

constexpr const char* kAllMethods = "far,cullide,far-pairs,exact";
constexpr const char* kBeyondCulling = "far-pairs,exact";
constexpr const char* kUsualResolutions = "128,256,512,1024,2048";
constexpr const char* kAuto = "auto";

// What a method is run at; `exact` is, once.
std::vector<int> resolutions_of(const CompareArguments& arguments, Method method) {
  const bool pairs = method == Method::far_pairs;
  if (!pairs && !draws(method)) return {0};
  const std::string text = arguments.resolutions.value_or(pairs ? kAuto : kUsualResolutions);
  std::vector<int> out;
  for (const std::string& resolution : split_list(text)) {
    if (resolution != kAuto) {
      out.push_back(parse_resolution(resolution, "--resolutions"));
      if (pairs) require_pair_resolution(out.back(), "--resolutions");
    } else if (pairs) {
      out.push_back(0);
    }
  }
  if (out.empty()) {
    throw Error("--resolutions", "auto has no meaning for " + to_string(method),
                "give a number of pixels as well, or --methods far-pairs");
  }
  return out;
}

// self: whether an object is tested against itself.
std::vector<RunOptions> cells_of(const CompareArguments& arguments, bool self) {
  std::vector<RunOptions> cells;
  const bool beyond = self || arguments.options.clearance > 0;
  for (const std::string& method :
       split_list(arguments.methods.value_or(beyond ? kBeyondCulling : kAllMethods))) {
    RunOptions options = arguments.options;
    options.method = parse_method(method, "--methods");
    if (self && !tests_self(options.method)) {
      throw Error("--methods",
                  method + " tests no object against itself, as one of the scene has to be",
                  "give " + method_names(tests_self));
    }
    for (const std::string& offset : split_list(arguments.offsets)) {
      if (options.method == Method::far) options.offset = offset;
      for (const int resolution : resolutions_of(arguments, options.method)) {
        options.resolution = resolution;
        validate(options);
        cells.push_back(options);
      }
      if (options.method != Method::far) break;
    }
  }
  return cells;
}

// A resolution beyond the device is refused before the first run, not after an hour of smaller
// ones. Every OpenGL 4.3 has room for half of its 16384 px, so only beyond that is a device asked.
void require_room(const std::vector<RunOptions>& cells, Session& session) {
  int largest = 0;
  for (const RunOptions& cell : cells) {
    if (draws(cell.method)) largest = std::max(largest, cell.resolution);
  }
  if (largest <= 8192) return;
  const int limit = GlCanvas(session.context(), DepthMode::fixed, {}).limits().max_resolution;
  if (largest > limit) {
    throw Error("--resolutions",
                fmt::format("{} is outside 1 .. {}, the limit of this device", largest, limit),
                "choose resolutions in that range");
  }
}

double compared_ms(const RunRecord& record) { return record.ms.cull + record.ms.exact; }

}  // namespace

std::vector<RunRecord> Comparison::median_records() const {
  std::vector<RunRecord> out;
  for (std::vector<RunRecord> repeats : runs) {
    const auto middle = repeats.begin() + static_cast<std::ptrdiff_t>((repeats.size() - 1) / 2);
    std::nth_element(
        repeats.begin(), middle, repeats.end(),
        [](const RunRecord& a, const RunRecord& b) { return compared_ms(a) < compared_ms(b); });
    out.push_back(*middle);
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
  // Repeats go round the cells, so that a slow minute of the machine does not fall on one of them
  // alone.
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      RunOptions options = cells[i];
      const std::string cell = describe(options) + ": ";
      const Progress named =
          progress ? [&](const std::string& stage) { progress(cell + stage); } : Progress{};
      out.runs[i].push_back(run_scene(scene, options, session, named));
    }
  }
  return out;
}

nlohmann::ordered_json to_json(const Scene& scene, const Comparison& comparison) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::vector<RunRecord>& repeats : comparison.runs) {
    for (const RunRecord& record : repeats) rows.push_back(to_json(scene, record));
  }
  return {{"runs", rows}};
}

}  // namespace farcull
