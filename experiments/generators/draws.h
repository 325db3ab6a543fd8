// Random draws of whole coordinates, points and pairs of triangles. Whole numbers times a power of
// two are exact, so contact that is made with them is contact of the doubles that are written.
// Nothing here uses sines or logarithms, whose last bits differ between platforms.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "core/base/random.h"
#include "core/scene/scene.h"

namespace farcull {

class RandomDraws : public RandomNumbers {
 public:
  using RandomNumbers::RandomNumbers;

  bool chance(int of) { return below(of) == 0; }
  /// lo .. hi, both included, a whole number of their type; |lo|, |hi| <= 2^52.
  template <class Low, class High>
  auto whole(Low lo, High hi) {
    using Number = std::common_type_t<Low, High>;
    const auto count = static_cast<std::uint64_t>(hi - lo) + 1;
    return static_cast<Number>(lo) + static_cast<Number>(below(count));
  }
  /// A multiple of 2^-8 in lo .. hi, which are such too: few bits, so that a small gap fits beside
  /// it in a double.
  double coarse(double lo, double hi) { return whole(lo * 256, hi * 256) / 256; }
  /// Whole coordinates in -extent .. extent.
  Vec3 whole_point(double extent) {
    const double x = whole(-extent, extent);
    const double y = whole(-extent, extent);
    const double z = whole(-extent, extent);
    return {x, y, z};
  }
  /// In the cube [-1, 1]^3.
  Vec3 point() {
    const double x = between(-1, 1);
    const double y = between(-1, 1);
    const double z = between(-1, 1);
    return {x, y, z};
  }
};

/// Two triangles with finite coordinates; either may be degenerate. Nothing is decided about them.
struct DrawnPair {
  std::array<Vec3, 3> a, b;
};
/// Brings the corners of each into any order, and a and b: predicates branch on both.
void shuffle(RandomDraws& draws, DrawnPair& pair);

/// Three axes at right angles and of equal length.
struct Frame {
  std::array<Vec3, 3> axis;

  Vec3 at(double x, double y, double z) const { return axis[0] * x + axis[1] * y + axis[2] * z; }
  Vec3 at(const Vec3& p) const { return at(p.x(), p.y(), p.z()); }
};

/// The axes of the coordinates, in any order and direction.
Frame straight_frame(RandomDraws& draws);
/// A rotation times a whole number, with whole entries of at most 4: of a quaternion with parts
/// from -1 to 1. Not straight.
Frame leaning_frame(RandomDraws& draws);
/// A rotation whose entries are rounded: of a quaternion with parts from -9 to 9.
Frame turned_frame(RandomDraws& draws);

}  // namespace farcull
