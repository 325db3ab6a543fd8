// Puts together the entries of built-in scenes, and moves objects as they are: each motion keeps
// the vertices at rest and writes those of an instant.
#include "experiments/scenes/builtin/scenes.h"

#include <cmath>
#include <memory>

#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

Scene two_objects(const std::string& name, const char* first, const Mesh& one, const char* second,
                  const Mesh& other, const Placement& placement) {
  SceneBuilder scene(name, name);
  scene.add(one, first);
  scene.add(other, second, Split::kNone, placement);
  return scene.finish();
}

BuiltScene halfway(BuiltScene built) {
  FrameNotes none;
  built.motion({.frame = 0, .time = 0.5}, built.scene, none);
  return built;
}

SceneMaker moved(Scene (*make)(), Motion (*motion)(const Scene&)) {
  return [make, motion](const SceneParameters&) {
    BuiltScene built{make(), {}};
    built.motion = motion(built.scene);
    return built;
  };
}

BuiltinScene entry(const char* name, std::uint64_t seed, const SceneMaker& make,
                   const char* description, std::uint32_t objects, std::uint32_t triangles,
                   const char* motion, const SceneSize& size, const SceneSecond& second,
                   bool costly, bool topology_changes) {
  BuiltinScene out{name, description, objects, triangles, motion};
  if (size.most > 0) out.size = size;
  if (!second.what.empty()) out.second = second;
  out.costly = costly;
  out.topology_changes = topology_changes;
  if (seed > 0) out.seed = seed;
  out.build = [make, seed](const SceneParameters& p) { return make(p, p.seed.value_or(seed)); };
  return out;
}

namespace {

constexpr std::uint64_t kDriftSeed = 8;

struct Part {
  Box box;
  std::vector<std::uint32_t> vertices;  // each once
};

// The scene without frames and its objects.
struct Rest {
  std::vector<Vec3> vertices;
  std::vector<Part> parts;
};

std::shared_ptr<const Rest> rest_of(const Scene& scene) {
  auto rest = std::make_shared<Rest>();
  rest->vertices = scene.vertices;
  std::vector<std::uint8_t> seen(scene.vertices.size(), 0);
  for (const Object& object : scene.objects) {
    Part& part = rest->parts.emplace_back();
    part.box = Box::empty();
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      for (const std::uint32_t v : scene.triangles[object.first_triangle + t]) {
        if (seen[v] != 0) continue;
        seen[v] = 1;
        part.vertices.push_back(v);
        part.box.add(scene.vertices[v]);
      }
    }
  }
  return rest;
}

}  // namespace

Motion pass_through(const Scene& scene) {
  return [rest = rest_of(scene)](const Instant& now, Scene& out, FrameNotes&) {
    const double width = rest->parts[0].box.hi.x() - rest->parts[0].box.lo.x();
    const double by = 2.2 * (0.5 - now.time) * width;
    for (const std::uint32_t v : rest->parts[1].vertices) {
      out.vertices[v] = rest->vertices[v];
      out.vertices[v].x() += by;
    }
  };
}

Motion pulse(const Scene& scene) {
  return [rest = rest_of(scene)](const Instant& now, Scene& out, FrameNotes&) {
    for (std::size_t o = 0; o < rest->parts.size(); ++o) {
      const Part& part = rest->parts[o];
      const Vec3 middle = centre(part.box);
      const double radius = (part.box.hi.z() - part.box.lo.z()) / 2;
      const double phase = 0.25 * static_cast<double>(o);
      for (const std::uint32_t v : part.vertices) {
        const Vec3 from = rest->vertices[v] - middle;
        const double breath = 0.15 * std::sin(shapes::kTurn * (now.time + phase));
        const double wave =
            0.05 * std::sin(shapes::kTurn * (2 * now.time + 1.5 * from.z() / radius));
        out.vertices[v] = middle + (1 + breath + wave) * from;
      }
    }
  };
}

Motion drift(const Scene& scene) {
  return [rest = rest_of(scene)](const Instant& now, Scene& out, FrameNotes&) {
    shapes::Random random(kDriftSeed);
    for (const Part& part : rest->parts) {
      const Vec3 way = random.direction();
      if (part.box.is_empty()) continue;
      const Vec3 by = std::sin(shapes::kTurn * now.time) * diagonal(part.box) * way;
      for (const std::uint32_t v : part.vertices) out.vertices[v] = rest->vertices[v] + by;
    }
  };
}

}  // namespace farcull
