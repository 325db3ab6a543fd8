// Reads certificates, scenes and lists of pairs, and prints what the checker of verify/certificate
// finds.
#include "experiments/command/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/scene/ignored.h"
#include "experiments/record/check_result.h"
#include "experiments/record/check_scene.h"
#include "experiments/record/distance_result.h"
#include "experiments/scenes/builtin/scenes.h"
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

constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30;  // of a certificate or a list

// Text that a terminal can show, line by line.
std::string clean_lines(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out += clean_name(std::string_view(text).substr(at, end - at)) + "\n";
    at = end + 1;
  }
  return out;
}

int exit_status(Verdict verdict) { return verdict == Verdict::proved ? kExitDone : kExitBroken; }

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

// Whether the file is there and says that it is a certificate of distances.
bool is_of_distances(const std::string& file) {
  std::array<char, 1024> start{};
  std::ifstream in(file, std::ios::binary);
  in.read(start.data(), start.size());
  return is_distance_certificate({start.data(), static_cast<std::size_t>(in.gcount())});
}

CheckedDistances checked_distances(const std::string& file, DistanceCertificate certificate,
                                   const Scene& scene) {
  require_nothing_ignored(scene, "a check");
  CheckedDistances out{clean_name(file), std::move(certificate), {}};
  out.result = check_distances(out.certificate, scene, out.file);
  return out;
}

// Prints the check of one scene, of pairs or of distances.
template <class Check>
int print_check(const CheckArguments& arguments, const Scene& scene, const Check& check) {
  if (!arguments.json.empty()) write_json(check_json(scene, check), arguments.json);
  if (arguments.json != "-") write_output("-", clean_lines(check_text(scene, check)));
  return exit_status(check.result.verdict);
}

int check_one(const CheckArguments& arguments, const GivenList* list) {
  // The certificate comes before the scene, which may be large.
  std::optional<Certificate> certificate;
  std::optional<DistanceCertificate> distances;
  const std::string file = clean_name(arguments.certificate);
  if (!arguments.certificate.empty()) {
    const std::string text = read_file(arguments.certificate, kMaxBytes);
    if (is_distance_certificate(text)) {
      require_no_list(arguments);
      distances = parse_distance_certificate(text, file);
    } else {
      certificate = parse_certificate(text, file);
    }
  }
  Scene scene = load_scene(arguments.scene);
  if (arguments.self) make_self(scene);
  if (distances)
    return print_check(arguments, scene, checked_distances(file, std::move(*distances), scene));
  return print_check(
      arguments, scene,
      check_scene_with(
          clearance_of(arguments, certificate), file, certificate, scene, list,
          list ? std::span<const ListedPair>(list->rows) : std::span<const ListedPair>()));
}

// The JSON of frames, which are added one by one; its text is that of ordered_json::dump(2).
class FrameChecks {
 public:
  explicit FrameChecks(std::string path) : output_(std::move(path)) {}
  void add(const Json& frame, const Json& summary) {
    const std::string before = std::exchange(begun_, true) ? ",\n    " : "{\n  \"frames\": [\n    ";
    output_.add(before + indented(frame, "    "),
                "\n  ],\n  \"summary\": " + indented(summary, "  ") + "\n}\n");
  }
  void finish() { output_.finish(); }

 private:
  static std::string indented(const Json& json, const std::string& by) {
    std::string out;
    for (const char c : json.dump(2)) {
      out += c;
      if (c == '\n') out += by;
    }
    return out;
  }

  GrowingOutput output_;
  bool begun_ = false;
};

// The check of a frame, as it is counted and printed.
struct FrameCheck {
  Verdict verdict;
  std::uint64_t listed;  // pairs or distances
  std::string row;       // of the table
  std::string reason;    // for the verdict, unless it is proved
  Json json;
};
template <class Check>
FrameCheck frame_check(const Scene& scene, const Check& check, std::uint64_t listed,
                       std::string row) {
  return {check.result.verdict, listed, std::move(row), verdict_text(scene, check),
          check_json(scene, check)};
}

// Checks frame after frame. head: of the table; at_end: lines below it, of the verdict in all.
int check_each(const CheckArguments& arguments, const std::string& head,
               const std::function<FrameCheck(FrameSource&, long)>& check,
               const std::function<std::string(const FrameVerdicts&)>& at_end) {
  const FrameRange range = *arguments.frames;
  FrameSource source(arguments.scene, range, arguments.self);
  std::optional<FrameChecks> json;
  if (!arguments.json.empty()) json.emplace(arguments.json);
  const bool table = arguments.json != "-";
  Interruptible interruptible(range.count(), "frames", "their verdicts are given", false);
  if (table) write_output("-", head);
  FrameVerdicts verdicts;
  for (long frame = range.first; frame <= range.last; ++frame) {
    const FrameCheck one = check(source, frame);
    verdicts.add(frame, one.verdict, one.listed);
    const std::string reason = one.verdict == Verdict::proved ? "" : "         " + one.reason;
    if (table) write_output("-", clean_lines(one.row + reason));
    if (json) {
      Json record = {{"frame", frame}};
      record.update(one.json);
      json->add(record, verdicts.json(range.count()));
    }
    interruptible.done(frame - range.first + 1);
  }
  if (json) json->finish();
  if (table) write_output("-", "\n" + clean_lines(at_end(verdicts)));
  return exit_status(verdicts.in_all());
}

int check_distance_frames(const CheckArguments& arguments) {
  const auto check = [&](FrameSource& source, long frame) {
    const std::string file = numbered(arguments.certificate, frame);
    DistanceCertificate certificate =
        parse_distance_certificate(read_file(file, kMaxBytes), clean_name(file));
    const Scene& scene = source.at(frame);
    const CheckedDistances checked = checked_distances(file, std::move(certificate), scene);
    const DistanceCheck& result = checked.result;
    const std::size_t listed = checked.certificate.distances.size();
    return frame_check(
        scene, checked, listed,
        fmt::format("{:>7}  {:<10}  {:>10}  {:>12}  {:>10.1f}\n", frame, to_string(result.verdict),
                    grouped(listed), grouped(result.decided), result.ms));
  };
  return check_each(
      arguments,
      fmt::format("{:>7}  {:<10}  {:>10}  {:>12}  {:>10}\n", "frame", "verdict", "distances",
                  "decided", "ms"),
      check, [](const FrameVerdicts& verdicts) {
        return verdicts.text("the distances are exactly these, and no others were asked for");
      });
}

// Throws Error where there is no certificate of the frame.
Certificate certificate_of_frame(const CheckArguments& arguments, const std::string& file,
                                 long frame) {
  std::error_code error;
  if (std::filesystem::exists(file, error))
    return parse_certificate(read_file(file, kMaxBytes), clean_name(file));
  const FrameRange range = *arguments.frames;
  // The frames of a built-in motion are those up to its last one.
  const bool motion = arguments.scene.size() == 1 && is_builtin_scene(arguments.scene[0]);
  throw Error(file, "the file does not exist",
              motion ? fmt::format("make it with farcull run --certificate --frames {}:{}", frame,
                                   range.last)
                     : fmt::format("give the numbers that there are: --frames FIRST:LAST "
                                   "instead of {}:{}",
                                   range.first, range.last));
}

int check_frames(const CheckArguments& arguments, const GivenList* list) {
  if (!arguments.certificate.empty() &&
      is_of_distances(numbered(arguments.certificate, arguments.frames->first))) {
    require_no_list(arguments);
    return check_distance_frames(arguments);
  }
  std::optional<double> clearance;
  SceneCheck last;
  const auto check = [&](FrameSource& source, long frame) {
    std::string file;
    std::optional<Certificate> certificate;
    if (!arguments.certificate.empty()) {
      file = numbered(arguments.certificate, frame);
      certificate = certificate_of_frame(arguments, file, frame);
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
    const CheckResult& result = last.result;
    return frame_check(
        scene, last, result.meeting.size(),
        fmt::format("{:>7}  {:<10}  {:>12}  {:>10}  {:>10.1f}\n", frame, to_string(result.verdict),
                    grouped(result.found.box_pairs), grouped(result.found.meeting), result.ms));
  };
  const auto at_end = [&](const FrameVerdicts& verdicts) {
    const bool several = arguments.frames->count() > 1 && !last.result.unattested.empty();
    const std::string which = *clearance == 0
                                  ? "of the scene meet"
                                  : fmt::format("are at distance {} or less", *clearance);
    return verdicts.text("these pairs " + which + ", and no others") +
           (several ? "of the last frame's run: " : "") + unattested_text(last);
  };
  return check_each(arguments,
                    fmt::format("{:>7}  {:<10}  {:>12}  {:>10}  {:>10}\n", "frame", "verdict",
                                "box pairs", "meeting", "ms"),
                    check, at_end);
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
  // A scene of several names is of meshes alone, so a first name that is not a mesh's is a
  // certificate's.
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
