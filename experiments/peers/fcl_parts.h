// The hierarchy of an object in FCL, for all peers from FCL.
#pragma once

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace farcull {

constexpr const char* kFclLibrary = "FCL " FCL_VERSION;

/// The hierarchy of one object; its primitive i is triangle first + i.
template <class Volume>
struct FclModel {
  std::shared_ptr<fcl::BVHModel<Volume>> hierarchy;
  std::uint32_t first = 0;
};

/// Coordinates are rounded to the scalar of the volume, each by itself and to the nearest. The
/// object has triangles. Throws Error where FCL builds nothing.
template <class Volume>
FclModel<Volume> fcl_model(const Scene& scene, const Object& object) {
  using Scalar = typename Volume::S;
  const auto triangles =
      std::span(scene.triangles).subspan(object.first_triangle, object.triangle_count);
  // Objects mostly own a range of the vertices.
  std::uint32_t least = triangles[0][0], most = least;
  for (const auto& triangle : triangles) {
    for (const std::uint32_t v : triangle) {
      least = std::min(least, v);
      most = std::max(most, v);
    }
  }
  std::vector<fcl::Vector3<Scalar>> points;
  points.reserve(most - least + 1);
  for (std::uint32_t v = least; v <= most; ++v) {
    points.push_back(scene.vertices[v].template cast<Scalar>());
  }
  std::vector<fcl::Triangle> faces;
  faces.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) faces.emplace_back(a - least, b - least, c - least);
  FclModel<Volume> model{std::make_shared<fcl::BVHModel<Volume>>(), object.first_triangle};
  const auto count = static_cast<int>(faces.size());
  if (model.hierarchy->beginModel(count, static_cast<int>(points.size())) != fcl::BVH_OK ||
      model.hierarchy->addSubModel(points, faces) != fcl::BVH_OK ||
      model.hierarchy->endModel() != fcl::BVH_OK) {
    throw Error(kFclLibrary, "builds no hierarchy of this object", "leave it out with --peers");
  }
  return model;
}

}  // namespace farcull
