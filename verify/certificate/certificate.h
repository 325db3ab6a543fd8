// A certificate states what a run claims about every pair of triangles whose boxes overlap. It has
// one byte of evidence for each pair. So anyone can prove or refute the claims without the culling
// code. docs/certificate.md has the format and the proof that 38 directions suffice.
//
// A check that passes proves which pairs of triangles of the scene meet, among the pairs that
// count. A pair counts if its triangles are of different objects, or of one object marked `self`.
// The certificate has a hash of the list of the pairs that meet, so the check proves a written list
// with this hash as well. Neighbours (verify/exact.h) meet iff they share more than their shared
// part. Pairs whose boxes are disjoint need no evidence. With a clearance D > 0, "meets" means "is
// at distance D or less", "overlap" means "are no farther apart than D", and "disjoint" means
// "farther apart than D"; neighbours, whose distance is 0, are decided as without a clearance.
//
// The certificate of a tile (docs/tiles.md) is only about the pairs that belong to the tile. The
// certificates of tiles that together cover an axis from end to end prove the whole list.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/tile.h"

namespace farcull {

/// Pairs of triangles of one object that is not `self`. These pairs are not tested, and no count of
/// meeting, missed or proved pairs includes them. So a report of such a count has to state how many
/// pairs were not tested.
struct NotAsked {
  std::uint64_t objects = 0;                         // objects that are not `self`
  std::uint64_t pairs = 0;                           // pairs of two triangles of one such object
  std::vector<std::array<std::uint32_t, 2>> ranges;  // indices of such objects, as [first, last]
};

NotAsked not_asked(const Scene& scene);

struct Certificate {
  struct SceneKey {
    std::string name;
    std::uint64_t objects = 0;
    std::uint64_t triangles = 0;
    std::string hash;  // scene_hash(), which ignores names
    bool operator==(const SceneKey&) const = default;
  };

  struct Unasked {  // the counts of NotAsked
    std::uint64_t objects = 0;
    std::uint64_t pairs = 0;
    bool operator==(const Unasked&) const = default;
  };

  /// Numbers of pairs that count and whose closed boxes overlap: box_pairs = separated + neighbours
  /// + meeting = kept + culled.
  struct Claims {
    std::uint64_t box_pairs = 0;
    std::uint64_t kept = 0;        // the method left these pairs to the exact tests
    std::uint64_t culled = 0;      // box_pairs - kept
    std::uint64_t separated = 0;   // disjoint pairs
    std::uint64_t neighbours = 0;  // neighbours that meet only in their shared part
    std::uint64_t meeting = 0;     // box_pairs - separated - neighbours
    bool operator==(const Claims&) const = default;
  };

  struct View {
    std::string name;
    std::uint64_t width = 0;   // px
    std::uint64_t height = 0;  // px
    double radius_px = 0;
    bool operator==(const View&) const = default;
  };

  /// Statements of a run about itself. No check can prove them.
  struct Run {
    std::string method;
    std::uint64_t resolution = 0;  // px; 0 if nothing was drawn
    double radius_px = 0;          // the largest radius of the views; finite, >= 0
    std::string offset;
    std::vector<View> views;
    struct Device {
      std::string vendor, renderer, version, glsl;
      bool operator==(const Device&) const = default;
    };
    std::optional<Device> device;          // none if nothing was drawn
    std::vector<std::string> assumptions;  // about the device; the method relied on them
    bool operator==(const Run&) const = default;
  };

  SceneKey scene;            // the whole scene, even if the certificate is of a tile
  double clearance = 0;      // world units, finite, >= 0
  std::optional<Tile> tile;  // none: the certificate is about all pairs
  Unasked not_asked;         // the pairs that the whole scene does not ask about
  Claims claims;
  std::string list_sha256;  // pair_list_hash() of the pairs that the run found to meet
  Run run;
  /// One byte per pair, in the order of BoxPairs. Bits 0 to 5 hold a direction that separates the
  /// pair (integer_pair.h), or kMeets, or kNeighbours. Bit 6 (kKept) is 1 if the run kept the pair.
  /// Bit 7 is 0.
  std::vector<std::uint8_t> evidence;

  bool operator==(const Certificate&) const = default;
};

/// The counts of Claims, each with its name in the text of a certificate.
inline constexpr std::pair<const char*, std::uint64_t Certificate::Claims::*> kClaims[] = {
    {"box_pairs", &Certificate::Claims::box_pairs},
    {"kept", &Certificate::Claims::kept},
    {"culled", &Certificate::Claims::culled},
    {"separated", &Certificate::Claims::separated},
    {"neighbours", &Certificate::Claims::neighbours},
    {"meeting", &Certificate::Claims::meeting}};

constexpr std::uint8_t kMeets = 38;
constexpr std::uint8_t kNeighbours = 39;
constexpr std::uint8_t kKept = 0x40;

struct ListNumbers;

/// Facts about the whole scene, for functions whose Scene has only the triangles that meet a tile.
struct WholeScene {
  Tile tile;
  const ListNumbers* numbers = nullptr;  // numbers of objects and triangles in the whole scene
  Certificate::SceneKey key;
  Certificate::Unasked not_asked;
};

Certificate::SceneKey key_of(const Scene& scene);
Certificate::Unasked unasked_of(const Scene& scene);

/// Makes the certificate of a run. kept: the pairs that culling left to the exact tests. colliding:
/// the kept pairs that the run found to meet, neighbours included. Each list is sorted, each pair
/// once, a < b. All pairs count and have overlapping boxes. whole: not null if the run was on a
/// tile; then all pairs belong to the tile. Throws std::logic_error if a list violates this.
///
/// If the run made an error, the certificate claims the same, so that the check refutes it. A kept
/// pair is claimed to meet iff it is in `colliding`. list_sha256 is the hash of `colliding`. If the
/// run calls a pair disjoint and no direction proves it, the pair gets direction 0 if it was kept,
/// and kMeets if it was culled; kept neighbours get kNeighbours. With a clearance > 0, kept pairs
/// whose boxes are farther apart than the clearance are left out, since they need no evidence.
Certificate make_certificate(const Scene& scene, std::span<const TrianglePair> kept,
                             std::span<const TrianglePair> colliding, Certificate::Run run,
                             double clearance = 0, const WholeScene* whole = nullptr);

/// Makes a certificate for a list of pairs, as if a run had kept just these pairs and found that
/// they meet. Leaves out pairs that do not count or whose boxes are disjoint; find_differences()
/// (pair_list.h) names these. listed: a < b, any order, repetitions allowed.
Certificate certificate_of_list(const Scene& scene, std::vector<TrianglePair> listed,
                                double clearance = 0);

/// Returns the certificate as JSON, with the keys always in the same order and a final newline. The
/// version is 5 for a tile, else 4 with a clearance, else 3. Bytes in strings that are not valid
/// UTF-8 become U+FFFD. Throws std::logic_error if a radius or the clearance is not finite.
std::string to_text(const Certificate& certificate);

/// The inverse of to_text(). Throws Error naming `name` and the fault if the text is not JSON of
/// exactly this form. Faults are: wrong syntax or UTF-8; unknown, missing or repeated keys; wrong
/// types, ranges, base64, format or version. The claims are not checked. Memory O(text).
Certificate parse_certificate(std::string_view text, const std::string& name);

enum class Verdict : std::uint8_t { proved, refuted, not_proved };
std::string to_string(Verdict verdict);

struct CheckResult {
  Verdict verdict = Verdict::not_proved;
  std::string reason;                   // empty if proved
  std::optional<TrianglePair> pair;     // the pair that decides the verdict, if one does
  Certificate::Claims found;            // the checker's own counts
  std::vector<TrianglePair> meeting;    // the pairs that meet, as the checker decided; sorted
  std::string list_sha256;              // pair_list_hash() of `meeting`; empty without decisions
  std::uint64_t culled_meeting = 0;     // number of pairs that meet but are called culled
  std::vector<std::string> unattested;  // what the check cannot prove, one item each
  double ms = 0;                        // wall clock of the whole check
  double decide_ms = 0;                 // wall clock of the decisions alone
};

/// Decides every pair with overlapping boxes in integers, and compares the answers with the claims.
/// - refuted: the certificate calls a pair culled that meets, or it is wrong about whether a pair
///   meets. The result names the first such pair.
/// - not_proved: no pair refutes the certificate, but the certificate has another fault: it is of
///   another scene, the evidence is too short or too long, a count or the hash of the list is
///   wrong, or a byte is wrong. A byte is wrong if it has no meaning, if its direction does not
///   separate the disjoint pair, or if it does not say that neighbours meet only in their shared
///   part.
/// - proved: there is no fault. So of the pairs that count, exactly the pairs of the list meet. The
///   check does not prove which pairs the run kept, nor anything else in Run.
/// If the scene or the length of the evidence is wrong, no decision is returned, since bytes and
/// pairs do not match.
/// With `whole`, `scene` has only the triangles that meet the tile. The check is then about the
/// pairs that belong to the tile. The certificate has to be of this tile and of the whole scene.
/// Throws std::logic_error if the clearance is negative or not finite. Precondition: validate()
/// accepts the scene.
CheckResult check_certificate(const Certificate& certificate, const Scene& scene,
                              const WholeScene* whole = nullptr);

}  // namespace farcull
