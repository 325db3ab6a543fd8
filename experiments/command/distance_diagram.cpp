// Reads the options of a diagram, then asks it about the scene.
#include "experiments/command/distance_diagram.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/base/count.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/scene.h"
#include "experiments/method/distances.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/output_file.h"

namespace farcull {

void DiagramArguments::add_to(CLI::App& command) {
  add_option(command, "--voronoi", diagram_, "FORM",
             "which objects may be nearest by a discrete Voronoi\n"
             "diagram, and which nearest ones it loses, instead of\n"
             "distances: published or reliable (docs/voronoi.md)");
  add_option(command, "--resolution", resolution_, "N",
             "with --voronoi: cells of the diagram along the\n"
             "longest side of the scene; default 64");
  add_option(command, "--device", device_, "DEVICE",
             "with --voronoi: native (alias cpu) or a GL device:\n"
             "gl, software, hardware or a number that farcull doctor\n"
             "lists; default native");
}

bool DiagramArguments::asked() const {
  if (diagram_) return true;
  for (const auto& [option, given] : {std::pair("--resolution", resolution_.has_value()),
                                      std::pair("--device", device_.has_value())}) {
    if (given)
      throw Error(option, "has no meaning without --voronoi",
                  "add --voronoi published or reliable, or leave it out");
  }
  return false;
}

DiagramOptions DiagramArguments::parse(unsigned threads) const {
  DiagramOptions out{.threads = threads, .device = device_of(device_)};
  if (*diagram_ == "reliable") {
    out.form = DiagramForm::reliable;
  } else if (*diagram_ != "published") {
    throw Error("--voronoi", "'" + *diagram_ + "' is no choice", "give published or reliable");
  }
  if (resolution_) {
    const std::optional<int> cells = parse_number<int>(*resolution_);
    if (!cells || *cells < 1 || *cells > kVoronoiLargest)
      throw Error("--resolution", "'" + *resolution_ + "' is no number of cells",
                  fmt::format("give 1 to {}", kVoronoiLargest));
    out.resolution = *cells;
  }
  return out;
}

int run_diagram(const std::vector<std::string>& words, const DiagramOptions& options,
                const Outputs& outputs) {
  TerminalProgress terminal;
  const Progress progress = terminal.callback();
  if (progress) progress("reading the scene");
  const Scene scene = load_scene(words);
  require_nothing_ignored(scene, "farcull distance");
  const std::string nothing = nothing_asked(scene, {.pairs = DistancePairs::nearest});
  if (!nothing.empty()) throw Error("SCENE", nothing, "name two objects or more");
  const DiagramRecord record = potential_neighbours(scene, options, progress);
  terminal.clear();
  if (outputs.csv) write_output(*outputs.csv, diagram_csv(scene, record));
  if (outputs.json) write_json(diagram_json(scene, record, seed_of(words)), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", diagram_table(scene, record));
  const DiagramTotals totals = totals_of(record);
  if (options.form == DiagramForm::published || totals.lost == 0) return kExitDone;
  complain_broken("the reliable diagram lost " +
                  counted(totals.lost, "nearest object", "nearest objects"));
  return kExitBroken;
}

}  // namespace farcull
