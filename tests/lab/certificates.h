// A scene with a certificate of it, for the tests of certificates.
#pragma once

#include "tests/lab/test.h"
#include "verify/certificate/box_pairs.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/integer_pair.h"
#include "verify/exact.h"

namespace farcull {

inline std::vector<TrianglePair> box_pairs(const Scene& scene, double clearance = 0) {
  BoxPairs enumeration(scene, clearance);
  std::vector<TrianglePair> pairs;
  enumeration.next(pairs, std::numeric_limits<std::size_t>::max());
  return pairs;
}

inline Certificate::Run some_run() {
  return {.method = "far",
          .resolution = 512,
          .radius_px = 0.71691,
          .offset = "obb",
          .views = {{"x", 512, 300, 0.71691}, {"-y \"quoted\"", 1, 2, 1e-3}},
          .device = {{"vendor", "renderer, \xc3\xa9", "4.5", "4.50"}},
          .assumptions = {"A1: something", "A2: \\ another"}};
}

/// A run that kept what meets, or is within the clearance, and every third pair that does not.
struct Case {
  Scene scene;
  std::vector<TrianglePair> pairs;  // with overlapping boxes
  std::vector<TrianglePair> meeting;
  std::vector<TrianglePair> kept;
  std::uint64_t neighbours = 0;  // that do not meet
  Certificate certificate;

  explicit Case(Scene from, double clearance = 0)
      : scene(std::move(from)), pairs(box_pairs(scene, clearance)) {
    const Collisions found = decide(scene, pairs, {.clearance = clearance});
    meeting = found.all();
    neighbours = found.neighbours - found.neighbour_pairs.size();
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (i % 3 == 0 || meets(i)) kept.push_back(pairs[i]);
    certificate = make_certificate(scene, kept, meeting, some_run(), clearance);
  }
  bool meets(std::size_t i) const { return std::ranges::binary_search(meeting, pairs[i]); }
  bool is_kept(std::size_t i) const { return (certificate.evidence[i] & kKept) != 0; }
  IntegerPair integers(std::size_t i) const {
    return IntegerPair(scene.corners(pairs[i].a), scene.corners(pairs[i].b), certificate.clearance);
  }
  /// The check of a changed certificate, by way of its text.
  CheckResult check(const Certificate& changed) const {
    return check_certificate(parse_certificate(to_text(changed), "changed.json"), scene);
  }
};

/// Claims as the evidence has them, so that no count gives a change away.
inline void recount(Certificate& certificate) {
  Certificate::Claims& claims = certificate.claims = {};
  for (const std::uint8_t byte : certificate.evidence) {
    ++claims.box_pairs;
    ++((byte & kKept) != 0 ? claims.kept : claims.culled);
    const int claim = byte & 63;
    ++(claim == kMeets        ? claims.meeting
       : claim == kNeighbours ? claims.neighbours
                              : claims.separated);
  }
}

}  // namespace farcull
