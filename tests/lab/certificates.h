// A scene with a certificate of it, for the tests of certificates.
#pragma once

#include "tests/lab/grid_distance.h"
#include "tests/lab/test.h"
#include "verify/certificate/box_pairs.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/distance_certificate.h"
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
    meeting = found.pairs;
    meeting.insert(meeting.end(), found.neighbour_pairs.begin(), found.neighbour_pairs.end());
    std::ranges::sort(meeting);
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

// Distances by brute force in rationals, and certificates made of them, for the tests of
// certificates of distances. Nothing of verify/certificate but the form of the certificate.

namespace farcull::distance_case {

using reference::Rational;
using reference::Triangle;

/// The square of the distance of two triangles.
inline Rational squared(const Triangle& a, const Triangle& b) {
  return near_lab::squared_distance_of(a, b);
}

/// A corner, an edge or the triangle itself, as a triangle.
inline Triangle part(const Triangle& t, int feature) {
  if (feature < 3) return {t[feature], t[feature], t[feature]};
  return feature < 6 ? Triangle{t[feature - 3], t[(feature - 2) % 3], t[(feature - 2) % 3]} : t;
}

/// The first two features that are as near as the triangles, the square of whose distance is given.
inline std::array<std::uint8_t, 2> features(const Triangle& a, const Triangle& b,
                                            const Rational& least) {
  for (std::uint8_t i = 0; i < 7; ++i) {
    for (std::uint8_t j = 0; j < 7; ++j) {
      if (squared(part(a, i), part(b, j)) == least) return {i, j};
    }
  }
  throw std::logic_error("no features");
}

/// A scene with all its distances.
struct Distances {
  Scene scene;
  std::vector<std::uint32_t> owner;
  std::map<TrianglePair, Rational> squares;               // of all pairs of triangles
  mutable std::map<TrianglePair, DistanceEntry> entries;  // of those that were asked for

  explicit Distances(Scene from) : scene(std::move(from)), owner(owners(scene)) {
    const auto count = static_cast<std::uint32_t>(scene.triangles.size());
    for (std::uint32_t a = 0; a < count; ++a)
      for (std::uint32_t b = a + 1; b < count; ++b)
        squares[{a, b}] = squared(scene.corners(a), scene.corners(b));
  }

  const DistanceEntry& entry(const TrianglePair& pair) const {
    const auto [it, added] = entries.try_emplace(pair);
    if (added) {
      const Rational& square = squares.at(pair);
      it->second =
          entry_of(scene, pair, square.get_num().get_str() + "/" + square.get_den().get_str(),
                   features(scene.corners(pair.a), scene.corners(pair.b), square));
    }
    return it->second;
  }

  bool counts(const TrianglePair& pair) const {
    if (owner[pair.a] != owner[pair.b]) return true;
    return scene.objects[owner[pair.a]].self &&
           !reference::share_position(scene.corners(pair.a), scene.corners(pair.b));
  }

  /// By two objects that have triangles, or one twice, the first of the nearest pairs that count.
  std::map<std::array<std::uint32_t, 2>, TrianglePair> nearest_pairs() const {
    std::map<std::array<std::uint32_t, 2>, TrianglePair> out;
    for (const auto& [pair, square] : squares) {
      if (!counts(pair)) continue;
      const auto [it, added] = out.try_emplace({owner[pair.a], owner[pair.b]}, pair);
      if (!added && square < squares.at(it->second)) it->second = pair;
    }
    return out;
  }

  DistanceCertificate certificate(DistanceCertificate::Pairs pairs, double within,
                                  std::uint64_t k = 0) const {
    DistanceCertificate out;
    out.scene = {scene.name, scene.objects.size(), scene.triangles.size(), scene_hash(scene)};
    out.pairs = pairs;
    out.k = k;
    out.within = within;
    const auto is_within = [&](const TrianglePair& pair) {
      return std::isinf(within) || squares.at(pair) <= Rational(within) * Rational(within);
    };
    if (pairs == DistanceCertificate::Pairs::all) {
      for (const auto& [pair, square] : squares) {
        if (counts(pair) && is_within(pair)) out.distances.push_back(entry(pair));
      }
      std::ranges::sort(out.distances, {},
                        [](const DistanceEntry& x) { return std::pair(x.objects, x.triangles); });
      return out;
    }
    const auto nearest = nearest_pairs();
    // Of those as far the lower object is nearer.
    const auto among_nearest = [&](std::uint32_t object, std::uint32_t to,
                                   const TrianglePair& pair) {
      std::uint64_t nearer = 0;
      for (const auto& [objects, other] : nearest) {
        if (objects[0] == objects[1] || (objects[0] != object && objects[1] != object)) continue;
        const std::uint32_t third = objects[0] == object ? objects[1] : objects[0];
        nearer += is_within(other) &&
                  std::pair(squares.at(other), third) < std::pair(squares.at(pair), to);
      }
      return nearer < k;
    };
    for (const auto& [objects, pair] : nearest) {
      if (!is_within(pair)) continue;
      const auto [a, b] = objects;
      if (k > 0 && (a == b || (!among_nearest(a, b, pair) && !among_nearest(b, a, pair)))) continue;
      out.distances.push_back(entry(pair));
    }
    return out;
  }
};

/// By way of the text.
inline DistanceCheck check(const DistanceCertificate& certificate, const Scene& scene) {
  return check_distances(parse_distance_certificate(to_text(certificate), "c.json"), scene,
                         "c.json");
}

}  // namespace farcull::distance_case
