// Pictures of scenes for people: triangles in colours, seen orthographically, the nearest in front,
// antialiased. Nothing here takes part in culling, and no guarantee rests on it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/gl/base/context.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

// ---- a picture in memory: draw_picture() makes it, experiments compose and write it ----

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

// ---- pictures of scenes ----

/// A triangle of the scene and how it is drawn.
struct PictureTriangle {
  std::uint32_t triangle = 0;
  Rgba colour;         // drawn opaque; its `a` is ignored
  bool shaded = true;  // Lambert on both sides, and ambient light; false: the colour as it is
  float outline = 0;   // px: its edges are drawn as strips that wide, so that it covers a disc of
                       // this diameter, however small, narrow or degenerate it is
  float lift = 0;      // px that it is moved towards the eye, in front of what it touches
};

struct PictureSettings {
  int samples = 3;  // along each side of a pixel, which is the mean of samples^2 of them
};

/// Largest width and height of a picture, px. OpenGL 4.3 allows it with 4 samples.
constexpr int kMostPicture = 4096;

/// The window that looks along the view and holds the boxes with `margin` (a part of its size, <
/// 1/2) around them, in a picture of that many pixels (each even, 2 to kMostPicture). The origin is
/// inside the boxes, so a scene far from the world's origin is drawn as sharply as one near it.
/// Throws Error naming the scene where doubles cannot distinguish its pixels.
Window picture_window(const View& view, std::span<const Box> boxes, int width, int height,
                      double margin, const std::string& scene_name);

/// Draws the triangles inside the window's width and height, of whatever depth. Image x is right
/// along window.view's first row, image up is its second, and a smaller depth is nearer. Where no
/// triangle is, alpha is 0; at an edge it is the covered part. Triangles that pixel space cannot
/// resolve (clip.h) are left out. Memory does not grow with their number. Throws Error where the
/// device refuses the size or reports an error.
Image draw_picture(const GlContext& context, const Scene& scene, const Window& window,
                   std::span<const PictureTriangle> triangles,
                   const PictureSettings& settings = {});

}  // namespace farcull
