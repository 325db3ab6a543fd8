// A plan is made of boxes and views; each view then takes candidates away from the ones before it.
#include "core/pairs/pairs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/pairs/cpu.h"
#include "core/scene/box_join.h"
#include "core/scene/members.h"

namespace farcull {
namespace {

// Pairs of the scene whose grown boxes overlap and one of whose triangles is in `some` (ascending):
// for triangles of which a view can say nothing.
std::vector<TrianglePair> pairs_by_boxes(const Scene& scene, const PairRegions& regions,
                                         std::span<const std::uint32_t> some, double clearance) {
  std::vector<Box> boxes(scene.triangles.size(), Box::empty());
  for (const std::uint32_t t : regions.triangles) boxes[t] = grown_box(scene, t, clearance);
  std::vector<TrianglePair> pairs = box_join(boxes, join_owners(scene), regions.triangles);
  if (some.size() < regions.triangles.size()) {
    std::erase_if(pairs, [&](const TrianglePair& pair) {
      return !std::binary_search(some.begin(), some.end(), pair.a) &&
             !std::binary_search(some.begin(), some.end(), pair.b);
    });
  }
  return pairs;
}

// Whether the boxes of two triangles, each grown by `half`, overlap: outward where half > 0, so
// that a distance of twice `half` or less is never lost.
bool boxes_meet(const Scene& scene, const TrianglePair& pair, double half) {
  const std::array<std::uint32_t, 3>&s = scene.triangles[pair.a], &t = scene.triangles[pair.b];
  const double *a = scene.vertices[s[0]].data(), *b = scene.vertices[s[1]].data(),
               *c = scene.vertices[s[2]].data();
  const double *d = scene.vertices[t[0]].data(), *e = scene.vertices[t[1]].data(),
               *f = scene.vertices[t[2]].data();
  const auto least = [](double x, double y) { return x < y ? x : y; };
  const auto most = [](double x, double y) { return x > y ? x : y; };
  for (int axis = 0; axis < 3; ++axis) {
    double lo0 = least(least(a[axis], b[axis]), c[axis]),
           hi0 = most(most(a[axis], b[axis]), c[axis]);
    double lo1 = least(least(d[axis], e[axis]), f[axis]),
           hi1 = most(most(d[axis], e[axis]), f[axis]);
    if (half > 0) {
      lo0 = std::nextafter(lo0 - half, -HUGE_VAL);
      hi0 = std::nextafter(hi0 + half, HUGE_VAL);
      lo1 = std::nextafter(lo1 - half, -HUGE_VAL);
      hi1 = std::nextafter(hi1 + half, HUGE_VAL);
    }
    if (lo0 > hi1 || lo1 > hi0) return false;
  }
  return true;
}

// Whether two triangles of one object share a vertex index.
bool share_index(const Scene& scene, const TrianglePair& pair) {
  const auto& [p, q, r] = scene.triangles[pair.b];
  bool shared = false;
  for (const std::uint32_t v : scene.triangles[pair.a]) shared |= (v == p) | (v == q) | (v == r);
  return shared;
}

// Pairs whose second corners are fetched ahead; the first ones are mostly those of the pair before.
constexpr std::size_t kAhead = 8;

// Those whose boxes overlap, in order; without neighbours where they are not asked for.
void keep_overlapping(const Scene& scene, const PairScene& seen, double clearance, unsigned threads,
                      std::vector<TrianglePair>& pairs) {
  const double half = half_of(clearance);
  const std::size_t chunks = chunks_for(pairs.size(), 2048, threads);
  std::vector<std::size_t> kept(chunks, 0);
  for_chunks(pairs.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t to = begin;
    for (std::size_t k = begin; k < end; ++k) {
      prefetch(scene, pairs[std::min(k + kAhead, end - 1)].b);
      pairs[to] = pairs[k];
      to += boxes_meet(scene, pairs[k], half) &&
            (seen.task.neighbours || seen.owners[pairs[k].a] != seen.owners[pairs[k].b] ||
             !share_index(scene, pairs[k]));
    }
    kept[chunk] = to - begin;
  });
  std::size_t to = 0;
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    const std::size_t from = pairs.size() * chunk / chunks;
    std::copy(pairs.begin() + from, pairs.begin() + from + kept[chunk], pairs.begin() + to);
    to += kept[chunk];
  }
  pairs.resize(to);
}

std::vector<TrianglePair> common(const std::vector<TrianglePair>& a,
                                 const std::vector<TrianglePair>& b) {
  std::vector<TrianglePair> out;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

std::vector<TrianglePair> merged(const std::vector<TrianglePair>& a,
                                 const std::vector<TrianglePair>& b) {
  std::vector<TrianglePair> out;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

// Whether one of the two is in the list.
bool has_any(const std::vector<std::uint32_t>& ascending, const TrianglePair& pair) {
  return std::binary_search(ascending.begin(), ascending.end(), pair.a) ||
         std::binary_search(ascending.begin(), ascending.end(), pair.b);
}

// Pairs that a further view is tried on, before it looks at all of them.
constexpr std::size_t kTried = 256;

// Whether a further view would keep every one of some candidates, evenly chosen: it then takes next
// to nothing away from the others. That is so where triangles lie on each other. A choice alone:
// no pair is lost either way.
bool keeps_sample(const Scene& scene, const PairRegions& regions, const PairChoice& choice,
                  double clearance, const std::vector<TrianglePair>& candidates,
                  std::size_t triangles) {
  std::vector<TrianglePair> sample;
  const std::size_t count = std::min(kTried, candidates.size());
  for (std::size_t k = 0; k < count; ++k) {
    sample.push_back(candidates[candidates.size() * k / count]);
  }
  const std::optional<PairWindow> window =
      pair_window(regions, choice.view, choice.resolution, clearance);
  if (!window) return true;
  PairScene seen;
  look(scene, regions, members_of(sample, scene.triangles.size()), *window, 1, seen);
  PairCounts counts;
  const std::vector<TrianglePair> kept =
      cpu_sample_backend(triangles)->raw_pairs(seen.task, counts);
  const auto& bad = seen.undrawable;
  return std::all_of(sample.begin(), sample.end(), [&](const TrianglePair& pair) {
    return std::binary_search(kept.begin(), kept.end(), pair) || has_any(bad, pair);
  });
}

std::optional<PairWindow> window_of(const PairPlan& plan, const PairChoice& choice) {
  return pair_window(plan.regions, choice.view, choice.resolution, plan.settings.clearance);
}

// The number of views that are looked at whatever the candidates, where they can be resolved.
std::size_t certain_views(const PairPlan& plan) {
  if (!plan.settings.views.empty()) return plan.choices.size();
  return plan.settings.full ? kMostPairViews : 1;
}

// One run over the views of a plan.
class Finding {
 public:
  Finding(const Scene& scene, const PairPlan& plan, PairBackend& backend, PairScene& seen,
          const Progress& progress)
      : scene_(scene), plan_(plan), backend_(backend), seen_(seen), progress_(progress) {}

  PairResult result() {
    for (std::size_t k = 0; k < plan_.choices.size(); ++k) {
      const PairChoice& choice = plan_.choices[k];
      if (asks_whether_to_go_on() && stops_before(choice)) break;
      if (skipped_) continue;
      look_along(choice, k < plan_.windows.size() ? plan_.windows[k] : window_of(plan_, choice));
    }
    if (first_) join_boxes();
    return std::move(out_);
  }

 private:
  bool asks_whether_to_go_on() {
    skipped_ = false;
    const PairSettings& settings = plan_.settings;
    return settings.views.empty() && !first_ && !(settings.full && looked_ < kMostPairViews);
  }

  // Whether no further view is looked at; or sets skipped_ where this one would take nothing away.
  bool stops_before(const PairChoice& choice) {
    const std::size_t triangles = plan_.regions.triangles.size();
    Stage stage = stage_of(choice);
    const bool enough = out_.candidates.size() <= kFurtherViewFrom * triangles;
    if (enough || looked_ == kMostPairViews) {
      stage.reason = enough ? Reason::few_candidates : Reason::enough_views;
      stage.n = enough ? out_.candidates.size() : 0;
      out_.stages.push_back(stage);
      return true;
    }
    if (keeps_sample(scene_, plan_.regions, choice, plan_.settings.clearance, out_.candidates,
                     triangles)) {
      stage.reason = Reason::keeps_sample;
      out_.stages.push_back(stage);
      ++looked_;
      skipped_ = true;
    }
    return false;
  }

  void look_along(const PairChoice& choice, const std::optional<PairWindow>& window) {
    const Stopwatch start;
    if (progress_) progress_("view " + choice.view.name);
    const std::vector<std::uint32_t> left =
        first_ ? std::vector<std::uint32_t>()
               : members_of(out_.candidates, scene_.triangles.size());
    const std::span<const std::uint32_t> triangles =
        first_ ? std::span<const std::uint32_t>(plan_.regions.triangles) : left;
    PairView view{.name = choice.view.name, .reason = choice.reason};
    Stage stage = stage_of(choice);
    stage.in = triangles.size();
    if (!window) {
      stage.reason = Reason::unresolvable_view;
      view.reason = reason_of(stage);
      out_.views.push_back(view);
      out_.stages.push_back(stage);
      return;
    }
    look(scene_, plan_.regions, triangles, *window, backend_.threads(), seen_);
    view.looked = true;
    view.width = seen_.window.width;
    view.height = seen_.window.height;
    view.pixel_size = seen_.window.pixel_size;
    const glsl::vec4& widening = seen_.task.widening;
    view.widening_px = std::max({widening.x, widening.y, widening.z});
    seen_.task.neighbours = plan_.settings.neighbours;
    const double prepare_ms = start.ms();
    std::vector<TrianglePair> pairs = backend_.raw_pairs(seen_.task, view.counts);
    view.counts.undrawable = seen_.undrawable.size();
    view.counts.prepare_ms = prepare_ms;
    narrow(std::move(pairs));
    first_ = false;
    ++looked_;
    stage.ran = true;
    stage.reason = Reason::chosen;
    stage.detail = choice.reason;
    stage.n = static_cast<std::uint64_t>(view.width);
    stage.m = static_cast<std::uint64_t>(view.height);
    stage.ms = start.ms();
    stage.out = out_.candidates.size();
    out_.views.push_back(view);
    out_.stages.push_back(stage);
  }

  // The candidates after a view whose raw pairs these are. A view says nothing about triangles that
  // it cannot show.
  void narrow(std::vector<TrianglePair> pairs) {
    const double clearance = plan_.settings.clearance;
    const std::vector<std::uint32_t>& bad = seen_.undrawable;
    if (first_) {
      keep_overlapping(scene_, seen_, clearance, backend_.threads(), pairs);
      if (!bad.empty())
        pairs = merged(pairs, pairs_by_boxes(scene_, plan_.regions, bad, clearance));
      out_.candidates = std::move(pairs);
      return;
    }
    std::vector<TrianglePair> unseen;
    for (const TrianglePair& pair : out_.candidates) {
      if (has_any(bad, pair)) unseen.push_back(pair);
    }
    out_.candidates = common(out_.candidates, merged(pairs, unseen));
  }

  void join_boxes() {
    const std::vector<std::uint32_t>& all = plan_.regions.triangles;
    if (all.empty()) return;
    const Stopwatch start;
    if (progress_) progress_("joining boxes");
    out_.candidates = pairs_by_boxes(scene_, plan_.regions, all, plan_.settings.clearance);
    out_.stages.push_back({.kind = StageKind::join,
                           .ran = true,
                           .reason = Reason::join_unresolvable,
                           .ms = start.ms(),
                           .in = all.size(),
                           .out = out_.candidates.size(),
                           .unit = Unit::pairs});
  }

  Stage stage_of(const PairChoice& choice) const {
    return {.kind = StageKind::view,
            .subject = choice.view.name,
            .depends = !first_ && looked_ >= certain_views(plan_),
            .unit = Unit::pairs};
  }

  const Scene& scene_;
  const PairPlan& plan_;
  PairBackend& backend_;
  PairScene& seen_;
  const Progress& progress_;
  PairResult out_;
  bool first_ = true;  // no view has said anything yet
  bool skipped_ = false;
  std::size_t looked_ = 0;
};

std::vector<PairChoice> given_choices(const Scene& scene, const PairRegions& regions,
                                      const PairSettings& settings) {
  std::vector<PairChoice> choices;
  const bool given = settings.resolution > 0;
  for (const View& view : settings.views) {
    choices.push_back({view,
                       given ? settings.resolution : choose_pair_resolution(scene, regions, view),
                       given ? "direction and resolution given"
                             : "direction given; pixels by the triangles' sizes"});
  }
  return choices;
}

}  // namespace

PairPlan plan_pairs(const Scene& scene, const PairSettings& settings, unsigned threads) {
  if (!(settings.clearance >= 0) || !std::isfinite(settings.clearance)) {
    throw std::logic_error("plan_pairs: the clearance is negative or not finite");
  }
  if (scene.triangles.size() + scene.objects.size() >= std::size_t{1} << 31) {
    throw Error(scene.name, "has 2^31 triangles and objects, or more", "split it into scenes");
  }
  const Stopwatch planning;
  PairPlan plan{.settings = settings,
                .regions = pair_regions(scene, settings.clearance, settings.full, threads),
                .choices = {},
                .windows = {},
                .trace = {}};
  plan.trace.push_back({.kind = StageKind::boxes,
                        .ran = true,
                        .reason = settings.full ? Reason::full : Reason::meetings,
                        .n = settings.full ? 0 : plan.regions.pairs,
                        .m = settings.full ? 0 : plan.regions.self,
                        .ms = planning.ms(),
                        .in = scene.triangles.size(),
                        .out = plan.regions.triangles.size(),
                        .unit = Unit::triangles});
  if (plan.regions.triangles.empty()) {
    plan.trace.push_back(
        {.kind = StageKind::views, .reason = Reason::no_boxes_overlap, .unit = Unit::pairs});
    return plan;
  }
  const Stopwatch choosing;
  const bool chosen = settings.views.empty();
  plan.choices = chosen ? choose_pair_views(scene, plan.regions, settings.resolution)
                        : given_choices(scene, plan.regions, settings);
  plan.trace.push_back({.kind = StageKind::choose,
                        .ran = true,
                        .reason = chosen ? Reason::views_chosen : Reason::views_given,
                        .ms = choosing.ms(),
                        .in = plan.choices.size(),
                        .out = chosen ? 1 : plan.choices.size(),
                        .unit = Unit::views});
  std::size_t resolved = 0;
  for (const PairChoice& choice : plan.choices) {
    if (resolved == certain_views(plan)) break;
    plan.windows.push_back(window_of(plan, choice));
    resolved += plan.windows.back().has_value();
  }
  return plan;
}

std::vector<Stage> planned_stages(const PairPlan& plan) {
  std::vector<Stage> stages;
  const bool chosen = plan.settings.views.empty();
  std::size_t looked = 0;
  for (std::size_t k = 0; k < plan.choices.size(); ++k) {
    const PairChoice& choice = plan.choices[k];
    Stage stage{.kind = StageKind::view, .subject = choice.view.name, .unit = Unit::pairs};
    if (k >= plan.windows.size()) {
      stage.depends = true;
      stage.ran = looked++ < kMostPairViews;
      stage.reason = stage.ran ? Reason::if_more_candidates : Reason::enough_views;
      stage.n = stage.ran ? kFurtherViewFrom : 0;
    } else if (const std::optional<PairWindow>& window = plan.windows[k]) {
      ++looked;
      stage.ran = true;
      stage.reason = Reason::chosen;
      stage.detail = choice.reason;
      stage.n = static_cast<std::uint64_t>(window->window.width);
      stage.m = static_cast<std::uint64_t>(window->window.height);
    } else {
      stage.reason = Reason::unresolvable_view;
    }
    stages.push_back(stage);
    if (chosen && stage.depends && !stage.ran) break;
  }
  if (looked == 0 && !plan.choices.empty())
    stages.push_back({.kind = StageKind::join,
                      .ran = true,
                      .reason = Reason::join_unresolvable,
                      .unit = Unit::pairs});
  return stages;
}

PairResult find_pairs(const Scene& scene, const PairPlan& plan, PairBackend& backend,
                      PairScene& workspace, const Progress& progress) {
  return Finding(scene, plan, backend, workspace, progress).result();
}

PairResult find_pairs(const Scene& scene, const PairSettings& settings, PairBackend& backend) {
  const PairPlan plan = plan_pairs(scene, settings, backend.threads());
  PairScene workspace;
  PairResult result = find_pairs(scene, plan, backend, workspace);
  result.stages.insert(result.stages.begin(), plan.trace.begin(), plan.trace.end());
  return result;
}

}  // namespace farcull
