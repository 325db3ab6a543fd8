// The compressed data of pages: read back as web/page_view.js reads them, they are what was
// written.
#include "experiments/picture/picture.h"

#include <rapidcheck/gtest.h>

#include "core/base/bytes.h"
#include "experiments/scenes/mesh/text.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

std::string unpacked(const std::string& block) {
  const auto small = from_base64(block);
  if (!small) throw std::runtime_error("no Base64");
  return gunzip({reinterpret_cast<const char*>(small->data()), small->size()}, "block");
}

// The way of numbersOf() in web/page_view.js.
std::vector<std::uint32_t> numbers_of(const std::string& block) {
  const std::string bytes = unpacked(block);
  const std::size_t n = bytes.size() / 4;
  std::vector<std::uint32_t> out;
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint32_t zigzag = 0;
    for (std::size_t byte = 0; byte < 4; ++byte)
      zigzag |= std::uint32_t{static_cast<unsigned char>(bytes[byte * n + i])} << 8 * byte;
    before += zigzag >> 1 ^ (0 - (zigzag & 1));
    out.push_back(before);
  }
  return out;
}

RC_GTEST_PROP(PageBlocks, NumbersComeBack, (const std::vector<std::uint32_t>& numbers)) {
  RC_ASSERT(numbers_of(packed_numbers(numbers)) == numbers);
}

TEST(PageBlocks, TheLargestDifferencesComeBack) {
  const std::vector<std::uint32_t> numbers = {0xffffffff, 0, 0x80000000, 0, 0x7fffffff, 1, 1};
  EXPECT_EQ(numbers_of(packed_numbers(numbers)), numbers);
  EXPECT_TRUE(numbers_of(packed_numbers({})).empty());
}

RC_GTEST_PROP(PageBlocks, BitsAreThoseOfTheNumbers, (const std::vector<bool>& wanted)) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < wanted.size(); ++i)
    if (wanted[i]) numbers.push_back(i);
  const std::string bits = unpacked(packed_bytes(bits_of(numbers, wanted.size())));
  RC_ASSERT(bits.size() == (wanted.size() + 7) / 8);
  for (std::size_t i = 0; i < 8 * bits.size(); ++i) {
    const bool one = (static_cast<unsigned char>(bits[i / 8]) >> i % 8 & 1) != 0;
    RC_ASSERT(one == (i < wanted.size() && wanted[i]));
  }
}

// Rounded to the nearest step: half a step, and the roundings of the formula, which are below 1e-10
// of a step.
RC_GTEST_PROP(PageBlocks, PositionsAreHalfAStepAway,
              (const std::vector<std::array<int, 3>>& given)) {
  RC_PRE(!given.empty());
  std::vector<Vec3> points;
  Box box = Box::empty();
  for (const auto& p : given) {
    points.emplace_back(p[0], p[1], p[2]);
    box.add(points.back());
  }
  const std::vector<std::uint32_t> steps = quantized(points, box);
  RC_ASSERT(steps.size() == 3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double extent = box.hi[axis] - box.lo[axis];
      const double back = box.lo[axis] + steps[axis * points.size() + i] / 65535.0 * extent;
      RC_ASSERT(std::abs(back - points[i][axis]) <= (0.5 + 1e-6) / 65535 * extent);
    }
  }
}

TEST(PageBlocks, PositionsOfTheLargestDoublesAndOfPoints) {
  const Box all = {.lo = Vec3::Constant(-1.7e308), .hi = Vec3::Constant(1.7e308)};
  EXPECT_EQ(quantized(std::vector<Vec3>{all.lo, all.hi}, all),
            (std::vector<std::uint32_t>{0, 65535, 0, 65535, 0, 65535}));
  const Box point = {.lo = Vec3(1, 2, 3), .hi = Vec3(1, 2, 3)};
  EXPECT_EQ(quantized(std::vector<Vec3>{point.lo}, point), (std::vector<std::uint32_t>{0, 0, 0}));
  // Outside of the box.
  EXPECT_EQ(
      quantized(std::vector<Vec3>{Vec3(9, -9, 3)}, {.lo = Vec3(0, 0, 3), .hi = Vec3(1, 1, 4)}),
      (std::vector<std::uint32_t>{65535, 0, 0}));
}

RunOptions of(Method method, int resolution = 0) {
  RunOptions out;
  out.method = method;
  out.resolution = resolution;
  return out;
}

std::vector<std::string> titles(const std::vector<RunOptions>& steps) {
  std::vector<std::string> out;
  for (const RunOptions& options : steps) out.push_back(panel_title(options));
  return out;
}

TEST(PageSteps, AMethodThatDrawsHasEveryResolutionOnceAscending) {
  const std::vector<std::string> expected = {"cullide at 32 px", "cullide at 128 px",
                                             "far at 32 px", "far at 128 px"};
  EXPECT_EQ(titles(at_resolutions({of(Method::cullide, 512), of(Method::far)}, {128, 32, 128})),
            expected);
}

// The radius makes another method of it.
TEST(PageSteps, FormsOfFarAreApart) {
  RunOptions published = of(Method::far);
  published.radius = parse_radius("published");
  EXPECT_EQ(at_resolutions({of(Method::far), published}, {32, 64}).size(), 4u);
}

}  // namespace
}  // namespace farcull
