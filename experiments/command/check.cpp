// `farcull check` reads certificates, scenes and lists of pairs. It prints the verdict of the
// checker in verify/certificate.
#include "experiments/command/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/floating_point.h"
#include "experiments/measure/frames.h"
#include "experiments/record/check.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"
#include "experiments/tiles/run_tile.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

Certificate read_certificate(const std::string& path) {
  return parse_certificate(read_file(path, kMaxCheckedBytes), clean_name(path));
}

std::string clean_lines(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out += clean_name(line) + "\n";
  return out;
}

namespace {

using Json = nlohmann::ordered_json;

GivenList read_list(const CheckArguments& arguments) {
  GivenList list =
      read_pair_list(read_file(arguments.pairs, kMaxCheckedBytes), clean_name(arguments.pairs));
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

// Returns the end of a message: the meshes in another order, in which the scene has this hash.
// Returns "" if no other order gives this hash. Tries at most four meshes, which have 24 orders.
std::string order_of(const std::vector<std::string>& meshes, const Scene& scene,
                     const std::string& hash) {
  const std::size_t count = meshes.size();
  if (count > 4 || count != scene.objects.size() || scene_hash(scene) == hash) return "";
  Scene other = scene;
  for (std::size_t o = 0; o < count; ++o) other.objects[o].name = meshes[o];
  while (std::ranges::next_permutation(other.objects, {}, &Object::first_triangle).found) {
    other.triangles.clear();
    std::string names;
    for (const Object& object : other.objects) {
      const auto first = scene.triangles.begin() + object.first_triangle;
      other.triangles.insert(other.triangles.end(), first, first + object.triangle_count);
      names += " " + object.name;
    }
    if (scene_hash(other) == hash) return "; the meshes are in another order: give" + names;
  }
  return "";
}

int check_one(const CheckArguments& arguments, const GivenList* list) {
  std::optional<Certificate> certificate;
  if (!arguments.certificate.empty()) {
    certificate = read_certificate(arguments.certificate);
    if (certificate->tile && arguments.clearance) {
      throw Error("--clearance", "does not go with the certificate of a tile, which names its own",
                  "leave it out");
    }
    if (certificate->tile && arguments.scene.ignore)
      throw Error("--ignore", "does not go with the certificate of a tile", "leave it out");
    if (certificate->tile) return check_tiles(arguments, {arguments.certificate}, false);
  }
  const Scene scene = read_scene(arguments.scene, arguments.self);
  require_asked(scene, {});
  SceneCheck done = check_scene_with(
      arguments.clearance.value_or(certificate ? certificate->clearance : 0),
      clean_name(arguments.certificate), certificate, scene, list,
      list ? std::span<const ListedPair>(list->rows) : std::span<const ListedPair>());
  if (certificate && done.result.verdict == Verdict::not_proved)
    done.result.reason += order_of(arguments.scene.names, scene, certificate->scene.hash);
  const int status = done.result.verdict == Verdict::proved ? kExitDone : kExitBroken;
  if (arguments.json != "-") print(clean_lines(check_text(scene, done)));
  if (arguments.verified) {
    const auto words = [&](const TakeWord& take) { give_words(scene, take); };
    check_again(arguments, {arguments.certificate}, words, status);
  }
  // The record is written last: check_again() throws if the two checkers disagree.
  if (!arguments.json.empty()) write_json(check_json(scene, done), arguments.json);
  return status;
}

Certificate certificate_of_frame(const CheckArguments& arguments, long frame) {
  const std::string file = numbered(arguments.certificate, frame);
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    const std::vector<std::string>& names = arguments.scene.names;
    const bool motion = names.size() == 1 && is_builtin_scene(names[0]);
    const FrameRange& range = *arguments.frames;
    throw Error(file, "the file does not exist",
                motion ? fmt::format("make it with farcull run --certificate --frames {}:{}", frame,
                                     range.last)
                       : fmt::format("give the numbers that there are: --frames FIRST:LAST "
                                     "instead of {}:{}",
                                     range.first, range.last));
  }
  return read_certificate(file);
}

int check_frames(const CheckArguments& arguments, const GivenList* list) {
  const FrameRange range = *arguments.frames;
  FrameSource source(arguments.scene, range, arguments.self);
  std::optional<FrameRecord> json;
  if (!arguments.json.empty()) json.emplace(arguments.json);
  const bool table = arguments.json != "-";
  if (table) {
    print(fmt::format("{:>7}  {:<10}  {:>12}  {:>10}  {:>10}\n", "frame", "verdict", "box pairs",
                      "meeting", "ms"));
  }
  FrameVerdicts verdicts;
  SceneCheck last;
  std::optional<double> clearance = arguments.clearance;
  bool self = false, ignores = false;
  std::string not_asked;
  for_each_frame(range, "their verdicts are given", {}, "", [&](long frame, const Progress&) {
    std::optional<Certificate> certificate;
    if (!arguments.certificate.empty()) certificate = certificate_of_frame(arguments, frame);
    std::span<const ListedPair> rows;
    if (list) {
      const auto found = std::ranges::equal_range(list->rows, static_cast<std::uint32_t>(frame), {},
                                                  &ListedPair::frame);
      rows = {found.begin(), found.end()};
    }
    const Scene& scene = source.at(frame);
    say_notes();
    if (frame == range.first) {
      require_asked(scene, {});
      not_asked = not_asked_line(scene);
    }
    self = self || has_self(scene);
    ignores = ignores || !scene.ignored.empty();
    // If no clearance was given, all frames use the clearance of the first certificate, or 0.
    if (!clearance) clearance = certificate ? certificate->clearance : 0;
    const std::string file = certificate ? numbered(arguments.certificate, frame) : "";
    last = check_scene_with(*clearance, clean_name(file), certificate, scene, list, rows);
    const CheckResult& result = last.result;
    verdicts.add(frame, result.verdict, result.meeting.size());
    if (table) {
      std::string row = fmt::format("{:>7}  {:<10}  {:>12}  {:>10}  {:>10.1f}\n", frame,
                                    to_string(result.verdict), grouped(result.found.box_pairs),
                                    grouped(result.found.meeting), result.ms);
      if (result.verdict != Verdict::proved) row += "         " + verdict_text(scene, last);
      print(clean_lines(row));
    }
    if (!json) return;
    Json one = {{"frame", frame}};
    one.update(check_json(scene, last));
    json->add(Json::object(), one, verdicts.json(range.count()));
  });
  const bool several = range.count() > 1 && !last.result.unattested.empty();
  const std::string proved =
      fmt::format("these pairs {}, and no others",
                  *clearance == 0 ? "of the scene meet"
                                  : fmt::format("are at distance {} or less", *clearance)) +
      proved_limits(*clearance, self, ignores);
  if (json) json->finish();
  if (table) {
    print("\n" + clean_lines(verdicts.text(proved) + not_asked +
                             (several ? "of the last frame's run: " : "") + unattested_text(last)));
  }
  return verdicts.in_all() == Verdict::proved ? kExitDone : kExitBroken;
}

class CheckCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "check", "prove or refute a certificate of a run, or a list of pairs",
        Rows{{"CERTIFICATE", &arguments_.certificate, "",
              "as written by run --certificate; may be left out\nbefore SCENE to check --pairs "
              "alone"}} +
            scene_rows(arguments_.scene, "SCENE", kSceneHelp, Need::may) +
            Rows{{"--self", &arguments_.self, "",
                  "every object was tested against itself, as by\nfarcull run --self"},
                 ignore_row(arguments_.scene.ignore),
                 {"--pairs", &pairs_, "FILE",
                  "a list of pairs as farcull run --pairs writes it:\n"
                  "is it right and complete? Columns are found by their\n"
                  "names; rows may be in any order. With --tiles: the\n"
                  "merged list, which must be equal byte for byte"},
                 {"--clearance", &clearance_, "D",
                  "the list is of pairs at this distance or less, in\n"
                  "world units; default 0, or that of the certificate"},
                 {"--frames", &frames_, "N|A:B",
                  "check these frames, as of farcull run --frames: with\n"
                  "a number (%d or %04d) in the name of CERTIFICATE and\n"
                  "a column `frame` in the list"},
                 {"--tiles", &tiles_, "N",
                  "check the certificates of all N tiles of the scene\n(farcull run --tiles), with "
                  "a number (%d or %04d) in\nthe name of CERTIFICATE; they prove the whole list"},
                 {"--verified", &arguments_.verified, "",
                  "the checker that Coq has proved must agree; a build has\nit where Coq is "
                  "installed "
                  "(docs/verified.md)"},
                 {"--json", &json_, "FILE", kJsonHelp}},
        "Examples:\n"
        "  farcull run two-spheres --certificate c.json --pairs pairs.csv\n"
        "  farcull check c.json two-spheres --pairs pairs.csv\n"
        "  farcull check two-spheres --pairs pairs.csv\n"
        "  farcull run two-spheres --clearance 0.01 --certificate d.json\n"
        "  farcull check d.json two-spheres\n"
        "  farcull run two-spheres --frames 10 --certificate c_%04d.json\n"
        "  farcull check c_%04d.json two-spheres --frames 10\n"
        "  farcull run two-tori --tiles 1/2 --certificate t1.json   (and likewise 2/2)\n"
        "  farcull check t%d.json two-tori --tiles 2\n\n"
        "Exit status 0: proved: these pairs of the scene meet (or are within the clearance), and\n"
        "no others; 1: refuted, or not proved, as for another scene; 2: what cannot be read.\n"
        "Nothing is proved about the run: neither its method nor which pairs it kept. The file of "
        "a\n"
        "certificate, and its proof: docs/certificate.md.");
  }
  int run() {
    CheckArguments& to = arguments_;
    if (to.certificate.empty())
      throw Error("CERTIFICATE", "is missing", "name a certificate and its scene, or see --help");
    if (pairs_ == "") throw Error("--pairs", "the path is empty", "name the list");
    to.pairs = pairs_.value_or("");
    if (frames_) to.frames = parse_frames(*frames_);
    if (tiles_) to.tiles = FrameRange{1, static_cast<long>(parse_tiles(*tiles_))};
    // The scene may come first on the command line. Certificate and scene are then exchanged.
    const auto is_certificate = [&](const std::string& path) {
      const std::string file = numbered_files(path, to.tiles ? to.tiles : to.frames).front();
      std::string text(100, ' ');
      if (std::filesystem::is_regular_file(file))
        std::ifstream(file).read(text.data(), static_cast<std::streamsize>(text.size()));
      return text.find("\"farcull-certificate\"") != std::string::npos;
    };
    if (!to.scene.names.empty() && !is_certificate(to.certificate) &&
        is_certificate(to.scene.names.back())) {
      to.scene.names.insert(to.scene.names.begin(), std::move(to.certificate));
      to.certificate = std::move(to.scene.names.back());
      to.scene.names.pop_back();
    }
    // A first name with the extension of a mesh is part of the scene, and not a certificate.
    const bool mesh = has_mesh_extension(to.certificate);
    if (!pairs_ && mesh) {
      throw Error("CERTIFICATE", "'" + to.certificate + "' is named like a mesh",
                  "name the certificate first, or give a list of pairs with --pairs FILE");
    }
    if (!pairs_ && to.scene.names.empty()) {
      throw Error("SCENE", "is missing after '" + to.certificate + "'",
                  "name the scene that the certificate is of, or give a list of pairs with --pairs "
                  "FILE");
    }
    if (mesh || to.scene.names.empty())
      to.scene.names.insert(to.scene.names.begin(), std::exchange(to.certificate, ""));
    if (to.certificate == "-")
      throw Error("CERTIFICATE", "is not read from standard input", "name a file");
    check_scene(to.scene.names);
    if (clearance_) to.clearance = parse_clearance(*clearance_);
    if (tiles_ && (to.certificate.empty() || to.frames || clearance_ || to.scene.ignore)) {
      throw Error("--tiles",
                  "is for certificates of tiles, without --frames, --clearance and --ignore",
                  "leave it out, or name the certificates of the tiles");
    }
    if (const bool numbers = to.frames || to.tiles;
        !to.certificate.empty() && is_numbered(to.certificate) != numbers) {
      if (numbers) {
        throw Error("CERTIFICATE", "'" + to.certificate + "' has no place for a number",
                    "put %d or %04d where the number of the frame or tile is in its name");
      }
      throw Error("CERTIFICATE", "'" + to.certificate + "' has a place for a number",
                  "say which frames with --frames FIRST:LAST, or how many tiles with --tiles N");
    }
    if (to.verified) {
      const auto refuse = [](const char* reason, const char* remedy) {
        throw Error("--verified", reason, remedy);
      };
      if (to.certificate.empty())
        refuse("needs a certificate", "make one with farcull run SCENE --certificate FILE");
      if (to.frames) refuse("does not take --frames", "check each frame by its own certificate");
      if (clearance_)
        refuse("does not take --clearance", "leave --clearance out: the certificate has it");
      if (pairs_ && !tiles_)
        refuse("does not read the list of --pairs",
               "check twice: with --pairs, then with --verified, which proves the same list");
    }
    std::vector<NamedFile> inputs = scene_files(to.scene.names, to.frames);
    if (!to.certificate.empty()) {
      for (const std::string& file :
           numbered_files(to.certificate, to.tiles ? to.tiles : to.frames))
        inputs.push_back({"CERTIFICATE", file});
    }
    if (pairs_) inputs.push_back({"--pairs", *pairs_});
    to.json = checked({.json = json_}, inputs).json.value_or("");
    if (to.verified && to.json == "-") {
      throw Error("--verified", "prints lines of its own, which would stand among the JSON",
                  "write the JSON to a file");
    }
    return run_check(to);
  }

 private:
  CheckArguments arguments_;
  Text json_, pairs_, clearance_, frames_, tiles_;
};

}  // namespace

int run_check(const CheckArguments& arguments) {
  const FloatingPointGuard guard;
  if (arguments.tiles)
    return check_tiles(arguments, numbered_files(arguments.certificate, arguments.tiles), true);
  std::optional<GivenList> list;
  if (!arguments.pairs.empty()) list = read_list(arguments);
  const GivenList* const given = list ? &*list : nullptr;
  return arguments.frames ? check_frames(arguments, given) : check_one(arguments, given);
}

Command add_check(CLI::App& app) { return declare<CheckCommand>(app); }

}  // namespace farcull
