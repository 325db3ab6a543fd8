// The simulated cloth as a scene: a frame is a time step.
#include <memory>
#include <optional>

#include "experiments/scenes/builtin/generators.h"
#include "experiments/scenes/cloth/cloth.h"
#include "experiments/scenes/cloth/kept.h"

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

// A simulation, and the folder that keeps its states where there is one.
class Simulated {
 public:
  explicit Simulated(const ClothSettings& settings) : settings_(settings), cloth_(settings) {}

  const Scene& scene() const { return cloth_.scene(); }
  const ClothReport& report() const { return cloth_.report(); }

  // Starts from the last frame that is known at or before `frame`: the one that it is at, a kept
  // one, or the first.
  void go_to(long frame) {
    if (frame == report().frame) return;
    const std::string folder = cloth_folder();
    if (!folder.empty() && !kept_) kept_.emplace(folder, settings_);
    const long at = report().frame <= frame ? report().frame : -1;
    const long last = kept_ ? kept_->last(frame) : 0;
    if (last > at && last > 0) {
      cloth_.restore(kept_->read(last));
    } else if (at < 0) {
      cloth_ = Cloth(settings_);
    }
    while (report().frame < frame) {
      cloth_.step();
      if (kept_) kept_->write(cloth_.state());
    }
  }

 private:
  ClothSettings settings_;
  Cloth cloth_;
  std::optional<KeptCloth> kept_;
};

// size: triangles of the cloth, as near as a square grid comes; second: stiffness, N/m.
BuiltScene make_cloth(const SceneParameters& parameters) {
  ClothSettings settings;
  settings.triangles = parameters.size;
  settings.stiffness = parameters.second;
  const auto now = std::make_shared<Simulated>(settings);
  BuiltScene built{now->scene(), {}};
  built.motion = [now](const Instant& wanted, Scene& out, FrameNotes& notes) {
    now->go_to(wanted.frame);
    out.vertices = now->scene().vertices;
    notes = notes_of(now->report());
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
              .motion = "it falls on the sphere and folds over itself; a frame is a time step "
                        "(FARCULL_CLOTH=DIR keeps them)",
              .costly = true},
             make_cloth),
  };
}

}  // namespace farcull
