// Least squares in logarithms, medians, binomial intervals, and numbers as text.
#include "experiments/report/chapters/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/measure/harness.h"
#include "experiments/system/shell_word.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

std::optional<double> number_in(const nlohmann::ordered_json& values, const std::string& name) {
  const auto it = values.find(name);
  if (it == values.end() || !it->is_number()) return {};
  return it->get<double>();
}

std::string base_label(const std::string& method, const PointKey& point) {
  if (method == "far") return point.offset == "exact" ? "FAR (exact)" : "FAR (OBB)";
  if (method == "far-pairs") return "FAR pairs";
  if (method == "cullide") return "CULLIDE";
  if (method == "quick-cullide") return "Quick-CULLIDE";
  if (method == "s-cullide") return "S-CULLIDE";
  if (method == "i-collide") return "I-COLLIDE";
  if (method.starts_with("far-snapped-"))
    return "FAR (OBB), " + method.substr(std::string("far-snapped-").size()) + " subpixel bits";
  return method;
}

// "CULLIDE, one round" of "cullide --rounds 1".
std::string form_label(const std::string& form) {
  const auto has = [&](const char* option) { return form.find(option) != std::string::npos; };
  std::string out;
  if (const std::size_t at = form.find("--rounds "); at != std::string::npos) {
    const std::string rounds = form.substr(at + 9, form.find(' ', at + 9) - at - 9);
    out += rounds == "1" ? ", one round" : ", " + rounds + " rounds";
  }
  if (has("--clear all")) out += ", all views";
  if (has("--level objects")) out += ", objects alone";
  if (has("--conservative")) out += ", conservative";
  if (const std::size_t at = form.find('@'); at != std::string::npos)
    out += ", " + form.substr(at + 1, form.find("px", at) - at - 1) + " px a triangle";
  return out;
}

std::string grouped_digits(std::string digits) {
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return digits;
}

}  // namespace

std::optional<double> count_of(const Row& row, const std::string& name) {
  return number_in(*row.measurement.counts, name);
}

std::optional<double> time_of(const Row& row, const std::string& name) {
  return number_in(*row.measurement.times, name);
}

std::vector<double> runs_of(const Row& row) {
  const auto& times = *row.measurement.times;
  const auto it = times.find("totals");
  return it != times.end() && it->is_array() ? it->get<std::vector<double>>()
                                             : std::vector<double>();
}

bool flag_of(const Row& row, const std::string& name) {
  const auto& counts = *row.measurement.counts;
  const auto it = counts.find(name);
  return it != counts.end() && it->is_boolean() && it->get<bool>();
}

std::string text_of(const Row& row, const std::string& name) {
  const auto& counts = *row.measurement.counts;
  const auto it = counts.find(name);
  return it != counts.end() && it->is_string() ? it->get<std::string>() : "";
}

std::string method_label(const PointKey& point) {
  const std::size_t end = std::min(point.method.find(' '), point.method.size());
  return base_label(point.method.substr(0, end), point) + form_label(point.method.substr(end));
}

Rate rate_of(std::uint64_t hits, std::uint64_t of) {
  using Binomial = boost::math::binomial_distribution<double>;
  const auto n = static_cast<double>(of), k = static_cast<double>(hits);
  constexpr double kOutside = 0.05;
  Rate out{.value = k / n};
  if (hits == 0) {
    out.high = Binomial::find_upper_bound_on_p(n, 0, kOutside);
    return out;
  }
  out.low = Binomial::find_lower_bound_on_p(n, k, kOutside / 2);
  out.high = hits == of ? 1 : Binomial::find_upper_bound_on_p(n, k, kOutside / 2);
  return out;
}

std::string rate_text(std::uint64_t hits, std::uint64_t of) {
  const std::string counts = grouped(hits) + " of " + grouped(of);
  if (of == 0) return counts;
  const Rate rate = rate_of(hits, of);
  const auto text = [](double p) { return rounded(p, 2); };
  if (hits == 0) return fmt::format("{} (95 % bound: at most {})", counts, text(rate.high));
  return fmt::format("{} ({}, 95 % interval {} to {})", counts, text(rate.value), text(rate.low),
                     text(rate.high));
}

std::string scene_base(const std::string& scene) { return scene.substr(0, scene.find("@seed")); }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

std::string spread(const std::vector<double>& values, const std::string& unit) {
  if (values.empty()) return "-";
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{}{} ({} to {})", rounded(median(values)), unit, rounded(*least),
                     rounded(*most));
}

std::optional<Exponent> exponent_of(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> u, v;
  Exponent out;
  for (std::size_t i = 0; i < x.size() && i < y.size(); ++i) {
    if (!(x[i] > 0) || !(y[i] > 0) || !std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    out.from = u.empty() ? x[i] : std::min(out.from, x[i]);
    out.to = u.empty() ? x[i] : std::max(out.to, x[i]);
    u.push_back(std::log(x[i]));
    v.push_back(std::log(y[i]));
  }
  const auto n = static_cast<double>(u.size());
  if (u.size() < 3) return {};
  double mean_u = 0, mean_v = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    mean_u += u[i] / n;
    mean_v += v[i] / n;
  }
  double uu = 0, uv = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    uu += (u[i] - mean_u) * (u[i] - mean_u);
    uv += (u[i] - mean_u) * (v[i] - mean_v);
  }
  const auto [least, most] = std::minmax_element(u.begin(), u.end());
  if (*least == *most) return {};
  out.value = uv / uu;
  double residuals = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double r = v[i] - mean_v - out.value * (u[i] - mean_u);
    residuals += r * r;
  }
  out.error = std::sqrt(residuals / (n - 2) / uu);
  out.points = u.size();
  const double reach = student_t95(u.size() - 2) * out.error;
  out.low = out.value - reach;
  out.high = out.value + reach;
  return out;
}

std::string exponent_text(const Exponent& e) {
  return e.points < kFewestForInterval
             ? fmt::format("{:.2f} (no interval of {} points)", e.value, e.points)
             : fmt::format("{:.2f} ({:.2f} to {:.2f})", e.value, e.low, e.high);
}

std::string rounded(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  const std::string sign = value < 0 ? "-" : "";
  if (size == 0) return "0";
  if (size >= 1e9 || size < 1e-4) return fmt::format("{:.{}g}", value, digits);
  if (size == std::floor(size)) return sign + grouped_digits(fmt::format("{:.0f}", size));
  const int whole = static_cast<int>(std::floor(std::log10(size))) + 1;
  std::string text = fmt::format("{:.{}f}", size, std::max(0, digits - whole));
  // 0.9996 rounds to four digits of 1.000.
  if (const std::size_t dot = text.find('.'); dot != std::string::npos) {
    return sign + grouped_digits(text.substr(0, dot)) + text.substr(dot);
  }
  return sign + grouped_digits(text);
}

std::string sentence(std::string text) {
  if (!text.empty() && std::string(".?!").find(text.back()) == std::string::npos) text += '.';
  return text;
}

std::string listed(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += i + 1 == words.size() ? " and " : ", ";
    out += words[i];
  }
  return out;
}

std::string command_of(const Declaration& declaration) {
  std::string out = "farcull experiment " + declaration.study;
  if (declaration.choice.quick) out += " --quick";
  if (declaration.choice.seed != 1) out += fmt::format(" --seed {}", declaration.choice.seed);
  return out;
}

std::string command_of(const StoredStudy& stored,
                       const std::vector<std::pair<std::int64_t, Provenance>>& runs) {
  std::int64_t last = 0;
  for (const Row& row : stored.rows) last = std::max(last, row.run);
  std::string out = command_of(stored.declaration);
  for (const auto& [run, provenance] : runs) {
    if (run != last) continue;
    const auto options = nlohmann::json::parse(provenance.options, nullptr, false);
    for (const char* name : {"suite", "contestants", "device"}) {
      const std::string value =
          options.is_object() && options.contains(name) && options[name].is_string()
              ? options[name].get<std::string>()
              : "";
      if (!value.empty()) out += fmt::format(" --{} {}", name, quoted(value));
    }
  }
  return out;
}

}  // namespace farcull
