// An answer about a box is compared with the exact part of the line in the box. An answer about a
// fattened triangle is compared with points of the line that lie in the solid.
#include "verify/kernel_check.h"

#include <algorithm>
#include <cmath>

#include "verify/kernel_cases.h"
#include "verify/solid_lines.h"

namespace farcull {
namespace {

using rational::Draws;
using rational::Q;

// Each index has its own random numbers, so that a case does not depend on earlier cases.
Draws draws_of(std::uint64_t seed, std::uint64_t index) {
  return Draws(seed * 0x9e3779b97f4a7c15u + index);
}

void count(bool held, KernelTally& tally) {
  ++tally.checked;
  tally.lost += !held;
}

// An answer with an infinite bound or NaN counts as wrong.
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
  // The kernel widens its answer by 2^-20, far more than outer_interval() does. So the comparison
  // with outer_interval() nearly always decides.
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

}  // namespace farcull
