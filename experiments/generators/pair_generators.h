// Makes pairs of triangles and meshes that are hard to decide: random draws, and the families of a
// suite.
#pragma once

#include <type_traits>

#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

// Random draws of whole coordinates, points and pairs of triangles. Whole numbers times a power of
// two are exact doubles, so triangles made of them that touch still touch when written as doubles.
// Nothing here uses sines or logarithms, whose last bits differ between platforms.

class RandomDraws : public shapes::Random {
 public:
  using shapes::Random::Random;

  /// True one time in `of`.
  bool chance(int of) { return below(of) == 0; }
  /// A whole number in lo .. hi, both included, of their type. Precondition: |lo|, |hi| <= 2^52.
  template <class Low, class High>
  auto whole(Low lo, High hi) {
    using Number = std::common_type_t<Low, High>;
    const auto count = static_cast<std::uint64_t>(hi - lo) + 1;
    return static_cast<Number>(lo) + static_cast<Number>(below(count));
  }
  /// A multiple of 2^-8 in lo .. hi, which must be such multiples too. It has few bits, so that a
  /// small gap can be added exactly in a double.
  double coarse(double lo, double hi) { return whole(lo * 256, hi * 256) / 256; }
  /// Whole coordinates in -extent .. extent.
  Vec3 whole_point(double extent) {
    const double x = whole(-extent, extent);
    const double y = whole(-extent, extent);
    const double z = whole(-extent, extent);
    return {x, y, z};
  }
  /// A point in the cube [-1, 1]^3.
  Vec3 point() { return in_cube(1); }
};

/// Two triangles with finite coordinates; either may be degenerate. Nothing is decided about them.
struct DrawnPair {
  std::array<Vec3, 3> a, b;
};
/// Calls function(p) with each corner, first those of a.
template <class Function>
void each_corner(DrawnPair& pair, const Function& function) {
  for (std::array<Vec3, 3>* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t) function(p);
  }
}
/// A triangle along u and v that has the point `at` as a corner, on an edge or in its inside;
/// where: 0, 1 or 2.
inline std::array<Vec3, 3> with_point(int where, const Vec3& at, const Vec3& u, const Vec3& v) {
  if (where == 0) return {at, at + u, at + v};
  return {where == 1 ? Vec3(at - u) : Vec3(at - u - v), at + u, at + v};
}
/// Shuffles the corners of each triangle, and exchanges a and b half of the time, since predicates
/// branch on their order.
void shuffle(RandomDraws& draws, DrawnPair& pair);

/// Three axes at right angles and of equal length.
struct Frame {
  std::array<Vec3, 3> axis;

  Vec3 at(double x, double y, double z) const { return axis[0] * x + axis[1] * y + axis[2] * z; }
  Vec3 at(const Vec3& p) const { return at(p.x(), p.y(), p.z()); }
};

/// The rotation of a quaternion with parts -1, 0 and 1, times 3: its entries are 1, 2, -1 or -2. No
/// axis is along an axis of the coordinates.
Frame leaning_frame(RandomDraws& draws);
/// The rotation of a quaternion with whole parts from -9 to 9; its entries are rounded.
Frame turned_frame(RandomDraws& draws);

// The families of a suite (docs/suite.md), of pairs and of meshes. Each makes pairs that meet and
// pairs that do not. Most have a parameter: a number that goes to an extreme.

struct MadePair : DrawnPair {
  bool neighbours = false;  // corners at equal positions are one vertex of a mesh
};

struct PairFamily {
  std::string name;
  std::string description;     // one line
  std::string parameter;       // what the parameter means; "" for none
  std::vector<double> values;  // values of the parameter; pairs take them in turn
  MadePair (*make)(RandomDraws& draws, double parameter);
};

const std::vector<PairFamily>& pair_families();

/// A seed for one item of a suite, from the seed of the suite, a name and a number.
std::uint64_t seed_of_item(std::uint64_t seed, std::string_view name, std::uint64_t number);

/// An object of a mesh.
struct SuiteObject {
  std::vector<Vec3> vertices;                           // finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices; at least one

  void add(std::uint32_t i, std::uint32_t j, std::uint32_t k) { triangles.push_back({i, j, k}); }
};

/// Kinds of meshes that people have (scans, cloth, ropes, plates), or that are hard (shells, folds,
/// fans, duplicates).
struct MeshFamily {
  std::string name;
  bool self = false;  // the objects are tested against themselves too
  /// Makes the objects. detail: how fine they are, in a unit that each family chooses.
  std::vector<SuiteObject> (*make)(RandomDraws& draws, double parameter, int detail);
  struct Member {
    double parameter = 0;  // docs/suite.md says of each family what it is
    int detail = 0;
  };
  std::vector<Member> members;
  std::size_t small = 0;  // a small suite has this many of the first members
  bool motion = false;    // the members are frames: the same triangles, but vertices move
};

/// In the order of the names.
const std::vector<MeshFamily>& mesh_families();

/// The objects of member `index` of a family. They depend only on the family, the seed and the
/// index; all frames of a motion are made with the same draws. In a mesh that is tested against
/// itself, vertices at one position are one vertex.
std::vector<SuiteObject> make_suite_mesh(const MeshFamily& family, std::uint64_t seed,
                                         std::size_t index);

}  // namespace farcull
