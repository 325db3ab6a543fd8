// Work items append pairs to a buffer; the pairs are read and sorted into a pool. Where they do not
// fit, tests are done in portions. Entries that stand together have about as many partners each, so
// a portion takes every so-and-so-manyth of them, and portions report about as many pairs each.
#include "core/gl/pairs_emission.h"

#include <algorithm>
#include <span>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr std::uint64_t kEntriesAtOnce = std::uint64_t{1} << 24;
constexpr std::uint64_t kComparisonsAtOnce = std::uint64_t{1} << 30;  // with large triangles
// Portions of which one work item is more than one, whatever their number.
constexpr std::uint32_t kMostPortions = 1u << 30;
// Entries of a record, on average, from which pairs are emitted once; and the largest number of
// records for which the number of a bit fits 32 bits.
constexpr std::size_t kRepeatedFrom = 16, kMostSettled = std::size_t{1} << 16;
constexpr std::size_t kLeastPairs = std::size_t{64} << 10;  // bytes for pairs
constexpr std::size_t kUnitBytes = 2 * kWord;
// Pairs that are held although they may repeat: this part of the memory, or so many, or as many as
// are distinct.
constexpr std::size_t kBufferPart = 8;
constexpr std::size_t kLeastBuffer = 4096;

}  // namespace

void PairEmission::begin() {
  // The pairs of a portion may come on top of it.
  portions_ = reported_ = 0;
  found_.emplace(1,
                 std::max(run_.options.memory / kBufferPart / sizeof(TrianglePair), kLeastBuffer),
                 run_.task->narrow);
}

std::vector<TrianglePair> PairEmission::take() {
  std::vector<TrianglePair> pairs = found_->take(0);
  found_.reset();
  return pairs;
}

void PairEmission::read_pairs(std::size_t emitted) {
  // No triangle has this number, so it stays only where nothing was read.
  constexpr std::uint32_t kUnread = 0xffffffff;
  const std::span<TrianglePair> read = found_->append(0, emitted, {kUnread, kUnread});
  pairs_.read(0, read.data(), read.size_bytes());
  run_.device.add_readback();
  ++portions_;
  reported_ += emitted;
  if (emitted > 0 && read.back().a == kUnread) {
    throw Error("GL pairs", "the pairs were not read",
                "a command was lost: run again, or with another {device}");
  }
  found_->shrink_if_full(0);
}

std::size_t PairEmission::most_bytes(const PartMemory& memory) const {
  return std::max(std::min(run_.options.memory, memory.block), kLeastPairs);
}
std::size_t PairEmission::pair_capacity(const PartMemory& memory) const {
  return std::min(pairs_.bytes(), most_bytes(memory)) / sizeof(TrianglePair);
}
std::size_t PairEmission::unit_capacity(const PartMemory& memory) const {
  return std::min(units_.bytes(), most_bytes(memory)) / kUnitBytes;
}

// Pairs are emitted once where they may repeat often and there is memory for a bit for each two
// records.
void PairEmission::settle(const PairLevel& pixels, PartMemory& memory) {
  settled_words_ = 0;
  const std::size_t all = items_.records(), listed_ones = pixels.listed;
  if (pixels.crowded == 0 && listed_ones <= kRepeatedFrom * all) return;
  const std::size_t words = (all * all + 31) / 32;
  if (all > kMostSettled || words * kWord > std::min(run_.options.memory / 8, memory.left)) return;
  if (words * kWord > memory.block || !memory.take(words * kWord)) return;
  settled_.reserve(words * kWord, memory.block);
  run_.device.zero(settled_, words, true);
  settled_words_ = words;
}

// Runs tests of a level's cells that are not cut, or what they left (`more`).
void PairEmission::run_tests(PairLists& lists, std::size_t l, bool more, const PairWork& work,
                             const Portion& portion, const PartMemory& memory) {
  PairLevel& level = lists.level(l);
  const bool some_cut = level.crowded > 0, once = settled_words_ > 0;
  PairUniforms u = run_.common;
  u.bins = level.bins;
  u.items = static_cast<std::uint32_t>(items_.records());
  u.capacity = static_cast<std::uint32_t>(pair_capacity(memory));
  u.cells = portion.of;
  u.extra = {static_cast<std::uint32_t>(l), run_.owners.same_group,
             static_cast<std::uint32_t>(unit_capacity(memory)), portion.k};
  // By more, some_cut, once.
  static constexpr PairProgram kPrograms[2][2][2] = {
      {{PairProgram::tests, PairProgram::settled_tests},
       {PairProgram::uncut_tests, PairProgram::uncut_settled_tests}},
      {{PairProgram::more_tests, PairProgram::more_settled_tests},
       {PairProgram::more_uncut_tests, PairProgram::more_uncut_settled_tests}}};
  run_.device.run(kPrograms[more][some_cut][once], work, u,
                  {{1, once ? &settled_ : &pairs_},
                   {2, &pairs_},
                   {3, &units_},
                   {4, &level.first},
                   {8, some_cut ? &level.state : &level.first},
                   {9, &level.entries},
                   {10, &level.places}});
}

// Lists the large ones among the records.
void PairEmission::find_large(const PartMemory& memory) {
  large_.reserve(std::max(items_.large() * kWord, kVec4), memory.block);
  if (items_.large() == 0) return;
  PairUniforms u = run_.common;
  u.capacity = static_cast<std::uint32_t>(items_.large());
  run_.device.run(PairProgram::find_large, items_.all_items(), u,
                  {{5, &items_.record_store()}, {6, &items_.record_heads()}, {8, &large_}});
}

// Large triangles with each active one.
void PairEmission::run_large(const Portion& portion, const PartMemory& memory) {
  const std::uint64_t batches = (items_.large() + kLargeBatch - 1) / kLargeBatch;
  if (batches == 0) return;
  PairUniforms u = run_.common;
  u.extra = {portion.k, run_.scene.gathered(), portion.of,
             static_cast<std::uint32_t>(items_.large())};
  u.capacity = static_cast<std::uint32_t>(pair_capacity(memory));
  run_.scene.for_each_piece([&](std::size_t, std::size_t sent) {
    u.cells = static_cast<std::uint32_t>(sent);
    const auto run = [&](std::uint64_t first, const PairWork& work) {
      u.items = static_cast<std::uint32_t>(first);
      run_.device.run(PairProgram::large, work, u,
                      run_.scene.bindings(items_.record_store(), items_.record_heads(),
                                          {{8, &large_}, {9, &pairs_}}));
    };
    if (batches * sent <= kComparisonsAtOnce) {
      run(0, {items_.large(), kTotalLarge, kLargeBatch, static_cast<std::uint32_t>(sent)});
      return;
    }
    // Numbers of work items fit 32 bits in each dispatch, which begins with a batch of large ones.
    const std::uint64_t step = std::max<std::uint64_t>(kComparisonsAtOnce / sent, 1);
    for (std::uint64_t first = 0; first < batches; first += step)
      run(first, std::min(step, batches - first) * sent);
  });
}

void PairEmission::launch(PairLists& lists, const Portion& portion, const PartMemory& memory) {
  for (std::size_t l = 0; l <= lists.levels(); ++l) {
    run_tests(lists, l, false, lists.all_entries(l), portion, memory);
    run_tests(lists, l, true, {some_further_ ? unit_capacity(memory) : 0, of_level(kTotalMore, l)},
              portion, memory);
  }
  run_large(portion, memory);
  run_.device.stamp(PairStamp::done);
}

std::size_t PairEmission::most_units_of(const PairTotalWords& totals) {
  const auto first = totals.begin() + kTotalMore;
  return *std::max_element(first, first + kMaxLevel + 1);
}

// Begins a part: room for its pairs and for work items of further tests, and its portions.
void PairEmission::prepare(std::size_t pairs, std::size_t units, const PartMemory& memory) {
  const std::size_t most = most_bytes(memory);
  pairs_.reserve(std::min(std::max(pairs * sizeof(TrianglePair), kLeastPairs), most), most);
  units_.reserve(std::min(std::max<std::size_t>(units, 1) * kUnitBytes, most), most);
  emitted_ = most_units_ = 0;
  left_.clear();
}

bool PairEmission::make(PairLists& lists, const PartMemory& memory, PairTotalWords& totals) {
  find_large(memory);
  std::uint64_t entries = 0, widest = 0;
  for (std::size_t l = 0; l <= lists.levels(); ++l) {
    entries += lists.level(l).listed;
    widest = std::max<std::uint64_t>(widest, lists.level(l).listed);
  }
  prepare(0, widest / kUnit + 1, memory);
  some_further_ = true;
  left_.assign(1, {0, static_cast<std::uint32_t>(entries / kEntriesAtOnce + 1)});
  for (std::uint32_t k = 1; k < left_.front().of; ++k) left_.push_back({k, left_.front().of});
  return run_portions(lists, memory, totals);
}

bool PairEmission::begin_foreseen(PairLists& lists, const PairForecast& forecast,
                                  const PartMemory& memory, PairTotalWords& totals) {
  find_large(memory);
  prepare(forecast.pairs, forecast.more, memory);
  some_further_ = forecast.more > 0;
  const std::size_t capacity = pair_capacity(memory);
  const auto portions = static_cast<std::uint32_t>(
      std::max<std::size_t>((forecast.pairs + capacity - 1) / capacity, 1));
  for (std::uint32_t k = 0; k < portions; ++k) left_.push_back({k, portions});
  launch(lists, left_.back(), memory);
  totals = run_.device.read("pairs");
  return totals[kTotalOverflow] == 0;
}

bool PairEmission::finish_foreseen(PairLists& lists, const PartMemory& memory,
                                   const PairTotalWords& totals) {
  check_lists(totals);
  const Portion first = left_.back();
  left_.pop_back();
  PairTotalWords others{};
  return take_portion(first, memory, totals) && run_portions(lists, memory, others);
}

// The portions that are left.
bool PairEmission::run_portions(PairLists& lists, const PartMemory& memory,
                                PairTotalWords& totals) {
  while (!left_.empty() && !run_.counts.given_up) {
    const Portion portion = left_.back();
    left_.pop_back();
    run_.device.reset(kPairTotals);
    launch(lists, portion, memory);
    totals = run_.device.read("pairs");
    check_lists(totals);
    if (!take_portion(portion, memory, totals)) return false;
  }
  return true;
}

// Reads the pairs of a portion that was launched. Where there was not room enough for them it is
// left to be done again, with more room, or in smaller portions. False: too many for the part.
bool PairEmission::take_portion(const Portion& portion, const PartMemory& memory,
                                const PairTotalWords& totals) {
  const std::uint64_t emitted = two_words(totals, kTotalPairs);
  const std::size_t more = most_units_of(totals);
  if (emitted <= pair_capacity(memory) && more <= unit_capacity(memory)) {
    if (overflow(totals, memory)) return false;
    read_pairs(emitted);
    emitted_ += emitted;
    most_units_ = std::max(most_units_, more);
    run_.counts.tests += two_words(totals, kTotalTests);
    run_.counts.given_up = run_.counts.tests > run_.task->most_tests;
    return true;
  }
  // Bits say that pairs were emitted which did not fit.
  if (settled_words_ > 0) run_.device.zero(settled_, settled_words_, true);
  const std::size_t most = most_bytes(memory);
  const std::size_t units = more * kUnitBytes;
  std::uint64_t bytes = emitted * sizeof(TrianglePair);
  // Further tests that did not run would have reported as many pairs each.
  const std::uint64_t tests = two_words(totals, kTotalTests);
  if (more > unit_capacity(memory) && tests > 0) {
    const double all = static_cast<double>(bytes) *
                       (1 + static_cast<double>(more) * kUnit / static_cast<double>(tests));
    bytes = static_cast<std::uint64_t>(std::min(all, 0x1p60));
  }
  units_.reserve(std::min(units, most), most);
  pairs_.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, most)), most);
  if (units <= most && bytes <= most) {
    left_.push_back(portion);
    return true;
  }
  // Portions differ a little in their pairs, so there is a sixteenth more room than for the mean.
  const std::uint64_t needed = std::max<std::uint64_t>(units, bytes);
  const std::uint64_t parts = std::max<std::uint64_t>((needed + needed / 16) / most + 1, 2);
  if (parts > kMostPortions / portion.of) {
    throw Error("GL pairs", "one work item has more pairs than fit its memory",
                "use {device} cpu or a larger {resolution}");
  }
  for (std::uint32_t k = 0; k < parts; ++k) {
    left_.push_back({portion.k + k * portion.of, static_cast<std::uint32_t>(parts) * portion.of});
  }
  return true;
}

}  // namespace farcull
