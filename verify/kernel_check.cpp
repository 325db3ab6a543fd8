// Draws cases by seed and index, and counts answers that do not contain all they must: the exact
// interval of a box, points of the solid of an exact offset, or, for FAR pairs, the corners of the
// part of a triangle over the pixel.
#include "verify/kernel_check.h"

#include <algorithm>
#include <cmath>

#include "verify/kernel_cases.h"
#include "verify/solid_lines.h"

namespace farcull {
namespace {

using rational::Draws;
using rational::Q;
using rational::Q3;

// An engine for each index, so that a case does not depend on the ones before.
Draws draws_of(std::uint64_t seed, std::uint64_t index) {
  return Draws(seed * 0x9e3779b97f4a7c15u + index);
}

void count(bool held, KernelTally& tally) {
  ++tally.checked;
  tally.lost += !held;
}

// An answer with a bound that is not finite counts as wrong.
bool usable(const SolidAnswer& a) {
  return !a.hit || (std::isfinite(a.entry) && std::isfinite(a.exit));
}

void count_excess(double excess, KernelTally& tally) {
  ++tally.ordinary;
  tally.loose += !(excess <= kLoose);
  tally.excess = std::max(tally.excess, excess);
}

}  // namespace

void check_box(const SolidCase& c, const SolidAnswer& answer, bool ordinary, KernelTally& tally) {
  if (!usable(answer)) return count(false, tally);
  // The kernel widens by 2^-20, so comparing with an interval in doubles that is a little too large
  // decides nearly always.
  const auto outer = box_line::outer_interval(c.cx, c.cy, c.solid);
  bool held = !outer || (answer.hit && answer.entry <= outer->lo && answer.exit >= outer->hi);
  if (!held) {
    const auto truth = box_line::exact_interval(c.cx, c.cy, c.solid);
    held = !truth || (answer.hit && Q(answer.entry) <= truth->lo && Q(answer.exit) >= truth->hi);
  }
  count(held, tally);
  if (ordinary && outer && answer.hit)
    count_excess(std::max(outer->lo - answer.entry, answer.exit - outer->hi), tally);
}

void check_minkowski(const SolidCase& c, const SolidAnswer& answer, bool ordinary,
                     KernelTally& tally) {
  if (!usable(answer)) return count(false, tally);
  const minkowski_line::Line line(c.solid, c.cx, c.cy);
  minkowski_line::Tally points;
  minkowski_line::check_contacts(line, c.solid, c.cx, c.cy, answer, points);
  minkowski_line::check(line, c.solid, c.cx, c.cy, minkowski_line::weights(1.0L / 3, 1.0L / 3),
                        answer, points);
  tally.checked += static_cast<std::uint64_t>(points.checks);
  tally.lost += static_cast<std::uint64_t>(points.violations);
  if (!ordinary || !answer.hit) return;
  minkowski_line::Weights at{};
  minkowski_line::Real first = 0, last = 0;
  if (!line.contact(-1, at, first) || !line.contact(1, at, last)) return;
  const minkowski_line::Real lo = std::max<minkowski_line::Real>(first, c.solid[0][3]);
  const minkowski_line::Real hi = std::min<minkowski_line::Real>(last, c.solid[2][3]);
  count_excess(static_cast<double>(std::max(lo - answer.entry, answer.exit - hi)), tally);
}

void check_interval(const IntervalCase& c, const IntervalAnswer& answer, KernelTally& tally) {
  const auto finite = [](const auto&... x) { return (std::isfinite(x) && ...); };
  for (int axis = 0; axis < 3; ++axis) {
    if (!finite(answer.lo[axis], answer.hi[axis])) return count(false, tally);
  }
  if (answer.hit && !finite(answer.row_lo, answer.row_hi, answer.near, answer.far))
    return count(false, tally);
  const std::vector<Q3> real = interval_cases::real_triangle(c);
  for (const Q3& p : real) {
    for (int axis = 0; axis < 3; ++axis)
      count(Q(answer.lo[axis]) <= p[axis] && p[axis] <= Q(answer.hi[axis]), tally);
  }
  const std::vector<Q3> part =
      interval_cases::part_in(real, Q(c.i), Q(c.i + 1), Q(c.j), Q(c.j + 1));
  for (const Q3& p : part) {
    count(answer.hit && Q(answer.row_lo) <= p[0] && p[0] <= Q(answer.row_hi) &&
              Q(answer.near) <= p[2] && p[2] <= Q(answer.far),
          tally);
  }
  // The answer may be no wider than the depths over the grown pixel. The budget grows the pixel by
  // three times the margin, once for each rounding of a border (docs/budget.md, "Interval pairs").
  if (part.empty() || !answer.hit) return;
  float most = 0;
  for (const auto& corner : c.corners) {
    for (const float x : corner) most = std::max(most, std::abs(x));
  }
  if (most > 4096) return;
  const Q grown(3 * (c.widening + 0x1p-17 * (1.0 + most)));
  std::vector<Q3> exact(3);
  for (int k = 0; k < 3; ++k)
    exact[k] = {Q(c.corners[k][0]), Q(c.corners[k][1]), Q(c.corners[k][2])};
  const std::vector<Q3> around =
      interval_cases::part_in(exact, c.i - grown, c.i + 1 + grown, c.j - grown, c.j + 1 + grown);
  if (around.empty()) return;
  Q near = around[0][2], far = around[0][2];
  for (const Q3& p : around) {
    near = std::min(near, p[2]);
    far = std::max(far, p[2]);
  }
  const Q before = near - grown - Q(answer.near), behind = Q(answer.far) - far - grown;
  count_excess(std::max(0.0, std::max(before.get_d(), behind.get_d())), tally);
}

void check_slices(const std::vector<SliceCase>& cases, const std::vector<SliceAnswer>& answers,
                  KernelTally& tally) {
  for (std::size_t n = 0; n < cases.size(); ++n) {
    const SliceCase& c = cases[n];
    const SliceAnswer& a = answers[n];
    const Q steps = Q(c.z) * Q(c.steps_per_px);
    const mpz_class whole = steps.get_num() / steps.get_den();  // the fraction is dropped
    mpz_class step = whole - c.first_step;
    if (step < 0) step = 0;
    mpz_class slice = step * c.slices_per_step / 65536;
    if (slice > 63) slice = 63;
    count(slice == a.slice, tally);
    // The integer part of a float below 2^24 is exact.
    const float x = std::clamp(c.x, 0.0f, 65536.0f);
    count(a.pixel == static_cast<std::int32_t>(x), tally);
  }
}

KernelTriangle kernel_triangle(std::uint64_t seed, std::uint64_t index, float cx, float cy) {
  Draws random = draws_of(seed, index);
  const int kind = static_cast<int>(index % minkowski_cases::kKindCount);
  const minkowski_cases::Case c = minkowski_cases::random_case_at(random, kind, cx, cy);
  return {c.triangle, c.radius, kind == 0};
}

Solid adversarial_box(std::uint64_t seed, std::uint64_t index, float cx, float cy) {
  Draws random = draws_of(seed, index);
  return box_line::adversarial_at(random, cx, cy);
}

Solid adversarial_minkowski(std::uint64_t seed, std::uint64_t index, float cx, float cy) {
  Draws random = draws_of(seed, index);
  return minkowski_cases::adversarial_at(random, cx, cy);
}

std::vector<IntervalCase> interval_kernel_cases(std::uint64_t seed, std::size_t count) {
  std::vector<IntervalCase> out;
  for (std::size_t n = 0; n < count; ++n) {
    Draws random = draws_of(seed, n);
    out.push_back(interval_cases::random_case(random));
  }
  return out;
}

std::vector<SliceCase> slice_kernel_cases(std::uint64_t seed, std::size_t count) {
  Draws random(seed);
  std::vector<SliceCase> out;
  const auto near = static_cast<float>(random.scaled(-4, 12));
  const auto depth = std::exp2(random.uniform(-4, 14));
  const int fine = std::min(9, 13 - std::ilogb(depth));
  const auto steps_per_px = std::ldexp(1.0f, fine);
  const auto first_step = static_cast<std::int32_t>(std::ldexp(near, fine));
  const auto slices_per_step = static_cast<std::int32_t>(
      std::min(0x1p16, std::floor(64 * 0x1p16 / (depth * steps_per_px + 2))));
  while (out.size() < count) {
    // Draws borders of steps and their neighbours, and depths inside and beyond the window.
    auto z = static_cast<float>(near + random.uniform(-0.1, 1.1) * depth);
    if (random.coin()) z = std::trunc(z * steps_per_px) / steps_per_px;
    if (random.below(16) == 0) z = static_cast<float>(random.scaled(-10, 20));
    auto x = static_cast<float>(random.scaled(-20, 18));
    if (random.coin()) x = static_cast<float>(random.below(65537));
    for (const float side : {-HUGE_VALF, HUGE_VALF}) {
      out.push_back({z, steps_per_px, first_step, slices_per_step, x});
      z = std::nextafter(z, side);
      x = std::nextafter(x, side);
    }
    out.push_back({z, steps_per_px, first_step, slices_per_step, x});
  }
  out.resize(count);
  std::sort(out.begin(), out.end(),
            [](const SliceCase& a, const SliceCase& b) { return a.z < b.z; });
  return out;
}

}  // namespace farcull
