// Reads a certificate, a scene and a list of pairs, and prints what the checker of
// verify/certificate finds.
#include "experiments/command/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/pair_list.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMaxCertificateBytes = std::uint64_t{4} << 30;

struct Place {
  std::uint32_t object, triangle;  // the triangle within its object
};

Place place_of(const Scene& scene, std::uint32_t triangle) {
  const auto after = std::upper_bound(
      scene.objects.begin(), scene.objects.end(), triangle,
      [](std::uint32_t t, const Object& object) { return t < object.first_triangle; });
  // An object without triangles starts where the next one does: the last that starts there owns it.
  const auto owner = static_cast<std::uint32_t>(after - scene.objects.begin() - 1);
  return {owner, triangle - scene.objects[owner].first_triangle};
}

Json place_json(const Scene& scene, std::uint32_t triangle) {
  const Place place = place_of(scene, triangle);
  return {{"object", place.object},
          {"name", scene.objects[place.object].name},
          {"triangle", place.triangle},
          {"face", scene.source_face[triangle]}};
}

Json claims_json(const Certificate::Claims& claims) {
  return {{"box_pairs", claims.box_pairs},   {"kept", claims.kept},
          {"culled", claims.culled},         {"separated", claims.separated},
          {"neighbours", claims.neighbours}, {"meeting", claims.meeting}};
}

double ns_per_pair(const CheckResult& result) {
  return result.found.box_pairs == 0
             ? 0
             : result.decide_ms * 1e6 / static_cast<double>(result.found.box_pairs);
}

// A proof is about the scene, not about the run.
std::string proved_text(const CheckResult& result) {
  const std::size_t pairs = result.meeting.size();
  if (pairs == 0) return "no pair of the scene meets";
  return pairs == 1 ? "this pair of the scene meets, and no other"
                    : "these " + grouped(pairs) + " pairs of the scene meet, and no others";
}

// The first line in which a list that was given differs from that of the pairs that meet, for a
// message; empty where they are the same.
std::string difference(std::string_view given, std::string_view proved) {
  if (given == proved) return {};
  const auto [at, other] = std::mismatch(given.begin(), given.end(), proved.begin(), proved.end());
  const auto same = static_cast<std::size_t>(at - given.begin());
  const std::size_t begin = same == 0 ? 0 : given.rfind('\n', same - 1) + 1;
  const auto line = [&](std::string_view text) {
    const std::string_view rest = text.substr(begin);
    return rest.empty() ? "nothing" : quote_token(rest.substr(0, rest.find('\n')));
  };
  const auto number =
      1 + std::count(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
  std::string is = line(given);
  std::string should = line(proved);
  if (is == should) is += " and other bytes";  // the end of the line, or what a message cannot hold
  return fmt::format("line {} is {}, and of the pairs that meet it is {}", number, is, should);
}

Json result_json(const CheckArguments& arguments, const Certificate& certificate,
                 const Scene& scene, const CheckResult& result,
                 const std::optional<std::string>& given) {
  Json pair = nullptr;
  if (result.pair) {
    pair = {{"a", place_json(scene, result.pair->a)}, {"b", place_json(scene, result.pair->b)}};
  }
  const bool decided = !result.list_sha256.empty();
  return {{"certificate", clean_name(arguments.certificate)},
          {"scene",
           {{"name", scene.name},
            {"hash", scene_hash(scene)},
            {"self_not_asked", not_asked_json(scene)}}},
          {"verdict", to_string(result.verdict)},
          {"proves", result.verdict == Verdict::proved ? Json(proved_text(result)) : Json(nullptr)},
          {"reason", result.reason.empty() ? Json(nullptr) : Json(result.reason)},
          {"pair", pair},
          {"list",
           {{"claimed_sha256", certificate.list_sha256},
            {"found_sha256", decided ? Json(result.list_sha256) : Json(nullptr)},
            {"given", arguments.pairs.empty() ? Json(nullptr) : Json(clean_name(arguments.pairs))},
            {"given_is_found", given ? Json(given->empty()) : Json(nullptr)}}},
          {"claimed", claims_json(certificate.claims)},
          {"found", claims_json(result.found)},
          {"culled_meeting", result.culled_meeting},
          {"unattested", result.unattested},
          {"floating_point", floating_point_json(callers_floating_point(), floating_point())},
          {"ms", result.ms},
          {"decide_ms", result.decide_ms},
          {"ns_per_pair", ns_per_pair(result)}};
}

std::string place_text(const Scene& scene, std::uint32_t triangle) {
  const Place place = place_of(scene, triangle);
  return fmt::format("{} triangle {}", scene.objects[place.object].name, place.triangle);
}

std::string result_text(const CheckArguments& arguments, const Scene& scene,
                        const CheckResult& result, const std::optional<std::string>& given) {
  std::string out =
      to_string(result.verdict) + ": " +
      (result.verdict == Verdict::proved ? proved_text(result) : clean_name(result.reason)) + "\n";
  if (result.pair) {
    out += fmt::format("  pair: {} and {}\n", place_text(scene, result.pair->a),
                       place_text(scene, result.pair->b));
  }
  if (const Certificate::Claims& found = result.found; !result.list_sha256.empty()) {
    out += fmt::format("list       SHA-256 of the pairs that meet: {}\n", result.list_sha256);
    if (given) {
      out += fmt::format("           {} is {}this list\n", clean_name(arguments.pairs),
                         given->empty() ? "" : "not ");
    }
    out += not_asked_line(scene);
    out += fmt::format(
        "boxes      {} pairs overlap: {} separated, {} neighbours, {} meet\n"
        "called     kept: {}; culled: {}, of which {} meet\n",
        found.box_pairs, found.separated, found.neighbours, found.meeting, found.kept, found.culled,
        result.culled_meeting);
  }
  out += "unattested, since the evidence is about the scene and not about the run:\n";
  for (const std::string& line : result.unattested) out += "  " + clean_name(line) + "\n";
  if (callers_floating_point() != kProved) {
    out += fmt::format("arithmetic: {}; the caller {}\n", to_string(floating_point()),
                       to_string(callers_floating_point()));
  }
  out += fmt::format("time: {:.1f} ms; {:.1f} of them for the decisions, {:.0f} ns per pair\n",
                     result.ms, result.decide_ms, ns_per_pair(result));
  return out;
}

}  // namespace

int check_certificate_file(const CheckArguments& arguments) {
  const FloatingPointGuard guard;
  const Certificate certificate = parse_certificate(
      read_file(arguments.certificate, kMaxCertificateBytes), clean_name(arguments.certificate));
  Scene scene = load_scene(arguments.scene);
  if (arguments.self) make_self(scene);
  std::string list;
  if (!arguments.pairs.empty()) list = read_file(arguments.pairs, kMaxCertificateBytes);
  CheckResult result = check_certificate(certificate, scene);
  std::optional<std::string> given;  // difference() of the list
  if (!arguments.pairs.empty() && !result.list_sha256.empty()) {
    given = difference(list, pair_list(scene, result.meeting));
    if (result.verdict == Verdict::proved && !given->empty()) {
      result.verdict = Verdict::not_proved;
      result.reason = clean_name(arguments.pairs) + " is another list: " + *given;
    }
  }
  if (!arguments.json.empty()) {
    write_output(arguments.json,
                 result_json(arguments, certificate, scene, result, given).dump(2) + "\n");
  }
  if (arguments.json != "-") write_output("-", result_text(arguments, scene, result, given));
  return result.verdict == Verdict::proved ? 0 : 1;
}

CLI::App* CheckCommand::add_to(CLI::App& app) {
  CLI::App* command = add_command(app, "check", "prove or refute a certificate of a run");
  add_required(*command, "CERTIFICATE", arguments_.certificate, "as written by run --certificate");
  add_scene(*command, arguments_.scene);
  add_flag(*command, "--self", arguments_.self,
           "every object was tested against itself, as by\nfarcull run --self");
  add_option(*command, "--pairs", pairs_, "FILE",
             "the list that farcull run --pairs wrote: is it the\none that is proved?");
  add_option(*command, "--json", json_, "FILE", kJsonHelp);
  add_footer(
      *command,
      "Examples:\n"
      "  farcull run two-spheres --certificate c.json --pairs pairs.csv\n"
      "  farcull check c.json two-spheres --pairs pairs.csv\n\n"
      "Exit status 0: proved: these pairs of the scene meet, and no others; 1: refuted, or not\n"
      "proved. Nothing is proved about the run: neither its method nor which pairs it kept.");
  return command;
}

int CheckCommand::run() {
  check_scene(arguments_.scene);
  if (pairs_ == "") throw Error("--pairs", "the path is empty", "name the list");
  arguments_.pairs = pairs_.value_or("");
  std::vector<NamedFile> inputs = scene_files(arguments_.scene);
  inputs.push_back({"CERTIFICATE", arguments_.certificate});
  if (pairs_) inputs.push_back({"--pairs", *pairs_});
  arguments_.json = checked({.json = json_}, inputs).json.value_or("");
  return check_certificate_file(arguments_);
}

}  // namespace farcull
