// Turns what the checker of distances found into text and JSON.
#include "experiments/record/distance_result.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/floating_point.h"
#include "experiments/record/check_result.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;
using Pairs = DistanceCertificate::Pairs;

// A fraction may have thousands of digits.
std::string shortened(const std::string& fraction) {
  constexpr std::size_t kMost = 120;
  if (fraction.size() <= kMost) return fraction;
  return fraction.substr(0, kMost) + "... (whole with --json)";
}

}  // namespace

std::string proved_text(const CheckedDistances& check) {
  const DistanceCertificate& c = check.certificate;
  const std::size_t count = c.distances.size();
  const bool all = c.pairs == Pairs::all;
  const std::string what = all ? "triangles" : "objects";
  const std::string within =
      std::isfinite(c.within) ? fmt::format("at distance {} or less", c.within) : "";
  if (count == 0) {
    return "no two " + what + (within.empty() ? " have a distance" : " are " + within);
  }
  const std::string these = count == 1
                                ? fmt::format("this pair of {} is", what)
                                : fmt::format("these {} pairs of {} are", grouped(count), what);
  const std::string others = count == 1 ? "no other" : "no others";
  std::string out = these + " at exactly " + (count == 1 ? "this distance" : "these distances");
  if (c.pairs == Pairs::nearest) {
    return out + fmt::format(", and {} each object's {}nearest{}, and {}",
                             count == 1 ? "it is" : "they are", c.k == 1 ? "" : grouped(c.k) + " ",
                             within.empty() ? "" : " " + within, others);
  }
  if (within.empty()) return out + ", and there " + (count == 1 ? "is " : "are ") + others;
  return out + ", and " + others + (count == 1 ? " is " : " are ") + within;
}

std::string verdict_text(const Scene& scene, const CheckedDistances& check) {
  const DistanceCheck& result = check.result;
  const bool proved = result.verdict == Verdict::proved;
  std::string out =
      to_string(result.verdict) + ": " + (proved ? proved_text(check) : result.reason) + "\n";
  if (!result.pair) return out;
  return out + fmt::format("  pair: {}\n  the exact square of its distance: {}, so about {}\n",
                           pair_text(scene, *result.pair), shortened(result.squared),
                           result.distance);
}

std::string check_text(const Scene& scene, const CheckedDistances& check) {
  const DistanceCheck& result = check.result;
  const bool all = check.certificate.pairs == Pairs::all;
  std::string out = verdict_text(scene, check);
  if (all) out += not_asked_line(scene);
  if (result.decided > 0 || result.verdict == Verdict::proved) {
    out += fmt::format("decided    {} in integers; boxes prove the others far enough apart\n",
                       counted(result.decided, "pair of triangles", "pairs of triangles"));
  }
  if (result.neighbours > 0) {
    out += fmt::format("neighbours {} near each other, which do not count\n",
                       counted(result.neighbours, "pair", "pairs"));
  }
  if (callers_floating_point() != kProved) {
    out += fmt::format("arithmetic {}; the caller {}\n", to_string(floating_point()),
                       to_string(callers_floating_point()));
  }
  return out + fmt::format("time       {:.1f} ms\n", result.ms);
}

Json check_json(const Scene& scene, const CheckedDistances& check) {
  const DistanceCertificate& c = check.certificate;
  const DistanceCheck& result = check.result;
  const bool proved = result.verdict == Verdict::proved;
  const auto text = [](const std::string& of) { return of.empty() ? Json(nullptr) : Json(of); };
  return {{"certificate", check.file},
          {"scene",
           {{"name", scene.name},
            {"hash", scene_hash(scene)},
            {"self_not_asked", not_asked_json(scene)}}},
          {"query",
           {{"pairs", to_string(c.pairs)},
            {"k", c.pairs == Pairs::nearest ? Json(c.k) : Json(nullptr)},
            {"within", std::isfinite(c.within) ? Json(c.within) : Json(nullptr)}}},
          {"verdict", to_string(result.verdict)},
          {"proves", proved ? Json(proved_text(check)) : Json(nullptr)},
          {"reason", text(result.reason)},
          {"pair", pair_json(scene, result.pair)},
          {"squared", text(result.squared)},
          {"distance",
           result.pair && std::isfinite(result.distance) ? Json(result.distance) : Json(nullptr)},
          {"listed", c.distances.size()},
          {"decided", result.decided},
          {"neighbours", result.neighbours},
          {"floating_point", floating_point_json(callers_floating_point(), floating_point())},
          {"ms", result.ms}};
}

}  // namespace farcull
