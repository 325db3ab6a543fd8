// Draws pictures of scenes: coloured triangles in an orthographic view, antialiased. Culling does
// not use these pictures, and no guarantee depends on them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/gl/base/context.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0;
  std::uint8_t a = 255;  // covered part of the pixel, 0 to 255; r, g, b are not premultiplied
  bool operator==(const Rgba&) const = default;
};

/// An image: width * height pixels. Rows go from top to bottom, pixels from left to right.
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

/// Mixes the colour into an opaque pixel. part: the colour's share, 0 to 1.
inline void blend(Rgba& pixel, const Rgba& colour, double part) {
  const auto mix = [part](std::uint8_t below, std::uint8_t above) {
    return static_cast<std::uint8_t>(below + (above - below) * part + 0.5);
  };
  pixel = {mix(pixel.r, colour.r), mix(pixel.g, colour.g), mix(pixel.b, colour.b), 255};
}

struct PictureTriangle {
  std::uint32_t triangle = 0;
  Rgba colour;         // drawn opaque; its `a` is ignored
  bool shaded = true;  // Lambert shading on both sides, plus ambient light; false: plain colour
  float outline = 0;   // width (px) of strips along the edges, so that even a degenerate
                       // triangle covers a disc of this diameter
  float lift = 0;      // px by which the triangle is moved towards the eye
};

/// Largest width and height (px). Every OpenGL 4.3 device can draw this size with samples = 4.
constexpr int kMostPicture = 4096;

/// Returns a window of width x height pixels (each even, 2 to kMostPicture) that shows the boxes in
/// this view. margin: border on each side, as a fraction of the picture (< 1/2). The origin is near
/// the boxes, so that scenes far from the world's origin are drawn accurately. Throws Error naming
/// the scene if its extent is too large for pixel coordinates in double.
Window picture_window(const View& view, std::span<const Box> boxes, int width, int height,
                      double margin, const std::string& scene_name);

/// Draws the triangles inside the window's width and height, at any depth. In the image, the first
/// row of window.view points right and the second row points up. A smaller depth is nearer. Alpha
/// is the covered part of a pixel. A triangle with a large rounding error (not Patch::drawable() in
/// core/view/view.h) is left out. Memory does not grow with the number of triangles. Each pixel is
/// the mean of samples x samples texels. Throws Error if the device refuses the size or reports an
/// error.
Image draw_picture(const GlContext& context, const Scene& scene, const Window& window,
                   std::span<const PictureTriangle> triangles, int samples = 3);

}  // namespace farcull
