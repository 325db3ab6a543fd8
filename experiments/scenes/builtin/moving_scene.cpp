// Calls the motion of a scene for each frame, then applies the suffixes of its name.
#include "experiments/scenes/builtin/moving_scene.h"

#include <algorithm>
#include <cassert>

#include "core/base/error.h"
#include "experiments/scenes/builtin/scenes.h"

namespace farcull {
namespace {

BuiltScene built_for(const SceneRequest& request, const std::string& name) {
  if (request.entry->motion.empty())
    throw Error(name, "nothing in the scene moves", "name one of " + moving_names());
  BuiltScene built = request.entry->build(request.parameters);
  built.scene.name = name;
  return built;
}

}  // namespace

bool has_motion(const std::string& name) {
  const BuiltinScene* const entry = find_builtin_scene(name);
  return entry != nullptr && !entry->motion.empty();
}

std::string moving_names() {
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (!scene.motion.empty()) names += (names.empty() ? "" : ", ") + scene.name;
  }
  return names;
}

MovingScene::MovingScene(BuiltScene built, long frames, bool self)
    : frames_(frames),
      self_(self),
      motion_(std::move(built.motion)),
      plain_(std::move(built.scene)) {
  assert(frames >= 1 && motion_);
}

MovingScene::MovingScene(const std::string& name, long frames, bool self)
    : MovingScene(built_for(parse_scene_name(name), name), frames, self) {
  const SceneRequest request = parse_scene_name(name);
  if (request.suffixes.empty()) return;
  changed_ = plain_;
  for (const SceneSuffix* suffix : request.suffixes) {
    changes_.push_back(suffix->change(changed_));
    apply(changes_.back(), changed_);
  }
}

const Scene& MovingScene::at(long frame) {
  assert(0 <= frame && frame < frames_);
  const auto last = static_cast<double>(std::max(1L, frames_ - 1));
  notes_ = {};
  motion_({frame, static_cast<double>(frame) / last}, plain_, notes_);
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
