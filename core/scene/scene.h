// Defines Scene: triangles in flat arrays, grouped into objects. The coordinates are the given
// doubles, and are never rounded.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace farcull {

using Vec3 = Eigen::Vector3d;

/// A closed axis-aligned box in world units. It is empty if lo > hi in some coordinate.
struct Box {
  Vec3 lo;
  Vec3 hi;

  static Box empty() { return {Vec3::Constant(HUGE_VAL), Vec3::Constant(-HUGE_VAL)}; }
  bool is_empty() const { return (lo.array() > hi.array()).any(); }
  void add(const Vec3& p) { add(Box{p, p}); }
  void add(const Box& other) {
    lo = lo.cwiseMin(other.lo);
    hi = hi.cwiseMax(other.hi);
  }
};

/// Returns the common part of two boxes, or an empty box if they do not overlap.
inline Box intersection(const Box& a, const Box& b) {
  return {a.lo.cwiseMax(b.lo), a.hi.cwiseMin(b.hi)};
}
/// True iff the closed boxes share a point. An empty box overlaps nothing. The answer is exact,
/// since doubles are only compared.
inline bool overlap(const Box& a, const Box& b) { return !intersection(a, b).is_empty(); }
inline bool lies_within(const Box& inner, const Box& outer) {
  return (inner.lo.array() >= outer.lo.array() && inner.hi.array() <= outer.hi.array()).all();
}

/// Two objects, as indices a < b. If a == b, this is an object and itself.
struct ObjectPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  auto operator<=>(const ObjectPair&) const = default;
};

struct Object {
  std::string name;
  std::uint32_t first_triangle = 0;  // index into Scene::triangles
  std::uint32_t triangle_count = 0;  // may be 0
  bool self = false;                 // true: its own triangles are tested against each other
};

/// A non-simple polygon of an input file: its triangles overlap or face opposite ways.
struct FoldedFace {
  std::uint32_t object = 0;
  std::uint32_t face = 0;  // number of the polygon, as in Scene::source_face
  auto operator<=>(const FoldedFace&) const = default;
};

/// Objects own contiguous, ascending, gapless ranges of triangles. Object and triangle order is the
/// order of the input.
struct Scene {
  std::string name;
  std::vector<Vec3> vertices;  // all finite
  /// Each triangle is three indices into `vertices`. Degenerate triangles are kept.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> source_face;  // per triangle: its polygon in the file, counted from 0
  std::vector<Object> objects;
  std::vector<ObjectPair> ignored = {};  // pairs of objects that are not tested; see in_order()
  std::vector<FoldedFace> folded = {};   // sorted

  std::array<Vec3, 3> corners(std::uint32_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return {vertices[a], vertices[b], vertices[c]};
  }
};

/// Fetches the corners of a triangle into the cache.
inline void prefetch([[maybe_unused]] const Scene& scene, [[maybe_unused]] std::uint32_t triangle) {
#ifdef __GNUC__
  for (const std::uint32_t v : scene.triangles[triangle])
    __builtin_prefetch(scene.vertices[v].data());
#endif
}
/// A loop over consecutive triangles prefetches corners this many triangles ahead.
inline constexpr std::uint32_t kTrianglesAhead = 16;

/// A pair of triangles of a scene, a < b, as global triangle indices.
struct TrianglePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  auto operator<=>(const TrianglePair&) const = default;
};

inline bool share_index(const std::array<std::uint32_t, 3>& a,
                        const std::array<std::uint32_t, 3>& b) {
  bool shared = false;
  for (const std::uint32_t v : a)
    shared = static_cast<bool>(shared | (v == b[0]) | (v == b[1]) | (v == b[2]));
  return shared;
}

/// The lowest and the highest vertex index that an object uses. Ranges of objects seldom overlap.
struct VertexRange {
  std::uint32_t first = 0, last = 0;
};
inline VertexRange vertices_of(const Scene& scene, const Object& object) {
  VertexRange out{scene.triangles[object.first_triangle][0],
                  scene.triangles[object.first_triangle][0]};
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    for (const std::uint32_t v : scene.triangles[object.first_triangle + t]) {
      out.first = std::min(out.first, v);
      out.last = std::max(out.last, v);
    }
  }
  return out;
}

/// Throws Error, which names `where`, unless all indices are in range, all coordinates are finite,
/// the objects' ranges of triangles have no gaps, and `ignored` is sorted.
void validate(const Scene& scene, const std::string& where);

/// Returns the box of each triangle. threads: 0 means one per core.
std::vector<Box> triangle_boxes(const Scene& scene, unsigned threads = 1);
/// Returns the box of each object's triangles. An object without triangles has an empty box.
std::vector<Box> object_boxes(const Scene& scene, std::span<const Box> triangle_boxes);
/// Returns the object of each triangle.
std::vector<std::uint32_t> owners(const Scene& scene);

/// Returns an FNV-1a hash, in 16 hex digits, of each object's triangle_count and `self`, and of the
/// bits of the coordinates of all triangles, in order. Names and ignored pairs of objects have no
/// influence.
std::string scene_hash(const Scene& scene);

/// Returns the triangles that are in at least one pair, ascending and distinct. triangles: number
/// of triangles of the scene.
std::vector<std::uint32_t> members_of(std::span<const TrianglePair> pairs, std::size_t triangles);

/// Returns the number of objects that have at least one of these triangles. Precondition: the
/// triangles are ascending.
std::uint64_t count_objects(const Scene& scene, std::span<const std::uint32_t> triangles);

bool has_self(const Scene& scene);

/// Returns the pairs of both lists, sorted and distinct. If a > b in a pair, exchanges a and b.
std::vector<ObjectPair> in_order(std::vector<ObjectPair> pairs,
                                 std::span<const ObjectPair> more = {});

/// Removes the pairs of triangles whose objects are an ignored pair. The remaining pairs keep their
/// order. Returns how many pairs were removed. ignored: a result of in_order(). Time O(pairs).
/// Throws std::logic_error if `ignored` names an object that the scene does not have.
std::uint64_t remove_ignored(const Scene& scene, std::span<const ObjectPair> ignored,
                             std::vector<TrianglePair>& pairs);

/// Throws Error if the scene ignores pairs of objects. who: the operation that needs all pairs.
void require_nothing_ignored(const Scene& scene, const std::string& who);

/// Tells whether the objects of a pair of triangles are an ignored pair.
class IgnoredObjects {
 public:
  /// Parameters and errors are those of remove_ignored(). The scene need not outlive this object.
  IgnoredObjects(const Scene& scene, std::span<const ObjectPair> ignored);
  bool any() const { return !others_.empty(); }
  bool operator()(const TrianglePair& pair) const;

 private:
  std::vector<std::uint32_t> owner_;  // object of each triangle
  // others_[first_[b]] to others_[first_[b + 1] - 1] are the objects a < b for which (a, b) is an
  // ignored pair, ascending.
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> others_;
};

/// The changes from the previous frame of a scene to the present frame.
struct FrameChange {
  bool same = false;                    // true: vertex count, triangles and objects are unchanged
  std::vector<std::uint32_t> vertices;  // if `same`: the distinct vertices that moved
};

/// Finds the corners that moved between two frames of the same triangles and objects. A class that
/// reuses results of a frame stores the frame's number, frame(), with the results. It may use these
/// results only if follows(number) is true.
class MovedCorners {
 public:
  /// Begins the next frame. change: what changed; if null, the scene is compared with a copy of the
  /// last frame, which this object keeps. If waits() was true before the call, `change` is ignored
  /// and nothing is compared.
  void update(const Scene& scene, const FrameChange* change = nullptr);
  /// True if the next update() compares nothing, because knowing the changes has saved no work.
  bool waits() const { return waits_ > 0; }
  /// Records whether knowing the changes saved work in this frame. Call at most once per frame. Has
  /// no effect if the changes are unknown.
  void notify(bool worth_while);
  /// Returns the number of the present frame, counted from 1.
  std::uint64_t frame() const { return frame_; }
  /// True if the present frame is the one after `frame` and has the same triangles and objects.
  /// Then the functions below describe what moved since `frame`.
  bool follows(std::uint64_t frame) const { return known_ && frame_ == frame + 1; }
  /// True if some triangle has a corner that moved.
  bool any() const { return !triangles_.empty(); }
  /// True if triangle t has a corner that moved.
  bool triangle(std::uint32_t t) const { return any() && triangle_moved_[t] != 0; }
  /// Returns the distinct triangles with a corner that moved.
  const std::vector<std::uint32_t>& triangles() const { return triangles_; }
  static constexpr int kMostWaits = 16;  // at most this many consecutive frames wait

 private:
  struct Copy {
    std::vector<Object> objects;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3> vertices;
  };
  FrameChange compare(const Scene& scene);
  void mark(const Scene& scene, const std::vector<std::uint32_t>& vertices);

  std::uint64_t frame_ = 0;
  bool known_ = false;
  int waits_ = 0, next_waits_ = 1;  // frames left to wait; length of the next wait in frames
  std::optional<Copy> last_;
  // The triangles with vertex v: of_vertex_[first_of_[v]] to of_vertex_[first_of_[v + 1] - 1]. The
  // lists are empty until mark() makes them.
  std::vector<std::uint32_t> first_of_, of_vertex_;
  std::vector<std::uint8_t> triangle_moved_;  // valid only if a corner moved
  std::vector<std::uint32_t> triangles_;      // triangles with a corner that moved
};

/// Examines an evenly spaced sample of the pairs. True if neither triangle moved in at least half
/// of the sample. Without pairs, true if nothing moved.
bool mostly_unmoved(const MovedCorners& moved, std::span<const TrianglePair> pairs);

/// True if the determinant certainly is not 0, despite rounding. r: the matrix, row by row, finite.
///
/// Each row is divided by its largest magnitude, which does not change the sign of the determinant.
/// A term of the determinant then has at most 8 roundings, each by at most u = 2^-53: three
/// quotients, two products, a difference and two sums. So 9 u times the sum of the magnitudes
/// covers all roundings, as in verify/filter_scalars.h.
bool is_invertible(std::array<double, 9> r);

}  // namespace farcull
