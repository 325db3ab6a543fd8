// A certificate of distances: the answer of `farcull distance` about a scene. A stranger can prove
// it in integers, without any of the code that found it. docs/certificate.md defines the format and
// has the proof.
//
// A check that passes proves something about the scene alone: that the question has these answers
// and no others, that each distance is exactly the one named, and where it is realised.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/integer_distance.h"

namespace farcull {

/// The answer about two objects, or about two triangles of them.
struct DistanceEntry {
  std::array<std::uint32_t, 2> objects{};
  std::array<std::uint32_t, 2> triangles{};  // numbered within their objects
  std::string squared;                       // the exact square, world units: decimal "5/4", in
                                             // lowest terms
  std::array<std::uint8_t, 2> features{};    // of each triangle the feature with the nearest point:
                                           // 0 to 2 a corner, 3 to 5 the edge from corner 0 to 2 to
                                           // the next, 6 the face; the first such two features
  InsideClaim inside = InsideClaim::unknown;  // for disjoint objects; unknown: nothing is claimed
  bool operator==(const DistanceEntry&) const = default;
};

struct DistanceCertificate {
  /// The question. An object without triangles has no distance and is never named.
  /// objects: for each two objects (or one object that is `self`, with itself) at most `within`
  ///   apart, their distance and the first of the nearest pairs of triangles.
  /// nearest: the same for each two objects at most `within` apart of which one is among the k
  ///   nearest of the other; at equal distance the lower object is nearer.
  /// all: each two triangles at most `within` apart, of different objects or of one that is `self`.
  /// Neighbours (verify/exact.h) of one object never count.
  enum class Pairs : std::uint8_t { objects, nearest, all };

  Certificate::SceneKey scene;
  Pairs pairs = Pairs::objects;
  std::uint64_t k = 0;                                      // >= 1 with `nearest`, else 0
  double within = std::numeric_limits<double>::infinity();  // world units, >= 0; finite with `all`
  std::vector<DistanceEntry> distances;  // sorted by objects, then by triangles, each once

  bool operator==(const DistanceCertificate&) const = default;
};
std::string to_string(DistanceCertificate::Pairs pairs);

/// The entry of a pair of global triangle indices a < b. Throws std::logic_error if the scene has
/// no such triangle.
DistanceEntry entry_of(const Scene& scene, const TrianglePair& pair, std::string squared,
                       std::array<std::uint8_t, 2> features);

/// "none", "a", "b" or "not closed"; empty for unknown.
std::string inside_text(InsideClaim inside);

/// "vertex 2", "edge 0" or "face".
std::string feature_text(std::uint8_t feature);

/// The certificate as JSON, the keys always in the same order, one line for each entry, with a
/// final newline. Bytes of strings that are not UTF-8 become U+FFFD.
std::string to_text(const DistanceCertificate& certificate);

/// The inverse of to_text(). Throws Error naming `name` and the fault if the text is not JSON of
/// exactly this form: syntax, UTF-8, keys unknown, missing or twice, types, ranges, fractions not
/// as in DistanceEntry, format or version. It does not judge what the certificate claims. Memory in
/// proportion to the text.
DistanceCertificate parse_distance_certificate(std::string_view text, const std::string& name);

/// Whether the text says that it is a certificate of distances: its first key is the format. The
/// text may still be malformed.
bool is_distance_certificate(std::string_view text);

struct DistanceCheck {
  Verdict verdict = Verdict::not_proved;
  std::string reason;                // empty where proved
  std::optional<TrianglePair> pair;  // the one that refutes, or that is wrong
  std::string squared;               // the exact square of its distance; empty without a pair
  double distance = 0;               // the root of `squared`, at most a unit in the last place
                                     // more; may be infinite
  std::uint64_t decided = 0;         // pairs of triangles that boxes leave to integers
  std::uint64_t neighbours = 0;      // those of `decided` that are neighbours
  double ms = 0;                     // wall clock
};

/// Decides in integers whether the answers are right and complete.
/// - refuted: the distance of an entry is not that of its triangles, an entry is wrong about which
///   object is inside, a pair of triangles is nearer than the listed pair of its objects, or a pair
///   belongs to the answer but is not listed, or is listed but does not belong to it. The first
///   such pair is named, with its exact squared distance. The order: pairs of entries wrong in
///   themselves, pairs nearer than an entry, pairs that are not listed; each by objects, then by
///   triangles.
/// - not_proved: the certificate is of another scene, and nothing was decided. Or nothing refutes,
///   but entries are not in order or repeated, an entry is of a pair that does not count, an entry
///   of `all` or of one object or with distance 0 claims what is inside, a pair as near as the
///   named one comes before it, or the nearest points lie on other features.
/// - proved: neither.
/// Throws Error naming `name` if the certificate names an object or a triangle that the scene does
/// not have. Precondition: validate() accepts the scene.
DistanceCheck check_distances(const DistanceCertificate& certificate, const Scene& scene,
                              const std::string& name);

}  // namespace farcull
