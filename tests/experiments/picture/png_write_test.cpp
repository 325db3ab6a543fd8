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

// The pixels of a text in a usual style.
std::vector<Rgba> drawn(const std::string& text, double room = 300) {
  Image image(300, 40, {255, 255, 255});
  draw_text(image, 5, 24, text, {}, room);
  return image.pixels;
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

}  // namespace
}  // namespace farcull
