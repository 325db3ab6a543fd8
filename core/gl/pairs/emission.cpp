// Work items append pairs to a buffer; the pairs are read and sorted into a pool. If they do not
// fit, tests are done in portions. Neighbouring entries have about as many partners each, so a
// portion takes every n-th entry, and all portions report about as many pairs.
#include <algorithm>
#include <span>

#include "core/base/error.h"
#include "core/gl/pairs/finder.h"

namespace farcull {
namespace {

constexpr std::uint64_t kEntriesAtOnce = std::uint64_t{1} << 24;
constexpr std::uint64_t kComparisonsAtOnce = std::uint64_t{1} << 30;  // with large triangles
// If a part takes more portions than this, the pairs of a single work item do not fit.
constexpr std::uint32_t kMostPortions = 1u << 30;
// A part with more than kRepeatedFrom entries per record may emit each pair only once
// (settle_pairs()). With more than kMostSettled records, the number of a pair's bit would not fit
// 32 bits.
constexpr std::size_t kRepeatedFrom = 16, kMostSettled = std::size_t{1} << 16;
constexpr std::size_t kLeastPairs = std::size_t{64} << 10;  // bytes for pairs
constexpr std::size_t kUnitBytes = 2 * kWord;
// The pool may hold repeated pairs: in a kBufferPart-th of the memory, or kLeastBuffer of them,
// whichever is more, or as many as are distinct.
constexpr std::size_t kBufferPart = 8;
constexpr std::size_t kLeastBuffer = 4096;

// How many work items further tests have, in the level where they have most.
std::size_t most_units_of(const PairTotalWords& totals) {
  const auto first = totals.begin() + kTotalMore;
  return *std::max_element(first, first + kMaxLevel + 1);
}

}  // namespace

// Begins a window: no pairs yet.
void PairFinder::begin_pairs() {
  // Beyond this size, the pool may hold the pairs of one more portion.
  portions_ = reported_ = 0;
  found_.emplace(1, std::max(options_.memory / kBufferPart / sizeof(TrianglePair), kLeastBuffer),
                 task_->narrow);
}

// Runs the tests of all lists, and compares large triangles with each active one; false: too many.
// Totals are read once, and again with each further portion of the pairs.
bool PairFinder::make_pairs(PairTotalWords& totals) {
  find_large();
  emitted_ = most_units_ = 0;
  left_.clear();
  std::size_t portions = 1;
  if (room_ == nullptr) {
    std::uint64_t entries = 0, widest = 0;
    for (std::size_t l = 0; l <= levels_cut_; ++l) {
      entries += levels_[l].listed;
      widest = std::max<std::uint64_t>(widest, levels_[l].listed);
    }
    reserve_pairs(0, widest / kUnit + 1);
    some_further_ = true;
    portions = entries / kEntriesAtOnce + 1;
  } else {
    reserve_pairs(room_->pairs, room_->more);
    some_further_ = room_->more > 0;
    const std::size_t capacity = pair_capacity();
    portions = std::max<std::size_t>((room_->pairs + capacity - 1) / capacity, 1);
  }
  for (std::uint32_t k = 0; k < portions; ++k)
    left_.push_back({k, static_cast<std::uint32_t>(portions)});
  if (room_ == nullptr) return run_portions(totals);
  const Portion first = left_.back();
  left_.pop_back();
  launch_portion(first);
  totals = device_.read("pairs");
  // If there was too little room for something since the part began, nothing is believed.
  if (totals[kTotalOverflow] != 0 || !room_->holds(totals, levels_cut_)) return false;
  check_lists(totals);
  PairTotalWords others{};
  return take_portion(first, totals) && run_portions(others);
}

// Runs the portions that are left; false: too many pairs for the part.
bool PairFinder::run_portions(PairTotalWords& totals) {
  while (!left_.empty() && !counts_.given_up) {
    const Portion portion = left_.back();
    left_.pop_back();
    device_.reset(kPairTotals);
    launch_portion(portion);
    totals = device_.read("pairs");
    check_lists(totals);
    if (!take_portion(portion, totals)) return false;
  }
  return true;
}

// Reads the pairs of a portion that was launched. If they did not fit, the portion is left to be
// done again, with more room or in smaller portions. False: too many for the part.
bool PairFinder::take_portion(const Portion& portion, const PairTotalWords& totals) {
  const std::uint64_t emitted = two_words(totals, kTotalPairs);
  const std::size_t more = most_units_of(totals);
  if (emitted <= pair_capacity() && more <= unit_capacity()) {
    if (overflow(totals)) return false;
    read_pairs(emitted);
    emitted_ += emitted;
    most_units_ = std::max(most_units_, more);
    counts_.tests += two_words(totals, kTotalTests);
    counts_.given_up = counts_.tests > task_->most_tests;
    return true;
  }
  // Clears the bits: they mark pairs as emitted that did not fit.
  if (settled_words_ > 0) device_.zero(settled_, settled_words_, true);
  divide(portion, emitted, more, two_words(totals, kTotalTests));
  return true;
}

// Leaves a portion to be done again, with more room or in smaller portions.
void PairFinder::divide(const Portion& portion, std::uint64_t emitted, std::size_t more,
                        std::uint64_t tests) {
  const std::size_t most = most_bytes();
  const std::size_t units = more * kUnitBytes;
  std::uint64_t bytes = emitted * sizeof(TrianglePair);
  // Assumes that further tests that did not run report as many pairs each as those that ran.
  if (more > unit_capacity() && tests > 0) {
    const double all = static_cast<double>(bytes) *
                       (1 + static_cast<double>(more) * kUnit / static_cast<double>(tests));
    bytes = static_cast<std::uint64_t>(std::min(all, 0x1p60));
  }
  units_.reserve(std::min(units, most), most);
  pairs_.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, most)), most);
  if (units <= most && bytes <= most) {
    left_.push_back(portion);
    return;
  }
  // Portions differ a little in their pairs, so there is a sixteenth more room than for the mean.
  const std::uint64_t needed = std::max<std::uint64_t>(units, bytes);
  const std::uint64_t parts = std::max<std::uint64_t>((needed + needed / 16) / most + 1, 2);
  if (parts > kMostPortions / portion.of) {
    throw Error("GL pairs", "one work item has more pairs than fit its memory",
                "use {device} cpu or a larger {resolution}");
  }
  for (std::uint32_t k = 0; k < parts; ++k)
    left_.push_back({portion.k + k * portion.of, static_cast<std::uint32_t>(parts) * portion.of});
}

// Room for the pairs of the part and for work items of further tests.
void PairFinder::reserve_pairs(std::size_t pairs, std::size_t units) {
  const std::size_t most = most_bytes();
  pairs_.reserve(std::min(std::max(pairs * sizeof(TrianglePair), kLeastPairs), most), most);
  units_.reserve(std::min(std::max<std::size_t>(units, 1) * kUnitBytes, most), most);
}

std::size_t PairFinder::most_bytes() const {
  return std::max(std::min(options_.memory, memory_.block), kLeastPairs);
}
std::size_t PairFinder::pair_capacity() const {
  return std::min(pairs_.bytes(), most_bytes()) / sizeof(TrianglePair);
}
std::size_t PairFinder::unit_capacity() const {
  return std::min(units_.bytes(), most_bytes()) / kUnitBytes;
}

void PairFinder::launch_portion(const Portion& portion) {
  for (std::size_t l = 0; l <= levels_cut_; ++l) {
    run_tests(l, false, all_entries(l), portion);
    run_tests(l, true, {some_further_ ? unit_capacity() : 0, of_level(kTotalMore, l)}, portion);
  }
  run_large(portion);
  device_.stamp(PairStamp::done);
}

// Decides whether each pair of the part is emitted only once: if pairs may repeat often, and there
// is memory for a bit for each two records.
void PairFinder::settle_pairs() {
  settled_words_ = 0;
  const std::size_t all = records();
  if (levels_[0].crowded == 0 && levels_[0].listed <= kRepeatedFrom * all) return;
  const std::size_t words = (all * all + 31) / 32;
  if (all > kMostSettled || words * kWord > std::min(options_.memory / 8, memory_.left)) return;
  if (words * kWord > memory_.block || !memory_.take(words * kWord)) return;
  settled_.reserve(words * kWord, memory_.block);
  device_.zero(settled_, words, true);
  settled_words_ = words;
}

// Runs the tests of a level's cells that are not cut, or (`more`) the further tests that they left.
void PairFinder::run_tests(std::size_t l, bool more, const PairWork& work, const Portion& portion) {
  PairLevel& level = levels_[l];
  const bool some_cut = level.crowded > 0, once = settled_words_ > 0;
  PairUniforms u = common_;
  u.bins = level.bins;
  u.items = static_cast<std::uint32_t>(records());
  u.capacity = static_cast<std::uint32_t>(pair_capacity());
  u.cells = portion.of;
  u.extra = {static_cast<std::uint32_t>(l), owners_.same_group,
             static_cast<std::uint32_t>(unit_capacity()), portion.k};
  // Indexed by more, some_cut, once.
  static constexpr PairProgram kPrograms[2][2][2] = {
      {{PairProgram::tests, PairProgram::settled_tests},
       {PairProgram::uncut_tests, PairProgram::uncut_settled_tests}},
      {{PairProgram::more_tests, PairProgram::more_settled_tests},
       {PairProgram::more_uncut_tests, PairProgram::more_uncut_settled_tests}}};
  device_.run(kPrograms[more][some_cut][once], work, u,
              {{1, once ? &settled_ : &pairs_},
               {2, &pairs_},
               {3, &units_},
               {4, &level.first},
               {8, some_cut ? &level.state : &level.first},
               {9, &level.entries},
               {10, &level.places}});
}

// Lists the large triangles among the records.
void PairFinder::find_large() {
  large_.reserve(std::max(large_count_ * kWord, kVec4), memory_.block);
  if (large_count_ == 0) return;
  PairUniforms u = common_;
  u.capacity = static_cast<std::uint32_t>(large_count_);
  device_.run(PairProgram::find_large, all_items(), u,
              {{5, &records_}, {6, &record_heads_}, {8, &large_}});
}

// Compares large triangles with each active one.
void PairFinder::run_large(const Portion& portion) {
  const std::uint64_t batches = (large_count_ + kLargeBatch - 1) / kLargeBatch;
  if (batches == 0) return;
  PairUniforms u = common_;
  u.extra = {portion.k, scene_.gathered(), portion.of, static_cast<std::uint32_t>(large_count_)};
  u.capacity = static_cast<std::uint32_t>(pair_capacity());
  scene_.for_each_piece([&](std::size_t, std::size_t sent) {
    u.cells = static_cast<std::uint32_t>(sent);
    const auto run = [&](std::uint64_t first, const PairWork& work) {
      u.items = static_cast<std::uint32_t>(first);
      device_.run(PairProgram::large, work, u,
                  scene_.bindings(records_, record_heads_, {{8, &large_}, {9, &pairs_}}));
    };
    if (batches * sent <= kComparisonsAtOnce) {
      run(0, {large_count_, kTotalLarge, kLargeBatch, static_cast<std::uint32_t>(sent)});
      return;
    }
    // Each dispatch begins with a batch of large triangles; its work item numbers fit 32 bits.
    const std::uint64_t step = std::max<std::uint64_t>(kComparisonsAtOnce / sent, 1);
    for (std::uint64_t first = 0; first < batches; first += step)
      run(first, std::min(step, batches - first) * sent);
  });
}

void PairFinder::read_pairs(std::size_t emitted) {
  // No triangle has this number, so it stays only where nothing was read.
  constexpr std::uint32_t kUnread = 0xffffffff;
  const std::span<TrianglePair> read = found_->append(0, emitted, {kUnread, kUnread});
  pairs_.read(0, read.data(), read.size_bytes());
  device_.add_readback();
  ++portions_;
  reported_ += emitted;
  if (emitted > 0 && read.back().a == kUnread) throw_lost("pairs", "the pairs were not read");
  found_->shrink_if_full(0);
}

}  // namespace farcull
