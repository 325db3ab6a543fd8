// Passes matrices of Eigen to the library. Each row of V (n x 3) is a vertex. Each row of F (m x 3)
// is a triangle. V has numbers that fit into a double. F has integers. Any storage order works.
// Needs Eigen 3: link Eigen3::Eigen.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "experiments/library/farcull.h"

namespace farcull {

/// Copies matrices. Converts implicitly to an Input, which is valid while the EigenInput lives.
///
///   collider.find(farcull::EigenInput(V, F, object_starts));
class EigenInput {
 public:
  /// Throws Error if a matrix does not have three columns. object_starts: as Input::object_starts.
  template <class Vertices, class Triangles>
  EigenInput(const Eigen::MatrixBase<Vertices>& V, const Eigen::MatrixBase<Triangles>& F,
             std::vector<std::uint32_t> object_starts = {}, std::vector<Pose> poses = {})
      : starts_(std::move(object_starts)), poses_(std::move(poses)) {
    static_assert(std::is_integral_v<typename Triangles::Scalar>, "triangles are whole numbers");
    static_assert(std::numeric_limits<typename Vertices::Scalar>::digits <= 53,
                  "vertices are numbers that a double holds");
    if (V.cols() != 3 || F.cols() != 3) {
      throw Error(V.cols() != 3 ? "vertices" : "triangles",
                  "have " + std::to_string(V.cols() != 3 ? V.cols() : F.cols()) + " columns",
                  "give a matrix with three columns");
    }
    vertices_ = V.template cast<double>();
    triangles_ = F.template cast<std::int64_t>();
  }

  operator Input() const {
    return {.vertices = {vertices_.data(), static_cast<std::size_t>(vertices_.size())},
            .triangles = {},
            .object_starts = starts_,
            .wide_triangles = {triangles_.data(), static_cast<std::size_t>(triangles_.size())},
            .poses = poses_};
  }

 private:
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> vertices_;
  Eigen::Matrix<std::int64_t, Eigen::Dynamic, 3, Eigen::RowMajor> triangles_;
  std::vector<std::uint32_t> starts_;
  std::vector<Pose> poses_;
};

/// Calls collide() with matrices of Eigen.
template <class Vertices, class Triangles>
Result collide(const Eigen::MatrixBase<Vertices>& V, const Eigen::MatrixBase<Triangles>& F,
               std::vector<std::uint32_t> object_starts, const Options& options = {}) {
  return collide(EigenInput(V, F, std::move(object_starts)), options);
}

/// Returns the pose that moves points as the transform does. Precondition: the transform is affine.
template <int Mode>
Pose pose_of(const Eigen::Transform<double, 3, Mode>& transform) {
  Pose out;
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) out.r[static_cast<std::size_t>(3 * row + k)] = transform(row, k);
    out.t[static_cast<std::size_t>(row)] = transform(row, 3);
  }
  return out;
}

}  // namespace farcull
