// The studies "accuracy" and "error-time": what every method misses, by the number of pixels and by
// the form of CULLIDE, and against the time that it takes, beside libraries.
#include <string>

#include "experiments/studies/point.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"
#include "experiments/system/machine.h"

namespace farcull {
namespace {

using enum Method;

struct AccuracyScene {
  std::string name;
  bool self = false;   // one object against itself, by S-CULLIDE and FAR pairs
  bool again = false;  // a scene that was measured already, drawn with another seed
};

// Scenes of three kinds: smooth surfaces, scans, and scenes that are drawn at random, each of these
// with several seeds. Their triangles are small or few: at 4096 px large ones take a software
// device minutes.
std::vector<AccuracyScene> accuracy_scenes(bool quick) {
  std::vector<AccuracyScene> out = {{"two-tori"}};
  if (!quick) {
    out.push_back({"two-spheres"});
    out.push_back({"two-bunnies"});
    out.push_back({"dragon-bunny"});
  }
  out.push_back({"mannequin-devil", true});
  const std::vector<std::string> drawn =
      quick ? std::vector<std::string>{"needles:60"}
            : std::vector<std::string>{"needles:60", "random-soup", "slivers:200:1e6", "field"};
  for (const std::string& base : drawn) {
    for (const std::string& name : drawn_scenes(base, quick ? 2 : 5))
      out.push_back({name, false, name != base});
  }
  return out;
}

// A method that promises nothing leaves out no view, so that the published radius takes up to five
// times as long as the budget's and sets the time of the study.
int most_published(const std::string& offset, bool quick) {
  return quick || offset == "exact" ? 1024 : 4096;
}

constexpr int kMostOfForms = 1024;  // px

// CULLIDE as published, and what can be changed in it one by one and together. Of a scene that is
// drawn again, those that miss little.
std::vector<CullideForm> forms_of(const AccuracyScene& scene) {
  const CullideForm conservative = {.rounds = 1, .conservative = true};
  const CullideForm strict = {.rounds = 1, .clear = ClearRule::all, .conservative = true};
  if (scene.again) return {kPublishedForm, conservative, strict};
  std::vector<CullideForm> out = {
      kPublishedForm,
      {.rounds = 1, .views = kBothDirections},
      {.rounds = 1, .clear = ClearRule::all},
      {.rounds = 1, .clear = ClearRule::all, .views = kBothDirections},
      conservative,
      strict,
  };
  if (!scene.self) out.push_back({.objects_alone = true});
  return out;
}

void add_forms(const AccuracyScene& scene, std::vector<Point>& out) {
  const NamedScene named{scene.name};
  const Method method = scene.self ? s_cullide : cullide;
  const std::vector<CullideForm> forms = forms_of(scene);
  for (int resolution = 64; resolution <= kMostOfForms; resolution *= 2) {
    for (const CullideForm& form : forms)
      out.push_back(in_form(cullide_point(named, method, resolution), form));
  }
  if (scene.self || scene.again) return;
  for (const double pixels : {1, 4, 16}) {
    for (const CullideForm& form : forms)
      out.push_back(at_mean_pixels(in_form(cullide_point(named, method, 0), form), pixels));
    out.push_back(at_mean_pixels(cullide_point(named, method, 0), pixels));
    out.push_back(at_mean_pixels(far_point(named, "obb", kBudgetRadius, 0), pixels));
  }
}

std::vector<Point> accuracy_grid(const GridChoice& choice) {
  std::vector<Point> out;
  for (const AccuracyScene& scene : accuracy_scenes(choice.quick)) {
    // S-CULLIDE takes a step per triangle.
    const int most = scene.again || (scene.self && choice.quick) ? 1024 : 4096;
    const NamedScene named{scene.name};
    for (int resolution = 64; resolution <= most; resolution *= 2) {
      if (scene.self) {
        out.push_back(cullide_point(named, s_cullide, resolution));
      } else {
        out.push_back(cullide_point(named, cullide, resolution));
        if (!scene.again) out.push_back(cullide_point(named, quick_cullide, resolution));
        for (const std::string offset : {"obb", "exact"}) {
          if (scene.again && offset == "exact") continue;
          out.push_back(far_point(named, offset, kBudgetRadius, resolution));
          if (resolution <= most_published(offset, choice.quick)) {
            out.push_back(far_point(named, offset, kPublishedRadius, resolution));
          }
        }
      }
      out.push_back(plain_point(named, far_pairs, resolution));
    }
    out.push_back(plain_point(named, far_pairs));
    if (!scene.self && !scene.again) out.push_back(plain_point(named, exact));
    add_forms(scene, out);
  }
  return out;
}

struct TimedScene {
  std::string name;
  bool self = false;  // as in AccuracyScene
};

// Smooth surfaces, scans, and scenes that are drawn at random, each of these with several seeds.
std::vector<TimedScene> timed_scenes(bool quick) {
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

std::vector<Point> timed_grid(const GridChoice& choice) {
  const std::vector<int> resolutions =
      choice.quick ? std::vector{64, 256, 1024} : std::vector{64, 128, 256, 512, 1024, 2048};
  const int repeat = choice.quick ? 3 : 5;
  std::vector<Point> out;
  for (const TimedScene& scene : timed_scenes(choice.quick)) {
    for (const int resolution : resolutions) add_drawn(out, scene, resolution, repeat);
    const NamedScene named{scene.name};
    for (const Method method : {far_pairs, i_collide, exact})
      out.push_back(repeated(plain_point(named, method), repeat));
    for (const char* peer : kPeers) out.push_back(PeerPoint{named, peer, repeat});
  }
  return out;
}

PointResult measure_timed(const Point& point, Lab& lab) {
  if (const auto* run = std::get_if<RunPoint>(&point)) return measure_run(*run, lab);
  PointResult out = measure_peer(std::get<PeerPoint>(point), lab, usable_cores());
  // The time is that of the whole call; not every library says what its parts take.
  out.times.cull.reset();
  out.times.exact.reset();
  return out;
}

}  // namespace

Study accuracy_study() {
  return {.name = "accuracy",
          .title = "Missed collisions against resolution",
          .question =
              "How many colliding pairs and colliding triangles does each method miss against the "
              "exact answer, do more pixels help, and does another form of CULLIDE?",
          .grid = accuracy_grid,
          .measure = measure_run_point};
}

Study error_time_study() {
  return {.name = "error-time",
          .title = "Error against run time",
          .question =
              "What does each method get wrong, and how long does it take, against each other and "
              "against the libraries that one would take instead?",
          .grid = timed_grid,
          .measure = measure_timed,
          .library = library_of_peer};
}

}  // namespace farcull
