// Separating directions: Gottschalk, Lin, Manocha, "OBBTree" (1996) for the idea; that 38
// directions are complete for triangles, degenerate ones included, is proved in
// docs/certificate.md.
#include "verify/integer_pair.h"

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace farcull {
namespace {

__extension__ using Wide = __int128;

template <class Integer>
using Vector = std::array<Integer, 3>;
template <class Integer>
using Corners = std::array<Vector<Integer>, 3>;

// ---- the few operations, for machine integers and for GMP's ----

void multiply(Wide& out, Wide x, Wide y) { out = x * y; }
void add_product(Wide& out, Wide x, Wide y) { out += x * y; }
void subtract_product(Wide& out, Wide x, Wide y) { out -= x * y; }

void multiply(mpz_class& out, const mpz_class& x, const mpz_class& y) {
  mpz_mul(out.get_mpz_t(), x.get_mpz_t(), y.get_mpz_t());
}
void add_product(mpz_class& out, const mpz_class& x, const mpz_class& y) {
  mpz_addmul(out.get_mpz_t(), x.get_mpz_t(), y.get_mpz_t());
}
void subtract_product(mpz_class& out, const mpz_class& x, const mpz_class& y) {
  mpz_submul(out.get_mpz_t(), x.get_mpz_t(), y.get_mpz_t());
}

template <class Integer>
void minus(Vector<Integer>& out, const Vector<Integer>& x, const Vector<Integer>& y) {
  for (int k = 0; k < 3; ++k) out[k] = x[k] - y[k];
}

template <class Integer>
void dot(Integer& out, const Vector<Integer>& x, const Vector<Integer>& y) {
  multiply(out, x[0], y[0]);
  add_product(out, x[1], y[1]);
  add_product(out, x[2], y[2]);
}

template <class Integer>
void cross(Vector<Integer>& out, const Vector<Integer>& x, const Vector<Integer>& y) {
  for (int k = 0; k < 3; ++k) {
    multiply(out[k], x[(k + 1) % 3], y[(k + 2) % 3]);
    subtract_product(out[k], x[(k + 2) % 3], y[(k + 1) % 3]);
  }
}

template <class Integer>
bool is_zero(const Vector<Integer>& x) {
  return x[0] == 0 && x[1] == 0 && x[2] == 0;
}

// What a test needs besides the corners. Kept between tests, since GMP's integers own memory.
template <class Integer>
struct Scratch {
  Vector<Integer> e, f, w, d;
  Integer ee, we;
  std::array<Integer, 3> on_a, on_b;
};

// ---- directions ----

template <class Integer>
void edge(Vector<Integer>& out, const Corners<Integer>& t, int i) {
  minus(out, t[(i + 1) % 3], t[i]);
}

/// s.d = the direction; see kDirections.
template <class Integer>
void make_direction(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b,
                    int direction) {
  if (direction < 2) {
    edge(s.e, direction == 0 ? a : b, 0);
    edge(s.f, direction == 0 ? a : b, 1);
    cross(s.d, s.e, s.f);
    return;
  }
  const int family = (direction - 2) / 9;
  const int i = (direction - 2) % 9 / 3;
  const int j = (direction - 2) % 3;
  if (family == 0) {
    edge(s.e, a, i);
    edge(s.f, b, j);
    cross(s.d, s.e, s.f);
    return;
  }
  if (family == 3) {
    minus(s.d, b[j], a[i]);
    return;
  }
  minus(s.w, b[j], a[i]);
  if (family == 1) {
    edge(s.e, a, i);
  } else {
    edge(s.e, b, j);
  }
  dot(s.ee, s.e, s.e);
  dot(s.we, s.w, s.e);
  for (int k = 0; k < 3; ++k) {
    multiply(s.d[k], s.w[k], s.ee);
    subtract_product(s.d[k], s.e[k], s.we);
  }
}

/// True iff the projections onto s.d have a gap. Onto zero they are equal, which is none.
template <class Integer>
bool has_gap(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b) {
  for (int i = 0; i < 3; ++i) {
    dot(s.on_a[i], s.d, a[i]);
    dot(s.on_b[i], s.d, b[i]);
  }
  const auto all_less = [](const auto& x, const auto& y) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (!(x[i] < y[j])) return false;
      }
    }
    return true;
  };
  return all_less(s.on_a, s.on_b) || all_less(s.on_b, s.on_a);
}

/// The largest bits for which has_gap(make_direction()) stays in 127 bits. With |differences| < D =
/// 2^bits, each coordinate itself the difference from a's first corner:
///   corner-corner: |d| < D, |projection| < 3 D^2 < 2^(2 bits + 2)
///   cross products: |d| < 2 D^2, |projection| < 6 D^3 < 2^(3 bits + 3)
///   perpendiculars: e.e, |w.e| < 3 D^2, |d| < 6 D^3, |projection| < 18 D^4 < 2^(4 bits + 5)
/// Sums that are still being formed are smaller than these bounds.
int most_bits(int direction) {
  if (direction >= 29) return 62;
  return direction < 11 ? 41 : 30;
}

// ---- from doubles to integers ----

/// value = mantissa * 2^exponent, the mantissa odd or 0.
struct Parts {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

Parts parts(double value) {
  if (value == 0) return {};
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa >> zeros, exponent - 53 + zeros};
}

int bit_length(Wide magnitude) {
  const auto high = static_cast<std::uint64_t>(magnitude >> 64);
  return high != 0 ? 128 - std::countl_zero(high)
                   : 64 - std::countl_zero(static_cast<std::uint64_t>(magnitude));
}

}  // namespace

struct IntegerPair::Big {
  Corners<mpz_class> a, b;

  Big(const std::array<Vec3, 3>& from_a, const std::array<Vec3, 3>& from_b) {
    int least = std::numeric_limits<int>::max();
    for (const auto* t : {&from_a, &from_b}) {
      for (const Vec3& p : *t) {
        for (int k = 0; k < 3; ++k) {
          if (p[k] != 0) least = std::min(least, parts(p[k]).exponent);
        }
      }
    }
    const auto convert = [least](Corners<mpz_class>& to, const std::array<Vec3, 3>& from) {
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
          const Parts x = parts(from[i][k]);
          to[i][k] = static_cast<long>(x.mantissa);
          if (x.mantissa != 0) to[i][k] <<= x.exponent - least;
        }
      }
    };
    convert(a, from_a);
    convert(b, from_b);
    // Every direction and every gap is about differences, and differences are shorter.
    const Vector<mpz_class> origin = a[0];
    for (auto* t : {&a, &b}) {
      for (Vector<mpz_class>& p : *t) minus(p, Vector<mpz_class>(p), origin);
    }
  }
};

IntegerPair::IntegerPair(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b)
    : corners_{a, b}, bits_(std::numeric_limits<int>::max()) {
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
  constexpr int kWidest = 125;  // of a coordinate, so that a difference still is a Wide
  if (top > least && top - least > kWidest) return;
  const auto value = [&](int i, int k) {
    const Parts x = all[i][k];
    return x.mantissa == 0 ? Wide{0} : Wide{x.mantissa} * (Wide{1} << (x.exponent - least));
  };
  std::array<std::array<Wide, 3>, 6> relative;
  int longest = 0;
  for (int k = 0; k < 3; ++k) {
    const Wide origin = value(0, k);
    Wide lo = 0;
    Wide hi = 0;
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
  if (!big_) big_ = std::make_unique<Big>(corners_[0], corners_[1]);
  return *big_;
}

bool IntegerPair::separated_by(int direction) {
  if (bits_ <= most_bits(direction)) {
    Corners<Wide> a;
    Corners<Wide> b;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        a[i][k] = small_[i][k];
        b[i][k] = small_[i + 3][k];
      }
    }
    Scratch<Wide> s;
    make_direction(s, a, b, direction);
    return has_gap(s, a, b);
  }
  thread_local Scratch<mpz_class> s;
  const Big& pair = big();
  make_direction(s, pair.a, pair.b, direction);
  return has_gap(s, pair.a, pair.b);
}

std::optional<int> IntegerPair::separating_direction() {
  // The directions of the lowest degree first: 29 .. 37, 0 .. 10, 11 .. 28.
  for (int n = 0; n < kDirections; ++n) {
    const int direction = n < 9 ? 29 + n : n - 9;
    if (separated_by(direction)) return direction;
  }
  return std::nullopt;
}

bool integer_intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return !IntegerPair(a, b).separating_direction().has_value();
}

// ---- points ----

namespace {

using BigVector = Vector<mpz_class>;
using BigCorners = Corners<mpz_class>;

BigVector difference(const BigVector& x, const BigVector& y) {
  BigVector out;
  minus(out, x, y);
  return out;
}

BigVector product(const BigVector& x, const BigVector& y) {
  BigVector out;
  cross(out, x, y);
  return out;
}

mpz_class dot_of(const BigVector& x, const BigVector& y) {
  mpz_class out;
  dot(out, x, y);
  return out;
}

/// numerator / denominator, the denominator > 0.
struct Point {
  BigVector numerator;
  mpz_class denominator;
};

/// True iff the point lies in the closed hull of the corners, whatever its dimension.
bool contains(const BigCorners& t, const Point& point) {
  std::array<BigVector, 3> from;  // denominator * (point - corner i)
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) from[i][k] = point.numerator[k] - point.denominator * t[i][k];
  }
  const BigVector normal = product(difference(t[1], t[0]), difference(t[2], t[0]));
  if (!is_zero(normal)) {
    if (dot_of(normal, from[0]) != 0) return false;
    for (int i = 0; i < 3; ++i) {
      const BigVector side = product(difference(t[(i + 1) % 3], t[i]), from[i]);
      if (dot_of(normal, side) < 0) return false;
    }
    return true;
  }
  // Collinear corners: the hull is the union of its edges. Between two ends: on their line, and the
  // offsets from the ends differ in sign in every coordinate or are zero (which pins a point that
  // both ends coincide in).
  for (int i = 0; i < 3; ++i) {
    const BigVector& p = from[i];
    const BigVector& q = from[(i + 1) % 3];
    if (!is_zero(product(difference(t[(i + 1) % 3], t[i]), p))) continue;
    bool between = true;
    for (int k = 0; k < 3; ++k) between = between && sgn(p[k]) * sgn(q[k]) <= 0;
    if (between) return true;
  }
  return false;
}

/// p + (numerator / denominator) u; none unless the fraction is in [0, 1].
std::optional<Point> along(const BigVector& p, const BigVector& u, mpz_class numerator,
                           mpz_class denominator) {
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  if (denominator == 0 || numerator < 0 || numerator > denominator) return std::nullopt;
  Point point;
  for (int k = 0; k < 3; ++k) point.numerator[k] = p[k] * denominator + u[k] * numerator;
  point.denominator = std::move(denominator);
  return point;
}

/// Where edge i of s crosses the plane of t, if it does so in one point.
std::optional<Point> edge_and_plane(const BigCorners& s, int i, const BigCorners& t) {
  const BigVector normal = product(difference(t[1], t[0]), difference(t[2], t[0]));
  const BigVector u = difference(s[(i + 1) % 3], s[i]);
  return along(s[i], u, dot_of(normal, difference(t[0], s[i])), dot_of(normal, u));
}

/// The point of edge i of s nearest to the line of edge j of t, unless they are parallel. Where the
/// lines cross it is their common point.
std::optional<Point> edge_and_edge(const BigCorners& s, int i, const BigCorners& t, int j) {
  const BigVector u = difference(s[(i + 1) % 3], s[i]);
  const BigVector v = difference(t[(j + 1) % 3], t[j]);
  const BigVector c = product(u, v);
  return along(s[i], u, dot_of(product(difference(t[j], s[i]), v), c), dot_of(c, c));
}

}  // namespace

bool IntegerPair::has_common_point() {
  const Big& pair = big();
  // Whatever was constructed, only membership in both triangles counts.
  const auto in_both = [&](const std::optional<Point>& point) {
    return point && contains(pair.a, *point) && contains(pair.b, *point);
  };
  for (int i = 0; i < 3; ++i) {
    if (in_both(edge_and_plane(pair.a, i, pair.b))) return true;
    if (in_both(edge_and_plane(pair.b, i, pair.a))) return true;
  }
  for (int i = 0; i < 3; ++i) {
    if (in_both(Point{pair.a[i], 1}) || in_both(Point{pair.b[i], 1})) return true;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (in_both(edge_and_edge(pair.a, i, pair.b, j))) return true;
    }
  }
  return false;
}

}  // namespace farcull
