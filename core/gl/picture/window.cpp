// Computes the window of a picture. This needs no GL device.
#include <algorithm>
#include <stdexcept>

#include "core/base/error.h"
#include "core/gl/picture/picture.h"

namespace farcull {

Window picture_window(const View& view, std::span<const Box> boxes, int width, int height,
                      double margin, const std::string& scene_name) {
  if (width < 2 || height < 2 || width % 2 != 0 || height % 2 != 0 || margin < 0 || margin >= 0.5)
    throw std::logic_error("picture_window: the size is odd, or the margin leaves no room");
  Box world = Box::empty();
  for (const Box& box : boxes) world.add(box);
  Window out{.view = view,
             .origin = 0.5 * world.lo + 0.5 * world.hi,
             .map = view.rows,
             .pixel_size = 1,
             .width = width,
             .height = height,
             .lo = {},
             .hi = {}};
  const auto pixels_of_boxes = [&] {
    Box pixels = Box::empty();
    for (const Box& box : boxes) {
      if (!box.is_empty()) pixels.add(pixel_box(out, box));
    }
    return pixels;
  };
  // Moves the origin to the middle of the image. The middle of the boxes may be elsewhere.
  Box image = pixels_of_boxes();
  out.origin += view.rows.transpose() * (0.5 * image.lo + 0.5 * image.hi);
  image = pixels_of_boxes();
  const double magnitude = std::max(world.lo.cwiseAbs().maxCoeff(), world.hi.cwiseAbs().maxCoeff());
  const Vec3 size = image.hi - image.lo;
  const double room = 1 - 2 * margin;
  out.pixel_size = std::max(
      {size[0] / (room * width), size[1] / (room * height), 0x1p-45 * magnitude, 0x1p-960});
  out.map = view.rows / out.pixel_size;
  const Box pixels = pixels_of_boxes();
  out.lo = pixels.lo.array() - 1;
  out.hi = pixels.hi.array() + 1;
  if (!out.map.allFinite() || !out.lo.allFinite() || !out.hi.allFinite()) {
    throw Error(scene_name, "its extent is beyond what a picture in doubles can show",
                "scale it to coordinates below 1e300");
  }
  return out;
}

}  // namespace farcull
