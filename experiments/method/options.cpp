// The table of options. Functions that read, check and describe options, and choose defaults.
#include "experiments/method/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {
namespace {

const std::vector<std::string> kOffsets = {
    "obb", "exact",
    // A new offset goes here.
};

bool is_distance(double value) { return value >= 0 && std::isfinite(value); }

// True if the text has the form of a device's name. Does not check that the device exists.
bool is_device(const std::string& device) {
  return device.empty() || is_cpu(device) || device == "gl" || device == "hardware" ||
         device == "software" || device.find_first_not_of("0123456789") == std::string::npos;
}

std::string braced(const std::string& name) { return "{" + name + "}"; }

Error bad_value(const Option& option, const std::string& text) {
  return {braced(option.name), "'" + text + "' is no " + option.kind, option.remedy};
}

template <class T>
bool take_number_from(T least, const std::string& text, T& value) {
  const std::optional<T> number = parse_number<T>(text);
  if (!number || !(*number >= least)) return false;
  value = *number;
  return true;
}

// An option with two values. Each value has a word on the command line.
template <class Value>
struct Choice {
  const char* first;
  Value of_first;
  const char* second;
  Value of_second;

  const char* word(Value value) const { return value == of_first ? first : second; }
};
constexpr Choice<DepthMode> kDepths = {"fragment", DepthMode::fragment, "fixed", DepthMode::fixed};
constexpr Choice<DepthFormat> kFormats = {"32f", DepthFormat::float32, "24", DepthFormat::fixed24};
constexpr Choice<QueryMode> kQueries = {"flags", QueryMode::flags, "occlusion",
                                        QueryMode::occlusion};
constexpr Choice<BroadPhase> kPhases = {"objects", BroadPhase::objects, "triangles",
                                        BroadPhase::triangles};
constexpr Choice<ClearRule> kClearRules = {"any", ClearRule::any, "all", ClearRule::all};
constexpr Choice<bool> kLevels = {"objects", true, "triangles", false};

template <const auto& Words, auto Member>
bool take_choice(const std::string& text, RunOptions& options) {
  if (text != Words.first && text != Words.second) return false;
  options.*Member = text == Words.first ? Words.of_first : Words.of_second;
  return true;
}

template <auto Member>
void copy_value(const RunOptions& from, RunOptions& to) {
  to.*Member = from.*Member;
}

// Reads "none", or sizes in descending order, separated by commas.
bool take_clusters(const std::string& text, RunOptions& options) {
  std::vector<std::uint32_t> sizes;
  for (const std::string& part : text == "none" ? std::vector<std::string>() : split_list(text)) {
    const std::optional<std::uint32_t> size = parse_number<std::uint32_t>(part);
    if (!size || *size < 2 || (!sizes.empty() && *size >= sizes.back())) return false;
    sizes.push_back(*size);
  }
  if (sizes.empty() && text != "none") return false;
  options.clusters = std::move(sizes);
  return true;
}

bool take_radius(const std::string& text, RunOptions& options) {
  options.radius = {.published = text == "published", .factor = 1};
  return text == "published" || text == "budget" ||
         (take_number_from(0.0, text, options.radius.factor) && options.radius.factor <= 1e5);
}

bool take_views(const std::string& text, RunOptions& options) {
  if (text.empty()) throw Error("{views}", "its value is empty", "give directions, as in x,y,z");
  options.views = text;
  return true;
}

bool take_device(const std::string& text, RunOptions& options) {
  if (text.empty())
    throw Error("{device}", "its value is empty", "give native, software, hardware or a number");
  options.device = text;
  return is_device(text);
}

// Functions for Option::serves. Each returns true for the methods that accept the option.
bool any(const Traits&) { return true; }
bool fattening(const Traits& t) { return t.fattens; }
bool drawing(const Traits& t) { return t.draws; }
bool drawing_levels(const Traits& t) { return has_broad_phase(t.method); }
bool drawing_triangles(const Traits& t) { return t.draws && !t.fattens; }

std::optional<std::string> only_if(bool unusual, std::string value) {
  return unusual ? std::optional(std::move(value)) : std::nullopt;
}
OptionValue value_if(bool has, OptionValue value) { return has ? value : OptionValue(); }
OptionValue text_if(bool has, const char* text) { return value_if(has, std::string(text)); }

using Given = const std::string&;
using Run = const RunOptions&;

const Option kOptions[] = {
    {.name = "method",
     .type = "METHOD",
     .help = "boxes, far, cullide, quick-cullide, s-cullide,\ni-collide or exact (see farcull "
             "help methods); default\nboxes",
     .serves = any,
     .take = [](Given text, RunOptions& o) { return o.method = parse_method(text), true; },
     .words = list_of_methods()},
    {.name = "resolution",
     .type = "N",
     .help =
         "pixels along the larger side of each view's window,\nfor methods that draw; default 512",
     .serves = drawing,
     .take = [](Given text, RunOptions& o) { return take_number_from(1, text, o.resolution); },
     .kind = "resolution",
     .remedy = "give a whole number of pixels from 1, such as 512",
     .value = [](Run o) { return value_if(draws(o.method), resolution_of(o)); },
     .of_drawing = true},
    {.name = "radius",
     .type = "RADIUS",
     .help = "of the ball that fattens a primitive, for far: budget,\n"
             "published, or a factor on the budget; default budget",
     .serves = fattening,
     .take = take_radius,
     .kind = "radius",
     .remedy =
         "give budget, published, or a factor of 0 to 100000 on the budget radius, such as 0.9; "
         "farcull compare takes several",
     .value = [](Run o) { return value_if(fattens(o.method), radius_text(o.radius)); },
     .of_drawing = true,
     .words = {"budget", "published"}},
    {.name = "offset",
     .type = "OFFSET",
     .help = "what a primitive is fattened to, for far: obb or\nexact; default obb",
     .serves = fattening,
     .take = [](Given text, RunOptions& o) { return o.offset = text, true; },  // see validate()
     .value = [](Run o) { return value_if(fattens(o.method), o.offset); },
     .of_drawing = true,
     .words = kOffsets},
    {.name = "depth",
     .type = "fragment|fixed",
     .help = "entry and exit depth by the fragment program\n"
             "(reliable), or fixed function as published;\n"
             "default fragment for far, fixed for the others",
     .serves = fattening,
     .take = take_choice<kDepths, &RunOptions::depth>,
     .kind = "choice",
     .remedy = "give fixed or fragment",
     .unusual =
         [](Run o) {
           return only_if(draws(o.method) && o.depth == DepthMode::fragment, "fragment");
         },
     .why_not =
         [](const Traits& t) {
           return t.draws ? "draws the triangles themselves, by fixed function" : "";
         },
     .value = [](Run o) { return text_if(draws(o.method), kDepths.word(depth_of(o))); },
     .of_drawing = true},
    {.name = "depth_format",
     .type = "32f|24",
     .help = "of the depth buffer; default 32f",
     .serves = drawing,
     .take = take_choice<kFormats, &RunOptions::depth_format>,
     .kind = "choice",
     .remedy = "give 24 or 32f",
     .value = [](Run o) { return text_if(draws(o.method), kFormats.word(o.depth_format)); },
     .of_drawing = true},
    {.name = "query",
     .type = "flags|occlusion",
     .help = "how visibility is asked; default flags, but occlusion\n"
             "with {depth_format} 24 and for s-cullide",
     .serves = drawing,
     .take = take_choice<kQueries, &RunOptions::query>,
     .kind = "choice",
     .remedy = "give flags or occlusion",
     .value = [](Run o) { return text_if(draws(o.method), kQueries.word(query_of(o))); },
     .of_drawing = true},
    {.name = "broad_phase",
     .type = "objects|triangles",
     .help = "which boxes are compared before drawing. objects: a\n"
             "triangle is drawn if its box meets the box of another\n"
             "object, as published; triangles: if it meets the box of\n"
             "a triangle of another object; default objects",
     .serves = drawing_levels,
     .take = take_choice<kPhases, &RunOptions::broad_phase>,
     .kind = "choice",
     .remedy = "give objects or triangles",
     .unusual = [](Run o) { return only_if(o.broad_phase == BroadPhase::triangles, "triangles"); },
     .copy = copy_value<&RunOptions::broad_phase>,
     .value =
         [](Run o) { return text_if(has_broad_phase(o.method), kPhases.word(o.broad_phase)); }},
    {.name = "clusters",
     .type = "LIST|none",
     .help = "sizes of clusters of triangles that are asked before\n"
             "single ones, for far, cullide and quick-cullide; default\n"
             "32 with occlusion queries and more than 32768 triangles",
     .serves = drawing_levels,
     .take = take_clusters,
     .kind = "list of sizes",
     .remedy = "give none, or numbers of 2 or more, each below the one before, as in 256,32"},
    {.name = "views",
     .type = "VIEWS",
     .help = "axes or directions to look along, by commas, as in\n"
             "x,-y,1:1:0.5, for methods that draw; default x,y,z,\n"
             "for far in the order that a sample suggests",
     .serves = drawing,
     .take = take_views,
     .words = {"x", "y", "z", "x,y,z"}},
    {.name = "rounds",
     .type = "N",
     .help = "at most N rounds over all views, for methods that draw;\n"
             "1 is CULLIDE as published; default: until a round\n"
             "changes nothing, for far until a view culls little",
     .serves = drawing,
     .take = [](Given text, RunOptions& o) { return take_number_from(1, text, o.rounds); },
     .kind = "number of rounds",
     .remedy = "give 1 or more",
     .unusual = [](Run o) { return only_if(o.rounds > 0, std::to_string(o.rounds)); },
     .why_not = [](const Traits&) { return "has no rounds"; },
     .copy = copy_value<&RunOptions::rounds>,
     .value = [](Run o) { return value_if(draws(o.method) && o.rounds > 0, o.rounds); },
     .of_drawing = true},
    {.name = "clear",
     .type = "any|all",
     .help = "how many views have to clear a triangle before it is\n"
             "culled, for methods that draw; default any",
     .serves = drawing,
     .take = take_choice<kClearRules, &RunOptions::clear>,
     .kind = "choice",
     .remedy = "give any or all",
     .unusual = [](Run o) { return only_if(o.clear == ClearRule::all, "all"); },
     .why_not = [](const Traits&) { return "clears nothing view by view"; },
     .copy = copy_value<&RunOptions::clear>,
     .value = [](Run o) { return text_if(draws(o.method), kClearRules.word(o.clear)); },
     .of_drawing = true},
    {.name = "level",
     .type = "objects|triangles",
     .help = "objects: objects are culled as a whole, their triangles\n"
             "are not; for far, cullide and quick-cullide;\n"
             "default triangles, for cullide after objects",
     .serves = drawing_levels,
     .take = take_choice<kLevels, &RunOptions::objects_alone>,
     .kind = "choice",
     .remedy = "give objects or triangles",
     .unusual = [](Run o) { return only_if(o.objects_alone, "objects"); },
     .why_not =
         [](const Traits& t) {
           return t.tests_self_alone ? "has triangles of one object alone"
                                     : "has no levels that are drawn";
         },
     .copy = copy_value<&RunOptions::objects_alone>,
     .value =
         [](Run o) { return text_if(has_broad_phase(o.method), kLevels.word(o.objects_alone)); },
     .of_drawing = true},
    {.name = "conservative",
     .type = "",
     .help = "draw every pixel that a triangle touches, for the\n"
             "CULLIDE family; OpenGL: where the device can",
     .serves = drawing_triangles,
     .take = [](Given, RunOptions& o) { return o.conservative = true; },
     .unusual = [](Run o) { return only_if(o.conservative, ""); },
     .why_not =
         [](const Traits& t) {
           return t.fattens ? "draws solids that contain their pixels' centres already"
                            : "draws no triangles";
         },
     .copy = copy_value<&RunOptions::conservative>,
     .value = [](Run o) { return value_if(drawing_triangles(traits(o.method)), o.conservative); },
     .of_drawing = true},
    {.name = "device",
     .type = "DEVICE",
     .help = "which draws: " + std::string(kDeviceHelp),
     .serves = drawing,
     .take = take_device,
     .kind = "device",
     .remedy = "give native, gl, software, hardware or a number that `farcull doctor` lists",
     .words = {"native", "cpu", "gl", "software", "hardware"}},
    {.name = "self",
     .type = "",
     .help = "every object is tested against itself as well\n"
             "(far, boxes, s-cullide, i-collide, exact); collisions\n"
             "of triangles that share a vertex position are listed apart",
     .serves = [](const Traits& t) { return t.tests_self; }},
    {.name = "clearance",
     .type = "D",
     .help = "pairs at this distance or less collide, in world\n"
             "units (boxes, exact); default 0",
     .serves = [](const Traits& t) { return t.takes_clearance; },
     .take =
         [](Given text, RunOptions& o) {
           return take_number_from(0.0, text, o.clearance) && is_distance(o.clearance);
         },
     .kind = "distance",
     .remedy = "give a finite distance in world units, 0 or more",
     .unusual = [](Run o) { return only_if(o.clearance != 0, shortest(o.clearance)); },
     .why_not = [](const Traits&) { return "finds what meets, not what is near"; },
     .value = [](Run o) { return value_if(takes_clearance(o.method), o.clearance); }},
    {.name = "ignore",
     .type = "LIST",
     .help = "pairs of objects that are not tested against each\n"
             "other, as in a:b,link*:gripper; * is any text",
     .serves = any},
    {.name = "ignore_file",
     .type = "FILE",
     .help = "the same, a pair a line; # begins a comment",
     .serves = any},
    {.name = "only",
     .type = "LIST",
     .help = "only these pairs of objects are tested against each\n"
             "other, as in a:b,link*:gripper",
     .serves = any},
    {.name = "limit",
     .type = "N",
     .help = "only the first N colliding pairs, in the order of\n"
             "{pairs}; the exact tests stop there. Of more than 4\n"
             "million candidates that boxes finds by a tree the\n"
             "search stops too, and nothing accounts for the pairs;\n"
             "other methods, and scenes that move, list all",
     .serves = any,
     .take = [](Given text,
                RunOptions& o) { return take_number_from<std::uint64_t>(1, text, o.limit); },
     .kind = "number of pairs",
     .remedy = "give a whole number, 1 or more"},
    {.name = "full",
     .type = "",
     .help = "leave nothing out that the scene does not need, to\n"
             "measure what leaving out saves (see farcull plan)",
     .serves = [](const Traits& t) { return t.culls; },
     .take = [](Given, RunOptions& o) { return o.full = true; },
     .why_not = [](const Traits&) { return "leaves nothing out"; },
     .value = [](Run o) -> OptionValue { return o.full; }},
    // A new option goes here.
};

// Throws Error for an option that the method does not accept, instead of ignoring the option.
void refuse_idle(const RunOptions& options, const GivenOptions& given) {
  const Traits& method = traits(options.method);
  for (const Option& option : run_options()) {
    if (option.serves(method)) continue;
    const bool unusual = option.unusual && option.unusual(options);
    if (!unusual && !given.contains(option.name)) continue;
    const std::string why = option.why_not ? option.why_not(method) : "";
    const std::string name = braced(option.name);
    throw Error(name,
                why.empty() ? "has no meaning for {method} " + to_string(options.method)
                            : to_string(options.method) + " " + why,
                "leave " + name + " out, or use {method} " + method_names(option.serves));
  }
}

}  // namespace

std::span<const Option> run_options() { return kOptions; }

const Option& run_option(std::string_view name) {
  for (const Option& option : run_options()) {
    if (option.name == name) return option;
  }
  throw std::logic_error("run_option: no option " + std::string(name));
}

std::string option_word(const std::string& name) {
  if (name == "doctor" || name == "run") return "farcull " + name;  // commands, not options
  // Names of options that run_options() lacks, since each belongs to a single command.
  static constexpr std::string_view kOthers[] = {"certificate", "compare", "inside", "no_verify",
                                                 "pairs",       "repeat",  "within"};
  if (std::ranges::none_of(run_options(), [&](const Option& o) { return name == o.name; }) &&
      std::ranges::find(kOthers, name) == std::end(kOthers))
    return {};
  std::string out = "--" + name;
  std::replace(out.begin(), out.end(), '_', '-');
  return out;
}

void take_option(std::string_view name, const std::string& text, RunOptions& options) {
  const Option& option = run_option(name);
  if (!option.take(text, options)) throw bad_value(option, text);
}

int parse_resolution(const std::string& text, const std::string& option) {
  int value = 0;
  if (take_number_from(1, text, value)) return value;
  const Option& row = run_option("resolution");
  throw Error(option, "'" + text + "' is no " + row.kind, row.remedy);
}

RadiusRule parse_radius(const std::string& text) {
  RunOptions options;
  take_option("radius", text, options);
  return options.radius;
}

int parse_repeat(const std::string& text) {
  int value = 0;
  if (take_number_from(1, text, value)) return value;
  throw Error("{repeat}", "'" + text + "' is no number of runs", "give 1 or more");
}

RunOptions read_options(const GivenOptions& given, RunOptions options) {
  options.method_is_default = !given.contains("method");
  for (const Option& option : run_options()) {  // `method` is the first option in the table
    const auto found = given.find(option.name);
    if (found != given.end() && option.take) take_option(option.name, found->second, options);
  }
  validate(options, given);
  return options;
}

void validate(const RunOptions& options, const GivenOptions& given) {
  const auto require = [](const char* name, bool good, const std::string& value) {
    if (!good) throw bad_value(run_option(name), value);
  };
  require("resolution", options.resolution >= 0, std::to_string(options.resolution));
  require("rounds", options.rounds >= 0, std::to_string(options.rounds));
  require("clearance", is_distance(options.clearance), shortest(options.clearance));
  require("device", is_device(options.device), options.device);
  if (std::ranges::find(kOffsets, options.offset) == kOffsets.end()) {
    std::string names;
    for (const std::string& name : kOffsets) names += (names.empty() ? "" : ", ") + name;
    throw Error("{offset}", "'" + options.offset + "' is no offset", "give one of " + names);
  }
  if (!options.views.empty()) parse_views(options.views);
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
  return options.resolution > 0 ? options.resolution : 512;
}

std::string views_of(const RunOptions& options) {
  return options.views.empty() ? "x,y,z" : options.views;
}

DepthMode depth_of(const RunOptions& options) {
  return options.depth.value_or(fattens(options.method) ? DepthMode::fragment : DepthMode::fixed);
}

QueryMode query_of(const RunOptions& options) {
  // Methods that test objects only against themselves draw triangle by triangle. QueryMode::flags
  // would make the program wait for the device after every triangle.
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
