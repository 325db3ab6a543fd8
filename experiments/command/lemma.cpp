// Runs the lemma experiment at one radius or along a sweep; prints a table, writes JSON and CSV.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string_view>

#include "commit.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "core/native/lanes.h"
#include "experiments/command/command.h"
#include "experiments/lemma/lemma.h"
#include "experiments/method/run.h"
#include "experiments/record/output.h"
#include "experiments/record/stage_words.h"
#include "experiments/system/output_file.h"
#include "offsets/offsets.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

struct LemmaArguments {
  std::uint64_t points = 100000;
  std::string radius = "budget";  // budget, published or a factor
  std::string sweep;              // FROM:TO:STEP of the factor; then `radius` is not used
  // native, gl or worst; empty: the canvas of `device`, or, without a device, gl if hardware
  // answers and passes its probes, else native.
  std::string canvas;
  std::string offset = "obb";  // obb or exact
  std::string device;
  std::uint64_t seed = 1;
  Outputs outputs = {};  // csv: for a sweep
};

struct Sweep {
  double from, to, step;
  int count() const { return static_cast<int>(std::floor((to - from) / step + 1e-9)) + 1; }
  double at(int i) const { return from + i * step; }
};

Sweep parse_sweep(const std::string& text) {
  double values[3] = {};
  std::string_view rest = text;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> value = take_number<double>(rest);
    const bool last = i == 2;
    if (!value || !std::isfinite(*value) || (last ? !rest.empty() : !rest.starts_with(':'))) {
      throw Error("--sweep", "'" + text + "' is no sweep",
                  "give FROM:TO:STEP of the radius factor, such as 0.5:1.1:0.01");
    }
    values[i] = *value;
    if (!last) rest.remove_prefix(1);
  }
  const Sweep sweep{values[0], values[1], values[2]};
  if (sweep.from < 0 || sweep.to < sweep.from || sweep.step <= 0 ||
      (sweep.to - sweep.from) / sweep.step > 100000) {
    throw Error("--sweep",
                "'" + text + "' does not ascend from 0 or more in at most 100000 positive steps",
                "give FROM:TO:STEP, such as 0.5:1.1:0.01");
  }
  return sweep;
}

std::string radius_name(const RadiusRule& rule) {
  return rule.published ? "published" : fmt::format("{}", rule.factor);
}

struct Result {
  RadiusRule rule;
  std::vector<LemmaRow> rows;
};

// The numbers of a row in the output.
struct WrittenRow {
  std::uint64_t points = 0, violations = 0, no_sample = 0, not_bounding = 0;
  FARCULL_FIELDS(points, violations, no_sample, not_bounding)
};
WrittenRow written(const LemmaRow& row) {
  return {row.points, row.violations(), row.no_sample, row.not_bounding};
}

Json result_json(const Result& result) {
  Json out = {{"radius", result.rule.published ? Json("published") : Json(result.rule.factor)}};
  out.update(json_of(written(lemma_total(result.rows))));
  out["generators"] = Json::array();
  for (const LemmaRow& row : result.rows) {
    Json& one = out["generators"].emplace_back(Json{{"generator", row.generator}});
    one.update(json_of(written(row)));
  }
  return out;
}

std::string result_table(const Result& result) {
  std::string out = fmt::format("{:<28} {:>12} {:>12} {:>12} {:>12} {:>10}\n", "generator",
                                "points", "no sample", "not bounding", "violations", "rate");
  std::vector<LemmaRow> rows = result.rows;
  rows.push_back(lemma_total(rows));
  for (const LemmaRow& row : rows) {
    out += fmt::format(
        "{:<28} {:>12} {:>12} {:>12} {:>12} {:>9.3f}%\n", row.generator, row.points, row.no_sample,
        row.not_bounding, row.violations(),
        row.points ? 100.0 * static_cast<double>(row.violations()) / static_cast<double>(row.points)
                   : 0.0);
  }
  return out;
}

std::string sweep_csv(const std::vector<Result>& results) {
  std::string out = fmt::format("factor,generator,{}\n", fmt::join(field_names<WrittenRow>(), ","));
  for (const Result& result : results) {
    std::vector<LemmaRow> rows = result.rows;
    rows.push_back(lemma_total(rows));
    for (const LemmaRow& row : rows) {
      out += fmt::format("{},{},{}\n", result.rule.factor, row.generator, csv_of(written(row)));
    }
  }
  return out;
}

// The smallest factor of the sweep such that neither it nor a later one has a violation.
std::optional<double> smallest_safe(const std::vector<Result>& results) {
  std::optional<double> out;
  for (const Result& result : results) {
    if (lemma_total(result.rows).violations() > 0) {
      out.reset();
    } else if (!out) {
      out = result.rule.factor;
    }
  }
  return out;
}

void validate(const LemmaArguments& arguments) {
  if (arguments.points < 1 || arguments.points > 1'000'000'000'000) {
    throw Error("--points", fmt::format("{} is no number of points", arguments.points),
                "give 1 to 1e12");
  }
  const std::string& canvas = arguments.canvas;
  if (!canvas.empty())
    word_of("--canvas", canvas, {"native", "gl", "worst"}, "no canvas", "give native, gl or worst");
  if (!arguments.device.empty() && canvas != "" && canvas != "gl") {
    throw Error("--device", "the " + canvas + " canvas needs no device",
                "leave --device out, or use --canvas gl");
  }
  word_of("--offset", arguments.offset, {"obb", "exact"}, "no offset", "give obb or exact");
  if (arguments.outputs.csv && arguments.sweep.empty()) {
    throw Error("--csv", "there is a table to write only with --sweep",
                "add --sweep 0.5:1.1:0.01, or use --json");
  }
}

std::vector<RadiusRule> rules_of(const LemmaArguments& arguments) {
  if (arguments.sweep.empty()) return {parse_radius(arguments.radius)};
  const Sweep sweep = parse_sweep(arguments.sweep);
  std::vector<RadiusRule> out;
  for (int i = 0; i < sweep.count(); ++i)
    out.push_back({.published = false, .factor = sweep.at(i)});
  return out;
}

// A canvas with the session that it needs; the worst canvas needs none.
struct LemmaCanvas {
  std::string name;  // native, gl or worst
  std::optional<Session> session;
  std::unique_ptr<WorstCanvas> worst;
  Canvas* canvas = nullptr;

  LemmaCanvas(const LemmaArguments& arguments, const Fattener& fattener) {
    if (arguments.canvas == "worst") {
      name = "worst";
      worst = std::make_unique<WorstCanvas>(fattener.solid);
      canvas = worst.get();
      return;
    }
    const bool named = arguments.canvas.empty() || !arguments.device.empty();
    session.emplace(named ? arguments.device : arguments.canvas);
    canvas = &session->canvas(fattener, {});
    name = session->canvas_device().native ? "native" : "gl";
  }
  // The GL device that draws; null for the others.
  const GlInfo* device() { return name == "gl" ? &session->context().info() : nullptr; }
};

// displaced: errors as large as those of doubles are added to what is drawn. For canvases that add
// no errors of their own, which would hide these.
Result measure(const LemmaArguments& arguments, const RadiusRule& rule, Canvas& canvas,
               bool displaced, const Fattener& fattener, const Progress& progress) {
  LemmaSettings settings;
  settings.points = arguments.points;
  settings.seed = arguments.seed;
  settings.displace = displaced;
  settings.radius = [&rule](const Budget& budget, double step) {
    return lemma_radius(rule, budget, step);
  };
  const std::string before = "radius " + radius_name(rule) + ", ";
  const Progress named =
      progress ? [&](const ProgressStep& step) { progress(before + text_of(step)); } : Progress{};
  return {rule, lemma_experiment(canvas, fattener, settings, named)};
}

Json to_json(const LemmaArguments& arguments, LemmaCanvas& on, double seconds,
             const std::vector<Result>& results) {
  Json device;
  if (const GlInfo* info = on.device())
    device = {{"vendor", info->vendor}, {"renderer", info->renderer}, {"version", info->version}};
  Json out = {{"experiment", "lemma"},
              {"canvas", on.name},
              {"offset", arguments.offset},
              {"device", device},
              {"subpixel_bits",
               on.name == "native" ? Json(nullptr) : Json(on.canvas->limits().subpixel_bits)},
              {"lanes", on.name == "native" ? Json(lane_target()) : Json(nullptr)},
              {"seed", arguments.seed},
              {"seconds", seconds},
              {"commit", FARCULL_COMMIT}};
  if (arguments.sweep.empty()) {
    out.update(result_json(results.front()));
  } else {
    out["sweep"] = Json::array();
    for (const Result& result : results) out["sweep"].push_back(result_json(result));
    out["smallest_factor_without_violation"] = json_of(smallest_safe(results));
  }
  return out;
}

std::string sweep_table(const std::vector<Result>& results) {
  std::string text = fmt::format("{:>10} {:>12} {:>12} {:>12} {:>12}\n", "factor", "points",
                                 "no sample", "not bounding", "violations");
  for (const Result& result : results) {
    const LemmaRow total = lemma_total(result.rows);
    text += fmt::format("{:>10.6g} {:>12} {:>12} {:>12} {:>12}\n", result.rule.factor, total.points,
                        total.no_sample, total.not_bounding, total.violations());
  }
  const std::optional<double> safe = smallest_safe(results);
  if (!safe) return text + "\nthe last factor still has violations\n";
  return text +
         fmt::format("\nno violation from the factor {:.6g} on: the budget's slack is {:.4g} %\n",
                     *safe, 100 * (1 - *safe));
}

std::string text_of(const LemmaArguments& arguments, LemmaCanvas& on, double seconds,
                    const std::vector<Result>& results) {
  const std::string where = on.name == "gl"       ? on.device()->renderer
                            : on.name == "native" ? "lanes of " + lane_target()
                                                  : "no device";
  const std::string heading =
      fmt::format("canvas {}, offset {}, {}\n\n", on.name, arguments.offset, where);
  const std::string took = fmt::format("\ntook {:.1f} s\n", seconds);
  if (!arguments.sweep.empty()) return heading + sweep_table(results) + took;
  return heading + "radius " + radius_name(results.front().rule) + "\n" +
         result_table(results.front()) + took;
}

class LemmaCommand {
 public:
  CLI::App* add_to(CLI::App& experiment);
  int run();

 private:
  LemmaArguments arguments_;
  Text device_;
};

CLI::App* LemmaCommand::add_to(CLI::App& experiment) {
  return add_command(
      experiment, "lemma", "the reliability lemmas on a canvas, decided in exact arithmetic",
      {{"--points", &arguments_.points, "N", "points in all; default 100000"},
       {"--radius", &arguments_.radius, "RADIUS",
        "budget, published, or a factor on the budget;\ndefault budget"},
       {"--sweep", &arguments_.sweep, "SWEEP", "instead: factors FROM:TO:STEP, as in 0.5:1.1:0.01"},
       {"--canvas", &arguments_.canvas, "native|gl|worst",
        "native (the cores of the CPU), gl (a device), or worst\n(as bad as the assumptions "
        "allow); default gl where\n--device is given or hardware answers, else native"},
       {"--offset", &arguments_.offset, "OFFSET", "obb or exact; default obb"},
       {"--seed", &arguments_.seed, "N", "of the points; default 1"},
       {"--device", &device_, "DEVICE", kDeviceHelp},
       {"--json", &arguments_.outputs.json, "FILE", kJsonHelp},
       {"--csv", &arguments_.outputs.csv, "FILE",
        "write the sweep as CSV to this file; - for standard\noutput"}},
      "Examples:\n"
      "  farcull experiment lemma --points 1000000 --radius budget\n"
      "  farcull experiment lemma --radius published\n"
      "  farcull experiment lemma --canvas worst --sweep 0.5:1.1:0.01 --csv sweep.csv\n\n"
      "Exit status 1: a violation at the budget radius or beyond.");
}

// Prints the rows; writes --json and --csv.
int LemmaCommand::run() {
  LemmaArguments& arguments = arguments_;
  const Outputs outputs = arguments.outputs = checked(arguments.outputs, {});
  arguments.device = device_of(device_);
  TerminalProgress terminal;
  const Progress progress = terminal.callback();
  validate(arguments);
  const std::vector<RadiusRule> rules = rules_of(arguments);
  const Fattener fattener = arguments.offset == "exact" ? minkowski_fattener() : obb_fattener();
  LemmaCanvas on(arguments, fattener);
  const Stopwatch watch;
  std::vector<Result> results;
  bool broken = false;
  for (const RadiusRule& rule : rules) {
    results.push_back(measure(arguments, rule, *on.canvas, on.name != "gl", fattener, progress));
    const bool promises = !rule.published && rule.factor >= 1;
    broken = broken || (promises && lemma_total(results.back().rows).violations() > 0);
  }
  const double seconds = watch.ms() / 1000;
  terminal.clear();
  if (outputs.json) write_json(to_json(arguments, on, seconds, results), *outputs.json);
  if (outputs.csv) write_output(*outputs.csv, sweep_csv(results));
  if (!outputs.to_stdout()) write_output("-", text_of(arguments, on, seconds, results));
  return broken ? 1 : 0;
}

}  // namespace

Command add_lemma(CLI::App& experiment) { return declare<LemmaCommand>(experiment); }

}  // namespace farcull
