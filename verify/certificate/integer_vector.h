// Vectors of machine integers and of GMP's, with the few operations that deciding a pair takes. For
// the sources of verify/certificate/integer_pair.h alone.
#pragma once

#include <gmpxx.h>

#include <array>

namespace farcull::integer {

__extension__ using Wide = __int128;

template <class Integer>
using Vector = std::array<Integer, 3>;
template <class Integer>
using Corners = std::array<Vector<Integer>, 3>;

inline void multiply(Wide& out, Wide x, Wide y) { out = x * y; }
inline void add_product(Wide& out, Wide x, Wide y) { out += x * y; }
inline void subtract_product(Wide& out, Wide x, Wide y) { out -= x * y; }

inline void multiply(mpz_class& out, const mpz_class& x, const mpz_class& y) {
  mpz_mul(out.get_mpz_t(), x.get_mpz_t(), y.get_mpz_t());
}
inline void add_product(mpz_class& out, const mpz_class& x, const mpz_class& y) {
  mpz_addmul(out.get_mpz_t(), x.get_mpz_t(), y.get_mpz_t());
}
inline void subtract_product(mpz_class& out, const mpz_class& x, const mpz_class& y) {
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

template <class Integer>
void edge(Vector<Integer>& out, const Corners<Integer>& t, int i) {
  minus(out, t[(i + 1) % 3], t[i]);
}

}  // namespace farcull::integer
