// The study "error-time": errors of an answer against the time that it takes, by our methods and by
// the libraries that one would take instead.
#include <string>

#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"
#include "experiments/system/machine.h"

namespace farcull {
namespace {

using enum Method;

struct TimedScene {
  std::string name;
  bool self = false;  // see accuracy.cpp
};

// Smooth surfaces, scans, and scenes that are drawn at random, each of these with several seeds.
std::vector<TimedScene> scenes_of(bool quick) {
  std::vector<TimedScene> out = {{"two-spheres"}};
  if (!quick) {
    for (const char* name : {"two-tori", "two-bunnies", "dragon-bunny"}) out.push_back({name});
    out.push_back({"mannequin-devil", true});
  }
  const std::vector<std::string> drawn =
      quick ? std::vector<std::string>{"needles:60"}
            : std::vector<std::string>{"needles:100", "random-soup", "field"};
  for (const std::string& base : drawn) {
    for (const std::string& name : drawn_scenes(base, quick ? 2 : 5)) out.push_back({name});
  }
  return out;
}

// Libraries with exact decisions after their broad phase, and FCL and ODE as they are.
constexpr const char* kPeers[] = {"cgal-boxes", "cgal-aabb", "embree-low",
                                  "fcl-double", "fcl-float", "ode-trimesh"};

// CULLIDE until a round changes nothing, as published, and in two forms that miss less.
const std::vector<CullideForm> kForms = {
    {},
    kPublishedForm,
    {.rounds = 1, .conservative = true},
    {.rounds = 1, .clear = ClearRule::all, .conservative = true}};

// All methods at one resolution.
void add_drawn(std::vector<Point>& out, const TimedScene& scene, int resolution, int repeat) {
  const NamedScene named{scene.name};
  const auto add = [&](RunPoint point) { out.push_back(repeated(std::move(point), repeat)); };
  if (scene.self) {
    // It takes a step per triangle: 2048 px would take as long as all other points together.
    if (resolution <= 1024) {
      for (const CullideForm& form : kForms)
        add(in_form(cullide_point(named, s_cullide, resolution), form));
    }
  } else {
    for (const CullideForm& form : kForms) {
      if (form.rounds > 0) add(in_form(cullide_point(named, cullide, resolution), form));
    }
    add(cullide_point(named, cullide, resolution));
    add(cullide_point(named, quick_cullide, resolution));
    add(far_point(named, "obb", kBudgetRadius, resolution));
    add(far_point(named, "exact", kBudgetRadius, resolution));
  }
  add(plain_point(named, far_pairs, resolution));
}

std::vector<Point> grid(const GridChoice& choice) {
  const std::vector<int> resolutions =
      choice.quick ? std::vector{64, 256, 1024} : std::vector{64, 128, 256, 512, 1024, 2048};
  const int repeat = choice.quick ? 3 : 5;
  std::vector<Point> out;
  for (const TimedScene& scene : scenes_of(choice.quick)) {
    for (const int resolution : resolutions) add_drawn(out, scene, resolution, repeat);
    const NamedScene named{scene.name};
    for (const Method method : {far_pairs, i_collide, exact})
      out.push_back(repeated(plain_point(named, method), repeat));
    for (const char* peer : kPeers) out.push_back(PeerPoint{named, peer, repeat});
  }
  return out;
}

PointResult measure(const Point& point, Lab& lab) {
  if (const auto* run = std::get_if<RunPoint>(&point)) return measure_run(*run, lab);
  PointResult out = measure_peer(std::get<PeerPoint>(point), lab, usable_cores());
  // The time is that of the whole call; not every library says what its parts take.
  out.times.cull.reset();
  out.times.exact.reset();
  return out;
}

}  // namespace

Study error_time_study() {
  return {.name = "error-time",
          .title = "Error against run time",
          .question =
              "What does each method get wrong, and how long does it take, against each other and "
              "against the libraries that one would take instead?",
          .grid = grid,
          .measure = measure,
          .library = library_of_peer};
}

}  // namespace farcull
