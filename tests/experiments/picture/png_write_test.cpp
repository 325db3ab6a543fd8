// PNG there and back, and the lettering.
#include "experiments/picture/panel.h"

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

TEST(Lettering, LettersDifferAndStandOnTheBaseline) {
  const TextStyle style{.height = 14, .bold = false, .colour = {0, 0, 0}};
  std::set<std::string> seen;
  for (char c = ' '; c <= '~'; ++c) {
    Image image(50, 40, {255, 255, 255});
    draw_text(image, 10, 24, std::string(1, c), style);
    std::string ink;
    for (const Rgba& pixel : image.pixels) ink.push_back(static_cast<char>(pixel.r));
    EXPECT_TRUE(seen.insert(ink).second) << c << " looks like another";
    EXPECT_EQ(c == ' ',
              std::ranges::all_of(ink, [](char v) { return v == static_cast<char>(255); }));
  }
  // A capital is as high as the style says: rows 10 to 23, and nothing above or below them.
  Image image(50, 40, {255, 255, 255});
  draw_text(image, 10, 24, "H", style);
  for (int y = 0; y < 40; ++y) {
    bool ink = false;
    for (int x = 0; x < 50; ++x) ink = ink || image.at(x, y).r < 128;
    EXPECT_EQ(ink, y >= 10 && y <= 23) << y;
  }
}

TEST(Lettering, BoldHasMoreInkAndColourIsThatOfTheStyle) {
  const auto ink = [](bool bold) {
    Image image(120, 40, {255, 255, 255});
    draw_text(image, 5, 24, "missed", {.height = 14, .bold = bold, .colour = {255, 0, 0}});
    int out = 0;
    for (const Rgba& pixel : image.pixels) {
      EXPECT_EQ(pixel.r, 255);
      EXPECT_EQ(pixel.g, pixel.b);
      out += 255 - pixel.g;
    }
    return out;
  };
  EXPECT_GT(ink(true), ink(false));
  EXPECT_GT(ink(false), 0);
}

TEST(Lettering, IsTheSameInEveryRunAndSaysWhatItDependsOn) {
  const auto drawn = [] {
    Image image(200, 40, {255, 255, 255});
    draw_text(image, 5.25, 24.5, "FAR missed 0 of 3,857", {});
    return image.pixels;
  };
  EXPECT_EQ(drawn(), drawn());
  EXPECT_TRUE(lettering_version().starts_with("DejaVu Sans 2.")) << lettering_version();
  EXPECT_TRUE(has_text(lettering_version(), "FreeType 2."));
}

TEST(Lettering, ReadsUtf8AndMarksWhatIsNone) {
  const TextStyle style;
  EXPECT_EQ(text_width("\xc3\xa4", style), text_width("a", style)) << "an umlaut is one letter";
  EXPECT_EQ(text_width("H\xff!", style), text_width("H?!", style));
  EXPECT_EQ(text_width("\xc3", style), text_width("?", style)) << "cut in the middle of a letter";
  // A letter that the font lacks (of the private area).
  EXPECT_EQ(text_width("\xf3\xb0\x80\x80", style), text_width("?", style));
}

TEST(Lettering, CutsWhatDoesNotFit) {
  const TextStyle style;
  EXPECT_EQ(text_that_fits("short", style, 1000), "short");
  const std::string cut = text_that_fits("a scene with a very l\xc3\xb6ng name", style, 200);
  EXPECT_TRUE(cut.ends_with("\xe2\x80\xa6"));
  EXPECT_LE(text_width(cut, style), 200);
  // No half letters: all of them have a width of their own.
  for (int width = 20; width < 260; ++width) {
    const std::string part = text_that_fits(
        "\xc3\xb6\xc3\xb6\xc3\xb6\xc3\xb6\xc3\xb6\xc3\xb6 \xc3\xb6\xc3\xb6", style, width);
    EXPECT_EQ(part.find('?'), std::string::npos);
    EXPECT_EQ((part.size() - part.ends_with("\xe2\x80\xa6") * 3) % 2,
              static_cast<std::size_t>(std::ranges::count(part, ' ')))
        << part;
  }
  EXPECT_EQ(text_that_fits("abc", style, 0), "\xe2\x80\xa6");
}

TEST(Lettering, TextOutsideTheImageIsCutOff) {
  Image image(10, 10, {255, 255, 255});
  draw_text(image, -30, 5, "wide text", {.height = 20});
  draw_text(image, 5, 300, "below", {});
  SUCCEED();
}

}  // namespace
}  // namespace farcull
