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
#include <stdexcept>

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

/// True iff the direction s.d proves that a and b share no more than their shared part; shared_a
/// and shared_b are the corners that stand in both. Where all of a lies on one side of a plane
/// across d and all of b on the other, they meet only in what both have in the plane: in the hulls
/// of their corners there. That is no more than the shared part where these corners of one triangle
/// are all shared, or where two edges that are not parallel (d is their product) lie in the plane.
template <class Integer>
bool parts_at_shared(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b,
                     int direction, unsigned shared_a, unsigned shared_b) {
  for (int i = 0; i < 3; ++i) {
    dot(s.on_a[i], s.d, a[i]);
    dot(s.on_b[i], s.d, b[i]);
  }
  const auto [a_lo, a_hi] = std::minmax_element(s.on_a.begin(), s.on_a.end());
  const auto [b_lo, b_hi] = std::minmax_element(s.on_b.begin(), s.on_b.end());
  const bool a_below = *a_hi <= *b_lo;
  if (!a_below && !(*b_hi <= *a_lo)) return false;
  const Integer plane = a_below ? *a_hi : *a_lo;  // a shared corner lies in it
  unsigned in_a = 0;
  unsigned in_b = 0;
  for (int i = 0; i < 3; ++i) {
    if (s.on_a[i] == plane) in_a |= 1u << i;
    if (s.on_b[i] == plane) in_b |= 1u << i;
  }
  if ((in_a & ~shared_a) == 0 || (in_b & ~shared_b) == 0) return true;
  if (direction < 2 || direction >= 11 || is_zero(s.d)) return false;
  const auto edge_of = [](int i) { return 1u << i | 1u << ((i + 1) % 3); };
  return in_a == edge_of((direction - 2) / 3) && in_b == edge_of((direction - 2) % 3);
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

/// The triangle whose corners are three of `points`, from `first` on.
Corners<Wide> wide(const std::array<std::array<std::int64_t, 3>, 6>& points, int first) {
  Corners<Wide> out;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) out[i][k] = points[first + i][k];
  }
  return out;
}

}  // namespace

struct IntegerPair::Big {
  Corners<mpz_class> a, b;
  mpz_class clearance;

  Big(const std::array<Vec3, 3>& from_a, const std::array<Vec3, 3>& from_b, double distance = 0) {
    int least = std::numeric_limits<int>::max();
    if (distance != 0) least = parts(distance).exponent;
    for (const auto* t : {&from_a, &from_b}) {
      for (const Vec3& p : *t) {
        for (int k = 0; k < 3; ++k) {
          if (p[k] != 0) least = std::min(least, parts(p[k]).exponent);
        }
      }
    }
    const auto scale = [least](mpz_class& to, double from) {
      const Parts x = parts(from);
      to = static_cast<long>(x.mantissa);
      if (x.mantissa != 0) to <<= x.exponent - least;
    };
    const auto convert = [&](Corners<mpz_class>& to, const std::array<Vec3, 3>& from) {
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) scale(to[i][k], from[i][k]);
      }
    };
    scale(clearance, distance);
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
    const Corners<Wide> a = wide(small_, 0), b = wide(small_, 3);
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

bool IntegerPair::only_shared_by(int direction) {
  if (bits_ <= most_bits(direction)) {
    const Corners<Wide> a = wide(small_, 0), b = wide(small_, 3);
    Scratch<Wide> s;
    make_direction(s, a, b, direction);
    return parts_at_shared(s, a, b, direction, shared_[0], shared_[1]);
  }
  thread_local Scratch<mpz_class> s;
  const Big& pair = big();
  make_direction(s, pair.a, pair.b, direction);
  return parts_at_shared(s, pair.a, pair.b, direction, shared_[0], shared_[1]);
}

bool integer_intersects(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return !IntegerPair(a, b).separating_direction().has_value();
}

bool integer_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  const IntegerPair::Big pair(a, b, clearance);
  Scratch<mpz_class> s;
  for (int direction = 0; direction < kDirections; ++direction) {
    make_direction(s, pair.a, pair.b, direction);
    if (!has_gap(s, pair.a, pair.b)) continue;  // and leaves the projections in s
    const auto [a_lo, a_hi] = std::minmax_element(s.on_a.begin(), s.on_a.end());
    const auto [b_lo, b_hi] = std::minmax_element(s.on_b.begin(), s.on_b.end());
    const mpz_class gap = *a_hi < *b_lo ? mpz_class(*b_lo - *a_hi) : mpz_class(*a_lo - *b_hi);
    mpz_class square;  // of the direction's length
    dot(square, s.d, s.d);
    if (gap * gap > pair.clearance * pair.clearance * square) return false;
  }
  return true;
}

// ---- points ----

namespace {

using BigVector = Vector<mpz_class>;
using BigCorners = Corners<mpz_class>;

/// Constructs points and verifies them. Its integers are members because GMP's own memory: a search
/// that made them anew would spend its time on that.
class PointSearch {
 public:
  /// Each constructs a point; false where there is none. It lies on the edge, but perhaps in
  /// neither triangle.
  bool corner(const BigCorners& t, int i) {
    point_ = t[i];
    scale_ = 1;
    return true;
  }
  /// Where edge i of s crosses the plane of t, if it does so in one point.
  bool edge_and_plane(const BigCorners& s, int i, const BigCorners& t) {
    make_normal(t);
    edge(u_, s, i);
    minus(w_, t[0], s[i]);
    dot(numerator_, normal_, w_);
    dot(scale_, normal_, u_);
    return along(s[i]);
  }
  /// The point of edge i of s nearest to the line of edge j of t, unless they are parallel. Where
  /// the lines cross it is their common point.
  bool edge_and_edge(const BigCorners& s, int i, const BigCorners& t, int j) {
    edge(u_, s, i);
    edge(v_, t, j);
    cross(normal_, u_, v_);
    minus(w_, t[j], s[i]);
    cross(side_, w_, v_);
    dot(numerator_, side_, normal_);
    dot(scale_, normal_, normal_);
    return along(s[i]);
  }

  /// True iff the normal of t is not zero.
  bool is_triangle(const BigCorners& t) {
    make_normal(t);
    return !is_zero(normal_);
  }

  /// True iff the point constructed last lies in the closed hull of the corners, whatever its
  /// dimension.
  bool lies_in(const BigCorners& t) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        from_[i][k] = point_[k];
        subtract_product(from_[i][k], scale_, t[i][k]);
      }
    }
    make_normal(t);
    if (!is_zero(normal_)) {
      dot(value_, normal_, from_[0]);
      if (value_ != 0) return false;
      for (int i = 0; i < 3; ++i) {
        edge(v_, t, i);
        cross(side_, v_, from_[i]);
        dot(value_, normal_, side_);
        if (value_ < 0) return false;
      }
      return true;
    }
    // Collinear corners: the hull is the union of its edges. Between two ends: on their line, and
    // the offsets from the ends differ in sign in every coordinate or are zero (which pins a point
    // that both ends coincide in).
    for (int i = 0; i < 3; ++i) {
      edge(v_, t, i);
      cross(side_, v_, from_[i]);
      if (!is_zero(side_)) continue;
      bool between = true;
      for (int k = 0; k < 3; ++k)
        between = between && sgn(from_[i][k]) * sgn(from_[(i + 1) % 3][k]) <= 0;
      if (between) return true;
    }
    return false;
  }

 private:
  void make_normal(const BigCorners& t) {
    edge(v_, t, 0);
    edge(w_, t, 1);
    cross(normal_, v_, w_);
  }
  /// from + (numerator / scale) u; none unless the fraction is in [0, 1].
  bool along(const BigVector& from) {
    if (scale_ < 0) {
      mpz_neg(scale_.get_mpz_t(), scale_.get_mpz_t());
      mpz_neg(numerator_.get_mpz_t(), numerator_.get_mpz_t());
    }
    if (scale_ == 0 || numerator_ < 0 || numerator_ > scale_) return false;
    for (int k = 0; k < 3; ++k) {
      multiply(point_[k], from[k], scale_);
      add_product(point_[k], u_[k], numerator_);
    }
    return true;
  }

  BigVector point_;                // times scale_
  mpz_class scale_;                // > 0 where there is a point
  std::array<BigVector, 3> from_;  // from each corner to the point, times scale_
  BigVector normal_, u_, v_, w_, side_;
  mpz_class numerator_, value_;
};

}  // namespace

namespace {

/// True iff one of the 21 points passes.
template <class Test>
bool any_point(PointSearch& search, const BigCorners& a, const BigCorners& b, const Test& test) {
  for (int i = 0; i < 3; ++i) {
    if (search.edge_and_plane(a, i, b) && test()) return true;
    if (search.edge_and_plane(b, i, a) && test()) return true;
  }
  for (int i = 0; i < 3; ++i) {
    if (search.corner(a, i) && test()) return true;
    if (search.corner(b, i) && test()) return true;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (search.edge_and_edge(a, i, b, j) && test()) return true;
    }
  }
  return false;
}

}  // namespace

bool IntegerPair::has_common_point() {
  thread_local PointSearch search;
  const Big& pair = big();
  // Whatever was constructed, only membership in both triangles counts.
  return any_point(search, pair.a, pair.b,
                   [&] { return search.lies_in(pair.a) && search.lies_in(pair.b); });
}

bool IntegerPair::meets_beyond_shared() {
  // The corners of a that are shared, one of them repeated where there are fewer than three.
  std::array<int, 3> shared = {-1, -1, -1};
  std::size_t count = 0;
  for (int i = 0; i < 3; ++i) {
    if ((shared_[0] >> i & 1) != 0) shared[count++] = i;
  }
  if (count == 0) throw std::logic_error("IntegerPair: no shared position");
  for (; count < 3; ++count) shared[count] = shared[count - 1];

  thread_local PointSearch search;
  const bool all = shared_[0] == 7 && shared_[1] == 7;
  // The hull of the shared corners is the shared part unless they are the corners of a triangle.
  if (all && search.is_triangle(big().a)) return true;
  for (int direction = 0; direction < 11; ++direction) {
    if (only_shared_by(direction)) return false;
  }
  const Big& pair = big();
  const BigCorners part = {pair.a[shared[0]], pair.a[shared[1]], pair.a[shared[2]]};
  return any_point(search, pair.a, pair.b, [&] {
    return search.lies_in(pair.a) && search.lies_in(pair.b) && !search.lies_in(part);
  });
}

}  // namespace farcull
