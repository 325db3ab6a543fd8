// Studies of missed pairs. "headline" compares methods on two scenes. "accuracy" counts the pairs
// that each method and each form of CULLIDE misses at each resolution. "error-time" measures the
// misses and the time of methods and libraries. "stability" tests which methods find all collisions
// in extreme scenes. "cloth" runs every frame of a cloth at four stiffnesses, and accounts for
// every pair of triangles.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "experiments/studies/run_point.h"
#include "experiments/system/machine.h"

namespace farcull {
namespace {

using enum Method;

struct ErrorScene {
  std::string name;
  bool self = false;   // each object is tested against itself
  bool drawn = false;  // the scene is drawn at random
  bool again = false;  // drawn with a seed that is not the scene's default
};

// Returns the scenes of both lists. objects: scenes of smooth surfaces and scans. drawn: randomly
// drawn scenes; each is returned with several seeds.
std::vector<ErrorScene> scenes_of(const std::vector<std::string>& objects,
                                  const std::vector<std::string>& drawn, bool quick) {
  std::vector<ErrorScene> out;
  for (const std::string& name : objects) out.push_back({name, name == "mannequin-devil"});
  for (const std::string& base : drawn) {
    for (const std::string& name : drawn_scenes(base, quick ? 2 : 5))
      out.push_back({name, false, true, name != base});
  }
  return out;
}

// Returns scenes whose triangles are small or few. At 4096 px, a software device takes minutes to
// draw many large triangles.
std::vector<ErrorScene> accuracy_scenes(bool quick) {
  if (quick) return scenes_of({"two-tori", "mannequin-devil"}, {"needles:60"}, quick);
  return scenes_of({"two-tori", "two-spheres", "two-bunnies", "dragon-bunny", "mannequin-devil"},
                   {"needles:60", "random-soup", "slivers:200:1e6", "field"}, quick);
}

// The highest resolution for forms of CULLIDE, for FAR at the published radius, and for counts of
// pairs at risk. These runs have no guarantee, so they skip no view and take up to five times as
// long as runs with a guarantee.
constexpr int kMostOfForms = 1024;  // px

// Forms of CULLIDE: the published form, forms with one change, and forms with several changes. A
// scene with another seed gets only the published form and the forms that miss little.
std::vector<CullideForm> forms_of(const ErrorScene& scene) {
  const CullideForm conservative = {.rounds = 1, .conservative = true};
  const char* const both = "x,-x,y,-y,z,-z";  // both directions of each axis
  if (scene.again) return {kPublishedForm, conservative, kStrictForm};
  std::vector<CullideForm> out = {
      kPublishedForm,
      {.rounds = 1, .views = both},
      {.rounds = 1, .clear = ClearRule::all},
      {.rounds = 1, .clear = ClearRule::all, .views = both},
      conservative,
      kStrictForm,
  };
  if (!scene.self) out.push_back({.objects_alone = true});
  return out;
}

void add_forms(const ErrorScene& scene, std::vector<Point>& out) {
  const NamedScene named{scene.name};
  const Method method = scene.self ? s_cullide : cullide;
  const std::vector<CullideForm> forms = forms_of(scene);
  for (int resolution = 64; resolution <= kMostOfForms; resolution *= 2) {
    for (const CullideForm& form : forms)
      out.push_back(cullide_point(named, method, resolution, form));
  }
  if (scene.self || scene.again) return;
  for (const double pixels : {1, 4, 16}) {
    const auto add = [&](RunPoint point) {
      point.mean_pixels = pixels;
      out.push_back(std::move(point));
    };
    for (const CullideForm& form : forms) add(cullide_point(named, method, 0, form));
    add(cullide_point(named, method, 0));
    add(far_point(named, "obb", kBudgetRadius, 0));
  }
}

std::vector<Point> accuracy_grid(const GridChoice& choice) {
  std::vector<Point> out;
  for (const ErrorScene& scene : accuracy_scenes(choice.quick)) {
    // S-CULLIDE is limited to 1024 px in the quick grid, since each triangle counts as an object.
    const int most = scene.again || (scene.self && choice.quick) ? 1024 : 4096;
    const NamedScene named{scene.name};
    for (int resolution = 64; resolution <= most; resolution *= 2) {
      if (scene.self) {
        out.push_back(cullide_point(named, s_cullide, resolution));
        continue;
      }
      out.push_back(cullide_point(named, cullide, resolution));
      if (!scene.again) out.push_back(cullide_point(named, quick_cullide, resolution));
      out.push_back(far_point(named, "obb", kBudgetRadius, resolution));
      if (scene.again) continue;
      if (resolution <= kMostOfForms)
        out.push_back(far_point(named, "obb", kPublishedRadius, resolution));
      out.push_back(far_point(named, "exact", kBudgetRadius, resolution));
    }
    out.push_back(plain_point(named, boxes));
    if (!scene.self && !scene.again) out.push_back(plain_point(named, exact));
    add_forms(scene, out);
  }
  return out;
}

PointResult measure_accuracy(const Point& point, MeasurementContext& lab) {
  const auto& run = std::get<RunPoint>(point);
  return run.resolution <= kMostOfForms ? measure_with_risk(run, lab) : measure_run(run, lab);
}

std::vector<ErrorScene> timed_scenes(bool quick) {
  if (quick) return scenes_of({"two-spheres"}, {"needles:60"}, quick);
  return scenes_of({"two-spheres", "two-tori", "two-bunnies", "dragon-bunny", "mannequin-devil"},
                   {"needles:100", "random-soup", "field"}, quick);
}

// The first three libraries only find candidates; exact predicates decide these pairs. FCL and ODE
// decide pairs with their own triangle tests.
constexpr const char* kPeers[] = {"cgal-boxes", "cgal-aabb", "embree-low",
                                  "fcl-double", "fcl-float", "ode-trimesh"};

// Forms of CULLIDE: rounds until nothing changes; the published form; two forms that miss less.
const std::vector<CullideForm> kForms = {
    {}, kPublishedForm, {.rounds = 1, .conservative = true}, kStrictForm};

void add_drawn(std::vector<Point>& out, const ErrorScene& scene, int resolution, int repeat) {
  const NamedScene named{scene.name};
  const auto add = [&](RunPoint point) { out.push_back(repeated(std::move(point), repeat)); };
  if (scene.self) {
    // S-CULLIDE treats each triangle as an object. At 2048 px, S-CULLIDE would take as long as all
    // other points together.
    if (resolution > 1024) return;
    for (const CullideForm& form : kForms) add(cullide_point(named, s_cullide, resolution, form));
    return;
  }
  for (const CullideForm& form : kForms) {
    if (form.rounds > 0) add(cullide_point(named, cullide, resolution, form));
  }
  add(cullide_point(named, cullide, resolution));
  add(cullide_point(named, quick_cullide, resolution));
  add(far_point(named, "obb", kBudgetRadius, resolution));
  add(far_point(named, "exact", kBudgetRadius, resolution));
}

std::vector<Point> timed_grid(const GridChoice& choice) {
  const std::vector<int> resolutions =
      choice.quick ? std::vector{64, 256, 1024} : std::vector{64, 128, 256, 512, 1024, 2048};
  const int repeat = choice.quick ? kRounds : 3 * kRounds;
  std::vector<Point> out;
  for (const ErrorScene& scene : timed_scenes(choice.quick)) {
    for (const int resolution : resolutions) {
      // At 2048 px the scenes with several seeds would take most of the time of the study.
      if (!scene.drawn || resolution <= 1024) add_drawn(out, scene, resolution, repeat);
    }
    const NamedScene named{scene.name};
    for (const Method method : {boxes, i_collide, exact})
      out.push_back(repeated(plain_point(named, method), repeat));
    for (const char* peer : kPeers) out.push_back(PeerPoint{named, peer, repeat});
  }
  return out;
}

PointResult measure_timed(const Point& point, MeasurementContext& lab) {
  if (const auto* run = std::get_if<RunPoint>(&point)) return measure_run(*run, lab);
  PointResult out = measure_peer(std::get<PeerPoint>(point), lab, usable_cores());
  // Keeps only the time of the whole call, since some libraries do not report the other times.
  out.times.cull.reset();
  out.times.exact.reset();
  return out;
}

// The full grid has a scene of two scans, and a scene of many randomly placed objects.
std::vector<Point> headline_grid(const GridChoice& choice) {
  constexpr int kResolution = 512;  // px
  std::vector<Point> out;
  for (const char* name : {choice.quick ? "two-spheres" : "two-bunnies", "field"}) {
    const NamedScene scene{name};
    for (const RunPoint& point : {cullide_point(scene, cullide, kResolution, kPublishedForm),
                                  cullide_point(scene, cullide, kResolution, kForms.back()),
                                  far_point(scene, "obb", kBudgetRadius, kResolution),
                                  far_point(scene, "exact", kBudgetRadius, kResolution),
                                  plain_point(scene, boxes), plain_point(scene, exact)})
      out.emplace_back(repeated(point, choice.quick ? kRounds : 3 * kRounds));
  }
  return out;
}

// ---- "stability" and "cloth" ----

constexpr long kFrames = 500;  // frames of the cloth's motion

void add_between_objects(std::vector<Point>& out, const PointScene& scene, int resolution) {
  out.insert(out.end(),
             {cullide_point(scene, cullide, resolution),
              cullide_point(scene, cullide, resolution, kStrictForm), PeerPoint{scene, "fcl-float"},
              PeerPoint{scene, "fcl-double"}, far_point(scene, "obb", kBudgetRadius, resolution),
              far_point(scene, "exact", kBudgetRadius, resolution), plain_point(scene, boxes),
              plain_point(scene, exact)});
}

void add_against_itself(std::vector<Point>& out, const PointScene& scene, int resolution) {
  out.insert(out.end(),
             {cullide_point(scene, s_cullide, resolution), PeerPoint{scene, "fcl-float"},
              PeerPoint{scene, "fcl-double"}, far_point(scene, "obb", kBudgetRadius, resolution),
              plain_point(scene, boxes), plain_point(scene, exact)});
}

// The values of a family range from harmless to extreme. There are more values near the value at
// which CULLIDE begins to fail, and in "offset" and "scale" also where floats begin to fail.
void add_contacts(std::vector<Point>& out, bool quick) {
  struct Family {
    const char* name;
    std::vector<const char*> values;
  };
  const std::vector<const char*> ratios = {"1e0", "2e0", "3e0", "4e0", "5e0", "7e0",
                                           "1e1", "3e1", "1e2", "1e6", "1e12"};
  const std::vector<Family> families = {
      {"slivers", ratios},
      {"mixed", ratios},
      {"edge-on", ratios},
      // 3e-14 px is a unit in the last place of the coordinates.
      {"overlap", {"2e0", "1e0", "8e-1", "6e-1", "3e-1", "2e-1", "1e-1", "1e-2", "3e-14", "0"}},
      {"gap", {"1e0", "1e-2", "1e-6", "3e-14"}},
      // A step of the depth buffer is 3e-5 px.
      {"stack", {"2e0", "1e0", "5e-1", "25e-2", "12e-2", "6e-2", "1e-2", "1e-4", "1e-5", "1e-13"}},
      {"offset", {"1e0", "1e3", "1e6", "1e7", "3e7", "1e8", "3e8", "1e9", "1e12"}},
      {"scale", {"1e-9", "1e-3", "1e0", "1e3", "1e6", "1e7", "1e8", "1e9"}}};
  for (const Family& family : families) {
    std::vector<const char*> values = family.values;
    if (quick) values = {values.front(), values[values.size() / 2], values.back()};
    for (const char* value : values)
      add_between_objects(out, ContactCells{family.name, quick ? 18 : 24, value}, kCellsResolution);
  }
}

constexpr int kClothResolution = 512;  // px

void add_cloth(std::vector<Point>& out, bool quick) {
  const std::vector<long> frames = quick ? std::vector<long>{40} : std::vector<long>{25, 60, 100};
  for (const int k : {2, 4, 6, 8}) {
    const std::string name = fmt::format("cloth:{}:1e{}", quick ? 450 : 800, k);
    for (const long frame : frames)
      add_against_itself(out, MotionFrame{name, frame, kFrames}, kClothResolution);
    for (const long frame : frames)
      add_between_objects(out, ClothApart{name, frame}, kClothResolution);
  }
}

PointResult measure_stability(const Point& point, MeasurementContext& lab) {
  PointResult out;
  const PointScene* scene = nullptr;
  std::vector<TrianglePair> pairs;
  AnswerCounts* answer = nullptr;
  if (const auto* run = std::get_if<RunPoint>(&point)) {
    Record record;
    out = measure_with_risk(*run, lab, &record);
    scene = &run->scene;
    pairs = record.collisions.all();
    answer = std::get_if<RunCounts>(&out.counts);
  } else {
    const auto& peer = std::get<PeerPoint>(point);
    out = measure_peer(peer, lab, 1, &pairs);
    scene = &peer.scene;
    if (auto* counts = std::get_if<PeerCounts>(&out.counts)) {
      counts->colliding_triangles.reset();
      counts->library.reset();
      counts->promises = false;
      counts->scene_hash = scene_hash(lab.current());
      PointTimes& times = out.times;
      times.total = *times.build + *times.cull + *times.exact;
      answer = counts;
    }
  }
  const auto* cells = std::get_if<ContactCells>(scene);
  if (cells == nullptr || answer == nullptr) return out;
  std::vector<TrianglePair> varying = lab.truth().pairs;
  std::erase_if(varying, [&](const TrianglePair& pair) { return !varies(pair, *cells); });
  answer->varying = {.varying = varying.size(), .missed_varying = lacking(varying, pairs)};
  return out;
}

std::vector<Point> cloth_grid(const GridChoice& choice) {
  const int triangles = choice.quick ? 200 : 20000;
  const long frames = choice.quick ? 12 : 500;
  std::vector<Point> out;
  for (const int k : {2, 8, 4, 6}) {
    const std::string name = fmt::format("cloth:{}:1e{}", triangles, k);
    for (long frame = 0; frame < frames; ++frame) {
      const MotionFrame scene{name, frame, frames};
      out.emplace_back(plain_point(scene, boxes));
      if (frame % 10 == 0)  // FAR would take too long on every frame
        out.emplace_back(far_point(scene, "obb", kBudgetRadius, kClothResolution));
    }
  }
  return out;
}

// Returns the simulation's value `name`, such as an energy. Throws std::logic_error if there is
// none.
double note(const FrameNotes& notes, const std::string& name) {
  for (const auto& [known, value] : notes.values) {
    if (known == name) return value;
  }
  throw std::logic_error("the cloth says nothing of " + name);
}

PointResult measure_cloth(const Point& point, MeasurementContext& lab) {
  const auto& of = std::get<RunPoint>(point);
  const Scene& scene = open_scene(of.scene, lab);
  const FrameNotes notes = lab.notes();
  RunOptions options = options_of(of, lab);
  options.verify = true;
  const Record record = run(scene, options, lab.session(), lab.progress());
  const Accounting& all = *record.verification;
  ClothCounts counts;
  counts.neighbours = record.collisions.neighbour_pairs.size();
  counts.missed = all.false_negatives;
  counts.colliding = record.collisions.pairs.size() + counts.neighbours + counts.missed;
  counts.candidates = record.found.count;
  counts.neighbour_candidates = record.collisions.neighbours;
  counts.kept_triangles = record.found.triangle_count;
  counts.triangles = scene.triangles.size();
  counts.accounted = all.pairs_total;
  counts.by_boxes = all.certified_by_boxes;
  counts.by_predicates = all.certified_by_predicates;
  counts.promises = guaranteed(record.options);
  if (counts.promises && !record.promise.holds) counts.revoked = true;
  counts.scene_hash = record.scene_hash;
  std::tie(counts.left_by_boxes, counts.views_used) = mechanism_of(scene, record);
  if (of.method == far) std::tie(counts.at_risk, counts.at_risk_bare) = pairs_at_risk(of, lab);
  counts.kinetic = note(notes, "kinetic J");
  counts.total = note(notes, "total J");
  counts.slack = note(notes, "slack J");
  counts.residual = note(notes, "residual N");
  counts.iterations = static_cast<std::uint64_t>(note(notes, "iterations"));
  counts.converged = note(notes, "converged") != 0;
  return {.counts = counts,
          .times = {.cull = record.ms.cull,
                    .exact = record.ms.exact,
                    .total = record.ms.cull + record.ms.exact,
                    .setup = record.ms.setup},
          .device = answered(record)};
}

}  // namespace

Study headline_study() {
  return {.name = "headline",
          .title = "What each method misses, and how long it takes",
          .question =
              "How many colliding pairs do CULLIDE and FAR miss on two scenes, in which time, "
              "beside methods that draw nothing?",
          .grid = headline_grid,
          .measure = measure_timed,
          .plain = true};
}

Study accuracy_study() {
  return {.name = "accuracy",
          .title = "Missed collisions against resolution",
          .question =
              "How many colliding pairs and colliding triangles does each method miss against the "
              "exact answer, do more pixels help, and does another form of CULLIDE?",
          .grid = accuracy_grid,
          .measure = measure_accuracy};
}

Study error_time_study() {
  return {.name = "error-time",
          .title = "Error against run time",
          .question =
              "What does each method get wrong, and how long does it take, against each other and "
              "against the libraries that one would take instead?",
          .grid = timed_grid,
          .measure = measure_timed,
          .library = library_of_peer,
          .plain = true};
}

Study stability_study() {
  return {.name = "stability",
          .title = "Scenes that go to an extreme",
          .question =
              "At which value does a method begin to miss pairs, where triangles become slivers, "
              "sizes differ by far, a view sees triangles edge-on, overlaps and distances shrink "
              "to ulps, the scene is far away or tiny, or cloth is stiff, and how much does "
              "culling then still remove?",
          .grid =
              [](const GridChoice& choice) {
                std::vector<Point> out;
                add_contacts(out, choice.quick);
                add_cloth(out, choice.quick);
                return out;
              },
          .measure = measure_stability,
          .library = library_of_peer};
}

Study cloth_study() {
  return {.name = "cloth",
          .title = "A stiff cloth, frame by frame",
          .question =
              "Does a cloth of 20,000 triangles stay finite and its energy bounded at every "
              "stiffness, and is every pair of triangles that collides found in every frame?",
          .grid = cloth_grid,
          .measure = measure_cloth,
          .campaign = true};
}

}  // namespace farcull
