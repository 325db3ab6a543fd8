// Checks which options go together, chooses defaults, and puts options in words.
#include "experiments/method/options.h"

#include <charconv>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr int kUsualResolution = 512;
constexpr const char* kUsualViews = "x,y,z";

// Refuses an option that the method does not have, so that no request of the user is ignored.
void refuse_idle(const RunOptions& options, const GivenOptions& given) {
  const Traits& method = traits(options.method);
  for (const Option& option : run_options()) {
    if (option.serves(method)) continue;
    const bool unusual = option.unusual && option.unusual(options);
    if (!unusual && !given.contains(option.name)) continue;
    const std::string why = option.why_not ? option.why_not(method) : "";
    const std::string name = "{" + std::string(option.name) + "}";
    throw Error(name,
                why.empty() ? "has no meaning for {method} " + to_string(options.method)
                            : to_string(options.method) + " " + why,
                "leave " + name + " out, or use {method} " + method_names(option.serves));
  }
}

}  // namespace

RunOptions read_options(const GivenOptions& given, RunOptions options) {
  options.method_is_default = !given.contains("method");
  for (const Option& option : run_options()) {  // the method is the first option
    const auto found = given.find(option.name);
    if (found != given.end() && option.take) take_option(option.name, found->second, options);
  }
  validate(options, given);
  return options;
}

void validate(const RunOptions& options, const GivenOptions& given) {
  require_range(options);
  if (!options.neighbours && options.verify) {
    throw Error("neighbours", "are not asked for, and the accounting asks for every pair",
                "leave the accounting out");
  }
  if (options.offset == "exact" && options.depth == DepthMode::fixed) {
    throw Error("{offset}",
                "exact offsets are evaluated by the fragment program, not drawn as surfaces",
                "use {depth} fragment, or {offset} obb");
  }
  refuse_idle(options, given);
  if (options.full && options.broad_phase == BroadPhase::triangles) {
    throw Error("{broad_phase}", "triangles leaves out what {full} asks for",
                "leave one of the two out");
  }
  if (options.objects_alone && options.clusters && !options.clusters->empty()) {
    throw Error("{clusters}", "are of triangles, which {level} objects never asks",
                "leave one of the two out");
  }
  if (options.query == QueryMode::flags && options.depth_format == DepthFormat::fixed24) {
    throw Error("{query}",
                "flags cannot be used with a 24-bit depth buffer: a comparison in the shader loses "
                "equal depths",
                "use {query} occlusion or {depth_format} 32f");
  }
}

int resolution_of(const RunOptions& options) {
  return options.resolution > 0 ? options.resolution : kUsualResolution;
}

std::string views_of(const RunOptions& options) {
  return options.views.empty() ? kUsualViews : options.views;
}

DepthMode depth_of(const RunOptions& options) {
  return options.depth.value_or(fattens(options.method) ? DepthMode::fragment : DepthMode::fixed);
}

QueryMode query_of(const RunOptions& options) {
  // Methods that test only an object against itself draw one step for each triangle, and flags
  // would wait for every step.
  const bool steps = tests_self_alone(options.method);
  const bool flags = options.depth_format == DepthFormat::float32 && !steps;
  return options.query.value_or(flags ? QueryMode::flags : QueryMode::occlusion);
}

bool guaranteed(const RunOptions& options) {
  const Promises promises = traits(options.method).promises;
  if (promises != Promises::at_budget_radius) return promises == Promises::always;
  return depth_of(options) == DepthMode::fragment && !options.radius.published &&
         options.radius.factor >= 1;
}

std::string form_text(const RunOptions& options) {
  std::string out;
  for (const Option& option : run_options()) {
    const auto value = option.copy ? option.unusual(options) : std::nullopt;
    if (!value) continue;
    out +=
        (out.empty() ? "" : " ") + option_word(option.name) + (value->empty() ? "" : " ") + *value;
  }
  return out;
}

RunOptions with_fitting_form(RunOptions options) {
  for (const Option& option : run_options()) {
    if (option.copy && !option.serves(traits(options.method))) option.copy(RunOptions(), options);
  }
  return options;
}

std::string radius_text(const RadiusRule& radius) {
  if (radius.published) return "published";
  if (radius.factor == 1) return "budget";
  char text[32];
  const bool plain = radius.factor == 0 || radius.factor >= 1e-4;
  const auto form = plain ? std::chars_format::fixed : std::chars_format::scientific;
  return {text, std::to_chars(text, text + sizeof text, radius.factor, form).ptr};
}

std::string describe(const RunOptions& options, const std::string& not_drawn) {
  if (!draws(options.method)) return to_string(options.method);
  if (!not_drawn.empty()) return to_string(options.method) + ", " + not_drawn;
  const std::string form = form_text(options);
  return to_string(options.method) + " at " + std::to_string(resolution_of(options)) + " px" +
         (form.empty() ? "" : ", " + form);
}

std::string method_reason(const RunOptions& options) {
  const std::string word = option_word("method");
  if (!options.method_is_default) return word;
  return "no " + word + ": " + to_string(kDefaultMethod) +
         " misses nothing, and is the fastest on most scenes";
}

}  // namespace farcull
