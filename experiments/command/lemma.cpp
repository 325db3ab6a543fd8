// Runs the lemma experiment at one radius; prints a table, writes JSON.
#include <fmt/format.h>

#include "commit.h"
#include "core/base/stopwatch.h"
#include "core/native/canvas.h"
#include "experiments/command/command.h"
#include "experiments/lemma/lemma.h"
#include "experiments/record/output.h"
#include "experiments/record/stage_words.h"
#include "offsets/offsets.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

struct LemmaArguments {
  std::uint64_t points = 100000;
  std::string radius = "budget";  // budget, published or a factor
  // native, gl or worst; empty: the canvas of `device`, or, without a device, gl if hardware
  // answers and passes its probes, else native.
  std::string canvas;
  std::string offset = "obb";  // obb or exact
  std::string device;
  std::uint64_t seed = 1;
  Outputs outputs = {};
};

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

// displaced: what is drawn gets errors as large as those of doubles. Only for canvases without
// errors of their own, which would hide these errors.
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
             const Result& result) {
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
  out.update(result_json(result));
  return out;
}

std::string text_of(const LemmaArguments& arguments, LemmaCanvas& on, double seconds,
                    const Result& result) {
  const std::string where = on.name == "gl"       ? on.device()->renderer
                            : on.name == "native" ? "lanes of " + lane_target()
                                                  : "no device";
  const std::string heading =
      fmt::format("canvas {}, offset {}, {}\n\n", on.name, arguments.offset, where);
  return heading + "radius " + radius_name(result.rule) + "\n" + result_table(result) +
         fmt::format("\ntook {:.1f} s\n", seconds);
}

class LemmaCommand {
 public:
  CLI::App* add_to(CLI::App& experiment) {
    return add_command(
        experiment, "lemma", "the reliability lemmas on a canvas, decided in exact arithmetic",
        {{"--points", &arguments_.points, "N", "points in all; default 100000"},
         {"--radius", &arguments_.radius, "RADIUS",
          "budget, published, or a factor on the budget;\ndefault budget"},
         {"--canvas", &arguments_.canvas, "native|gl|worst",
          "native (the cores of the CPU), gl (a device), or worst\n(as bad as the assumptions "
          "allow); default gl where\n--device is given or hardware answers, else native"},
         {"--offset", &arguments_.offset, "OFFSET", "obb or exact; default obb"},
         {"--seed", &arguments_.seed, "N", "of the points; default 1"},
         {"--device", &device_, "DEVICE", kDeviceHelp},
         {"--json", &arguments_.outputs.json, "FILE", kJsonHelp}},
        "Examples:\n"
        "  farcull experiment lemma --points 1000000 --radius budget\n"
        "  farcull experiment lemma --radius published\n"
        "  farcull experiment lemma --canvas worst --radius 0.9999\n\n"
        "Exit status 1: a violation at the budget radius or beyond.");
  }
  // Prints the rows; writes --json.
  int run() {
    LemmaArguments& arguments = arguments_;
    const Outputs outputs = arguments.outputs = checked(arguments.outputs, {});
    arguments.device = device_of(device_);
    TerminalProgress terminal;
    const Progress progress = terminal.callback();
    validate(arguments);
    const RadiusRule rule = parse_radius(arguments.radius);
    const Fattener fattener = arguments.offset == "exact" ? minkowski_fattener() : obb_fattener();
    LemmaCanvas on(arguments, fattener);
    const Stopwatch watch;
    const Result result = measure(arguments, rule, *on.canvas, on.name != "gl", fattener, progress);
    const bool guaranteed = !rule.published && rule.factor >= 1;
    const double seconds = watch.ms() / 1000;
    terminal.clear();
    if (outputs.json) write_json(to_json(arguments, on, seconds, result), *outputs.json);
    if (!outputs.to_stdout()) print(text_of(arguments, on, seconds, result));
    return guaranteed && lemma_total(result.rows).violations() > 0 ? kExitBroken : kExitDone;
  }

 private:
  LemmaArguments arguments_;
  Text device_;
};

}  // namespace

Command add_lemma(CLI::App& experiment) { return declare<LemmaCommand>(experiment); }

}  // namespace farcull
