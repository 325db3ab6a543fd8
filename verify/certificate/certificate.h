// A certificate says what a run claims about every pair of triangles whose boxes overlap, with one
// byte of evidence for each pair. So a stranger can prove or refute the claims without any of the
// code that culled. docs/certificate.md has the format and the proof that 38 directions suffice.
//
// A check that passes proves something about the scene alone: which of the pairs of triangles that
// count meet. A pair counts if its triangles are of different objects, or of one object marked
// `self`. The certificate names the list of the pairs that meet by its hash, so that a written list
// is proved, too. Neighbours (verify/exact.h) meet iff they share more than their shared part.
// Pairs whose boxes are disjoint need no evidence. With a clearance D > 0, "meets" means "is at
// distance D or less", "overlap" means "are no farther apart than D", and "disjoint" means "farther
// apart than D"; neighbours, whose distance is 0, are decided as without a clearance.
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

/// The pairs that a scene does not ask about: those inside an object that is not `self`. No count
/// of pairs that meet, are missed or are proved includes them, so a report of such a count reports
/// these pairs as well.
struct NotAsked {
  std::uint64_t objects = 0;                         // that are not tested against themselves
  std::uint64_t pairs = 0;                           // of two triangles inside one of them
  std::vector<std::array<std::uint32_t, 2>> ranges;  // these objects, as [first, last]
};

NotAsked not_asked(const Scene& scene);

struct Certificate {
  struct SceneKey {
    std::string name;
    std::uint64_t objects = 0;
    std::uint64_t triangles = 0;
    std::string hash;  // scene_hash(); names do not count
    bool operator==(const SceneKey&) const = default;
  };

  struct Unasked {  // as NotAsked
    std::uint64_t objects = 0;
    std::uint64_t pairs = 0;
    bool operator==(const Unasked&) const = default;
  };

  /// Numbers of pairs that count and whose closed boxes overlap: box_pairs = separated + neighbours
  /// + meeting = kept + culled.
  struct Claims {
    std::uint64_t box_pairs = 0;
    std::uint64_t kept = 0;        // called kept: left to the exact tests by the method
    std::uint64_t culled = 0;      // box_pairs - kept
    std::uint64_t separated = 0;   // disjoint
    std::uint64_t neighbours = 0;  // neighbours that meet only in what they share
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

  /// For the reader's information; no check can attest it.
  struct Run {
    std::string method;
    std::uint64_t resolution = 0;  // px; 0 where nothing was drawn
    double radius_px = 0;          // the largest of the views; finite, >= 0
    std::string offset;
    std::vector<View> views;
    struct Device {
      std::string vendor, renderer, version, glsl;
      bool operator==(const Device&) const = default;
    };
    std::optional<Device> device;          // none where nothing was drawn
    std::vector<std::string> assumptions;  // of the device, that the method relied on
    bool operator==(const Run&) const = default;
  };

  SceneKey scene;            // the whole scene, also of a tile's certificate
  double clearance = 0;      // world units, finite, >= 0
  std::optional<Tile> tile;  // none: the certificate is about all pairs
  Unasked not_asked;         // of the whole scene
  Claims claims;
  std::string list_sha256;  // pair_list_hash() of the pairs that the run found to meet
  Run run;
  /// One byte per pair in the order of BoxPairs. Bits 0 .. 5: a direction (integer_pair.h) that
  /// separates the pair, or kMeets, or kNeighbours; bit 6 (kKept): the run kept the pair; bit 7: 0.
  std::vector<std::uint8_t> evidence;

  bool operator==(const Certificate&) const = default;
};

/// The counts of the claims by their names in a certificate.
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

/// The whole scene, for a scene that has only those of its triangles that meet a tile.
struct WholeScene {
  Tile tile;
  const ListNumbers* numbers = nullptr;  // of the part's objects and triangles in the whole scene
  Certificate::SceneKey key;
  Certificate::Unasked not_asked;
};

Certificate::SceneKey key_of(const Scene& scene);
Certificate::Unasked unasked_of(const Scene& scene);

/// Makes the certificate of a run. kept: the pairs that culling left to the exact tests. colliding:
/// the kept pairs that the run found to meet, neighbours included. Both are sorted, each pair once,
/// a < b; the pairs count and have overlapping boxes; colliding is a part of kept. whole: not null
/// if the run was on a tile; then all pairs belong to the tile. Throws std::logic_error otherwise.
///
/// Errors of the run are written as the run made them, so that the check refutes them. A kept pair
/// is said to meet iff it is in `colliding`, which also gives the hash of the list. If the run
/// calls a pair disjoint but no direction proves it, the pair gets direction 0 if it was kept
/// (neighbours: kNeighbours), and kMeets if it was culled. With a clearance > 0, kept pairs whose
/// boxes are farther apart than the clearance are left out: a method may keep such pairs, but they
/// need no evidence.
Certificate make_certificate(const Scene& scene, std::span<const TrianglePair> kept,
                             std::span<const TrianglePair> colliding, Certificate::Run run,
                             double clearance = 0, const WholeScene* whole = nullptr);

/// Makes a certificate for a list that has none, as for a run that kept just these pairs and found
/// that they meet. Pairs of the list that do not count, or whose boxes are disjoint, are left out:
/// find_differences() (pair_list.h) names them. listed: a < b, any order, repetitions allowed.
Certificate certificate_of_list(const Scene& scene, std::vector<TrianglePair> listed,
                                double clearance = 0);

/// The certificate as JSON, the keys always in the same order, with a final newline. The version is
/// 3, or 4 with a clearance, or 5 of a tile. Bytes of strings that are not UTF-8 become U+FFFD.
/// Throws std::logic_error if a radius is not finite.
std::string to_text(const Certificate& certificate);

/// The inverse of to_text(). Throws Error naming `name` and the fault if the text is not JSON of
/// exactly this form: syntax, UTF-8, keys unknown, missing or twice, types, ranges, base64, format
/// or version. It does not judge what the certificate claims. Memory in proportion to the text.
Certificate parse_certificate(std::string_view text, const std::string& name);

enum class Verdict : std::uint8_t { proved, refuted, not_proved };
std::string to_string(Verdict verdict);

struct CheckResult {
  Verdict verdict = Verdict::not_proved;
  std::string reason;                   // empty where proved
  std::optional<TrianglePair> pair;     // the pair that refutes, or whose evidence fails
  Certificate::Claims found;            // counted by the checker, whatever was claimed
  std::vector<TrianglePair> meeting;    // the pairs that meet, sorted; decided by the checker
  std::string list_sha256;              // pair_list_hash() of `meeting`; empty if none was decided
  std::uint64_t culled_meeting = 0;     // pairs that the certificate calls culled and that meet
  std::vector<std::string> unattested;  // what the check cannot prove, one line each
  double ms = 0;                        // wall clock of the check: hash, enumeration and decisions
  double decide_ms = 0;                 // wall clock of the decisions alone, on all cores
};

/// Decides every pair of the scene whose boxes overlap, in integers, and compares with the claims.
/// - refuted: the certificate calls a pair culled that meets, or is wrong about whether a pair
///   meets. The first such pair in order is named.
/// - not_proved: there is no such pair, but the certificate is of another scene, the evidence is
///   too short or too long, a count or the hash of the list is wrong, or a byte is wrong: it has no
///   meaning, its direction does not separate the pair (which is disjoint), or it does not say that
///   neighbours meet only in what they share.
/// - proved: neither. So the pairs of the list meet, and no others that count. The check does not
///   prove which pairs the run kept, nor anything else in Run. If a pair that meets is called kept,
///   the claim about the scene is true, whatever the run did.
/// For another scene or a wrong length nothing is decided: bytes and pairs do not belong together.
/// With `whole`, the scene has the triangles that meet the tile, and the check is about the pairs
/// that belong to it; the certificate has to be of this tile and of the whole scene.
/// Throws std::logic_error if the clearance is negative or not finite. Precondition: validate()
/// accepts the scene.
CheckResult check_certificate(const Certificate& certificate, const Scene& scene,
                              const WholeScene* whole = nullptr);

}  // namespace farcull
