// Stores squared distances as fractions of integers, compares them exactly, and rounds once.
//
// Rounding. A quotient or a root is first cut off to an integer of at least 55 bits, times a power
// of two. Then one more bit is appended, which is 1 iff something was cut off. A double keeps 53
// bits, so at least three bits follow. So the long number lies on the same side of every double,
// and of every middle between two doubles, as the exact number. Therefore both are rounded to the
// same double.
#include "verify/squared_distance.h"

#include <cmath>
#include <utility>

namespace farcull {
namespace {

constexpr long kDigits = 53;
constexpr long kLeastExponent = -1074;  // exponent of the last bit of the least double
constexpr long kKept = kDigits + 2;

/// Returns x 2^k, cut off to an integer.
mpz_class shifted(const mpz_class& x, long k) {
  mpz_class out;
  if (k >= 0) {
    mpz_mul_2exp(out.get_mpz_t(), x.get_mpz_t(), static_cast<mp_bitcnt_t>(k));
  } else {
    mpz_tdiv_q_2exp(out.get_mpz_t(), x.get_mpz_t(), static_cast<mp_bitcnt_t>(-k));
  }
  return out;
}

/// Returns |num| 2^k / den, cut off to an integer. Sets `more` to whether something was cut off.
mpz_class cut_quotient(const mpz_class& num, const mpz_class& den, long k, bool& more) {
  mpz_class quotient, rest;
  const mpz_class n = shifted(num, std::max(k, 0L)), d = shifted(den, std::max(-k, 0L));
  mpz_tdiv_qr(quotient.get_mpz_t(), rest.get_mpz_t(), n.get_mpz_t(), d.get_mpz_t());
  more = rest != 0;
  return quotient;
}

/// Returns 2 x with `more` as its last bit, which makes the magnitude larger.
mpz_class with_last_bit(const mpz_class& x, bool more, int sign) {
  const mpz_class magnitude = 2 * abs(x) + (more ? 1 : 0);
  return sign < 0 ? mpz_class(-magnitude) : magnitude;
}

}  // namespace

double rounded(const mpz_class& m, long exponent) {
  if (m == 0) return 0;
  mpz_class magnitude = abs(m);
  const long last = std::max(bits_of(magnitude) + exponent - kDigits, kLeastExponent);
  const long drop = last - exponent;
  if (drop > 0) {
    // Adds half of the last kept bit, and cuts off the sum. If two doubles are equally near, keeps
    // the even one.
    const auto k = static_cast<mp_bitcnt_t>(drop);
    const bool middle = mpz_scan1(magnitude.get_mpz_t(), 0) == k - 1;
    mpz_class sum = magnitude + shifted(1, drop - 1);
    magnitude = shifted(sum, -drop);
    if (middle && mpz_odd_p(magnitude.get_mpz_t())) magnitude -= 1;
    exponent = last;
  }
  if (magnitude == 0) return 0;
  // The magnitude now has at most 53 bits, or is 2^53, so get_d() is exact. ldexp() returns
  // infinity for a result beyond the largest double.
  const double size =
      exponent > 2000 ? HUGE_VAL : std::ldexp(magnitude.get_d(), static_cast<int>(exponent));
  return m < 0 ? -size : size;
}

double rounded_quotient(const mpz_class& num, const mpz_class& den, long exponent) {
  if (num == 0) return 0;
  const long k = kKept + 1 + bits_of(den) - bits_of(num);
  bool more = false;
  const mpz_class quotient = cut_quotient(num, den, k, more);
  return rounded(with_last_bit(quotient, more, sgn(num)), exponent - k - 1);
}

double rounded_root(const mpz_class& num, const mpz_class& den, long exponent) {
  if (num == 0) return 0;
  long k = 2 * kKept + 1 + bits_of(den) - bits_of(num);
  if ((exponent - k) % 2 != 0) ++k;
  bool more = false;
  const mpz_class square = cut_quotient(num, den, k, more);
  mpz_class root, rest;
  mpz_sqrtrem(root.get_mpz_t(), rest.get_mpz_t(), square.get_mpz_t());
  return rounded(with_last_bit(root, more || rest != 0, 1), (exponent - k) / 2 - 1);
}

SquaredDistance::SquaredDistance() : value_(std::make_shared<const Value>()) {}

SquaredDistance::SquaredDistance(std::shared_ptr<const Value> value) : value_(std::move(value)) {}

SquaredDistance SquaredDistance::of(double distance) {
  if (distance == 0) return {};
  const int exponent = lowest_bit(distance);
  const mpz_class whole = integer_of(distance, exponent);
  return SquaredDistance(std::make_shared<Value>(Value{whole * whole, 1, 2L * exponent}));
}

double SquaredDistance::root() const {
  return rounded_root(value_->num, value_->den, value_->exponent);
}

std::string SquaredDistance::text() const {
  const long e = value_->exponent;
  mpq_class q(shifted(value_->num, std::max(e, 0L)), shifted(value_->den, std::max(-e, 0L)));
  q.canonicalize();
  return q.get_num().get_str() + "/" + q.get_den().get_str();
}

bool SquaredDistance::is_zero() const { return value_->num == 0; }

std::strong_ordering operator<=>(const SquaredDistance& a, const SquaredDistance& b) {
  const SquaredDistance::Value &x = *a.value_, &y = *b.value_;
  if (&x == &y) return std::strong_ordering::equal;
  const long last = std::min(x.exponent, y.exponent);
  const mpz_class left = shifted(x.num * y.den, x.exponent - last);
  const mpz_class right = shifted(y.num * x.den, y.exponent - last);
  return cmp(left, right) <=> 0;
}

bool operator==(const SquaredDistance& a, const SquaredDistance& b) { return (a <=> b) == 0; }

}  // namespace farcull
