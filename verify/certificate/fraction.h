// Squares of distances as fractions of GMP's integers. For the sources of this folder and for
// tests.
#pragma once

#include <gmpxx.h>

#include <compare>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace farcull {

/// over / under, >= 0. Not always in lowest terms.
struct Fraction {
  mpz_class over = 0;   // >= 0
  mpz_class under = 1;  // > 0

  /// By value: 1/2 equals 2/4.
  friend std::strong_ordering operator<=>(const Fraction& x, const Fraction& y);
  friend bool operator==(const Fraction& x, const Fraction& y) { return x <=> y == 0; }
};

/// The most decimal digits of either part of a squared distance. All coordinates of a scene times
/// 2^1074 are integers below 2^2098, and their differences are below D = 2^2099. In this scale the
/// square of a distance is, by the features of the nearest points, (w . d)^2 / (d . d) with d at
/// most a product of two edges, so both parts are below (6 D^3)^2 < 2^12600. In world units
/// the lower part has 2148 bits more: (d . d) 2^2148 < (2 D^2)^2 * 3 * 2^2148 < 2^10548. Dividing
/// by common factors makes none longer. log10(2^12600) < 3793.
constexpr std::size_t kMostDigits = 4000;

/// The square of a length, finite and >= 0.
Fraction square_of(double length);

/// The fraction that is all of the text: decimal digits, '/', decimal digits, in lowest terms,
/// without leading zeros, neither part longer than kMostDigits. None for any other text.
std::optional<Fraction> parse_fraction(std::string_view text);

/// In lowest terms, as parse_fraction() reads it.
std::string text_of(const Fraction& fraction);

/// A double that is at least the root, and hardly more; infinity where no double is.
double root_above(const Fraction& fraction);

/// A length by its square, with the double above it.
struct Length {
  Fraction squared;
  double above = 0;  // root_above(squared)

  explicit Length(Fraction square) : squared(std::move(square)), above(root_above(squared)) {}
};

}  // namespace farcull
