#include "experiments/builtin_motion.h"

#include <cmath>
#include <numbers>

#include "experiments/builtin_shapes.h"
#include "experiments/scene_build.h"

namespace farcull {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::uint64_t kDriftSeed = 8;

struct Part {
  Box box;
  std::vector<std::uint32_t> vertices;  // each once
  bool stays = false;                   // the ground of the suffix @ground
};

std::vector<Part> parts_of(const Scene& scene) {
  std::vector<Part> parts;
  std::vector<std::uint8_t> seen(scene.vertices.size(), 0);
  for (const Object& object : scene.objects) {
    Part& part = parts.emplace_back();
    part.box = Box::empty();
    part.stays = object.name == "ground";
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      for (const std::uint32_t v : scene.triangles[object.first_triangle + t]) {
        if (seen[v] != 0) continue;
        seen[v] = 1;
        part.vertices.push_back(v);
        part.box.add(scene.vertices[v]);
      }
    }
  }
  return parts;
}

// The second bunny comes from beside the first, goes through it and leaves on the other side.
void pass_through(const std::vector<Part>& parts, double time, std::vector<Vec3>& vertices) {
  const double width = parts[0].box.hi.x() - parts[0].box.lo.x();
  const double by = 2.2 * (0.5 - time) * width;
  for (const std::uint32_t v : parts[1].vertices) vertices[v].x() += by;
}

// Both breathe, out of step, while waves run along them.
void pulse(const std::vector<Part>& parts, double time, std::vector<Vec3>& vertices) {
  for (std::size_t o = 0; o < parts.size(); ++o) {
    const Part& part = parts[o];
    if (part.stays) continue;
    const Vec3 centre = part.box.lo + (part.box.hi - part.box.lo) / 2;
    const double radius = (part.box.hi.z() - part.box.lo.z()) / 2;
    const double phase = 0.25 * static_cast<double>(o);
    for (const std::uint32_t v : part.vertices) {
      const Vec3 from = vertices[v] - centre;
      const double breath = 0.15 * std::sin(kTurn * (time + phase));
      const double wave = 0.05 * std::sin(kTurn * (2 * time + 1.5 * from.z() / radius));
      vertices[v] = centre + (1 + breath + wave) * from;
    }
  }
}

// Each goes its own way, by up to its diagonal, and comes back.
void drift(const std::vector<Part>& parts, double time, std::vector<Vec3>& vertices) {
  shapes::Random random(kDriftSeed);
  for (const Part& part : parts) {
    const Vec3 way = random.direction();
    if (part.stays || part.box.is_empty()) continue;
    const Vec3 by = std::sin(kTurn * time) * diagonal(part.box) * way;
    for (const std::uint32_t v : part.vertices) vertices[v] += by;
  }
}

std::string base_of(const std::string& name) { return name.substr(0, name.find_first_of(":@")); }

}  // namespace

const std::vector<BuiltinMotion>& builtin_motions() {
  static const std::vector<BuiltinMotion> motions = {
      {"two-spheres", "both breathe while waves run along them"},
      {"crowd", "each object drifts by up to its diagonal and back"},
      {"field", "the same"},
      {"two-bunnies", "one passes through the other"},
  };
  return motions;
}

bool has_motion(const std::string& name) {
  for (const BuiltinMotion& motion : builtin_motions()) {
    if (motion.scene == base_of(name)) return true;
  }
  return false;
}

std::vector<Vec3> moved(const std::string& name, const Scene& rest, double time) {
  std::vector<Vec3> vertices = rest.vertices;
  const std::vector<Part> parts = parts_of(rest);
  const std::string base = base_of(name);
  if (base == "two-bunnies") pass_through(parts, time, vertices);
  if (base == "two-spheres") pulse(parts, time, vertices);
  if (base == "crowd" || base == "field") drift(parts, time, vertices);
  return vertices;
}

}  // namespace farcull
