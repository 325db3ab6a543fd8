#include "experiments/lemma_command.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commit.h"
#include "core/error.h"
#include "core/gl_canvas.h"
#include "experiments/lemma.h"
#include "experiments/output.h"
#include "experiments/run.h"
#include "offsets/exact.h"
#include "offsets/obb.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

struct Sweep {
  double from, to, step;
  int count() const { return static_cast<int>(std::floor((to - from) / step + 1e-9)) + 1; }
  double at(int i) const { return from + i * step; }
};

Sweep parse_sweep(const std::string& text) {
  double values[3];
  const char* at = text.data();
  const char* end = text.data() + text.size();
  for (int i = 0; i < 3; ++i) {
    const auto [next, code] = std::from_chars(at, end, values[i]);
    const bool last = i == 2;
    if (code != std::errc() || !std::isfinite(values[i]) ||
        (last ? next != end : next == end || *next != ':')) {
      throw Error("--sweep", "'" + text + "' is no sweep",
                  "give FROM:TO:STEP of the radius factor, such as 0.5:1.1:0.01");
    }
    at = next + 1;
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

Json row_json(const LemmaRow& row) {
  return {{"generator", row.generator},
          {"points", row.points},
          {"violations", row.violations()},
          {"no_sample", row.no_sample},
          {"not_bounding", row.not_bounding}};
}

Json result_json(const Result& result) {
  const LemmaRow total = lemma_total(result.rows);
  Json rows = Json::array();
  for (const LemmaRow& row : result.rows) rows.push_back(row_json(row));
  return {{"radius", result.rule.published ? Json("published") : Json(result.rule.factor)},
          {"points", total.points},
          {"violations", total.violations()},
          {"no_sample", total.no_sample},
          {"not_bounding", total.not_bounding},
          {"generators", rows}};
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
  std::string out = "factor,generator,points,violations,no_sample,not_bounding\n";
  for (const Result& result : results) {
    std::vector<LemmaRow> rows = result.rows;
    rows.push_back(lemma_total(rows));
    for (const LemmaRow& row : rows) {
      out += fmt::format("{},{},{},{},{},{}\n", result.rule.factor, row.generator, row.points,
                         row.violations(), row.no_sample, row.not_bounding);
    }
  }
  return out;
}

// The smallest factor of the sweep from which on no point was violated.
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

}  // namespace

int lemma_command(const LemmaArguments& arguments, const Progress& progress,
                  const std::function<void()>& done) {
  if (arguments.points < 1 || arguments.points > 1'000'000'000'000) {
    throw Error("--points", fmt::format("{} is no number of points", arguments.points),
                "give 1 to 1e12");
  }
  if (arguments.canvas != "gl" && arguments.canvas != "worst") {
    throw Error("--canvas", "'" + arguments.canvas + "' is no canvas", "give gl or worst");
  }
  if (arguments.offset != "obb" && arguments.offset != "exact") {
    throw Error("--offset", "'" + arguments.offset + "' is no offset", "give obb or exact");
  }
  if (!arguments.csv.empty() && arguments.sweep.empty()) {
    throw Error("--csv", "there is a table to write only with --sweep",
                "add --sweep 0.5:1.1:0.01, or use --json");
  }
  std::vector<RadiusRule> rules;
  if (arguments.sweep.empty()) {
    rules.push_back(parse_radius(arguments.radius));
  } else {
    const Sweep sweep = parse_sweep(arguments.sweep);
    for (int i = 0; i < sweep.count(); ++i)
      rules.push_back({.published = false, .factor = sweep.at(i)});
  }

  const Fattener fattener = arguments.offset == "exact" ? exact_fattener() : obb_fattener();
  const bool worst = arguments.canvas == "worst";
  std::unique_ptr<GlContext> context;
  std::unique_ptr<Canvas> canvas;
  if (worst) {
    canvas = std::make_unique<WorstCanvas>(fattener.solid);
  } else {
    context = std::make_unique<GlContext>(arguments.device);
    canvas = std::make_unique<GlCanvas>(*context, fattener.mode, fattener.solid);
  }

  std::vector<Result> results;
  std::uint64_t broken = 0;
  for (const RadiusRule& rule : rules) {
    LemmaSettings settings;
    settings.points = arguments.points;
    settings.seed = arguments.seed;
    settings.displace = worst;
    settings.radius = [&rule](const Budget& budget, double step) {
      return rule.published ? published_radius(step) : rule.factor * budget.radius();
    };
    const Progress named =
        progress ? [&](const std::string&
                           text) { progress("radius " + radius_name(rule) + ", " + text); }
                 : Progress{};
    results.push_back({rule, lemma_experiment(*canvas, fattener, settings, named)});
    if (!rule.published && rule.factor >= 1)
      broken += lemma_total(results.back().rows).violations();
  }
  done();

  const std::optional<double> safe = smallest_safe(results);
  if (!arguments.json.empty()) {
    Json out = {{"experiment", "lemma"},
                {"canvas", arguments.canvas},
                {"offset", arguments.offset},
                {"device", worst ? Json(nullptr)
                                 : Json{{"vendor", context->info().vendor},
                                        {"renderer", context->info().renderer},
                                        {"version", context->info().version}}},
                {"subpixel_bits", canvas->limits().subpixel_bits},
                {"seed", arguments.seed},
                {"commit", FARCULL_COMMIT}};
    if (arguments.sweep.empty()) {
      out.update(result_json(results.front()));
    } else {
      out["sweep"] = Json::array();
      for (const Result& result : results) out["sweep"].push_back(result_json(result));
      out["smallest_factor_without_violation"] = safe ? Json(*safe) : Json(nullptr);
    }
    write_output(arguments.json, out.dump(2) + "\n");
  }
  if (!arguments.csv.empty()) write_output(arguments.csv, sweep_csv(results));
  if (arguments.json != "-" && arguments.csv != "-") {
    std::string text =
        fmt::format("canvas {}, offset {}, {}\n\n", arguments.canvas, arguments.offset,
                    worst ? "no device" : context->info().renderer);
    if (arguments.sweep.empty()) {
      text += "radius " + radius_name(rules.front()) + "\n" + result_table(results.front());
    } else {
      text += fmt::format("{:>10} {:>12} {:>12} {:>12} {:>12}\n", "factor", "points", "no sample",
                          "not bounding", "violations");
      for (const Result& result : results) {
        const LemmaRow total = lemma_total(result.rows);
        text += fmt::format("{:>10.6g} {:>12} {:>12} {:>12} {:>12}\n", result.rule.factor,
                            total.points, total.no_sample, total.not_bounding, total.violations());
      }
      text +=
          safe ? fmt::format(
                     "\nno violation from the factor {:.6g} on: the budget's slack is {:.4g} %\n",
                     *safe, 100 * (1 - *safe))
               : "\nthe last factor still has violations\n";
    }
    write_output("-", text);
  }
  return broken > 0 ? 1 : 0;
}

}  // namespace farcull
