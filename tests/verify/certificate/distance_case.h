// Distances by brute force in rationals, and certificates made of them, for the tests of
// certificates of distances. Nothing of verify/certificate but the form of the certificate.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "tests/verify/reference.h"
#include "verify/certificate/distance_certificate.h"
#include "verify/exact.h"

namespace farcull::distance_case {

using reference::Rational;
using reference::RationalPoint;
using reference::RationalTriangle;
using reference::Triangle;

inline RationalPoint at(const RationalPoint& p, const RationalPoint& u, const Rational& x) {
  return {Rational(p[0] + u[0] * x), Rational(p[1] + u[1] * x), Rational(p[2] + u[2] * x)};
}

inline Rational between(const RationalPoint& p, const RationalPoint& q) {
  const RationalPoint w = reference::minus(q, p);
  return reference::dot(w, w);
}

/// The square of the distance of a point from a segment: the nearest point of the line, clamped.
inline Rational to_segment(const RationalPoint& p, const RationalPoint& from,
                           const RationalPoint& to) {
  const RationalPoint u = reference::minus(to, from);
  const Rational uu = reference::dot(u, u);
  if (uu == 0) return between(p, from);
  Rational x = reference::dot(u, reference::minus(p, from)) / uu;
  x = std::clamp(x, Rational(0), Rational(1));
  return between(p, at(from, u, x));
}

inline Rational of_segments(const RationalPoint& p, const RationalPoint& p_end,
                            const RationalPoint& q, const RationalPoint& q_end) {
  Rational least = std::min({to_segment(p, q, q_end), to_segment(p_end, q, q_end),
                             to_segment(q, p, p_end), to_segment(q_end, p, p_end)});
  const RationalPoint u = reference::minus(p_end, p);
  const RationalPoint v = reference::minus(q_end, q);
  const RationalPoint n = reference::cross(u, v);
  if (reference::is_zero(n)) return least;
  const Rational nn = reference::dot(n, n);
  const RationalPoint w = reference::minus(q, p);
  const Rational s = reference::dot(reference::cross(w, v), n) / nn;
  const Rational t = reference::dot(reference::cross(w, u), n) / nn;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
    least = std::min(least, between(at(p, u, s), at(q, v, t)));
  return least;
}

/// Where the plane of the triangle has a foot of p in it, the square of the distance from it.
inline std::optional<Rational> to_face(const RationalPoint& p, const RationalTriangle& t) {
  const RationalPoint n =
      reference::cross(reference::minus(t[1], t[0]), reference::minus(t[2], t[0]));
  if (reference::is_zero(n)) return std::nullopt;
  const Rational nn = reference::dot(n, n);
  const Rational height = reference::dot(n, reference::minus(p, t[0]));
  if (!reference::lies_in(at(p, n, Rational(-height / nn)), t)) return std::nullopt;
  return Rational(height * height / nn);
}

inline RationalTriangle rational(const Triangle& t) {
  return reference::converted(t, [](double x) { return Rational(x); });
}

/// The square of the distance: 0 where verify/exact finds a common point, else the least over
/// corners with faces and edges with edges.
inline Rational squared(const Triangle& a, const Triangle& b) {
  if (intersects(a, b)) return 0;
  const RationalTriangle s = rational(a);
  const RationalTriangle t = rational(b);
  std::optional<Rational> least;
  const auto take = [&](const std::optional<Rational>& x) {
    if (x && (!least || *x < *least)) least = x;
  };
  for (int i = 0; i < 3; ++i) {
    take(to_face(s[i], t));
    take(to_face(t[i], s));
    for (int j = 0; j < 3; ++j) take(of_segments(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
  }
  return *least;
}

/// A corner, an edge or the triangle itself, as a triangle.
template <class T>
T part(const T& t, int feature) {
  if (feature < 3) return {t[feature], t[feature], t[feature]};
  return feature < 6 ? T{t[feature - 3], t[(feature - 2) % 3], t[(feature - 2) % 3]} : t;
}

/// The first two features that are as near as the triangles, the square of whose distance is given.
inline std::array<std::uint8_t, 2> features(const Triangle& a, const Triangle& b,
                                            const Rational& least) {
  const RationalTriangle s = rational(a);
  const RationalTriangle t = rational(b);
  for (std::uint8_t i = 0; i < 7; ++i) {
    for (std::uint8_t j = 0; j < 7; ++j) {
      const RationalTriangle x = part(s, i);
      const RationalTriangle y = part(t, j);
      const Rational found =
          i < 6 && j < 6 ? of_segments(x[0], x[1], y[0], y[1]) : squared(part(a, i), part(b, j));
      if (found == least) return {i, j};
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
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = a + 1; b < count; ++b)
        squares[{a, b}] = squared(scene.corners(a), scene.corners(b));
    }
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
        const bool inside = owner[pair.a] == owner[pair.b];
        const bool counts =
            !inside || (scene.objects[owner[pair.a]].self &&
                        !reference::share_position(scene.corners(pair.a), scene.corners(pair.b)));
        if (counts && is_within(pair)) out.distances.push_back(entry(pair));
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
