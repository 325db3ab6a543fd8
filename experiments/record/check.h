// `farcull check`: checks one scene, and returns the result as text for people and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "verify/certificate/certificate.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

/// The result for one scene, of which a certificate, a list of pairs, or both were checked.
struct SceneCheck {
  std::string certificate;  // file name; empty if only a list was checked
  std::string list;         // file name; empty if no list was given
  double clearance = 0;
  std::string claimed_sha256;  // hash of the list, as the certificate states it
  Certificate::Claims claimed;
  CheckResult result;                          // also covers the list, if one was given
  std::optional<ListDifferences> differences;  // set if a list was given and pairs were decided
  std::vector<std::string> not_looked_at;      // names of columns of the list that are ignored
};

nlohmann::ordered_json pair_json(const Scene& scene, const std::optional<TrianglePair>& pair);

/// Returns what the verdict `proved` proves: "these 12 pairs of the scene meet, and no others".
std::string proved_text(const Scene& scene, const SceneCheck& check);
/// Returns the beginning of that statement, without the limits.
std::string proved_text(std::size_t pairs, double clearance);
/// Returns the limits at the end of that statement; empty if the statement is about all pairs.
/// self: an object is tested against itself. ignores: some pairs of objects are ignored.
std::string proved_limits(double clearance, bool self, bool ignores);
/// Returns one or two lines: the verdict, its reason, and the pair that the reason is about.
std::string verdict_text(const Scene& scene, const SceneCheck& check);
std::string check_text(const Scene& scene, const SceneCheck& check);
/// Returns lines about claims that no check can prove, and about an unusual floating-point mode of
/// the caller. May be empty.
std::string unattested_text(const SceneCheck& check);

nlohmann::ordered_json check_json(const Scene& scene, const SceneCheck& check);
nlohmann::ordered_json claims_json(const Certificate::Claims& claims);

/// The verdicts of several frames, and the verdict about all frames: refuted if at least one frame
/// is refuted, else not proved if at least one frame is not proved, else proved.
class FrameVerdicts {
 public:
  /// listed: number of pairs that the verdict is about.
  void add(long frame, Verdict verdict, std::uint64_t listed);
  Verdict in_all() const;
  /// wanted: number of frames that were requested.
  nlohmann::ordered_json json(long wanted) const;
  /// proved: the statement that the text gives if all frames are proved.
  std::string text(const std::string& proved) const;

 private:
  std::uint64_t of(Verdict verdict) const { return count_[static_cast<std::size_t>(verdict)]; }
  std::uint64_t all() const { return count_[0] + count_[1] + count_[2]; }

  std::array<std::uint64_t, 3> count_{};        // number of frames with each Verdict
  std::array<std::optional<long>, 3> first_{};  // the first frame with each Verdict
  std::uint64_t listed_ = 0;
};

/// Checks a certificate, a list of pairs, or both. The verdict covers everything that was checked.
/// A list alone is proved or refuted. file: the name of the certificate, or "". rows: the rows of
/// the list that are about this scene. Throws Error if the list names objects or triangles that the
/// scene does not have. Precondition: a certificate or a list is given.
SceneCheck check_scene_with(double clearance, const std::string& file,
                            const std::optional<Certificate>& certificate, const Scene& scene,
                            const GivenList* list, std::span<const ListedPair> rows);

}  // namespace farcull
