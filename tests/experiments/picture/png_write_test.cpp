// PNG there and back, and the lettering.
#include "experiments/picture/panel.h"

#include "tests/experiments/picture/png_read.h"

namespace farcull {
namespace {

Image pattern() {
  Image image(37, 11, {});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(7 * x), static_cast<std::uint8_t>(23 * y),
                        static_cast<std::uint8_t>(x * y)};
    }
  }
  return image;
}

TEST(PngWrite, ReadsBackPixelsAndTexts) {
  const PngTexts texts = {{"Commit", "0123abc"}, {"Scene", "zwei H\xc3\xa4schen"}, {"Command", ""}};
  const Image image = pattern();
  const PngContent back = png_content(to_png(image, texts));
  EXPECT_EQ(back.image.width, image.width);
  EXPECT_EQ(back.image.height, image.height);
  EXPECT_EQ(back.image.pixels, image.pixels);
  EXPECT_EQ(back.texts, texts);
}

TEST(PngWrite, GivesTheSameBytesAgain) {
  const PngTexts texts = {{"Commit", "0123abc"}};
  EXPECT_EQ(to_png(pattern(), texts), to_png(pattern(), texts));
}

TEST(Lettering, LettersDifferAndStandOnTheBaseline) {
  const TextStyle style{.height = 14, .bold = false, .colour = {0, 0, 0}};
  std::set<std::string> seen;
  for (char c = ' '; c <= '~'; ++c) {
    Image image(50, 40, {255, 255, 255});
    draw_text(image, 10, 24, std::string(1, c), style, 50);
    std::string ink;
    for (const Rgba& pixel : image.pixels) ink.push_back(static_cast<char>(pixel.r));
    EXPECT_TRUE(seen.insert(ink).second) << c << " looks like another";
    EXPECT_EQ(c == ' ',
              std::ranges::all_of(ink, [](char v) { return v == static_cast<char>(255); }));
  }
  // A capital is as high as the style says: rows 10 to 23, and nothing above or below them.
  Image image(50, 40, {255, 255, 255});
  draw_text(image, 10, 24, "H", style, 50);
  for (int y = 0; y < 40; ++y) {
    bool ink = false;
    for (int x = 0; x < 50; ++x) ink = ink || image.at(x, y).r < 128;
    EXPECT_EQ(ink, y >= 10 && y <= 23) << y;
  }
}

TEST(Lettering, BoldHasMoreInkAndColourIsThatOfTheStyle) {
  const auto ink = [](bool bold) {
    Image image(120, 40, {255, 255, 255});
    draw_text(image, 5, 24, "missed", {.height = 14, .bold = bold, .colour = {255, 0, 0}}, 120);
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
    draw_text(image, 5.25, 24.5, "FAR missed 0 of 3,857", {}, 200);
    return image.pixels;
  };
  EXPECT_EQ(drawn(), drawn());
  EXPECT_TRUE(lettering_version().starts_with("DejaVu Sans, pango 1.")) << lettering_version();
  EXPECT_TRUE(has_text(lettering_version(), ", cairo 1."));
}

// The pixels of a text in a usual style.
std::vector<Rgba> drawn(const std::string& text, double room = 300) {
  Image image(300, 40, {255, 255, 255});
  draw_text(image, 5, 24, text, {}, room);
  return image.pixels;
}

TEST(Lettering, ReadsUtf8AndMarksWhatIsNone) {
  EXPECT_NE(drawn("\xc3\xa4"), drawn("a"));
  EXPECT_EQ(drawn("H\xff!"), drawn("H\xef\xbf\xbd!"));
  EXPECT_EQ(drawn("\xc3"), drawn("\xef\xbf\xbd")) << "cut in the middle of a letter";
}

TEST(Lettering, CutsWhatDoesNotFit) {
  EXPECT_EQ(drawn("short", 100), drawn("short"));
  const std::string name = "a scene with a very l\xc3\xb6ng name";
  EXPECT_NE(drawn(name, 200), drawn(name));
  const std::vector<Rgba> cut = drawn(name, 200);
  for (std::size_t i = 0; i < cut.size(); ++i) {
    if (i % 300 > 206) {
      EXPECT_EQ(cut[i].r, 255) << "ink right of the room";
    }
  }
  EXPECT_EQ(drawn("abc", 0), drawn("\xe2\x80\xa6", 0));
}

TEST(Lettering, TextOutsideTheImageIsCutOff) {
  Image image(10, 10, {255, 255, 255});
  draw_text(image, -30, 5, "wide text", {.height = 20}, 10);
  draw_text(image, 5, 300, "below", {}, 10);
  SUCCEED();
}

}  // namespace
}  // namespace farcull
