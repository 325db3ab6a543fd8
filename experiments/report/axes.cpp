// Ticks stand at 1, 2 or 5 times powers of ten, or at the values where these are powers of two.
#include "experiments/report/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace farcull {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
// Longer tails of powers are written as powers.
constexpr int kPlainPowers = 3;

double power(int exponent) { return std::pow(10.0, exponent); }

// 1, 2 or 5 times a power of ten: the largest that is at most x, or the least that is at least x.
double round_down(double x) {
  const double base = power(static_cast<int>(std::floor(std::log10(x))));
  // A power of ten that rounding left above x.
  if (base > x) return base / 10 * 5;
  for (const double m : {5.0, 2.0}) {
    if (m * base <= x) return m * base;
  }
  return base;
}

double round_up(double x) {
  const double base = round_down(x);
  if (base >= x) return base;
  for (const double m : {1.0, 2.0, 5.0, 10.0, 20.0}) {
    const double next = m * power(static_cast<int>(std::floor(std::log10(base) + 1e-9)));
    if (next >= x) return next;
  }
  return base * 10;
}

std::size_t width_of(const std::vector<Tick>& ticks) {
  std::size_t width = 0;
  for (const Tick& tick : ticks) {
    if (!tick.label.empty()) width += characters(tick.label) + 2;
  }
  return width;
}

// Labels are taken away, every second first, until the others fit.
void thin(std::vector<Tick>& ticks, std::size_t room) {
  while (width_of(ticks) > room) {
    std::size_t labelled = 0;
    for (Tick& tick : ticks) {
      if (!tick.label.empty() && labelled++ % 2 == 1) tick.label.clear();
    }
    if (labelled <= 2) return;
  }
}

// Resolutions and the like: all values are powers of two, and few.
std::vector<Tick> ticks_at_powers_of_two(const std::vector<double>& values) {
  std::set<double> distinct;
  for (const double value : values) {
    if (std::isfinite(value)) distinct.insert(value);
  }
  if (distinct.size() < 3 || distinct.size() > 10) return {};
  std::vector<Tick> out;
  for (const double value : distinct) {
    int exponent = 0;
    if (value <= 0 || std::frexp(value, &exponent) != 0.5) return {};
    out.push_back({value, tick_label(value)});
  }
  return out;
}

// At equal steps from 1, 2 or 5 times a power of ten.
std::vector<Tick> even_ticks(double from, double to, double step) {
  std::vector<Tick> out;
  const double begin = std::ceil(from / step - 1e-9);
  for (int i = 0; i <= 12; ++i) {
    double at = (begin + i) * step;
    if (at > to + 1e-9 * step) break;
    if (std::abs(at) < 1e-9 * step) at = 0;
    out.push_back({at, tick_label(at)});
  }
  return out;
}

void add_log_ticks(Scale& scale, double lowest, std::size_t room) {
  // Powers say nothing where there is hardly one.
  if (scale.to < 5 * lowest) {
    for (Tick& tick : even_ticks(lowest, scale.to, round_up((scale.to - lowest) / 4)))
      scale.ticks.push_back(std::move(tick));
    thin(scale.ticks, room);
    return;
  }
  const int first = static_cast<int>(std::ceil(std::log10(lowest) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(scale.to) + 1e-9));
  const bool plain = first >= -kPlainPowers && last <= kPlainPowers;
  const bool short_range = std::log10(scale.to / lowest) < 1.7;
  const bool minor = std::log10(scale.to / lowest) < 6;
  for (int exponent = first - 1; exponent <= last; ++exponent) {
    for (int m = 1; m <= 9; ++m) {
      const double at = m * power(exponent);
      if (at < lowest * (1 - 1e-9) || at > scale.to * (1 + 1e-9)) continue;
      if (m == 1) {
        scale.ticks.push_back({at, plain ? tick_label(at) : power_label(exponent)});
      } else if (short_range && (m == 2 || m == 5)) {
        scale.ticks.push_back({at, tick_label(at)});
      } else if (minor) {
        scale.ticks.push_back({at, ""});
      }
    }
  }
  thin(scale.ticks, room);
}

Scale logarithmic_scale(const Axis& axis, const std::vector<double>& values, std::size_t room) {
  Scale scale;
  scale.logarithmic = true;
  double least = kNothing, most = kNothing;
  bool zeros = false;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (value <= 0) {
      zeros = true;
      continue;
    }
    if (std::isnan(least) || value < least) least = value;
    if (std::isnan(most) || value > most) most = value;
  }
  if (std::isnan(least)) least = most = 1;
  if (axis.from && *axis.from > 0) least = *axis.from;
  if (axis.to && *axis.to > 0) most = std::max(*axis.to, least);
  scale.from = axis.from && *axis.from > 0 ? least : round_down(least);
  scale.to = axis.to && *axis.to > 0 ? most : round_up(most);
  if (scale.to <= scale.from) {
    scale.from = round_down(scale.from * 0.5);
    scale.to = round_up(scale.to * 2);
  }
  scale.from = std::min(scale.from, least);
  scale.to = std::max(scale.to, most);
  double lowest = scale.from;
  if (axis.shows_zero && zeros) {
    // Counts: linear from 0 to 1. Of what is below 1: to the power of ten below it.
    lowest = least >= 1 ? 1 : power(static_cast<int>(std::floor(std::log10(least) + 1e-9)));
    const double decades = std::log10(scale.to / lowest);
    // Not below what a double can be.
    const double band = std::min(std::max(0.3, 0.13 * decades), (std::log10(lowest) + 305) / 1.5);
    scale.zero = lowest * std::pow(10, -band);
    scale.linear_to = lowest;
    scale.from = lowest * std::pow(10, -1.5 * band);
    scale.ticks.push_back({scale.zero, "0"});
  }
  if (std::vector<Tick> at = ticks_at_powers_of_two(values); !at.empty() && scale.zero == 0) {
    std::erase_if(at, [&](const Tick& t) { return t.at < scale.from || t.at > scale.to; });
    // A little air beside the first and the last point.
    const double air = std::pow(scale.to / scale.from, 0.03);
    if (!axis.from) scale.from = at.front().at / air;
    if (!axis.to) scale.to = at.back().at * air;
    thin(at, room);
    scale.ticks = std::move(at);
    return scale;
  }
  add_log_ticks(scale, lowest, room);
  return scale;
}

Scale linear_scale(const Axis& axis, const std::vector<double>& values, std::size_t room) {
  Scale scale;
  double least = kNothing, most = kNothing;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (std::isnan(least) || value < least) least = value;
    if (std::isnan(most) || value > most) most = value;
  }
  if (std::isnan(least)) least = 0, most = 1;
  // From 0 where that does not squeeze what there is to see.
  if (least > 0 && least < 0.5 * most) least = 0;
  if (axis.from) least = *axis.from;
  if (axis.to) most = *axis.to;
  if (most <= least) {
    const double around = least == 0 ? 1 : std::abs(least) * 0.5;
    if (!axis.from && least != 0) least -= around;
    most = least + 2 * around;
  }
  const double span = most - least;
  const double target = std::clamp(static_cast<double>(room) / 9.0, 2.0, 6.0);
  double step = std::max(round_up(span / target), std::numeric_limits<double>::min());
  // One tick gives no scale: where both ends are given, hardly a multiple of the step may be
  // between them.
  while (axis.from && axis.to && even_ticks(least, most, step).size() < 3) {
    const double finer = round_down(0.9 * step);
    if (!(finer > span / 20)) break;
    step = finer;
  }
  scale.from = axis.from ? least : std::floor(least / step + 1e-9) * step;
  scale.to = axis.to ? most : std::ceil(most / step - 1e-9) * step;
  // Rounding must not leave a value outside.
  scale.from = std::min(scale.from, least);
  scale.to = std::max(scale.to, most);
  scale.ticks = even_ticks(scale.from, scale.to, step);
  thin(scale.ticks, room);
  return scale;
}

}  // namespace

double Scale::place(double value) const {
  if (!std::isfinite(value)) return kNothing;
  if (!logarithmic || (value > 0 && value >= linear_to)) return value;
  if (linear_to == 0) return kNothing;
  return zero * std::pow(linear_to / zero, std::max(value, 0.0) / linear_to);
}

double Scale::along(double place) const {
  return logarithmic ? std::log(place / from) / std::log(to / from) : (place - from) / (to - from);
}

std::size_t Scale::label_width() const {
  std::size_t width = 0;
  for (const Tick& tick : ticks) width = std::max(width, characters(tick.label));
  return width;
}

Scale scale_of(const Axis& axis, const std::vector<double>& values, std::size_t room) {
  return axis.logarithmic ? logarithmic_scale(axis, values, room)
                          : linear_scale(axis, values, room);
}

std::string tick_label(double value) {
  const double size = std::abs(value);
  if (size != 0 && (size >= 1e7 || size < 1e-4)) {
    const int exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9));
    const double mantissa = value / power(exponent);
    if (std::abs(mantissa - 1) < 1e-9) return power_label(exponent);
    return fmt::format("{:g}·{}", std::round(mantissa * 1000) / 1000, power_label(exponent));
  }
  if (size < 1000) return fmt::format("{:.6g}", value);
  std::string digits = fmt::format("{:.0f}", size);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return (value < 0 ? "-" : "") + digits;
}

std::string power_label(int exponent) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = "10";
  if (exponent < 0) out += "⁻";
  for (const char c : std::to_string(std::abs(exponent))) out += kDigits[c - '0'];
  return out;
}

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

}  // namespace farcull
