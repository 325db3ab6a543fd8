// Work items append pairs to a buffer, as many at a time as it holds; the pairs are read and sorted
// into a pool. Where all fit, all tests of the part are one emission.
#include "core/gl/pairs_emission.h"

#include <algorithm>
#include <span>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr std::uint64_t kEmitted = std::uint64_t{1} << 22;  // work items of one emission
constexpr std::uint64_t kAtOnce = std::uint64_t{1} << 24;   // of one of all tests together
constexpr int kAttempts = 4;  // at most to do all tests at once, each with more room
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
  // An emission, up to a quarter of the memory, may come on top of it.
  found_.emplace(1,
                 std::max(run_.options.memory / kBufferPart / sizeof(TrianglePair), kLeastBuffer));
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
  if (emitted > 0 && read.back().a == kUnread) {
    throw Error("GL pairs", "the pairs were not read",
                "a command was lost: run again, or with another --device");
  }
  found_->shrink_if_full(0);
}

std::size_t PairEmission::most_bytes(const PartMemory& memory) const {
  return std::max(std::min(run_.options.memory / 4, memory.block), kLeastPairs);
}
std::size_t PairEmission::pair_capacity(const PartMemory& memory) const {
  return std::min(pairs_.bytes(), most_bytes(memory)) / sizeof(TrianglePair);
}
std::size_t PairEmission::unit_capacity(const PartMemory& memory) const {
  return std::min(units_.bytes(), most_bytes(memory)) / kUnitBytes;
}

// Runs launch(first, count) over work items that append pairs, in as many parts as the memory for
// pairs asks for, and takes the pairs. After each part after(the total kTotalMore of the level).
void PairEmission::emit(std::uint64_t count, std::size_t level, const PartMemory& memory,
                        const Launch& launch, const After& after) {
  const std::size_t most = most_bytes(memory);
  std::uint64_t size = std::min(count, kEmitted);
  for (std::uint64_t first = 0; first < count;) {
    const std::uint64_t n = std::min(size, count - first);
    pairs_.reserve(kLeastPairs, most);
    const std::size_t capacity = pair_capacity(memory);
    run_.device.reset(kPairTotals);
    launch(first, n, static_cast<std::uint32_t>(capacity));
    run_.device.stamp(PairStamp::done);
    const auto totals = run_.device.read("pairs");
    check_lists(totals);
    const std::size_t emitted = totals[kTotalPairs];
    const std::uint32_t more = totals[of_level(kTotalMore, level)];
    if (emitted > capacity || more > unit_capacity(memory) || totals[kTotalOverflow] != 0) {
      // Bits say that pairs were emitted which did not fit.
      if (settled_words_ > 0) run_.device.zero(settled_, settled_words_, true);
      const bool fits = more * kUnitBytes <= most && emitted * sizeof(TrianglePair) <= most;
      const bool grows = emitted > capacity || more > unit_capacity(memory);
      if (fits && grows) {
        pairs_.reserve(emitted * sizeof(TrianglePair), most);
        units_.reserve(more * kUnitBytes, most);
      } else if (n > 1) {
        size = n / 2;
      } else {
        throw Error("GL pairs", "one work item has more pairs than fit its memory",
                    "use --device cpu or a larger --resolution");
      }
      continue;
    }
    read_pairs(emitted);
    emitted_bytes_ += emitted * sizeof(TrianglePair);
    run_.counts.tests += two_words(totals, kTotalTests);
    if (more > 0) after(more);
    first += n;
  }
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
                             std::uint64_t first, const PartMemory& memory) {
  PairLevel& level = lists.level(l);
  const bool some_cut = level.crowded > 0, once = settled_words_ > 0;
  PairUniforms u = run_.common;
  u.bins = level.bins;
  u.items = static_cast<std::uint32_t>(items_.records());
  u.capacity = static_cast<std::uint32_t>(pair_capacity(memory));
  u.extra = {static_cast<std::uint32_t>(l), run_.owners.same_group,
             static_cast<std::uint32_t>(unit_capacity(memory)), static_cast<std::uint32_t>(first)};
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

// Large triangles with each of the `sent` ones on the device.
void PairEmission::run_large(const PairWork& work, std::size_t sent, std::uint64_t first,
                             std::size_t capacity) {
  PairUniforms u = run_.common;
  u.extra = {0, run_.scene.gathered(), 0, static_cast<std::uint32_t>(items_.large())};
  u.cells = static_cast<std::uint32_t>(sent);
  u.items = static_cast<std::uint32_t>(first);
  u.capacity = static_cast<std::uint32_t>(capacity);
  run_.device.run(PairProgram::large, work, u,
                  run_.scene.bindings(items_.record_store(), items_.record_heads(),
                                      {{8, &large_}, {9, &pairs_}}));
}

void PairEmission::launch_all(PairLists& lists, bool more, const PartMemory& memory) {
  for (std::size_t l = 0; l <= lists.levels(); ++l) {
    run_tests(lists, l, false, lists.all_entries(l), 0, memory);
    run_tests(lists, l, true, {more ? unit_capacity(memory) : 0, of_level(kTotalMore, l)}, 0,
              memory);
  }
  const std::size_t sent = run_.task->active.size();
  run_large({items_.large(), kTotalLarge, kLargeBatch, static_cast<std::uint32_t>(sent)}, sent, 0,
            pair_capacity(memory));
  run_.device.stamp(PairStamp::done);
}

bool PairEmission::make(PairLists& lists, const PartMemory& memory,
                        std::optional<PairTotalWords>& all_totals) {
  const std::size_t most = most_bytes(memory);
  find_large(memory);
  std::uint64_t entries = 0, widest = 0;
  for (std::size_t l = 0; l <= lists.levels(); ++l) {
    entries += lists.level(l).listed;
    widest = std::max<std::uint64_t>(widest, lists.level(l).listed);
  }
  pairs_.reserve(kLeastPairs, most);
  // The partners of one entry at least have room.
  units_.reserve((widest / kUnit + 1) * kUnitBytes, memory.block);
  const std::uint64_t batches = (items_.large() + kLargeBatch - 1) / kLargeBatch;
  const std::uint64_t comparisons = batches * run_.task->active.size();
  const bool at_once = entries <= kAtOnce && comparisons <= kAtOnce * kLargeBatch &&
                       !(comparisons > 0 && run_.scene.gathered()) &&
                       run_.task->triangles.size() != too_many_of_;
  for (int attempt = 0; at_once && attempt < kAttempts; ++attempt) {
    run_.device.reset(kPairTotals);
    launch_all(lists, true, memory);
    const auto totals = run_.device.read("pairs");
    check_lists(totals);
    std::size_t more = 0;
    for (std::size_t l = 0; l <= lists.levels(); ++l)
      more = std::max<std::size_t>(more, totals[of_level(kTotalMore, l)]);
    const std::size_t emitted = totals[kTotalPairs];
    if (emitted <= pair_capacity(memory) && more <= unit_capacity(memory)) {
      if (overflow(totals, memory)) return false;
      read_pairs(emitted);
      run_.counts.tests += two_words(totals, kTotalTests);
      all_totals = totals;
      return true;
    }
    // Bits say that pairs were emitted which did not fit.
    if (settled_words_ > 0) run_.device.zero(settled_, settled_words_, true);
    if (emitted * sizeof(TrianglePair) > most || more * kUnitBytes > most) {
      too_many_of_ = run_.task->triangles.size();
      break;
    }
    pairs_.reserve(emitted * sizeof(TrianglePair), most);
    units_.reserve(more * kUnitBytes, most);
  }
  emitted_bytes_ = 0;
  for (std::size_t l = 0; l <= lists.levels(); ++l) emit_tests(lists, l, memory);
  emit_large(memory);
  if (emitted_bytes_ <= most) too_many_of_ = 0;
  check_lists(run_.device.read("pairs"));
  return true;
}

void PairEmission::emit_tests(PairLists& lists, std::size_t l, const PartMemory& memory) {
  const auto launch = [&](bool more) {
    return [&, more](std::uint64_t first, std::uint64_t n, std::uint32_t) {
      run_tests(lists, l, more, n, first, memory);
    };
  };
  emit(lists.level(l).listed, l, memory, launch(false),
       [&](std::uint32_t more) { emit(more, l, memory, launch(true), [](std::uint32_t) {}); });
}

void PairEmission::emit_large(const PartMemory& memory) {
  // Bits are of records of entries, which large ones have none of.
  settled_words_ = 0;
  if (items_.large() == 0) return;
  const std::uint64_t batches = (items_.large() + kLargeBatch - 1) / kLargeBatch;
  run_.scene.for_each_piece([&](std::size_t, std::size_t sent) {
    emit(
        batches * sent, 0, memory,
        [&](std::uint64_t first, std::uint64_t n, std::uint32_t capacity) {
          run_large(n, sent, first, capacity);
        },
        [](std::uint32_t) {});
  });
}

bool PairEmission::make(PairLists& lists, const PairForecast& forecast, const PartMemory& memory,
                        PairTotalWords& totals) {
  const std::size_t most = most_bytes(memory);
  find_large(memory);
  pairs_.reserve(std::max(forecast.pairs * sizeof(TrianglePair), kLeastPairs), most);
  units_.reserve(std::max<std::size_t>(forecast.more, 1) * kUnitBytes, most);
  launch_all(lists, forecast.more > 0, memory);
  totals = run_.device.read("pairs");
  if (totals[kTotalOverflow] != 0 || totals[kTotalPairs] > pair_capacity(memory)) return false;
  check_lists(totals);
  read_pairs(totals[kTotalPairs]);
  run_.counts.tests += two_words(totals, kTotalTests);
  return true;
}

}  // namespace farcull
