// Checks a certificate, a list of pairs, or both, with the checker of verify/certificate.
#include "experiments/record/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

Json list_json(const Scene& scene, const SceneCheck& check) {
  Json out = {{"claimed_sha256", text_json(check.claimed_sha256)},
              {"found_sha256", text_json(check.result.list_sha256)},
              {"given", text_json(check.list)},
              {"given_is_found", nullptr}};
  if (!check.differences) return out;
  const ListDifferences& differ = *check.differences;
  out["given_is_found"] = differ.none();
  out["lines"] = differ.listed;
  out["wrong"] = {{"lines", differ.wrong},
                  {"first", json_if(differ.wrong > 0, differ.wrong_line)},
                  {"reason", text_json(differ.wrong_reason)},
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

// Returns a text such as "bunny triangle 3 and floor triangle 0".
std::string pair_text(const Scene& scene, const TrianglePair& pair) {
  return place_text(scene, pair.a) + " and " + place_text(scene, pair.b);
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
    out += fmt::format("           missing: {}, the first of them: {}\n",
                       counted(differ.missing, "pair", "pairs"),
                       pair_text(scene, *differ.missing_pair));
  }
  if (!check.not_looked_at.empty()) {
    out +=
        fmt::format("           not looked at: columns {}\n", fmt::join(check.not_looked_at, ", "));
  }
  return out;
}

// Checks a list without a certificate. Makes evidence, and the checker verifies the evidence.
CheckResult check_list(const Scene& scene, const std::string& name,
                       std::span<const ListedPair> rows, double clearance) {
  const Stopwatch start;
  std::vector<TrianglePair> listed;
  for (const ListedPair& row : rows) {
    const TrianglePair pair = pair_of(scene, name, row);
    if (pair.a != pair.b) listed.push_back(pair);
  }
  // The evidence has to cover all pairs, so colliding pairs of ignored objects are added.
  if (const IgnoredObjects is_ignored(scene, scene.ignored); is_ignored.any()) {
    for (const TrianglePair& pair : all_colliding_pairs(scene, {.clearance = clearance}).pairs) {
      if (is_ignored(pair)) listed.push_back(pair);
    }
  }
  CheckResult result =
      check_certificate(certificate_of_list(scene, std::move(listed), clearance), scene);
  remove_ignored(scene, scene.ignored, result.meeting);
  result.unattested.clear();  // unattested claims are about a run; there was no run
  result.ms = start.ms();
  return result;
}

// Compares the list with the pairs that meet. Adapts the verdict, so that it covers the list, too.
void compare_list(const Scene& scene, const GivenList& list, std::span<const ListedPair> rows,
                  SceneCheck& check) {
  CheckResult& result = check.result;
  check.list = list.name;
  check.not_looked_at = list.not_looked_at;
  if (result.list_sha256.empty()) return;  // empty: no pair was decided
  check.differences = find_differences(scene, list.name, rows, result.meeting, check.clearance);
  const ListDifferences& differ = *check.differences;
  const bool alone = check.certificate.empty();
  if (differ.none()) {
    if (alone && result.verdict != Verdict::proved)
      throw std::logic_error("check: the evidence for a right list proves nothing: " +
                             result.reason);
    return;
  }
  if (!alone && result.verdict != Verdict::proved) return;
  result.verdict = alone ? Verdict::refuted : Verdict::not_proved;
  result.reason = fmt::format(
      "{} is {}: {}", list.name, alone ? "not the list of the pairs" : "another list",
      differ.wrong > 0 ? fmt::format("line {}: {}", differ.wrong_line, differ.wrong_reason)
                       : "a pair is missing");
  result.pair = differ.wrong > 0 ? differ.wrong_pair : differ.missing_pair;
}

}  // namespace

Json pair_json(const Scene& scene, const std::optional<TrianglePair>& pair) {
  if (!pair) return nullptr;
  return pair_json(scene, *pair);
}

std::string proved_text(const Scene& scene, const SceneCheck& check) {
  return proved_text(check.result.meeting.size(), check.clearance) +
         proved_limits(check.clearance, has_self(scene), !scene.ignored.empty());
}

std::string proved_limits(double clearance, bool self, bool ignores) {
  return std::string(clearance != 0 && self ? " (neighbours only where they meet)" : "") +
         (ignores ? ", of objects that are not ignored" : "");
}

std::string proved_text(std::size_t pairs, double clearance) {
  const std::string near = fmt::format("at distance {} or less", clearance);
  if (pairs > 1) {
    return "these " + grouped(pairs) + " pairs of the scene " +
           (clearance == 0 ? "meet" : "are " + near) + ", and no others";
  }
  return (pairs == 0 ? "no" : "this") +
         (" pair of the scene " + (clearance == 0 ? "meets" : "is " + near)) +
         (pairs == 0 ? "" : ", and no other");
}

std::string verdict_text(const Scene& scene, const SceneCheck& check) {
  const CheckResult& result = check.result;
  std::string out =
      to_string(result.verdict) + ": " +
      (result.verdict == Verdict::proved ? proved_text(scene, check) : one_line(result.reason)) +
      "\n";
  if (result.pair) out += fmt::format("  pair: {}\n", pair_text(scene, *result.pair));
  return out;
}

std::string check_text(const Scene& scene, const SceneCheck& check) {
  const CheckResult& result = check.result;
  std::string out = verdict_text(scene, check);
  if (const Certificate::Claims& found = result.found; !result.list_sha256.empty()) {
    out += fmt::format("list       {} (SHA-256 of the pairs{})\n", result.list_sha256,
                       scene.ignored.empty() ? "" : ", of ignored objects too");
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
  for (const std::string& line : check.result.unattested) out += "  " + one_line(line) + "\n";
  if (callers_floating_point() != kProved) {
    out += fmt::format("arithmetic: {}; the caller {}\n", to_string(floating_point()),
                       to_string(callers_floating_point()));
  }
  return out;
}

Json claims_json(const Certificate::Claims& claims) {
  return FARCULL_JSON(claims, box_pairs, kept, culled, separated, neighbours, meeting);
}

nlohmann::ordered_json check_json(const Scene& scene, const SceneCheck& check) {
  const CheckResult& result = check.result;
  return {{"certificate", text_json(check.certificate)},
          {"scene",
           {{"name", scene.name},
            {"hash", scene_hash(scene)},
            {"self_not_asked", not_asked_json(scene)}}},
          {"clearance", check.clearance},
          {"verdict", to_string(result.verdict)},
          {"proves", json_if(result.verdict == Verdict::proved, proved_text(scene, check))},
          {"reason", text_json(result.reason)},
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
  // If some of the wanted frames were not checked, `proved` becomes `not proved`.
  const bool whole = all() == static_cast<std::uint64_t>(wanted);
  const Verdict verdict = in_all() == Verdict::proved && !whole ? Verdict::not_proved : in_all();
  const auto& bad = first_[static_cast<std::size_t>(verdict)];
  return {{"frames", all()},
          {"wanted", wanted},
          {"proved", of(Verdict::proved)},
          {"refuted", of(Verdict::refuted)},
          {"not_proved", of(Verdict::not_proved)},
          {"verdict", to_string(verdict)},
          {"first", json_if(verdict != Verdict::proved, bad)}};
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

SceneCheck check_scene_with(double clearance, const std::string& file,
                            const std::optional<Certificate>& certificate, const Scene& scene,
                            const GivenList* list, std::span<const ListedPair> rows) {
  if (certificate) require_nothing_ignored(scene, "a certificate");
  SceneCheck out;
  out.clearance = clearance;
  if (certificate) {
    out.certificate = file;
    out.claimed_sha256 = certificate->list_sha256;
    out.claimed = certificate->claims;
    if (out.clearance == certificate->clearance) {
      out.result = check_certificate(*certificate, scene);
    } else {
      out.result.reason = fmt::format("the certificate is of another clearance: {}, not {}",
                                      certificate->clearance, out.clearance);
    }
  } else {
    out.result = check_list(scene, list->name, rows, out.clearance);
  }
  if (list) compare_list(scene, *list, rows, out);
  return out;
}

}  // namespace farcull
