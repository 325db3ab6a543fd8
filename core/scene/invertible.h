// Whether a linear map can be inverted.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace farcull {

/// False if the matrix (finite, row by row) maps space to a plane, a line or a point, as far as
/// doubles tell: its determinant is 0, or no larger than its own rounding errors.
///
/// Each row is divided by its largest number, which changes neither answer nor signs. A term of the
/// determinant then meets 8 roundings at most: the three quotients, two products, a difference and
/// two sums. So 9 u times the sum of the magnitudes covers them, as in verify/filter_scalars.h.
inline bool is_invertible(std::array<double, 9> r) {
  for (int row = 0; row < 9; row += 3) {
    const double most = std::max({std::abs(r[row]), std::abs(r[row + 1]), std::abs(r[row + 2])});
    if (!(most > 0)) return false;
    for (int k = row; k < row + 3; ++k) r[k] /= most;
  }
  double sum = 0, magnitudes = 0;
  for (int k = 0; k < 3; ++k) {
    const int l = 3 + (k + 1) % 3, m = 3 + (k + 2) % 3;
    const double p = r[l] * r[m + 3], q = r[m] * r[l + 3];
    sum += r[k] * (p - q);
    magnitudes += std::abs(r[k]) * (std::abs(p) + std::abs(q));
  }
  return std::abs(sum) > 9 * 0x1p-53 * magnitudes;
}

}  // namespace farcull
