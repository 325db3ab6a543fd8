// Embree, in two ways: rtcCollide as a broad phase, and distances by rtcPointQuery.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "experiments/peers/peer.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr const char* kLibrary = "Embree " RTC_VERSION_STRING;

RTCDevice new_device(unsigned threads) {
  return rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
}

/// Throws Error if a call of Embree failed since the last check.
void require_no_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw Error(kLibrary, "error " + std::to_string(error), "leave it out with --peers");
}

/// Why Embree cannot take the scene; empty if it can. Embree silently leaves out geometry with a
/// coordinate of 1.844e18 or more.
std::string refuses_large(const Scene& scene) {
  for (const Vec3& p : scene.vertices) {
    if (p.cwiseAbs().maxCoeff() > 1e18) return "Embree leaves out coordinates beyond 1e18";
  }
  return "";
}

// The broad phase: hierarchies of user geometries, whose boxes in float are rounded outward.

// These functions move x outward by more than its rounding to float: the step is at least an ulp of
// f, f -+ an ulp is a float, and rounding is monotone; kTiny is more than half an ulp of subnormal
// floats. For |x| < 2^127. (This is faster than finding the nearest float beyond x, and as good.)
constexpr float kTiny = std::numeric_limits<float>::min();
float below(double x) {
  const auto f = static_cast<float>(x);
  return f - std::abs(f) * 0x1p-23f - kTiny;
}
float above(double x) { return -below(-x); }

/// The box around a triangle, for rtcCollide.
struct FloatBox {
  std::array<float, 3> lo, hi;
};

bool meet(const FloatBox& a, const FloatBox& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.hi[k] < b.lo[k] || b.hi[k] < a.lo[k]) return false;
  }
  return true;
}

/// The boxes of all triangles. Each vertex is rounded once for all triangles that use it.
std::vector<FloatBox> float_boxes(const Scene& scene, unsigned threads) {
  std::vector<FloatBox> points(scene.vertices.size());
  for_chunks(points.size(), threads, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (int k = 0; k < 3; ++k) {
        points[v].lo[k] = below(scene.vertices[v][k]);
        points[v].hi[k] = above(scene.vertices[v][k]);
      }
    }
  });
  std::vector<FloatBox> boxes(scene.triangles.size());
  for_chunks(boxes.size(), threads, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = scene.triangles[t];
      for (int k = 0; k < 3; ++k) {
        boxes[t].lo[k] = std::min({points[a].lo[k], points[b].lo[k], points[c].lo[k]});
        boxes[t].hi[k] = std::max({points[a].hi[k], points[b].hi[k], points[c].hi[k]});
      }
    }
  });
  return boxes;
}

void bounds(const RTCBoundsFunctionArguments* arguments) {
  const FloatBox& box = static_cast<const FloatBox*>(arguments->geometryUserPtr)[arguments->primID];
  *arguments->bounds_o = {box.lo[0], box.lo[1], box.lo[2], 0, box.hi[0], box.hi[1], box.hi[2], 0};
}

/// A device with two hierarchies. Each run builds them anew, in memory that is kept between runs.
class Embree {
 public:
  Embree(RTCBuildQuality quality, unsigned threads) : device_(new_device(threads)) {
    for (RTCScene& scene : scenes_) {
      scene = rtcNewScene(device_);
      rtcSetSceneBuildQuality(scene, quality);
      RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
      rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
      rtcSetGeometryBuildQuality(geometry, quality);
      rtcAttachGeometryByID(scene, geometry, 0);
      rtcReleaseGeometry(geometry);
    }
    require_no_error(device_);
  }
  ~Embree() {
    for (RTCScene scene : scenes_) rtcReleaseScene(scene);
    rtcReleaseDevice(device_);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  void build(int which, std::span<FloatBox> boxes) {
    RTCGeometry geometry = rtcGetGeometry(scenes_[which], 0);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.size()));
    rtcSetGeometryUserData(geometry, boxes.data());
    rtcCommitGeometry(geometry);
    rtcCommitScene(scenes_[which]);
    require_no_error(device_);
  }

  void collide(int first, int second, RTCCollideFunc collect, void* data) {
    rtcCollide(scenes_[first], scenes_[second], collect, data);
    require_no_error(device_);
  }

 private:
  RTCDevice device_;
  std::array<RTCScene, 2> scenes_{};
};

struct Found {
  const PeerScene& scene;
  const std::vector<FloatBox>& boxes;
  PeerCandidates& candidates;
  std::uint32_t second;  // added to the second hierarchy's numbers of primitives
};

/// Adds candidates. Embree calls this from any of its threads with all pairs of two leaves that
/// meet. A hierarchy with itself gives both orders of every pair whose boxes overlap.
void collect(void* data, RTCCollision* collisions, unsigned count) {
  const Found& found = *static_cast<const Found*>(data);
  PeerCandidates::Part& part = found.candidates.part();
  const bool two_sides = found.scene.two_sides;
  for (unsigned i = 0; i < count; ++i) {
    const std::uint32_t a = collisions[i].primID0;
    const std::uint32_t b = found.second + collisions[i].primID1;
    if (!two_sides && (a >= b || !found.scene.counts(a, b))) continue;
    if (meet(found.boxes[a], found.boxes[b])) part.add(a, b);
  }
}

BenchAnswer collide(Embree& embree, const Scene& raw, unsigned threads) {
  const Stopwatch building;
  const PeerScene scene(raw, false);
  std::vector<FloatBox> boxes = float_boxes(raw, threads);
  const std::span all(boxes);
  const bool any = scene.has_pairs();
  if (any && scene.two_sides) {
    embree.build(0, all.first(scene.second));
    embree.build(1, all.subspan(scene.second));
  } else if (any) {
    embree.build(0, all);
  }
  const double build_ms = building.ms();

  PeerCandidates candidates(raw, threads, threads > 1);
  Found found{scene, boxes, candidates, scene.second};
  if (any) embree.collide(0, scene.two_sides ? 1 : 0, collect, &found);
  BenchAnswer answer = candidates.finish();
  answer.build_ms = build_ms;
  return answer;
}

Peer peer(const std::string& name, RTCBuildQuality quality) {
  return {name, kLibrary, "",
          [quality](unsigned threads) -> BenchRun {
            const auto embree = std::make_shared<Embree>(quality, threads);
            return [=](const Scene& scene) { return collide(*embree, scene, threads); };
          },
          refuses_large};
}

// Distances, as Embree's documentation and its tutorial closest_point use rtcPointQuery: find the
// nearest point of the other object's triangles from each vertex of one object, and the reverse.
//
// Two triangles that are apart can be nearest at inner points of two edges, and the vertices of two
// triangles that cross are all apart from the other one. So, apart from rounding, the answer is an
// upper bound. It is the distance if one of the nearest points is a vertex.

constexpr float kInfinite = std::numeric_limits<float>::infinity();

struct Point {
  float x = 0, y = 0, z = 0;
};
Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator*(float s, const Point& a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
float distance(const Point& a, const Point& b) { return std::sqrt(dot(a - b, a - b)); }

/// The point of the triangle that is nearest to p, found by regions as in the tutorial: Ericson,
/// Real-Time Collision Detection (2005), section 5.1.5.
Point nearest_of(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a, ap = p - a;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Point bp = p - b;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const Point cp = p - c;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  const float whole = va + vb + vc;
  return a + (vb / whole) * ab + (vc / whole) * ac;
}

/// One object: its hierarchy, and its geometry in Embree's buffers. A triangle uses each vertex.
struct TreeOfObject {
  std::uint32_t number = 0;  // the object's number
  RTCScene scene = nullptr;
  const Point* points = nullptr;
  const std::array<unsigned, 3>* corners = nullptr;  // of each triangle
  std::size_t point_count = 0;
  std::array<float, 3> lo{kInfinite, kInfinite, kInfinite};
  std::array<float, 3> hi{-kInfinite, -kInfinite, -kInfinite};

  bool nearer(RTCPointQueryFunctionArguments* arguments) const {
    RTCPointQuery& query = *arguments->query;
    const auto& [a, b, c] = corners[arguments->primID];
    const Point from{query.x, query.y, query.z};
    const float found = distance(from, nearest_of(from, points[a], points[b], points[c]));
    if (!(found < query.radius)) return false;
    query.radius = found;  // nothing farther is visited
    return true;
  }
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
  return static_cast<const TreeOfObject*>(arguments->userPtr)->nearer(arguments);
}

/// The least distance of a vertex of `from` to `to` if it is below `most`; else `most`.
float from_vertices(const TreeOfObject& from, const TreeOfObject& to, float most) {
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  for (std::size_t i = 0; i < from.point_count && most > 0; ++i) {
    const auto& [x, y, z] = from.points[i];
    RTCPointQuery query{.x = x, .y = y, .z = z, .time = 0, .radius = most};
    rtcPointQuery(to.scene, &query, &context, visit, const_cast<TreeOfObject*>(&to));
    most = query.radius;
  }
  return most;
}

float bound_of(const TreeOfObject& a, const TreeOfObject& b, float most) {
  return from_vertices(b, a, from_vertices(a, b, most));
}

float gap(const TreeOfObject& a, const TreeOfObject& b) {
  float sum = 0;
  for (int k = 0; k < 3; ++k) {
    const float apart = std::max({a.lo[k] - b.hi[k], b.lo[k] - a.hi[k], 0.0F});
    sum += apart * apart;
  }
  return std::sqrt(sum);
}

/// The hierarchies of all objects that have triangles, and the device that holds them.
class Trees {
 public:
  Trees(const Scene& scene, unsigned threads) : device_(new_device(threads)) {
    for (const std::uint32_t o : objects_with_triangles(scene)) all_.push_back({.number = o});
    for_each_taken(all_.size(), 1, threads, [&](std::size_t i) { build(scene, all_[i]); });
    check();
  }
  ~Trees() {
    for (const TreeOfObject& tree : all_) rtcReleaseScene(tree.scene);
    rtcReleaseDevice(device_);
  }
  Trees(const Trees&) = delete;
  Trees& operator=(const Trees&) = delete;

  std::size_t size() const { return all_.size(); }
  const TreeOfObject& operator[](std::size_t i) const { return all_[i]; }

  void check() const { require_no_error(device_); }

 private:
  void build(const Scene& scene, TreeOfObject& out) const {
    const Object& object = scene.objects[out.number];
    std::vector<std::uint32_t> used;
    used.reserve(std::size_t{3} * object.triangle_count);
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      const auto& corners = scene.triangles[object.first_triangle + t];
      used.insert(used.end(), corners.begin(), corners.end());
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());

    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<Point*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Point), used.size()));
    auto* corners = static_cast<std::array<unsigned, 3>*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(std::array<unsigned, 3>), object.triangle_count));
    if (points == nullptr || corners == nullptr) {
      rtcReleaseGeometry(geometry);
      return;  // the error is reported by check()
    }
    for (std::size_t v = 0; v < used.size(); ++v) {
      const Vec3& at = scene.vertices[used[v]];
      points[v] = {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
      const std::array<float, 3> as_floats{points[v].x, points[v].y, points[v].z};
      for (int k = 0; k < 3; ++k) {
        out.lo[k] = std::min(out.lo[k], as_floats[k]);
        out.hi[k] = std::max(out.hi[k], as_floats[k]);
      }
    }
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      for (int k = 0; k < 3; ++k) {
        const auto at = std::lower_bound(used.begin(), used.end(),
                                         scene.triangles[object.first_triangle + t][k]);
        corners[t][k] = static_cast<unsigned>(at - used.begin());
      }
    }
    out.points = points;
    out.corners = corners;
    out.point_count = used.size();
    out.scene = rtcNewScene(device_);
    rtcSetSceneBuildQuality(out.scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(out.scene, geometry);
    rtcReleaseGeometry(geometry);  // the scene keeps the geometry and its buffers
    rtcCommitScene(out.scene);
  }

  RTCDevice device_;
  std::vector<TreeOfObject> all_;
};

/// The radius for a query that finds points at most `within` away. A query finds only points nearer
/// than its radius, so the radius is larger than `within`.
float radius_of(double within) {
  constexpr float kMost = std::numeric_limits<float>::max();
  if (!(within < static_cast<double>(kMost))) return kInfinite;
  return std::nextafter(static_cast<float>(within), kInfinite);
}

PeerDistances distances(const Scene& scene, const PeerQuestion& question, unsigned threads) {
  const Stopwatch building;
  const Trees trees(scene, threads);
  PeerDistances answer{.build_ms = building.ms()};
  const Stopwatch asking;
  const float most = radius_of(question.within);
  const auto found_within = [&](float found) {
    return found < most && found <= question.within ? static_cast<double>(found)
                                                    : std::numeric_limits<double>::infinity();
  };
  std::vector<std::uint32_t> numbers;
  for (std::size_t i = 0; i < trees.size(); ++i) numbers.push_back(trees[i].number);
  answer.distances = distances_of_trees(
      numbers, question.task, most, threads,
      [&](std::size_t i, std::size_t k) { return gap(trees[i], trees[k]); },
      [&](std::size_t i, std::size_t k, float least) {
        return bound_of(trees[i], trees[k], least);
      },
      found_within);
  trees.check();
  answer.query_ms = asking.ms();
  return answer;
}

/// Why distances cannot be asked for; empty if they can. nearest_of() divides by zero for a
/// degenerate triangle.
std::string refuses_distances(const Scene& scene) {
  const std::string large = refuses_large(scene);
  if (!large.empty()) return large;
  return refuse_degenerate(scene, "the nearest point of a degenerate triangle divides by zero");
}

}  // namespace

LibraryPeers embree_library() {
  return {.broad = {peer("embree-low", RTC_BUILD_QUALITY_LOW),
                    peer("embree-medium", RTC_BUILD_QUALITY_MEDIUM)},
          .distances = {{.name = "embree-points",
                         .library = kLibrary,
                         .comparable = false,
                         .run = distances,
                         .refuses = refuses_distances}}};
}

}  // namespace farcull
