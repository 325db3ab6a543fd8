// Scenes made of the meshes that experiments/meshes.sh unpacks.
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "experiments/builtin_parts.h"
#include "experiments/builtin_scenes.h"
#include "experiments/scene_build.h"

namespace farcull {
namespace {

constexpr const char* kArmadillo = "armadillo.off";
constexpr const char* kElephant = "refined_elephant.off";
constexpr const char* kMannequin = "mannequin-devil.off";

Vec3 centre(const Box& box) { return box.lo + (box.hi - box.lo) / 2; }

// The second mesh scaled to the diagonal of the first and moved so that their boxes have one
// centre.
Placement onto(const Mesh& first, const Mesh& second) {
  const double scale = diagonal(bounds(first)) / diagonal(bounds(second));
  return {.scale = Vec3(Vec3::Constant(scale)),
          .rotate = {},
          .translate = Vec3(centre(bounds(first)) - scale * centre(bounds(second)))};
}

Scene self_colliding(const std::string& name, const char* file) {
  SceneBuilder builder(name, name);
  builder.add(packaged(file), name, Split::kNone, {});
  Scene scene = builder.finish();
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

}  // namespace

Mesh packaged(const char* file) {
  const std::string path = (std::filesystem::path(mesh_folder()) / file).string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw Error(
        path, "the packaged mesh is not there",
        "run bash experiments/meshes.sh, or set FARCULL_MESHES to the folder that holds it");
  }
  return load_mesh(path);
}

Scene make_two_bunnies() {
  const Mesh bunny = packaged(kBunny);
  const Box box = bounds(bunny);
  const double half_extent = (box.hi.x() - box.lo.x()) / 2;
  SceneBuilder scene("two-bunnies", "two-bunnies");
  scene.add(bunny, "first", Split::kNone, {});
  scene.add(bunny, "second", Split::kNone,
            {.scale = {},
             .rotate = Placement::Rotation{Vec3(0, 0, 1), 0.7},
             .translate = Vec3(half_extent * Vec3(0.02, 0.0026, 0.0014))});
  return scene.finish();
}

Scene make_armadillo_elephant() {
  const Mesh armadillo = packaged(kArmadillo);
  const Mesh elephant = packaged(kElephant);
  SceneBuilder scene("armadillo-elephant", "armadillo-elephant");
  scene.add(armadillo, "armadillo", Split::kNone, {});
  scene.add(elephant, "elephant", Split::kNone, onto(armadillo, elephant));
  return scene.finish();
}

Scene make_dragon_bunny() {
  const Mesh dragon = packaged(kDragon);
  const Mesh bunny = packaged(kBunny);
  SceneBuilder scene("dragon-bunny", "dragon-bunny");
  scene.add(dragon, "dragon", Split::kNone, {});
  scene.add(bunny, "bunny", Split::kNone, onto(dragon, bunny));
  return scene.finish();
}

Scene make_near_copy() {
  const Mesh armadillo = packaged(kArmadillo);
  // (2, 3, 6) / 7 has length 1 and lies along no axis.
  const Vec3 step = 1e-9 * diagonal(bounds(armadillo)) / 7 * Vec3(2, 3, 6);
  SceneBuilder scene("near-copy", "near-copy");
  scene.add(armadillo, "armadillo", Split::kNone, {});
  scene.add(armadillo, "copy", Split::kNone, {.scale = {}, .rotate = {}, .translate = step});
  return scene.finish();
}

Scene make_bunnies_far_apart() {
  const Mesh bunny = packaged(kBunny);
  const Vec3 step = 10 * diagonal(bounds(bunny)) / 7 * Vec3(2, 3, 6);
  SceneBuilder scene("bunnies-far-apart", "bunnies-far-apart");
  scene.add(bunny, "first", Split::kNone, {});
  scene.add(bunny, "second", Split::kNone, {.scale = {}, .rotate = {}, .translate = step});
  return scene.finish();
}

Scene make_mannequin_devil() { return self_colliding("mannequin-devil", kMannequin); }
Scene make_armadillo() { return self_colliding("armadillo", kArmadillo); }
Scene make_bunny() { return self_colliding("bunny", kBunny); }

}  // namespace farcull
