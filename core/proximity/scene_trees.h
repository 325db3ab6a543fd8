// A tree over the triangles of each object, a tree over the objects, and the search for the nearest
// triangles of two objects: branch and bound over pairs of nodes of their trees.
//
// A search pauses when it has examined as many pairs of leaves as it may. It can then continue, or
// be divided into searches that run in parallel. Its result depends only on the scene, the question
// and the hint, since no search uses the results of another one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "core/base/uninitialized.h"
#include "core/boxes/triangle_blocks.h"
#include "core/proximity/near_pairs.h"
#include "core/scene/scene.h"

namespace farcull::near {

// Rounding errors of the arithmetic that finds near pairs, and the constants that bound them.
//
// u = 2^-53. All coordinates are scaled (SceneTrees): |x| < 4, and scaling errs by at most 2^-1075.
// "Exact" means: for the given coordinates times the scale. Bounds of a distance are in these
// units.
//
// Gaps of boxes. Along an axis, the computed gap is g = fl(lo - hi) if that is positive. A
// difference does not underflow, so g <= (G + 2^-1074) (1 + u), where G < 8 is the exact gap. The
// sum of squares has at most three more roundings, and a product below 2^-1022 errs by 2^-1075. So
// the sum is at most (sum of G^2 + 2^-1069) (1 + u)^5 + 2^-1073. square_limit() computes P^2 (1 +
// 16 u) + 2^-900 with three roundings, so it returns at least P^2 (1 + 12 u) + 2^-901. If the sum
// is above that, the exact distance is above P.
//
// Gaps along a direction d, any vector with components in [-16, 16]. Points are taken relative to
// an origin: x = fl(point - origin) errs by u |x|. A dot product d.x has three products and two
// sums. With the error of x, it errs by less than 5 u |d|.|x| (absolute values per axis). The
// difference of two dot products adds a rounding of 2 u |d|.|x|. With X the largest |x| per axis,
// that is 12 u |d|.X in all. kGap is 16 u, which also covers the roundings of kGap |d|.X. The
// distance is at least the gap divided by the length of d.
//
// Points. The points p and q are weighted sums of the corners of one triangle each, relative to a
// corner of the first triangle. R is the largest |coordinate| of these corners. The computed
// weights are in [0, 1] and sum to 1 up to 4 u. Per axis, p differs from a point of its triangle by
// at most u R (1 + 4 u) (differences) + 3 u R (products and sums) + 4 u R (weights, compared with
// weights that sum to 1) < 9 u R. The same holds for q. Their difference has one rounding of 2 u R,
// so it errs by less than 20.1 u R per axis, or 35 u R in length. The computed length is below 4 R
// and errs by less than 3 u of itself, and two sums follow: 20 u R. That is 55 u R in all; kPoint
// is 64 u.
//
// Triangles that meet. An edge from p to q passes through a triangle if p and q are strictly on
// opposite sides of its plane, and the edge passes the triangle's three sides in the same sense.
// The signs of five determinants of differences of points decide both. A difference errs by u of
// itself. So each of the six products of three is within (1 + u)^8 of the exact one, with two sums.
// A determinant errs by less than 8.1 u of the sum of the products' magnitudes. kDeterminant is 16
// u, which also covers the roundings of that sum. If all signs are certain, the triangles share a
// point, and 0 is an upper bound.
//
// Underflow. A product errs by at most 2^-1075. That is lost in the rounding of a squared length
// above 2^-900 (kLeastSquare). A smaller square counts as 2^-900 in an upper bound, and gives no
// direction. All other losses by underflow are far below kAbsolute.

constexpr double kUnit = 0x1p-53;
constexpr double kPoint = 64 * kUnit;
constexpr double kGap = 16 * kUnit;
constexpr double kDeterminant = 16 * kUnit;
constexpr double kLeastSquare = 0x1p-900;
constexpr double kAbsolute = 0x1p-900;
/// Larger than the square of any gap of boxes, but finite, so that a missing box is beyond it.
constexpr double kMostSquare = 1024;

/// Boxes whose squared gap is above this are farther apart than `limit` (>= 0, may be infinite).
inline double square_limit(double limit) {
  const double square = limit * limit * (1 + 16 * kUnit) + kAbsolute;
  return square < kMostSquare ? square : kMostSquare;
}

/// Points farther apart than this along a direction are farther apart than `limit`. squared: the
/// square of the direction's length. doubt: kGap |d|.X.
inline double gap_limit(double limit, double squared, double doubt) {
  // The root is off by less than 3 u of itself.
  return limit * (std::sqrt(squared) * (1 + 8 * kUnit)) * (1 + 4 * kUnit) + doubt + kAbsolute;
}

}  // namespace farcull::near

namespace farcull {

/// The trees of a scene. Leaves are blocks of at most sixteen triangles that lie together. All
/// coordinates are multiplied by `scale`, a power of two. It brings the largest magnitude of the
/// scene into [1, 4), or below if it was less than 2^-1000, so nothing computed from scaled
/// coordinates overflows. Products with `scale` are exact, or off by at most 2^-1075 if subnormal.
/// Scaled triangles have scaled corners.
class SceneTrees {
 public:
  SceneTrees(const Scene& scene, unsigned threads, Settle settle = {});

  const Scene& scene() const { return *scene_; }
  const Settle& settle() const { return settle_; }  // may be empty
  double scale() const { return scale_; }
  const WideBoxes<double>* blocks() const { return blocks_.data(); }
  /// Its leaves are the blocks of the object, counted from 0.
  const BoxTree<double>& tree(std::uint32_t object) const { return trees_[object]; }
  /// The number of a leaf among those of all objects.
  std::uint32_t leaf(std::uint32_t object, std::uint32_t k) const { return of_.first[object] + k; }
  /// Triangles of a leaf.
  std::uint32_t count(std::uint32_t leaf) const { return of_.ranges[place_[leaf]].count; }
  std::uint32_t triangle(std::uint32_t leaf, std::uint32_t k) const {
    return of_.triangle(of_.ranges[place_[leaf]].first + k);
  }
  Vec3 corner(std::uint32_t triangle, std::size_t k) const {
    return scene_->vertices[scene_->triangles[triangle][k]] * scale_;
  }
  /// Boxes that together contain the triangles of an object: one box, or several much smaller ones
  /// if its triangles lie far apart.
  std::span<const Box> parts(std::uint32_t object) const {
    return std::span(parts_).subspan(first_part_[object],
                                     first_part_[object + 1] - first_part_[object]);
  }
  /// The lowest number of a triangle below a node of an object's tree.
  std::uint32_t least(std::uint32_t object, std::size_t height, std::uint32_t k) const {
    const BoxTree<double>& tree = trees_[object];
    if (height == static_cast<std::size_t>(tree.levels))
      return scene_->objects[object].first_triangle;
    return least_[tree.first[height] + k / kWide][k % kWide];
  }

  /// The tree over the parts of all objects. object(): the object whose part a leaf is.
  const BoxTree<double>& objects() const { return objects_; }
  std::uint32_t object(std::uint32_t leaf) const { return object_of_leaf_[leaf]; }

 private:
  void make_trees(unsigned threads);
  void find_least(std::uint32_t object);
  void add_parts(std::uint32_t object);
  void make_object_tree();

  const Scene* scene_;
  Settle settle_;
  double scale_ = 1;
  TriangleBlocks of_;
  std::vector<std::uint32_t> place_;  // per leaf: its index in of_.ranges
  std::vector<BoxTree<double>> trees_;
  std::vector<Box> parts_;
  std::vector<std::size_t> first_part_;  // of each object, and one behind the last
  BoxTree<double> objects_;
  std::vector<std::uint32_t> object_of_leaf_;
  UninitializedVector<WideBoxes<double>> blocks_;
  std::vector<std::array<std::uint32_t, kWide>> least_;  // of each box of blocks_
};

/// The corners of sixteen scaled triangles, in columns: column 3 * corner + axis.
using CornerColumns = std::array<std::array<double, kWide>, 9>;

struct alignas(64) PairBatch {
  CornerColumns a{}, b{};
  std::array<TrianglePair, kWide> pairs{};
  std::size_t count = 0;  // of pairs; the columns behind them hold any finite numbers
};

/// The distance of the exact triangles is at least `lower` and at most `upper`, in scaled units. If
/// upper is 0, they certainly meet. direction: roughly from the closest point of a to that of b.
struct alignas(64) BatchBounds {
  std::array<double, kWide> lower, upper;
  std::array<std::array<double, kWide>, 3> direction;
};

struct alignas(64) BlockCorners {
  CornerColumns corner;
  WideBoxes<double> boxes;  // of the triangles
  std::array<std::uint32_t, kWide> triangle;
  alignas(64) std::array<double, kWide> extreme;  // per triangle, along a direction: its largest
                                                  // coordinate in a, its smallest in b
  double most_extreme = 0;
  std::uint64_t direction = 0;  // the direction's number in SearchMemory
  std::uint32_t leaf = UINT32_MAX;
  std::uint32_t count = 0;
};

/// Loads the leaf with this number among those of all objects (SceneTrees::leaf()). Columns behind
/// its last triangle repeat that triangle, but have no box.
void load_leaf(const SceneTrees& trees, std::uint32_t leaf, BlockCorners& out);

/// Whether the triangles have a corner at the same position.
bool share_position(const Scene& scene, std::uint32_t a, std::uint32_t b);

/// Two nodes of trees, by height and number, and the square of the gap of their boxes.
struct NodePair {
  double square;
  std::uint32_t a, b;
  std::uint8_t a_height, b_height;
};

/// A pair of triangles that may be nearest; bounds of its distance in scaled units.
struct KeptPair {
  TrianglePair pair;
  double lower, upper;
};

/// The reach of each triangle of an object (SettledPair), and the greatest below each node.
struct Reaches {
  Reaches(const SceneTrees& trees, std::uint32_t object,
          const std::function<double(std::uint32_t)>& reach);
  std::vector<std::vector<double>> nodes;  // by height and number
  std::vector<double> triangles;           // at kWide * leaf + k
};

/// The planes of a settled pair: they prove that other pairs of triangles are no nearer.
struct Planes {
  TrianglePair pair;  // the settled one
  Reaches a;          // of the triangles of objects.a
  Reaches b;          // the starts of the triangles of objects.b, negated
};

/// State of a search for the nearest other objects of one object. The search compares the object
/// with all triangles of the scene at once; the trees `all` hold these as one object, at the same
/// scale. Searching two objects takes as long as bounding some hundred pairs of triangles, so a
/// single search is faster if many small objects overlap.
struct Others {
  const SceneTrees* all;
  const Scene& scene;
  std::span<const std::uint32_t> owner;  // per triangle
  std::uint32_t object;                  // the one whose nearest others are searched for
  std::size_t k;                         // how many others are asked for
  bool ties;  // keep also others that are as near as the k-th but have higher numbers
  /// Triangles from here on need no search: k others with lower numbers certainly meet the object.
  std::uint32_t end = UINT32_MAX;
  /// The k least upper bounds, each of another object, sorted; among equal ones the lower numbers.
  std::vector<std::pair<double, std::uint32_t>> nearest = {};

  bool is_own(std::uint32_t triangle) const {
    const Object& own = scene.objects[object];
    return triangle - own.first_triangle < own.triangle_count;
  }
  std::uint32_t other_of(const TrianglePair& pair) const {
    return owner[is_own(pair.a) ? pair.b : pair.a];
  }
  double upper() const {
    return nearest.size() < k ? std::numeric_limits<double>::infinity() : nearest.back().first;
  }
  /// Notes that a pair of the object and another one is at most `upper` apart.
  void add(const TrianglePair& pair, double upper);
};

struct Search {
  ObjectPair objects;
  Others* others = nullptr;  // of objects.a; if set, objects.b is the object of Others::all
  double limit = 0;          // scaled: pairs farther apart are not searched for
  double upper = std::numeric_limits<double>::infinity();  // the least upper bound of a pair so far
  /// The first pair, in the order of pairs, that is known to meet. Later ones are not the answer.
  TrianglePair first = {UINT32_MAX, UINT32_MAX};
  /// The pair that the latest settle() chose, the first of the nearest ones; one of the kept pairs.
  TrianglePair settled = {UINT32_MAX, UINT32_MAX};
  std::shared_ptr<const Planes> planes;  // of `settled`, or of an earlier one that is no nearer
  bool is_part = false;                  // of a search that was divided; makes no planes
  Vec3 direction = Vec3::Zero();         // of a pair with about the bound `upper`; 0: none
  std::vector<NodePair> open;            // to be examined, the last one first
  std::vector<KeptPair> kept;
  bool everything = false;       // keeps all pairs within the limit
  std::size_t kept_most = 1024;  // if more are kept, those that cannot be nearest are dropped, and
                                 // then, if the trees have exact arithmetic, all but the nearest
  ProximityCounts counts;

  double bound() const { return everything ? limit : std::min(upper, limit); }
  bool is_behind(const TrianglePair& pair) const { return !everything && pair > first; }
  /// Drops pairs that cannot be the answer.
  void filter();
};

/// Memory that a thread uses again in all its searches in one scene.
struct SearchMemory {
  static constexpr std::uint32_t kLeaves = 64;
  SearchMemory() : a(kLeaves), b(kLeaves) {}

  std::vector<BlockCorners> a, b;  // leaves of the first and the second object, at leaf % kLeaves
  std::uint64_t directions = 0;    // the number of directions used so far
  PairBatch batch;
};

/// Begins a search. hint: null, or a pair of triangles that may be near.
Search begin_search(const SceneTrees& trees, const ObjectPair& objects, double limit,
                    const TrianglePair* hint, SearchMemory& memory);
/// Begins a search for the nearest others of an object that has triangles. It keeps all pairs whose
/// other object can be among these.
Search begin_search(const SceneTrees& trees, std::uint32_t object, double limit, Others& others,
                    SearchMemory& memory);
/// Continues until no pair of nodes is open, or until `most` pairs of leaves were examined.
void go_on(const SceneTrees& trees, std::size_t most, Search& search, SearchMemory& memory);

/// Pairs of leaves that a search examines before it pauses. A search that is not finished by then
/// is long, and is divided.
constexpr std::size_t kLeafPairsAtOnce = 4096;

/// If the trees have exact arithmetic: drops all kept pairs but the first of the nearest ones. A
/// later pair that is not nearer cannot be the answer. Precondition: some pair is kept.
void settle(const SceneTrees& trees, Search& search);
/// A limit in world units, scaled and rounded up.
double scaled_limit(const SceneTrees& trees, double within);
/// The answer of a search with nothing open. Sets counts.kept.
NearPairs answer(const SceneTrees& trees, Search& search);
/// The most pairs that a search may keep; they take 2.4 GB.
constexpr std::size_t kMostKept = 100'000'000;

/// Throws Error if a search keeps more than `most` pairs.
void require_room(const SceneTrees& trees, const Search& search, std::size_t most = kMostKept);
/// Runs a search to its end, divided. What it finds and counts does not depend on the number of
/// threads. Throws Error if it keeps more than `most` pairs.
void go_on_divided(const SceneTrees& trees, unsigned threads, Search& search,
                   std::size_t most = kMostKept);

}  // namespace farcull
