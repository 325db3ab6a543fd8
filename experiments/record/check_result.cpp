// Turns what the checker of verify/certificate found into text and JSON.
#include "experiments/record/check_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/floating_point.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

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

Json list_json(const Scene& scene, const SceneCheck& check) {
  const auto text = [](const std::string& of) { return of.empty() ? Json(nullptr) : Json(of); };
  Json out = {{"claimed_sha256", text(check.claimed_sha256)},
              {"found_sha256", text(check.result.list_sha256)},
              {"given", text(check.list)},
              {"given_is_found", nullptr}};
  if (!check.differences) return out;
  const ListDifferences& differ = *check.differences;
  out["given_is_found"] = differ.none();
  out["lines"] = differ.listed;
  out["wrong"] = {{"lines", differ.wrong},
                  {"first", differ.wrong > 0 ? Json(differ.wrong_line) : Json(nullptr)},
                  {"reason", text(differ.wrong_reason)},
                  {"pair", pair_json(scene, differ.wrong_pair)}};
  out["missing"] = {{"pairs", differ.missing}, {"first", pair_json(scene, differ.missing_pair)}};
  out["columns_not_looked_at"] = check.not_looked_at;
  return out;
}

double ns_per_pair(const CheckResult& result) {
  return result.found.box_pairs == 0
             ? 0
             : result.decide_ms * 1e6 / static_cast<double>(result.found.box_pairs);
}

std::string list_text(const Scene& scene, const SceneCheck& check) {
  const ListDifferences& differ = *check.differences;
  std::string out = fmt::format("           {} is {}this list: {}\n", check.list,
                                differ.none() ? "" : "not ", counted(differ.listed, "row", "rows"));
  if (differ.wrong > 0) {
    out +=
        fmt::format("           wrong: {}, the first in line {}: {}\n",
                    counted(differ.wrong, "row", "rows"), differ.wrong_line, differ.wrong_reason);
  }
  if (differ.missing > 0) {
    out += fmt::format("           missing: {}, the first {}\n",
                       counted(differ.missing, "pair", "pairs"),
                       pair_text(scene, *differ.missing_pair));
  }
  std::string columns;
  for (const std::string& name : check.not_looked_at)
    columns += (columns.empty() ? "" : ", ") + name;
  if (!columns.empty()) out += fmt::format("           not looked at: columns {}\n", columns);
  return out;
}

}  // namespace

Json pair_json(const Scene& scene, const std::optional<TrianglePair>& pair) {
  if (!pair) return nullptr;
  return {{"a", place_json(scene, pair->a)}, {"b", place_json(scene, pair->b)}};
}

std::string pair_text(const Scene& scene, const TrianglePair& pair) {
  const auto place = [&](std::uint32_t triangle) {
    const Place at = place_of(scene, triangle);
    return fmt::format("{} triangle {}", scene.objects[at.object].name, at.triangle);
  };
  return place(pair.a) + " and " + place(pair.b);
}

// A proof is about the scene, not about the run.
std::string proved_text(const Scene& scene, const SceneCheck& check) {
  const std::size_t pairs = check.result.meeting.size();
  const std::string near =
      check.clearance == 0 ? "" : fmt::format("at distance {} or less", check.clearance);
  std::string out;
  if (pairs == 0) {
    out = "no pair of the scene " + (near.empty() ? "meets" : "is " + near);
  } else if (pairs == 1) {
    out = "this pair of the scene " + (near.empty() ? "meets" : "is " + near) + ", and no other";
  } else {
    out = "these " + grouped(pairs) + " pairs of the scene " +
          (near.empty() ? "meet" : "are " + near) + ", and no others";
  }
  const bool self = std::any_of(scene.objects.begin(), scene.objects.end(),
                                [](const Object& object) { return object.self; });
  return !near.empty() && self ? out + " (neighbours only where they meet)" : out;
}

std::string verdict_text(const Scene& scene, const SceneCheck& check) {
  const CheckResult& result = check.result;
  std::string out =
      to_string(result.verdict) + ": " +
      (result.verdict == Verdict::proved ? proved_text(scene, check) : result.reason) + "\n";
  if (result.pair) out += fmt::format("  pair: {}\n", pair_text(scene, *result.pair));
  return out;
}

std::string check_text(const Scene& scene, const SceneCheck& check) {
  const CheckResult& result = check.result;
  std::string out = verdict_text(scene, check);
  if (const Certificate::Claims& found = result.found; !result.list_sha256.empty()) {
    out += fmt::format("list       SHA-256 of the pairs that {}: {}\n",
                       check.clearance == 0 ? "meet" : "are within it", result.list_sha256);
    if (check.differences) out += list_text(scene, check);
    out += not_asked_line(scene);
    out += fmt::format("boxes      {} {}: {} separated, {} neighbours, {} {}\n",
                       counted(found.box_pairs, "pair", "pairs"),
                       check.clearance != 0
                           ? fmt::format("at most {} apart along each axis", check.clearance)
                           : std::string(found.box_pairs == 1 ? "overlaps" : "overlap"),
                       grouped(found.separated), grouped(found.neighbours), grouped(found.meeting),
                       check.clearance == 0 ? "meet" : "within it");
    if (!check.certificate.empty()) {
      out += fmt::format("called     kept: {}; culled: {}, of which {} {}\n", grouped(found.kept),
                         grouped(found.culled), grouped(result.culled_meeting),
                         check.clearance == 0 ? "meet" : "are within it");
    }
  }
  out += unattested_text(check);
  out += fmt::format("time       {:.1f} ms; {:.1f} of them for the decisions, {:.0f} ns per pair\n",
                     result.ms, result.decide_ms, ns_per_pair(result));
  return out;
}

std::string unattested_text(const SceneCheck& check) {
  std::string out;
  if (!check.result.unattested.empty())
    out += "unattested, since the evidence is about the scene and not about the run:\n";
  for (const std::string& line : check.result.unattested) out += "  " + line + "\n";
  if (callers_floating_point() != kProved) {
    out += fmt::format("arithmetic: {}; the caller {}\n", to_string(floating_point()),
                       to_string(callers_floating_point()));
  }
  return out;
}

nlohmann::ordered_json check_json(const Scene& scene, const SceneCheck& check) {
  const CheckResult& result = check.result;
  return {{"certificate", check.certificate.empty() ? Json(nullptr) : Json(check.certificate)},
          {"scene",
           {{"name", scene.name},
            {"hash", scene_hash(scene)},
            {"self_not_asked", not_asked_json(scene)}}},
          {"clearance", check.clearance},
          {"verdict", to_string(result.verdict)},
          {"proves",
           result.verdict == Verdict::proved ? Json(proved_text(scene, check)) : Json(nullptr)},
          {"reason", result.reason.empty() ? Json(nullptr) : Json(result.reason)},
          {"pair", pair_json(scene, result.pair)},
          {"list", list_json(scene, check)},
          {"claimed", check.certificate.empty() ? Json(nullptr) : claims_json(check.claimed)},
          {"found", claims_json(result.found)},
          {"culled_meeting", result.culled_meeting},
          {"unattested", result.unattested},
          {"floating_point", floating_point_json(callers_floating_point(), floating_point())},
          {"ms", result.ms},
          {"decide_ms", result.decide_ms},
          {"ns_per_pair", ns_per_pair(result)}};
}

void FrameVerdicts::add(long frame, Verdict verdict, std::uint64_t listed) {
  const auto index = static_cast<std::size_t>(verdict);
  ++count_[index];
  if (!first_[index]) first_[index] = frame;
  listed_ += listed;
}

Verdict FrameVerdicts::in_all() const {
  return of(Verdict::refuted) > 0      ? Verdict::refuted
         : of(Verdict::not_proved) > 0 ? Verdict::not_proved
                                       : Verdict::proved;
}

Json FrameVerdicts::json(long wanted) const {
  const Verdict verdict = in_all();
  const auto& bad = first_[static_cast<std::size_t>(verdict)];
  return {{"frames", all()},
          {"wanted", wanted},
          {"proved", of(Verdict::proved)},
          {"refuted", of(Verdict::refuted)},
          {"not_proved", of(Verdict::not_proved)},
          {"verdict", to_string(verdict)},
          {"first", verdict == Verdict::proved ? Json(nullptr) : Json(*bad)}};
}

std::string FrameVerdicts::text(const std::string& proved) const {
  const Verdict verdict = in_all();
  if (verdict == Verdict::proved) {
    return fmt::format(
        "proved: in {} {}: {} in all\n",
        all() == 1 ? "the one frame" : fmt::format("each of {} frames", grouped(all())), proved,
        grouped(listed_));
  }
  std::string out =
      fmt::format("{}: {} of {}, the first is frame {}", to_string(verdict), grouped(of(verdict)),
                  counted(all(), "frame", "frames"), *first_[static_cast<std::size_t>(verdict)]);
  if (verdict == Verdict::refuted && of(Verdict::not_proved) > 0)
    out += fmt::format("; {} not proved", grouped(of(Verdict::not_proved)));
  return out + "\n";
}

}  // namespace farcull
