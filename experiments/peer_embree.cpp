// Embree's rtcCollide: hierarchies of user geometries, whose boxes in float are rounded outward.
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "core/error.h"
#include "experiments/peer_parts.h"

namespace farcull {
namespace {

constexpr const char* kLibrary = "Embree " RTC_VERSION_STRING;
struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
using Hierarchy = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;

void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw Error(kLibrary, "error " + std::to_string(error), "leave it out with --peers");
}

float below(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity())
                                    : f;
}
float above(double x) { return -below(-x); }

/// The triangles from first on, as boxes.
struct Side {
  const PeerScene* scene;
  std::uint32_t first;
  std::uint32_t count;
};

void bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& side = *static_cast<const Side*>(arguments->geometryUserPtr);
  const Box& box = side.scene->boxes[side.first + arguments->primID];
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = below(box.lo.x());
  out.lower_y = below(box.lo.y());
  out.lower_z = below(box.lo.z());
  out.upper_x = above(box.hi.x());
  out.upper_y = above(box.hi.y());
  out.upper_z = above(box.hi.z());
}

Hierarchy build(RTCDevice device, Side& side, RTCBuildQuality quality) {
  Hierarchy hierarchy(rtcNewScene(device));
  rtcSetSceneBuildQuality(hierarchy.get(), quality);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, side.count);
  rtcSetGeometryUserData(geometry, &side);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(hierarchy.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(hierarchy.get());
  check(device);
  return hierarchy;
}

struct Found {
  const PeerScene& scene;
  Candidates& candidates;
  std::uint32_t second;  // added to what the second hierarchy calls its primitives
};

/// Called from any of Embree's threads, with all pairs of two leaves that meet. A hierarchy with
/// itself gives both orders of every pair whose boxes overlap.
void collect(void* data, RTCCollision* collisions, unsigned count) {
  const Found& found = *static_cast<const Found*>(data);
  Candidates::Part& part = found.candidates.part();
  const bool two_sides = found.scene.two_sides;
  for (unsigned i = 0; i < count; ++i) {
    const std::uint32_t a = collisions[i].primID0;
    const std::uint32_t b = found.second + collisions[i].primID1;
    if (!two_sides && (a >= b || !found.scene.counts(a, b))) continue;
    if (overlap(found.scene.boxes[a], found.scene.boxes[b])) part.add(a, b);
  }
}

BenchAnswer collide(RTCDevice device, const Scene& raw, RTCBuildQuality quality, unsigned threads) {
  const Stopwatch building;
  const PeerScene scene(raw);
  const auto count = static_cast<std::uint32_t>(raw.triangles.size());
  const std::uint32_t second = scene.two_sides ? scene.second : 0;
  Side sides[2] = {{&scene, 0, scene.two_sides ? second : count}, {&scene, second, count - second}};
  Hierarchy first, other;
  if (scene.has_pairs()) first = build(device, sides[0], quality);
  if (scene.two_sides) other = build(device, sides[1], quality);
  const double build_ms = building.ms();

  Candidates candidates(raw, threads, threads > 1);
  Found found{scene, candidates, second};
  if (first) {
    rtcCollide(first.get(), scene.two_sides ? other.get() : first.get(), collect, &found);
    check(device);
  }
  BenchAnswer answer = candidates.finish();
  answer.build_ms = build_ms;
  return answer;
}

/// Embree leaves out, without a word, what has a coordinate of 1.844e18 or more.
std::string refuses_large(const Scene& scene) {
  for (const Vec3& p : scene.vertices) {
    if (p.cwiseAbs().maxCoeff() > 1e18) return "Embree leaves out coordinates beyond 1e18";
  }
  return "";
}

Peer peer(const std::string& name, RTCBuildQuality quality) {
  return {name, kLibrary, "",
          [quality](unsigned threads) -> BenchRun {
            const std::string config = "threads=" + std::to_string(threads);
            const std::shared_ptr<Device> device =
                std::make_shared<Device>(rtcNewDevice(config.c_str()));
            check(device->get());
            return
                [=](const Scene& scene) { return collide(device->get(), scene, quality, threads); };
          },
          refuses_large};
}

}  // namespace

std::vector<Peer> embree_peers() {
  return {peer("embree-low", RTC_BUILD_QUALITY_LOW),
          peer("embree-medium", RTC_BUILD_QUALITY_MEDIUM)};
}

}  // namespace farcull
