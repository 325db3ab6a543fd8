// Small scenes for tests of the discrete Voronoi diagram, their nearest neighbours, and what it
// misses.
#pragma once

#include "core/voronoi/voronoi.h"
#include "tests/lab/grid_distance.h"
#include "tests/lab/rational.h"
#include "tests/lab/scenes.h"

namespace farcull::exact_distance {

// Number: rational::Q, or double for a first estimate.
template <class Number>
using Corners = near_lab::Corners<Number>;

template <class Number>
Corners<Number> converted(const std::array<Vec3, 3>& corners) {
  return reference::converted(corners, [](double x) { return Number(x); });
}

/// The square of the distance of two triangles.
template <class Number>
Number between(const Corners<Number>& a, const Corners<Number>& b) {
  const auto squared = near_lab::squared_distance(a, b);
  return Number(squared.numerator / squared.denominator);
}

struct Nearest {
  rational::Q squared = -1;         // of the distance; negative: there is no other object
  std::vector<TrianglePair> pairs;  // all at that distance, sorted
};

/// Of each object. Precondition: coordinates of at most about 2, multiples of 2^-10 or of 2^-10 of
/// their size. A first estimate in double leaves out what is far from the least distance: of such
/// numbers all comparisons in it are right, and its squares are less than 1e-12 off.
inline std::vector<Nearest> nearest_neighbours(const Scene& scene) {
  const std::vector<std::uint32_t> owner = owners(scene);
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  std::vector<Corners<double>> rough;
  std::vector<Corners<rational::Q>> exact;
  for (std::uint32_t t = 0; t < count; ++t) {
    rough.push_back(converted<double>(scene.corners(t)));
    exact.push_back(converted<rational::Q>(scene.corners(t)));
  }
  struct Estimate {
    TrianglePair pair;
    double squared;
  };
  std::vector<Estimate> estimates;
  std::vector<double> least(scene.objects.size(), HUGE_VAL);
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      if (owner[a] == owner[b]) continue;
      const double squared = between(rough[a], rough[b]);
      estimates.push_back({{a, b}, squared});
      for (const std::uint32_t t : {a, b}) least[owner[t]] = std::min(least[owner[t]], squared);
    }
  }
  std::vector<Nearest> out(scene.objects.size());
  for (const auto& [pair, squared] : estimates) {
    std::optional<rational::Q> decided;
    for (const std::uint32_t object : {owner[pair.a], owner[pair.b]}) {
      if (squared > 1.001 * least[object] + 1e-12) continue;
      if (!decided) decided = between(exact[pair.a], exact[pair.b]);
      Nearest& nearest = out[object];
      if (nearest.squared < 0 || *decided < nearest.squared) {
        nearest.squared = *decided;
        nearest.pairs.clear();
      }
      if (*decided == nearest.squared) nearest.pairs.push_back(pair);
    }
  }
  return out;
}

}  // namespace farcull::exact_distance

namespace farcull::lab {

// 3 to 8 objects of 1 to 4 triangles in a cube of side 1, on a grid of 2^-10, so that contacts and
// ties happen. Kinds: triangles of any size; segments and points; needles; sheets one above the
// other; a cluster of any size, from 1/4 to 1/2048, apart from one triangle; copies.
constexpr int kNeighbourKinds = 6;
constexpr int kClusterKind = 4;
inline Scene neighbours_scene(std::uint64_t seed, int kind) {
  Random random(seed);
  constexpr double kGrid = 0x1p-10;
  std::vector<std::vector<std::array<Vec3, 3>>> objects(
      static_cast<std::size_t>(3 + random.below(6)));
  const auto drawn = [&](double from, double to) {
    return Vec3(random.grid(from, to, kGrid), random.grid(from, to, kGrid),
                random.grid(from, to, kGrid));
  };
  const double cluster = std::exp2(-2 - random.below(10));
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const int count = 1 + random.below(4);
    for (int i = 0; i < count; ++i) {
      const double size = std::exp2(-random.below(8));
      const Vec3 at = drawn(0, 1);
      std::array<Vec3, 3> t = {at, at, at};
      for (Vec3& c : t) c += drawn(-size, size);
      if (kind == kClusterKind && (o > 0 || i > 0))
        for (Vec3& c : t) c *= cluster;
      if (kind == 1 && random.below(2)) t[2] = random.below(2) ? t[1] : Vec3(2 * t[1] - t[0]);
      if (kind == 1 && random.below(3) == 0) t[2] = t[1] = t[0];
      if (kind == 2) t[2] = t[1] + Vec3(kGrid, 0, 0);
      if (kind == 3) t[0][2] = t[1][2] = t[2][2] = random.below(8) * 0x1p-5;
      if (kind == 5 && o > 0 && random.below(3) == 0) t = objects[o - 1].front();
      objects[o].push_back(t);
    }
  }
  return scene_of(objects);
}

// Of any kind.
inline Scene neighbours_scene(std::uint64_t seed) {
  return neighbours_scene(seed, static_cast<int>(seed % kNeighbourKinds));
}

// How many objects have a nearest neighbour, and how many of these lose all of theirs: no object
// that is as near as any is among the pairs.
struct Losses {
  std::uint64_t objects = 0, lost = 0;
};

inline bool holds(const std::vector<ObjectPair>& sorted, std::uint32_t a, std::uint32_t b) {
  return std::ranges::binary_search(sorted, ObjectPair{std::min(a, b), std::max(a, b)});
}

inline void count_losses(const Scene& scene, const std::vector<exact_distance::Nearest>& truth,
                         const std::vector<ObjectPair>& found, Losses& losses) {
  const std::vector<std::uint32_t> owner = owners(scene);
  for (const exact_distance::Nearest& nearest : truth) {
    if (nearest.pairs.empty()) continue;
    ++losses.objects;
    losses.lost += std::ranges::none_of(nearest.pairs, [&](const TrianglePair& pair) {
      return holds(found, owner[pair.a], owner[pair.b]);
    });
  }
}

/// The square of the distance of a point of a grid from a triangle.
inline rational::Q squared_distance(const GridPoint& point, const GridTriangle& triangle) {
  exact_distance::Corners<rational::Q> corners, p;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c][k] = static_cast<double>(triangle.corners[c][k]);
      p[c][k] = static_cast<double>(point[k]);
    }
  }
  return exact_distance::between(p, corners);
}

// A triangle in the unit cubes of a grid, often a needle, a segment or a point.
inline GridTriangle drawn_triangle(rational::Random& random, float longest) {
  GridTriangle out;
  const auto number = [&] { return static_cast<float>(random.uniform(0, longest)); };
  const float thin = std::exp2(static_cast<float>(-random.below(40)));
  for (auto& corner : out.corners) corner = {number(), number(), number()};
  auto& [a, b, c] = out.corners;
  const int kind = random.below(6);
  if (kind == 0)  // a needle
    for (std::size_t k = 0; k < 3; ++k) c[k] = std::min(longest, b[k] + thin);
  if (kind == 1) {  // three points close to a line
    for (std::size_t k = 0; k < 3; ++k) c[k] = 0.5f * (a[k] + b[k]);
    c[0] = std::min(longest, c[0] + thin);
  }
  if (kind == 2) c = b;
  if (kind == 3) c = b = a;
  return out;
}

}  // namespace farcull::lab
