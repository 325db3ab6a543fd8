// Reads the options of `farcull run`, `verify` and `plan`, then plans or runs.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "core/boxes/join.h"
#include "core/scene/scene.h"
#include "experiments/command/command.h"
#include "experiments/measure/frames.h"
#include "experiments/method/miss_model.h"
#include "experiments/record/output.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"
#include "experiments/tiles/run_tile.h"
#include "verify/inside.h"

namespace farcull {
namespace {

std::vector<ContactKind> parse_kinds(const std::string& list) {
  std::vector<ContactKind> out;
  for (const std::string& name : split_list(list)) {
    const std::optional<ContactKind> kind = parse_contact_kind(name);
    if (!kind) {
      std::string known;
      for (const ContactKind one : kContactKinds)
        known.append(known.empty() ? "" : ", ").append(name_of(one));
      throw Error("--kinds", "'" + name + "' is no kind of contact", "give some of " + known);
    }
    out.push_back(*kind);
  }
  return out;
}

// Name, title and end of the help of each command, in the order of RunCommand::Kind.
constexpr std::array<std::array<const char*, 3>, 3> kCommands = {
    {{"run", "cull a scene, test what is left, account for every pair",
      "Examples:\n"
      "  farcull run two-spheres\n"
      "  farcull run bunny.off dragon.off --method cullide --resolution 256\n"
      "  farcull run cloth.obj --self --pairs pairs.csv\n"
      "  farcull run a.obj b.obj --clearance 0.001\n"
      "  farcull run a.obj b.obj --pairs pairs.csv --kinds crossing,coplanar --segments\n"
      "  farcull run robot.json --ignore 'link*:base,hand:cup' --limit 100\n"
      "  farcull run 'cloth_%04d.obj' body.obj --frames 1:100 --no-verify\n"
      "  farcull run two-spheres --frames 10 --certificate c_%04d.json\n"
      "  farcull run field:3000000 --tiles 2/4 --json t2.json --pairs t2.csv\n"
      "  farcull run scene.json --json - | jq .verification\n"
      "  farcull run two-spheres --method far --radius published --depth fixed --depth-format 24\n"
      "  farcull run two-tori --method cullide --rounds 1 --views x,-x,y,-y,z,-z\n\n"
      "farcull help methods: which method does what; farcull help terms: the words of the\n"
      "table; farcull help pairs: the columns of --pairs.\n\n"
      "Exit status 1: a method that promises missed a pair. i-collide and boxes promise,\n"
      "and far at the budget radius or more with fragment depth; on OpenGL only where the\n"
      "probes of the device pass (farcull doctor), but the status is 1 all the same.\n"
      "farcull verify asks it of every method."},
     {"verify", "run; status 1 if any culled pair intersects",
      "Examples:\n"
      "  farcull verify two-spheres\n"
      "  farcull verify two-spheres --method cullide --resolution 64\n"
      "  farcull verify two-spheres --method far --resolution 64 --no-risk\n"
      "  farcull verify two-spheres --frames 30\n"
      "  farcull verify scene.json --json record.json\n\n"
      "The first lines are the verdict and the classes of all pairs (farcull help terms). On a\n"
      "terminal the verdict is green or red, unless NO_COLOR is set. Of far on a scene without\n"
      "frames it also says how many pairs were at risk: where none was, "
      "\"0 missed\" does not show\nthat the radius is large enough.\n\n"
      "Exit status 1: a culled pair intersects, whatever the method."},
     {"plan", "what run would do, what it would leave out, and why",
      "Examples:\n"
      "  farcull plan two-bunnies\n"
      "  farcull plan two-bunnies --method far --offset exact\n"
      "  farcull plan bunnies-far-apart --json -\n\n"
      "The same scene and options give the same plan. farcull run --full leaves nothing out."}}};

namespace fs = std::filesystem;

// Returns the objects in which two triangles collide with each other, in ascending order.
std::vector<std::uint32_t> meeting_themselves(const Scene& scene, const Record& record) {
  std::set<std::uint32_t> found;
  for (const auto* pairs : {&record.collisions.pairs, &record.collisions.neighbour_pairs}) {
    for (const TrianglePair& pair : *pairs) {
      const std::uint32_t a = place_of(scene, pair.a).object;
      if (a == place_of(scene, pair.b).object) found.insert(a);
    }
  }
  return {found.begin(), found.end()};
}

// Returns lines about objects that may lie inside a closed object: the object's box lies in the box
// of the closed object, and the surfaces do not meet. Returns "" if there are no such objects, or
// if more than a million pairs of boxes overlap.
std::string nested_line(const Scene& scene, const Record& record) {
  const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
  std::vector<std::uint32_t> all(boxes.size());
  std::iota(all.begin(), all.end(), 0u);
  constexpr std::size_t kMost = 1'000'000;
  const std::vector<TrianglePair> overlapping = box_join(boxes, all, all, kMost);
  if (overlapping.size() > kMost) return "";
  std::set<ObjectPair> meet;
  for (const TrianglePair& pair : record.collisions.pairs)
    meet.insert({place_of(scene, pair.a).object, place_of(scene, pair.b).object});
  meet.insert(record.options.ignored.begin(), record.options.ignored.end());
  std::map<std::uint32_t, bool> closed;
  std::uint64_t count = 0;
  std::string first;
  for (const auto& [a, b] : overlapping) {
    for (const auto& [in, out] : {ObjectPair{a, b}, ObjectPair{b, a}}) {
      if (!lies_within(boxes[in], boxes[out]) || meet.contains({a, b})) continue;
      if (!closed.contains(out)) closed[out] = is_closed(scene, out);
      if (!closed[out]) continue;
      if (count++ == 0) first = scene.objects[in].name + " in " + scene.objects[out].name;
      break;
    }
  }
  if (count == 0) return "";
  return fmt::format(
      "nested     {} may lie wholly inside a closed one, as {}. Surfaces that do\n"
      "           not meet are no collision; farcull distance says what lies inside\n",
      counted(count, "object", "objects"), first);
}

// Returns the path of `file`, relative to the folder of the file `record`.
std::string beside(const std::string& file, const std::string& record) {
  // Resolves links first: `..` after a link means the parent of the link's target.
  const fs::path folder = fs::weakly_canonical(fs::absolute(record).parent_path());
  const fs::path path = fs::absolute(file);
  return (fs::weakly_canonical(path.parent_path()) / path.filename())
      .lexically_proximate(folder)
      .string();
}

// The commands run, verify and plan. `verify` fails if a pair was missed. `plan` runs nothing.
class RunCommand {
 public:
  enum class Kind { run, verify, plan };
  explicit RunCommand(Kind kind) : kind_(kind) {}
  CLI::App* add_to(CLI::App& app) {
    Rows rows = scene_rows(scene_) + options_.rows();
    if (kind_ == Kind::verify)
      rows.push_back({"--no-risk", &no_risk_, "", kNoRiskHelp});
    else
      rows.push_back({"--no-verify", &no_verify_, "", "leave out the accounting of all pairs"});
    const auto& [name, title, examples] = kCommands[static_cast<std::size_t>(kind_)];
    return add_command(app, name, title, rows + output_rows(), examples);
  }
  int run() const {
    RunOptions options{.verify = !no_verify_, .seed = seed_of(scene_.names)};
    if (contacts_ || kinds_) options.contacts = ContactDetail::kinds;
    if (segments_) options.contacts = ContactDetail::segments;
    options = read_options(options_.given(), options);
    check_scene(scene_.names);
    if (kind_ == Kind::plan) return plan(options);
    if (tiles_) return run_tile(options);
    refuse_outputs();
    columns();
    std::optional<FrameRange> range;
    if (frames_) range = parse_frames(*frames_);
    if (range && verbose_)
      throw Error("--verbose", "has no meaning with --frames", "leave it out, or name one frame");
    const Outputs outputs = checked(outputs_, read_files(range), range);
    return range ? run_frames(options, outputs, *range) : run_once(options, outputs);
  }

 private:
  Rows output_rows() {
    const OptionRow json = {"--json", &outputs_.json, "FILE", kJsonHelp};
    if (kind_ == Kind::plan) return {json};
    Rows rows = {{"--frames", &frames_, "N|A:B",
                  "run N frames (0 to N-1), or those numbered A to B, of\n"
                  "meshes with %d or %04d in their names, or of a\n"
                  "built-in scene that moves (see farcull scenes), where\n"
                  "30:59 is the second half of 60"},
                 {"--pairs", &outputs_.pairs, "FILE",
                  "write the colliding pairs as CSV to this file (- for\n"
                  "standard output, without the table): object_a,\n"
                  "triangle_a, object_b, triangle_b, all counted from 0,\n"
                  "triangles within their object; with --self also\n"
                  "neighbours, 0 or 1 (see farcull help pairs)"},
                 {"--faces", &faces_, "",
                  "with --pairs: two more columns, face_a and face_b, the\n"
                  "faces of the mesh files (see farcull help pairs)"},
                 {"--names", &names_, "",
                  "with --pairs: two more columns, name_a and name_b, the\n"
                  "names of the objects"},
                 {"--contacts", &contacts_, "",
                  "how the triangles of each pair meet: counts in the table\n"
                  "and the record, a column `contact` in the file of\n"
                  "--pairs (see farcull help pairs)"},
                 {"--segments", &segments_, "",
                  "with --pairs: the same, and the ends or the corners of\n"
                  "what the two triangles have in common"},
                 {"--kinds", &kinds_, "LIST",
                  "with --pairs: the same, and pairs of these kinds alone,\n"
                  "as in crossing,coplanar"},
                 {"-v,--verbose", &verbose_, "",
                  "print the stages as well: what each took and left, and\n"
                  "what was left out and why"},
                 json,
                 {"--certificate", &outputs_.certificate, "FILE",
                  "write evidence for every pair to this file, for\n"
                  "`farcull check`; with --frames one for each, with %d\n"
                  "or %04d in the name"}};
    if (kind_ != Kind::run) return rows;
    rows.insert(rows.begin() + 1,
                {"--tiles", &tiles_, "K/N",
                 "only the Kth of N parts of the scene, which is read\ntwice and never "
                 "held; boxes only. With --json and\n--pairs farcull merge joins all parts"});
    return rows;
  }
  // Throws Error if --pairs is absent but needed, or if an option excludes --certificate.
  void refuse_outputs() const {
    const auto needs_pairs = [&](const char* option, bool given, const char* what) {
      if (!given || outputs_.pairs) return;
      throw Error(option, std::string(what) + " the file of --pairs, which is not asked for",
                  "give --pairs FILE.csv as well");
    };
    needs_pairs("--faces", faces_, "adds columns to");
    needs_pairs("--names", names_, "adds columns to");
    needs_pairs("--segments", segments_, "adds columns to");
    needs_pairs("--kinds", kinds_.has_value(), "chooses the rows of");
    if (!outputs_.certificate) return;
    for (const char* name : {"ignore", "ignore_file", "only", "limit"}) {
      if (!options_.has(name)) continue;
      throw Error(option_word(name), "a certificate is about all colliding pairs of all objects",
                  "leave " + option_word(name) + " or --certificate out");
    }
  }
  PairColumns columns() const {
    return {.faces = faces_,
            .contacts = contacts_ || segments_ || kinds_,
            .segments = segments_,
            .names = names_,
            .kinds = kinds_ ? parse_kinds(*kinds_) : std::vector<ContactKind>()};
  }
  std::vector<IgnoredNames> ignored() const {
    return ignored_names(options_.text("ignore"), options_.text("ignore_file"));
  }
  bool leaves_out() const { return options_.has("only") || !ignored().empty(); }
  // Returns the pairs of objects that are not tested: the pairs of --ignore, and with --only, all
  // pairs except those of --only.
  std::vector<ObjectPair> left_out(const Scene& scene,
                                   UnknownName lacking = UnknownName::refused) const {
    std::vector<ObjectPair> out = ignored_objects(scene, ignored(), lacking);
    const Text& only = options_.text("only");
    if (!only) return out;
    const std::vector<ObjectPair> asked =
        ignored_objects(scene, parse_ignored(*only, "--only"), lacking);
    constexpr std::size_t kMostObjects = 5000;  // so that the list stays below 100 MB
    if (scene.objects.size() > kMostObjects) {
      throw Error("--only", fmt::format("is given for {} objects", scene.objects.size()),
                  fmt::format("give a scene of at most {}, or --ignore", kMostObjects));
    }
    const auto count = static_cast<std::uint32_t>(scene.objects.size());
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = a + 1; b < count; ++b) {
        if (!std::ranges::binary_search(asked, ObjectPair{a, b})) out.push_back({a, b});
      }
    }
    return in_order(std::move(out));
  }
  std::vector<NamedFile> read_files(const std::optional<FrameRange>& range = {}) const {
    std::vector<NamedFile> out = scene_files(scene_.names, range);
    if (const Text& file = options_.text("ignore_file")) out.push_back({"--ignore-file", *file});
    return out;
  }
  std::string with_self() const {
    std::string command = kCommands[static_cast<std::size_t>(kind_)][0];
    command = command_with("farcull " + command, scene_);
    if (const Text& method = options_.text("method")) {
      const bool can = tests_self(parse_method(*method));
      command += " --method " + (can ? *method : to_string(kDefaultMethod));
    }
    if (frames_) command += " --frames " + quoted(*frames_);
    return command + " --self";
  }
  // Returns the verdict of `verify`, green or red on a terminal. Returns "" for `run` and `plan`.
  std::string verdict_line(const Accounting& accounting) const {
    if (kind_ != Kind::verify) return "";
    const Colour colour = accounting.false_negatives == 0 ? Colour::good : Colour::bad;
    return coloured(verdict_text(accounting), colour, STDOUT_FILENO) + "\n";
  }
  void refuse_with_tiles(const RunOptions& options) const {
    const auto refuse = [](const std::string& option, bool given, const std::string& why) {
      if (!given) return;
      throw Error(option, "cannot be answered in tiles: " + why,
                  "leave " + option + " or --tiles out");
    };
    if (options.method != Method::boxes) {
      throw Error("--tiles",
                  "are of boxes: " + to_string(options.method) + " looks at all of a scene",
                  "leave --tiles out, or use --method boxes");
    }
    refuse("--frames", frames_.has_value(), "a tile is of a scene that stands still");
    refuse("--limit", options_.has("limit"), "no tile knows how many pairs the others have");
  }
  int run_tile(const RunOptions& options) const {
    TileQuestion question{.options = options, .number = parse_tile(*tiles_)};
    refuse_with_tiles(options);
    refuse_outputs();
    const Outputs outputs = checked(outputs_, read_files());
    const PairColumns chosen = columns();
    if (outputs.pairs && outputs.json) {
      try {  // dump() throws if the path is not UTF-8
        static_cast<void>(nlohmann::json(*outputs.pairs).dump());
      } catch (const nlohmann::json::exception&) {
        throw Error("--pairs", "the name of the file is no UTF-8, and the record has to hold it",
                    "choose another name");
      }
    }
    if (leaves_out()) question.ignored = [this](const Scene& scene) { return left_out(scene); };
    TerminalProgress terminal;
    const Progress progress = terminal.callback();
    Session session(options.device);
    const TileRun tile = farcull::run_tile(scene_in_parts(scene_, options_.has("self")), question,
                                           session, progress);
    terminal.clear();
    require_pairs(nothing_to_test(tile.census), with_self());
    require_asked(tile.census.objects, tile.census.self_objects > 0, tile.ignored.size(), "SCENE",
                  "test objects against themselves with --self");
    if (outputs.certificate) {
      require_nothing_ignored(names_of(tile.census), "a certificate");
      const WholeScene whole = whole_scene(tile.census, tile.tile, tile.part);
      write_output(*outputs.certificate,
                   to_text(certificate_of(tile.part.scene, tile.record, &whole)));
    }
    std::optional<TileList> list;  // describes the file of pairs in the record
    if (outputs.pairs) {
      const std::string text = tile_list(tile, chosen);
      write_output(*outputs.pairs, text);
      if (outputs.json && *outputs.json != "-" && *outputs.pairs != "-")
        list = TileList{text, beside(*outputs.pairs, *outputs.json), chosen};
    }
    if (outputs.json) write_json(tile_json(tile, list ? &*list : nullptr), *outputs.json);
    if (!outputs.to_stdout())
      print(run_answer(tile.part.scene, tile.record) + tile_lines(tile) +
            (verbose_ ? run_details(tile.record) : ""));
    if (!broken(tile.record, false)) return kExitDone;
    complain_broken(missed(tile.record));
    return kExitBroken;
  }
  int plan(const RunOptions& options) const {
    const Outputs outputs = checked(outputs_, read_files());
    const Scene scene = read_scene(scene_, options_.has("self"));
    require_pairs(nothing_to_test(scene), with_self());
    RunOptions all = options;
    all.ignored = left_out(scene);
    require_asked(scene, all.ignored);
    const Plan planned = farcull::plan(scene, all);
    const MissesOfPlan misses = misses_of(scene, planned);
    if (outputs.json) write_json(plan_json(scene, planned, misses.predicted), *outputs.json);
    if (!outputs.to_stdout()) print(plan_table(scene, planned) + misses_line(misses));
    return kExitDone;
  }
  int run_once(const RunOptions& options, const Outputs& outputs) const {
    TerminalProgress terminal;
    const Progress progress = terminal.callback("reading the scene");
    const Scene scene = read_scene(scene_, options_.has("self"));
    require_pairs(nothing_to_test(scene), with_self());
    if (outputs.certificate) require_nothing_ignored(scene, "a certificate");
    RunOptions all = options;
    all.ignored = left_out(scene);
    require_asked(scene, all.ignored);
    // With no_shortcuts, FAR draws all views, as in the runs of pairs_at_risk().
    all.no_shortcuts = kind_ == Kind::verify && !no_risk_ && fattens(all.method);
    Session session(options.device);
    Record record = farcull::run(scene, all, session, progress);
    if (kind_ == Kind::verify && !no_risk_)
      record.risk = pairs_at_risk(scene, record, session, progress);
    terminal.clear();
    if (kind_ == Kind::verify && record.limited)
      throw Error("--limit", "ended the search, so not all pairs are known",
                  "leave it out, or use farcull run");
    if (outputs.pairs) {
      write_output(*outputs.pairs,
                   [&](const TextSink& sink) { give_pairs_csv(scene, record, columns(), sink); });
    }
    if (outputs.certificate)
      write_output(*outputs.certificate, to_text(certificate_of(scene, record)));
    if (outputs.json) write_json(to_json(scene, record), *outputs.json);
    if (!outputs.to_stdout()) {
      std::string verdict;
      if (record.verification) verdict = verdict_line(*record.verification);
      print(run_answer(scene, record, verdict) + nested_line(scene, record) +
            weld_lines(scene, meeting_themselves(scene, record)) +
            (verbose_ ? run_details(record) : ""));
    }
    if (!broken(record, kind_ == Kind::verify)) return kExitDone;
    complain_broken(missed(record));
    return kExitBroken;
  }
  int run_frames(const RunOptions& options, const Outputs& outputs, FrameRange range) const {
    TerminalProgress terminal;
    const Progress progress = terminal.callback("reading the scene");
    FramesQuestion question{.options = options,
                            .range = range,
                            .self = options_.has("self"),
                            .strict = kind_ == Kind::verify,
                            .pairs = outputs.pairs.has_value(),
                            .columns = columns(),
                            .certificates = outputs.certificate.has_value()};
    if (leaves_out()) {
      question.ignored = [this, lacking = UnknownName::refused](const Scene& scene) mutable {
        std::vector<ObjectPair> out = left_out(scene, lacking);
        lacking = UnknownName::passed_over;
        return out;
      };
    }
    FrameSource source(scene_, range, options_.has("self"));
    if (const std::optional<Error> missing = source.missing()) {
      terminal.clear();
      complain(missing->where + ": the file does not exist; the frames before it are run");
    }
    std::optional<FrameRecord> json;
    std::optional<GrowingOutput> pairs;
    if (outputs.json) json.emplace(*outputs.json);
    if (outputs.pairs) pairs.emplace(*outputs.pairs);
    const FramesResult result =
        farcull::run_frames(source, question, progress, [&](const FrameReport& report) {
          terminal.clear();
          say_notes();
          // The certificate is written first, so that every frame in the record has one.
          if (outputs.certificate)
            write_output(numbered(*outputs.certificate, report.number), report.certificate);
          if (json) json->add(report);
          if (pairs) pairs->add(report.pairs_csv, "");
          if (!outputs.to_stdout()) print(report.rows);
        });
    terminal.clear();
    if (json) json->finish();
    if (pairs) pairs->finish();
    require_pairs(result.nothing, with_self());
    if (!outputs.to_stdout()) {
      std::string end = result.table;
      if (kind_ == Kind::verify) end += verdict_line(result.sum) + accounting_sum(result.sum);
      print(end);
    }
    if (result.broken.empty()) return kExitDone;
    complain_broken(result.broken);
    return kExitBroken;
  }

  Kind kind_;
  SceneArguments scene_;
  MethodOptions options_;
  Text frames_, kinds_, tiles_;
  Outputs outputs_;
  bool no_verify_ = false, no_risk_ = false, faces_ = false, contacts_ = false, segments_ = false,
       names_ = false, verbose_ = false;
};

}  // namespace

Command add_run(CLI::App& app) { return declare<RunCommand>(app, RunCommand::Kind::run); }
Command add_verify(CLI::App& app) { return declare<RunCommand>(app, RunCommand::Kind::verify); }
Command add_plan(CLI::App& app) { return declare<RunCommand>(app, RunCommand::Kind::plan); }

}  // namespace farcull
