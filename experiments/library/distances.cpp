// Distances for users of the library: input is checked and copied into a scene, then asked about.
#include "experiments/method/distances.h"

#include <cmath>
#include <limits>
#include <utility>

#include "experiments/library/farcull.h"
#include "experiments/library/input.h"

namespace farcull {
namespace {

DistancePairs pairs_of(DistanceKind kind) {
  switch (kind) {
    case DistanceKind::objects:
      return DistancePairs::objects;
    case DistanceKind::nearest:
      return DistancePairs::nearest;
    case DistanceKind::all:
      return DistancePairs::all;
  }
  throw Error("kind", "is none", "give objects, nearest or all");
}

DistanceOptions checked(const DistanceFinderOptions& options) {
  DistanceOptions out{.pairs = pairs_of(options.kind),
                      .k = options.k,
                      .inside = options.inside,
                      .threads = options.threads};
  if (options.threads > kMostThreads)
    throw Error("threads", "are more than 1024", "give a number up to 1024, or 0");
  if (std::isnan(options.within))
    throw Error("within", "is no number", "give a distance, or a negative number for no limit");
  if (options.within >= 0) out.within = options.within;
  if (out.pairs == DistancePairs::all && !std::isfinite(out.within))
    throw Error("within", "is not finite, which pairs of all triangles need",
                "give a finite distance, 0 or more");
  if (out.pairs == DistancePairs::nearest && options.k == 0)
    throw Error("k", "is 0", "give 1 or more");
  return out;
}

DistanceInside given_out(WhichInside inside) {
  switch (inside) {
    case WhichInside::unknown:
      return DistanceInside::unknown;
    case WhichInside::none:
      return DistanceInside::none;
    case WhichInside::a:
      return DistanceInside::a;
    case WhichInside::b:
      return DistanceInside::b;
    case WhichInside::not_closed:
      return DistanceInside::not_closed;
  }
  return DistanceInside::unknown;
}

DistanceAnswer given_out(const Distance& d) {
  const auto point = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  return {.object_a = d.objects.a,
          .object_b = d.objects.b,
          .triangle_a = d.triangles.a,
          .triangle_b = d.triangles.b,
          .distance = d.closest.distance,
          .squared = d.closest.squared.text(),
          .point_a = point(d.closest.points[0]),
          .point_b = point(d.closest.points[1]),
          .feature_a = to_string(d.closest.features[0]),
          .feature_b = to_string(d.closest.features[1]),
          .inside = given_out(d.inside)};
}

}  // namespace

struct DistanceFinder::State {
  DistanceFinderOptions given;
  DistanceOptions options;
  Scene scene;  // of the last call
  DistanceMemory memory;
  std::atomic_flag used;

  explicit State(const DistanceFinderOptions& from) : given(from), options(checked(from)) {}
};

DistanceFinder::DistanceFinder(const DistanceFinderOptions& options)
    : state_(translated([&] { return std::make_unique<State>(options); })) {}
DistanceFinder::DistanceFinder() : DistanceFinder(DistanceFinderOptions{}) {}
DistanceFinder::~DistanceFinder() = default;
DistanceFinder::DistanceFinder(DistanceFinder&&) noexcept = default;
DistanceFinder& DistanceFinder::operator=(DistanceFinder&&) noexcept = default;

std::vector<DistanceAnswer> DistanceFinder::find(const ColliderInput& input) {
  return exclusive(state_, "DistanceFinder", [&](State& state) {
    take(input, state.given.self, state.given.self_objects, state.scene);
    std::vector<DistanceAnswer> out;
    if (!nothing_asked(state.scene, state.options).empty()) return out;
    const DistanceRecord record = distances(state.scene, state.options, {}, &state.memory);
    out.reserve(record.distances.size());
    for (const Distance& d : record.distances) out.push_back(given_out(d));
    return out;
  });
}

std::vector<DistanceAnswer> distances(const ColliderInput& input,
                                      const DistanceFinderOptions& options) {
  return DistanceFinder(options).find(input);
}

}  // namespace farcull
