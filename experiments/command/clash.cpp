// `farcull clash` finds which parts of an assembly clash. This file reads the options, and prints
// the record of clashes().
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/stopwatch.h"
#include "experiments/command/command.h"
#include "experiments/measure/frames.h"
#include "experiments/method/clash.h"
#include "experiments/record/output.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples =
    "Examples:\n"
    "  farcull clash parts/\n"
    "  farcull clash parts/*.stl --clearance 0.5 --unit mm --csv clashes.csv\n"
    "  farcull clash house/ --tolerance '1e-9*size'    # rounded coordinates clash no more\n"
    "  farcull clash house/ --only 'pipe*:wall*' --compare old.csv --csv new.csv\n"
    "  farcull clash robot.json --ignore 'link*:base,hand:cup' --fail-on clash,touch\n"
    "  farcull clash 'arm_%04d.obj' wall.obj --frames 1:100 --csv clashes.csv\n"
    "  farcull clash a.obj b.obj --depth --json - | jq '.pairs[0].depth'\n\n"
    "Each pair of parts has a verdict, the most serious first:\n"
    "  clash      the surfaces cross, the insides overlap, or the parts meet and it is not\n"
    "             proved that they touch only\n"
    "  contained  one part, or a piece of it, is inside the other\n"
    "  unknown    may be contained, but the outer part is not closed, or it is not certain\n"
    "             what its faces enclose\n"
    "  touch      they meet, and it is proved that they do not overlap\n"
    "  near       they are at most the clearance apart\n"
    "  clear      none of these\n"
    "With --tolerance, touch is also said of parts whose depth is proved to be the tolerance or\n"
    "less, and of parts that are so near. What they are exactly is in the column exact.\n"
    "All coordinates are taken as the files have them, so all parts have to be in one unit.\n"
    "depth (with --depth): bounds of the shortest way by which one part has to move so that\n"
    "closed parts no longer overlap; the true one lies between. curve: length of the curve in\n"
    "which the surfaces cross. docs/clash.md has the columns and the proofs.\n"
    "A comma, colon or * that is part of a name is written with \\ before it, as in 'a\\,b:c'.\n\n"
    "Exit status 0: no pair has a verdict of --fail-on, in any frame. 1: one has; also if a pair\n"
    "was not examined, since a part has no triangles. 2: the input or an option is wrong.";

constexpr std::size_t kMostBytes = std::size_t{1} << 31;           // largest file of --compare
constexpr const char* kNoTriangles = "the mesh has no triangles";  // Error::reason of load_mesh()

// Reads the parts. A mesh without triangles becomes an empty part. Empty parts come after all
// others.
Scene read_parts(SceneArguments files) {
  std::vector<std::string> empty;
  for (;;) {
    try {
      Scene scene = read_scene(files);
      const auto end = static_cast<std::uint32_t>(scene.triangles.size());
      for (const std::string& file : empty)
        scene.objects.push_back(
            {.name = clean_name(file), .first_triangle = end, .triangle_count = 0});
      return scene;
    } catch (const Error& error) {
      const auto at = std::ranges::find(files.names, error.where);
      if (error.reason != kNoTriangles || at == files.names.end() || files.names.size() < 2) throw;
      empty.push_back(*at);
      files.names.erase(at);
      take_reading_notes();  // discards the notes: the next attempt repeats them
    }
  }
}

class ClashCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "clash", "which parts clash, touch or are too near, one row for each pair",
        scene_rows(
            scene_, "PARTS",
            "a folder of mesh files, with the folders in it; or\n" + std::string(kSceneHelp)) +
            Rows{
                {"--clearance", &clearance_, "D",
                 "parts at this distance or less are near, in world\nunits; default 0"},
                {"--tolerance", &tolerance_, "T",
                 "an overlap proved to be at most this deep, or a gap of\nat most this, is a "
                 "touch; "
                 "in world units, or relative to\nthe box of all parts, as in 1e-9*size; default "
                 "0"},
                {"--depth", &depth_, "",
                 "how deep parts are in each other, as bounds; where parts\nhave many triangles "
                 "this "
                 "takes longer than all else"},
                {"--ignore", &ignore_, "LIST",
                 "pairs of parts that may clash, as in\na:b,link*:gripper; * is any text; they are "
                 "listed\nlast where they meet"},
                {"--ignore-file", &ignore_file_, "FILE", help_of_option("ignore_file")},
                {"--only", &only_, "LIST",
                 "only these pairs of parts are examined, as in\npipe*:wall*"},
                {"--fail-on", &fail_on_, "LIST",
                 "verdicts for which the exit status is 1, or none;\n"
                 "with touch, pairs that touch are listed as well; with\nnew, only rows that "
                 "--compare calls new count; default\nclash,contained,unknown"},
                {"--frames", &frames_, "N|A:B",
                 "examine each of these frames, as farcull run --frames;\n"
                 "the table has the worst verdict of each pair"},
                {"--unit", &unit_, "WORD", "the unit of lengths, for the output, such as mm"},
                {"--csv", &outputs_.csv, "FILE",
                 "write the pairs as CSV to this file; - for standard\noutput, without the table"},
                {"--compare", &compare_, "OLD.csv",
                 "say which pairs are new, the same or gone since this\nfile of --csv; not with "
                 "--frames"},
                {"--json", &outputs_.json, "FILE", kJsonHelp},
                {"--html", &outputs_.page, "FILE",
                 "write a page to look at the pairs in a browser; not\nwith --frames"}},
        kExamples);
  }
  int run() const {
    ClashOptions options;
    options.depth = depth_;
    if (clearance_) options.clearance = parse_clearance(*clearance_);
    check_scene(scene_.names);
    std::optional<FrameRange> range;
    if (frames_) {
      range = parse_frames(*frames_);
      refuse_given({{"--html", outputs_.page.has_value()},
                    {"--compare", compare_.has_value()},
                    {"--fail-on new", only_new()}},
                   "is of one frame", "leave it or --frames out");
    }
    const std::vector<ClashVerdict> failing = this->failing();
    const SceneArguments files = parts();
    std::vector<NamedFile> inputs = scene_files(files.names, range);
    if (ignore_file_) inputs.push_back({"--ignore-file", *ignore_file_});
    if (compare_) inputs.push_back({"--compare", *compare_});
    const std::string old = compare_ ? read_file(*compare_, kMostBytes) : "";
    const WeldTolerance tolerance = parse_weld(tolerance_.value_or("0"), "--tolerance");
    const Outputs outputs = checked(outputs_, inputs);
    ClashTable table{.failing = failing, .unit = unit_.value_or("")};
    if (range) return run_frames(files, *range, outputs, tolerance, options, table);
    TerminalProgress terminal;
    const Progress progress = terminal.callback("reading the scene");
    const Stopwatch reading;
    Scene scene = read_parts(files);
    options.tolerance = tolerance.length(bounds(scene));
    prepare(scene, options, UnknownName::refused);
    if (outputs.page) require_clash_page(scene);
    const double read_ms = reading.ms();
    ClashRecord record = clashes(scene, options, progress);
    record.trace.insert(record.trace.begin(), {.kind = StageKind::read,
                                               .ran = true,
                                               .ms = read_ms,
                                               .out = scene.triangles.size(),
                                               .unit = Unit::triangles});
    record.ms += read_ms;
    terminal.clear();
    if (compare_) table.compared = compare_clashes(scene, record, old, *compare_);
    if (outputs.csv) write_output(*outputs.csv, clash_csv(scene, record, table));
    if (outputs.json) write_json(clash_json(scene, record, table), *outputs.json);
    if (outputs.page) write_output(*outputs.page, clash_page(scene, record, table.unit));
    if (!outputs.to_stdout()) print(clash_text(scene, record, table));
    return fails(record, table) ? kExitBroken : kExitDone;
  }

 private:
  // Returns the arguments, with each folder replaced by the mesh files in the folder and its
  // subfolders. Throws Error for a mesh file in an unknown format, unless the folder has a readable
  // mesh of the same part.
  SceneArguments parts() const {
    SceneArguments out = scene_;
    out.names.clear();
    for (const std::string& part : scene_.names) {
      if (!fs::is_directory(part)) {
        out.names.push_back(part);
        continue;
      }
      std::vector<std::string> files, others;
      for (const auto& entry : fs::recursive_directory_iterator(part)) {
        const std::string name = entry.path().string();
        const bool file = entry.is_regular_file();
        if (!file && (entry.is_symlink() || !entry.is_directory()))
          throw Error(name, "is neither a file nor a folder, or a link to a folder",
                      "take it out, and name a folder that is meant as well");
        if (file) (has_mesh_extension(name) ? files : others).push_back(name);
      }
      if (files.empty())
        throw Error(part, "the folder has no mesh files",
                    "name a folder with meshes, or the files");
      std::ranges::sort(files);
      for (const std::string& other : others) {
        const auto same = [&](const std::string& file) {
          return mesh_stem(file) == mesh_stem(other) &&
                 fs::path(file).parent_path() == fs::path(other).parent_path();
        };
        const std::optional<Error> foreign = foreign_mesh(other);
        if (foreign && std::ranges::none_of(files, same)) throw *foreign;
      }
      out.names.insert(out.names.end(), files.begin(), files.end());
    }
    return out;
  }
  std::vector<ClashVerdict> failing() const {
    const std::vector<ClashVerdict> usual = {ClashVerdict::clash, ClashVerdict::contained,
                                             ClashVerdict::unknown};
    std::vector<ClashVerdict> out;
    if (fail_on_ == "none") return out;
    if (only_new() && !compare_)
      throw Error("--fail-on", "new needs an earlier table", "name it with --compare OLD.csv");
    for (const std::string& word : split_list(fail_on_.value_or("new"))) {
      if (word == "new") continue;
      const auto at = std::ranges::find_if(kClashVerdicts,
                                           [&](ClashVerdict v) { return to_string(v) == word; });
      if (at == kClashVerdicts.end() || *at == ClashVerdict::clear)
        throw Error("--fail-on", "'" + word + "' is no verdict",
                    "give none, or some of clash, contained, unknown, touch, near, new");
      out.push_back(*at);
    }
    return out.empty() ? usual : out;
  }
  bool only_new() const { return std::ranges::count(split_list(fail_on_.value_or("")), "new") > 0; }
  // Moves the scene's ignored pairs into the options, and adds the pairs of --ignore and --only.
  // lacking: what to do about names that are not in the scene.
  void prepare(Scene& scene, ClashOptions& options, UnknownName lacking) const {
    if (scene_.names.size() == 1 && fs::is_directory(scene_.names[0]))
      scene.name = clean_name(fs::canonical(scene_.names[0]).filename().string());
    for (Object& object : scene.objects) object.self = false;
    options.ignored = in_order(
        ignored_objects(scene, ignored_names(ignore_, ignore_file_), lacking), scene.ignored);
    if (only_) options.only = ignored_objects(scene, parse_ignored(*only_, "--only"), lacking);
    scene.ignored.clear();
  }
  bool fails(const ClashRecord& record, const ClashTable& table) const {
    if (record.examined < record.asked && fail_on_ != "none") return true;
    for (std::size_t k = 0; k < record.rows.size(); ++k) {
      const ClashRow& row = record.rows[k];
      if (!row.ignored && std::ranges::count(table.failing, row.verdict) > 0 &&
          !(only_new() && table.compared->same[k]))
        return true;
    }
    return false;
  }
  int run_frames(const SceneArguments& files, FrameRange range, const Outputs& outputs,
                 const WeldTolerance& tolerance, ClashOptions options,
                 const ClashTable& table) const {
    TerminalProgress terminal;
    const Progress progress = terminal.callback("reading the scene");
    FrameSource source(files, range, false);
    if (const std::optional<Error> missing = source.missing()) throw *missing;
    ClashFrames frames(range.count());
    bool broken = false;
    std::optional<FrameRecord> json;
    std::optional<GrowingOutput> csv;
    if (outputs.json) json.emplace(*outputs.json);
    if (outputs.csv) csv.emplace(*outputs.csv);
    const auto print_pairs = [&] {
      terminal.clear();
      if (!outputs.to_stdout()) print(frames.text(table));
    };
    try {
      for_each_frame(
          range,
          json || csv ? "what they gave is written" : "their pairs are in no file (--csv FILE)",
          progress, "", [&](long frame, const Progress& named) {
            Scene scene = source.at(frame);
            const bool first = frame == range.first;
            if (first) options.tolerance = tolerance.length(bounds(scene));
            prepare(scene, options, first ? UnknownName::refused : UnknownName::passed_over);
            if (options.only && options.only->empty())
              throw Error("--only", fmt::format("frame {} has none of these pairs", frame),
                          "name pairs that each frame has, or other frames");
            const ClashRecord record = clashes(scene, options, named);
            terminal.clear();
            say_notes();
            broken = fails(record, table) || broken;
            const ClashFrames::Report report = frames.add(scene, record, table, frame);
            if (json) json->add(report.head, report.frame, report.summary);
            if (csv) csv->add(report.csv, "");
            if (!outputs.to_stdout()) print(report.text);
          });
    } catch (const Error&) {
      print_pairs();
      throw;
    }
    if (json) json->finish();
    if (csv) csv->finish();
    print_pairs();
    return broken ? kExitBroken : kExitDone;
  }

  SceneArguments scene_;
  bool depth_ = false;
  Text clearance_, tolerance_, ignore_, ignore_file_, only_, unit_, fail_on_, compare_, frames_;
  Outputs outputs_;
};

}  // namespace

Command add_clash(CLI::App& app) { return declare<ClashCommand>(app); }

}  // namespace farcull
