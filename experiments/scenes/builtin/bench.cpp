// Scenes for benchmarks: a field of any size, and needles whose boxes overlap by the million.
// Blobs of the field are drawn one after the other, so a part of it needs nothing of those before
// it but the state of the random numbers.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "experiments/scenes/builtin/generators.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {

using namespace shapes;

namespace {

// ---- the field ----

constexpr std::uint64_t kFieldBlob = 320;  // triangles of one blob
constexpr double kSpacing = 1.8;           // of the cells, a blob in each
constexpr double kJitter = 0.3;            // of a blob in its cell, along each axis
constexpr std::size_t kShapes = 16;
constexpr std::uint64_t kPartBlobs = 256;  // of one part

// Blobs of kFieldBlob triangles, as near as their number comes, at least one.
class Blobs {
 public:
  Blobs(std::uint64_t triangles, std::uint64_t seed)
      : random_(seed),
        count_(std::max<std::uint64_t>(1, (triangles + kFieldBlob / 2) / kFieldBlob)) {
    for (std::size_t i = 0; i < kShapes; ++i) shapes_.push_back(blob(2, random_));
    while (cells_ * cells_ * cells_ < count_) ++cells_;
  }
  std::uint64_t left() const { return count_ - next_; }

  // Precondition: count <= left().
  void append(std::uint64_t count, Scene& scene) {
    scene.objects.reserve(scene.objects.size() + count);
    scene.vertices.reserve(scene.vertices.size() + count * shapes_[0].vertices.size());
    scene.triangles.reserve(scene.triangles.size() + count * shapes_[0].triangles.size());
    scene.source_face.reserve(scene.triangles.capacity());
    for (const std::uint64_t end = next_ + count; next_ < end; ++next_) append_next(scene);
  }

 private:
  void append_next(Scene& scene) {
    const std::uint64_t i = next_;
    const Vec3 cell(static_cast<double>(i % cells_), static_cast<double>(i / cells_ % cells_),
                    static_cast<double>(i / cells_ / cells_));
    Placement placement = random_.anywhere(kSpacing * cell + random_.in_cube(kJitter));
    placement.scale = Vec3::Constant(random_.between(0.5, 1));
    const Mesh& shape = shapes_[random_.below(kShapes)];
    append_object("blob" + std::to_string(i), place(shape.vertices, placement), shape.triangles,
                  shape.source_face, scene);
  }

  Random random_;
  std::vector<Mesh> shapes_;
  std::uint64_t count_, next_ = 0;
  std::uint64_t cells_ = 1;  // along each axis of the cube that the blobs fill from below
};

// ---- needles ----

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

BuiltScene make_field(const SceneParameters& parameters, std::uint64_t seed) {
  Blobs blobs(parameters.size, seed);
  Scene scene;
  scene.name = "field";
  blobs.append(blobs.left(), scene);
  validate(scene, scene.name);
  const Motion motion = drift(scene);
  return {std::move(scene), motion};
}

}  // namespace

void stream_field(const SceneParameters& parameters, std::uint64_t seed, const std::string& name,
                  const std::function<void(Scene& part)>& take) {
  for (Blobs blobs(parameters.size, seed); blobs.left() > 0;) {
    Scene part;
    part.name = name;
    blobs.append(std::min(kPartBlobs, blobs.left()), part);
    take(part);
  }
}

std::vector<BuiltinScene> bench_scenes() {
  return {
      drawn({.name = "needles-layers",
             .description = "two layers of oblique needles, 4700 x 0.002: 44,946,746 boxes "
                            "overlap, 1501 collide",
             .objects = 2,
             .triangles = 32000,
             .costly = true},
            5,
            [](std::uint64_t seed) {
              return layers_of_needles("needles-layers", {frame_of({3, 2.6, 2.2})}, {20000, 12000},
                                       seed);
            }),
      drawn({.name = "needles-crossed",
             .description = "the same in two oblique directions at once: 2,856,139 boxes overlap, "
                            "625 collide",
             .objects = 2,
             .triangles = 10000,
             .costly = true},
            6,
            [](std::uint64_t seed) {
              return layers_of_needles("needles-crossed",
                                       {frame_of({3, 2.6, 2.2}), frame_of({-2.3, 2.9, 1.7})},
                                       {5000, 5000}, seed);
            }),
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
