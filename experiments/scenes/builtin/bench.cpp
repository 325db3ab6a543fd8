// Scenes for benchmarks: needles whose boxes overlap by the million, and a field of any size.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "experiments/scenes/builtin/field.h"
#include "experiments/scenes/builtin/generators.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {

using namespace shapes;

namespace {

constexpr double kLength = 4700;  // of a needle
constexpr double kWidth = 0.002;
constexpr double kBending = 1e-4;  // radians that a needle may differ from its direction
constexpr double kSpan = 24000;    // of a layer, across its needles
constexpr double kShear = 1;       // needles start the later the farther across they lie
constexpr double kGap = 1;         // between the two layers

// An orthonormal frame whose first axis is the direction of needles.
struct Frame {
  Vec3 along, across, up;
};

Frame frame_of(const Vec3& direction) {
  const Vec3 along = direction / direction.norm();
  const Vec3 across = along.cross(Vec3::UnitZ()).normalized();
  return {along, across, along.cross(across)};
}

// About the origin.
Corners hair(const Frame& frame, Random& random) {
  const Vec3 along = (frame.along + kBending * random.in_ball()).normalized();
  const Vec3 aside = across(along, kWidth, random);
  const Vec3 start = -kLength / 2 * along;
  const Vec3 end = kLength / 2 * along;
  return {start, end, start + random.between(0.2, 0.8) * (end - start) + aside};
}

// Somewhere in the layer of an object, a quarter of the gap thick.
Vec3 in_layer(const Frame& frame, int object, Random& random) {
  const double across = random.between(-kSpan / 2, kSpan / 2);
  const double height = kGap * (object + random.between(-0.125, 0.125));
  return across * (frame.across + kShear * frame.along) + height * frame.up;
}

// The needles of two objects take the frames in turn. One in eight of the second object is moved so
// that it crosses one of the first.
Scene layers_of_needles(const std::string& name, const std::vector<Frame>& frames,
                        std::array<std::uint32_t, 2> counts, std::uint64_t seed) {
  Random random(seed);
  const auto frame = [&](std::uint32_t i) -> const Frame& { return frames[i % frames.size()]; };
  std::array<std::vector<Corners>, 2> layers;
  for (std::uint32_t i = 0; i < counts[0]; ++i) {
    const Corners corners = hair(frame(i), random);
    layers[0].push_back(shifted(corners, in_layer(frame(i), 0, random)));
  }
  for (std::uint32_t i = 0; i < counts[1]; ++i) {
    const Corners corners = hair(frame(i), random);
    Vec3 to = in_layer(frame(i), 1, random);
    if (i % 8 == 0) {
      const Corners& crossed = layers[0][random.below(counts[0])];
      to = inner_point(crossed, random);
      to -= inner_point(corners, random);
    }
    layers[1].push_back(shifted(corners, to));
  }
  return two_objects(name, "first", soup(layers[0]), "second", soup(layers[1]));
}

Scene make_needles_layers(std::uint64_t seed) {
  return layers_of_needles("needles-layers", {frame_of({3, 2.6, 2.2})}, {20000, 12000}, seed);
}

Scene make_needles_crossed(std::uint64_t seed) {
  return layers_of_needles("needles-crossed", {frame_of({3, 2.6, 2.2}), frame_of({-2.3, 2.9, 1.7})},
                           {5000, 5000}, seed);
}

}  // namespace

std::vector<BuiltinScene> bench_scenes() {
  return {
      drawn({.name = "needles-layers",
             .description = "two layers of oblique needles, 4700 x 0.002: 44,946,746 boxes "
                            "overlap, 1501 collide",
             .objects = 2,
             .triangles = 32000,
             .costly = true},
            5, make_needles_layers),
      drawn({.name = "needles-crossed",
             .description = "the same in two oblique directions at once: 2,856,139 boxes overlap, "
                            "625 collide",
             .objects = 2,
             .triangles = 10000,
             .costly = true},
            6, make_needles_crossed),
      drawn({.name = "field",
             .description = "blobs spread evenly, some colliding with neighbours",
             .objects = 31,
             .triangles = 9920,
             .size = SceneSize{"triangles", 1000, 1'000'000'000, 10'000},
             .motion = "each object drifts by up to its diagonal and back"},
            7, make_field),
  };
}

}  // namespace farcull
