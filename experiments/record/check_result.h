// The outcome of `farcull check`, as text for people and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "verify/certificate/certificate.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

/// A check of one scene: of a certificate, of a list of pairs, or of both.
struct SceneCheck {
  std::string certificate;  // a file; empty where a list was checked without one
  std::string list;         // a file; empty where none was given
  double clearance = 0;
  std::string claimed_sha256;  // of the certificate, and what it claims
  Certificate::Claims claimed;
  CheckResult result;                          // with the list taken into account
  std::optional<ListDifferences> differences;  // where a list was given and the pairs were decided
  std::vector<std::string> not_looked_at;      // columns of the list
};

/// "these 12 pairs of the scene meet, and no others": what is proved where everything is.
std::string proved_text(const Scene& scene, const SceneCheck& check);
/// The verdict with its reason, and the pair that it is about: one line or two.
std::string verdict_text(const Scene& scene, const SceneCheck& check);
/// The verdict and everything else.
std::string check_text(const Scene& scene, const SceneCheck& check);
/// Lines about what no check attests and about the arithmetic; empty where there are none.
std::string unattested_text(const SceneCheck& check);

nlohmann::ordered_json check_json(const Scene& scene, const SceneCheck& check);

}  // namespace farcull
