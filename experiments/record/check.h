// `farcull check`: checks one scene, and gives the outcome as text for people and as JSON.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "verify/certificate/certificate.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

/// A check of one scene: of a certificate, of a list of pairs, or of both.
struct SceneCheck {
  std::string certificate;  // a file; empty if a list was checked without a certificate
  std::string list;         // a file; empty if no list was given
  double clearance = 0;
  std::string claimed_sha256;  // the hash of the list that the certificate names
  Certificate::Claims claimed;
  CheckResult result;                          // its verdict is also about the list, if given
  std::optional<ListDifferences> differences;  // set if a list was given and pairs were decided
  std::vector<std::string> not_looked_at;      // columns of the list that were not read
};

/// "bunny triangle 3 and floor triangle 0".
std::string pair_text(const Scene& scene, const TrianglePair& pair);
/// The pair as JSON; null if there is none.
nlohmann::ordered_json pair_json(const Scene& scene, const std::optional<TrianglePair>& pair);

/// The statement that the check has proved if its verdict is `proved`: "these 12 pairs of the scene
/// meet, and no others".
std::string proved_text(const Scene& scene, const SceneCheck& check);
/// The same for this many pairs, without proved_limits().
std::string proved_text(std::size_t pairs, double clearance);
/// The end of the statement if it is not about all pairs. self: whether an object is tested against
/// itself; ignores: whether pairs of objects are ignored.
std::string proved_limits(double clearance, bool self, bool ignores);
/// The verdict with its reason, and the pair that it is about: one line or two.
std::string verdict_text(const Scene& scene, const SceneCheck& check);
/// The verdict and everything else.
std::string check_text(const Scene& scene, const SceneCheck& check);
/// Lines about claims that no check can prove, and about the arithmetic; empty if there are none.
std::string unattested_text(const SceneCheck& check);

nlohmann::ordered_json check_json(const Scene& scene, const SceneCheck& check);
nlohmann::ordered_json claims_json(const Certificate::Claims& claims);

/// The verdicts of several frames, and the verdict about all of them: refuted if one frame is
/// refuted, else not proved if one frame is not proved.
class FrameVerdicts {
 public:
  /// listed: how many pairs the verdict is about.
  void add(long frame, Verdict verdict, std::uint64_t listed);
  Verdict in_all() const;
  /// wanted: how many frames were asked for.
  nlohmann::ordered_json json(long wanted) const;
  /// proved: the statement that is proved of each frame if all frames are proved.
  std::string text(const std::string& proved) const;

 private:
  std::uint64_t of(Verdict verdict) const { return count_[static_cast<std::size_t>(verdict)]; }
  std::uint64_t all() const { return count_[0] + count_[1] + count_[2]; }

  std::array<std::uint64_t, 3> count_{};        // by Verdict
  std::array<std::optional<long>, 3> first_{};  // by Verdict
  std::uint64_t listed_ = 0;
};

/// Checks a certificate, a list of pairs, or both. clearance: the one that is asked about; file:
/// the printed name of the certificate, "" for none; rows: the rows of the list that are about this
/// scene. If both are given, the verdict is about both. A list alone is proved or refuted. Throws
/// Error if the list names objects or triangles that the scene does not have. Precondition: a
/// certificate or a list is given.
SceneCheck check_scene_with(double clearance, const std::string& file,
                            const std::optional<Certificate>& certificate, const Scene& scene,
                            const GivenList* list, std::span<const ListedPair> rows);

}  // namespace farcull
