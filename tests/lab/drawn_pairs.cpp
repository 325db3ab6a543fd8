// Pairs in contact are made exactly, on integers; some are then changed by an ulp, by rounding or
// by a scale.
#include "tests/lab/drawn_pairs.h"

#include <cmath>
#include <limits>

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

Corners whole_triangle(RandomDraws& random, double extent) {
  return {random.whole_point(extent), random.whole_point(extent), random.whole_point(extent)};
}

double nudged(RandomDraws& random, double x) {
  constexpr double kMost = std::numeric_limits<double>::max();
  return std::nextafter(x, random.chance(2) ? kMost : -kMost);
}

DrawnPair small_grid(RandomDraws& random) {
  const int extent = random.whole(1, 3);
  return {whole_triangle(random, extent), whole_triangle(random, extent)};
}

DrawnPair random_pair(RandomDraws& random) {
  DrawnPair pair;
  each_corner(pair, [&](Vec3& p) { p = random.point(); });
  return pair;
}

/// Exact contact: a corner of a, or a point of an edge or of the face of a, is on a corner, an edge
/// or the face of b. Coordinates of a are multiples of 4, so that their quarters are whole. b goes
/// to any side of the point, so it may also cross a; every third time it moves by up to one unit.
DrawnPair contact(RandomDraws& random) {
  constexpr int kExtent = 64;
  DrawnPair pair;
  for (Vec3& p : pair.a) p = 4 * random.whole_point(kExtent);
  Vec3 at = pair.a[0];
  const int where = random.below(3);
  if (where == 1) {
    const int weight = random.whole(1, 3);
    at = (weight * pair.a[0] + (4 - weight) * pair.a[1]) / 4;
  }
  if (where == 2) at = (2 * pair.a[0] + pair.a[1] + pair.a[2]) / 4;
  const Vec3 u = random.whole_point(kExtent);
  const Vec3 v = random.whole_point(kExtent);
  const int way = random.below(4);
  if (way < 3) pair.b = with_point(way, at, u, v);
  if (way == 1) pair.b[1] = at + random.whole(1, 3) * u;
  if (way == 3) {  // an edge of b along an edge of a
    pair.b = {pair.a[0], pair.a[1], at + v};
    if (random.chance(2)) pair.b[1] = at - (pair.a[1] - pair.a[0]) / 4;
  }
  if (random.chance(3)) {
    const Vec3 step = random.whole_point(1);
    for (Vec3& p : pair.b) p += step;
  }
  return pair;
}

DrawnPair coplanar(RandomDraws& random) {
  const Vec3 u = random.whole_point(20);
  const Vec3 v = random.whole_point(20);
  const Vec3 origin = random.whole_point(1000);
  const auto corner = [&] {
    const int i = random.whole(-5, 5);
    const int j = random.whole(-5, 5);
    return Vec3(origin + i * u + j * v);
  };
  DrawnPair pair;
  each_corner(pair, [&](Vec3& p) { p = corner(); });
  if (random.chance(4)) {  // b is a copy of a, moved in the plane
    const Vec3 move = random.whole(-3, 3) * u + random.whole(-3, 3) * v;
    for (int i = 0; i < 3; ++i) pair.b[i] = pair.a[i] + move;
  }
  return pair;
}

/// A contact whose coordinates have all 53 bits. They are rounded, so there is a gap or an overlap
/// of about an ulp. One coordinate of b in three is then moved by an ulp.
DrawnPair one_ulp(RandomDraws& random) {
  DrawnPair pair;
  for (Vec3& p : pair.a) p = random.point();
  const double s = random.chance(3) ? 0 : random.unit();
  const double t = random.chance(3) ? 0 : random.unit() * (1 - s);
  const Vec3 at = pair.a[0] + s * (pair.a[1] - pair.a[0]) + t * (pair.a[2] - pair.a[0]);
  const Vec3 u = random.point();
  const Vec3 v = random.point();
  const int way = random.below(4);
  if (way < 2) pair.b = with_point(way, at, u, v);
  if (way == 2) {  // coplanar except for the rounding
    pair.b = {at, at + (at - pair.a[1]) * random.between(-1, 2),
              at + (at - pair.a[2]) * random.between(-1, 2)};
  }
  if (way == 3) {  // both in one plane of equal z, except a corner of b
    for (int i = 0; i < 3; ++i) {
      pair.a[i].z() = at.z();
      pair.b[i] = {random.point().x(), random.point().y(), at.z()};
    }
    pair.b[0].z() = at.z() + random.unit();
  }
  for (Vec3& p : pair.b) {
    for (int k = 0; k < 3; ++k) {
      if (random.chance(3)) p[k] = nudged(random, p[k]);
    }
  }
  return pair;
}

DrawnPair needles(RandomDraws& random) {
  const double width = std::pow(10, -random.between(3, 12));
  const auto needle = [&](const Vec3& through) {
    const Vec3 along = random.point();
    const double before = random.between(-0.2, 1.2);
    return Corners{through - before * along, through + (1 - before) * along,
                   through + (random.between(-1, 2) - before) * along + width * random.point()};
  };
  const Vec3 centre = random.point();
  return {needle(centre), needle(centre + random.below(3) * width * random.point())};
}

/// A point or segment, and a point, segment or triangle. Half of the time both contain the same
/// point.
DrawnPair degenerate(RandomDraws& random) {
  const auto shape = [&](int dimension, const Vec3& through) -> Corners {
    const Vec3 u = random.whole_point(6);
    if (dimension == 0) return {through, through, through};
    if (dimension == 1) {
      const int from = random.whole(-3, 1);
      return {through + from * u, through + random.whole(from, 3) * u,
              through + random.whole(from, 3) * u};
    }
    const Vec3 v = random.whole_point(6);
    return {through - u - v, through + random.whole(0, 2) * u, through + random.whole(0, 2) * v};
  };
  const Vec3 at = random.whole_point(10);
  const Vec3 near = random.chance(2) ? at : Vec3(at + random.whole_point(2));
  return {shape(random.below(2), at), shape(random.below(3), near)};
}

/// A pair scaled by 1e-30 .. 1e30, with one scale or one for each axis. Some scales keep exact
/// contact, others round it away.
DrawnPair magnitudes(RandomDraws& random) {
  DrawnPair pair = random.chance(2) ? contact(random) : one_ulp(random);
  const auto scale = [&] {
    const double exponent = random.between(-30, 30);
    return random.chance(2) ? std::pow(10, exponent) : std::exp2(std::round(exponent * 3.3));
  };
  Vec3 factors = Vec3::Constant(scale());
  if (random.chance(2)) factors = {scale(), scale(), scale()};
  each_corner(pair, [&](Vec3& p) { p = p.cwiseProduct(factors); });
  return pair;
}

/// Coordinates that are whole multiples of the least double; half of the time on one axis only.
DrawnPair denormals(RandomDraws& random) {
  DrawnPair pair = random.chance(2) ? contact(random) : small_grid(random);
  const int exponent = random.whole(-1074, -1030);
  const int axis = random.chance(2) ? -1 : random.below(3);  // -1: all
  each_corner(pair, [&](Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      if (axis < 0 || k == axis) p[k] = std::ldexp(p[k], exponent);
    }
  });
  return pair;
}

/// A pair moved away from the origin by about 1e9 times its size, so that rounding leaves about 23
/// bits of its shape.
DrawnPair far_away(RandomDraws& random) {
  DrawnPair pair = random.chance(2) ? one_ulp(random) : contact(random);
  double size = 0;
  each_corner(pair, [&](const Vec3& p) { size = std::max(size, p.norm()); });
  const Vec3 move = 2e9 * size * random.point();
  each_corner(pair, [&](Vec3& p) { p += move; });
  return pair;
}

/// A triangle of size 1e3 .. 1e30, and one of size about 1 at a corner, an edge or the face of the
/// large one.
DrawnPair huge_beside_tiny(RandomDraws& random) {
  const double size = std::pow(10, random.between(3, 30));
  DrawnPair pair;
  const Vec3 at = random.whole_point(8);
  const Vec3 u = std::round(size) * (random.chance(3) ? Vec3(Vec3::UnitX()) : random.point());
  const Vec3 v = std::round(size) * (random.chance(3) ? Vec3(Vec3::UnitY()) : random.point());
  pair.a = with_point(random.below(3), at, u, v);
  for (Vec3& p : pair.b) p = at + random.whole_point(2);
  if (random.chance(2)) pair.b[0] = at;
  if (random.chance(3)) pair.b[1] = pair.b[0];
  return pair;
}

template <DrawnPair (*Make)(RandomDraws&)>
DrawnPair any_order(RandomDraws& random) {
  DrawnPair pair = Make(random);
  shuffle(random, pair);
  return pair;
}

}  // namespace

const std::vector<PairGenerator>& pair_generators() {
  static const std::vector<PairGenerator> generators = {
      {"grid", any_order<small_grid>},
      {"random", any_order<random_pair>},
      {"contact", any_order<contact>},
      {"coplanar", any_order<coplanar>},
      {"one-ulp", any_order<one_ulp>},
      {"needles", any_order<needles>},
      {"degenerate", any_order<degenerate>},
      {"magnitudes", any_order<magnitudes>},
      {"denormals", any_order<denormals>},
      {"far-away", any_order<far_away>},
      {"huge-beside-tiny", any_order<huge_beside_tiny>},
  };
  return generators;
}

}  // namespace farcull
