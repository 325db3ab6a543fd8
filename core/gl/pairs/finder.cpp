// Finds the pairs of a window. If the sizes of buffers can be predicted from the last windows, or
// guessed from the bounds of its triangles, the window needs one readback: each dispatch reads on
// the device how much there is to do. If there was too little room for something, all is done
// again, step by step, and counts are read between the steps. A part of the window that is too much
// for the memory is split in two, down to single pixels.
//
// GlPairs owns a PairFinder and forgets it after any failure, so that nothing on the device is
// believed then.
#include "core/gl/pairs/pairs.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/gl/pairs/finder.h"
#include "core/pairs/backend.h"
#include "core/pairs/grid.h"

namespace farcull {
namespace {

void check_counted_twice(const PairTotalWords& totals, std::size_t levels) {
  bool same = totals[kTotalLargeFound] == totals[kTotalLarge] &&
              two_words(totals, kTotalRows) == totals[kTotalRowItems];
  for (std::size_t l = 1; l <= levels; ++l)
    same &= totals[of_level(kTotalCrowded, l)] == totals[of_level(kTotalParents, l)];
  if (!same)
    throw_lost("pairs", "the same was counted twice with different results", kLostInvocation);
}

// Whether a sample, an eighth of the triangles, predicts several times the work that may be done.
// The device reports its work only afterwards, so this check comes first. The number of pixels
// grows with the number of triangles, that of comparisons with its square.
bool takes_too_much(const PairTask& task) {
  constexpr std::size_t kOneOf = 8, kTimes = 4;
  if (task.most_tests == UINT64_MAX || std::max(task.width, task.height) > kMostCpuPixels)
    return false;
  std::vector<std::uint32_t> some;
  for (std::size_t k = 0; k < task.active.size(); k += kOneOf) some.push_back(task.active[k]);
  PairTask part = task;
  part.active = some;
  part.most_tests = task.most_tests / kOneOf;
  PairCounts counts;
  cpu_sample_backend(task.active.size())->raw_pairs(part, counts);
  return counts.given_up || counts.tests > kTimes * task.most_tests / (kOneOf * kOneOf);
}

}  // namespace

bool PartMemory::take(std::size_t bytes) {
  if (bytes > block && last) {
    throw Error("GL pairs", "one pixel needs a buffer of " + std::to_string(bytes) + " bytes",
                "use {device} cpu or a larger {resolution}");
  }
  if (last) return true;
  if (bytes > block || bytes > left) return false;
  left -= bytes;
  return true;
}

void check_lists(const PairTotalWords& totals) {
  if (totals[kTotalMismatches] == 0) return;
  throw_lost(
      "pairs",
      std::to_string(totals[kTotalMismatches]) + " lists were not filled as they were counted",
      "a compute invocation was lost, or two programs of this device round differently");
}

std::vector<TrianglePair> PairFinder::find(const PairTask& task, PairCounts& counts) {
  begin_window(task);
  if (task.active.empty()) {
    if (scene_.sent_bytes() > 0) device_.read("pairs upload");
  } else {
    const PairPart whole{0, task.width - 1, 0, task.height - 1};
    const SeenWindow window(task);
    const std::optional<PairForecast> room = expected_room(window);
    if (!room || !find_at_once(whole, *room)) split(whole);
    remember(window);
  }
  counts_.dispatches = device_.dispatches();
  counts_.readbacks = device_.readbacks();
  counts = counts_;
  std::vector<TrianglePair> pairs = found_->take(0);
  found_.reset();
  if (counts.given_up) pairs.clear();
  return pairs;
}

// Sends the scene, and sets the uniforms that all parts share.
void PairFinder::begin_window(const PairTask& task) {
  const Stopwatch start;
  task_ = &task;
  counts_ = {};
  counts_.bands = 0;
  device_.start(true);
  common_ = {};
  common_.widen = {task.widening.x, task.widening.y, task.widening.z, 0};
  common_.window = {task.width, task.height};
  const DepthSlices slices = depth_slices(task.near_px, task.far_px);
  common_.steps_per_px = slices.steps_per_px;
  common_.first_step = slices.first_step;
  common_.slices_per_step = slices.slices_per_step;
  common_.masked =
      std::any_of(task.self.begin(), task.self.end(), [](std::uint8_t self) { return self == 0; });
  owners_ = scene_.begin(task);
  begin_pairs();
  counts_.mark_ms = start.ms();
  fresh_ = true;
}

// Finds the pairs of the whole window with one wait; false: there was not room enough.
bool PairFinder::find_at_once(const PairPart& window, const PairForecast& room) {
  const PairCounts before = counts_;
  if (find_in(window, &room)) {
    counts_.bands = 1;
    return true;
  }
  counts_ = before;
  ++counts_.redone;
  begin_pairs();
  break_off_lists();
  return false;
}

// Finds the pairs of a part of the window step by step, in two halves if the part is too much.
void PairFinder::split(const PairPart& part) {
  if (counts_.given_up) return;
  const PairCounts before = counts_;
  if (find_in(part, nullptr)) {
    ++counts_.bands;
    return;
  }
  // The next parts use what was sent for this one, so read() checks it first.
  device_.read("pairs");
  counts_ = before;
  break_off_lists();
  PairPart low = part, high = part;
  if (part.height() > 1) {
    low.j1 = part.j0 + part.height() / 2 - 1;
    high.j0 = low.j1 + 1;
  } else {
    low.i1 = part.i0 + part.width() / 2 - 1;
    high.i0 = low.i1 + 1;
  }
  split(low);
  split(high);
}

// Makes the items, lists and pairs of one part. With `room`, nothing is read before the end.
bool PairFinder::find_in(const PairPart& part, const PairForecast* room) {
  part_ = part;
  room_ = room;
  memory_ = {options_.memory, device_.block(), room == nullptr && part.cells() == 1};
  // The bytes that every pixel needs, before any work is done.
  const std::size_t fixed =
      part.cells() * (2 * owners_.groups * kWord + (common_.masked ? 8 + 16 * owners_.bits : 0));
  if (room == nullptr && !memory_.last && (fixed > memory_.left / 2 || fixed > memory_.block))
    return false;

  begin_part();
  const Stopwatch marking;
  bool done = make_items();
  counts_.mark_ms += marking.ms();
  if (done && room == nullptr && wholes_ + items_ == 0) return true;

  const double marked = counts_.mark_ms;
  const Stopwatch listing;
  done = done && make_lists();
  counts_.list_ms += listing.ms() - (counts_.mark_ms - marked);

  const Stopwatch pairing;
  if (!done) {
    if (room != nullptr) device_.read("pairs");
    return false;
  }
  device_.stamp(PairStamp::listed);
  settle_pairs();
  PairTotalWords totals{};
  if (!make_pairs(totals)) return false;
  end_part(totals);
  counts_.pair_ms += pairing.ms();
  return true;
}

void PairFinder::begin_part() {
  if (!fresh_) device_.start(false);
  fresh_ = false;
  device_.stamp(PairStamp::begun);
  common_.tile = {part_.i0, part_.i1, part_.j0, part_.j1};
  seen_.reset();
}

// Adds the counts of a part that was done, and keeps them in seen_.
void PairFinder::end_part(const PairTotalWords& totals) {
  PairForecast seen;
  seen.triangles = task_->triangles.size();
  seen.wholes = totals[kTotalWholes];
  seen.items = totals[kTotalItems];
  seen.large = totals[kTotalLarge];
  seen.shown = totals[kTotalListed];
  seen.row_items = totals[kTotalRowItems];
  seen.pairs = emitted_;
  seen.more = most_units_;
  for (std::size_t l = 0; l <= kMaxLevel; ++l) {
    seen.entries[l] = totals[of_level(kTotalEntries, l)];
    seen.crowded[l] = totals[of_level(kTotalParents, l)];
  }
  // The time of the device; unknown for the window if it is unknown for a part.
  const auto add = [&](double& ms, PairStamp from, PairStamp to) {
    const double more = device_.between(from, to);
    ms = more < 0 || (counts_.bands > 0 && ms < 0) ? -1 : std::max(ms, 0.0) + more;
  };
  add(counts_.mark_device_ms, PairStamp::begun, PairStamp::marked);
  add(counts_.list_device_ms, PairStamp::marked, PairStamp::listed);
  add(counts_.pair_device_ms, PairStamp::listed, PairStamp::done);
  while (seen.levels < kMaxLevel && seen.crowded[seen.levels] > 0) ++seen.levels;
  check_counted_twice(totals, seen.levels);
  for (std::size_t l = 0; l <= levels_cut_; ++l) levels_[l].dirty = false;  // all was filled in
  counts_.listed += totals[kTotalListed] + totals[kTotalListedRows];
  counts_.crowded += seen.crowded[0];
  counts_.large = std::max<std::uint64_t>(counts_.large, seen.large);
  for (const std::size_t entries : seen.entries) counts_.entries += entries;
  seen_ = seen;
}

// After a part that was broken off, the counts of its levels may be anything.
void PairFinder::break_off_lists() {
  for (PairLevel& level : levels_) level.dirty = true;
}

// True if a sum went beyond 32 bits, so that the part must be split. Throws Error for a single
// pixel.
bool PairFinder::overflow(const PairTotalWords& totals) const {
  if (totals[kTotalOverflow] == 0) return false;
  if (memory_.last) {
    throw Error("GL pairs", "one pixel has more work than can be counted in 32 bits",
                "use {device} cpu or a larger {resolution}");
  }
  return true;
}

GlPairs::GlPairs(const GlContext& context, const GlPairOptions& options)
    : context_(context), options_(options) {
  const GlCurrent current(context);
  finder_ = std::make_unique<PairFinder>(context, options);
}

GlPairs::~GlPairs() { forget(); }

// Deletes everything on the device. If the context cannot be made current, the end of the context
// does that.
void GlPairs::forget() {
  if (!gl_forget(context_, [&] { finder_.reset(); })) static_cast<void>(finder_.release());
}

std::string GlPairs::name() const { return context_.info().renderer; }

std::vector<TrianglePair> GlPairs::raw_pairs(const PairTask& task, PairCounts& counts) {
  if (task.width < 1 || task.height < 1 || task.width > 65536 || task.height > 65536)
    throw std::logic_error("GlPairs: a window of no pixels, or of more than 65536 along a side");
  if (takes_too_much(task)) {
    counts = {};
    counts.given_up = true;
    return {};
  }
  const GlCurrent current(context_);
  try {
    if (!finder_) finder_ = std::make_unique<PairFinder>(context_, options_);
    return finder_->find(task, counts);
  } catch (...) {
    forget();
    throw;
  }
}

std::size_t GlPairs::dispatches() const { return finder_ ? finder_->dispatches() : 0; }
std::size_t GlPairs::uploaded_bytes() const { return finder_ ? finder_->sent_bytes() : 0; }
std::size_t GlPairs::portions() const { return finder_ ? finder_->portions() : 0; }
std::size_t GlPairs::reported_pairs() const { return finder_ ? finder_->reported_pairs() : 0; }

std::unique_ptr<PairBackend> gl_pair_backend(const GlContext& context, std::size_t memory) {
  return std::make_unique<GlPairs>(context, GlPairOptions{.memory = memory});
}

}  // namespace farcull
