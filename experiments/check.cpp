#include "experiments/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "experiments/mesh_text.h"
#include "experiments/output.h"
#include "experiments/scene_file.h"

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
      "A7: every command ran, or the failure is seen"};
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

Json result_json(const CheckArguments& arguments, const Certificate& certificate,
                 const Scene& scene, const CheckResult& result) {
  Json pair = nullptr;
  if (result.pair) {
    pair = {{"a", place_json(scene, result.pair->a)}, {"b", place_json(scene, result.pair->b)}};
  }
  return {{"certificate", clean_name(arguments.certificate)},
          {"scene", {{"name", scene.name}, {"hash", scene_hash(scene)}}},
          {"verdict", to_string(result.verdict)},
          {"reason", result.reason.empty() ? Json(nullptr) : Json(result.reason)},
          {"pair", pair},
          {"claimed", claims_json(certificate.claims)},
          {"found", claims_json(result.found)},
          {"culled_meeting", result.culled_meeting},
          {"unattested", result.unattested},
          {"ms", result.ms},
          {"decide_ms", result.decide_ms},
          {"ns_per_pair", ns_per_pair(result)}};
}

std::string place_text(const Scene& scene, std::uint32_t triangle) {
  const Place place = place_of(scene, triangle);
  return fmt::format("{} triangle {}", scene.objects[place.object].name, place.triangle);
}

std::string result_text(const Scene& scene, const CheckResult& result) {
  std::string out = to_string(result.verdict);
  if (!result.reason.empty()) out += ": " + clean_name(result.reason);
  out += "\n";
  if (result.pair) {
    out += fmt::format("  pair: {} and {}\n", place_text(scene, result.pair->a),
                       place_text(scene, result.pair->b));
  }
  const Certificate::Claims& found = result.found;
  if (found.box_pairs > 0 || result.verdict == Verdict::proved) {
    out += fmt::format(
        "pairs with overlapping boxes: {}; {} separated, {} neighbours, {} meet\n"
        "called kept: {}; called culled: {}, of which {} meet\n",
        found.box_pairs, found.separated, found.neighbours, found.meeting, found.kept, found.culled,
        result.culled_meeting);
  }
  out += "unattested:\n";
  for (const std::string& line : result.unattested) out += "  " + clean_name(line) + "\n";
  out += fmt::format("time: {:.1f} ms; {:.1f} of them for the decisions, {:.0f} ns per pair\n",
                     result.ms, result.decide_ms, ns_per_pair(result));
  return out;
}

}  // namespace

int check_command(const CheckArguments& arguments) {
  const Certificate certificate = parse_certificate(
      read_file(arguments.certificate, kMaxCertificateBytes), clean_name(arguments.certificate));
  Scene scene = load_scene(arguments.scene);
  if (arguments.self) {
    for (Object& object : scene.objects) object.self = true;
  }
  const CheckResult result = check_certificate(certificate, scene);
  if (!arguments.json.empty()) {
    write_output(arguments.json, result_json(arguments, certificate, scene, result).dump(2) + "\n");
  }
  if (arguments.json != "-") write_output("-", result_text(scene, result));
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
