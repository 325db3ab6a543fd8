// PNG there and back, and the lettering.
#include "experiments/picture/png_write.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>

#include "experiments/picture/bitmap_font.h"
#include "tests/experiments/picture/png_read.h"

namespace farcull {
namespace {

Image pattern(bool opaque) {
  Image image(37, 11, {});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(7 * x), static_cast<std::uint8_t>(23 * y),
                        static_cast<std::uint8_t>(x * y),
                        static_cast<std::uint8_t>(opaque ? 255 : 5 * x)};
    }
  }
  return image;
}

TEST(PngWrite, ReadsBackPixelsAndTexts) {
  const PngTexts texts = {{"Commit", "0123abc"}, {"Scene", "zwei H\xc3\xa4schen"}, {"Command", ""}};
  for (const bool opaque : {true, false}) {
    const Image image = pattern(opaque);
    const PngContent back = png_content(to_png(image, texts));
    EXPECT_EQ(back.image.width, image.width);
    EXPECT_EQ(back.image.height, image.height);
    EXPECT_EQ(back.image.pixels, image.pixels);
    EXPECT_EQ(back.texts, texts);
  }
}

TEST(PngWrite, GivesTheSameBytesAgain) {
  const PngTexts texts = {{"Commit", "0123abc"}};
  EXPECT_EQ(to_png(pattern(true), texts), to_png(pattern(true), texts));
}

TEST(BitmapFont, LettersDifferAndStayInTheirPlace) {
  const TextStyle style{.height = 14, .bold = false, .colour = {0, 0, 0}};
  std::set<std::string> seen;
  for (char c = ' '; c <= '~'; ++c) {
    Image image(40, 40, {255, 255, 255});
    draw_text(image, 10, 24, std::string(1, c), style);
    std::string ink;
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) {
        ink.push_back(static_cast<char>(image.at(x, y).r));
        // A capital is 14 px high and 10 wide; the stroke's half may stand out.
        const bool room = x >= 9 && x <= 20 && y >= 9 && y <= 29;
        EXPECT_TRUE(room || image.at(x, y).r == 255) << c << " at " << x << ", " << y;
      }
    }
    EXPECT_TRUE(seen.insert(ink).second) << c << " looks like another";
    EXPECT_EQ(c == ' ', std::all_of(ink.begin(), ink.end(),
                                    [](char v) { return v == static_cast<char>(255); }));
  }
}

TEST(BitmapFont, ALetterBeyondAsciiIsOneMark) {
  const TextStyle style;
  EXPECT_EQ(text_width("H\xc3\xa4schen", style), text_width("H?schen", style));
}

TEST(BitmapFont, CutsWhatDoesNotFit) {
  const TextStyle style;
  EXPECT_EQ(text_that_fits("short", style, 1000), "short");
  const std::string cut = text_that_fits("a scene with a very long name", style, 200);
  EXPECT_TRUE(cut.ends_with(".."));
  EXPECT_LE(text_width(cut, style), 200);
  EXPECT_EQ(text_that_fits("abc", style, 0), "..");
}

TEST(BitmapFont, TextOutsideTheImageIsCutOff) {
  Image image(10, 10, {255, 255, 255});
  draw_text(image, -30, 5, "wide text", {.height = 20});
  draw_text(image, 5, 300, "below", {});
  SUCCEED();
}

}  // namespace
}  // namespace farcull
