// The points that several studies put into their grids.
#pragma once

#include <string>

#include "experiments/studies/study.h"

namespace farcull {

/// FAR at a resolution, with fragment depth in 32 bits. offset: obb or exact; radius: as --radius.
inline Point far_point(const std::string& scene, const std::string& offset,
                       const std::string& radius, int resolution) {
  return {.scene = scene,
          .method = "far",
          .offset = offset,
          .radius = radius,
          .depth_format = "float32",
          .depth_mode = "fragment",
          .resolution = resolution,
          .views = {}};
}

/// A method of the CULLIDE family at a resolution, with the depth of the rasterizer in 32 bits.
inline Point cullide_point(const std::string& scene, const std::string& method, int resolution) {
  return {.scene = scene,
          .method = method,
          .offset = {},
          .radius = {},
          .depth_format = "float32",
          .depth_mode = "fixed",
          .resolution = resolution,
          .views = {}};
}

/// What draws no sets: far-pairs (resolution 0: chosen by the scene), i-collide, exact, peers.
inline Point plain_point(const std::string& scene, const std::string& method, int resolution = 0) {
  return {.scene = scene,
          .method = method,
          .offset = {},
          .radius = {},
          .depth_format = {},
          .depth_mode = {},
          .resolution = resolution,
          .views = {}};
}

}  // namespace farcull
