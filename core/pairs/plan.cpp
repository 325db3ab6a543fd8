// Makes the plan: what boxes of blocks decide, and which views are looked at for the rest.
#include "core/pairs/pairs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/boxes/join.h"
#include "core/scene/scene.h"

namespace farcull {

bool has_any(std::span<const std::uint32_t> ascending, const TrianglePair& pair) {
  return std::binary_search(ascending.begin(), ascending.end(), pair.a) ||
         std::binary_search(ascending.begin(), ascending.end(), pair.b);
}

namespace {

// Pairs that a view is tried on, before it looks at all of them.
constexpr std::size_t kTried = 256;
// A view that would keep more than this part of the pairs of overlapping boxes is no help: it finds
// each of them in several pixels.
constexpr double kKeptByView = 0.5;

}  // namespace

double kept_by(const Scene& scene, const PairRegions& regions, const PairChoice& choice,
               double clearance, const std::vector<TrianglePair>& from) {
  std::vector<TrianglePair> sample;
  const std::size_t count = std::min(kTried, from.size());
  for (std::size_t k = 0; k < count; ++k) sample.push_back(from[from.size() * k / count]);
  const std::optional<PairWindow> window =
      pair_window(regions, choice.view, choice.resolution, clearance);
  if (!window) return 1;
  PairScene seen;
  look(scene, regions, members_of(sample, scene.triangles.size()), *window, 1, seen);
  PairCounts counts;
  const std::vector<TrianglePair> kept =
      cpu_sample_backend(regions.triangles.size())->raw_pairs(seen.task, counts);
  const auto& bad = seen.undrawable;
  const auto left = std::ranges::count_if(sample, [&](const TrianglePair& pair) {
    return std::binary_search(kept.begin(), kept.end(), pair) || has_any(bad, pair);
  });
  return static_cast<double>(left) / static_cast<double>(count);
}

std::optional<PairWindow> window_of(const PairPlan& plan, const PairChoice& choice) {
  return pair_window(plan.regions, choice.view, choice.resolution, plan.settings.clearance);
}

Stage stage_of_join(Reason reason, std::uint64_t n, const std::string& detail) {
  return {.kind = StageKind::join,
          .ran = true,
          .reason = reason,
          .detail = detail,
          .n = n,
          .unit = Unit::pairs};
}

Stage stage_of_blocks(const PairPlan& plan) {
  const std::size_t compared = plan.blocks.pairs.size();
  return {.kind = StageKind::blocks,
          .ran = true,
          .reason = plan.blocks.oriented ? Reason::oriented_pairs : Reason::block_pairs,
          .detail = compared < plan.blocks.overlaps ? std::to_string(compared) : "",
          .n = plan.blocks.overlaps,
          .m = plan.blocks.meetings,
          .in = plan.blocks.triangles,
          .unit = Unit::pairs};
}

std::size_t certain_views(const PairPlan& plan) {
  if (!plan.settings.views.empty()) return plan.choices.size();
  return plan.settings.full ? kMostPairViews : 1;
}

namespace {

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

// An estimate of how many pairs of boxes overlap, and some of these pairs.
struct PairEstimate {
  double pairs = 0;
  std::vector<TrianglePair> sample;
};

// Compares the boxes of a few triangles with those of some others. The eighth of the few that meets
// most is left out, since one huge box says nothing about the others.
PairEstimate estimated_pairs(const Scene& scene, std::span<const std::uint32_t> triangles,
                             double clearance) {
  constexpr std::size_t kAsked = 32, kOthers = 8192;
  const std::vector<std::uint32_t> owner = join_owners(scene);
  const std::size_t n = triangles.size();
  const std::size_t asked = std::min(n, kAsked), others = std::min(n, kOthers);
  std::vector<Box> boxes;
  for (std::size_t k = 0; k < others; ++k)
    boxes.push_back(grown_box(scene, triangles[n * k / others], clearance));
  std::vector<std::vector<TrianglePair>> found(asked);
  for (std::size_t a = 0; a < asked; ++a) {
    const std::uint32_t one = triangles[n * a / asked];
    const Box box = grown_box(scene, one, clearance);
    for (std::size_t k = 0; k < others; ++k) {
      const std::uint32_t other = triangles[n * k / others];
      if (owner[one] != owner[other] && overlap(box, boxes[k]))
        found[a].push_back({std::min(one, other), std::max(one, other)});
    }
  }
  std::ranges::sort(found, {}, &std::vector<TrianglePair>::size);
  found.resize(asked - asked / 8);
  PairEstimate out;
  for (const auto& some : found) out.sample.insert(out.sample.end(), some.begin(), some.end());
  std::ranges::sort(out.sample);
  const auto repeated = std::ranges::unique(out.sample);
  const auto part = [n](std::size_t of) {
    return static_cast<double>(n) / static_cast<double>(of);
  };
  out.pairs = 0.5 * static_cast<double>(out.sample.size()) * part(found.size()) * part(others);
  out.sample.erase(repeated.begin(), repeated.end());
  return out;
}

std::uint64_t most_tests_of(const Scene& scene, const PairPlan& plan, bool asked) {
  const std::vector<std::uint32_t>& triangles = plan.regions.triangles;
  const double pairs = estimated_pairs(scene, triangles, plan.settings.clearance).pairs;
  // The constant allows some milliseconds in any scene: a few triangles may have many pixels.
  const double most =
      0x1p20 + kTestsPerTriangle * static_cast<double>(triangles.size()) + kTestsPerPair * pairs;
  return static_cast<std::uint64_t>(std::min(0x1p63, (asked ? kOfAskedViews : 1) * most));
}

// Leaves an uneven scene whose boxes overlap often (as those of needles do) to views, if the best
// view takes enough pairs away.
void try_views(const Scene& scene, unsigned threads, const PairSettings& settings, PairParts& parts,
               std::vector<PairChoice>& choices) {
  const PairEstimate estimate = estimated_pairs(scene, parts.rest.triangles, settings.clearance);
  const auto n = static_cast<double>(parts.rest.triangles.size());
  if (estimate.pairs <= static_cast<double>(kOverlapsPerTriangle) * n) return;
  PairRegions regions = pair_regions(scene, settings.clearance, false, threads, settings.ignored);
  if (regions.triangles.empty()) return;
  std::vector<PairChoice> views = choose_pair_views(scene, regions, 0);
  if (kept_by(scene, regions, views.front(), settings.clearance, estimate.sample) > kKeptByView)
    return;
  parts = {.blocks = {}, .rest = std::move(regions)};
  choices = std::move(views);
}

// The number of triangles that take part in pairs that blocks decide, or views, or both.
std::uint64_t taking_part(const Scene& scene, const PairPlan& plan) {
  if (plan.blocks.empty()) return plan.regions.triangles.size();
  if (plan.regions.triangles.empty()) return plan.blocks.triangles;
  std::vector<std::uint8_t> takes_part(scene.triangles.size(), 0);
  for (const std::uint32_t t : plan.regions.triangles) takes_part[t] = 1;
  const auto mark = [&](std::uint32_t index) {
    const TriangleBlock& block = plan.blocks.of->ranges[index];
    for (std::uint32_t k = 0; k < block.count; ++k) {
      takes_part[plan.blocks.of->triangle(block.first + k)] = 1;
    }
  };
  for (const BlockPair& pair : plan.blocks.pairs.between) mark(pair.a), mark(pair.b);
  for (const BlockPair& pair : plan.blocks.pairs.inside) mark(pair.a), mark(pair.b);
  return static_cast<std::uint64_t>(std::ranges::count(takes_part, 1));
}

// Whether the memory knows the scene's last frame, and that is of use. If not, the memory is made
// ready to keep this one.
bool knows_last_frame(const PairSettings& settings, PairMemory& memory) {
  const std::optional<std::uint64_t> last =
      std::exchange(memory.frame, {});  // until this frame is found
  if (last && memory.moved.follows(*last) && memory.clearance == settings.clearance &&
      memory.neighbours == settings.neighbours && memory.ignored == settings.ignored &&
      (!memory.oriented || !memory.moved.any()) && mostly_unmoved(memory.moved, memory.pairs))
    return true;
  memory.clearance = settings.clearance;
  memory.neighbours = settings.neighbours;
  memory.ignored = settings.ignored;
  memory.blocks.reset();
  return false;
}

// The words for pairs that a stage of boxes leaves out.
std::string apart(const PairSettings& settings) {
  return settings.ignored.empty() ? "" : "ignored ones";
}

Stage stage_of_boxes(const Scene& scene, const PairPlan& plan, double ms, std::uint64_t out) {
  const bool full = plan.settings.full;
  return {.kind = StageKind::boxes,
          .ran = true,
          .reason = full                   ? Reason::full
                    : plan.regions.crowded ? Reason::crowded
                                           : Reason::meetings,
          .detail = full ? "" : apart(plan.settings),
          .n = full ? 0 : plan.regions.pairs,
          .m = full ? 0 : plan.regions.self,
          .ms = ms,
          .in = scene.triangles.size(),
          .out = out,
          .unit = Unit::triangles};
}

Stage stage_of_choice(Reason reason, double ms, std::size_t in, std::size_t out) {
  return {.kind = StageKind::choose,
          .ran = true,
          .reason = reason,
          .ms = ms,
          .in = in,
          .out = out,
          .unit = Unit::views};
}

// Splits the meetings of a scene into those that boxes of blocks decide and those that views do,
// and chooses the views.
void split_and_choose(const Scene& scene, unsigned threads, PairMemory* memory, PairPlan& plan) {
  const PairSettings& settings = plan.settings;
  const Stopwatch planning;
  const bool known = memory && knows_last_frame(settings, *memory);
  plan.remembers = memory != nullptr;
  const auto split = [&](bool all) {
    return known ? split_next_frame(scene, threads, all, *memory)
                 : split_meetings(scene, settings.clearance, threads, all, settings.ignored);
  };
  PairParts parts = split(false);
  const double split_ms = planning.ms();
  const Stopwatch choosing;
  if (parts.join == Reason::join_uneven) {
    try_views(scene, threads, settings, parts, plan.choices);
  } else if (parts.join == Reason::none && !parts.rest.triangles.empty()) {
    plan.choices = choose_pair_views(scene, parts.rest, 0);
    // No view separates triangles that lie on each other, and boxes are faster.
    if (!parts.sample.empty() && kept_by(scene, parts.rest, plan.choices.front(),
                                         settings.clearance, parts.sample) > kKeptByView) {
      PairParts by_blocks = split(true);
      if (by_blocks.rest.triangles.empty() || by_blocks.join != Reason::none) {
        plan.choices.clear();
        parts = std::move(by_blocks);
      }
    }
  }
  plan.join = parts.join;
  plan.join_n = parts.join_n;
  plan.blocks = std::move(parts.blocks);
  plan.regions = std::move(parts.rest);
  plan.trace.push_back(stage_of_boxes(scene, plan, split_ms, taking_part(scene, plan)));
  if (!plan.choices.empty()) {
    plan.trace.push_back(
        stage_of_choice(Reason::views_chosen, choosing.ms(), plan.choices.size(), 1));
    return;
  }
  const bool joined = plan.join != Reason::none, apart_all = !joined && plan.blocks.empty();
  plan.trace.push_back({.kind = StageKind::views,
                        .reason = joined      ? plan.join
                                  : apart_all ? Reason::no_boxes_overlap
                                              : Reason::only_blocks,
                        .detail = apart_all ? apart(settings) : "",
                        .n = plan.join_n,
                        .ms = choosing.ms(),
                        .unit = Unit::pairs});
}

// Leaves everything to views, because the caller wants views, or a resolution, or nothing left out.
void leave_to_views(const Scene& scene, unsigned threads, PairPlan& plan) {
  const PairSettings& settings = plan.settings;
  const Stopwatch planning;
  plan.regions = pair_regions(scene, settings.clearance, settings.full, threads, settings.ignored);
  plan.trace.push_back(stage_of_boxes(scene, plan, planning.ms(), plan.regions.triangles.size()));
  if (plan.regions.triangles.empty()) {
    plan.trace.push_back({.kind = StageKind::views,
                          .reason = Reason::no_boxes_overlap,
                          .detail = apart(settings),
                          .unit = Unit::pairs});
    return;
  }
  const Stopwatch choosing;
  const bool chosen = settings.views.empty();
  plan.choices = chosen ? choose_pair_views(scene, plan.regions, settings.resolution)
                        : given_choices(scene, plan.regions, settings);
  plan.trace.push_back(stage_of_choice(chosen ? Reason::views_chosen : Reason::views_given,
                                       choosing.ms(), plan.choices.size(),
                                       chosen ? 1 : plan.choices.size()));
}

}  // namespace

PairPlan plan_pairs(const Scene& scene, const PairSettings& settings, unsigned threads,
                    PairMemory* memory) {
  if (!(settings.clearance >= 0) || !std::isfinite(settings.clearance)) {
    throw std::logic_error("plan_pairs: the clearance is negative or not finite");
  }
  if (scene.triangles.size() + scene.objects.size() >= std::size_t{1} << 31) {
    throw Error(scene.name, "has 2^31 triangles and objects, or more", "split it into scenes");
  }
  PairPlan plan;
  plan.settings = settings;
  plan.threads = threads;
  const bool asked =
      !settings.blocks || !settings.views.empty() || settings.resolution > 0 || settings.full;
  if (!asked) {
    split_and_choose(scene, threads, memory, plan);
  } else {
    if (memory) memory->frame.reset();
    leave_to_views(scene, threads, plan);
  }
  if (!plan.choices.empty()) plan.most_tests = most_tests_of(scene, plan, asked);
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
  if (!plan.blocks.empty()) stages.push_back(stage_of_blocks(plan));
  if (plan.join != Reason::none) stages.push_back(stage_of_join(plan.join, plan.join_n));
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
  if (looked == 0 && !plan.choices.empty()) {
    stages.push_back(stage_of_join(Reason::join_unresolvable));
  } else if (looked > 0) {
    stages.push_back(stage_of_join(Reason::if_more_tests, plan.most_tests));
    stages.back().depends = true;
  }
  return stages;
}

}  // namespace farcull
