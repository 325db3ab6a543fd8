// Scenes made of the meshes that experiments/meshes.sh unpacks.
#include "experiments/scenes/builtin/packaged.h"

#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"
#include "experiments/scenes/builtin/generators.h"
#include "experiments/scenes/builtin/motion.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {
namespace {

constexpr const char* kArmadillo = "armadillo.off";
constexpr const char* kElephant = "refined_elephant.off";
constexpr const char* kMannequin = "mannequin-devil.off";

// The second mesh scaled to the diagonal of the first and moved so that their boxes have one
// centre.
Placement onto(const Mesh& first, const Mesh& second) {
  const double scale = diagonal(bounds(first)) / diagonal(bounds(second));
  return {.scale = Vec3(Vec3::Constant(scale)),
          .rotate = {},
          .translate = Vec3(centre(bounds(first)) - scale * centre(bounds(second)))};
}

Scene make_two_bunnies() {
  const Mesh bunny = packaged(kBunny);
  const Box box = bounds(bunny);
  const double half_extent = (box.hi.x() - box.lo.x()) / 2;
  return two_objects("two-bunnies", "first", bunny, "second", bunny,
                     {.scale = {},
                      .rotate = Placement::Rotation{Vec3(0, 0, 1), 0.7},
                      .translate = Vec3(half_extent * Vec3(0.02, 0.0026, 0.0014))});
}

Scene make_armadillo_elephant() {
  const Mesh armadillo = packaged(kArmadillo);
  const Mesh elephant = packaged(kElephant);
  return two_objects("armadillo-elephant", "armadillo", armadillo, "elephant", elephant,
                     onto(armadillo, elephant));
}

Scene make_dragon_bunny() {
  const Mesh dragon = packaged(kDragon);
  const Mesh bunny = packaged(kBunny);
  return two_objects("dragon-bunny", "dragon", dragon, "bunny", bunny, onto(dragon, bunny));
}

// A mesh and its copy, moved by so many diagonals along (2, 3, 6), a direction of no axis whose
// length is 7.
Scene with_copy(const std::string& name, const char* file, const char* first, const char* second,
                double diagonals) {
  const Mesh mesh = packaged(file);
  const Vec3 step = diagonals * diagonal(bounds(mesh)) / 7 * Vec3(2, 3, 6);
  return two_objects(name, first, mesh, second, mesh,
                     {.scale = {}, .rotate = {}, .translate = step});
}

Scene make_near_copy() { return with_copy("near-copy", kArmadillo, "armadillo", "copy", 1e-9); }
Scene make_bunnies_far_apart() {
  return with_copy("bunnies-far-apart", kBunny, "first", "second", 10);
}

Scene self_colliding(const std::string& name, const char* file) {
  SceneBuilder builder(name, name);
  builder.add(packaged(file), name, Split::kNone, {});
  Scene scene = builder.finish();
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

Scene make_mannequin_devil() { return self_colliding("mannequin-devil", kMannequin); }
Scene make_armadillo() { return self_colliding("armadillo", kArmadillo); }
Scene make_bunny() { return self_colliding("bunny", kBunny); }

}  // namespace

std::string mesh_folder() {
  const char* const folder = std::getenv("FARCULL_MESHES");
  return folder != nullptr && *folder != '\0' ? folder : FARCULL_MESH_DIR;
}

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

std::vector<BuiltinScene> packaged_scenes() {
  return {
      made({.name = "two-bunnies",
            .description = "two interpenetrating Stanford bunnies",
            .objects = 2,
            .triangles = 150816,
            .needs_meshes = true,
            .motion = "one passes through the other"},
           make_two_bunnies, pass_through),
      made({.name = "armadillo-elephant",
            .description = "armadillo and elephant of one size in one place",
            .objects = 2,
            .triangles = 140928,
            .needs_meshes = true},
           make_armadillo_elephant),
      made({.name = "dragon-bunny",
            .description = "dragon and bunny of one size in one place",
            .objects = 2,
            .triangles = 95402,
            .needs_meshes = true},
           make_dragon_bunny),
      made({.name = "near-copy",
            .description = "armadillo and its copy moved by 1e-9 of its diagonal",
            .objects = 2,
            .triangles = 104000,
            .needs_meshes = true},
           make_near_copy),
      made({.name = "bunnies-far-apart",
            .description = "two bunnies ten diagonals from each other",
            .objects = 2,
            .triangles = 150816,
            .needs_meshes = true},
           make_bunnies_far_apart),
      made({.name = "mannequin-devil",
            .description =
                "a mannequin with horns; inside it 1,643 pairs = 1,581 + 62 of neighbours collide",
            .objects = 1,
            .triangles = 25888,
            .needs_meshes = true},
           make_mannequin_devil),
      made({.name = "armadillo",
            .description = "the armadillo against itself, where nothing collides",
            .objects = 1,
            .triangles = 52000,
            .needs_meshes = true},
           make_armadillo),
      made({.name = "bunny",
            .description = "the Stanford bunny against itself, where nothing collides",
            .objects = 1,
            .triangles = 75408,
            .needs_meshes = true},
           make_bunny),
  };
}

}  // namespace farcull
