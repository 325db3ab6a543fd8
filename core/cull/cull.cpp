// The schedule of culling: a round visits views, a visit runs levels, and a level runs two passes.
// Class Culling holds the state of a run and defines the steps. cull_by() calls the steps in order.
#include "core/cull/cull.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/scene/scene.h"

namespace farcull {
namespace {

double radius_of(const RadiusRule& rule, const Budget& budget, double step) {
  const double radius = rule.published ? published_radius(step) : rule.factor * budget.radius();
  // With a radius above kMaxRadius, floats could overflow in the kernels and lose fragments.
  if (!(radius >= 0 && radius <= kMaxRadius)) {
    throw Error("{radius}", std::to_string(radius) + " px is beyond the largest ball, 2^20 px",
                "choose a smaller factor");
  }
  return radius;
}

// Returns the owner of each triangle: settings.owners if given, else the object. With
// settings.self, each triangle of an object that is tested against itself is its own owner.
std::vector<std::uint32_t> owners(const Scene& scene, const CullSettings& settings) {
  if (!settings.owners.empty()) return settings.owners;
  if (!settings.self) return owners(scene);
  std::vector<std::uint32_t> out;
  out.reserve(scene.triangles.size());
  std::uint32_t owner = 0;
  for (const Object& object : scene.objects) {
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      out.push_back(owner);
      owner += object.self;
    }
    owner += !object.self;
  }
  return out;
}

// A view of the run, and the state of the run after the last visit of the view.
struct ViewState {
  std::optional<Window> window;  // empty: nothing can be drawn in this view
  // stored_version() of the first and the second pass, from the last time when the pass ran at
  // triangle level in this view. An equal stored_version() means an unchanged stored set.
  std::uint64_t stored[2] = {0, 0};
  PassCost plain;  // cost of both passes of plain CULLIDE at triangle level
};

bool has_own_owners(const Scene& scene, const CullSettings& settings) {
  return settings.self && std::any_of(scene.objects.begin(), scene.objects.end(),
                                      [](const Object& object) { return object.self; });
}

// True if objects are the owners, so that one query can test a whole object.
bool owned_by_objects(const Scene& scene, const CullSettings& settings) {
  return settings.owners.empty() && !has_own_owners(scene, settings);
}

bool has_object_level(const Scene& scene, const CullSettings& settings) {
  return (settings.object_level || settings.objects_alone) && owned_by_objects(scene, settings);
}

// Returns the initial states of the views. A view without a window cannot be drawn.
std::vector<ViewState> view_states_of(const Regions& regions, const CullSettings& settings) {
  std::vector<ViewState> places;
  for (const View& view : settings.views) {
    ViewState& place = places.emplace_back();
    if (!regions.places.empty())
      place.window = fit_window(view, regions.places, settings.resolution);
  }
  return places;
}

// Returns the stages known before drawing: views without a window, the object level, and clusters.
std::vector<Stage> opening_stages(const Scene& scene, const Regions& regions,
                                  const CullSettings& settings,
                                  const std::vector<ViewState>& places, std::size_t live) {
  std::vector<Stage> stages;
  bool any = false;
  for (std::size_t v = 0; v < places.size(); ++v) {
    any |= places[v].window.has_value();
    if (places[v].window) continue;
    stages.push_back(
        {.kind = StageKind::view,
         .subject = settings.views[v].name,
         .reason = regions.places.empty() ? Reason::no_boxes_overlap : Reason::unresolvable,
         .in = live,
         .out = live,
         .unit = Unit::triangles});
  }
  if (any && !has_object_level(scene, settings) && owned_by_objects(scene, settings)) {
    stages.push_back({.kind = StageKind::objects,
                      .reason = Reason::asked_singly,
                      .in = live,
                      .out = live,
                      .unit = Unit::triangles});
  }
  const Clusters& clusters = settings.clusters;
  if (clusters.reason == Reason::none || !any) return stages;
  const bool alone = has_own_owners(scene, settings);
  stages.push_back({.kind = StageKind::clusters,
                    .ran = !alone && !clusters.sizes.empty(),
                    .reason = alone ? Reason::owners : clusters.reason,
                    .n = alone ? 0 : clusters.n,
                    .m = alone ? 0 : clusters.m,
                    .in = live,
                    .out = live,
                    .unit = Unit::triangles});
  return stages;
}

// The steps of one run. cull_by() calls these steps in order.
class Culling {
 public:
  Culling(const PassRule& rule, const Scene& scene, const Regions& regions,
          const CullSettings& settings, Canvas& canvas, const Progress& progress)
      : rule_(rule),
        scene_(scene),
        regions_(regions),
        settings_(settings),
        canvas_(canvas),
        progress_(progress) {
    const std::size_t triangles = scene.triangles.size();
    if (!settings.bits.empty() && settings.bits.size() != triangles)
      throw std::logic_error("cull: bits of another scene");
    if (!settings.owners.empty() && settings.owners.size() != triangles)
      throw std::logic_error("cull: owners of another scene");
    if (settings.objects_alone && !owned_by_objects(scene, settings))
      throw std::logic_error("cull: objects are no owners");
    state_.owner = owners(scene, settings);
    state_.bits.assign(triangles, kCulled);
    for (const std::uint32_t t : regions.triangles)
      state_.bits[t] = settings.bits.empty() ? 0 : settings.bits[t];
    state_.live = regions.triangles;
    std::stable_sort(state_.live.begin(), state_.live.end(), [&](std::uint32_t a, std::uint32_t b) {
      return state_.owner[a] < state_.owner[b];
    });
    own_owners_ = has_own_owners(scene, settings);
    state_.remove_culled();
    arrange_clusters();
  }

  std::size_t views() const { return places_.size(); }
  int round() const { return round_; }
  const Level& objects() const { return objects_; }
  const std::vector<Level>& clusters() const { return clusters_; }
  const Level& triangles() const { return triangles_; }

  void open_views() {
    places_ = view_states_of(regions_, settings_);
    for (std::size_t v = 0; v < places_.size(); ++v)
      result_.views.push_back(report_of(settings_.views[v].name, places_[v]));
    result_.stages = opening_stages(scene_, regions_, settings_, places_, state_.live.size());
  }

  void begin_round() {
    ++round_;
    before_round_ = changes();
    live_before_ = state_.live.size();
    if (settings_.clear == ClearRule::any) return;
    if (rule_.clears) state_.clear_bits();
    start_ = state_;
    agreed_.assign(state_.bits.size(), kCulled);
  }

  // With ClearRule::all, sets the bits that all visits of the round have set.
  void end_round() {
    if (settings_.clear == ClearRule::any || state_.live.empty()) return;
    if (places_.empty()) return;  // without views, no bit may be set
    Stage stage = begin({.kind = StageKind::agreement,
                         .round = round_,
                         .depends = round_ > 1,
                         .reason = Reason::all_views});
    for (const std::uint32_t t : start_.live) {
      for (const Bit bit : {kF, kL}) {
        if (agreed_[t] & bit) state_.set(t, bit);
      }
    }
    state_.remove_culled();
    stage.out = state_.live.size();
    finish(stage);
    end_at_few_or_little();
  }

  // True if another round follows. A round that changed nothing is the last round. If a round that
  // changed something is the last round, adds a stage with the reason.
  bool round_changed() {
    const bool ended = done_ || changes() == before_round_;
    const bool last = round_ == settings_.rounds;
    // If `rounds` is 1, round 1 is always the last round, so its stage does not depend on pixels.
    if (last && (!ended || round_ == 1)) {
      leave_out({.kind = StageKind::further_rounds,
                 .reason = Reason::rounds_given,
                 .n = static_cast<std::uint64_t>(round_)})
          .depends = round_ > 1;
    }
    if (ended || last) return false;
    if (settings_.full) return true;
    if (!state_.live.empty()) return true;
    leave_out({.kind = StageKind::further_rounds, .reason = Reason::nothing_left});
    return false;
  }

  // True if the visit of this view is skipped. Adds a stage with the reason if there is none yet.
  bool leaves_out(std::size_t view) {
    ViewState& place = places_[view];
    view_ = settings_.views[view].name;
    if (!place.window && settings_.clear == ClearRule::all) agreed_ = start_.bits;
    if (!place.window || done_) return true;
    if (settings_.full) return false;
    if (state_.live.empty()) {
      leave_out(of_visit(StageKind::view, Reason::nothing_left));
    } else if (!due(place, kF) && !due(place, kL)) {
      Stage& stage = leave_out(of_visit(StageKind::view, Reason::set_unchanged));
      stage.draws_saved = place.plain.draws;
      stage.queries_saved = place.plain.queries;
      saved_ += place.plain;
      notify(triangles_, kF);
      notify(triangles_, kL);
    } else {
      return false;
    }
    return true;
  }

  void begin_visit(std::size_t view) {
    if (progress_) progress_({StageKind::cull, view_, round_});
    place_ = &places_[view];
    live_before_ = state_.live.size();
    result_.views[view].drawn = true;
    Stage stage = begin(of_visit(StageKind::fatten, Reason::fattener));
    stage.fattener = settings_.fattener.name;
    stage.depends = round_ > 1 || (visited_ && !settings_.full);
    items_ = VisitItems(state_);
    FattenCounts counts;
    const ViewReport& report = result_.views[view];
    // If owners have many triangles, most proxies are not made here. The canvas later makes only
    // the proxies that it needs, many at a time. `reach`: a proxy covers all pixel centres closer
    // than this to a corner of its triangle, in spite of rounding errors (lemma 21).
    constexpr std::size_t kLeastOfOwner = 16;
    std::optional<double> reach;
    if (canvas_.fits_proxies() &&
        items_.items.size() >= kLeastOfOwner * (items_.owner_begin.size() - 1))
      reach = (report.radius_px - report.budget.input) * (1 - 0x1p-30);
    drawables_ = fatten(scene_, items_.items, *place_->window, settings_.fattener, report.radius_px,
                        counts, std::move(drawables_), reach);
    canvas_.begin(*place_->window, drawables_);
    items_.take_drawables(drawables_);
    stage.out = drawables_.elements();
    stage.n = counts.undrawable;
    finish(stage);
  }

  bool asks_objects() const {
    return (round_ == 1 || settings_.objects_alone) && farcull::has_object_level(scene_, settings_);
  }
  bool asks_clusters() const { return round_ == 1 && !settings_.objects_alone; }
  bool asks_triangles() const { return !settings_.objects_alone; }

  // Runs both passes over the live triangles at one level.
  void run_level(const Level& level) {
    Stage stage = of_visit(StageKind::cull, Reason::nothing_left);
    stage.level = level.size;
    stage.depends = round_ > 1 || (!settings_.full && (visited_ || !first_level_));
    first_level_ = false;
    if (state_.live.empty() && !settings_.full) {
      leave_out(stage);
      return;
    }
    stage = begin(stage);
    if (rule_.clears) state_.clear_bits();
    for (const Bit bit : {kF, kL}) stage.n += run_one(level, bit, stage);
    stage.reason = Reason::passes;
    state_.remove_culled();
    stage.out = state_.live.size();
    finish(stage);
  }

  void end_visit() {
    visited_ = true;
    place_->plain = {};
    if (!rule_.clears) {
      place_->plain += plain_cost(state_, items_, drawables_, kF, triangles_);
      place_->plain += plain_cost(state_, items_, drawables_, kL, triangles_);
    }
    if (settings_.clear == ClearRule::any) {
      end_at_few_or_little();
      return;
    }
    // In plain CULLIDE, the bits of a triangle count only if the visit set both.
    for (const std::uint32_t t : start_.live) {
      const std::uint8_t bits = state_.bits[t];
      agreed_[t] &= rule_.clears && bits != kCulled ? 0 : bits;
    }
    state_ = start_;
  }

  CullResult result() {
    if (rule_.clears) state_.clear_bits();
    result_.live = std::move(state_.live);
    std::sort(result_.live.begin(), result_.live.end());
    result_.bits = std::move(state_.bits);
    return std::move(result_);
  }

 private:
  ViewReport report_of(const std::string& name, const ViewState& place) const {
    ViewReport report{.name = name, .budget = {}};
    if (!place.window) return report;
    const Window& w = *place.window;
    report.width = w.width;
    report.height = w.height;
    report.pixel_size = w.pixel_size;
    report.budget = budget_for(canvas_.limits(), viewport_side(std::max(w.width, w.height)));
    report.depth_step_px = depth_step(w, canvas_.limits().depth_bits);
    if (!settings_.fattener.raw)
      report.radius_px = radius_of(settings_.radius, report.budget, report.depth_step_px);
    return report;
  }

  // Makes the clusters of all levels. They stay the same for the whole run.
  void arrange_clusters() {
    if (own_owners_ || settings_.clusters.sizes.empty()) return;
    state_.live = spatial_order(state_.live, state_.owner, regions_.triangle_boxes);
    groups_.reserve(settings_.clusters.sizes.size());  // keeps the pointers in clusters_ valid
    for (const std::uint32_t size : settings_.clusters.sizes) {
      groups_.push_back(cluster_numbers(state_.live, state_.owner, size));
      clusters_.push_back({size, &groups_.back()});
    }
  }

  std::uint64_t changes() const {
    return rule_.clears ? state_.culled : state_.changes[0] + state_.changes[1];
  }

  // Returns a number that increases whenever the set stored by the pass for `bit` changes.
  std::uint64_t stored_version(Bit bit) const { return state_.changes[bit == kF]; }
  // True if the pass for `bit` has to run. A pass can be skipped if bits are kept across views and
  // the stored set has not changed since the pass last ran in this view.
  bool due(const ViewState& place, Bit bit) const {
    return settings_.full || rule_.clears || settings_.clear == ClearRule::all ||
           settings_.objects_alone || stored_version(bit) != place.stored[bit == kL];
  }

  void end_at_few_or_little() {
    const std::uint64_t left = state_.live.size(), culled = live_before_ - left;
    const bool few = settings_.enough > 0 && left <= settings_.enough;
    const bool little =
        settings_.worth_a_view > 0 && culled * settings_.worth_a_view < live_before_;
    if (settings_.full || !(few || little)) return;
    done_ = true;
    leave_out({.kind = StageKind::further_views,
               .reason = few ? Reason::few_left : Reason::little_culled,
               .n = few ? left : culled,
               .m = few ? settings_.enough : live_before_});
  }

  bool run_one(const Level& level, Bit bit, Stage& stage) {
    const bool leave_out = &level == &triangles_ && !due(*place_, bit);
    PassCost plain, cost;
    if (!rule_.clears) plain = plain_cost(state_, items_, drawables_, bit, level);
    if (!leave_out) {
      if (&level == &triangles_) place_->stored[bit == kL] = stored_version(bit);
      cost = run_pass(state_, items_, drawables_, bit, rule_, level, settings_.touching, canvas_);
    }
    stage.draws += cost.draws;
    stage.queries += cost.queries;
    used_ += cost;
    if (!rule_.clears) {
      const PassCost saved = {plain.draws - cost.draws, plain.queries - cost.queries};
      stage.draws_saved += saved.draws;
      stage.queries_saved += saved.queries;
      saved_ += saved;
    }
    notify(level, bit);
    return !leave_out;
  }

  void notify(const Level& level, Bit bit) const {
    if (!settings_.watch) return;
    settings_.watch({.level = level.size,
                     .view = view_,
                     .round = round_,
                     .first_pass = bit == kF,
                     .bits = state_.bits,
                     .draws = used_.draws,
                     .queries = used_.queries,
                     .draws_saved = saved_.draws,
                     .queries_saved = saved_.queries});
  }

  // Returns a new stage for the current visit.
  Stage of_visit(StageKind kind, Reason reason) const {
    return {.kind = kind, .subject = view_, .round = round_, .depends = true, .reason = reason};
  }
  Stage begin(Stage stage) {
    watch_ = Stopwatch();
    stage.ran = true;
    stage.in = state_.live.size();
    stage.unit = Unit::triangles;
    return stage;
  }
  void finish(Stage& stage) {
    stage.ms = watch_.ms();
    result_.stages.push_back(stage);
  }
  Stage& leave_out(Stage stage) {
    stage.depends = true;
    stage.in = stage.out = state_.live.size();
    stage.unit = Unit::triangles;
    return result_.stages.emplace_back(std::move(stage));
  }

  const PassRule& rule_;
  const Scene& scene_;
  const Regions& regions_;
  const CullSettings& settings_;
  Canvas& canvas_;
  const Progress& progress_;
  CullResult result_;
  CullState state_;
  bool own_owners_ = false;                         // some triangle is its own owner
  std::vector<std::vector<std::uint32_t>> groups_;  // per cluster level and triangle: its cluster
  Level objects_{kObjectLevel, &state_.owner};
  std::vector<Level> clusters_;
  Level triangles_{kTriangleLevel};
  std::vector<ViewState> places_;

  int round_ = 0;
  std::uint64_t before_round_ = 0;
  std::uint64_t live_before_ = 0;     // number of live triangles before this visit (or round)
  CullState start_;                   // for ClearRule::all: the state when the round began
  std::vector<std::uint8_t> agreed_;  // for ClearRule::all: bits that every visit of the round set
  bool done_ = false;                 // few triangles are left, or few were culled last
  bool visited_ = false;              // a visit has ended
  bool first_level_ = true;           // no level has run yet
  PassCost used_, saved_;

  // The state of the current visit.
  std::string view_;
  ViewState* place_ = nullptr;
  VisitItems items_;
  Drawables drawables_;
  Stopwatch watch_;
};

}  // namespace

std::vector<Stage> planned_stages(const Scene& scene, const Regions& regions,
                                  const CullSettings& settings) {
  const std::vector<ViewState> places = view_states_of(regions, settings);
  const std::size_t live = regions.triangles.size();
  std::vector<Stage> stages = opening_stages(scene, regions, settings, places, live);
  std::vector<std::uint32_t> levels;
  if (has_object_level(scene, settings)) levels.push_back(kObjectLevel);
  if (!has_own_owners(scene, settings)) {
    for (const std::uint32_t size : settings.clusters.sizes) levels.push_back(size);
  }
  if (!settings.objects_alone) levels.push_back(kTriangleLevel);

  bool first_view = true, first_level = true;
  for (std::size_t v = 0; v < places.size(); ++v) {
    if (!places[v].window) continue;
    Stage fatten{.kind = StageKind::fatten,
                 .subject = settings.views[v].name,
                 .round = 1,
                 .ran = true,
                 .reason = Reason::fattener,
                 .fattener = settings.fattener.name};
    const auto add = [&](Stage stage, bool depends) {
      stage.depends = depends && !settings.full;
      if (stage.depends) {
        const bool any = settings.clear == ClearRule::any;
        const bool further = !first_view && any && settings.worth_a_view > 0;
        stage.reason = further ? Reason::if_more_culled : Reason::if_more_left;
        stage.n = first_view || !any ? 0 : settings.enough;
        stage.m = further ? settings.worth_a_view : 0;
      }
      stages.push_back(std::move(stage));
    };
    add(fatten, !first_view);
    for (const std::uint32_t level : levels) {
      Stage cull = fatten;
      cull.kind = StageKind::cull;
      cull.level = level;
      cull.reason = Reason::passes;
      cull.n = 2;
      add(cull, !first_level);
      first_level = false;
    }
    first_view = false;
  }
  if (first_view) return stages;  // nothing is drawn
  if (settings.clear == ClearRule::all) {
    stages.push_back(
        {.kind = StageKind::agreement, .round = 1, .ran = true, .reason = Reason::all_views});
  }
  if (settings.rounds == 1) {
    stages.push_back({.kind = StageKind::further_rounds, .reason = Reason::rounds_given, .n = 1});
    return stages;
  }
  stages.push_back({.kind = StageKind::further_rounds,
                    .ran = true,
                    .depends = true,
                    .reason = settings.worth_a_view > 0 ? Reason::if_culled : Reason::if_changed,
                    .n = settings.worth_a_view,
                    .m = static_cast<std::uint64_t>(settings.rounds)});
  return stages;
}

CullResult cull(const Scene& scene, const Regions& regions, const CullSettings& settings,
                Canvas& canvas, const Progress& progress) {
  return cull_by(settings.quick ? kQuickRule : kPlainRule, scene, regions, settings, canvas,
                 progress);
}

CullResult cull_by(const PassRule& rule, const Scene& scene, const Regions& regions,
                   const CullSettings& settings, Canvas& canvas, const Progress& progress) {
  if (settings.resolution < 1 || settings.resolution > canvas.limits().max_resolution) {
    throw Error("{resolution}",
                std::to_string(settings.resolution) + " is outside 1 .. " +
                    std::to_string(canvas.limits().max_resolution) + ", the limit of this device",
                "choose a resolution in that range");
  }
  Culling run(rule, scene, regions, settings, canvas, progress);
  run.open_views();
  do {
    run.begin_round();
    for (std::size_t view = 0; view < run.views(); ++view) {
      if (run.leaves_out(view)) continue;
      run.begin_visit(view);
      if (run.asks_objects()) run.run_level(run.objects());
      if (run.asks_clusters()) {
        for (const Level& clusters : run.clusters()) run.run_level(clusters);
      }
      if (run.asks_triangles()) run.run_level(run.triangles());
      run.end_visit();
    }
    run.end_round();
  } while (run.round_changed());
  return run.result();
}

}  // namespace farcull
