// All numbers are rationals (GMP), so nothing is rounded, except a double that is returned.
#include "verify/exact_point.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace farcull {
namespace {

mpq_class coordinate(const ExactPoint& point, int axis) {
  mpq_class sum = 0;
  int weights = 0;
  for (int i = 0; i < 3; ++i) {
    sum += mpq_class(point.corners[i][axis]) * point.weights[i];
    weights += point.weights[i];
  }
  return sum / weights;
}

// Returns the first and last index of the pixels that contain x, in a row of `size` pixels centred
// on 0; first > last if no pixel does.
std::pair<int, int> indices(const mpq_class& x, int size) {
  const mpq_class at = x + mpq_class(size) / 2;
  if (at < 0 || at > size) return {0, -1};
  mpz_class floor;
  mpz_fdiv_q(floor.get_mpz_t(), at.get_num_mpz_t(), at.get_den_mpz_t());
  const int upper = static_cast<int>(floor.get_si());
  const int lower = at == floor ? upper - 1 : upper;
  return {std::max(lower, 0), std::min(upper, size - 1)};
}

// Returns the larger number, rounded toward 0 to a double. A positive number does not become 0.
double larger(const mpq_class& a, const mpq_class& b) {
  const mpq_class& most = a > b ? a : b;
  const double cut = most.get_d();
  return cut == 0 && most > 0 ? std::numeric_limits<double>::denorm_min() : cut;
}

}  // namespace

std::vector<Pixel> pixels_containing(const ExactPoint& point, int width, int height) {
  const auto [x0, x1] = indices(coordinate(point, 0), width);
  const auto [y0, y1] = indices(coordinate(point, 1), height);
  std::vector<Pixel> out;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) out.push_back({x, y});
  }
  return out;
}

bool bounded(const ExactPoint& point, float entry, float exit) {
  if (!std::isfinite(entry) || !std::isfinite(exit)) return false;  // no kernel returns infinity
  const mpq_class z = coordinate(point, 2);
  return mpq_class(entry) <= z && z <= mpq_class(exit);
}

double beyond(const ExactPoint& point, float entry, float exit) {
  const mpq_class z = coordinate(point, 2);
  return larger(mpq_class(entry) - z, z - mpq_class(exit));
}

double beyond_stored(const ExactPoint& point, float entry, float exit, float scale) {
  const mpq_class depth = mpq_class(1, 2) + coordinate(point, 2) * mpq_class(scale);
  return larger(mpq_class(entry) - depth, depth - mpq_class(exit));
}

}  // namespace farcull
