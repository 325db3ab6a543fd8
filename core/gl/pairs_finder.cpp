// A window whose work is foreseen by that on the last ones, or guessed by the bounds of its
// triangles, is done without a wait: each dispatch learns on the device how much there is to do.
// Where there was too little room for something, all is done again, and what there is to do is
// read, step by step. A part of the window that is too much for the memory is split in two, down to
// single pixels.
#include "core/gl/pairs_finder.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/gl/pairs_guess.h"

namespace farcull {
namespace {

// As many views as a frame has mostly, so that the room is enough for each of them.
constexpr std::size_t kRemembered = 4;

SeenWindow window_of(const PairTask& task) {
  constexpr std::size_t kLooked = 16;  // objects
  SeenWindow out;
  out.side = static_cast<float>(std::max(task.width, task.height));
  out.places = {static_cast<float>(task.width), static_cast<float>(task.height)};
  for (std::size_t o = 0; o < std::min(task.limits.size(), kLooked); ++o) {
    const PixelBox& box = task.limits[o];
    for (const float x : {box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z})
      out.places.push_back(x);
  }
  return out;
}

void check_counted_twice(const PairTotalWords& totals, std::size_t levels) {
  bool same = totals[kTotalLargeFound] == totals[kTotalLarge] &&
              two_words(totals, kTotalRows) == totals[kTotalRowItems];
  for (std::size_t l = 1; l <= levels; ++l)
    same &= totals[of_level(kTotalCrowded, l)] == totals[of_level(kTotalParents, l)];
  if (same) return;
  throw Error("GL pairs", "the same was counted twice with different results",
              "a compute invocation was lost: run again, or with another {device}");
}

// The same that the device was asked, compared again, and work that nobody foresaw and that was
// left out: rows of pixels, and crowded cells of the last level.
bool has_room(const PairForecast& room, const PairTotalWords& totals, std::size_t levels) {
  bool enough = totals[kTotalWholes] <= room.wholes && totals[kTotalItems] <= room.items &&
                totals[kTotalLarge] <= room.large && totals[kTotalListed] <= room.shown &&
                two_words(totals, kTotalRows) == totals[kTotalRowItems] &&
                totals[kTotalRowItems] <= room.row_items;
  for (std::size_t l = 0; l <= levels; ++l) {
    const std::size_t crowded = l < levels ? room.crowded[l] : 0;
    enough &= totals[of_level(kTotalEntries, l)] <= room.entries[l];
    enough &= l == kMaxLevel || totals[of_level(kTotalParents, l)] <= crowded;
  }
  return enough;
}

}  // namespace

std::vector<TrianglePair> PairFinder::find(const PairTask& task, PairCounts& counts) {
  const Stopwatch start;
  run_.begin(task);
  emission_.begin();
  run_.counts.mark_ms = start.ms();
  fresh_ = true;
  if (task.active.empty()) {
    if (run_.scene.sent_bytes() > 0) run_.device.read("pairs upload");
  } else {
    const PairPart whole{0, task.width - 1, 0, task.height - 1};
    const SeenWindow window = window_of(task);
    std::optional<PairForecast> expected = forecast();
    if (!run_.scene.gathered() && !(expected && seen_like(window))) {
      auto guess = first_guess(task, run_.options.memory, run_.device.block());
      if (guess && expected) guess->join(*expected);
      expected = guess;
    }
    if (run_.options.step_by_step) expected.reset();
    if (!expected || !find_at_once(whole, *expected)) {
      split(whole);
    } else {
      run_.counts.bands = 1;
    }
    if (seen_ && run_.counts.bands == 1 && !run_.counts.given_up) {
      last_ones_.push_front({*seen_, window});
      if (last_ones_.size() > kRemembered) last_ones_.pop_back();
    } else {
      last_ones_.clear();
    }
  }
  run_.counts.dispatches = run_.device.dispatches();
  run_.counts.readbacks = run_.device.readbacks();
  counts = run_.counts;
  std::vector<TrianglePair> pairs = emission_.take();
  if (counts.given_up) pairs.clear();
  return pairs;
}

// Nothing where the last windows were of another scene.
std::optional<PairForecast> PairFinder::forecast() const {
  if (last_ones_.empty() || run_.scene.gathered()) return {};
  PairForecast all = last_ones_.front().counts;
  if (all.triangles != run_.task->triangles.size()) return {};
  for (const Seen& one : last_ones_) {
    if (one.counts.triangles == all.triangles) all.join(one.counts);
  }
  return all.with_room();
}

// True where one of the last windows was of this view, or of one in which objects are at the same
// places, a step of a motion apart.
bool PairFinder::seen_like(const SeenWindow& window) const {
  constexpr float kStep = 0.125f;  // of the window
  const auto near = [&](float a, float b) { return std::abs(a - b) <= kStep * window.side; };
  return std::any_of(last_ones_.begin(), last_ones_.end(), [&](const Seen& one) {
    return near(one.window.side, window.side) &&
           std::equal(one.window.places.begin(), one.window.places.end(), window.places.begin(),
                      window.places.end(), near);
  });
}

void PairFinder::begin_part(const PairPart& part) {
  if (!fresh_) run_.device.start(false);
  fresh_ = false;
  run_.device.stamp(PairStamp::begun);
  run_.common.tile = {part.i0, part.i1, part.j0, part.j1};
  seen_.reset();
}

// Takes the counts of a part that was done.
void PairFinder::end_part(const PairTotalWords& totals) {
  PairForecast seen;
  seen.triangles = run_.task->triangles.size();
  seen.wholes = totals[kTotalWholes];
  seen.items = totals[kTotalItems];
  seen.large = totals[kTotalLarge];
  seen.shown = totals[kTotalListed];
  seen.row_items = totals[kTotalRowItems];
  seen.pairs = emission_.emitted();
  seen.more = emission_.most_units();
  for (std::size_t l = 0; l <= kMaxLevel; ++l) {
    seen.entries[l] = totals[of_level(kTotalEntries, l)];
    seen.crowded[l] = totals[of_level(kTotalParents, l)];
  }
  // The time of the device; unknown for the window where it is for a part.
  const auto add = [&](double& ms, PairStamp from, PairStamp to) {
    const double more = run_.device.between(from, to);
    ms = more < 0 || (run_.counts.bands > 0 && ms < 0) ? -1 : std::max(ms, 0.0) + more;
  };
  add(run_.counts.mark_device_ms, PairStamp::begun, PairStamp::marked);
  add(run_.counts.list_device_ms, PairStamp::marked, PairStamp::listed);
  add(run_.counts.pair_device_ms, PairStamp::listed, PairStamp::done);
  while (seen.levels < kMaxLevel && seen.crowded[seen.levels] > 0) ++seen.levels;
  check_counted_twice(totals, seen.levels);
  lists_.set_done();
  run_.counts.listed += totals[kTotalListed] + totals[kTotalListedRows];
  run_.counts.crowded += seen.crowded[0];
  run_.counts.large = std::max<std::uint64_t>(run_.counts.large, seen.large);
  for (const std::size_t entries : seen.entries) run_.counts.entries += entries;
  seen_ = seen;
}

// The whole window with one wait; false: there was not room enough.
bool PairFinder::find_at_once(const PairPart& part, const PairForecast& forecast) {
  PartMemory memory{run_.options.memory, run_.device.block(), false};
  const std::uint64_t batches = (forecast.large + kLargeBatch - 1) / kLargeBatch;
  if (batches * run_.task->active.size() >> 31 != 0) return false;  // beyond one dispatch
  const PairCounts before = run_.counts;
  begin_part(part);
  const Stopwatch marking;
  bool enough = items_.make(forecast, memory);
  run_.counts.mark_ms += marking.ms();
  const double marked = run_.counts.mark_ms;
  const Stopwatch listing;
  enough = enough && lists_.make(part, forecast, memory);
  run_.counts.list_ms += listing.ms() - (run_.counts.mark_ms - marked);
  const Stopwatch pairing;
  run_.device.stamp(PairStamp::listed);
  if (enough) {
    emission_.settle(lists_.level(0), memory);
    PairTotalWords totals;
    enough = emission_.begin_foreseen(lists_, forecast, memory, totals) &&
             has_room(forecast, totals, lists_.levels()) &&
             emission_.finish_foreseen(lists_, memory, totals);
    if (enough) end_part(totals);
  } else {
    run_.device.read("pairs");
  }
  run_.counts.pair_ms += pairing.ms();
  if (enough) return true;
  run_.counts = before;
  ++run_.counts.redone;
  emission_.begin();
  lists_.set_broken_off();
  return false;
}

// One part of the window; false: too much for the memory.
bool PairFinder::find_in(const PairPart& part) {
  PartMemory memory{run_.options.memory, run_.device.block(), part.cells() == 1};
  // The bytes that every pixel needs, before any work is done.
  const std::size_t fixed = part.cells() * (2 * run_.owners.groups * kWord +
                                            (run_.common.masked ? 8 + 16 * run_.owners.bits : 0));
  if (!memory.last && (fixed > memory.left / 2 || fixed > memory.block)) return false;

  const Stopwatch marking;
  begin_part(part);
  if (!items_.make(memory)) return false;
  run_.counts.mark_ms += marking.ms();
  if (items_.empty()) return true;

  const double marked = run_.counts.mark_ms;
  const Stopwatch listing;
  if (!lists_.make(part, memory)) return false;
  run_.counts.list_ms += listing.ms() - (run_.counts.mark_ms - marked);

  const Stopwatch pairing;
  run_.device.stamp(PairStamp::listed);
  emission_.settle(lists_.level(0), memory);
  PairTotalWords totals{};
  if (!emission_.make(lists_, memory, totals)) return false;
  end_part(totals);
  run_.counts.pair_ms += pairing.ms();
  return true;
}

void PairFinder::split(const PairPart& part) {
  if (run_.counts.given_up) return;
  const PairCounts before = run_.counts;
  run_.counts.crowded = 0;
  if (find_in(part)) {
    run_.counts.crowded += before.crowded;
    ++run_.counts.bands;
    return;
  }
  // The next parts believe what was sent for this one, so it is checked first.
  run_.device.read("pairs");
  run_.counts = before;
  lists_.set_broken_off();
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

}  // namespace farcull
