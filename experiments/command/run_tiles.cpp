// `farcull run --tiles K/N` and `farcull plan --tiles N`.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/command/run.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/output_file.h"
#include "experiments/tiles/run_tile.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

// The path of the file, relative to the folder of the record.
std::string beside(const std::string& file, const std::string& record) {
  // Of folders behind links, `..` is not the one that the path names.
  const fs::path folder = fs::weakly_canonical(fs::absolute(record).parent_path());
  const fs::path path = fs::absolute(file);
  return (fs::weakly_canonical(path.parent_path()) / path.filename())
      .lexically_proximate(folder)
      .string();
}

// A record is UTF-8.
void require_text(const std::string& option, const std::string& file) {
  try {
    static_cast<void>(nlohmann::json(file).dump());
  } catch (const nlohmann::json::exception&) {
    throw Error(option, "the name of the file is no UTF-8, and the record has to hold it",
                "choose another name");
  }
}

}  // namespace

SceneSource RunCommand::source() const {
  return [this](const TakePart& take) {
    return stream_scene(scene_, [&](Scene& part) {
      if (options_.has("self")) make_self(part);
      take(part);
    });
  };
}

void RunCommand::refuse_with_tiles(const RunOptions& options) const {
  const auto refuse = [](const std::string& option, bool given, const std::string& why) {
    if (!given) return;
    throw Error(option, "cannot be answered in tiles: " + why,
                "leave " + option + " or --tiles out");
  };
  if (options.method != Method::far_pairs) {
    throw Error("--tiles",
                "are of far-pairs: " + to_string(options.method) + " looks at all of a scene",
                "leave --tiles out, or use --method far-pairs");
  }
  refuse("--frames", frames_.has_value(), "a tile is of a scene that stands still");
  refuse("--certificate", outputs_.certificate.has_value(), "a certificate is about a whole scene");
  refuse("--limit", options_.has("limit"), "no tile knows how many pairs the others have");
}

int RunCommand::run_tile(const RunOptions& options) const {
  TileQuestion question{.options = options, .tile = parse_tile(*tiles_)};
  refuse_with_tiles(options);
  refuse_outputs();
  const Outputs outputs = checked(outputs_, read_files());
  const PairColumns chosen = columns();
  if (outputs.pairs && outputs.json) require_text("--pairs", *outputs.pairs);
  if (const std::vector<IgnoredNames> names = ignored(); !names.empty())
    question.ignored = [names](const Scene& scene) { return ignored_objects(scene, names); };
  TerminalProgress terminal;
  const Progress progress = terminal.callback();
  Session session(options.device);
  const TileRun tile = farcull::run_tile(source(), question, session, progress);
  terminal.clear();
  std::optional<TileList> list;
  if (outputs.pairs) {
    list = TileList{.text = tile_list(tile, chosen), .file = {}, .columns = chosen};
    write_output(*outputs.pairs, list->text);
    const bool both = outputs.json && *outputs.json != "-" && *outputs.pairs != "-";
    if (both) list->file = beside(*outputs.pairs, *outputs.json);
    if (!both) list.reset();
  }
  if (outputs.json) write_json(tile_json(tile, list ? &*list : nullptr), *outputs.json);
  if (!outputs.to_stdout())
    write_output("-", run_table(tile.part.scene, tile.record) + tile_lines(tile) +
                          nothing_note(nothing_to_test(tile.census), with_self()));
  if (!broken(tile.record, false)) return kExitDone;
  complain_broken(missed(tile.record));
  return kExitBroken;
}

int RunCommand::plan_tiles(const RunOptions& options) const {
  const std::size_t tiles = parse_tiles(*tiles_);
  refuse_with_tiles(options);
  const Outputs outputs = checked(outputs_, read_files());
  TerminalProgress terminal;
  if (const Progress progress = terminal.callback()) progress("reading the scene");
  const std::vector<IgnoredNames> names = ignored();
  const Census census = take_census(source(), options.clearance, !names.empty());
  if (!names.empty())
    ignored_objects(names_of(census), names);  // throws if a name matches no object
  const Cuts cuts = choose_cuts(census, tiles);
  const std::vector<TileCount> counts = count_tiles(source(), cuts, options.clearance);
  terminal.clear();
  if (outputs.json) write_json(tiles_json(census, cuts, counts), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", tiles_table(census, cuts, counts));
  return kExitDone;
}

}  // namespace farcull
