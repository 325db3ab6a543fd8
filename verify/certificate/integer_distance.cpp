// A pair of triangles is scaled to integers once; GMP's, since the square of a distance is mostly
// long.
#include "verify/certificate/integer_distance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "verify/certificate/integer_pair.h"
#include "verify/certificate/integer_witnesses.h"
#include "verify/certificate/integers.h"

namespace farcull {

using namespace integer;

namespace {

constexpr int kFeatures = 7;
constexpr int kFace = 6;

bool is_corner(int feature) { return feature < 3; }

/// Constructs the two points of these features that can be nearest, if no earlier pair of features
/// has nearest points. False: there are none.
bool construct(PointSearch& on_a, PointSearch& on_b, const ScaledPair& pair, int of_a, int of_b) {
  const auto& [a, b, exponent] = pair;
  if (is_corner(of_a)) {
    on_a.corner(a, of_a);
    if (is_corner(of_b)) return on_b.corner(b, of_b);
    if (of_b == kFace) return on_b.foot_on_plane(b, a[of_a]);
    return on_b.foot_on_edge(b, of_b - 3, a[of_a]);
  }
  if (is_corner(of_b)) {
    on_b.corner(b, of_b);
    if (of_a == kFace) return on_a.foot_on_plane(a, b[of_b]);
    return on_a.foot_on_edge(a, of_a - 3, b[of_b]);
  }
  if (of_a == kFace) {
    return of_b != kFace && on_a.edge_and_plane(b, of_b - 3, a) &&
           on_b.edge_and_plane(b, of_b - 3, a);
  }
  if (of_b == kFace)
    return on_a.edge_and_plane(a, of_a - 3, b) && on_b.edge_and_plane(a, of_a - 3, b);
  return on_a.edge_and_edge(a, of_a - 3, b, of_b - 3) &&
         on_b.edge_and_edge(b, of_b - 3, a, of_a - 3);
}

/// Whether x is the fraction, rounded: whether that lies between the middles beside x.
bool is_rounded(double x, const mpq_class& exact) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (std::isnan(x) || (x == 0 && std::signbit(x))) return false;
  const bool even = (std::bit_cast<std::uint64_t>(x) & 1) == 0;
  // 2^1024 stands for infinity.
  const auto rational = [](double y) {
    return std::isfinite(y) ? mpq_class(y) : mpq_class((y > 0 ? 1 : -1) * (mpz_class(1) << 1024));
  };
  const auto beside = [&](double next) {
    return cmp(exact, mpq_class((rational(x) + rational(next)) / 2));
  };
  const int below = x == -kInfinity ? 1 : beside(std::nextafter(x, -kInfinity));
  const int above = x == kInfinity ? -1 : beside(std::nextafter(x, kInfinity));
  return (below > 0 || (below == 0 && even)) && (above < 0 || (above == 0 && even));
}

}  // namespace

bool is_rounded(const Vec3& x, const FractionPoint& point) {
  for (int k = 0; k < 3; ++k) {
    mpq_class exact(point.over[static_cast<std::size_t>(k)], point.under);
    exact.canonicalize();
    if (point.exponent >= 0) {
      exact <<= static_cast<mp_bitcnt_t>(point.exponent);
    } else {
      exact >>= static_cast<mp_bitcnt_t>(-point.exponent);
    }
    exact += mpq_class(point.from[k]);
    if (!is_rounded(x[k], exact)) return false;
  }
  return true;
}

IntegerDistance integer_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  thread_local PointSearch on_a, on_b;
  const ScaledPair pair = scaled(a, b);
  for (int of_a = 0; of_a < kFeatures; ++of_a) {
    for (int of_b = 0; of_b < kFeatures; ++of_b) {
      // The construction is not trusted: the points count only if they lie in the triangles and are
      // proved nearest.
      if (!construct(on_a, on_b, pair, of_a, of_b) || !on_a.is_nearest(on_b, pair.a, pair.b) ||
          !on_a.lies_in(pair.a) || !on_b.lies_in(pair.b)) {
        continue;
      }
      IntegerDistance out;
      on_a.squared_distance(on_b, out.squared.over, out.squared.under);
      if (pair.exponent > 0) out.squared.over <<= 2 * pair.exponent;
      if (pair.exponent < 0) out.squared.under <<= -2 * pair.exponent;
      out.features = {static_cast<std::uint8_t>(of_a), static_cast<std::uint8_t>(of_b)};
      out.points = {FractionPoint{on_a.point(), on_a.scale(), pair.exponent, a[0]},
                    FractionPoint{on_b.point(), on_b.scale(), pair.exponent, a[0]}};
      return out;
    }
  }
  throw std::logic_error("integer_distance: no two features hold nearest points");
}

bool is_beyond(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Length& length,
               bool or_as_far) {
  if (or_as_far && length.squared.over == 0) return true;
  thread_local Scratch<mpz_class> s;
  const ScaledPair pair = scaled(a, b);
  Fraction limit = length.squared;
  if (pair.exponent > 0) limit.under <<= 2 * pair.exponent;
  if (pair.exponent < 0) limit.over <<= -2 * pair.exponent;
  const auto shows = [&](int direction) {
    make_direction(s, pair.a, pair.b, direction);
    return has_gap(s, pair.a, pair.b) && gap_reaches(s, limit.over, limit.under, or_as_far);
  };
  const int likely = likely_direction(a, b, length.above);
  if (shows(likely)) return true;
  for (int n = 0; n < kDirections; ++n) {
    // The directions of the lowest degree first.
    const int direction = n < 9 ? 29 + n : n - 9;
    if (direction != likely && shows(direction)) return true;
  }
  return false;
}

}  // namespace farcull
