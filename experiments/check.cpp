#include "experiments/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/floating_point.h"
#include "experiments/mesh_text.h"
#include "experiments/output.h"
#include "experiments/scene_file.h"
#include "experiments/tables.h"
#include "verify/pair_list.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMaxCertificateBytes = std::uint64_t{4} << 30;

// As docs/reliability.md names them.
const std::vector<std::string>& assumptions() {
  static const std::vector<std::string> lines = {
      "A1: vertex arithmetic through the viewport transform errs by no more than its term of the "
      "budget",
      "A2: window coordinates snap by at most 2^-b px per axis, b = GL_SUBPIXEL_BITS",
      "A3: coverage is that of one common, infinitesimally shifted sample; zero snapped area "
      "covers "
      "nothing",
      "A4: fragment and compute arithmetic as GLSL 4.50, 4.7.1 promises; the depth map is monotone",
      "A5: the depth buffer and its test are monotone",
      "A6: a query is zero only if no sample passed",
      "A7: every command ran, or the failure is seen",
      "A8: what a dispatch or a draw wrote is seen after the barrier; atomics neither lose nor "
      "double"};
  return lines;
}

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

// What a proof is about: the scene, not the run.
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

int check_command(const CheckArguments& arguments) {
  const FloatingPointGuard guard;
  const Certificate certificate = parse_certificate(
      read_file(arguments.certificate, kMaxCertificateBytes), clean_name(arguments.certificate));
  Scene scene = load_scene(arguments.scene);
  if (arguments.self) {
    for (Object& object : scene.objects) object.self = true;
  }
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

Certificate certificate_of(const Scene& scene, const RunRecord& record,
                           std::span<const TrianglePair> kept) {
  const RunOptions& options = record.options;
  Certificate::Run run;
  run.method = to_string(options.method);
  if (record.device) run.resolution = static_cast<std::uint64_t>(resolution_of(options));
  run.offset = options.method == Method::far ? options.offset : "none";
  for (const ViewReport& view : record.views) {
    if (!view.drawn) continue;
    run.views.push_back({view.name, static_cast<std::uint64_t>(view.width),
                         static_cast<std::uint64_t>(view.height), view.radius_px});
    run.radius_px = std::max(run.radius_px, view.radius_px);
  }
  for (const PairView& view : record.pair_views) {
    if (!view.looked) continue;
    run.views.push_back({view.name, static_cast<std::uint64_t>(view.width),
                         static_cast<std::uint64_t>(view.height), 0});
    run.resolution = std::max({run.resolution, run.views.back().width, run.views.back().height});
  }
  if (record.device) {
    const GlInfo& device = *record.device;
    run.device = {device.vendor, device.renderer, device.version, device.glsl};
    run.assumptions = assumptions();
  }
  std::vector<TrianglePair> colliding;
  std::merge(record.pairs.begin(), record.pairs.end(), record.neighbour_pairs.begin(),
             record.neighbour_pairs.end(), std::back_inserter(colliding));
  return make_certificate(scene, kept, colliding, std::move(run));
}

}  // namespace farcull
