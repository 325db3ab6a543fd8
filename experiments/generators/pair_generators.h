// Makes pairs of triangles and of meshes for which it is hard to decide whether they meet.
#pragma once

#include <type_traits>

#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

// Random draws of coordinates, points and pairs of triangles. Most coordinates are integers times a
// power of two, which doubles hold exactly. So triangles that touch by construction also touch as
// doubles. Sines and logarithms are not used, since their last bits differ between platforms.

class RandomDraws : public shapes::Random {
 public:
  using shapes::Random::Random;

  /// Returns true with probability 1 / `of`.
  bool chance(int of) { return below(of) == 0; }
  /// Returns an integer from lo to hi, in the common type of lo and hi. Precondition: |lo|, |hi| <=
  /// 2^52.
  template <class Low, class High>
  auto whole(Low lo, High hi) {
    using Number = std::common_type_t<Low, High>;
    const auto count = static_cast<std::uint64_t>(hi - lo) + 1;
    return static_cast<Number>(lo) + static_cast<Number>(below(count));
  }
  /// Returns a multiple of 2^-8 from lo to hi. The result has few bits, so that adding a small gap
  /// is exact. Precondition: lo and hi are multiples of 2^-8.
  double coarse(double lo, double hi) { return whole(lo * 256, hi * 256) / 256; }
  /// Returns a point whose coordinates are integers from -extent to extent.
  Vec3 whole_point(double extent) {
    const double x = whole(-extent, extent);
    const double y = whole(-extent, extent);
    const double z = whole(-extent, extent);
    return {x, y, z};
  }
  Vec3 point() { return in_cube(1); }
};

/// Two triangles, perhaps degenerate, with finite coordinates.
struct DrawnPair {
  std::array<Vec3, 3> a, b;
};
/// Calls function(p) with each corner of a, then with each corner of b.
template <class Function>
void each_corner(DrawnPair& pair, const Function& function) {
  for (std::array<Vec3, 3>* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t) function(p);
  }
}
/// Returns a triangle in the plane that u and v span at the point `at`. This point is a corner if
/// `where` is 0, on an edge if `where` is 1, and in the interior if `where` is 2.
inline std::array<Vec3, 3> with_point(int where, const Vec3& at, const Vec3& u, const Vec3& v) {
  if (where == 0) return {at, at + u, at + v};
  return {where == 1 ? Vec3(at - u) : Vec3(at - u - v), at + u, at + v};
}
/// Shuffles the corners of each triangle, and exchanges a and b in half of the calls. The
/// branches of predicates depend on the order.
void shuffle(RandomDraws& draws, DrawnPair& pair);

/// Three axes at right angles and of equal length.
struct Frame {
  std::array<Vec3, 3> axis;

  Vec3 at(double x, double y, double z) const { return axis[0] * x + axis[1] * y + axis[2] * z; }
  Vec3 at(const Vec3& p) const { return at(p.x(), p.y(), p.z()); }
};

/// Returns 3 times the rotation matrix of a quaternion with one part 0 and three parts +-1. The
/// matrix entries are +-1 or +-2, so no axis of the frame is along a coordinate axis.
Frame leaning_frame(RandomDraws& draws);
/// Returns the rounded rotation matrix of a random quaternion with integer parts from -9 to 9.
Frame turned_frame(RandomDraws& draws);

// The families of pairs and the families of meshes in a suite (docs/suite.md). Each family makes
// pairs that meet and pairs that do not meet. Most families have a parameter.

struct MadePair : DrawnPair {
  bool neighbours = false;  // true: corners at equal positions are one vertex of a mesh
};

struct PairFamily {
  std::string name;
  std::string description;     // one line
  std::string parameter;       // what the parameter means; "" if there is none
  std::vector<double> values;  // values of the parameter; pairs use them in turn
  MadePair (*make)(RandomDraws& draws, double parameter);
};

const std::vector<PairFamily>& pair_families();

/// Returns the seed for one item of a suite. seed: the seed of the suite.
std::uint64_t seed_of_item(std::uint64_t seed, std::string_view name, std::uint64_t number);

struct SuiteObject {
  std::vector<Vec3> vertices;                           // coordinates are finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices; not empty

  void add(std::uint32_t i, std::uint32_t j, std::uint32_t k) { triangles.push_back({i, j, k}); }
};

/// Meshes of one kind: practical meshes such as scans or cloth, or hard cases such as folds.
struct MeshFamily {
  std::string name;
  bool self = false;  // true: each object is also tested against itself
  /// Makes the objects. detail: fineness of the meshes, in a unit that depends on the family.
  std::vector<SuiteObject> (*make)(RandomDraws& draws, double parameter, int detail);
  struct Member {
    double parameter = 0;  // parameter of the family (docs/suite.md)
    int detail = 0;
  };
  std::vector<Member> members;
  std::size_t small = 0;  // a small suite has only the first `small` members
  bool motion = false;    // true: the members are frames of one motion
};

/// Returns the families, sorted by name.
const std::vector<MeshFamily>& mesh_families();

/// Returns the objects of member `index` of a family. The objects depend only on the arguments. All
/// frames of a motion are made with the same draws. If MeshFamily::self is true, no two vertices of
/// an object have the same position.
std::vector<SuiteObject> make_suite_mesh(const MeshFamily& family, std::uint64_t seed,
                                         std::size_t index);

}  // namespace farcull
