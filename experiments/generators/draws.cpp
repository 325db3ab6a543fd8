// Rotations come from quaternions with whole parts (Rodrigues' parameters), so that no sine is
// taken.
#include "experiments/generators/draws.h"

#include <utility>

namespace farcull {
namespace {

/// The rotation of the quaternion w + xi + yj + zk times its squared length.
Frame scaled_rotation(double w, double x, double y, double z) {
  const Vec3 first(w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y));
  const Vec3 second(2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x));
  const Vec3 third(2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z);
  return {{first, second, third}};
}

}  // namespace

void shuffle(RandomDraws& draws, DrawnPair& pair) {
  for (std::array<Vec3, 3>* t : {&pair.a, &pair.b}) {
    std::swap((*t)[0], (*t)[draws.below(3)]);
    std::swap((*t)[1], (*t)[1 + draws.below(2)]);
  }
  if (draws.chance(2)) std::swap(pair.a, pair.b);
}

Frame straight_frame(RandomDraws& draws) {
  Frame out{{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}};
  std::swap(out.axis[0], out.axis[draws.below(3)]);
  std::swap(out.axis[1], out.axis[1 + draws.below(2)]);
  for (Vec3& axis : out.axis) axis *= draws.sign();
  return out;
}

Frame leaning_frame(RandomDraws& draws) {
  const double w = draws.sign();
  const double x = draws.sign();
  const double y = draws.sign();
  // With four parts of one size the rotation only exchanges axes.
  return scaled_rotation(w, x, y, 0);
}

Frame turned_frame(RandomDraws& draws) {
  const double w = draws.whole(1, 9);
  const double x = draws.whole(-9, 9);
  const double y = draws.whole(-9, 9);
  const double z = draws.whole(-9, 9);
  Frame out = scaled_rotation(w, x, y, z);
  const double square = w * w + x * x + y * y + z * z;
  for (Vec3& axis : out.axis) axis /= square;
  return out;
}

}  // namespace farcull
