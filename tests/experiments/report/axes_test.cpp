#include "experiments/report/axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/experiments/report/logarithmic.h"

namespace farcull {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> labels_of(const Scale& scale) {
  std::vector<std::string> out;
  for (const Tick& tick : scale.ticks) {
    if (!tick.label.empty()) out.push_back(tick.label);
  }
  return out;
}

TEST(ReportAxis, ZerosHaveAPlaceOfTheirOwnBelowThePowers) {
  const Scale scale = scale_of(logarithmic(true), {0, 3, 5000}, 100);
  EXPECT_GT(scale.zero, scale.from);
  EXPECT_LT(scale.zero, 1);
  EXPECT_EQ(scale.place(0), scale.zero);
  EXPECT_EQ(scale.place(3), 3);
  EXPECT_EQ(labels_of(scale).front(), "0");
  // A tick below the smallest power would be taken for a value.
  for (const Tick& tick : scale.ticks)
    EXPECT_TRUE(tick.at == scale.zero || tick.at >= 1) << tick.at;
}

TEST(ReportAxis, WithZerosIsLinearToOneAndLogarithmicBeyond) {
  const Scale counts = scale_of(logarithmic(true), {0, 300, 5000}, 100);
  EXPECT_EQ(counts.linear_to, 1);
  EXPECT_NEAR(counts.place(1), 1, 1e-12);
  // Halfway between 0 and 1.
  EXPECT_NEAR(counts.along(counts.place(0.5)),
              (counts.along(counts.place(0)) + counts.along(1)) / 2, 1e-12);
  const std::vector<std::string> labels = labels_of(counts);
  EXPECT_NE(std::find(labels.begin(), labels.end(), "1"), labels.end());
  // Where values are below 1, linear to a power of ten below all of them.
  EXPECT_NEAR(scale_of(logarithmic(true), {0, 0.03, 50}, 100).linear_to, 0.01, 1e-15);
  // The twin: without zeros nothing is linear.
  EXPECT_EQ(scale_of(logarithmic(true), {3, 300, 5000}, 100).linear_to, 0);
}

TEST(ReportAxis, ZerosAreNoValuesOfALogarithmicAxisThatDoesNotShowThem) {
  const Scale scale = scale_of(logarithmic(), {0, 3, 5000}, 100);
  EXPECT_TRUE(std::isnan(scale.place(0)));
  EXPECT_EQ(scale.zero, 0);
}

TEST(ReportAxis, ZerosAloneStillHaveAnAxis) {
  const Scale scale = scale_of(logarithmic(true), {0, 0, 0}, 100);
  EXPECT_LT(scale.from, scale.to);
  EXPECT_GT(scale.zero, 0);
}

TEST(ReportAxis, HoldsEveryValueOfAnySize) {
  for (const bool log : {false, true}) {
    Axis axis;
    axis.logarithmic = log;
    for (int exponent = -300; exponent <= 300; exponent += 7) {
      for (const double m : {1.0, 1.9999999, 2.0, 4.2, 9.999999}) {
        const double value = m * std::pow(10, exponent);
        const Scale scale = scale_of(axis, {value, value * 3, kNone}, 60);
        EXPECT_LT(scale.from, scale.to) << value;
        EXPECT_LE(scale.from, value) << value;
        EXPECT_GE(scale.to, value * 3) << value;
        EXPECT_FALSE(scale.ticks.empty()) << value;
        EXPECT_LE(scale.ticks.size(), 60u) << value;
      }
    }
  }
}

TEST(ReportAxis, PowersOfTwoAreTicksThemselves) {
  EXPECT_EQ(labels_of(scale_of(logarithmic(), {64, 128, 256, 512}, 100)),
            (std::vector<std::string>{"64", "128", "256", "512"}));
}

TEST(ReportAxis, LessThanADecadeHasTicksAsWell) {
  EXPECT_GE(labels_of(scale_of(logarithmic(), {112, 131, 190}, 60)).size(), 3u);
}

TEST(ReportAxis, LabelsThatDoNotFitAreLeftOut) {
  const Scale wide = scale_of(logarithmic(), {1e-9, 1e9}, 200);
  const Scale narrow = scale_of(logarithmic(), {1e-9, 1e9}, 30);
  EXPECT_GT(labels_of(wide).size(), labels_of(narrow).size());
  EXPECT_GE(labels_of(narrow).size(), 2u);
}

TEST(ReportAxis, LabelsAreForPeople) {
  EXPECT_EQ(tick_label(1000), "1,000");
  EXPECT_EQ(tick_label(0.1), "0.1");
  EXPECT_EQ(tick_label(0), "0");
  EXPECT_EQ(tick_label(1e9), "10⁹");
  EXPECT_EQ(power_label(-12), "10⁻¹²");
  EXPECT_EQ(characters("10⁻¹²"), 5u);
}

TEST(ReportAxis, ANarrowRangeHasTicksAsWell) {
  Axis axis;
  axis.from = 0.96;
  axis.to = 1.04;
  EXPECT_GE(labels_of(scale_of(axis, {0.5, 1, 1.1}, 20)).size(), 3u);
  // The twin: no more than fit, and none added where there are enough.
  EXPECT_LT(labels_of(scale_of(axis, {0.5, 1, 1.1}, 8)).size(), 4u);
  axis.from = 0;
  EXPECT_EQ(labels_of(scale_of(axis, {0.5, 1, 1.1}, 20)),
            (std::vector<std::string>{"0", "0.5", "1"}));
}

}  // namespace
}  // namespace farcull
