// Random worlds and schedules, and core/cull made to run on them: the canvas answers by the
// relations of a world of the model (model.h) instead of by pixels.
#pragma once

#include "core/cull/cull.h"
#include "core/cull/patches.h"
#include "experiments/record/stage_words.h"
#include "tests/core/cull/model.h"
#include "tests/lab/canvas.h"

namespace farcull::model {

struct Case {
  World world;
  Schedule schedule;
  Bits start;

  // For core/cull alone.
  Scene scene;
  std::vector<std::uint32_t> patches;   // per triangle its owner; empty: objects own, or `self`
  bool self = false;                    // see CullSettings
  bool places = true;                   // false: no two boxes of objects overlap
  bool touching = true;                 // see CullSettings
  std::vector<std::uint32_t> clusters;  // sizes
  bool object_level = true;
  std::vector<std::string> levels;  // names, of the coarse ones and of the triangles
};

/// What stands for a fault of the canvas, or of the order in which a pass is drawn.
enum class Fault { none, nothing_everywhere, first_of_slot };

/// Draws nothing: answers by the relations of a world. Two triangles see each other in one of their
/// elements only, so that an element that is left out is noticed.
class RelationCanvas : public Canvas {
 public:
  RelationCanvas(const World& world, bool touching, Fault fault)
      : world_(world), touching_(touching), fault_(fault) {
    limits_.subpixel_bits = 8;
    limits_.depth_bits = 32;
    limits_.max_resolution = 4096;
  }
  const RasterLimits& limits() const override { return limits_; }

  void begin(const Window& window, const Drawables& drawables) override {
    view_ = std::stoi(window.view.name);
    drawables_ = &drawables;
  }

  std::vector<std::uint8_t> run(const farcull::Pass& pass) override;

  /// What was wrong with a pass; empty: nothing.
  const std::string& complaint() const { return complaint_; }

 private:
  struct Element {
    int triangle, number;
  };
  Element element(std::uint32_t e) const {
    const Solid& solid = drawables_->proxies.at(e).solid;
    return {static_cast<int>(solid[0][0]), static_cast<int>(solid[0][1])};
  }
  bool sees(const Element& asked, const Element& stored) const {
    const View& view = world_.views[view_];
    if (!(view.behind[asked.triangle] & only(stored.triangle))) return false;
    const int mixed = 7 * asked.triangle + 5 * stored.triangle + view_;
    return asked.number == mixed % view.elements[asked.triangle] &&
           stored.number == mixed % view.elements[stored.triangle];
  }

  const World& world_;
  bool touching_;
  Fault fault_;
  RasterLimits limits_;
  const Drawables* drawables_ = nullptr;
  int view_ = 0;
  std::string complaint_;
};

inline std::vector<std::uint8_t> RelationCanvas::run(const farcull::Pass& pass) {
  std::vector<std::uint8_t> seen(pass.slots), asked(pass.slots);
  std::vector<Element> stored;
  bool everywhere = false;
  if (pass.touching != touching_) complaint_ = "touching";
  if (pass.steps.empty() || pass.steps.back().verb == Verb::store)
    complaint_ = "a pass that does not end with a question";
  for (const farcull::Step& step : pass.steps) {
    if (step.count == 0) complaint_ = "an empty step";
    for (std::uint32_t d = step.first; d < step.first + step.count; ++d) {
      const Draw& draw = pass.draws.at(d);
      if (draw.element == kEverywhere) {
        if (step.verb == Verb::ask) complaint_ = "an undrawable triangle is asked";
        everywhere |= fault_ != Fault::nothing_everywhere;
      } else if (step.verb == Verb::store) {
        stored.push_back(element(draw.element));
      } else {
        const Element its = element(draw.element);
        const bool next = d == step.first || pass.draws[d - 1].slot != draw.slot;
        if (next && asked.at(draw.slot)) complaint_ = "a slot that is asked in two places";
        if (fault_ == Fault::first_of_slot && asked[draw.slot] &&
            asked[draw.slot] != its.triangle + 1)
          continue;
        asked[draw.slot] = static_cast<std::uint8_t>(its.triangle + 1);
        for (const Element& other : stored) seen[draw.slot] |= sees(its, other);
        seen[draw.slot] |= everywhere;
      }
    }
  }
  for (const std::uint8_t slot : asked)
    if (!slot) complaint_ = "a slot that is not asked";
  return seen;
}

/// Regions of a case: every triangle is a point on the diagonal of one place.
inline Regions regions_of(const Case& c) {
  Regions regions;
  regions.triangle_boxes = triangle_boxes(c.scene);
  regions.object_boxes = object_boxes(c.scene, regions.triangle_boxes);
  if (c.places) regions.places = {{Vec3(0, 0, 0), Vec3(kMost + 1, kMost + 1, kMost + 1)}};
  for (std::uint32_t t = 0; t < c.scene.triangles.size(); ++t)
    if (c.world.region & only(static_cast<int>(t))) regions.triangles.push_back(t);
  return regions;
}

/// The rule of core/cull for what the model asks and stores.
inline PassRule pass_rule(const Schedule& schedule) {
  PassRule rule{.asks = {}, .stores = {}, .clears = !schedule.quick};
  for (const bool second : {false, true}) {
    for (int set = 0; set < 4; ++set) {
      const Bits bits{set & kF ? Set{1} : Set{0}, set & kL ? Set{1} : Set{0}};
      const model::Pass pass = schedule.quick ? quick_pass(second, 1, bits, schedule.rules)
                                              : plain_pass(second, 1, bits);
      rule.asks[second][set] = pass.asked != 0;
      rule.stores[second][set] = pass.stored != 0;
    }
  }
  return rule;
}

/// Draws each triangle as its elements in the view that `view` names; tells triangles by their
/// place.
inline Fattener relation_fattener(const World& world, std::shared_ptr<int> view,
                                  std::vector<double> depth) {
  const auto draw = [&world, view, depth](const Patch& patch, double, const ProxyBounds&,
                                          Drawables& out) {
    const double z = patch.corners[0][2];
    const auto nearest = std::ranges::min_element(
        depth, [z](double a, double b) { return std::abs(a - z) < std::abs(b - z); });
    const auto t = static_cast<int>(nearest - depth.begin());
    const View& shown = world.views[*view];
    if (shown.undrawable & only(t))
      out.undrawable.push_back(static_cast<std::uint32_t>(out.first.size() - 1));
    if (!(shown.shown & only(t))) return;
    for (int e = 0; e < shown.elements[t]; ++e) {
      Proxy proxy{};
      proxy.solid[0] = {static_cast<float>(t), static_cast<float>(e), 0, 0};
      out.proxies.push_back(proxy);
    }
  };
  return {"relation", DepthMode::fragment, {}, draw};
}

/// The views of a case, which differ in nothing but their names, and those that cannot be drawn.
inline std::vector<farcull::View> views_of(const World& world) {
  std::vector<farcull::View> out;
  for (std::size_t v = 0; v < world.views.size(); ++v) {
    const double scale = world.views[v].drawn ? 1 : 1e308;
    out.push_back({std::to_string(v), scale * Eigen::Matrix3d::Identity()});
  }
  return out;
}

inline std::string name_of(const Case& c, const Step& step) {
  return c.levels[step.level] + " " + std::to_string(step.view) + ", round " +
         std::to_string(step.round) + (step.second ? ", second pass" : ", first pass");
}

inline std::string name_of(const CullStep& step) {
  return level_name(step.level) + " " + step.view + ", round " + std::to_string(step.round) +
         (step.first_pass ? ", first pass" : ", second pass");
}

inline std::vector<std::uint8_t> bits_of(const Case& c, const Bits& bits) {
  std::vector<std::uint8_t> out(c.scene.triangles.size());
  for (std::uint32_t t = 0; t < out.size(); ++t)
    out[t] = static_cast<std::uint8_t>((bits.f >> t & 1) * kF | (bits.l >> t & 1) * kL);
  return out;
}

/// A step as both report it.
struct Seen {
  std::string name;
  std::vector<std::uint8_t> bits;
  std::uint64_t draws = 0, queries = 0, draws_saved = 0, queries_saved = 0;  // so far
  bool operator==(const Seen&) const = default;
};

struct Outcome {
  std::vector<Seen> steps;
  std::vector<std::uint8_t> bits;
  std::uint64_t passes = 0;  // that ran
  std::string complaint;
};

inline Outcome by_model(const Case& c) {
  Outcome out;
  Seen so_far;
  const Bits end = run(c.world, c.schedule, c.start, [&](const Step& step) {
    const Level& level = step.level < static_cast<int>(c.schedule.coarse.size())
                             ? c.schedule.coarse[step.level]
                             : c.schedule.triangles;
    so_far.name = name_of(c, step);
    so_far.bits = bits_of(c, step.bits);
    so_far.draws += step.answer.draws;
    so_far.queries += step.answer.groups;
    if (c.schedule.quick) {
      const Answer plain =
          run_pass(c.world, c.world.views[step.view], level,
                   plain_pass(step.second, c.world.region, step.before), false, c.schedule.rules);
      so_far.draws_saved += plain.draws - step.answer.draws;
      so_far.queries_saved += plain.groups - step.answer.groups;
    }
    out.passes += step.ran;
    out.steps.push_back(so_far);
  });
  out.bits = bits_of(c, end);
  return out;
}

inline Outcome by_core(const Case& c, Fault fault = Fault::none) {
  const Schedule& s = c.schedule;
  const Regions regions = regions_of(c);
  const auto view = std::make_shared<int>(0);
  RelationCanvas canvas(c.world, c.touching, fault);
  CullSettings settings;
  settings.views = views_of(c.world);
  settings.resolution = 64;
  std::vector<double> depth;
  if (c.places) {
    const auto window = fit_window({"", Eigen::Matrix3d::Identity()}, regions.places, 64);
    for (std::uint32_t t = 0; t < c.scene.triangles.size(); ++t)
      depth.push_back(to_pixel(window.value(), c.scene.corners(t)[0]).p[2]);
  }
  settings.fattener = relation_fattener(c.world, view, depth);
  settings.quick = s.quick;
  settings.self = c.self;
  settings.owners = c.patches;
  settings.touching = c.touching;
  settings.clusters.sizes = c.clusters;
  settings.clear = s.all_views ? ClearRule::all : ClearRule::any;
  settings.rounds = s.rounds;
  settings.objects_alone = s.alone;
  settings.full = s.full;
  settings.enough = static_cast<std::uint32_t>(s.enough);
  settings.object_level = c.object_level;
  settings.worth_a_view = static_cast<std::uint32_t>(s.worth);
  settings.bits = bits_of(c, c.start);
  Outcome out;
  settings.watch = [&](const CullStep& step) {
    out.steps.push_back(
        {name_of(step), step.bits, step.draws, step.queries, step.draws_saved, step.queries_saved});
  };
  // The progress is what names a view before it is fattened.
  const CullResult result =
      cull_by(pass_rule(s), c.scene, regions, settings, canvas,
              [&](const ProgressStep& step) { *view = std::stoi(step.subject); });
  for (const Stage& stage : result.stages)
    if (stage.kind == StageKind::cull && stage.ran) out.passes += stage.n;
  out.bits = result.bits;
  out.complaint = canvas.complaint();
  for (std::uint32_t t = 0; t < out.bits.size(); ++t) {
    const bool live = std::ranges::binary_search(result.live, t);
    if (live != (out.bits[t] != kCulled)) out.complaint = "live is not what lacks a bit";
  }
  return out;
}

/// The first step after which both have other bits; empty: none.
inline std::string difference_of_bits(const Outcome& model, const Outcome& core) {
  if (!core.complaint.empty()) return core.complaint;
  for (std::size_t i = 0; i < std::max(model.steps.size(), core.steps.size()); ++i) {
    if (i >= core.steps.size()) return "core/cull ends before " + model.steps[i].name;
    if (i >= model.steps.size()) return "the model ends before " + core.steps[i].name;
    if (model.steps[i].name != core.steps[i].name || model.steps[i].bits != core.steps[i].bits)
      return core.steps[i].name;
  }
  return model.bits == core.bits ? "" : "the end";
}

/// The same, also of what was drawn, asked, saved and left out.
inline std::string difference(const Outcome& model, const Outcome& core) {
  const std::string bits = difference_of_bits(model, core);
  if (!bits.empty()) return bits;
  for (std::size_t i = 0; i < core.steps.size(); ++i) {
    Seen m = model.steps[i];
    const Seen& c = core.steps[i];
    // A visit that is left out reports what it saves in both passes at the first of them.
    if (i % 2 == 0) m.draws_saved = c.draws_saved, m.queries_saved = c.queries_saved;
    if (m != c) return c.name + ", cost";
  }
  return model.passes == core.passes ? "" : "the number of passes";
}

/// How each triangle takes part in a random case: by its object; by itself in some objects; by
/// patches of some objects.
enum class Owners { objects, selves, patches };

inline Set random_set(lab::Random& random, int n, double share) {
  Set out = 0;
  for (int t = 0; t < n; ++t)
    if (random.unit() < share) out |= only(t);
  return out;
}

inline View random_view(lab::Random& random, int n) {
  static constexpr double kShares[] = {0.03, 0.1, 0.2, 0.4, 0.8};
  View view;
  view.drawn = random.below(12) > 0;
  const double odd = random.below(2) * 0.15;
  view.undrawable = random_set(random, n, odd);
  view.shown = ~random_set(random, n, odd) & ~view.undrawable & (only(n) - 1);
  const double share = kShares[random.below(5)];
  for (int t = 0; t < n; ++t) {
    view.elements[t] = 1 + random.below(3);
    // Also of one owner: nobody is asked against its own.
    if (view.shown & only(t)) view.behind[t] = random_set(random, n, share) & view.shown;
  }
  return view;
}

/// A triangle for each place: a point of the diagonal.
inline void add_points(const std::vector<int>& places, Scene& scene) {
  for (const int place : places) {
    const auto v = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.push_back(Vec3::Constant(place));
    scene.triangles.push_back({v, v, v});
    scene.source_face.push_back(v);
  }
}

/// Objects of points at different places of a diagonal, in any order.
inline void add_scene(lab::Random& random, int n, bool marks, Case& c) {
  std::vector<int> place(n);
  std::iota(place.begin(), place.end(), 1);
  for (int i = n - 1; i > 0; --i) std::swap(place[i], place[random.below(i + 1)]);
  const int objects = 1 + random.below(5);
  std::vector<int> first(objects + 1, n);
  first[0] = 0;
  for (int o = 1; o < objects; ++o) first[o] = random.below(n + 1);
  std::ranges::sort(first);
  for (int o = 0; o < objects; ++o) {
    c.scene.objects.push_back({"o", static_cast<std::uint32_t>(first[o]),
                               static_cast<std::uint32_t>(first[o + 1] - first[o]),
                               marks && random.below(2) == 0});
  }
  add_points(place, c.scene);
}

inline void add_owners(lab::Random& random, Owners kind, Case& c) {
  for (const Object& object : c.scene.objects) {
    const bool marked = object.self && kind != Owners::objects;
    const std::size_t first = c.world.owners.size();
    const int parts = !marked                   ? 1
                      : kind == Owners::patches ? 1 + random.below(4)
                                                : static_cast<int>(object.triangle_count);
    c.world.owners.resize(first + static_cast<std::size_t>(parts));
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
      const std::uint32_t t = object.first_triangle + i;
      const std::size_t part = !marked ? 0
                               : kind == Owners::patches
                                   ? static_cast<std::size_t>(random.below(parts))
                                   : i;
      c.world.owners[first + part] |= only(static_cast<int>(t));
      if (kind == Owners::patches) c.patches.push_back(static_cast<std::uint32_t>(first + part));
    }
  }
}

/// Each owner's live triangles in the order of their places, cut into clusters of `size`.
inline Level clusters(const Case& c, std::uint32_t size) {
  Level out;
  for (const Set owner : c.world.owners) {
    std::vector<int> members;
    for (Set rest = owner & c.world.region & ~c.start.culled(); rest != 0; rest &= rest - 1)
      members.push_back(first_of(rest));
    std::ranges::sort(
        members, [&](int a, int b) { return c.scene.vertices[a][0] < c.scene.vertices[b][0]; });
    out.emplace_back();
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (i % size == 0) out.back().push_back(0);
      out.back().back() |= only(members[i]);
    }
  }
  return out;
}

inline void add_levels(lab::Random& random, Owners kind, Case& c) {
  Schedule& s = c.schedule;
  const bool marked =
      std::ranges::any_of(c.scene.objects, [](const Object& object) { return object.self; });
  const bool alone = kind == Owners::selves && marked;  // some triangle is its own owner
  c.object_level = random.below(3) > 0;
  s.alone = c.patches.empty() && !alone && random.below(8) == 0;
  if (c.patches.empty() && !alone && (s.alone || c.object_level)) {
    s.coarse.push_back(wholes(c.world.owners));
    c.levels.emplace_back("objects");
  }
  const int sizes = random.below(3);
  for (int i = 0; i < sizes; ++i) {
    c.clusters.push_back(static_cast<std::uint32_t>(2 + random.below(3)));
    if (alone || s.alone) continue;
    s.coarse.push_back(clusters(c, c.clusters.back()));
    c.levels.push_back("clusters of " + std::to_string(c.clusters.back()));
  }
  s.triangles = singles(c.world.owners);
  c.levels.emplace_back("triangles");
}

inline Case random_case(std::uint64_t seed, int most) {
  lab::Random random(seed);
  Case c;
  const int n = 1 + random.below(most);
  const Owners kind{random.below(3)};
  add_scene(random, n, kind != Owners::objects, c);
  add_owners(random, kind, c);
  c.self = kind == Owners::selves;
  c.world.region = only(random.below(n)) | random_set(random, n, random.below(4) == 0 ? 0.7 : 1);
  c.places = random.below(40) > 0;
  c.touching = random.below(2) == 0;
  if (random.below(4) == 0) c.start = {random_set(random, n, 0.3), random_set(random, n, 0.3)};
  const int views = random.below(40) == 0 ? 0 : 1 + random.below(4);
  for (int v = 0; v < views; ++v) {
    c.world.views.push_back(random_view(random, n));
    c.world.views.back().drawn &= c.places;
  }
  Schedule& s = c.schedule;
  s.quick = random.below(3) > 0;
  s.rounds = random.below(4);
  s.all_views = random.below(5) == 0;
  s.full = random.below(4) == 0;
  s.enough = random.below(3) == 0 ? random.below(6) : 0;
  s.worth = random.below(3) == 0 ? random.below(6) : 0;
  add_levels(random, kind, c);
  return c;
}

/// A world of the model, with each of its owners as an object, and a schedule without coarse
/// levels.
inline Case case_of(const World& world, const Schedule& schedule, const Bits& start) {
  Case c;
  c.world = world;
  c.schedule = schedule;
  c.start = start;
  for (const Set owner : world.owners) {
    c.scene.objects.push_back({"o", static_cast<std::uint32_t>(first_of(owner)),
                               static_cast<std::uint32_t>(std::popcount(owner))});
  }
  const Object& last = c.scene.objects.back();
  std::vector<int> place(last.first_triangle + last.triangle_count);
  std::iota(place.begin(), place.end(), 1);
  add_points(place, c.scene);
  c.object_level = false;
  c.levels.emplace_back("triangles");
  return c;
}

}  // namespace farcull::model
