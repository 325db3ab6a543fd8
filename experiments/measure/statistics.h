// Intervals of what is estimated from few measurements: medians and their ratios by the bootstrap,
// slopes by Student's t.
#pragma once

#include <cstddef>
#include <vector>

namespace farcull {

/// An estimate from n measurements with its 95 % interval.
struct Estimate {
  double value = 0, low = 0, high = 0;
  std::size_t n = 0;
};

/// The middle value, of an even number of values the mean of the two in the middle; 0 of none.
double middle(std::vector<double> values);

/// The middle() with the percentile interval of the bootstrap (Efron and Tibshirani 1993,
/// section 13.3): as many values are drawn with replacement 10,000 times, and the interval goes
/// from the 2.5th to the 97.5th percentile of their medians. The generator has a fixed seed, so the
/// same values in any order give the same interval. It contains the true median with a probability
/// of 75 % for 3 independent runs, 94 % for 5 and 96 % for 9 (docs/experiments.md, "Statistics").
/// All 0 where there are no values.
Estimate median_estimate(std::vector<double> values);

/// The median of the first over that of the second, both drawn anew; n: of the smaller one.
/// Precondition: both have values, those of the second above 0.
Estimate ratio_estimate(std::vector<double> over, std::vector<double> under);

/// The factor t with which value +- t * standard error is the 95 % interval of a least-squares
/// slope with so many degrees of freedom (points less 2). Precondition: at least 1.
double student_t95(std::size_t degrees);

}  // namespace farcull
