// Runs all cells in turn. A cell is a method with a resolution, an offset and a radius.
#include "experiments/measure/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/view/view.h"
#include "experiments/measure/harness.h"
#include "experiments/record/output.h"
#include "experiments/record/stage_words.h"

namespace farcull {
namespace {

constexpr int kUsualRepeats = 3;
constexpr double kLongMs = 10'000;

// Returns the resolutions of a method in px; {0} for a method that does not draw.
std::vector<int> resolutions_of(const CompareArguments& arguments, Method method) {
  if (!draws(method)) return {0};
  std::vector<int> out;
  for (const std::string& text :
       split_list(arguments.resolutions.value_or("128,256,512,1024,2048")))
    out.push_back(parse_resolution(text, "--resolutions"));
  return out;
}

using Words = std::vector<std::string>;

// Returns the cells to compare. self: true if an object is tested against itself.
std::vector<RunOptions> cells_of(const CompareArguments& arguments, bool self) {
  std::vector<RunOptions> cells;
  const std::string methods =
      arguments.methods.value_or(usual_methods(arguments.options.clearance > 0, self));
  for (const std::string& method : split_list(methods)) {
    RunOptions options = arguments.options;
    options.method = parse_method(method, "--methods");
    options = with_fitting_form(options);
    if (self && !tests_self(options.method)) {
      throw Error("--methods",
                  method + " tests no object against itself, as one of the scene has to be",
                  "give " + method_names([](const Traits& t) { return t.tests_self; }));
    }
    const bool far = fattens(options.method);
    for (const std::string& offset : far ? split_list(arguments.offsets) : Words{options.offset}) {
      options.offset = offset;
      for (const std::string& radius : far ? split_list(arguments.radii) : Words{"budget"}) {
        options.radius = parse_radius(radius);
        for (const int resolution : resolutions_of(arguments, options.method)) {
          options.resolution = resolution;
          validate(options);
          cells.push_back(options);
        }
      }
    }
  }
  const bool mixed = std::ranges::any_of(
      cells, [](const RunOptions& cell) { return fattens(cell.method) && !guaranteed(cell); });
  for (RunOptions& cell : cells) cell.no_shortcuts = mixed && fattens(cell.method);
  return cells;
}

// Throws Error if a resolution is too large for the device. Every device of OpenGL 4.3 supports
// 8192 px, so the device is opened only for larger resolutions.
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

std::string usual_methods(bool clearance, bool self) {
  return clearance ? "boxes,exact" : self ? "far,boxes,exact" : "far,cullide,boxes,exact";
}

std::vector<Compared> Comparison::rows() const {
  std::vector<Compared> out;
  for (const std::vector<Record>& repeats : runs) {
    std::vector<double> ms;
    for (const Record& record : repeats) ms.push_back(compared_ms(record));
    const Spread spread = spread_of(ms);
    out.push_back({repeats[median_run(ms)], spread.min, spread.max, ms.size()});
  }
  return out;
}

void validate(const CompareArguments& arguments) {
  if (arguments.repeat) parse_repeat(*arguments.repeat);
  cells_of(arguments, arguments.self);
}

Comparison compare(const Scene& scene, const CompareArguments& arguments,
                   const Progress& progress) {
  const int repeats = arguments.repeat ? parse_repeat(*arguments.repeat) : kUsualRepeats;
  const std::vector<RunOptions> cells = cells_of(arguments, has_self(scene));
  Comparison out;
  out.runs.resize(cells.size());
  Session session(arguments.options.device);
  require_room(cells, session);
  measure_in_turns(cells.size(), {.counted = repeats}, [&](std::size_t i, int round) {
    if (!arguments.repeat && round > 0 && compared_ms(out.runs[i].front()) > kLongMs) return 0.0;
    const std::string cell = describe(cells[i]) + ": ";
    const Progress named =
        progress ? [&](const ProgressStep& step) { progress(cell + text_of(step)); } : Progress{};
    out.runs[i].push_back(run(scene, cells[i], session, named));
    return compared_ms(out.runs[i].back());
  });
  for (std::vector<Record>& of : out.runs) {
    if (!arguments.risk) break;
    if (progress) progress("pairs at risk of " + describe(of.front().options));
    const std::optional<PairsAtRisk> risk = pairs_at_risk(scene, of.front(), session);
    for (Record& record : of) record.risk = risk;
  }
  return out;
}

nlohmann::ordered_json to_json(const Scene& scene, const Comparison& comparison) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::vector<Record>& repeats : comparison.runs) {
    for (const Record& record : repeats) rows.push_back(to_json(scene, record));
  }
  return {{"runs", rows}};
}

std::string comparison_csv(const Scene& scene, const std::vector<Compared>& rows) {
  std::string out =
      "scene,method,form,offset,radius,resolution,objects,triangles,candidates,colliding,"
      "neighbours,"
      "missed,at_risk,at_risk_bare,cull_ms,exact_ms,ms,least_ms,most_ms,runs\n";
  for (const Compared& row : rows) {
    const Record& r = row.record;
    const bool drew = r.found.drew(), fattened = drew && fattens(r.options.method);
    const auto text_if = [](bool has, const auto& value) {
      return has ? fmt::format("{}", value()) : "";
    };
    out += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{}\n",
        csv_cell(scene.name), to_string(r.options.method), csv_cell(form_text(r.options)),
        fattened ? r.options.offset : "", fattened ? radius_text(r.options.radius) : "",
        text_if(drew, [&] { return resolution_of(r.options); }), r.found.object_count,
        r.found.triangle_count, r.found.count, r.collisions.pairs.size(),
        r.collisions.neighbour_pairs.size(),
        text_if(r.verification.has_value(), [&] { return r.verification->false_negatives; }),
        text_if(r.risk.has_value(), [&] { return r.risk->at_risk; }),
        text_if(r.risk.has_value(), [&] { return r.risk->at_risk_bare; }), r.ms.cull, r.ms.exact,
        r.ms.cull + r.ms.exact, row.least_ms, row.most_ms, row.runs);
  }
  return out;
}

}  // namespace farcull
