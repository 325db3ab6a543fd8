// root_above() guesses a root, then compares the exact square of the guess with the fraction.
#include "verify/certificate/integers.h"

namespace farcull {
namespace {

/// True if the text is a whole number: at most kMostDigits digits, without a leading zero.
bool is_whole(std::string_view text) {
  if (text.empty() || text.size() > kMostDigits || (text[0] == '0' && text.size() > 1))
    return false;
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

long bits_of(const mpz_class& x) { return static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2)); }

}  // namespace

std::strong_ordering operator<=>(const Fraction& x, const Fraction& y) {
  return cmp(mpz_class(x.over * y.under), mpz_class(y.over * x.under)) <=> 0;
}

Fraction square_of(double length) {
  const integer::Parts x = integer::parts(length);
  Fraction out;
  out.over = static_cast<long>(x.mantissa);
  out.over *= mpz_class(out.over);
  if (x.exponent > 0) out.over <<= 2 * x.exponent;
  if (x.exponent < 0) out.under <<= -2 * x.exponent;
  return out;
}

std::optional<Fraction> parse_fraction(std::string_view text) {
  const std::size_t stroke = text.find('/');
  if (stroke == text.npos) return std::nullopt;
  const std::string_view over = text.substr(0, stroke);
  const std::string_view under = text.substr(stroke + 1);
  if (!is_whole(over) || !is_whole(under) || under == "0") return std::nullopt;
  Fraction out{mpz_class(std::string(over)), mpz_class(std::string(under))};
  if (gcd(out.over, out.under) != 1) return std::nullopt;
  return out;
}

double root_above(const Fraction& fraction) {
  if (fraction.over == 0) return 0;
  // A quotient of about 128 bits gives a root of about 64 bits.
  long shift = 128 - bits_of(fraction.over) + bits_of(fraction.under);
  shift += shift & 1;
  const mpz_class quotient = shift >= 0 ? mpz_class((fraction.over << shift) / fraction.under)
                                        : mpz_class(fraction.over / (fraction.under << -shift));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double root = std::ldexp(mpz_class(sqrt(quotient)).get_d(), static_cast<int>(-shift / 2));
  while (std::isfinite(root) && square_of(root) < fraction) root = std::nextafter(root, kInfinity);
  return root;
}

}  // namespace farcull
