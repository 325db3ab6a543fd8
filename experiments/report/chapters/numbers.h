// Numbers of rows: medians and exponents of them, and how a report writes them.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/studies/store.h"

namespace farcull {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // a gap in a line

/// A count or a time of a row by its name; empty where the row has none.
std::optional<double> count_of(const Row& row, const std::string& name);
std::optional<double> time_of(const Row& row, const std::string& name);
/// The same; NaN where the row has none.
inline double count_or_none(const Row& row, const std::string& name) {
  return count_of(row, name).value_or(kNone);
}
inline double time_or_none(const Row& row, const std::string& name) {
  return time_of(row, name).value_or(kNone);
}
/// Each run of a row in ms, in their order; empty where the row does not hold them.
std::vector<double> runs_of(const Row& row);
/// Whether a row has a count of that name that is true.
bool flag_of(const Row& row, const std::string& name);
/// A count of that name that is text; "" where the row has none.
std::string text_of(const Row& row, const std::string& name);

/// As figures and tables name what a point was measured with: "FAR (OBB)", "FAR pairs", "CULLIDE",
/// in another form "CULLIDE, one round, all views".
std::string method_label(const PointKey& point);

/// The name of a scene without the seed that it was drawn with: "field" of "field@seed101".
std::string scene_base(const std::string& scene);

/// The middle value, of an even number the mean of the two. Precondition: there is one.
double median(std::vector<double> values);

/// "2 (1 to 3)": the median with the least and the largest; "-" of no values.
std::string spread(const std::vector<double>& values, const std::string& unit = "");

/// A share of `hits` in `of` draws, with its 95 % interval: that of Clopper and Pearson, exact for
/// draws that do not depend on each other; of no hit from 0 to the upper bound at 95 %, which is
/// about 3 / of. Precondition: hits <= of, of >= 1.
struct Rate {
  double value = 0, low = 0, high = 0;
};
Rate rate_of(std::uint64_t hits, std::uint64_t of);
/// "0 of 114,014 (95 % bound: at most 2.6e-5)", or "5 of 1,000 (5.0e-3, 95 % interval 1.6e-3 to
/// 0.012)"; "0 of 0" alone.
std::string rate_text(std::uint64_t hits, std::uint64_t of);

/// The exponent b of y = a x^b by least squares in logarithms, with its standard error (from the
/// residuals; none of the model itself) and its 95 % interval by Student's t.
struct Exponent {
  double value = 0, error = 0;
  double low = 0, high = 0;
  double from = 0, to = 0;  // of x
  std::size_t points = 0;
};
/// Pairs that are not both positive are left out. Empty where fewer than three are left, or x does
/// not differ.
std::optional<Exponent> exponent_of(const std::vector<double>& x, const std::vector<double>& y);
/// An interval of fewer points says little, since t is large: it is not given.
constexpr std::size_t kFewestForInterval = 6;
/// "0.77 (0.58 to 0.96)", or "0.77 (no interval of 4 points)".
std::string exponent_text(const Exponent& exponent);

/// Three significant digits, all of a whole number, thousands grouped: 0.0123, 1.50, 3, 12,346.
std::string rounded(double value, int digits = 3);

/// With a point at its end where it has none.
std::string sentence(std::string text);

/// "a, b and c".
std::string listed(const std::vector<std::string>& words);

/// "farcull experiment NAME", with --quick and --seed as the study was declared.
std::string command_of(const Declaration& declaration);
/// The same with --suite, --contestants and --device as they were given to the last of the runs
/// that measured rows of it. A word is quoted where a shell asks for it.
std::string command_of(const StoredStudy& stored,
                       const std::vector<std::pair<std::int64_t, Provenance>>& runs);

}  // namespace farcull
