// The points that several studies put into their grids, each measured once unless `repeat` is set.
#pragma once

#include <string>
#include <utility>
#include <vector>

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

/// The same in a form, which the options of RunPoint say.
struct CullideForm {
  int rounds = 0;
  ClearRule clear = ClearRule::any;
  bool objects_alone = false;
  bool conservative = false;
  std::string views = {};
};
inline RunPoint in_form(RunPoint point, const CullideForm& form) {
  point.rounds = form.rounds;
  point.clear = form.clear;
  point.objects_alone = form.objects_alone;
  point.conservative = form.conservative;
  point.views = form.views;
  return point;
}
/// CULLIDE as published: one round.
inline const CullideForm kPublishedForm = {.rounds = 1};
inline constexpr const char* kBothDirections = "x,-x,y,-y,z,-z";

/// The same at the least resolution at which triangles cover so many pixels on average.
inline RunPoint at_mean_pixels(RunPoint point, double pixels) {
  point.resolution = 0;
  point.mean_pixels = pixels;
  return point;
}

/// The five seeds that scenes which are drawn at random are measured with: their own, and 101 to
/// 104. With `count` fewer.
inline std::vector<std::string> drawn_scenes(const std::string& name, int count = 5) {
  std::vector<std::string> out = {name};
  for (int i = 1; i < count; ++i) out.push_back(name + "@seed" + std::to_string(100 + i));
  return out;
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
