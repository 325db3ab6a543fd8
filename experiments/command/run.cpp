// Reads the options of the three commands, then plans or runs.
#include "experiments/command/run.h"

#include <unistd.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/ignored.h"
#include "experiments/measure/frames.h"
#include "experiments/record/certificate.h"
#include "experiments/record/output.h"
#include "experiments/record/plan.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/output_file.h"
#include "experiments/system/shell_word.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

template <class Value>
Value choose(const std::string& option, const std::string& given,
             const std::map<std::string, Value>& values) {
  const auto found = values.find(given);
  if (found != values.end()) return found->second;
  std::string known;
  for (const auto& [name, value] : values) known += (known.empty() ? "" : " or ") + name;
  throw Error(option, "'" + given + "' is no choice", "give " + known);
}

std::uint64_t parse_limit(const std::string& text) {
  const std::optional<std::uint64_t> value = parse_number<std::uint64_t>(text);
  if (!value || *value == 0)
    throw Error("--limit", "'" + text + "' is no number of pairs",
                "give a whole number, 1 or more");
  return *value;
}

std::vector<ContactKind> parse_kinds(const std::string& list) {
  std::vector<ContactKind> out;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    const std::optional<ContactKind> kind = parse_contact_kind(name);
    if (!kind) {
      std::string known;
      for (const ContactKind one : kContactKinds)
        known.append(known.empty() ? "" : ", ").append(name_of(one));
      throw Error("--kinds", "'" + name + "' is no kind of contact", "give some of " + known);
    }
    out.push_back(*kind);
    begin = end + 1;
  }
  return out;
}

constexpr const char* kRunExamples =
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
    "Exit status 1: a method that promises missed a pair. i-collide and far-pairs promise,\n"
    "and far at the budget radius or more with fragment depth; on OpenGL only where the\n"
    "probes of the device pass (farcull doctor), but the status is 1 all the same.\n"
    "farcull verify asks it of every method.";
constexpr const char* kVerifyExamples =
    "Examples:\n"
    "  farcull verify two-spheres\n"
    "  farcull verify two-spheres --method cullide --resolution 64\n"
    "  farcull verify two-spheres --frames 30\n"
    "  farcull verify scene.json --json record.json\n\n"
    "The last lines are the verdict and the classes of all pairs (farcull help terms). On a\n"
    "terminal the verdict is green or red, unless NO_COLOR is set.\n\n"
    "Exit status 1: a culled pair intersects, whatever the method.";
constexpr const char* kPlanExamples =
    "Examples:\n"
    "  farcull plan two-bunnies\n"
    "  farcull plan two-bunnies --method far --offset exact\n"
    "  farcull plan bunnies-far-apart --json -\n"
    "  farcull plan field:3000000 --tiles 4\n\n"
    "The same scene and options give the same plan. farcull run --full leaves nothing out.";

}  // namespace

CLI::App* RunCommand::add_to(CLI::App& app) {
  const auto declare = [&](const char* name, const char* title, const char* examples) {
    CLI::App* command = add_command(app, name, title);
    add_footer(*command, examples);
    return command;
  };
  CLI::App* command = nullptr;
  switch (kind_) {
    case Kind::run:
      command =
          declare("run", "cull a scene, test what is left, account for every pair", kRunExamples);
      break;
    case Kind::verify:
      command = declare("verify", "run; status 1 if any culled pair intersects", kVerifyExamples);
      break;
    case Kind::plan:
      command =
          declare("plan", "what run would do, what it would leave out, and why", kPlanExamples);
      break;
  }
  add_scene(*command, scene_);
  add_method_options(*command);
  if (kind_ != Kind::verify)
    add_flag(*command, "--no-verify", no_verify_, "leave out the accounting of all pairs");
  if (kind_ == Kind::plan) {
    add_option(*command, "--tiles", tiles_, "N",
               "where run --tiles K/N cuts the scene, how many\ntriangles each tile has and about "
               "how much memory it\ntakes");
    add_option(*command, "--json", outputs_.json, "FILE", kJsonHelp);
  } else {
    add_outputs(*command);
  }
  return command;
}

void RunCommand::add_method_options(CLI::App& command) {
  const auto add = [&](const char* name, Text& text, const char* type, const char* help) {
    add_option(command, name, text, type, help);
  };
  add("--method", method_, "METHOD",
      "far-pairs, far, cullide, quick-cullide, s-cullide,\ni-collide or exact (see farcull help "
      "methods); "
      "default\nfar-pairs");
  add("--resolution", resolution_, "N|auto",
      "pixels along the larger side of each view's window;\ndefault 512; for far-pairs auto: "
      "chosen by the scene;\nfar-pairs: with a number views decide");
  add("--radius", radius_, "RADIUS",
      "of the ball that fattens a primitive, for far: budget,\n"
      "published, or a factor on the budget; default budget");
  add("--offset", offset_, "OFFSET",
      "what a primitive is fattened to, for far: obb or\nexact; default obb");
  add("--depth", depth_, "fragment|fixed",
      "entry and exit depth by the fragment program\n"
      "(reliable), or fixed function as published;\n"
      "default fragment for far, fixed for the others");
  add("--depth-format", depth_format_, "32f|24", "of the depth buffer; default 32f");
  add("--query", query_, "flags|occlusion",
      "how visibility is asked; default flags, but occlusion\n"
      "with --depth-format 24 and for s-cullide");
  add("--clusters", clusters_, "LIST|none",
      "sizes of clusters of triangles that are asked before\n"
      "single ones, for far, cullide and quick-cullide; default\n"
      "32 with occlusion queries and more than 32768 triangles");
  add("--views", views_, "VIEWS", kViewsHelp);
  add("--rounds", rounds_, "N", kRoundsHelp);
  add("--clear", clear_, "any|all", kClearHelp);
  add("--level", level_, "objects|triangles", kLevelHelp);
  add_flag(command, "--conservative", conservative_, kConservativeHelp);
  add_option(command, "--device", device_, "DEVICE", device_help_of_methods());
  add_flag(command, "--self", self_, kSelfHelp);
  add("--clearance", clearance_, "D", kClearanceHelp);
  add("--ignore", ignore_, "LIST",
      "pairs of objects that are not tested against each\n"
      "other, as in a:b,link*:gripper; * is any text");
  add("--ignore-file", ignore_file_, "FILE", "the same, a pair a line; # begins a comment");
  add("--limit", limit_, "N",
      "only the first N colliding pairs, in the order of\n"
      "--pairs; the exact tests stop there");
  add_flag(command, "--full", full_, kFullHelp);
}

void RunCommand::add_outputs(CLI::App& command) {
  const auto add = [&](const char* name, Text& text, const char* type, const char* help) {
    add_option(command, name, text, type, help);
  };
  add("--frames", frames_, "N|A:B",
      "run N frames (0 to N-1), or those numbered A to B, of\n"
      "meshes with %d or %04d in their names, or of a\n"
      "built-in scene that moves (see farcull scenes), where\n"
      "30:59 is the second half of 60");
  if (kind_ == Kind::run) {
    add("--tiles", tiles_, "K/N",
        "only the Kth of N parts of the scene, which is read\ntwice and never held; far-pairs "
        "only. "
        "With --json and\n--pairs farcull merge joins all parts");
  }
  add("--pairs", outputs_.pairs, "FILE",
      "write the colliding pairs as CSV to this file (- for\n"
      "standard output, without the table): object_a,\n"
      "triangle_a, object_b, triangle_b, all counted from 0,\n"
      "triangles within their object; with --self also\n"
      "neighbours, 0 or 1 (see farcull help pairs)");
  add_flag(command, "--faces", faces_, kFacesHelp);
  add_flag(command, "--contacts", contacts_,
           "how the triangles of each pair meet: counts in the table\n"
           "and the record, a column `contact` in the file of\n"
           "--pairs (see farcull help pairs)");
  add_flag(command, "--segments", segments_,
           "with --pairs: the same, and the ends of what the two\n"
           "triangles have in common");
  add("--kinds", kinds_, "LIST",
      "with --pairs: the same, and pairs of these kinds alone,\n"
      "as in crossing,coplanar");
  add("--json", outputs_.json, "FILE", kJsonHelp);
  add("--certificate", outputs_.certificate, "FILE",
      "write evidence for every pair to this file, for\n"
      "`farcull check`; with --frames one for each, with %d\n"
      "or %04d in the name");
}

RunOptions RunCommand::parse() const {
  RunOptions out;
  if (method_) out.method = parse_method(*method_);
  out.method_is_default = !method_;
  const bool pairs = chooses_views(out.method);
  if (resolution_ == "auto") {
    if (!pairs) {
      throw Error("--resolution", "auto has no meaning for --method " + to_string(out.method),
                  "give a number of pixels, or use --method far-pairs");
    }
  } else if (resolution_) {
    out.resolution = parse_resolution(*resolution_);
  }
  if (radius_) out.radius = parse_radius(*radius_);
  if (offset_) out.offset = *offset_;
  if (depth_) {
    out.depth = choose<DepthMode>("--depth", *depth_,
                                  {{"fragment", DepthMode::fragment}, {"fixed", DepthMode::fixed}});
  }
  if (depth_format_) {
    out.depth_format =
        choose<DepthFormat>("--depth-format", *depth_format_,
                            {{"32f", DepthFormat::float32}, {"24", DepthFormat::fixed24}});
  }
  if (query_) out.query = parse_query(*query_);
  if (clusters_) out.clusters = parse_clusters(*clusters_);
  if (rounds_) out.rounds = parse_rounds(*rounds_);
  if (clear_) out.clear = parse_clear(*clear_);
  if (level_) out.objects_alone = parse_level(*level_);
  out.conservative = conservative_;
  if (views_) out.views = parse_views_option(*views_, pairs);
  if (clearance_) out.clearance = parse_clearance(*clearance_);
  if (limit_) out.limit = parse_limit(*limit_);
  if (contacts_ || kinds_) out.contacts = ContactDetail::kinds;
  if (segments_) out.contacts = ContactDetail::segments;
  out.device = device_of(device_);
  out.verify = !no_verify_;
  out.full = full_;
  out.seed = seed_of(scene_);
  validate(out);
  refuse_idle(out.method);
  return out;
}

// Refuses an option that the method does not use, so that no result lacks what was asked for.
void RunCommand::refuse_idle(Method chosen) const {
  const auto refuse = [&](const char* option, bool given, const std::string& methods) {
    if (!given) return;
    throw Error(option, "has no meaning for --method " + to_string(chosen),
                std::string("leave ") + option + " out, or use --method " + methods);
  };
  if (!tests_self(chosen))
    refuse("--self", self_, method_names([](const Traits& t) { return t.tests_self; }));
  if (!takes_clearance(chosen))
    refuse("--clearance", clearance_.has_value(),
           method_names([](const Traits& t) { return t.takes_clearance; }));
  if (!fattens(chosen)) {
    refuse("--radius", radius_.has_value(), "far");
    refuse("--offset", offset_.has_value(), "far");
    refuse("--depth", depth_.has_value(), "far");
  }
  if (!draws(chosen)) {
    const std::string drawing = method_names([](const Traits& t) { return t.draws; });
    refuse("--depth-format", depth_format_.has_value(), drawing);
    refuse("--query", query_.has_value(), drawing);
    refuse("--rounds", rounds_.has_value(), drawing);
    refuse("--clear", clear_.has_value(), drawing);
    refuse("--level", level_.has_value(), drawing);
  }
  if (clusters_ && (!draws(chosen) || tests_self_alone(chosen)))
    refuse("--clusters", true, "far, cullide or quick-cullide");
  if (!looks(chosen)) {
    const std::string others =
        method_names([](const Traits& t) { return t.draws || t.chooses_views; });
    refuse("--resolution", resolution_.has_value(), others);
    refuse("--views", views_.has_value(), others);
    refuse("--device", device_.has_value(), others);
  }
  if (!culls(chosen) && full_)
    throw Error("--full", "exact leaves nothing out", "leave --full out");
}

void RunCommand::refuse_outputs() const {
  const auto needs_pairs = [&](const char* option, bool given, const char* what) {
    if (!given || outputs_.pairs) return;
    throw Error(option, std::string(what) + " the file of --pairs, which is not asked for",
                "give --pairs FILE.csv as well");
  };
  needs_pairs("--faces", faces_, "adds columns to");
  needs_pairs("--segments", segments_, "adds columns to");
  needs_pairs("--kinds", kinds_.has_value(), "chooses the rows of");
  if (!outputs_.certificate) return;
  const auto refuse = [](const char* option, bool given) {
    if (!given) return;
    throw Error(option, "a certificate is about all colliding pairs of all objects",
                std::string("leave ") + option + " or --certificate out");
  };
  refuse("--ignore", ignore_.has_value());
  refuse("--ignore-file", ignore_file_.has_value());
  refuse("--limit", limit_.has_value());
}

PairColumns RunCommand::columns() const {
  return {.faces = faces_,
          .contacts = contacts_ || segments_ || kinds_,
          .segments = segments_,
          .kinds = kinds_ ? parse_kinds(*kinds_) : std::vector<ContactKind>()};
}

std::vector<IgnoredNames> RunCommand::ignored() const {
  std::vector<IgnoredNames> out;
  if (ignore_) out = parse_ignored(*ignore_);
  if (ignore_file_) {
    for (IgnoredNames& names : read_ignored(*ignore_file_)) out.push_back(std::move(names));
  }
  return out;
}

std::vector<NamedFile> RunCommand::read_files(const std::optional<FrameRange>& range) const {
  std::vector<NamedFile> out = scene_files(scene_, range);
  if (ignore_file_) out.push_back({"--ignore-file", *ignore_file_});
  return out;
}

std::string RunCommand::with_self() const {
  std::string command = kind_ == Kind::run ? "run" : kind_ == Kind::verify ? "verify" : "plan";
  command = command_with("farcull " + command, scene_);
  const bool can = !method_ || tests_self(parse_method(*method_));
  if (method_) command += " --method " + (can ? *method_ : to_string(kDefaultMethod));
  if (frames_) command += " --frames " + quoted(*frames_);
  return command + " --self";
}

std::string RunCommand::verdict_line(const Accounting& accounting) const {
  if (kind_ != Kind::verify) return "";
  const Colour colour = accounting.false_negatives == 0 ? Colour::good : Colour::bad;
  return coloured(verdict_text(accounting), colour, STDOUT_FILENO) + "\n";
}

int RunCommand::run() const {
  const RunOptions options = parse();
  check_scene(scene_);
  if (kind_ == Kind::plan) return tiles_ ? plan_tiles(options) : plan(options);
  if (tiles_) return run_tile(options);
  refuse_outputs();
  columns();
  std::optional<FrameRange> range;
  if (frames_) range = parse_frames(*frames_);
  const Outputs outputs = checked(outputs_, read_files(range), range);
  return range ? run_frames(options, outputs, *range) : run_once(options, outputs);
}

int RunCommand::plan(const RunOptions& options) const {
  const Outputs outputs = checked(outputs_, read_files());
  Scene scene = load_scene(scene_);
  if (self_) make_self(scene);
  RunOptions all = options;
  all.ignored = ignored_objects(scene, ignored());
  const Plan planned = farcull::plan(scene, all);
  if (outputs.json) write_json(plan_json(scene, planned), *outputs.json);
  if (!outputs.to_stdout()) {
    write_output("-",
                 plan_table(scene, planned) + nothing_note(nothing_to_test(scene), with_self()));
  }
  return kExitDone;
}

int RunCommand::run_once(const RunOptions& options, const Outputs& outputs) const {
  TerminalProgress terminal;
  const Progress progress = terminal.callback();
  if (progress) progress("reading the scene");
  Scene scene = load_scene(scene_);
  if (self_) make_self(scene);
  if (outputs.certificate) require_nothing_ignored(scene, "a certificate");
  RunOptions all = options;
  all.ignored = ignored_objects(scene, ignored());
  Session session(options.device);
  const Record record = farcull::run(scene, all, session, progress);
  terminal.clear();
  if (outputs.pairs) write_output(*outputs.pairs, pairs_csv(scene, record, columns()));
  if (outputs.certificate) {
    write_output(*outputs.certificate, to_text(certificate_of(scene, record)));
  }
  if (outputs.json) write_json(to_json(scene, record), *outputs.json);
  if (!outputs.to_stdout()) {
    const NothingToTest nothing = nothing_to_test(scene);
    std::string verdict;
    if (record.verification && nothing.reason.empty()) verdict = verdict_line(*record.verification);
    write_output("-", run_table(scene, record, verdict) + nothing_note(nothing, with_self()));
  }
  if (!broken(record, kind_ == Kind::verify)) return kExitDone;
  complain_broken(missed(record));
  return kExitBroken;
}

int RunCommand::run_frames(const RunOptions& options, const Outputs& outputs,
                           FrameRange range) const {
  TerminalProgress terminal;
  const Progress progress = terminal.callback();
  FramesQuestion question{.options = options,
                          .range = range,
                          .self = self_,
                          .strict = kind_ == Kind::verify,
                          .pairs = outputs.pairs.has_value(),
                          .columns = columns(),
                          .certificates = outputs.certificate.has_value()};
  if (const std::vector<IgnoredNames> names = ignored(); !names.empty()) {
    question.ignored = [names, lacking = Lacking::refused](const Scene& scene) mutable {
      return ignored_objects(scene, names, std::exchange(lacking, Lacking::passed_over));
    };
  }
  if (progress) progress("reading the scene");
  FrameSource source(scene_, range, self_);
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
        // First: a frame that the record has has its certificate.
        if (outputs.certificate)
          write_output(numbered(*outputs.certificate, report.number), report.certificate);
        if (json) json->add(report);
        if (pairs) pairs->add(report.pairs_csv, "");
        if (!outputs.to_stdout()) write_output("-", report.rows);
      });
  terminal.clear();
  if (json) json->finish();
  if (pairs) pairs->finish();
  if (!outputs.to_stdout()) {
    std::string end = result.table;
    if (kind_ == Kind::verify && result.nothing.reason.empty())
      end += verdict_line(result.sum) + accounting_sum(result.sum);
    write_output("-", end + nothing_note(result.nothing, with_self()));
  }
  if (result.broken.empty()) return kExitDone;
  complain_broken(result.broken);
  return kExitBroken;
}

}  // namespace farcull
