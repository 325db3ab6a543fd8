// Declares a tree over the triangles of each object, a tree over the objects, and the search for
// the nearest triangles of two objects: branch and bound over pairs of nodes of their trees.
//
// A search pauses after a given number of pairs of leaves. It can then continue, or be divided into
// searches that run in parallel. No search uses the results of another search, so a result depends
// only on the scene, the question and the hint.
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

// Derives the constants below, which bound the rounding errors of the search for near pairs.
//
// u = 2^-53. All coordinates are scaled (SceneTrees): |x| < 4, and scaling errs by at most 2^-1075.
// "Exact" values are those for the given coordinates times the scale. Distances are scaled, too.
//
// Gaps of boxes. Along an axis, the computed gap is g = max(0, fl(lo - hi)). A difference does not
// underflow, so g <= (G + 2^-1074) (1 + u), where G < 8 is the exact gap. The sum of squares has at
// most three more roundings, and a product below 2^-1022 errs by 2^-1075. So the sum is at most
// (sum of G^2 + 2^-1069) (1 + u)^5 + 2^-1073. square_limit(P) computes P^2 (1 + 16 u) + 2^-900 with
// three roundings, so it returns at least P^2 (1 + 12 u) + 2^-901. If the sum is above
// square_limit(P), the exact distance is above P.
//
// Gaps along a direction d, any vector with components in [-16, 16]. Points are taken relative to
// an origin: x = fl(point - origin) errs by u |x|. A dot product d.x has three products and two
// sums. With the error of x, it errs by less than 5 u |d|.|x| (absolute values per axis). The
// difference of two dot products adds a rounding of 2 u |d|.|x|. If X is the largest |x| per axis,
// the gap errs by at most 12 u |d|.X. kGap is 16 u, which also covers the roundings of kGap |d|.X.
// The distance is at least the gap divided by the length of d.
//
// Points. The points p and q are weighted sums of the corners of one triangle each, relative to a
// corner of the first triangle. R is the largest |coordinate| of these corners. The computed
// weights are in [0, 1] and sum to 1 up to 4 u. Per axis, p differs from a point of its triangle by
// at most u R (1 + 4 u) (differences) + 3 u R (products and sums) + 4 u R (weights, compared with
// weights that sum to 1) < 9 u R. The same holds for q. The difference p - q has one rounding of 2
// u R, so it errs by less than 20.1 u R per axis, or 35 u R in length. The computed length is below
// 4 R and errs by less than 3 u of itself. This error and the roundings of two later sums add 20 u
// R. In all, the error is at most 55 u R; kPoint is 64 u.
//
// Triangles that meet. An edge from p to q passes through a triangle if p and q are strictly on
// opposite sides of its plane, and the edge passes the triangle's three sides in the same sense.
// The signs of five determinants of differences of points decide both. A difference errs by u of
// itself. So each of the six products of three differences is within a factor (1 + u)^8 of the
// exact product, sums included. A determinant errs by less than 8.1 u of the sum of the products'
// magnitudes. kDeterminant is 16 u, which also covers the roundings of that sum. If all signs are
// certain, the triangles share a point, and 0 is an upper bound of their distance.
//
// Underflow. A product errs by at most 2^-1075, far below the rounding of a squared length above
// 2^-900 (kLeastSquare). A smaller square counts as 2^-900 in an upper bound, and gives no
// direction. All other losses by underflow are far below kAbsolute.

constexpr double kUnit = 0x1p-53;
constexpr double kPoint = 64 * kUnit;
constexpr double kGap = 16 * kUnit;
constexpr double kDeterminant = 16 * kUnit;
constexpr double kLeastSquare = 0x1p-900;
constexpr double kAbsolute = 0x1p-900;
/// A finite number, larger than the square of any gap between boxes. The gap to an empty box is
/// infinite.
constexpr double kMostSquare = 1024;

/// If the squared gap of two boxes is above the returned number, the boxes are farther apart than
/// `limit` (>= 0, may be infinite).
inline double square_limit(double limit) {
  const double square = limit * limit * (1 + 16 * kUnit) + kAbsolute;
  return square < kMostSquare ? square : kMostSquare;
}

/// If the gap of two points along a direction d is above the returned number, their distance is
/// above `limit`. squared: the squared length of d. doubt: kGap |d|.X.
inline double gap_limit(double limit, double squared, double doubt) {
  // The computed square root has a relative error of less than 3 u.
  return limit * (std::sqrt(squared) * (1 + 8 * kUnit)) * (1 + 4 * kUnit) + doubt + kAbsolute;
}

}  // namespace farcull::near

namespace farcull {

/// The trees of a scene. A leaf is a block of at most sixteen triangles that lie near each other.
/// All coordinates are multiplied by `scale`, a power of two. The largest scaled magnitude is in
/// [1, 4), or below 1 if the largest magnitude of the scene is less than 2^-1000. So no computation
/// with scaled coordinates overflows. A scaled coordinate is exact, unless it is subnormal: then
/// its error is at most 2^-1075.
class SceneTrees {
 public:
  SceneTrees(const Scene& scene, unsigned threads, Settle settle = {});

  const Scene& scene() const { return *scene_; }
  const Settle& settle() const { return settle_; }
  double scale() const { return scale_; }
  const WideBoxes<double>* blocks() const { return blocks_.data(); }
  /// Returns the tree of an object. The leaves are the object's blocks, numbered from 0.
  const BoxTree<double>& tree(std::uint32_t object) const { return trees_[object]; }
  /// Returns the index, among the leaves of all objects, of leaf k of this object.
  std::uint32_t leaf(std::uint32_t object, std::uint32_t k) const { return of_.first[object] + k; }
  std::uint32_t count(std::uint32_t leaf) const { return of_.ranges[place_[leaf]].count; }
  std::uint32_t triangle(std::uint32_t leaf, std::uint32_t k) const {
    return of_.triangle(of_.ranges[place_[leaf]].first + k);
  }
  Vec3 corner(std::uint32_t triangle, std::size_t k) const {
    return scene_->vertices[scene_->triangles[triangle][k]] * scale_;
  }
  /// Returns boxes that together contain the triangles of an object: one box, or several much
  /// smaller boxes if the triangles lie far apart.
  std::span<const Box> parts(std::uint32_t object) const {
    return std::span(parts_).subspan(first_part_[object],
                                     first_part_[object + 1] - first_part_[object]);
  }
  /// Returns the lowest triangle number below node k of an object's tree at this height.
  std::uint32_t least(std::uint32_t object, std::size_t height, std::uint32_t k) const {
    const BoxTree<double>& tree = trees_[object];
    if (height == static_cast<std::size_t>(tree.levels))
      return scene_->objects[object].first_triangle;
    return least_[tree.first[height] + k / kWide][k % kWide];
  }

  /// Returns the tree over the parts of all objects. Each leaf is a part of object(leaf).
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
  std::vector<std::uint32_t> place_;  // one index in of_.ranges per leaf
  std::vector<BoxTree<double>> trees_;
  std::vector<Box> parts_;
  std::vector<std::size_t> first_part_;  // index of each object's first part; last: number of parts
  BoxTree<double> objects_;
  std::vector<std::uint32_t> object_of_leaf_;
  UninitializedVector<WideBoxes<double>> blocks_;
  std::vector<std::array<std::uint32_t, kWide>> least_;  // one per box of blocks_; see least()
};

/// The corners of sixteen scaled triangles, in columns: column 3 * corner + axis.
using CornerColumns = std::array<std::array<double, kWide>, 9>;

struct alignas(64) PairBatch {
  CornerColumns a{}, b{};
  std::array<TrianglePair, kWide> pairs{};
  std::size_t count = 0;  // the number of pairs; later columns hold any finite numbers
};

/// The exact distance of each pair is at least `lower` and at most `upper`, in scaled units. If
/// `upper` is 0, the triangles certainly meet. `direction` leads roughly from the closest point of
/// triangle a to the closest point of triangle b.
struct alignas(64) BatchBounds {
  std::array<double, kWide> lower, upper;
  std::array<std::array<double, kWide>, 3> direction;
};

struct alignas(64) BlockCorners {
  CornerColumns corner;
  WideBoxes<double> boxes;  // boxes of the triangles
  std::array<std::uint32_t, kWide> triangle;
  alignas(64) std::array<double, kWide> extreme;  // per triangle: its largest or smallest
                                                  // coordinate along the direction
  double most_extreme = 0;
  std::uint64_t direction = 0;  // number of the direction (SearchMemory); 0: none
  std::uint32_t leaf = UINT32_MAX;
  std::uint32_t count = 0;
};

/// Loads a leaf, numbered by SceneTrees::leaf(). Columns after the leaf's last triangle repeat that
/// triangle, but have empty boxes.
void load_leaf(const SceneTrees& trees, std::uint32_t leaf, BlockCorners& out);

/// True if the triangles have a corner at the same position.
bool share_position(const Scene& scene, std::uint32_t a, std::uint32_t b);

/// A pair of nodes, each with its height and number. square: the squared gap of their boxes.
struct NodePair {
  double square;
  std::uint32_t a, b;
  std::uint8_t a_height, b_height;
};

/// A pair of triangles that may be nearest. lower, upper: bounds of its distance, in scaled units.
struct KeptPair {
  TrianglePair pair;
  double lower, upper;
};

/// Holds the reach (SettledPair) of each triangle of an object. Also holds, for each node of the
/// object's tree, the greatest reach of a triangle below the node.
struct Reaches {
  Reaches(const SceneTrees& trees, std::uint32_t object,
          const std::function<double(std::uint32_t)>& reach);
  std::vector<std::vector<double>> nodes;  // index: height, then number of the node
  std::vector<double> triangles;           // index: kWide * leaf + k
};

/// Proves that other pairs of triangles are no nearer than a settled pair.
struct Planes {
  TrianglePair pair;  // the settled pair
  Reaches a;          // the reach of each triangle of objects.a
  Reaches b;          // -start (SettledPair) of each triangle of objects.b
};

/// State of a search for the nearest other objects of one object. The search compares the object
/// with all triangles of the scene at once. The trees `all` hold these triangles as one object, at
/// the same scale. A search between two objects takes as long as bounding some hundred pairs of
/// triangles. So one search is faster than many if many small objects overlap.
struct Others {
  const SceneTrees* all;
  const Scene& scene;
  std::span<const std::uint32_t> owner;  // object of each triangle
  std::uint32_t object;                  // the search finds objects near this object
  std::size_t k;                         // number of other objects to find
  bool ties;                             // true: keeps all others that are as near as the k-th
  /// Triangles from this number on need no search, since k other objects with only lower triangle
  /// numbers certainly meet the object.
  std::uint32_t end = UINT32_MAX;
  /// The k least upper bounds with the numbers of their objects, sorted by bound, then by number.
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
  /// Records that a triangle of the object and one of another object are at most `upper` apart.
  void add(const TrianglePair& pair, double upper);
};

struct Search {
  ObjectPair objects;
  Others* others = nullptr;  // if set, objects.b is the one object of Others::all
  double limit = 0;          // scaled; pairs farther apart are not searched for
  double upper = std::numeric_limits<double>::infinity();  // the least upper bound of a pair so far
  /// The first pair, in sorted order, that is known to meet. No later pair can be the answer.
  TrianglePair first = {UINT32_MAX, UINT32_MAX};
  /// The kept pair that the latest settle() chose.
  TrianglePair settled = {UINT32_MAX, UINT32_MAX};
  std::shared_ptr<const Planes> planes;  // planes of `settled`, or of an earlier settled pair
  bool is_part = false;                  // part of a divided search; such a part makes no planes
  Vec3 direction = Vec3::Zero();         // between closest points of the best pair; 0: unknown
  std::vector<NodePair> open;            // pairs to examine; the last pair comes first
  std::vector<KeptPair> kept;
  bool everything = false;       // true: keeps all pairs within the limit
  std::size_t kept_most = 1024;  // with more kept pairs, the search calls filter(), then settle()
  ProximityCounts counts;

  double bound() const { return everything ? limit : std::min(upper, limit); }
  bool is_behind(const TrianglePair& pair) const { return !everything && pair > first; }
  /// Drops kept pairs that cannot be the answer.
  void filter();
};

/// Memory of one thread for all its searches in one scene.
struct SearchMemory {
  static constexpr std::uint32_t kLeaves = 64;
  SearchMemory() : a(kLeaves), b(kLeaves) {}

  std::vector<BlockCorners> a, b;  // caches of leaves; leaf l of objects.a is a[l % kLeaves]
  std::uint64_t directions = 0;    // the number of directions used so far
  PairBatch batch;
};

/// Begins a search. hint: may be null; otherwise a pair of triangles that may be near each other.
Search begin_search(const SceneTrees& trees, const ObjectPair& objects, double limit,
                    const TrianglePair* hint, SearchMemory& memory);
/// Begins a search for the other objects nearest to an object. The search keeps all pairs whose
/// other object can be among the nearest. Precondition: the object has triangles.
Search begin_search(const SceneTrees& trees, std::uint32_t object, double limit, Others& others,
                    SearchMemory& memory);
/// Continues until no pair of nodes is left, or until `most` pairs of leaves were examined.
void go_on(const SceneTrees& trees, std::size_t most, Search& search, SearchMemory& memory);

/// A search examines this many pairs of leaves, then pauses. If it is not finished, it is divided.
constexpr std::size_t kLeafPairsAtOnce = 4096;

/// Drops all kept pairs except the nearest, by exact arithmetic. If several are nearest, keeps the
/// first. Does nothing if the trees have no Settle. Precondition: some pair is kept.
void settle(const SceneTrees& trees, Search& search);
/// Converts a limit from world units to scaled units, rounded up.
double scaled_limit(const SceneTrees& trees, double within);
/// Returns the answer of a finished search. Sets counts.kept.
NearPairs answer(const SceneTrees& trees, Search& search);
/// A search may keep at most this many pairs, which take 2.4 GB.
constexpr std::size_t kMostKept = 100'000'000;

/// Throws Error if a search keeps more than `most` pairs.
void require_room(const SceneTrees& trees, const Search& search, std::size_t most = kMostKept);
/// Finishes a search in parts that run in parallel. Results and counts do not depend on the number
/// of threads. Throws Error if the search keeps more than `most` pairs.
void go_on_divided(const SceneTrees& trees, unsigned threads, Search& search,
                   std::size_t most = kMostKept);

}  // namespace farcull
