// `farcull check`: what it does with one scene, and the outcome as text for people and as JSON.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "verify/certificate/certificate.h"
#include "verify/certificate/distance_certificate.h"
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

/// "bunny triangle 3 and floor triangle 0".
std::string pair_text(const Scene& scene, const TrianglePair& pair);
/// null without a pair.
nlohmann::ordered_json pair_json(const Scene& scene, const std::optional<TrianglePair>& pair);

/// "these 12 pairs of the scene meet, and no others": what is proved where everything is.
std::string proved_text(const Scene& scene, const SceneCheck& check);
/// The verdict with its reason, and the pair that it is about: one line or two.
std::string verdict_text(const Scene& scene, const SceneCheck& check);
/// The verdict and everything else.
std::string check_text(const Scene& scene, const SceneCheck& check);
/// Lines about what no check attests and about the arithmetic; empty where there are none.
std::string unattested_text(const SceneCheck& check);

nlohmann::ordered_json check_json(const Scene& scene, const SceneCheck& check);

/// The verdicts of several frames, and the one in all: refuted if one is, else not proved if one
/// is.
class FrameVerdicts {
 public:
  /// listed: how many pairs it is about.
  void add(long frame, Verdict verdict, std::uint64_t listed);
  Verdict in_all() const;
  /// wanted: how many frames were asked for.
  nlohmann::ordered_json json(long wanted) const;
  /// proved: what is proved of each frame where all are.
  std::string text(const std::string& proved) const;

 private:
  std::uint64_t of(Verdict verdict) const { return count_[static_cast<std::size_t>(verdict)]; }
  std::uint64_t all() const { return count_[0] + count_[1] + count_[2]; }

  std::array<std::uint64_t, 3> count_{};        // by Verdict
  std::array<std::optional<long>, 3> first_{};  // by Verdict
  std::uint64_t listed_ = 0;
};

/// Checks what is given: a certificate, a list of pairs, or both. clearance: that is asked about;
/// file: the name of the certificate, as it is printed, "" for none; rows: of the list, those that
/// are about this scene. With a list the verdict is about both: a list alone is proved or refuted.
/// Throws Error if the list names objects or triangles that the scene does not have.
/// Precondition: certificate or list is there.
SceneCheck check_scene_with(double clearance, const std::string& file,
                            const std::optional<Certificate>& certificate, const Scene& scene,
                            const GivenList* list, std::span<const ListedPair> rows);

/// A certificate of distances with what its check found.
struct CheckedDistances {
  std::string file;
  DistanceCertificate certificate;
  DistanceCheck result;
};

/// "these 3 pairs of objects are at exactly these distances, ...": what is proved where everything
/// is.
std::string proved_text(const CheckedDistances& check);
/// The verdict with its reason, and the pair that it is about.
std::string verdict_text(const Scene& scene, const CheckedDistances& check);
/// The verdict and everything else.
std::string check_text(const Scene& scene, const CheckedDistances& check);
nlohmann::ordered_json check_json(const Scene& scene, const CheckedDistances& check);

}  // namespace farcull
