// What chapters compute from rows, and how they write numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/studies/store.h"

namespace farcull {

/// A count or a time of a row by its name; empty where the row has none.
std::optional<double> count_of(const Row& row, const std::string& name);
std::optional<double> time_of(const Row& row, const std::string& name);

/// As figures and tables name what a point was measured with: "FAR (OBB)", "CULLIDE", "FAR pairs".
std::string method_label(const Point& point);

/// The middle value, of an even number the mean of the two. Precondition: there is one.
double median(std::vector<double> values);

/// The exponent b of y = a x^b by least squares in logarithms, with its standard error (from the
/// residuals; none of the model itself).
struct Exponent {
  double value = 0, error = 0;
  double from = 0, to = 0;  // of x
  std::size_t points = 0;
};
/// Pairs that are not both positive are left out. Empty where fewer than three are left, or x does
/// not differ.
std::optional<Exponent> exponent_of(const std::vector<double>& x, const std::vector<double>& y);

/// Three significant digits, all of a whole number, thousands grouped: 0.0123, 1.50, 3, 12,346.
std::string rounded(double value, int digits = 3);

/// With a point at its end where it has none.
std::string sentence(std::string text);

/// "a, b and c".
std::string listed(const std::vector<std::string>& words);

/// "farcull experiment NAME", with --quick and --seed as the study was declared.
std::string command_of(const Declaration& declaration);

}  // namespace farcull
