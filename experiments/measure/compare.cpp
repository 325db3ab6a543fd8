// Runs in turn all cells (a method at a resolution), or runs as planned and runs with --full.
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

// Refuses a choice that none of the methods has.
void require_used(const RunOptions& asked, const std::vector<RunOptions>& cells) {
  for (const Option& option : run_options()) {
    if (!option.copy || !option.unusual(asked)) continue;
    if (std::ranges::any_of(cells,
                            [&](const RunOptions& o) { return option.unusual(o).has_value(); }))
      continue;
    throw Error("{" + std::string(option.name) + "}", "has no meaning for any of the methods",
                "leave it out, or add cullide to --methods");
  }
}

// Refuses a resolution beyond the device before the first run, not after an hour of smaller ones.
// Every OpenGL 4.3 takes 8192 px, half of its 16384, so the device is asked only beyond that.
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

SavingsRow run_row(const Scene& scene, Method method, const SavingsArguments& arguments,
                   Session& session, const Progress& progress) {
  SavingsRow row{.scene = scene.name, .method = method, .planned_ms = {}, .full_ms = {}};
  RunOptions options = arguments.options;
  options.method = method;
  options.verify = false;
  if (!draws(method)) options.resolution = 0;
  Record planned;
  // Contestant 0 is the run as planned, 1 the one with --full.
  const std::vector<Timed> timed = measure_in_turns(
      2, {.warm_up = 1, .counted = arguments.repeat}, [&](std::size_t full, int round) {
        if (full == 0 && progress) {
          progress(fmt::format("{}, {}: {} of {}", scene.name, to_string(method), round + 1,
                               arguments.repeat));
        }
        options.full = full == 1;
        Record record = run(scene, options, session);
        const double ms = compared_ms(record);
        if (full == 1) {
          row.same_pairs = row.same_pairs && same_pairs(planned, record);
        } else {
          planned = std::move(record);
        }
        return ms;
      });
  row.planned_ms = timed[0].ms;
  row.full_ms = timed[1].ms;
  return row;
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
  require_used(arguments.options, cells_of(arguments, arguments.self));
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

bool same_pairs(const Record& a, const Record& b) {
  return a.collisions.pairs == b.collisions.pairs &&
         a.collisions.neighbour_pairs == b.collisions.neighbour_pairs;
}

std::string broken(const std::vector<SavingsRow>& rows, RunOptions options) {
  for (const SavingsRow& row : rows) {
    options.method = row.method;
    if (!row.same_pairs && promises(options))
      return row.scene + ": " + to_string(row.method) + " finds other pairs with --full";
  }
  return "";
}

double SavingsRow::planned() const { return middle(planned_ms); }
double SavingsRow::full() const { return middle(full_ms); }
bool SavingsRow::pays() const { return planned() <= 1.05 * full() + 2; }

std::vector<SavingsRow> run_savings(const SavingsArguments& arguments, const Progress& progress) {
  std::vector<std::string> scenes = arguments.scenes;
  if (scenes.empty()) {
    for (const BuiltinScene& scene : builtin_scenes()) {
      if (!scene.costly) scenes.push_back(scene.name);
    }
  }
  // Checks all names before the first run.
  std::vector<Method> methods;
  for (const std::string& text : split_list(arguments.methods)) {
    methods.push_back(parse_method(text, "--methods"));
    if (!culls(methods.back()))
      throw Error("--methods", "exact leaves nothing out", "name other methods");
  }
  for (const std::string& name : scenes) require_known(name);
  Session session(arguments.options.device);
  std::vector<SavingsRow> rows;
  for (const std::string& name : scenes) {
    Scene scene = load_scene({name});
    for (const Method method : methods) {
      Scene unmarked = scene;
      if (!tests_self(method)) {
        for (Object& object : unmarked.objects) object.self = false;
      }
      if (!has_self(unmarked) && tests_self_alone(method)) continue;
      rows.push_back(run_row(unmarked, method, arguments, session, progress));
    }
  }
  if (rows.empty()) {
    throw Error("--methods", "none of them has a question to ask of these scenes",
                "name other methods, or scenes that are tested against themselves");
  }
  return rows;
}

std::string savings_table(const std::vector<SavingsRow>& rows) {
  Table table("llrrrrrl");
  table.add({"scene", "method", "planned ms", "full ms", "planned/full", "95 %", "n", ""});
  for (const SavingsRow& row : rows) {
    const Estimate ratio = ratio_estimate(row.planned_ms, row.full_ms);
    table.add({row.scene, to_string(row.method), fmt::format("{:.2f}", row.planned()),
               fmt::format("{:.2f}", row.full()), fmt::format("{:.2f}", ratio.value),
               fmt::format("{:.2f} to {:.2f}", ratio.low, ratio.high), std::to_string(ratio.n),
               std::string(row.same_pairs ? "" : "DIFFERENT PAIRS ") +
                   (row.pays() ? "" : "slower than --full")});
  }
  return table.text() +
         "\ncull + exact ms of the run as planned and of --full, medians of n runs; 95 %: the "
         "interval "
         "of their\nratio by the bootstrap, which is narrower than 95 % for fewer than 9 runs.\n";
}

nlohmann::ordered_json savings_json(const std::vector<SavingsRow>& rows,
                                    const SavingsArguments& arguments) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SavingsRow& row : rows) {
    list.push_back({{"scene", row.scene},
                    {"method", to_string(row.method)},
                    {"planned_ms", row.planned_ms},
                    {"full_ms", row.full_ms},
                    {"ratio", row.planned() / row.full()},
                    {"same_pairs", row.same_pairs},
                    {"pays", row.pays()}});
  }
  return {{"experiment", "savings"},
          {"repeat", arguments.repeat},
          {"resolution", arguments.options.resolution},
          {"commit", FARCULL_COMMIT},
          {"rows", list}};
}

}  // namespace farcull
