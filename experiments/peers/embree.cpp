// Embree as a broad phase: rtcCollide() searches hierarchies of user geometries. The boxes of the
// geometries are in float and are rounded outward.
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "experiments/peers/peer.h"

namespace farcull {
namespace {

constexpr const char* kLibrary = "Embree " RTC_VERSION_STRING;

/// Throws Error if a call of Embree failed since the last check.
void require_no_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw Error(kLibrary, "error " + std::to_string(error), "leave it out with --peers");
}

/// Returns why Embree cannot process the scene, or "" if it can. Embree silently leaves out
/// geometry with a coordinate of 1.844e18 or more.
std::string refuses_large(const Scene& scene) {
  for (const Vec3& p : scene.vertices) {
    if (p.cwiseAbs().maxCoeff() > 1e18) return "Embree leaves out coordinates beyond 1e18";
  }
  return "";
}

// For |x| < 2^127, these functions round x to the nearest float f, and move f outward by at least
// one ulp. This is more than the rounding error. For subnormal f, kTiny is at least one ulp.
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

/// Returns the boxes of all triangles. Rounds each vertex once.
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

/// An Embree device with two hierarchies. Each run rebuilds the hierarchies in the same memory.
class Embree {
 public:
  Embree(RTCBuildQuality quality, unsigned threads)
      : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
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
  std::uint32_t second;  // primitive i of the second hierarchy is triangle second + i
};

/// Adds candidates. Embree calls this function from any of its threads, with pairs of overlapping
/// leaves. For a hierarchy against itself, Embree gives every pair as (a, b) and as (b, a).
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
  return candidates.finish(build_ms);
}

Peer peer(const std::string& name, RTCBuildQuality quality) {
  return {name, kLibrary, "",
          [quality](unsigned threads) -> BenchRun {
            const auto embree = std::make_shared<Embree>(quality, threads);
            return [=](const Scene& scene) { return collide(*embree, scene, threads); };
          },
          refuses_large};
}

}  // namespace

LibraryPeers embree_library() {
  return {.broad = {peer("embree-low", RTC_BUILD_QUALITY_LOW),
                    peer("embree-medium", RTC_BUILD_QUALITY_MEDIUM)}};
}

}  // namespace farcull
