// Boxes of blocks give their pairs; each view takes candidates away that the views before it left.
#include "core/pairs/pairs.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/boxes/join.h"
#include "core/boxes/oriented.h"
#include "core/scene/scene.h"

namespace farcull {
namespace {

// Up to so many triangles are compared with all others one by one: a join of all boxes would find
// every pair of boxes that overlap, to keep few of them.
constexpr std::size_t kComparedWithAll = 256;

// Pairs that count, of one of a few triangles (ascending) and any other, whose grown boxes overlap.
std::vector<TrianglePair> pairs_of_few(const Scene& scene, const PairRegions& regions,
                                       std::span<const std::uint32_t> few, double clearance) {
  const std::vector<std::uint32_t> owner = join_owners(scene);
  std::vector<Box> boxes;
  for (const std::uint32_t t : few) boxes.push_back(grown_box(scene, t, clearance));
  std::vector<TrianglePair> pairs;
  for (const std::uint32_t t : regions.triangles) {
    const Box box = grown_box(scene, t, clearance);
    const bool one = std::binary_search(few.begin(), few.end(), t);
    for (std::size_t k = 0; k < few.size(); ++k) {
      // A pair of two of the few is found once, from the larger one.
      if (owner[t] == owner[few[k]] || (one && t < few[k]) || !overlap(box, boxes[k])) continue;
      pairs.push_back({std::min(t, few[k]), std::max(t, few[k])});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Whether a pair counts although its triangles may be neighbours. owners: of the triangles; empty
// if neighbours count.
bool neighbours_count(const Scene& scene, std::span<const std::uint32_t> owners,
                      const TrianglePair& pair) {
  return owners.empty() || owners[pair.a] != owners[pair.b] ||
         !share_index(scene.triangles[pair.a], scene.triangles[pair.b]);
}

// Pairs of the scene whose grown boxes overlap and one of whose triangles is in `some` (ascending):
// for triangles that a view cannot show.
std::vector<TrianglePair> pairs_by_boxes(const Scene& scene, const PairRegions& regions,
                                         std::span<const std::uint32_t> some,
                                         const PairSettings& settings, unsigned threads) {
  if (some.size() <= kComparedWithAll)
    return pairs_of_few(scene, regions, some, settings.clearance);
  std::mutex mutex;
  std::vector<TrianglePair> found;
  OrderedPairs(scene, settings.clearance, settings.ignored, settings.neighbours, threads)
      .give([&](std::vector<TrianglePair>& pairs) {
        std::erase_if(pairs, [&](const TrianglePair& pair) { return !has_any(some, pair); });
        const std::scoped_lock lock(mutex);
        found.insert(found.end(), pairs.begin(), pairs.end());
      });
  std::ranges::sort(found);
  return found;
}

// How many pairs ahead the corners of second triangles are prefetched. The first triangle is mostly
// that of the pair before.
constexpr std::size_t kAhead = 8;

// Keeps the pairs whose boxes overlap, in order. owners: as neighbours_count() takes them.
void keep_overlapping(const Scene& scene, std::span<const std::uint32_t> owners, double clearance,
                      unsigned threads, std::vector<TrianglePair>& pairs) {
  const double half = half_of(clearance);
  const std::size_t chunks = chunks_for(pairs.size(), 2048, threads);
  std::vector<std::size_t> kept(chunks, 0);
  for_chunks(pairs.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t to = begin;
    for (std::size_t k = begin; k < end; ++k) {
      prefetch(scene, pairs[std::min(k + kAhead, end - 1)].b);
      pairs[to] = pairs[k];
      to += boxes_meet(scene, pairs[k], half) && neighbours_count(scene, owners, pairs[k]);
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

// One run over the views of a plan.
class Finding {
 public:
  Finding(const Scene& scene, const PairPlan& plan, PairBackend& backend, PairWorkspace& workspace,
          const Progress& progress, const TakePairs& take)
      : scene_(scene),
        plan_(plan),
        backend_(backend),
        seen_(workspace.seen),
        memory_(workspace.memory),
        progress_(progress),
        take_(take) {}

  PairResult result() {
    compare_blocks();
    for (std::size_t k = 0; k < plan_.choices.size() && !given_up_; ++k) {
      const PairChoice& choice = plan_.choices[k];
      if (asks_whether_to_go_on() && stops_before(choice)) break;
      if (skipped_) continue;
      look_along(choice, k < plan_.windows.size() ? plan_.windows[k] : window_of(plan_, choice));
    }
    if (first_) join_boxes();
    if (plan_.remembers) remember();
    if (out_.given) return std::move(out_);  // a tree has the pairs of the blocks too
    if (out_.candidates.empty()) {
      out_.candidates = std::move(of_blocks_);
    } else if (!of_blocks_.empty()) {
      out_.candidates = merged(out_.candidates, of_blocks_);
    }
    out_.count = out_.candidates.size();
    return std::move(out_);
  }

 private:
  void compare_blocks() {
    if (plan_.blocks.empty()) return;
    const Stopwatch start;
    const PairSettings& settings = plan_.settings;
    const bool alone = plan_.choices.empty() && plan_.regions.triangles.empty();
    out_.given = take_ && alone && !settings.lists && !plan_.remembers;
    if (out_.given) {
      out_.count =
          give_pairs_of_blocks(scene_, plan_.blocks, plan_.blocks.pairs, settings.clearance,
                               settings.neighbours, plan_.threads, take_);
    } else {
      of_blocks_ = pairs_of_blocks(scene_, plan_.blocks, settings.clearance, settings.neighbours,
                                   plan_.threads);
    }
    Stage stage = stage_of_blocks(plan_);
    stage.ms = start.ms();
    stage.out = out_.given ? out_.count : of_blocks_.size();
    out_.stages.push_back(stage);
  }

  // Keeps what blocks decided for the next frame; views tell nothing about it.
  void remember() {
    const bool complete = plan_.regions.triangles.empty();
    memory_.frame = complete ? std::optional(memory_.moved.frame()) : std::nullopt;
    // While nothing moves the plan has no blocks, and the pairs are those of the frame before.
    if (plan_.blocks.of) memory_.oriented = plan_.blocks.oriented != nullptr;
    memory_.pairs = complete ? of_blocks_ : std::vector<TrianglePair>();
    memory_.overlaps = plan_.blocks.overlaps;
    memory_.meetings = plan_.blocks.meetings;
    memory_.triangles = plan_.blocks.triangles;
    memory_.object_pairs = plan_.regions.pairs;
    memory_.self = plan_.regions.self;
  }

  bool asks_whether_to_go_on() {
    skipped_ = false;
    const PairSettings& settings = plan_.settings;
    return settings.views.empty() && !first_ && !(settings.full && looked_ < kMostPairViews);
  }

  // Whether no further view is looked at. Sets skipped_ if this one would take nothing away.
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
    // A view that keeps all of a sample takes almost nothing away: the triangles lie on each other.
    if (kept_by(scene_, plan_.regions, choice, plan_.settings.clearance, out_.candidates) == 1) {
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
    seen_.task.most_tests = plan_.most_tests;
    seen_.task.narrow = [&](std::vector<TrianglePair>& pairs) {
      keep_overlapping(scene_, {}, plan_.settings.clearance, 1, pairs);
    };
    const double prepare_ms = start.ms();
    std::vector<TrianglePair> pairs = backend_.raw_pairs(seen_.task, view.counts);
    view.counts.undrawable = seen_.undrawable.size();
    view.counts.prepare_ms = prepare_ms;
    const bool further = !first_;
    if (view.counts.given_up) {
      given_up_ = choice.view.name;
    } else {
      narrow(std::move(pairs));
      first_ = false;
    }
    ++looked_;
    stage.ran = true;
    stage.reason = Reason::chosen;
    stage.detail = choice.reason;
    stage.n = static_cast<std::uint64_t>(view.width);
    stage.m = static_cast<std::uint64_t>(view.height);
    if (further && view.counts.given_up) {
      stage.reason = Reason::given_up;
      stage.n = plan_.most_tests;
    } else if (view.counts.given_up) {
      stage.unit = Unit::none;  // nothing came out; a stage that follows says why
    }
    stage.ms = start.ms();
    stage.out = out_.candidates.size();
    out_.views.push_back(view);
    out_.stages.push_back(stage);
  }

  // Takes away the candidates that are not among the raw pairs of a view. A view says nothing about
  // triangles that it cannot show.
  void narrow(std::vector<TrianglePair> pairs) {
    const double clearance = plan_.settings.clearance;
    const std::vector<std::uint32_t>& bad = seen_.undrawable;
    if (first_) {
      const std::span<const std::uint32_t> owners(seen_.owners);
      keep_overlapping(scene_, seen_.task.neighbours ? owners.first(0) : owners, clearance,
                       backend_.threads(), pairs);
      if (!bad.empty()) {
        pairs = merged(
            pairs, pairs_by_boxes(scene_, plan_.regions, bad, plan_.settings, backend_.threads()));
      }
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
    const PairSettings& settings = plan_.settings;
    OrderedPairs tree(scene_, settings.clearance, settings.ignored, settings.neighbours,
                      plan_.threads);
    if (take_) {
      out_.count = tree.give(take_);
      out_.given = true;
    } else {
      out_.candidates = tree.all();
      out_.count = out_.candidates.size();
    }
    Stage stage = given_up_ ? stage_of_join(Reason::join_many_tests, plan_.most_tests, *given_up_)
                  : plan_.join != Reason::none ? stage_of_join(plan_.join, plan_.join_n)
                                               : stage_of_join(Reason::join_unresolvable);
    stage.depends = given_up_.has_value();
    stage.m = tree.compared();
    stage.ms = start.ms();
    stage.in = all.size();
    stage.out = out_.count;
    out_.stages.push_back(stage);
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
  PairMemory& memory_;
  const Progress& progress_;
  const TakePairs& take_;
  PairResult out_;
  std::vector<TrianglePair> of_blocks_;
  bool first_ = true;  // no view has said anything yet
  bool skipped_ = false;
  std::optional<std::string> given_up_ = {};  // the view that took too much work
  std::size_t looked_ = 0;
};

}  // namespace

PairResult find_pairs(const Scene& scene, const PairPlan& plan, PairBackend& backend,
                      PairWorkspace& workspace, const Progress& progress, const TakePairs& take) {
  return Finding(scene, plan, backend, workspace, progress, take).result();
}

PairResult find_pairs(const Scene& scene, const PairSettings& settings, PairBackend& backend) {
  const PairPlan plan = plan_pairs(scene, settings, backend.threads());
  PairWorkspace workspace;
  PairResult result = find_pairs(scene, plan, backend, workspace);
  result.stages.insert(result.stages.begin(), plan.trace.begin(), plan.trace.end());
  return result;
}

}  // namespace farcull
