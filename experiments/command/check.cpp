// Reads certificates, scenes and lists of pairs, and prints what the checker of verify/certificate
// finds.
#include "experiments/command/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "experiments/command/check_distances.h"
#include "experiments/command/frame_checks.h"
#include "experiments/record/check_result.h"
#include "experiments/record/check_scene.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/cache.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/interrupt.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/distance_certificate.h"
#include "verify/certificate/pair_list.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

Certificate read_certificate(const std::string& path) {
  return parse_certificate(read_file(path, kMaxBytes), clean_name(path));
}

// The clearance that is asked about: --clearance, or that of the certificate, of several frames the
// first one. One question for all frames.
double clearance_of(const CheckArguments& arguments,
                    const std::optional<Certificate>& certificate) {
  return arguments.clearance.value_or(certificate ? certificate->clearance : 0);
}

GivenList read_list(const CheckArguments& arguments) {
  GivenList list =
      read_pair_list(read_file(arguments.pairs, kMaxBytes), clean_name(arguments.pairs));
  for (std::string& column : list.not_looked_at) column = clean_name(column);
  if (list.has_frames && !arguments.frames) {
    throw Error(list.name, "has a column `frame`",
                "say which frames with --frames N or --frames FIRST:LAST");
  }
  if (!list.has_frames && arguments.frames) {
    throw Error(list.name, "has no column `frame`",
                "give the list that farcull run --frames wrote, or leave --frames out");
  }
  if (!arguments.frames) return list;
  const FrameRange range = *arguments.frames;
  for (const ListedPair& row : list.rows) {
    if (row.frame >= range.first && row.frame <= range.last) continue;
    throw Error(list.name, fmt::format("frame {} is not among those that are checked", row.frame),
                fmt::format("give all frames of the list instead of --frames {}:{}", range.first,
                            range.last),
                static_cast<long>(row.line));
  }
  std::ranges::stable_sort(list.rows, {}, &ListedPair::frame);
  return list;
}

// A certificate of distances says itself what was asked.
void require_no_list(const CheckArguments& arguments) {
  if (arguments.pairs.empty() && !arguments.clearance) return;
  throw Error(arguments.clearance ? "--clearance" : "--pairs",
              "does not go with a certificate of distances", "leave it out");
}

int check_one(const CheckArguments& arguments, const GivenList* list) {
  // Before the scene, which may be large.
  std::optional<Certificate> certificate;
  if (!arguments.certificate.empty()) {
    const std::string text = read_file(arguments.certificate, kMaxBytes);
    if (is_distance_certificate(text)) {
      require_no_list(arguments);
      return check_distance_file(
          {arguments.certificate, arguments.scene, arguments.self, arguments.json}, text);
    }
    certificate = parse_certificate(text, clean_name(arguments.certificate));
  }
  Scene scene = load_scene(arguments.scene);
  if (arguments.self) make_self(scene);
  const SceneCheck done = check_scene_with(
      clearance_of(arguments, certificate), clean_name(arguments.certificate), certificate, scene,
      list, list ? std::span<const ListedPair>(list->rows) : std::span<const ListedPair>());
  if (!arguments.json.empty()) write_json(check_json(scene, done), arguments.json);
  if (arguments.json != "-") write_output("-", clean_lines(check_text(scene, done)));
  return done.result.verdict == Verdict::proved ? kExitDone : kExitBroken;
}

std::string row_of(long frame, const SceneCheck& check) {
  const CheckResult& result = check.result;
  return fmt::format("{:>7}  {:<10}  {:>12}  {:>10}  {:>10.1f}\n", frame, to_string(result.verdict),
                     grouped(result.found.box_pairs), grouped(result.found.meeting), result.ms);
}

std::string proved_of_frames(double clearance) {
  return fmt::format(
      "these pairs {}, and no others",
      clearance == 0 ? "of the scene meet" : fmt::format("are at distance {} or less", clearance));
}

int check_frames(const CheckArguments& arguments, const GivenList* list) {
  const FrameRange range = *arguments.frames;
  if (!arguments.certificate.empty() &&
      is_of_distances(numbered(arguments.certificate, range.first))) {
    require_no_list(arguments);
    return check_distance_frames(
        {arguments.certificate, arguments.scene, arguments.self, arguments.json}, range);
  }
  FrameSource source(arguments.scene, range, arguments.self);
  std::optional<FrameChecks> json;
  if (!arguments.json.empty()) json.emplace(arguments.json);
  const bool table = arguments.json != "-";
  FrameVerdicts verdicts;
  SceneCheck last;
  Interruptible interruptible(range.count(), "frames", "their verdicts are given", false);
  if (table) {
    write_output("-", fmt::format("{:>7}  {:<10}  {:>12}  {:>10}  {:>10}\n", "frame", "verdict",
                                  "box pairs", "meeting", "ms"));
  }
  std::optional<double> clearance;
  for (long frame = range.first; frame <= range.last; ++frame) {
    std::string file;
    std::optional<Certificate> certificate;
    if (!arguments.certificate.empty()) {
      file = numbered(arguments.certificate, frame);
      std::error_code error;
      if (!std::filesystem::exists(file, error)) {
        // The frames of a built-in motion are those up to its last one.
        const bool motion = arguments.scene.size() == 1 && is_builtin_scene(arguments.scene[0]);
        throw Error(file, "the file does not exist",
                    motion ? fmt::format("make it with farcull run --certificate --frames {}:{}",
                                         frame, range.last)
                           : fmt::format("give the numbers that there are: --frames FIRST:LAST "
                                         "instead of {}:{}",
                                         range.first, range.last));
      }
      certificate = read_certificate(file);
    }
    std::span<const ListedPair> rows;
    if (list) {
      const auto found = std::ranges::equal_range(list->rows, static_cast<std::uint32_t>(frame), {},
                                                  &ListedPair::frame);
      rows = {found.begin(), found.end()};
    }
    const Scene& scene = source.at(frame);
    if (!clearance) clearance = clearance_of(arguments, certificate);
    last = check_scene_with(*clearance, clean_name(file), certificate, scene, list, rows);
    verdicts.add(frame, last.result.verdict, last.result.meeting.size());
    if (table) {
      std::string text = row_of(frame, last);
      if (last.result.verdict != Verdict::proved) text += "         " + verdict_text(scene, last);
      write_output("-", clean_lines(text));
    }
    if (json) {
      Json one = {{"frame", frame}};
      one.update(check_json(scene, last));
      json->add(one, verdicts.json(range.count()));
    }
    interruptible.done(frame - range.first + 1);
  }
  if (json) json->finish();
  if (table) {
    const std::string rest = unattested_text(last);
    const bool several = range.count() > 1 && !last.result.unattested.empty();
    write_output("-", "\n" + clean_lines(verdicts.text(proved_of_frames(*clearance)) +
                                         (several ? "of the last frame's run: " : "") + rest));
  }
  return verdicts.in_all() == Verdict::proved ? kExitDone : kExitBroken;
}

// Whether certificates are of frames and the frames are named, or neither.
void require_number(const std::string& certificate, bool frames) {
  if (certificate.empty() || is_numbered(certificate) == frames) return;
  if (frames) {
    throw Error("CERTIFICATE", "'" + certificate + "' has no place for the number of the frame",
                "put %d or %04d there, as for farcull run --certificate");
  }
  throw Error("CERTIFICATE", "'" + certificate + "' has a place for the number of a frame",
              "say which frames with --frames N or --frames FIRST:LAST");
}

}  // namespace

int run_check(const CheckArguments& arguments) {
  const FloatingPointGuard guard;
  if (arguments.certificate.empty() && arguments.pairs.empty())
    throw std::logic_error("run_check: neither a certificate nor a list");
  std::optional<GivenList> list;
  if (!arguments.pairs.empty()) list = read_list(arguments);
  const GivenList* const given = list ? &*list : nullptr;
  return arguments.frames ? check_frames(arguments, given) : check_one(arguments, given);
}

CLI::App* CheckCommand::add_to(CLI::App& app) {
  CLI::App* command =
      add_command(app, "check", "prove or refute a certificate of a run, or a list of pairs");
  add_option(*command, "CERTIFICATE", arguments_.certificate, "",
             "as written by run or distance --certificate; may be\nleft out before SCENE to check "
             "--pairs alone");
  add_option(*command, "SCENE", arguments_.scene, "", kSceneHelp);
  add_flag(*command, "--self", arguments_.self,
           "every object was tested against itself, as by\nfarcull run --self");
  add_option(*command, "--pairs", pairs_, "FILE",
             "a list of pairs as farcull run --pairs writes it:\n"
             "is it right and complete? Columns are found by their\n"
             "names; rows may be in any order");
  add_option(*command, "--clearance", clearance_, "D",
             "the list is of pairs at this distance or less, in\n"
             "world units; default 0, or that of the certificate");
  add_option(*command, "--frames", frames_, "N|A:B",
             "check these frames, as of farcull run --frames: with\n"
             "a number (%d or %04d) in the name of CERTIFICATE and\n"
             "a column `frame` in the list");
  add_option(*command, "--json", json_, "FILE", kJsonHelp);
  add_footer(
      *command,
      "Examples:\n"
      "  farcull run two-spheres --certificate c.json --pairs pairs.csv\n"
      "  farcull check c.json two-spheres --pairs pairs.csv\n"
      "  farcull check two-spheres --pairs pairs.csv\n"
      "  farcull run two-spheres --method far-pairs --clearance 0.01 --certificate d.json\n"
      "  farcull check d.json two-spheres\n"
      "  farcull run two-spheres --method far-pairs --frames 10 --certificate c_%04d.json\n"
      "  farcull check c_%04d.json two-spheres --frames 10\n"
      "  farcull distance two-tori --certificate e.json\n"
      "  farcull check e.json two-tori\n\n"
      "Exit status 0: proved: these pairs of the scene meet (or are within the clearance), and\n"
      "no others, or these are the distances that were asked for; 1: refuted, or not proved, as\n"
      "for another scene; 2: what cannot be read. Nothing is proved about the run: neither its\n"
      "method nor which pairs it kept. The file of a certificate, and its proof:\n"
      "docs/certificate.md.");
  return command;
}

int CheckCommand::run() {
  CheckArguments& to = arguments_;
  if (to.certificate.empty())
    throw Error("CERTIFICATE", "is missing", "name a certificate and its scene, or see --help");
  if (pairs_ == "") throw Error("--pairs", "the path is empty", "name the list");
  to.pairs = pairs_.value_or("");
  // A scene of several names is of meshes alone, so a first name that is none is a certificate's.
  const bool mesh = has_mesh_extension(to.certificate);
  if (!pairs_ && mesh) {
    throw Error("CERTIFICATE", "'" + to.certificate + "' is named like a mesh",
                "name the certificate first, or give a list of pairs with --pairs FILE");
  }
  if (!pairs_ && to.scene.empty()) {
    throw Error("SCENE", "is missing after '" + to.certificate + "'",
                "name the scene that the certificate is of, or give a list of pairs with --pairs "
                "FILE");
  }
  if (mesh || to.scene.empty())
    to.scene.insert(to.scene.begin(), std::exchange(to.certificate, ""));
  check_scene(to.scene);
  if (clearance_) to.clearance = parse_clearance(*clearance_);
  if (frames_) to.frames = parse_frames(*frames_);
  require_number(to.certificate, to.frames.has_value());
  std::vector<NamedFile> inputs = scene_files(to.scene, to.frames);
  if (!to.certificate.empty()) {
    for (const std::string& file : numbered_files(to.certificate, to.frames))
      inputs.push_back({"CERTIFICATE", file});
  }
  if (pairs_) inputs.push_back({"--pairs", *pairs_});
  to.json = checked({.json = json_}, inputs).json.value_or("");
  return run_check(to);
}

}  // namespace farcull
