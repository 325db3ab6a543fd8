// The simulated cloth as a scene: a frame is a time step.
#include <memory>
#include <optional>

#include "experiments/builtin_parts.h"
#include "experiments/cloth.h"

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

// Where the simulation is.
struct Simulated {
  ClothSettings settings;
  std::optional<Cloth> cloth;
  long frame = 0;  // steps taken
};

}  // namespace

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

}  // namespace farcull
