// The filter may say `unknown`, never anything false; and it must not say `unknown` where pairs are
// easy, or it would be of no use. Each twin lowers one bound to zero and must be caught.
#include "verify/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "experiments/lemma/pair_generators.h"
#include "tests/verify/reference.h"
#include "verify/exact.h"
#include "verify/filter_of_planes.h"

namespace farcull {
namespace {

using reference::Triangle;

struct Tally {
  std::array<int, 3> answers{};  // in the order of Triage
  int contradictions = 0;

  void add(Triage triage, const std::function<bool()>& truth) {
    ++answers[static_cast<int>(triage)];
    if (triage != Triage::unknown && (triage == Triage::yes) != truth()) ++contradictions;
  }
  int decided() const { return answers[0] + answers[1]; }
};

PairOfTriangles mapped(PairOfTriangles pair, const std::function<double(double)>& map) {
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t) p = Vec3(map(p.x()), map(p.y()), map(p.z()));
  }
  return pair;
}

bool finite(const PairOfTriangles& pair) {
  const auto all = [](const Triangle& t) {
    return t[0].allFinite() && t[1].allFinite() && t[2].allFinite();
  };
  return all(pair.a) && all(pair.b);
}

double nudged(PairRandom& random, double x) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (int n = random.below(3); n > 0; --n) x = std::nextafter(x, random.chance(2) ? kInf : -kInf);
  return x;
}

Vec3 point(PairRandom& random) {
  const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
  return {x, y, z};
}

/// A corner of b within a few ulps of the plane of a, perhaps of an edge or a corner of it; half of
/// the time all corners of b.
PairOfTriangles nearly_coplanar(PairRandom& random) {
  PairOfTriangles pair;
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
PairOfTriangles extreme(PairRandom& random) {
  PairOfTriangles pair;
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t) {
      for (double& x : p) x = random.whole(-9, 9);
    }
  }
  if (random.chance(2)) pair = mapped(nearly_coplanar(random), [](double x) { return x; });
  constexpr std::array<int, 9> kCentres = {-1060, -1020, -540, -512, -358, -341, 341, 511, 1000};
  const int exponent = kCentres[random.below(9)] + random.whole(-8, 8);
  const int axis = random.chance(3) ? random.below(3) : 3;
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t) {
      for (int k = 0; k < 3; ++k) p[k] = std::ldexp(p[k], k == axis ? exponent / 2 : exponent);
    }
  }
  return pair;
}

/// In one plane with v; a corner of each on the line, to within rounding, that divides the angle
/// between the others.
PairOfTriangles along_the_divide(PairRandom& random) {
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
PairOfTriangles slivers_on_an_edge(PairRandom& random) {
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
PairOfTriangles coplanar_and_long(PairRandom& random) {
  PairOfTriangles pair;
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

using Make = std::function<PairOfTriangles(PairRandom&)>;

std::vector<std::pair<std::string, Make>> generators() {
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

template <class Bounds>
Tally tally(const Make& make, Sharing sharing, int pairs, std::uint64_t seed = 1) {
  PairRandom random(seed);
  Tally out;
  for (int n = 0; n < pairs; ++n) {
    auto [a, b] = make(random);
    if (!finite({a, b})) continue;
    if (sharing >= Sharing::vertex) b[0] = a[0];
    if (sharing == Sharing::edge) b[1] = a[1];
    const auto beyond = [&] { return reference::intersects_beyond_shared(a, b); };
    int shared = 0;
    for (const Vec3& p : a) shared += std::find(b.begin(), b.end(), p) != b.end();
    switch (sharing) {
      case Sharing::none:
        out.add(filters::filter_planes<Bounds>(a, b, 0),
                [&] { return reference::intersects(a, b); });
        break;
      case Sharing::vertex:
        if (shared == 1) {
          out.add(filters::filter_beyond_vertex<Bounds>(a[0], a[1], a[2], b[1], b[2]), beyond);
        }
        break;
      case Sharing::edge:
        if (shared == 2)
          out.add(filters::filter_beyond_edge<Bounds>(a[0], a[1], a[2], b[2]), beyond);
        break;
    }
  }
  return out;
}

TEST(Filter, NeverContradictsExactArithmetic) {
  for (const auto& [name, make] : generators()) {
    for (const Sharing sharing : {Sharing::none, Sharing::vertex, Sharing::edge}) {
      const Tally t = tally<FilterBounds>(make, sharing, 500);
      EXPECT_EQ(t.contradictions, 0) << name << " " << static_cast<int>(sharing);
    }
  }
}

// Otherwise every pair would go the slow way in silence.
TEST(Filter, DecidesWhatIsNotClose) {
  const auto random_pair = [](PairRandom& random) {
    PairOfTriangles pair;
    for (Triangle* t : {&pair.a, &pair.b}) {
      for (Vec3& p : *t) p = point(random);
    }
    return pair;
  };
  for (const Sharing sharing : {Sharing::none, Sharing::vertex, Sharing::edge}) {
    const Tally t = tally<FilterBounds>(random_pair, sharing, 2000);
    EXPECT_EQ(t.decided(), 2000) << static_cast<int>(sharing);
    if (sharing == Sharing::edge) continue;  // where a collision takes four points in one plane
    EXPECT_GT(t.answers[0], 200);
    EXPECT_GT(t.answers[1], 200);
  }
}

// A flat sheet has nothing but coplanar neighbours; its pairs must not all go the slow way.
TEST(Filter, DecidesNeighboursInAFlatSheet) {
  const auto at = [](double x, double y) { return Vec3(0.1 * x, 0.1 * y, 0.3); };
  const Vec3 v = at(0, 0);
  EXPECT_EQ(filter_beyond_edge(v, at(1, 1), at(1, 0), at(0, 1)), Triage::no);
  EXPECT_EQ(filter_beyond_vertex(v, at(1, 0), at(1, 1), at(-1, 0), at(-1, -1)), Triage::no);
  EXPECT_EQ(filter_beyond_vertex(v, at(1, 0), at(1, 1), at(0, 1), at(-1, 0)), Triage::no);
}

TEST(Filter, DoesNotKnowContactsAndDegenerateTriangles) {
  const Triangle unit = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const Triangle touching = {Vec3(1, 1, 0), Vec3(1, 1, 4), Vec3(2, 1, 4)};
  EXPECT_EQ(filter_planes(unit, touching), Triage::unknown);
  EXPECT_EQ(filter_planes(unit, unit), Triage::unknown);
  const Triangle needle = {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 1, 1)};
  EXPECT_EQ(filter_planes(unit, needle), Triage::unknown);
  EXPECT_EQ(filter_beyond_edge(unit[0], unit[1], unit[2], Vec3(1, 1, 0)), Triage::unknown);
}

TEST(Filter, SaysNothingWhereArithmeticOverflows) {
  const double s = 1e200;
  const auto scaled = [s](Triangle t) { return Triangle{s * t[0], s * t[1], s * t[2]}; };
  const Triangle a = scaled({Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)});
  const Triangle b = scaled({Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 4, 1)});
  EXPECT_EQ(filter_planes(a, b), Triage::unknown);
  EXPECT_FALSE(intersects(a, b));
}

template <class Bounds>
int contradictions(Sharing sharing, const Make& make) {
  int out = 0;
  for (std::uint64_t seed = 1; seed <= 100 && out == 0; ++seed) {
    out += tally<Bounds>(make, sharing, 200, seed).contradictions;
  }
  return out;
}

struct NoSide : FilterBounds {
  static constexpr double side = 0;
};
TEST(FilterTwin, WithoutTheBoundOfSidesItIsWrong) {
  EXPECT_GT(contradictions<NoSide>(Sharing::none, nearly_coplanar), 0);
  EXPECT_GT(contradictions<NoSide>(Sharing::vertex, nearly_coplanar), 0);
  EXPECT_GT(contradictions<NoSide>(Sharing::edge, coplanar_and_long), 0);
}

struct NoNormals : FilterBounds {
  static constexpr double normals = 0;
};
TEST(FilterTwin, WithoutTheBoundOfNormalsItIsWrong) {
  EXPECT_GT(contradictions<NoNormals>(Sharing::edge, slivers_on_an_edge), 0);
}

struct NoAbsolute : FilterBounds {
  static constexpr double absolute = 0;
};
TEST(FilterTwin, WithoutTheBoundOfUnderflowItIsWrong) {
  EXPECT_GT(contradictions<NoAbsolute>(Sharing::none, extreme), 0);
}

}  // namespace
}  // namespace farcull
