// Puts together the entries of built-in scenes.
#include "experiments/scenes/builtin/generators.h"

namespace farcull {

Scene two_objects(const std::string& name, const char* first, const Mesh& one, const char* second,
                  const Mesh& other, const Placement& placement) {
  SceneBuilder scene(name, name);
  scene.add(one, first, Split::kNone, {});
  scene.add(other, second, Split::kNone, placement);
  return scene.finish();
}

BuiltScene halfway(BuiltScene built) {
  FrameNotes none;
  built.motion({.frame = 0, .time = 0.5}, built.scene, none);
  return built;
}

BuiltinScene made(BuiltinScene entry, Scene (*make)(), Motion (*moved)(const Scene&)) {
  entry.build = [make, moved](const SceneParameters&) {
    BuiltScene built{make(), {}};
    if (moved != nullptr) built.motion = moved(built.scene);
    return built;
  };
  return entry;
}

BuiltinScene taking(BuiltinScene entry, BuiltScene (*build)(const SceneParameters&)) {
  entry.build = build;
  return entry;
}

BuiltinScene drawn(BuiltinScene entry, std::uint64_t seed,
                   BuiltScene (*make)(const SceneParameters&, std::uint64_t)) {
  entry.build = [make, seed](const SceneParameters& p) { return make(p, p.seed.value_or(seed)); };
  entry.seed = seed;
  return entry;
}

BuiltinScene drawn(BuiltinScene entry, std::uint64_t seed, Scene (*make)(std::uint64_t)) {
  entry.build = [make, seed](const SceneParameters& p) {
    return BuiltScene{make(p.seed.value_or(seed)), {}};
  };
  entry.seed = seed;
  return entry;
}

}  // namespace farcull
