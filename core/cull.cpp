#include "core/cull.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "core/cull_clusters.h"
#include "core/cull_pass.h"
#include "core/error.h"
#include "core/stopwatch.h"

namespace farcull {
namespace {

double radius_of(const RadiusRule& rule, const Budget& budget, double step) {
  const double radius = rule.published ? published_radius(step) : rule.factor * budget.radius();
  // Beyond it floats overflow in the kernels, and a fragment would be lost instead of seen.
  if (!(radius >= 0 && radius <= kMaxRadius)) {
    throw Error("--radius", std::to_string(radius) + " px is beyond the largest ball, 2^20 px",
                "choose a smaller factor");
  }
  return radius;
}

// The owner of each triangle: its object, or itself where its object is tested against itself.
std::vector<std::uint32_t> owners(const Scene& scene, bool self) {
  if (!self) return owners(scene);
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

// A view of the run, and what its last visit left behind.
struct Place {
  std::optional<Window> window;
  // How many changes the sets stored in the first and second pass at triangle level had seen.
  std::uint64_t stored[2] = {0, 0};
  PassCost plain;  // of plain CULLIDE's two passes at triangle level on what is live
};

// The parts of one run; cull_by() puts them in order.
class Culling {
 public:
  Culling(const PassRule& rule, const Scene& scene, const Plan& plan, const CullSettings& settings,
          Canvas& canvas, const Progress& progress)
      : rule_(rule),
        scene_(scene),
        plan_(plan),
        settings_(settings),
        canvas_(canvas),
        progress_(progress) {
    const std::size_t triangles = scene.triangles.size();
    if (!settings.bits.empty() && settings.bits.size() != triangles)
      throw std::logic_error("cull: bits of another scene");
    state_.owner = owners(scene, settings.self);
    state_.bits.assign(triangles, kCulled);
    for (const std::uint32_t t : plan.triangles)
      state_.bits[t] = settings.bits.empty() ? 0 : settings.bits[t];
    state_.live = plan.triangles;
    owners_of_one_ = settings.self && std::any_of(scene.objects.begin(), scene.objects.end(),
                                                  [](const Object& o) { return o.self; });
    state_.bury();
    arrange_clusters();
  }

  std::size_t views() const { return places_.size(); }
  int round() const { return round_; }
  const Level& objects() const { return objects_; }
  const std::vector<Level>& clusters() const { return clusters_; }
  const Level& triangles() const { return triangles_; }

  void open_views() {
    for (const View& view : settings_.views) {
      ViewReport report{.name = view.name, .budget = {}};
      Place place;
      if (!plan_.regions.empty())
        place.window = fit_window(view, plan_.regions, settings_.resolution);
      if (place.window) {
        const Window& w = *place.window;
        report.drawn = true;
        report.width = w.width;
        report.height = w.height;
        report.pixel_size = w.pixel_size;
        report.budget = budget_for(canvas_.limits(), viewport_side(std::max(w.width, w.height)));
        report.depth_step_px = depth_step(w, canvas_.limits().depth_bits);
        const bool fattened = settings_.fattener.name != "raw";
        report.radius_px =
            fattened ? radius_of(settings_.radius, report.budget, report.depth_step_px) : 0;
      } else {
        leave_out("view " + view.name, plan_.regions.empty()
                                           ? "no two objects' boxes overlap"
                                           : "double arithmetic cannot resolve the region in "
                                             "pixels; nothing is culled here");
      }
      places_.push_back(place);
      result_.views.push_back(report);
    }
    // Said once, and only where something is drawn.
    if (!settings_.clusters.reason.empty() && any_window()) {
      Stage stage = stage_of("sub-object level", settings_.clusters.reason);
      stage.ran = !clusters_.empty();
      if (owners_of_one_) stage.reason = "triangles are owners";
      stage.out = state_.live.size();
      result_.stages.push_back(stage);
    }
  }

  void begin_round() {
    ++round_;
    before_round_ = changes();
  }

  // Whether the round that ends changed something, so that another one may. What follows an empty
  // set is left out.
  bool round_changed() {
    if (done_ || changes() == before_round_) return false;
    if (!state_.live.empty() || settings_.full) return true;
    leave_out("further rounds", "nothing is left");
    return false;
  }

  // Whether the visit that comes is left out; says why.
  bool leaves_out(std::size_t view) {
    Place& place = places_[view];
    at_ = settings_.views[view].name + ", round " + std::to_string(round_);
    if (!place.window || done_) return true;
    if (settings_.full) return false;
    if (state_.live.empty()) {
      leave_out("view " + at_, "nothing is left");
    } else if (!due(place, kF) && !due(place, kL)) {
      leave_out("view " + at_, "what its passes store has not changed since the last visit");
      result_.stages.back().draws_saved = place.plain.draws;
      result_.stages.back().queries_saved = place.plain.queries;
      saved_ += place.plain;
      tell(triangles_, kF);
      tell(triangles_, kL);
    } else {
      return false;
    }
    return true;
  }

  void begin_visit(std::size_t view) {
    if (progress_) progress_("culling along " + at_);
    place_ = &places_[view];
    Stage stage = stage_of("fatten " + at_, settings_.fattener.name);
    stage.ran = true;
    items_ = state_.live;
    FattenCounts counts;
    drawables_ = fatten(scene_, items_, *place_->window, settings_.fattener,
                        result_.views[view].radius_px, counts);
    canvas_.begin(*place_->window, drawables_);
    stage.out = drawables_.elements();
    if (counts.undrawable > 0) {
      stage.reason +=
          "; " + std::to_string(counts.undrawable) + " triangles beyond the budget, kept";
    }
    finish(stage);
  }

  bool has_object_level() const { return !owners_of_one_; }

  // Both passes over the open triangles at one level.
  void run_level(const Level& level) {
    if (state_.live.empty() && !settings_.full) {
      leave_out("cull " + level.name + " " + at_, "no such level: nothing is left");
      return;
    }
    Stage stage = stage_of("cull " + level.name + " " + at_, "");
    stage.ran = true;
    if (rule_.forgets) state_.forget();
    int passes = 0;
    for (const Bit bit : {kF, kL}) passes += run_one(level, bit, stage);
    state_.bury();
    stage.out = state_.live.size();
    stage.reason = std::to_string(passes) + (passes == 1 ? " pass" : " passes");
    if (passes < 2) stage.reason += ", the other stores what it stored at the last visit";
    finish(stage);
  }

  void end_visit() {
    place_->plain = {};
    if (!rule_.forgets) {
      place_->plain += plain_cost(state_, items_, drawables_, kF, triangles_);
      place_->plain += plain_cost(state_, items_, drawables_, kL, triangles_);
    }
    if (settings_.full || settings_.enough == 0 || state_.live.size() > settings_.enough) return;
    done_ = true;
    leave_out("further views", std::to_string(state_.live.size()) +
                                   " triangles are left, at most " +
                                   std::to_string(settings_.enough) + " are enough");
  }

  CullResult result() {
    if (rule_.forgets) state_.forget();
    result_.live = std::move(state_.live);
    std::sort(result_.live.begin(), result_.live.end());
    result_.bits = std::move(state_.bits);
    return std::move(result_);
  }

 private:
  // The clusters of a run are fixed, so that fewer open triangles never ask in larger company.
  void arrange_clusters() {
    if (owners_of_one_ || settings_.clusters.sizes.empty()) return;
    state_.live = spatial_order(state_.live, state_.owner, plan_.triangle_boxes);
    groups_.reserve(settings_.clusters.sizes.size());  // levels point into it
    for (const std::uint32_t size : settings_.clusters.sizes) {
      groups_.push_back(cluster_numbers(state_.live, state_.owner, size));
      clusters_.push_back({"clusters of " + std::to_string(size), &groups_.back()});
    }
  }

  bool any_window() const {
    return std::any_of(places_.begin(), places_.end(),
                       [](const Place& p) { return p.window.has_value(); });
  }

  std::uint64_t changes() const {
    return rule_.forgets ? state_.deaths : state_.changes[0] + state_.changes[1];
  }

  // What the pass that asks `bit` stores has this version: the other bit decides.
  std::uint64_t stored_version(Bit bit) const { return state_.changes[bit == kF]; }
  bool due(const Place& place, Bit bit) const {
    return settings_.full || rule_.forgets || stored_version(bit) != place.stored[bit == kL];
  }

  bool run_one(const Level& level, Bit bit, Stage& stage) {
    const bool leave_out = &level == &triangles_ && !due(*place_, bit);
    PassCost plain, cost;
    if (!rule_.forgets) plain = plain_cost(state_, items_, drawables_, bit, level);
    if (!leave_out) {
      if (&level == &triangles_) place_->stored[bit == kL] = stored_version(bit);
      cost = run_pass(state_, items_, drawables_, bit, rule_, level, settings_.touching, canvas_);
    }
    stage.draws += cost.draws;
    stage.queries += cost.queries;
    used_ += cost;
    if (!rule_.forgets) {
      const PassCost saved = {plain.draws - cost.draws, plain.queries - cost.queries};
      stage.draws_saved += saved.draws;
      stage.queries_saved += saved.queries;
      saved_ += saved;
    }
    tell(level, bit);
    return !leave_out;
  }

  void tell(const Level& level, Bit bit) const {
    if (!settings_.watch) return;
    settings_.watch(
        {.name = level.name + " " + at_ + (bit == kF ? ", first pass" : ", second pass"),
         .bits = state_.bits,
         .draws = used_.draws,
         .queries = used_.queries,
         .draws_saved = saved_.draws,
         .queries_saved = saved_.queries});
  }

  Stage stage_of(const std::string& name, const std::string& reason) {
    watch_ = Stopwatch();
    return {.name = name, .reason = reason, .in = state_.live.size(), .unit = "triangles"};
  }
  void finish(Stage& stage) {
    stage.ms = watch_.ms();
    result_.stages.push_back(stage);
  }
  void leave_out(const std::string& name, const std::string& reason) {
    Stage stage = stage_of(name, reason);
    stage.out = stage.in;
    result_.stages.push_back(stage);
  }

  const PassRule& rule_;
  const Scene& scene_;
  const Plan& plan_;
  const CullSettings& settings_;
  Canvas& canvas_;
  const Progress& progress_;
  CullResult result_;
  CullState state_;
  bool owners_of_one_ = false;
  std::vector<std::vector<std::uint32_t>> groups_;  // per size of clusters, per triangle
  Level objects_{"objects", &state_.owner};
  std::vector<Level> clusters_;
  Level triangles_{"triangles"};
  std::vector<Place> places_;

  int round_ = 0;
  std::uint64_t before_round_ = 0;
  bool done_ = false;  // few enough triangles are left
  PassCost used_, saved_;

  // Of the visit that goes on.
  std::string at_;  // "z, round 1"
  Place* place_ = nullptr;
  std::vector<std::uint32_t> items_;
  Drawables drawables_;
  Stopwatch watch_;
};

}  // namespace

CullResult cull(const Scene& scene, const Plan& plan, const CullSettings& settings, Canvas& canvas,
                const Progress& progress) {
  return cull_by(settings.quick ? kQuickRule : kPlainRule, scene, plan, settings, canvas, progress);
}

CullResult cull_by(const PassRule& rule, const Scene& scene, const Plan& plan,
                   const CullSettings& settings, Canvas& canvas, const Progress& progress) {
  if (settings.resolution < 1 || settings.resolution > canvas.limits().max_resolution) {
    throw Error("--resolution",
                std::to_string(settings.resolution) + " is outside 1 .. " +
                    std::to_string(canvas.limits().max_resolution) + ", the limit of this device",
                "choose a resolution in that range");
  }
  Culling run(rule, scene, plan, settings, canvas, progress);
  run.open_views();
  do {
    run.begin_round();
    for (std::size_t view = 0; view < run.views(); ++view) {
      if (run.leaves_out(view)) continue;
      run.begin_visit(view);
      if (run.round() == 1) {
        if (run.has_object_level()) run.run_level(run.objects());
        for (const Level& clusters : run.clusters()) run.run_level(clusters);
      }
      run.run_level(run.triangles());
      run.end_visit();
    }
  } while (run.round_changed());
  return run.result();
}

}  // namespace farcull
