#include "experiments/builtin_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/error.h"
#include "experiments/builtin_shapes.h"
#include "experiments/scene_build.h"

namespace farcull {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
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

// The second one comes from beside the first, goes through it and leaves on the other side.
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

// All breathe, out of step, while waves run along them.
Motion pulse(const Scene& scene) {
  return [rest = rest_of(scene)](const Instant& now, Scene& out, FrameNotes&) {
    for (std::size_t o = 0; o < rest->parts.size(); ++o) {
      const Part& part = rest->parts[o];
      const Vec3 centre = part.box.lo + (part.box.hi - part.box.lo) / 2;
      const double radius = (part.box.hi.z() - part.box.lo.z()) / 2;
      const double phase = 0.25 * static_cast<double>(o);
      for (const std::uint32_t v : part.vertices) {
        const Vec3 from = rest->vertices[v] - centre;
        const double breath = 0.15 * std::sin(kTurn * (now.time + phase));
        const double wave = 0.05 * std::sin(kTurn * (2 * now.time + 1.5 * from.z() / radius));
        out.vertices[v] = centre + (1 + breath + wave) * from;
      }
    }
  };
}

// Each goes its own way, by up to its diagonal, and comes back.
Motion drift(const Scene& scene) {
  return [rest = rest_of(scene)](const Instant& now, Scene& out, FrameNotes&) {
    shapes::Random random(kDriftSeed);
    for (const Part& part : rest->parts) {
      const Vec3 way = random.direction();
      if (part.box.is_empty()) continue;
      const Vec3 by = std::sin(kTurn * now.time) * diagonal(part.box) * way;
      for (const std::uint32_t v : part.vertices) out.vertices[v] = rest->vertices[v] + by;
    }
  };
}

bool has_motion(const std::string& name) {
  const std::string base = name.substr(0, name.find_first_of(":@"));
  const auto& scenes = builtin_scenes();
  return std::any_of(scenes.begin(), scenes.end(), [&](const BuiltinScene& scene) {
    return scene.name == base && !scene.motion.empty();
  });
}

std::string moving_names() {
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (!scene.motion.empty()) names += (names.empty() ? "" : ", ") + scene.name;
  }
  return names;
}

namespace {

BuiltScene built_for(const SceneRequest& request, const std::string& name) {
  if (request.entry->motion.empty())
    throw Error(name, "nothing in the scene moves", "name one of " + moving_names());
  BuiltScene built = request.entry->build(request.parameters);
  built.scene.name = name;
  return built;
}

}  // namespace

MovingScene::MovingScene(BuiltScene built, long frames, long first, bool self)
    : frames_(frames),
      first_(first),
      self_(self),
      motion_(std::move(built.motion)),
      plain_(std::move(built.scene)) {
  assert(frames >= 1 && first >= 0 && motion_);
}

MovingScene::MovingScene(const std::string& name, long frames, long first, bool self)
    : MovingScene(built_for(parse_scene_name(name), name), frames, first, self) {
  const SceneRequest request = parse_scene_name(name);
  if (request.suffixes.empty()) return;
  changed_ = plain_;
  for (const SceneSuffix* suffix : request.suffixes) {
    changes_.push_back(suffix->change(changed_));
    apply(changes_.back(), changed_);
  }
}

const Scene& MovingScene::at(long frame) {
  assert(first_ <= frame && frame < first_ + frames_);
  const auto last = static_cast<double>(std::max(1L, frames_ - 1));
  notes_ = {};
  motion_({frame, static_cast<double>(frame - first_) / last}, plain_, notes_);
  Scene* shown = &plain_;
  if (changes_.empty()) {
    validate(plain_, plain_.name);
  } else {
    shown = &changed_;
    changed_ = plain_;  // assigned, so that the vectors keep their memory
    for (const SceneChange& change : changes_) apply(change, changed_);
  }
  for (Object& object : shown->objects) object.self = object.self || self_;
  return *shown;
}

}  // namespace farcull
