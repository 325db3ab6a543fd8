// Computes the discrete Voronoi diagram of objects, and finds neighbouring objects in it.
//
// As published: Sud, Govindaraju, Gayle, Kabul, Manocha (Fast Proximity Computation Among
// Deformable Models using Discrete Voronoi Diagrams, SIGGRAPH 2006), after Hoff, Keyser, Lin,
// Manocha, Culver (Fast Computation of Generalized Voronoi Diagrams Using Graphics Hardware,
// SIGGRAPH 1999). A grid of cubes covers the scene. Each cell names the two objects that are
// nearest to its centre, with distances in float. Two objects are potential neighbours if some cell
// names them. If a cell lies between the nearest points of two objects, a third object may be
// nearer to its centre. So the published form loses neighbours.
//
// The reliable form loses no neighbours. If the middle of a shortest segment between two objects
// lies in a cell, the cell keeps every triangle that may hold an end of the segment (theorem V9).
// docs/voronoi.md has definitions and proofs.
//
// Both forms process a tree of blocks of cells (the papers fill slice after slice). A block is left
// out if no cell in it can add to the answer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/stage.h"
#include "core/scene/scene.h"

namespace farcull {

// The code below defines the grid of the discrete Voronoi diagram, triangles in units of the grid,
// and the distance of a point from a triangle, in float with two bounds of the exact distance.
//
// In units of the grid, a coordinate x of the scene is (x 2^exponent - lo) / cell. The cells are
// the unit cubes [i, i + 1]. The power of two keeps all finite doubles in range.
//
// Errors of the computed distance, with u = 2^-24. The coordinates of the point c and of the
// triangle with corners q_i are in [0, N]. All roundings are to nearest.
//
// Upper bound. The point w of the triangle nearest to c is sought on each edge and in the face. On
// an edge from q to q', w = q + t (q' - q) with a float t in [0, 1]. In the face, w = q0 + s (q1 -
// q0) + t (q2 - q0) with floats s, t >= 0 and s + t <= 1 (up to 1 + u, if the float sum is rounded
// down to 1). With exact arithmetic, this t (and s) gives a point P of the triangle. Per axis,
// w differs from P by at most uN for each difference, product and sum, and by the factor 1 + u.
// Computing n = c - w adds uN, so n differs from c - P by at most 6.2 uN per axis, or 10.8 uN in
// length. The length of n is at most 1.7321 N. Its relative error is at most 2.6 u, which is 4.6
// uN. Rounding a corner to float moves it by at most 1.01 uN per axis, or 1.8 uN in length. So the
// exact distance is at most the computed one + 17.2 uN.
//
// Lower bound. Along n, a corner of the triangle is the point nearest to c. So the distance is at
// least the least n . (c - q_i) / |n|. The computed product errs by at most 4.1 u |n| |c - q_i|,
// which is 7.2 uN |n|. Dividing by the computed length errs by 3.7 u of the quotient (at most 1.74
// N), which is 6.5 uN. With 1.8 uN for the corners, the sum is 15.5 uN. Products below the normal
// floats err by 2^-149 each, far less than uN |n| if |n| >= kShortest.
//
// voronoi_error() = 32 uN exceeds both errors, with room for the roundings of a few sums of
// distances (docs/voronoi.md, lemma V6).

/// The cubes [0, cells[0]] x [0, cells[1]] x [0, cells[2]] contain all triangles of the scene.
struct VoronoiGrid {
  int exponent = 0;
  Vec3 lo = Vec3::Zero();  // world units
  double cell = 1;
  std::array<int, 3> cells = {1, 1, 1};

  int longest() const;  // the largest of `cells`
  /// Converts a distance from units of the grid to world units, rounded up. Returns infinity if the
  /// result is too large for a double.
  double world(double distance) const;
};

/// Returns the grid with `resolution` cells along the longest side of the box of all triangles.
VoronoiGrid voronoi_grid(const Scene& scene, int resolution);

/// A triangle in units of the grid. Each coordinate errs by at most 1.01 * 2^-24 longest().
struct GridTriangle {
  std::array<std::array<float, 3>, 3> corners;
  std::uint32_t object = 0;
};
std::vector<GridTriangle> grid_triangles(const Scene& scene, const VoronoiGrid& grid,
                                         unsigned threads);

/// A point in units of the grid.
using GridPoint = std::array<float, 3>;

/// Returns 32 uN (u = 2^-24). longest: N, the number of cells along the longest side.
inline float voronoi_error(int longest) { return 0x1p-19f * static_cast<float>(longest); }

/// lower <= the exact distance <= upper. computed: the distance that the published form compares.
struct GridDistance {
  float computed;
  float lower;
  float upper;
};

namespace grid_distance {

constexpr float kShortest = 0x1p-40f;

inline GridPoint minus(const GridPoint& a, const GridPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline float dot(const GridPoint& a, const GridPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline GridPoint cross(const GridPoint& a, const GridPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// Returns the quotient, clamped to [0, 1]; 0 if it is NaN.
inline float part(float numerator, float denominator) {
  const float t = numerator / denominator;
  return t > 0 ? std::min(t, 1.0f) : 0.0f;
}

// The shortest of the added vectors from a point of the triangle to c. square: n . n.
struct Shortest {
  GridPoint n;
  float square;

  void add(const GridPoint& other) {
    const float of_other = dot(other, other);
    if (of_other < square) {
      n = other;
      square = of_other;
    }
  }
};

inline GridPoint to_edge(const GridPoint& c, const GridPoint& q, const GridPoint& along) {
  const float t = part(dot(minus(c, q), along), dot(along, along));
  return minus(c, {q[0] + t * along[0], q[1] + t * along[1], q[2] + t * along[2]});
}

// Projects c on the face's plane. If the projection is in the triangle, adds the vector from the
// projection to c.
inline void add_face(const GridPoint& c, const GridPoint& q, const GridPoint& e, const GridPoint& f,
                     Shortest& shortest) {
  const GridPoint normal = cross(e, f), from = minus(c, q);
  const float square = dot(normal, normal);
  const float s = dot(cross(from, f), normal) / square, t = dot(cross(e, from), normal) / square;
  // If the normal is 0, s and t are NaN, and this test returns.
  if (!(s >= 0 && t >= 0 && s + t <= 1)) return;
  GridPoint w;
  for (std::size_t k = 0; k < 3; ++k) w[k] = q[k] + s * e[k] + t * f[k];
  shortest.add(minus(c, w));
}

}  // namespace grid_distance

/// Returns the distance of c from the triangle, with bounds. error: voronoi_error() of the grid.
inline GridDistance distance_of(const GridPoint& c, const GridTriangle& triangle, float error) {
  using namespace grid_distance;
  const auto& q = triangle.corners;
  const GridPoint e = minus(q[1], q[0]), f = minus(q[2], q[0]);
  const GridPoint first = to_edge(c, q[0], e);
  Shortest shortest{first, dot(first, first)};
  shortest.add(to_edge(c, q[0], f));
  shortest.add(to_edge(c, q[1], minus(q[2], q[1])));
  add_face(c, q[0], e, f, shortest);
  const GridPoint& n = shortest.n;
  const float length = std::sqrt(shortest.square);
  const float along =
      std::min({dot(n, minus(c, q[0])), dot(n, minus(c, q[1])), dot(n, minus(c, q[2]))});
  const float lower = length >= kShortest ? along / length - error : 0.0f;
  return {length, std::max(lower, 0.0f), length + error};
}

struct VoronoiOptions {
  int resolution = 64;  // cells along the longest side of the scene's box; 1 to kVoronoiLargest
  /// The reliable form widens each cell by this many half diagonals of the cell, 0 to 1. The proof
  /// needs 1. With a smaller value, neighbours may be lost.
  double widening = 1;
  unsigned threads = 0;                               // 0: one per core; changes no answer
  std::uint64_t most_pairs = std::uint64_t{1} << 27;  // limit of pairs in reliable_neighbours()
};
constexpr int kVoronoiLargest = 1 << 14;

struct VoronoiCounts {
  std::array<int, 3> cells{};   // cells of the grid along each axis
  std::uint64_t blocks = 0;     // blocks whose distances were computed
  std::uint64_t distances = 0;  // computed distances of a point from a triangle
};

/// The result of the published or the reliable form. Objects without triangles have no neighbours.
struct VoronoiNeighbours {
  /// Pairs of objects, sorted, distinct. In the published form, a pair has the two objects nearest
  /// to some cell; of objects at equal distances in float, those with the lowest indices. In the
  /// reliable form, a pair has the two objects of a pair in `triangles`.
  std::vector<ObjectPair> objects;
  VoronoiCounts counts;

  // The published form leaves the members below empty.
  /// For each object A, let d be its least distance from any other object. The list has every pair
  /// of triangles at distance d, one of A and one of another object. Sorted, distinct.
  std::vector<TrianglePair> triangles;
  /// For each object an upper bound of d, in world units. Infinite if the object has no triangles,
  /// or if no other object has triangles.
  std::vector<double> upper;
};

/// Computes the published form. Throws Error for options that are out of range. Precondition: the
/// scene satisfies validate().
VoronoiNeighbours voronoi_neighbours(const Scene& scene, const VoronoiOptions& options,
                                     const Progress& progress = {});

/// Computes the reliable form. Throws Error for options that are out of range, and if it would keep
/// more pairs than most_pairs plus some millions, because a cell contains too much of the scene.
/// Precondition: the scene satisfies validate().
VoronoiNeighbours reliable_neighbours(const Scene& scene, const VoronoiOptions& options,
                                      const Progress& progress = {});

}  // namespace farcull
