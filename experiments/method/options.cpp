// Parsing of option values, defaults, and which options go together.
#include "experiments/method/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {
namespace {

constexpr int kUsualResolution = 512;
constexpr const char* kUsualViews = "x,y,z";
const std::vector<std::string> kOffsets = {
    "obb", "exact",
    // A new offset goes here.
};

std::string offset_names() {
  std::string names;
  for (const std::string& name : kOffsets) names += (names.empty() ? "" : ", ") + name;
  return names;
}

// The shortest text that gives the same double back.
std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// Refuses a form that the method does not have.
void validate_form(const RunOptions& options) {
  if (options.rounds < 0) {
    throw Error("--rounds", std::to_string(options.rounds) + " is no number of rounds",
                "give 1 or more");
  }
  const std::string method = to_string(options.method);
  const RunOptions fitting = with_fitting_form(options);
  const std::string drawing = method_names([](const Traits& t) { return t.draws; });
  const auto refuse = [&](const char* option, bool given, const std::string& why,
                          const std::string& methods) {
    if (!given) return;
    throw Error(option, method + " " + why,
                std::string("leave ") + option + " out, or use --method " + methods);
  };
  refuse("--rounds", options.rounds != fitting.rounds, "has no rounds", drawing);
  refuse("--clear", options.clear != fitting.clear, "clears nothing view by view", drawing);
  refuse("--level", options.objects_alone != fitting.objects_alone,
         tests_self_alone(options.method) ? "has triangles of one object alone"
                                          : "has no levels that are drawn",
         method_names([](const Traits& t) { return t.draws && !t.tests_self_alone; }));
  refuse("--conservative", options.conservative != fitting.conservative,
         fattens(options.method) ? "draws solids that contain their pixels' centres already"
                                 : "draws no triangles",
         method_names([](const Traits& t) { return t.draws && !t.fattens; }));
  if (options.objects_alone && options.clusters && !options.clusters->empty()) {
    throw Error("--clusters", "are of triangles, which --level objects never asks",
                "leave one of the two out");
  }
}

}  // namespace

int parse_resolution(const std::string& text, const std::string& option) {
  const std::optional<int> value = parse_number<int>(text);
  if (value && *value >= 1) return *value;
  throw Error(option, "'" + text + "' is no resolution",
              "give a whole number of pixels from 1, such as 512");
}

RadiusRule parse_radius(const std::string& text) {
  if (text == "published") return {.published = true, .factor = 1};
  if (text == "budget") return {};
  const std::optional<double> factor = parse_number<double>(text);
  if (factor && std::isfinite(*factor) && *factor >= 0 && *factor <= 1e5)
    return {.published = false, .factor = *factor};
  throw Error(
      "--radius", "'" + text + "' is no radius",
      "give budget, published, or a factor of 0 to 100000 on the budget radius, such as 0.9");
}

QueryMode parse_query(const std::string& text) {
  if (text == "flags") return QueryMode::flags;
  if (text == "occlusion") return QueryMode::occlusion;
  throw Error("--query", "'" + text + "' is no choice", "give flags or occlusion");
}

std::vector<std::uint32_t> parse_clusters(const std::string& text) {
  std::vector<std::uint32_t> sizes;
  if (text == "none") return sizes;
  const Error bad("--clusters", "'" + text + "' is no list of sizes",
                  "give none, or numbers of 2 or more, each below the one before, as in 256,32");
  for (const std::string& part : split_list(text)) {
    const std::optional<std::uint32_t> size = parse_number<std::uint32_t>(part);
    if (!size || *size < 2 || (!sizes.empty() && *size >= sizes.back())) throw bad;
    sizes.push_back(*size);
  }
  if (sizes.empty()) throw bad;
  return sizes;
}

int parse_rounds(const std::string& text) {
  const std::optional<int> value = parse_number<int>(text);
  if (value && *value >= 1) return *value;
  throw Error("--rounds", "'" + text + "' is no number of rounds", "give 1 or more");
}

ClearRule parse_clear(const std::string& text) {
  if (text == "any") return ClearRule::any;
  if (text == "all") return ClearRule::all;
  throw Error("--clear", "'" + text + "' is no choice", "give any or all");
}

bool parse_level(const std::string& text) {
  if (text == "objects") return true;
  if (text == "triangles") return false;
  throw Error("--level", "'" + text + "' is no choice", "give objects or triangles");
}

int parse_repeat(const std::string& text) {
  const std::optional<int> value = parse_number<int>(text);
  if (value && *value >= 1) return *value;
  throw Error("--repeat", "'" + text + "' is no number of runs", "give 1 or more");
}

void require_pair_resolution(int resolution, const std::string& option) {
  if (resolution <= kMostPairResolution) return;
  throw Error(option,
              std::to_string(resolution) + " is outside 1 .. " +
                  std::to_string(kMostPairResolution) + ", the limit of far-pairs",
              "give a number in that range, or auto");
}

int resolution_of(const RunOptions& options) {
  if (options.resolution > 0 || chooses_views(options.method)) return options.resolution;
  return kUsualResolution;
}

std::string views_of(const RunOptions& options) {
  if (!options.views.empty() || chooses_views(options.method)) return options.views;
  return kUsualViews;
}

DepthMode depth_of(const RunOptions& options) {
  return options.depth.value_or(fattens(options.method) ? DepthMode::fragment : DepthMode::fixed);
}

QueryMode query_of(const RunOptions& options) {
  // One step a triangle: flags would wait for each of them.
  const bool steps = tests_self_alone(options.method);
  const bool flags = options.depth_format == DepthFormat::float32 && !steps;
  return options.query.value_or(flags ? QueryMode::flags : QueryMode::occlusion);
}

bool promises(const RunOptions& options) {
  switch (traits(options.method).promises) {
    case Promises::never:
      return false;
    case Promises::always:
      return true;
    case Promises::at_budget_radius:
      return depth_of(options) == DepthMode::fragment && !options.radius.published &&
             options.radius.factor >= 1;
  }
  return false;
}

std::string form_text(const RunOptions& options) {
  std::string out;
  const auto add = [&out](const std::string& text) { out += (out.empty() ? "" : " ") + text; };
  if (options.rounds > 0) add("--rounds " + std::to_string(options.rounds));
  if (options.clear == ClearRule::all) add("--clear all");
  if (options.objects_alone) add("--level objects");
  if (options.conservative) add("--conservative");
  return out;
}

RunOptions with_fitting_form(RunOptions options) {
  if (!draws(options.method)) {
    options.rounds = 0;
    options.clear = ClearRule::any;
  }
  if (!draws(options.method) || tests_self_alone(options.method)) options.objects_alone = false;
  if (!draws(options.method) || fattens(options.method)) options.conservative = false;
  return options;
}

std::string describe(const RunOptions& options) {
  const int resolution = resolution_of(options);
  if (!looks(options.method) || resolution == 0) return to_string(options.method);
  const std::string form = form_text(options);
  return to_string(options.method) + " at " + std::to_string(resolution) + " px" +
         (form.empty() ? "" : ", " + form);
}

std::string method_reason(const RunOptions& options) {
  if (!options.method_is_default) return "--method";
  return "no --method: " + to_string(kDefaultMethod) +
         " misses nothing, and is the fastest on most scenes";
}

void validate(const RunOptions& options) {
  if (options.resolution < 0) {
    throw Error("--resolution", std::to_string(options.resolution) + " is no resolution",
                "give 1 px or more");
  }
  if (chooses_views(options.method)) require_pair_resolution(options.resolution);
  if (!(options.clearance >= 0) || !std::isfinite(options.clearance)) {
    throw Error("--clearance", number(options.clearance) + " is no distance",
                "give a finite distance in world units, 0 or more");
  }
  if (options.clearance > 0 && !takes_clearance(options.method)) {
    throw Error("--clearance", to_string(options.method) + " finds what meets, not what is near",
                "use --method " + method_names([](const Traits& t) { return t.takes_clearance; }));
  }
  if (std::find(kOffsets.begin(), kOffsets.end(), options.offset) == kOffsets.end()) {
    throw Error("--offset", "'" + options.offset + "' is no offset",
                "give one of " + offset_names());
  }
  if (!options.neighbours && options.verify) {
    throw Error("neighbours", "are not asked for, and the accounting asks for every pair",
                "leave the accounting out");
  }
  if (options.offset == "exact" && options.depth == DepthMode::fixed) {
    throw Error("--offset",
                "exact offsets are evaluated by the fragment program, not drawn as surfaces",
                "use --depth fragment, or --offset obb");
  }
  if (draws(options.method) && !fattens(options.method) && options.depth == DepthMode::fragment) {
    throw Error("--depth",
                to_string(options.method) + " draws the triangles themselves, by fixed function",
                "leave --depth out, or use --method far");
  }
  validate_form(options);
  if (options.query == QueryMode::flags && options.depth_format == DepthFormat::fixed24) {
    throw Error("--query",
                "flags cannot be used with a 24-bit depth buffer: a comparison in the shader loses "
                "equal depths",
                "use --query occlusion or --depth-format 32f");
  }
  // Whether there is such a device is seen when one is needed; what can be none is refused at once.
  const std::string& device = options.device;
  if (device != "" && !is_cpu(device) && device != "gl" && device != "hardware" &&
      device != "software" && device.find_first_not_of("0123456789") != std::string::npos) {
    throw Error("--device", "'" + device + "' is no device",
                "give native, gl, software, hardware or a number that `farcull doctor` lists");
  }
  if (!options.views.empty()) parse_views(options.views);
}

}  // namespace farcull
