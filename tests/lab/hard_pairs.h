// Pairs of triangles that filters in doubles find hard: near a common plane, where products
// underflow or overflow, and those of tests/lab/drawn_pairs.h.
#pragma once

#include "tests/lab/drawn_pairs.h"
#include "tests/lab/reference.h"
#include "verify/rounding.h"

namespace farcull::hard_pairs {

using reference::Triangle;

inline DrawnPair mapped(DrawnPair pair, const std::function<double(double)>& map) {
  for (Triangle* t : {&pair.a, &pair.b})
    for (Vec3& p : *t) p = Vec3(map(p.x()), map(p.y()), map(p.z()));
  return pair;
}

inline bool finite(const DrawnPair& pair) {
  const auto all = [](const Triangle& t) {
    return t[0].allFinite() && t[1].allFinite() && t[2].allFinite();
  };
  return all(pair.a) && all(pair.b);
}

inline double nudged(RandomDraws& random, double x) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (int n = random.below(3); n > 0; --n) x = std::nextafter(x, random.chance(2) ? kInf : -kInf);
  return x;
}

inline Vec3 point(RandomDraws& random) {
  const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
  return {x, y, z};
}

/// A corner of b within a few ulps of the plane of a, perhaps of an edge or a corner of it; half of
/// the time all corners of b.
inline DrawnPair nearly_coplanar(RandomDraws& random) {
  DrawnPair pair;
  const double far = std::ldexp(1, random.whole(-3, 12));  // from the origin
  const Vec3 at = far * point(random);
  for (Vec3& p : pair.a) p = at + point(random);
  const auto on_plane = [&]() -> Vec3 {
    const double s = random.chance(4) ? 0 : random.between(-1, 2);
    const double t = random.chance(4) ? 0 : random.between(-1, 2);
    return pair.a[0] + s * (pair.a[1] - pair.a[0]) + t * (pair.a[2] - pair.a[0]);
  };
  const bool all = random.chance(2);
  for (int i = 0; i < 3; ++i) {
    pair.b[i] = all || i == 0 ? on_plane() : Vec3(at + point(random));
    for (double& x : pair.b[i]) x = nudged(random, x);
  }
  return pair;
}

/// Small whole numbers times a power of two at which products of two or three underflow or
/// overflow, or one coordinate alone that is large.
inline DrawnPair extreme(RandomDraws& random) {
  DrawnPair pair;
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t)
      for (double& x : p) x = random.whole(-9, 9);
  }
  if (random.chance(2)) pair = mapped(nearly_coplanar(random), [](double x) { return x; });
  constexpr std::array<int, 9> kCentres = {-1060, -1020, -540, -512, -358, -341, 341, 511, 1000};
  const int exponent = kCentres[random.below(9)] + random.whole(-8, 8);
  const int axis = random.chance(3) ? random.below(3) : 3;
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t)
      for (int k = 0; k < 3; ++k) p[k] = std::ldexp(p[k], k == axis ? exponent / 2 : exponent);
  }
  return pair;
}

/// Two triangles in one plane that share the corner v. A corner of each lies, but for rounding, on
/// the line that divides the angle between the others.
inline DrawnPair along_the_divide(RandomDraws& random) {
  constexpr double kGrid = 0x1p48;  // so that small multiples are exact
  const double x = std::round(random.between(-1, 1) * kGrid) / kGrid;
  const double y = std::round(random.between(-1, 1) * kGrid) / kGrid;
  const double length = random.between(0.5, 2), up = random.between(0.1, 2);
  const auto in_plane = [](double s, double t) { return Vec3(s, s, t); };
  const auto multiple = [&] {
    const int factor = random.whole(1, 15);
    return in_plane(factor * x, factor * y);
  };
  const Vec3 v = Vec3::Zero();
  return {{v, in_plane(length * x - up * y, length * y + 2 * up * x), multiple()},
          {v, multiple(), in_plane(length * x + up * y, length * y - 2 * up * x)}};
}

/// (p, q, r) and (p, q, s) in one plane, r and s within a few ulps of the edge's line.
inline DrawnPair slivers_on_an_edge(RandomDraws& random) {
  const auto in_plane = [](double s, double t) { return Vec3(s, s, t); };
  const double far = random.whole(0, 3);
  const auto corner = [&] { return Vec3(in_plane(far + random.unit(), random.unit())); };
  const Vec3 p = corner(), q = corner();
  const auto near_line = [&] {
    const Vec3 x = p + random.unit() * (q - p);
    const double s = nudged(random, x.x());
    return in_plane(s, nudged(random, x.z()));
  };
  const Vec3 r = near_line(), s = near_line();
  return {{p, q, r}, {p, q, s}};
}

/// All corners in the plane x + y + z = 0 exactly, products of coordinates longer than a double.
inline DrawnPair coplanar_and_long(RandomDraws& random) {
  DrawnPair pair;
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t) {
      constexpr double kGrid = 0x1p40;
      const double x = std::round(random.between(-1, 1) * kGrid) / kGrid;
      const double y = std::round(random.between(-1, 1) * kGrid) / kGrid;
      p = Vec3(x, y, -(x + y));
    }
  }
  return pair;
}

using Make = std::function<DrawnPair(RandomDraws&)>;

inline std::vector<std::pair<std::string, Make>> generators() {
  std::vector<std::pair<std::string, Make>> out;
  for (const PairGenerator& g : pair_generators()) out.emplace_back(g.name, g.make);
  out.emplace_back("nearly coplanar", nearly_coplanar);
  out.emplace_back("extreme", extreme);
  out.emplace_back("along the divide", along_the_divide);
  out.emplace_back("slivers on an edge", slivers_on_an_edge);
  out.emplace_back("coplanar and long", coplanar_and_long);
  return out;
}

/// How the triangles of a generated pair are made to share corners.
enum class Sharing { none, vertex, edge };

inline void share(Sharing sharing, Triangle& a, Triangle& b) {
  if (sharing >= Sharing::vertex) b[0] = a[0];
  if (sharing == Sharing::edge) b[1] = a[1];
}

// The bounds of the filters without one of them: the twins that must be wrong.
struct NoSide : FilterBounds {
  static constexpr double side = 0;
};
struct NoAbsolute : FilterBounds {
  static constexpr double absolute = 0;
};
struct NoPoint : FilterBounds {
  static constexpr double point = 0;
};
struct NoGap : FilterBounds {
  static constexpr double gap = 0;
};

/// Two triangles at a distance that is a double, closest in one feature of each alone.
struct KnownDistance {
  const char* name;
  Triangle a, b;
  double distance;
};

inline std::vector<KnownDistance> known_distances() {
  const auto triangle = [](const std::array<int, 9>& x) {
    return Triangle{Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5]), Vec3(x[6], x[7], x[8])};
  };
  struct Row {
    const char* name;
    std::array<int, 9> a, b;  // the coordinates of the corners
    double distance;
  };
  std::vector<KnownDistance> out;
  for (const auto& [name, a, b, distance] :
       {Row{"corners", {0, 0, 0, -4, -1, 0, -4, 1, 0}, {3, 4, 0, 9, 5, 1, 9, 7, -1}, 5},
        Row{"corner, edge", {0, 0, 0, -4, -1, 0, -4, 1, 1}, {3, -2, 0, 3, 5, 0, 9, 0, 0}, 3},
        Row{"corner, face", {1, 1, 7, 0, 1, 9, 1, 2, 9}, {-3, -3, 0, 9, -3, 0, -3, 9, 0}, 7},
        Row{"edges", {-3, 0, 0, 5, 0, 0, 0, 0, -4}, {0, -3, 2, 0, 4, 2, 0, 0, 6}, 2},
        Row{"parallel edges", {-3, 0, 0, 5, 0, 0, 0, 0, -4}, {1, 0, 2, 9, 0, 2, 2, 0, 6}, 2},
        Row{"parallel faces", {0, 0, 0, 5, 0, 0, 0, 5, 0}, {1, 1, 2, 6, 1, 2, 1, 6, 2}, 2},
        Row{"points", {1, 2, 2, 1, 2, 2, 1, 2, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 0}, 3},
        Row{"segments", {-3, 0, 0, 5, 0, 0, 1, 0, 0}, {0, -3, 2, 0, 4, 2, 0, 1, 2}, 2}}) {
    out.push_back({name, triangle(a), triangle(b), distance});
    out.push_back({name, triangle(b), triangle(a), distance});
  }
  return out;
}

}  // namespace farcull::hard_pairs
