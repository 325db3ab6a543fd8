// Tries simpler pairs, all of one round in one process, and goes on from the simplest that keeps
// the fault.
#include "experiments/peers/minimize.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "core/base/error.h"
#include "experiments/peers/score.h"
#include "experiments/suite/reader.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Change = std::function<double(double)>;

/// Coordinate i of 18, of the first triangle and then of the second.
double& coordinate(SuitePair& pair, std::size_t i) {
  return (i < 9 ? pair.a : pair.b)[i / 3 % 3][static_cast<Eigen::Index>(i % 3)];
}
double coordinate(const SuitePair& pair, std::size_t i) {
  return (i < 9 ? pair.a : pair.b)[i / 3 % 3][static_cast<Eigen::Index>(i % 3)];
}

void change_all(SuitePair& pair, const Change& change) {
  for (std::size_t i = 0; i < 18; ++i) coordinate(pair, i) = change(coordinate(pair, i));
}

/// Rounded to so many bits.
double to_bits(double value, int bits) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(fraction, bits)), exponent - bits);
}
/// Rounded to so many significant decimal digits.
double to_digits(double value, int digits) {
  if (value == 0) return 0;
  char text[40];
  std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  return std::strtod(text, nullptr);
}

/// A shared corner is one vertex: the second takes what the first has.
void keep_shared(SuitePair& pair) {
  for (const SharedCorner& corner : pair.shared) pair.b[corner.b] = pair.a[corner.a];
}

std::vector<SuitePair> simpler(const SuitePair& from) {
  std::vector<SuitePair> out;
  const auto with = [&](const std::function<void(SuitePair&)>& change) {
    SuitePair next = from;
    change(next);
    keep_shared(next);
    bool finite = true;
    for (std::size_t i = 0; i < 18; ++i) finite = finite && std::isfinite(coordinate(next, i));
    if (finite && cost_of(next) < cost_of(from)) out.push_back(std::move(next));
  };
  const auto all = [&](const Change& change) {
    with([&](SuitePair& pair) { change_all(pair, change); });
  };
  for (const int bits : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32})
    all([bits](double x) { return to_bits(x, bits); });
  for (int digits = 1; digits <= 16; ++digits)
    all([digits](double x) { return to_digits(x, digits); });
  // As integers, at the scale of the largest coordinate.
  double most = 0;
  for (std::size_t i = 0; i < 18; ++i) most = std::max(most, std::abs(coordinate(from, i)));
  if (most > 0) {
    const int exponent = std::ilogb(most);
    for (int keep = 1; keep <= 30; keep += 1) {
      all([=](double x) { return std::nearbyint(std::ldexp(x, keep - exponent)); });
    }
    all([=](double x) { return std::ldexp(x, -exponent); });
  }
  for (const auto* triangle : {&from.a, &from.b}) {
    for (const Vec3& corner : *triangle) {
      with([&](SuitePair& pair) {
        for (Vec3& p : pair.a) p -= corner;
        for (Vec3& p : pair.b) p -= corner;
      });
    }
  }
  for (std::size_t i = 0; i < 18; ++i) {
    for (const int digits : {0, 1, 2, 3, 5, 8}) {
      with([&](SuitePair& pair) {
        double& x = coordinate(pair, i);
        x = digits == 0 ? 0 : to_digits(x, digits);
      });
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const SuitePair& x, const SuitePair& y) { return cost_of(x) < cost_of(y); });
  return out;
}

/// Whether a simpler pair is of the same sort: it meets or not as before, and what the
/// documentation promises of it is the same.
bool like(const ContestantCard& card, const SuitePair& before, SuitePair& pair) {
  // Corners that came together by rounding would be shared by place and not by index.
  if (!pair.shared.empty() && pair.shared != equal_corners(pair.a, pair.b)) return false;
  pair.kind = decide(pair, "a smaller pair");
  return collides(pair.kind) == collides(before.kind) &&
         promised(card, pair) == promised(card, before);
}

}  // namespace

std::size_t cost_of(const SuitePair& pair) { return coordinates_text(pair).size(); }

std::string coordinates_text(const SuitePair& pair) {
  std::string out;
  for (std::size_t i = 0; i < 18; ++i)
    out += (i == 0 ? "" : " ") + decimal(coordinate(pair, i) + 0.0);
  return out;
}

std::optional<SuitePair> minimized(const Invited& invited, const PairFault& fault,
                                   const ContestLimits& limits, int rounds) {
  ContestLimits hasty = limits;
  if (is_death(fault.outcome)) {  // each costs a process, and a hang its whole limit
    hasty.start_s = limits.answer_s;
    rounds = std::min(rounds, 3);
  }
  // Twice, each time alone in a new process.
  const auto errs_alone = [&](const SuitePair& pair) {
    for (int time = 0; time < 2; ++time) {
      if (ask_pairs(invited, std::span(&pair, 1), hasty, 0).answers[0].outcome != fault.outcome)
        return false;
    }
    return true;
  };
  if (!errs_alone(fault.pair)) return std::nullopt;
  SuitePair best = fault.pair;
  for (int round = 0; round < rounds; ++round) {
    std::vector<SuitePair> tried = simpler(best);
    std::erase_if(tried, [&](SuitePair& pair) { return !like(invited.card, fault.pair, pair); });
    if (tried.empty()) return best;
    if (is_death(fault.outcome)) tried.resize(std::min<std::size_t>(tried.size(), 4));
    const PairsAnswer answer = ask_pairs(invited, tried, hasty, 0);
    bool found = false;
    for (std::size_t i = 0; i < tried.size() && !found; ++i) {
      if (answer.answers[i].outcome != fault.outcome || !errs_alone(tried[i])) continue;
      best = tried[i];
      found = true;
    }
    if (!found) return best;
  }
  return best;
}

}  // namespace farcull
