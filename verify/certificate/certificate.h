// A certificate states what a run claims about every pair of triangles whose boxes overlap, with
// one byte of evidence per pair. So anyone can prove or refute the claims without the culling code.
// docs/certificate.md has the format, and the proof that 38 directions suffice.
//
// A check that passes proves which pairs of triangles meet, among the pairs that count. A pair
// counts if its triangles are of different objects, or of one object marked `self`. The check also
// proves a written list of the pairs, if the list has the hash in the certificate. Neighbours
// (verify/exact.h) meet iff they share more than their shared part. Pairs whose boxes are disjoint
// need no evidence. With a clearance D > 0, "meet" means "are at distance D or less", "overlap"
// means "are no farther apart than D", and "disjoint" means "farther apart than D". The distance of
// neighbours is 0, so a clearance has no effect on them.
//
// The certificate of a tile (docs/tiles.md) covers only the pairs that belong to the tile. If tiles
// cover an axis from end to end, their certificates together prove the whole list.
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

/// Pairs of triangles of one object that is not `self`. These pairs are not tested, so counts of
/// meeting, missed or proved pairs do not include them. A report of such a count has to state how
/// many pairs were not tested.
struct NotAsked {
  std::uint64_t objects = 0;                         // number of objects that are not `self`
  std::uint64_t pairs = 0;                           // number of pairs inside these objects
  std::vector<std::array<std::uint32_t, 2>> ranges;  // indices of these objects, as [first, last]
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
    std::uint64_t kept = 0;        // pairs that the method left to exact tests
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

  /// Facts that a run states about itself. The check cannot prove these facts.
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
    std::optional<Device> device;          // empty if nothing was drawn
    std::vector<std::string> assumptions;  // assumptions of the method about the device
    bool operator==(const Run&) const = default;
  };

  SceneKey scene;            // the whole scene, even for the certificate of a tile
  double clearance = 0;      // world units, finite, >= 0
  std::optional<Tile> tile;  // empty: the certificate covers all pairs
  Unasked not_asked;         // untested pairs of the whole scene
  Claims claims;
  std::string list_sha256;  // pair_list_hash() of the pairs that meet, as the run found
  Run run;
  /// One byte per pair, in the order of BoxPairs. Bits 0 to 5 hold kMeets, kNeighbours, or the
  /// number of a direction that separates the pair (integer_pair.h). Bit 6 (kKept) is 1 if the run
  /// kept the pair. Bit 7 is 0.
  std::vector<std::uint8_t> evidence;

  bool operator==(const Certificate&) const = default;
};

/// The members of Claims, with their names in the text of a certificate.
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

/// Data of the whole scene, for functions whose Scene has only the triangles that meet a tile.
struct WholeScene {
  Tile tile;
  const ListNumbers* numbers = nullptr;  // numbers of objects and triangles in the whole scene
  Certificate::SceneKey key;
  Certificate::Unasked not_asked;
};

Certificate::SceneKey key_of(const Scene& scene);
Certificate::Unasked unasked_of(const Scene& scene);

/// Makes the certificate of a run. kept: the pairs that culling left to the exact tests. colliding:
/// the kept pairs that meet according to the run, neighbours included. Each list is sorted, each
/// pair once, a < b. All pairs count and have overlapping boxes. whole: not null if the run was on
/// a tile; then all pairs belong to the tile. Throws std::logic_error if a list violates this.
///
/// The certificate repeats errors of the run, so that the check finds them. A kept pair is claimed
/// to meet iff it is in `colliding`. list_sha256 is the hash of `colliding`. If the run calls a
/// pair disjoint and no direction separates it, the byte has direction 0 for a kept pair, and
/// kMeets for a culled pair. Kept neighbours get kNeighbours. With a clearance > 0, omits kept
/// pairs whose boxes are farther apart than the clearance, since they need no evidence.
Certificate make_certificate(const Scene& scene, std::span<const TrianglePair> kept,
                             std::span<const TrianglePair> colliding, Certificate::Run run,
                             double clearance = 0, const WholeScene* whole = nullptr);

/// Makes a certificate for a list of pairs, as if a run had kept just these pairs and found that
/// they meet. Omits pairs that do not count or whose boxes are disjoint; find_differences()
/// (pair_list.h) finds these. listed: a < b, any order, repetitions allowed.
Certificate certificate_of_list(const Scene& scene, std::vector<TrianglePair> listed,
                                double clearance = 0);

/// Returns the certificate as JSON, with a fixed order of keys and a final newline. The version is
/// 5 for a tile, else 4 with a clearance, else 3. Bytes in strings that are not valid UTF-8 become
/// U+FFFD. Throws std::logic_error if a radius or the clearance is not finite.
std::string to_text(const Certificate& certificate);

/// The inverse of to_text(). Throws Error naming `name` and the fault if the text is not JSON of
/// exactly this form. Faults are: wrong syntax or UTF-8; unknown, missing or repeated keys; wrong
/// types, ranges, base64, format or version. Does not check the claims. Memory O(text).
Certificate parse_certificate(std::string_view text, const std::string& name);

enum class Verdict : std::uint8_t { proved, refuted, not_proved };
std::string to_string(Verdict verdict);

struct CheckResult {
  Verdict verdict = Verdict::not_proved;
  std::string reason;                   // empty if proved
  std::optional<TrianglePair> pair;     // pair that decides the verdict, if a pair does
  Certificate::Claims found;            // counts by the checker
  std::vector<TrianglePair> meeting;    // pairs that meet, as the checker decided; sorted
  std::string list_sha256;              // pair_list_hash() of `meeting`; empty if not computed
  std::uint64_t culled_meeting = 0;     // pairs that meet but are called culled
  std::vector<std::string> unattested;  // statements that the check cannot prove
  double ms = 0;                        // wall clock of the whole check
  double decide_ms = 0;                 // wall clock of the decisions alone
};

/// Decides every pair with overlapping boxes in integers, and compares the results with the claims.
/// - refuted: a pair meets and is called culled, or a claim about whether a pair meets is wrong.
///   The result names the first such pair.
/// - not_proved: no pair refutes the certificate, but the certificate has another fault: it is of
///   another scene, the evidence is too short or too long, a count or the hash of the list is
///   wrong, or a byte is wrong. A byte is wrong if it has no meaning, if its direction does not
///   separate the disjoint pair, or if the pair consists of neighbours that meet only in their
///   shared part and the byte is not kNeighbours.
/// - proved: there is no fault. So among the pairs that count, exactly the pairs of the list meet.
///   The check proves neither which pairs the run kept nor anything in Run.
/// If the scene or the length of the evidence is wrong, no decision is returned, since bytes and
/// pairs do not match.
/// With `whole`, `scene` has only the triangles that meet the tile, and the check covers the pairs
/// that belong to the tile. The certificate has to be of this tile and of the whole scene. Throws
/// std::logic_error if the clearance is negative or not finite. Precondition: validate() accepts
/// the scene.
CheckResult check_certificate(const Certificate& certificate, const Scene& scene,
                              const WholeScene* whole = nullptr);

}  // namespace farcull
