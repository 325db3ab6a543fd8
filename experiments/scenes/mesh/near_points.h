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

/// For maps of positions. Equal positions need equal bits: add 0.0, which makes -0.0 0.0.
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

  /// The number of the nearest point that is kept, if it is at most the tolerance away (in double);
  /// of equally near ones the lowest. Else the point is kept, with the number `own`.
  std::uint32_t number(const Vec3& p, std::uint32_t own);

 private:
  using Cell = std::array<double, 3>;
  Cell cell_of(const Vec3& p) const;

  double tolerance_;
  std::unordered_map<Cell, std::vector<std::pair<Vec3, std::uint32_t>>, PositionHash> cells_;
};

struct WeldHint {
  std::uint64_t open_edges = 0;  // edges that belong to an odd number of triangles
  double tolerance = 0;          // of the diagonal; merging corners so far apart closes it
  Vec3 place;                    // the end of an open edge
};
/// If the object has open edges, and merging their ends within some power of 10, from 1e-13 to 1e-5
/// of the object's size, would leave none: the least such tolerance.
std::optional<WeldHint> weld_hint(const Scene& scene, const Object& object);

}  // namespace farcull
