// The integers behind a SquaredDistance, and rounding of fractions to doubles. For the sources of
// verify/closest.h and verify/contact.h and their tests alone.
#pragma once

#include <gmpxx.h>

#include "verify/closest.h"

namespace farcull {

/// num / den times 2^exponent. Not in lowest terms: those take time, and only text() needs them.
struct SquaredDistance::Value {
  mpz_class num = 0;  // >= 0
  mpz_class den = 1;  // > 0
  long exponent = 0;
};

/// m times 2^exponent, rounded to the nearest double, to the even one of two equally near doubles.
/// Subnormal results are rounded once as well. Results beyond the largest double become infinity,
/// as IEEE 754 rounds. Never -0.0.
double rounded(const mpz_class& m, long exponent);

/// num / den times 2^exponent, den > 0, rounded in the same way.
double rounded_quotient(const mpz_class& num, const mpz_class& den, long exponent);

/// The root of num / den times 2^exponent, num >= 0 and den > 0, rounded in the same way.
double rounded_root(const mpz_class& num, const mpz_class& den, long exponent);

}  // namespace farcull
