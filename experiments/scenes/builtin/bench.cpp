// Scenes for benchmarks: a field of any number of blobs, needles with millions of overlapping
// boxes, and scenes with an extreme aspect ratio, gap or ratio of sizes.
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

using namespace shapes;

namespace {

constexpr std::uint64_t kFieldBlob = 320;  // number of triangles of a blob
constexpr double kSpacing = 1.8;           // side of a cubic cell; each cell has one blob
constexpr double kJitter = 0.3;            // largest shift of a blob along each axis
constexpr std::size_t kShapes = 16;
constexpr std::uint64_t kPartBlobs = 256;  // number of blobs of a part

// Makes the blobs of a field one after the other. The number of blobs is at least 1, and gives the
// number of triangles that is nearest to the wanted number.
class Blobs {
 public:
  Blobs(std::uint64_t triangles, std::uint64_t seed)
      : random_(seed),
        count_(std::max<std::uint64_t>(1, (triangles + kFieldBlob / 2) / kFieldBlob)) {
    for (std::size_t i = 0; i < kShapes; ++i) shapes_.push_back(blob(2, random_));
    while (cells_ * cells_ * cells_ < count_) ++cells_;
  }
  std::uint64_t left() const { return count_ - next_; }

  // Appends the next `count` blobs. Precondition: count <= left().
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
  std::uint64_t cells_ = 1;  // number of cells along each axis of the cube that the blobs fill
};

constexpr double kLength = 4700;  // length of a needle
constexpr double kWidth = 0.002;
constexpr double kBending = 1e-4;  // largest angle between a needle and Frame::along, in radians
constexpr double kSpan = 24000;    // extent of a layer perpendicular to its needles
constexpr double kShear = 1;       // shift along the needles per unit of shift across them
constexpr double kGap = 1;         // distance of the two layers

// An orthonormal frame. The first axis is the direction of needles.
struct Frame {
  Vec3 along, across, up;
};

Frame frame_of(const Vec3& direction) {
  const Vec3 along = direction / direction.norm();
  const Vec3 across = along.cross(Vec3::UnitZ()).normalized();
  return {along, across, along.cross(across)};
}

Corners hair(const Frame& frame, Random& random) {
  const Vec3 along = (frame.along + kBending * random.in_ball()).normalized();
  const Vec3 aside = across(along, kWidth, random);
  const Vec3 start = -kLength / 2 * along;
  const Vec3 end = kLength / 2 * along;
  return {start, end, start + random.between(0.2, 0.8) * (end - start) + aside};
}

// Returns a random position in the layer of an object. A layer's thickness is a quarter of kGap.
Vec3 in_layer(const Frame& frame, int object, Random& random) {
  const double across = random.between(-kSpan / 2, kSpan / 2);
  const double height = kGap * (object + random.between(-0.125, 0.125));
  return across * (frame.across + kShear * frame.along) + height * frame.up;
}

// Makes two layers of needles, one per object. Needle i of a layer has frame i modulo the number of
// frames. Every eighth needle of the second layer crosses a needle of the first layer.
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

// Returns a random unit vector perpendicular to `along`.
Vec3 across(const Vec3& along, Random& random) {
  for (;;) {
    const Vec3 out = along.cross(random.direction());
    if (out.norm() > 0.1) return out / out.norm();
  }
}

// Returns a triangle with a random orientation. Its longest side is 1, and its height over this
// side is 1 / aspect.
Corners sliver(double aspect, Random& random) {
  const Vec3 along = random.direction();
  const Vec3 start = -0.5 * along;
  return {start, start + along,
          start + random.between(0.3, 0.7) * along + across(along, random) / aspect};
}

Corners equilateral(double side, Random& random) {
  const Vec3 along = random.direction();
  const Vec3 other = across(along, random);
  const double high = side * std::sqrt(0.75);
  return {-0.5 * side * along - high / 3 * other, 0.5 * side * along - high / 3 * other,
          2 * high / 3 * other};
}

Vec3 normal_of(const Corners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
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
      entry(
          "needles-layers", 5,
          [](std::uint64_t seed) {
            return layers_of_needles("needles-layers", {frame_of({3, 2.6, 2.2})}, {20000, 12000},
                                     seed);
          },
          "two layers of oblique needles, 4700 x 0.002: 44,946,746 boxes overlap, 1501 collide", 2,
          32000, "", {}, {}, kCostly),
      entry(
          "needles-crossed", 6,
          [](std::uint64_t seed) {
            return layers_of_needles("needles-crossed",
                                     {frame_of({3, 2.6, 2.2}), frame_of({-2.3, 2.9, 1.7})},
                                     {5000, 5000}, seed);
          },
          "the same in two oblique directions at once: 2,856,139 boxes overlap, 625 collide", 2,
          10000, "", {}, {}, kCostly),
      entry("field", 7, make_field, "blobs spread evenly, some colliding with neighbours", 31, 9920,
            "each object drifts by up to its diagonal and back",
            {"triangles", 1000, 1'000'000'000, 10'000}),
  };
}

BuiltScene make_slivers(const SceneParameters& parameters, std::uint64_t seed) {
  const double aspect = parameters.second;
  Random random(seed);
  std::vector<Corners> first, second;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    first.push_back(shifted(sliver(aspect, random), random.in_cube(1)));
    // Moves each new sliver so that it crosses the first object's last sliver. Then moves every
    // fourth new sliver by twice the height of a sliver in a random direction.
    const Corners other = sliver(aspect, random);
    const Vec3 from = inner_point(other, random);
    Vec3 to = inner_point(first.back(), random);
    if (i % 4 == 3) to += 2 / aspect * random.direction();
    second.push_back(shifted(other, to - from));
  }
  return {two_objects("slivers", "first", soup(first), "second", soup(second)), {}};
}

BuiltScene make_mixed(const SceneParameters& parameters, std::uint64_t seed) {
  const double small = 1 / parameters.second;
  Random random(seed);
  std::vector<Corners> large, little;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    large.push_back(shifted(equilateral(1, random), random.in_cube(1)));
    // Each large triangle gets eight small triangles. Four small triangles cross the large
    // triangle. The other four are at a distance of about twice their side from the large triangle.
    for (int k = 0; k < 8; ++k) {
      Vec3 at = inner_point(large.back(), random);
      if (k % 2 == 1) at += 2 * small * normal_of(large.back());
      little.push_back(shifted(equilateral(small, random), at));
    }
  }
  return {two_objects("mixed", "large", soup(large), "small", soup(little)), {}};
}

// Sheets without tilt have the slope z = x/4 + y/8. Heights and tilts are multiples of gap/8. The
// gap is a power of two from 2^-47 to 2^-3. So with up to 2^10 sheets every sum is exact.
BuiltScene make_stack(const SceneParameters& parameters) {
  const double gap = stack_gap(parameters.second);
  constexpr std::uint32_t kCells = 8;  // cells along a side of a sheet
  const Mesh shape = grid(kCells);
  SceneBuilder scene("stack", "stack");
  for (std::uint64_t s = 0; s < parameters.size; ++s) {
    const bool crosses = s % 4 == 3;
    Mesh placed = shape;
    for (Vec3& p : placed.vertices) {
      const double tilt = crosses ? 1.5 * (1 - 2 * p.x()) : 0;
      p.z() = (0.25 * p.x() + 0.125 * p.y()) + (static_cast<double>(s) + tilt) * gap;
    }
    scene.add(placed, (crosses ? "crossing" : "sheet") + std::to_string(s));
  }
  return {scene.finish(), {}};
}

double stack_gap(double wanted) { return std::exp2(std::round(std::log2(wanted))); }

// All coordinates are multiples of 2^-53 in [1/2, 1). The ulp there is 2^-53, so each is exact.
BuiltScene make_gap(const SceneParameters& parameters) {
  const double gap = std::nearbyint(parameters.second) * 0x1p-53;
  std::uint64_t side = 1;
  while (side * side * side < parameters.size) ++side;
  const double cell = 0.5 / static_cast<double>(std::bit_ceil(side));
  std::vector<Corners> lower, upper;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    const Vec3 corner = Vec3::Constant(0.5) + cell * Vec3(static_cast<double>(i % side),
                                                          static_cast<double>(i / side % side),
                                                          static_cast<double>(i / side / side));
    // Returns a point of the cell. u and v count eighths of the cell along two axes. `rise` counts
    // quarters of the cell along the third axis, and `by` is added. In views along an axis, a
    // triangle that is edge-on would cover no pixel. The slope u / 32 + v / 64 avoids this.
    const auto axis = static_cast<int>(i % 3);
    const auto at = [&](double u, double v, double rise, double by) {
      Vec3 p = corner;
      p[(axis + 1) % 3] += u / 8 * cell;
      p[(axis + 2) % 3] += v / 8 * cell;
      p[axis] += (0.375 + rise / 4 + u / 32 + v / 64) * cell + by;
      return p;
    };
    if (i / 3 % 2 == 0) {  // a vertex over a face
      lower.push_back({at(1, 1, 0, 0), at(7, 1, 0, 0), at(1, 7, 0, 0)});
      upper.push_back({at(3, 3, 0, gap), at(6, 1, 1, gap), at(1, 6, 1, gap)});
    } else {  // an edge over an edge
      lower.push_back({at(1, 4, 0, 0), at(7, 4, 0, 0), at(4, 4, -1, 0)});
      upper.push_back({at(4, 1, 0, gap), at(4, 7, 0, gap), at(4, 4, 1, gap)});
    }
  }
  return {two_objects("gap", "lower", soup(lower), "upper", soup(upper)), {}};
}

std::vector<BuiltinScene> extreme_scenes() {
  return {
      entry("slivers", 14, make_slivers, "slivers of one aspect, most crossing another one", 2, 400,
            "", {"slivers in each object", 1, 100'000, 200},
            {"aspect, longest side over height", 2, 1e12, 1e6}),
      entry("stack", 0, make_stack,
            "parallel sheets closely above each other, every fourth crossing its neighbours at an "
            "angle as small",
            16, 2048, "", {"sheets", 2, 1000, 16},
            {"distance of neighbours in their widths", 1e-14, 0.1, 1e-9}),
      entry("mixed", 15, make_mixed,
            "large triangles, each with small ones that pierce it or do not", 2, 450, "",
            {"large triangles", 1, 10'000, 50}, {"ratio of their sides", 1, 1e12, 1e6}),
      entry("gap", 0, make_gap, "vertices above faces and edges above edges by a number of ulps", 2,
            432, "", {"pairs", 1, 4096, 216},
            {"number of ulps; 0: they touch, below: they cross", -1e13, 1e13, 1}),
  };
}

}  // namespace farcull
