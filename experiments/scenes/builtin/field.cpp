// Blobs are drawn one after the other, so a part of the scene needs nothing of those before it but
// the state of the random numbers.
#include "experiments/scenes/builtin/field.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "experiments/scenes/builtin/motion.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {
namespace {

using namespace shapes;

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
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    const std::vector<Vec3> placed = place(shape.vertices, placement);
    scene.objects.push_back({"blob" + std::to_string(i),
                             static_cast<std::uint32_t>(scene.triangles.size()),
                             static_cast<std::uint32_t>(shape.triangles.size())});
    scene.vertices.insert(scene.vertices.end(), placed.begin(), placed.end());
    for (const auto& [a, b, c] : shape.triangles)
      scene.triangles.push_back({first + a, first + b, first + c});
    scene.source_face.insert(scene.source_face.end(), shape.source_face.begin(),
                             shape.source_face.end());
  }

  Random random_;
  std::vector<Mesh> shapes_;
  std::uint64_t count_, next_ = 0;
  std::uint64_t cells_ = 1;  // along each axis of the cube that the blobs fill from below
};

}  // namespace

BuiltScene make_field(const SceneParameters& parameters, std::uint64_t seed) {
  Blobs blobs(parameters.size, seed);
  Scene scene;
  scene.name = "field";
  blobs.append(blobs.left(), scene);
  validate(scene, scene.name);
  const Motion motion = drift(scene);
  return {std::move(scene), motion};
}

void stream_field(const SceneParameters& parameters, std::uint64_t seed, const std::string& name,
                  const std::function<void(Scene& part)>& take) {
  for (Blobs blobs(parameters.size, seed); blobs.left() > 0;) {
    Scene part;
    part.name = name;
    blobs.append(std::min(kPartBlobs, blobs.left()), part);
    take(part);
  }
}

}  // namespace farcull
