// Scales a pair of triangles to integers once. Uses 128-bit integers if the coordinates are short
// enough and there is no clearance; otherwise the big integers of GMP.
#include "verify/certificate/integer_pair.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "verify/certificate/integer_witnesses.h"
#include "verify/certificate/integers.h"

namespace farcull {

using namespace integer;

namespace {

int bit_length(Wide magnitude) {
  const auto high = static_cast<std::uint64_t>(magnitude >> 64);
  return high != 0 ? 64 + std::bit_width(high)
                   : std::bit_width(static_cast<std::uint64_t>(magnitude));
}

Corners<Wide> wide(const std::array<std::array<std::int64_t, 3>, 6>& points, int first) {
  Corners<Wide> out;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) out[i][k] = points[first + i][k];
  }
  return out;
}

using Triangle = std::array<Vec3, 3>;

Vec3 direction_of(const Triangle& a, const Triangle& b, int direction) {
  const auto edge = [](const Triangle& t, int i) -> Vec3 { return t[(i + 1) % 3] - t[i]; };
  const auto cross = [](const Vec3& x, const Vec3& y) -> Vec3 {
    return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  };
  if (direction < 2) {
    const Triangle& t = direction == 0 ? a : b;
    return cross(edge(t, 0), edge(t, 1));
  }
  const int family = (direction - 2) / 9;
  const int i = (direction - 2) % 9 / 3;
  const int j = (direction - 2) % 3;
  const Vec3 w = b[j] - a[i];
  if (family == 0) return cross(edge(a, i), edge(b, j));
  if (family == 3) return w;
  const Vec3 e = family == 1 ? edge(a, i) : edge(b, j);
  return w * e.dot(e) - e * w.dot(e);
}

}  // namespace

struct IntegerPair::Big : ScaledPair {
  mpz_class clearance, squared_clearance;

  Big(const std::array<Vec3, 3>& from_a, const std::array<Vec3, 3>& from_b, double distance)
      : ScaledPair(scaled(from_a, from_b, distance)) {
    scale(clearance, distance, exponent);
    multiply(squared_clearance, clearance, clearance);
  }
};

IntegerPair::IntegerPair(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                         double clearance)
    : corners_{a, b}, clearance_(clearance), bits_(std::numeric_limits<int>::max()) {
  std::array<std::array<Parts, 3>, 6> all;
  int least = std::numeric_limits<int>::max();
  int top = std::numeric_limits<int>::min();
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Parts x = all[i][k] = parts(corners_[i / 3][i % 3][k]);
      if (x.mantissa == 0) continue;
      least = std::min(least, x.exponent);
      top = std::max(top, x.exponent + bit_length(x.mantissa < 0 ? -Wide{x.mantissa} : x.mantissa));
    }
  }
  constexpr int kWidest = 125;  // bits of a coordinate; a difference then fits a Wide
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (corners_[0][i] != corners_[1][j]) continue;
      shared_[0] |= 1u << i;
      shared_[1] |= 1u << j;
    }
  }
  if (top > least && top - least > kWidest) return;
  const auto value = [&](int i, int k) {
    const Parts x = all[i][k];
    return x.mantissa == 0 ? Wide{0} : Wide{x.mantissa} * (Wide{1} << (x.exponent - least));
  };
  std::array<std::array<Wide, 3>, 6> relative;
  int longest = 0;
  for (int k = 0; k < 3; ++k) {
    const Wide origin = value(0, k);
    Wide lo = 0, hi = 0;
    for (int i = 0; i < 6; ++i) {
      relative[i][k] = value(i, k) - origin;
      lo = std::min(lo, relative[i][k]);
      hi = std::max(hi, relative[i][k]);
    }
    longest = std::max(longest, bit_length(hi - lo));
  }
  if (longest > most_bits(29)) return;
  bits_ = longest;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 3; ++k) small_[i][k] = static_cast<std::int64_t>(relative[i][k]);
  }
}

IntegerPair::~IntegerPair() = default;

IntegerPair::Big& IntegerPair::big() {
  if (!big_) big_ = std::make_unique<Big>(corners_[0], corners_[1], clearance_);
  return *big_;
}

/// Computes the direction and returns use(scratch, a, b). Chooses integers that are long enough.
bool IntegerPair::with_direction(int direction, double clearance, const auto& use) {
  // Most clearances are decimal fractions. Scaling such a clearance makes the integers too long.
  if (clearance == 0 && bits_ <= most_bits(direction)) {
    const Corners<Wide> a = wide(small_, 0), b = wide(small_, 3);
    Scratch<Wide> s;
    make_direction(s, a, b, direction);
    return use(s, a, b);
  }
  thread_local Scratch<mpz_class> s;
  const Big& pair = big();
  make_direction(s, pair.a, pair.b, direction);
  return use(s, pair.a, pair.b);
}

bool IntegerPair::separated_by(int direction) {
  return with_direction(direction, clearance_, [&](auto& s, const auto& a, const auto& b) {
    if (!has_gap(s, a, b)) return false;
    if constexpr (std::is_same_v<decltype(s.ee), mpz_class>)
      return clearance_ == 0 || gap_reaches(s, big().squared_clearance, 1, false);
    return true;
  });
}

std::optional<int> IntegerPair::separating_direction() {
  const auto found = std::ranges::find_if(kByDegree, [&](int d) { return separated_by(d); });
  return found == kByDegree.end() ? std::nullopt : std::optional(*found);
}

bool IntegerPair::has_common_point() {
  thread_local PointSearch search;
  const Big& pair = big();
  // The constructions are not trusted: a point counts only if it lies in both triangles.
  return any_point(search, pair.a, pair.b,
                   [&] { return search.lies_in(pair.a) && search.lies_in(pair.b); });
}

bool IntegerPair::is_within() {
  if (clearance_ > 0) {
    thread_local PointSearch in_a, in_b;
    const Big& pair = big();
    if (any_two_points(in_a, in_b, pair.a, pair.b, [&] {
          return in_a.is_near(in_b, pair.clearance) && in_a.lies_in(pair.a) && in_b.lies_in(pair.b);
        })) {
      return true;
    }
  }
  return has_common_point();
}

bool IntegerPair::meets_beyond_shared() {
  // The shared corners of a; if there are fewer than three, the last corner is repeated.
  std::array<int, 3> shared = {-1, -1, -1};
  std::size_t count = 0;
  for (int i = 0; i < 3; ++i) {
    if ((shared_[0] >> i & 1) != 0) shared[count++] = i;
  }
  if (count == 0) throw std::logic_error("IntegerPair: no shared position");
  for (; count < 3; ++count) shared[count] = shared[count - 1];

  thread_local PointSearch search;
  const bool all = shared_[0] == 7 && shared_[1] == 7;
  // If the triangles are equal and not degenerate, they share their inside, so they meet. Otherwise
  // the shared part is the hull of the shared corners.
  if (all && search.is_triangle(big().a)) return true;
  for (int direction = 0; direction < 11; ++direction) {
    const bool only_shared =
        with_direction(direction, 0, [&](auto& s, const auto& a, const auto& b) {
          return parts_at_shared(s, a, b, direction, shared_[0], shared_[1]);
        });
    if (only_shared) return false;
  }
  const Big& pair = big();
  const BigCorners part = {pair.a[shared[0]], pair.a[shared[1]], pair.a[shared[2]]};
  return any_point(search, pair.a, pair.b, [&] {
    return search.lies_in(pair.a) && search.lies_in(pair.b) && !search.lies_in(part);
  });
}

// Tries the 38 directions in doubles. Rounding errors do no harm: the caller proves the result.

int likely_direction(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  constexpr double kClear = 1e-6;
  int best = 29;
  double widest = -std::numeric_limits<double>::infinity();
  for (const int direction : kByDegree) {
    const Vec3 d = direction_of(a, b, direction);
    std::array<double, 3> on_a, on_b;
    for (int i = 0; i < 3; ++i) {
      on_a[i] = d.dot(a[i] - a[0]);
      on_b[i] = d.dot(b[i] - a[0]);
    }
    const auto [a_lo, a_hi] = std::minmax({on_a[0], on_a[1], on_a[2]});
    const auto [b_lo, b_hi] = std::minmax({on_b[0], on_b[1], on_b[2]});
    const double extent = std::max(a_hi, b_hi) - std::min(a_lo, b_lo);
    const double needed = clearance == 0 ? 0 : clearance * d.norm();
    const double gap = (std::max(b_lo - a_hi, a_lo - b_hi) - needed) / extent;
    if (gap > kClear) return direction;
    if (gap > widest) widest = gap, best = direction;
  }
  return best;
}

}  // namespace farcull
