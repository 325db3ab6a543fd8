// Checks a certificate, a list of pairs, or both against a scene. The verdict is about all that was
// given.
#include "experiments/record/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/stopwatch.h"
#include "core/scene/scene.h"

namespace farcull {
namespace {

std::string differences_text(const ListDifferences& differ) {
  return differ.wrong > 0 ? fmt::format("line {}: {}", differ.wrong_line, differ.wrong_reason)
                          : "a pair is missing";
}

// The evidence for a list is made here. The checker trusts it no more than any other.
CheckResult check_list(const Scene& scene, const std::string& name,
                       std::span<const ListedPair> rows, double clearance) {
  const Stopwatch start;
  std::vector<TrianglePair> listed;
  for (const ListedPair& row : rows) {
    const TrianglePair pair = pair_of(scene, name, row);
    if (pair.a != pair.b) listed.push_back(pair);
  }
  CheckResult result =
      check_certificate(certificate_of_list(scene, std::move(listed), clearance), scene);
  result.unattested.clear();  // there is no run
  result.ms = start.ms();
  return result;
}

// Takes the list into account: the verdict is about both.
void compare_list(const Scene& scene, const GivenList& list, std::span<const ListedPair> rows,
                  SceneCheck& check) {
  CheckResult& result = check.result;
  check.list = list.name;
  check.not_looked_at = list.not_looked_at;
  if (result.list_sha256.empty()) return;  // nothing was decided
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
  result.reason =
      fmt::format("{} is {}: {}", list.name, alone ? "not the list of the pairs" : "another list",
                  differences_text(differ));
  result.pair = differ.wrong > 0 ? differ.wrong_pair : differ.missing_pair;
}

}  // namespace

SceneCheck check_scene_with(double clearance, const std::string& file,
                            const std::optional<Certificate>& certificate, const Scene& scene,
                            const GivenList* list, std::span<const ListedPair> rows) {
  require_nothing_ignored(scene, "a check");
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
