// The simulated cloth as a scene: a frame is a time step.
#include <memory>
#include <optional>

#include "experiments/scenes/builtin/generators.h"
#include "experiments/scenes/cloth/cloth.h"

namespace farcull {
namespace {

FrameNotes notes_of(const ClothReport& report) {
  return {.values = {{"kinetic J", report.kinetic},
                     {"elastic J", report.elastic},
                     {"bending J", report.bending},
                     {"gravitational J", report.gravitational},
                     {"contact J", report.contact},
                     {"total J", report.total()},
                     {"slack J", report.slack},
                     {"residual N", report.residual},
                     {"iterations", report.iterations},
                     {"converged", report.converged ? 1 : 0}},
          .warning = report.warning};
}

// The state of the simulation.
struct Simulated {
  ClothSettings settings;
  std::optional<Cloth> cloth;
  long frame = 0;  // steps taken
};

// size: triangles of the cloth, as near as a square grid comes; second: stiffness, N/m.
BuiltScene make_cloth(const SceneParameters& parameters) {
  auto now = std::make_shared<Simulated>();
  now->settings.triangles = parameters.size;
  now->settings.stiffness = parameters.second;
  now->cloth.emplace(now->settings);
  BuiltScene built{now->cloth->scene(), {}};
  built.motion = [now](const Instant& wanted, Scene& out, FrameNotes& notes) {
    if (wanted.frame < now->frame) {
      now->cloth.emplace(now->settings);
      now->frame = 0;
    }
    for (; now->frame < wanted.frame; ++now->frame) now->cloth->step();
    out.vertices = now->cloth->scene().vertices;
    notes = notes_of(now->cloth->report());
  };
  return built;
}

}  // namespace

std::vector<BuiltinScene> cloth_scenes() {
  return {
      taking({.name = "cloth",
              .description = "a cloth above a sphere, against itself as well (FAR)",
              .objects = 2,
              .triangles = 25'120,
              .size = SceneSize{"triangles of the cloth", 8, 200'000, 20'000},
              .second = SceneSecond{"stiffness in N/m", 1e2, 1e8, 1e4},
              .motion = "it falls on the sphere and folds over itself; a frame is a time step",
              .costly = true},
             make_cloth),
  };
}

}  // namespace farcull
