// A picture in memory: core/gl/picture/picture.h draws it, experiments compose and write it.
#pragma once

#include <cstdint>
#include <vector>

namespace farcull {

struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0;
  std::uint8_t a = 255;  // 0: nothing is here; colours are not multiplied by it
  bool operator==(const Rgba&) const = default;
};

/// Rows from the top, each from the left; width * height pixels.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgba> pixels;

  Image() = default;
  Image(int w, int h, Rgba fill)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}

  Rgba& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const Rgba& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

/// Mixes `part` (0 to 1) of the colour into a pixel that is opaque.
inline void blend(Rgba& pixel, const Rgba& colour, double part) {
  const auto mix = [part](std::uint8_t below, std::uint8_t above) {
    return static_cast<std::uint8_t>(below + (above - below) * part + 0.5);
  };
  pixel = {mix(pixel.r, colour.r), mix(pixel.g, colour.g), mix(pixel.b, colour.b), 255};
}

}  // namespace farcull
