// The scenes of points: read by name, moved to a frame, or made here.
#include <fmt/format.h>

#include <cstdlib>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/cloth/cloth.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"
#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"

namespace farcull {
namespace {

// Two objects of segments, each of the one crossed by one of the other at 45 degrees, within 2^-10
// px of a corner of a pixel in the view z at this resolution: both boxes are as many units wide as
// the window has pixels, so that a unit is a pixel and corners are whole numbers (core/view/view.h,
// fit_window).
constexpr const char* kCorners = "pixel-corners";
constexpr int kCornersResolution = 96;

Scene pixel_corners() {
  using shapes::Corners;
  constexpr int kHalf = kCornersResolution / 2;
  constexpr double kReach = 0x1p-12;
  shapes::Random random(16);
  std::vector<Corners> one, other;
  for (int y = 3 - kHalf; y <= kHalf - 3; y += 3) {
    for (int x = 3 - kHalf; x <= kHalf - 3; x += 3) {
      const auto near = [&random] {
        return (static_cast<double>(random.below(33)) - 16) * 0x1p-14;
      };
      const double dx = near(), dy = near();
      const Vec3 q(x + dx, y + dy, static_cast<double>(random.below(64)));
      const Vec3 up(kReach, kReach, 0), down(kReach, -kReach, 0);
      one.push_back({q - up, q + up, q + up});
      other.push_back({q - down, q + down, q + down});
    }
  }
  for (const double at : {-1.0, 1.0}) {  // points: they make the boxes as large, and touch
    const Vec3 p(at * kHalf, at * kHalf, 64);
    for (auto* list : {&one, &other}) list->push_back({p, p, p});
  }
  SceneBuilder scene(kCorners, kCorners);
  scene.add(shapes::soup(one), "rising", Split::kNone, {});
  scene.add(shapes::soup(other), "falling", Split::kNone, {});
  return scene.finish();
}

// Two hundred objects of one to four triangles in a cube of side 1: ten clusters of twenty objects,
// each in a cube whose side is 1 / ratio, anywhere. Two objects of one triangle lie in opposite
// corners of the large cube, so that a grid covers all of it.
Scene clusters(const ClusteredScene& wanted) {
  using shapes::Corners;
  constexpr int kClusters = 10, kObjects = 20;
  shapes::Random random(wanted.seed);
  const double side = 1.0 / wanted.ratio;
  const auto drawn = [&random](double from, double to) -> Vec3 {
    return Vec3::Constant((from + to) / 2) + random.in_cube((to - from) / 2);
  };
  SceneBuilder scene("clusters", "clusters");
  int objects = 0;
  const auto add = [&](const std::vector<Corners>& triangles) {
    scene.add(shapes::soup(triangles), fmt::format("object{}", objects++), Split::kNone, {});
  };
  for (int cluster = 0; cluster < kClusters; ++cluster) {
    const Vec3 corner = drawn(0, 1 - side);
    for (int object = 0; object < kObjects; ++object) {
      // An object fills a part of the cluster, so that most do not meet.
      const Vec3 at = corner + drawn(0, 0.9 * side);
      std::vector<Corners> triangles(1 + random.below(4));
      for (Corners& triangle : triangles) {
        for (Vec3& p : triangle) p = at + drawn(0, 0.1 * side);
      }
      add(triangles);
    }
  }
  for (const double at : {0.0, 1.0}) {
    const double inside = at == 0 ? 0x1p-20 : 1 - 0x1p-20;
    add({{Vec3::Constant(at), Vec3(inside, at, at), Vec3(at, inside, at)}});
  }
  return scene.finish();
}

Scene changed(const ChangedScene& scene) {
  const double by = std::strtod(fmt::format("1e{}", scene.power).c_str(), nullptr);
  const Scene plain = make_builtin_scene(scene.name);
  return scene.change == ChangedScene::Change::offset ? transformed(plain, 1, Vec3::Constant(by))
                                                      : transformed(plain, by, Vec3::Zero());
}

Scene cloth_apart(const ClothApart& wanted) {
  const SceneRequest request = parse_scene_name(wanted.name);
  ClothSettings settings;
  settings.triangles = request.parameters.size;
  settings.stiffness = request.parameters.second;
  Cloth cloth(settings);
  for (long i = 0; i < wanted.frame; ++i) cloth.step();
  Scene scene = cloth.scene();
  for (Object& object : scene.objects) object.self = false;
  return scene;
}

}  // namespace

const Scene& open_scene(const PointScene& scene, Lab& lab) {
  if (const auto* of = std::get_if<NamedScene>(&scene)) return lab.scene(of->name);
  if (const auto* of = std::get_if<MotionFrame>(&scene))
    return lab.scene(of->name, of->frame, of->frames);
  const PointKey key = key_of(RunPoint{.scene = scene});
  if (const auto* of = std::get_if<ChangedScene>(&scene))
    return lab.scene(key.scene, [&] { return changed(*of); });
  if (const auto* of = std::get_if<ClothApart>(&scene)) {
    return lab.scene(fmt::format("{} frame {}", key.scene, key.frame),
                     [&] { return cloth_apart(*of); });
  }
  if (const auto* of = std::get_if<ClusteredScene>(&scene))
    return lab.scene(key.scene, [&] { return clusters(*of); });
  return lab.scene(key.scene, pixel_corners);
}

}  // namespace farcull
