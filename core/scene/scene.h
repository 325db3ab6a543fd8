// A scene: triangles as flat arrays, grouped into objects. Coordinates are the doubles that were
// given, never rounded.
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

/// A closed axis-aligned box in world units. Empty where lo > hi in some coordinate.
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

/// The common part of two boxes; empty if they do not overlap.
inline Box intersection(const Box& a, const Box& b) {
  return {a.lo.cwiseMax(b.lo), a.hi.cwiseMin(b.hi)};
}
/// True iff the closed boxes share a point (touching counts); never if one is empty along an axis.
/// Exact: it only compares doubles.
inline bool overlap(const Box& a, const Box& b) { return !intersection(a, b).is_empty(); }
/// True iff `outer` contains all of `inner`.
inline bool lies_within(const Box& inner, const Box& outer) {
  return (inner.lo.array() >= outer.lo.array() && inner.hi.array() <= outer.hi.array()).all();
}

/// Two objects as indices, a < b; or one object twice.
struct ObjectPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  auto operator<=>(const ObjectPair&) const = default;
};

struct Object {
  std::string name;
  std::uint32_t first_triangle = 0;  // index into Scene::triangles
  std::uint32_t triangle_count = 0;  // may be 0
  bool self = false;                 // its own triangles are tested against each other as well
};

/// A polygon of a file that is folded: not simple, so its triangles overlap or face both ways.
struct FoldedFace {
  std::uint32_t object = 0;
  std::uint32_t face = 0;  // as in Scene::source_face
  auto operator<=>(const FoldedFace&) const = default;
};

/// Objects own contiguous, ascending, gapless ranges of triangles. Object and triangle order is the
/// order of the input.
struct Scene {
  std::string name;
  std::vector<Vec3> vertices;  // finite
  /// Indices into vertices; degenerate triangles are kept.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> source_face;  // per triangle: its polygon in the file, from 0
  std::vector<Object> objects;
  std::vector<ObjectPair> ignored = {};  // not tested against each other; as in_order() gives them
  std::vector<FoldedFace> folded = {};   // polygons to warn of; sorted

  std::array<Vec3, 3> corners(std::uint32_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return {vertices[a], vertices[b], vertices[c]};
  }
};

/// Fetches the corners of a triangle into the cache. They may lie anywhere in memory.
inline void prefetch([[maybe_unused]] const Scene& scene, [[maybe_unused]] std::uint32_t triangle) {
#ifdef __GNUC__
  for (const std::uint32_t v : scene.triangles[triangle])
    __builtin_prefetch(scene.vertices[v].data());
#endif
}
/// Loops over triangles in order prefetch corners this many triangles ahead.
inline constexpr std::uint32_t kTrianglesAhead = 16;

/// A pair of triangles of a scene, a < b, as global triangle indices.
struct TrianglePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  auto operator<=>(const TrianglePair&) const = default;
};

/// Whether two triangles have a vertex index in common.
inline bool share_index(const std::array<std::uint32_t, 3>& a,
                        const std::array<std::uint32_t, 3>& b) {
  bool shared = false;
  for (const std::uint32_t v : a)
    shared = static_cast<bool>(shared | (v == b[0]) | (v == b[1]) | (v == b[2]));
  return shared;
}

/// The range of vertices that an object with triangles uses. Ranges of two objects seldom overlap.
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

/// Throws Error naming `where` unless every index is in range, every coordinate finite and the
/// ranges gapless.
void validate(const Scene& scene, const std::string& where);

std::vector<Box> triangle_boxes(const Scene& scene);
/// One box per object (empty for an object without triangles), from the triangles, so unused
/// vertices do not count.
std::vector<Box> object_boxes(const Scene& scene, std::span<const Box> triangle_boxes);
/// The object of each triangle.
std::vector<std::uint32_t> owners(const Scene& scene);

/// 16 hex digits: FNV-1a over the sizes of the objects, whether they are `self`, and the bits of
/// the coordinates of all triangles, in order. Names do not count, nor do ignored objects, which a
/// record lists separately.
std::string scene_hash(const Scene& scene);

/// Triangles in at least one of the pairs; ascending, each once. triangles: number of triangles of
/// the scene.
std::vector<std::uint32_t> members_of(std::span<const TrianglePair> pairs, std::size_t triangles);

/// Number of objects that have at least one of these triangles (ascending).
std::uint64_t count_objects(const Scene& scene, std::span<const std::uint32_t> triangles);

/// Whether an object of the scene is tested against itself.
bool has_self(const Scene& scene);

/// Joins two lists of pairs of different objects: a < b in each pair, sorted, each pair once.
std::vector<ObjectPair> in_order(std::vector<ObjectPair> pairs,
                                 std::span<const ObjectPair> more = {});

/// Removes the pairs of triangles whose objects are an ignored pair (such objects are not tested,
/// and their distance is not measured). The others stay in their order. Returns how many were
/// removed. ignored: as in_order() gives them. Time O(pairs). Throws std::logic_error if `ignored`
/// names an object that the scene does not have.
std::uint64_t remove_ignored(const Scene& scene, std::span<const ObjectPair> ignored,
                             std::vector<TrianglePair>& pairs);

/// Throws Error if the scene ignores pairs of objects. who: the work that needs all pairs.
void require_nothing_ignored(const Scene& scene, const std::string& who);

/// Tells whether the objects of a pair of triangles are ignored.
class IgnoredObjects {
 public:
  /// As remove_ignored(). The scene is not kept.
  IgnoredObjects(const Scene& scene, std::span<const ObjectPair> ignored);
  bool any() const { return !others_.empty(); }
  bool operator()(const TrianglePair& pair) const;

 private:
  std::vector<std::uint32_t> owner_;  // per triangle
  // Per object b the objects a < b that are ignored with it: others_[first_[b]] to
  // others_[first_[b + 1]], ascending. Most objects have a short list or an empty one.
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> others_;
};

/// What changed from the previous frame of a scene to this one.
struct FrameChange {
  bool same = false;  // number of vertices, triangles and objects are those of the frame before
  std::vector<std::uint32_t> vertices;  // if `same`: the vertices that moved, each once
};

/// Which corners moved between two frames of the same triangles and objects. A class that keeps
/// results of a frame also keeps its frame(), and uses the results only in the next frame.
class MovedCorners {
 public:
  /// Begins the next frame. change: what changed, if the caller knows it; null: the scene is
  /// compared with a copy of the last frame, which this object keeps. If waits() was true before
  /// the call, `change` is ignored and nothing is compared.
  void update(const Scene& scene, const FrameChange* change = nullptr);
  /// True if the next update() compares nothing: knowing what moved has saved nothing lately.
  bool waits() const { return waits_ > 0; }
  /// Call at most once a frame: tells whether knowing what moved saved work in this frame. Has no
  /// effect if it was not known.
  void notify(bool worth_while);
  /// The number of the present frame, counted from 1.
  std::uint64_t frame() const { return frame_; }
  /// True if this is the frame after the given one and has the same triangles and objects, so that
  /// the functions below say what moved since.
  bool follows(std::uint64_t frame) const { return known_ && frame_ == frame + 1; }
  /// Whether any triangle has a corner that moved.
  bool any() const { return !triangles_.empty(); }
  /// Whether triangle t has a corner that moved.
  bool triangle(std::uint32_t t) const { return any() && triangle_moved_[t] != 0; }
  /// All triangles with a corner that moved, each once.
  const std::vector<std::uint32_t>& triangles() const { return triangles_; }
  static constexpr int kMostWaits = 16;  // frames in a row that may wait

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
  int waits_ = 0, next_waits_ = 1;  // frames still to wait; frames to wait the next time
  std::optional<Copy> last_;
  // Per vertex v the triangles that have it: of_vertex_[first_of_[v]] to of_vertex_[first_of_[v +
  // 1]]. Empty: not made yet.
  std::vector<std::uint32_t> first_of_, of_vertex_;
  std::vector<std::uint8_t> triangle_moved_;  // valid only if a corner moved
  std::vector<std::uint32_t> triangles_;      // those that moved
};

/// True if at least half of an even sample of the pairs have no triangle that moved. Without a
/// pair: true if nothing moved.
bool mostly_unmoved(const MovedCorners& moved, std::span<const TrianglePair> pairs);

/// False if the matrix (finite, row by row) maps space to a plane, a line or a point, as far as
/// doubles can show: its determinant is 0, or at most its own rounding errors.
///
/// Each row is divided by its largest number, which changes neither answer nor signs. A term of the
/// determinant then has at most 8 roundings, each by at most u = 2^-53: three quotients, two
/// products, a difference and two sums. So 9 u times the sum of the magnitudes covers them, as in
/// verify/filter_scalars.h.
bool is_invertible(std::array<double, 9> r);

}  // namespace farcull
