// Numbers of about 106 bits: what they round is the exact result rounded, or they say that they do
// not know.
#include "verify/wide.h"

#include "experiments/generators/pair_generators.h"
#include "tests/lab/test.h"
#include "verify/rational.h"
#include "verify/squared_distance.h"

namespace farcull {
namespace {

using rational::Q;

/// The coordinates of a point p of an edge, of q on its other side, and of three corners of a
/// plane.
using Given = std::array<Vec3, 5>;

/// The first coordinate of the point where the edge meets the plane, in numbers of any kind, as a
/// quotient.
template <class N>
std::array<N, 2> where_met(const Given& given) {
  const auto minus = [&](int i, int j) {
    std::array<N, 3> out;
    for (int k = 0; k < 3; ++k) out[k] = N(given[i][k]) - N(given[j][k]);
    return out;
  };
  const auto e = minus(3, 2), f = minus(4, 2), p = minus(0, 2), q = minus(1, 2);
  const auto height = [&](const std::array<N, 3>& x) -> N {
    return N(N(N(e[1] * f[2]) - N(e[2] * f[1])) * x[0]) +
           N(N(N(e[2] * f[0]) - N(e[0] * f[2])) * x[1]) +
           N(N(N(e[0] * f[1]) - N(e[1] * f[0])) * x[2]);
  };
  const N s = height(p), t = height(q);
  return {N(N(N(given[1][0]) * s) - N(N(given[0][0]) * t)), N(s - t)};
}

double nearest_double(const Q& q) { return rounded_quotient(q.get_num(), q.get_den(), 0); }

struct Small {  // the twin: no bound
  static constexpr double factor = 0;
};

struct Score {
  int right = 0, unknown = 0, wrong = 0;
};
template <class Bounds>
void judge(const Given& given, Score& score) {
  const auto exact = where_met<Q>(given);
  if (exact[1] == 0) return;
  const auto [num, den] = where_met<wide::Number<Bounds>>(given);
  const std::optional<double> found = wide::nearest(num / den);
  if (!found) {
    ++score.unknown;
  } else {
    ++(*found == nearest_double(exact[0] / exact[1]) ? score.right : score.wrong);
  }
}

/// A point just between two doubles on the edge and on the plane, which nearly holds the edge.
Given in_the_middle(RandomDraws& random) {
  constexpr double kUlp = 0x1p-52;  // of doubles in [1, 2)
  const auto whole = [&](double size) {
    return std::round(random.between(-size, size) / kUlp) * kUlp;
  };
  Given out;
  for (int k = 0; k < 3; ++k) {
    const double middle = 1.5 + whole(0.1), along = whole(0.3), across = whole(0.3);
    out[0][k] = middle - along;
    out[1][k] = middle + along + kUlp;
    out[2][k] = middle - across;
    out[3][k] = middle + across + kUlp;
    out[4][k] = out[0][k] + 1e-6 * random.between(-1, 1);
  }
  return out;
}

TEST(Wide, RoundsAsRationalNumbersOrSaysThatItDoesNotKnow) {
  RandomDraws random(611);
  Score plain, middle, twin;
  for (int n = 0; n < 5000; ++n) {
    Given given;
    for (Vec3& p : given)
      p = Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    judge<wide::Bounds>(given, plain);
    given = in_the_middle(random);
    judge<wide::Bounds>(given, middle);
    judge<Small>(given, twin);
  }
  EXPECT_EQ(plain.wrong, 0);
  EXPECT_EQ(middle.wrong, 0);
  EXPECT_LT(plain.unknown, 5);
  EXPECT_GT(twin.wrong, 500);
}

TEST(Wide, AtTheEndsOfItsRange) {
  RandomDraws random(613);
  Score score;
  for (int n = 0; n < 3000; ++n) {
    Given given;
    for (Vec3& p : given) {
      for (double& x : p) {
        x = std::ldexp(random.between(0.5, 1), random.chance(2) ? -98 : 100);
        if (random.chance(3)) x = -x;
        if (random.chance(4)) x = 0;
      }
    }
    judge<wide::Bounds>(given, score);
  }
  EXPECT_EQ(score.wrong, 0);
  EXPECT_GT(score.right, 100);
}

}  // namespace
}  // namespace farcull
