// Runs the lemma experiment at one radius. Prints a table, and writes JSON.
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

Json numbers_json(const LemmaRow& row) {
  return {{"points", row.points},
          {"violations", row.violations()},
          {"no_sample", row.no_sample},
          {"not_bounding", row.not_bounding}};
}

std::string table_of(std::vector<LemmaRow> rows) {
  std::string out = fmt::format("{:<28} {:>12} {:>12} {:>12} {:>12} {:>10}\n", "generator",
                                "points", "no sample", "not bounding", "violations", "rate");
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

// A canvas and the session that made it. The canvas "worst" has no session.
struct LemmaCanvas {
  std::string name;  // native, gl or worst
  std::optional<Session> session;
  std::unique_ptr<WorstCanvas> worst;
  Canvas* canvas = nullptr;

  LemmaCanvas(const std::string& kind, const std::string& device, const Fattener& fattener) {
    if (kind == "worst") {
      name = "worst";
      worst = std::make_unique<WorstCanvas>(fattener.solid);
      canvas = worst.get();
      return;
    }
    session.emplace(kind.empty() || !device.empty() ? device : kind);
    canvas = &session->canvas(fattener, {});
    name = session->canvas_device().native ? "native" : "gl";
  }
  // Returns the GL device that draws; null for canvases other than gl.
  const GlInfo* info() { return name == "gl" ? &session->context().info() : nullptr; }
};

class LemmaCommand {
 public:
  CLI::App* add_to(CLI::App& experiment) {
    return add_command(
        experiment, "lemma", "the reliability lemmas on a canvas, decided in exact arithmetic",
        {{"--points", &points_, "N", "points in all; default 100000"},
         {"--radius", &radius_, "RADIUS",
          "budget, published, or a factor on the budget;\ndefault budget"},
         {"--canvas", &canvas_, "native|gl|worst",
          "native (the cores of the CPU), gl (a device), or worst\n(as bad as the assumptions "
          "allow); default gl where\n--device is given or hardware answers, else native"},
         {"--offset", &offset_, "OFFSET", "obb or exact; default obb"},
         {"--seed", &seed_, "N", "of the points; default 1"},
         {"--device", &device_, "DEVICE", kDeviceHelp},
         {"--json", &json_, "FILE", kJsonHelp}},
        "Examples:\n"
        "  farcull experiment lemma --points 1000000 --radius budget\n"
        "  farcull experiment lemma --radius published\n"
        "  farcull experiment lemma --canvas worst --radius 0.9999\n\n"
        "Exit status 1: a violation at the budget radius or beyond.");
  }
  int run() const {
    const Outputs outputs = checked({.json = json_}, {});
    const std::string device = device_of(device_);
    TerminalProgress terminal;
    const Progress progress = terminal.callback();
    if (points_ < 1 || points_ > 1'000'000'000'000) {
      throw Error("--points", fmt::format("{} is no number of points", points_), "give 1 to 1e12");
    }
    if (!canvas_.empty()) {
      word_of("--canvas", canvas_, {"native", "gl", "worst"}, "no canvas",
              "give native, gl or worst");
    }
    if (!device.empty() && canvas_ != "" && canvas_ != "gl") {
      throw Error("--device", "the " + canvas_ + " canvas needs no device",
                  "leave --device out, or use --canvas gl");
    }
    word_of("--offset", offset_, {"obb", "exact"}, "no offset", "give obb or exact");
    const RadiusRule rule = parse_radius(radius_);
    const Fattener fattener = offset_ == "exact" ? minkowski_fattener() : obb_fattener();
    LemmaCanvas on(canvas_, device, fattener);
    const Stopwatch watch;
    LemmaSettings settings;
    settings.points = points_;
    settings.seed = seed_;
    // Displaces drawn triangles by the largest error of double arithmetic. Does not displace them
    // for GL, since the errors of GL itself are larger.
    settings.displace = on.name != "gl";
    settings.radius = [&rule](const Budget& budget, double step) {
      return lemma_radius(rule, budget, step);
    };
    const std::string name = rule.published ? "published" : fmt::format("{}", rule.factor);
    const auto named = [&](const ProgressStep& step) {
      progress("radius " + name + ", " + text_of(step));
    };
    const std::vector<LemmaRow> rows =
        lemma_experiment(*on.canvas, fattener, settings, progress ? named : Progress{});
    const double seconds = watch.ms() / 1000;
    terminal.clear();
    if (outputs.json) write_json(to_json(on, rule, seconds, rows), *outputs.json);
    if (!outputs.to_stdout()) {
      print(fmt::format("canvas {}, offset {}, {}\n\nradius {}\n{}\ntook {:.1f} s\n", on.name,
                        offset_,
                        on.name == "gl"       ? on.info()->renderer
                        : on.name == "native" ? "lanes of " + lane_target()
                                              : "no device",
                        name, table_of(rows), seconds));
    }
    const bool guaranteed = !rule.published && rule.factor >= 1;
    return guaranteed && lemma_total(rows).violations() > 0 ? kExitBroken : kExitDone;
  }

 private:
  Json to_json(LemmaCanvas& on, const RadiusRule& rule, double seconds,
               const std::vector<LemmaRow>& rows) const {
    Json device;
    if (const GlInfo* gl = on.info())
      device = {{"vendor", gl->vendor}, {"renderer", gl->renderer}, {"version", gl->version}};
    const bool native = on.name == "native";
    Json out = {{"experiment", "lemma"},
                {"canvas", on.name},
                {"offset", offset_},
                {"device", device},
                {"subpixel_bits", native ? Json() : Json(on.canvas->limits().subpixel_bits)},
                {"lanes", native ? Json(lane_target()) : Json()},
                {"seed", seed_},
                {"seconds", seconds},
                {"commit", FARCULL_COMMIT},
                {"radius", rule.published ? Json("published") : Json(rule.factor)}};
    out.update(numbers_json(lemma_total(rows)));
    out["generators"] = Json::array();
    for (const LemmaRow& row : rows) {
      Json& one = out["generators"].emplace_back(Json{{"generator", row.generator}});
      one.update(numbers_json(row));
    }
    return out;
  }

  std::uint64_t points_ = 100000, seed_ = 1;
  std::string radius_ = "budget", offset_ = "obb";
  std::string canvas_;  // empty: the canvas that --device implies
  Text device_, json_;
};

}  // namespace

Command add_lemma(CLI::App& experiment) { return declare<LemmaCommand>(experiment); }

}  // namespace farcull
