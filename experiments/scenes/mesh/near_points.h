// Points that nearly coincide, and the hint that merging such corners would close a mesh.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/scene/scene.h"

namespace farcull {

/// For maps of positions. Equal positions must have equal bits: add 0.0, which turns -0.0 into 0.0.
struct PositionHash {
  std::size_t operator()(const std::array<double, 3>& at) const {
    std::uint64_t hash = 0;
    for (const double x : at) {
      // The high bits of a double vary most.
      hash = (std::rotl(hash, 21) ^ std::bit_cast<std::uint64_t>(x)) * kGolden;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// Numbers points so that near points share a number.
class NearPoints {
 public:
  /// tolerance: finite, >= 0.
  explicit NearPoints(double tolerance) : tolerance_(tolerance) {}

  /// Returns the number of the nearest kept point if it is at most the tolerance away (in double);
  /// of equally near ones, the lowest number. Otherwise keeps p as number `own`.
  std::uint32_t number(const Vec3& p, std::uint32_t own);

 private:
  using Cell = std::array<double, 3>;
  Cell cell_of(const Vec3& p) const;

  double tolerance_;
  std::unordered_map<Cell, std::vector<std::pair<Vec3, std::uint32_t>>, PositionHash> cells_;
};

struct WeldHint {
  std::uint64_t open_edges = 0;  // edges that belong to an odd number of triangles
  double tolerance = 0;          // part of the diagonal; merging corners this near closes the mesh
  Vec3 place;                    // the end of an open edge
};
/// The least tolerance among 1e-13, 1e-12, .. 1e-5 of the object's size at which merging the ends
/// of its open edges would leave none open. Empty if there is none, or no open edge.
std::optional<WeldHint> weld_hint(const Scene& scene, const Object& object);

}  // namespace farcull
