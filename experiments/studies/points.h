// The points that several studies put into their grids, each measured once unless `repeat` is set.
#pragma once

#include <string>
#include <utility>

#include "experiments/studies/point.h"

namespace farcull {

/// FAR at a resolution, with fragment depth in 32 bits. offset: obb or exact.
inline RunPoint far_point(PointScene scene, const std::string& offset, const RadiusRule& radius,
                          int resolution) {
  return {.scene = std::move(scene),
          .method = Method::far,
          .offset = offset,
          .radius = radius,
          .depth_mode = DepthMode::fragment,
          .depth_format = DepthFormat::float32,
          .resolution = resolution};
}

/// A method of the CULLIDE family at a resolution, with the depth of the rasterizer in 32 bits.
inline RunPoint cullide_point(PointScene scene, Method method, int resolution) {
  return {.scene = std::move(scene),
          .method = method,
          .depth_mode = DepthMode::fixed,
          .depth_format = DepthFormat::float32,
          .resolution = resolution};
}

/// A method that draws no sets: far-pairs (resolution 0: chosen by the scene), i-collide, exact.
inline RunPoint plain_point(PointScene scene, Method method, int resolution = 0) {
  return {.scene = std::move(scene), .method = method, .resolution = resolution};
}

inline constexpr RadiusRule kBudgetRadius = {};
inline constexpr RadiusRule kPublishedRadius = {.published = true};

/// The same point, measured so often.
template <class OfPoint>
OfPoint repeated(OfPoint point, int repeat) {
  point.repeat = repeat;
  return point;
}

}  // namespace farcull
