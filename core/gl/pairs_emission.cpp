// Work items append pairs to a buffer, as many at a time as it holds; the pairs are read and sorted
// into a pool.
#include "core/gl/pairs_emission.h"

#include <algorithm>
#include <span>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr std::uint64_t kEmitted = std::uint64_t{1} << 22;  // work items of one emission
// Entries of a record, on average, from which pairs are emitted once; and the largest number of
// records for which the number of a bit fits 32 bits.
constexpr std::size_t kRepeatedFrom = 16, kMostSettled = std::size_t{1} << 16;
constexpr std::size_t kLeastPairs = std::size_t{64} << 10;  // bytes for pairs
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

// Runs launch(first, count) over work items that append pairs, in as many parts as the memory for
// pairs asks for, and takes the pairs; the sum of kTotalMore.
std::uint32_t PairEmission::emit(std::uint64_t count, const PairMemory& memory,
                                 const Launch& launch) {
  const std::size_t most = std::max(std::min(run_.options.memory / 4, memory.block), kLeastPairs);
  std::uint32_t more = 0;
  std::uint64_t size = std::min(count, kEmitted);
  for (std::uint64_t first = 0; first < count;) {
    const std::uint64_t n = std::min(size, count - first);
    pairs_.reserve(kLeastPairs, most);
    const std::size_t capacity = std::min(pairs_.bytes(), most) / sizeof(TrianglePair);
    run_.device.reset(kPairTotals);
    launch(first, n, static_cast<std::uint32_t>(capacity));
    const auto totals = run_.device.read("pairs");
    check_lists(totals);
    const std::size_t emitted = totals[kTotalPairs];
    if (emitted > capacity) {
      // Bits say that pairs were emitted which did not fit.
      if (settled_words_ > 0) run_.device.zero(settled_, settled_words_);
      if (emitted * sizeof(TrianglePair) <= most) {
        pairs_.reserve(emitted * sizeof(TrianglePair), most);
      } else if (n > 1) {
        size = n / 2;
      } else {
        throw Error("GL pairs", "one work item has more pairs than fit its memory",
                    "use --device cpu or a larger --resolution");
      }
      continue;
    }
    read_pairs(emitted);
    run_.counts.tests += two_words(totals, kTotalTests);
    more += totals[kTotalMore];
    first += n;
  }
  return more;
}

// Pairs are emitted once where they may repeat often and there is memory for a bit for each two
// records.
void PairEmission::settle(const PairLevel& pixels, PairMemory& memory) {
  settled_words_ = 0;
  const std::size_t all = items_.records(), listed_ones = pixels.listed;
  if (run_.counts.crowded == 0 && listed_ones <= kRepeatedFrom * all) return;
  const std::size_t words = (all * all + 31) / 32;
  if (all > kMostSettled || words * kWord > std::min(run_.options.memory / 8, memory.left)) return;
  if (words * kWord > memory.block || !memory.take(words * kWord)) return;
  settled_.reserve(words * kWord, memory.block);
  run_.device.zero(settled_, words);
  settled_words_ = words;
}

// The tests of a level's cells that are not cut; false: too many.
bool PairEmission::test(PairLevel& level, bool pixels, bool some_cut, PairMemory& memory) {
  if (level.listed == 0) return true;
  if (!memory.take(level.listed * kWord) || !memory.take(level.listed * kWord)) return false;
  units_.reserve(level.listed * kWord, memory.block);
  PairUniforms u = run_.common;
  u.bins = level.bins;
  u.items = static_cast<std::uint32_t>(items_.records());
  u.extra = {pixels, run_.owners.same_group, static_cast<std::uint32_t>(level.listed), 0};
  const auto launch = [&](PairProgram program, const GlStore& unit_store) {
    return [&, program, unit = &unit_store](std::uint64_t first, std::uint64_t n,
                                            std::uint32_t capacity) {
      u.capacity = capacity;
      u.extra[3] = static_cast<std::uint32_t>(first);
      run_.device.run(program, n, u,
                      {{1, settled_words_ > 0 ? &settled_ : &pairs_},
                       {2, &pairs_},
                       {3, unit},
                       {4, &level.first},
                       {8, some_cut ? &level.state : &level.first},
                       {9, &level.entries},
                       {10, &level.places}});
    };
  };
  const std::uint32_t more =
      emit(level.listed, memory,
           launch(settled_words_ > 0
                      ? (some_cut ? PairProgram::uncut_settled_tests : PairProgram::settled_tests)
                      : (some_cut ? PairProgram::uncut_tests : PairProgram::tests),
                  units_));
  if (more == 0) return true;
  units_before_.reserve(level.listed * kWord, memory.block);
  run_.device.scan(units_, units_before_, level.listed);
  const auto totals = run_.device.read("pair tests");
  if (overflow(totals, memory)) return false;
  emit(totals[kTotalScanned], memory,
       launch(settled_words_ > 0
                  ? (some_cut ? PairProgram::more_uncut_settled_tests
                              : PairProgram::more_settled_tests)
                  : (some_cut ? PairProgram::more_uncut_tests : PairProgram::more_tests),
              units_before_));
  return true;
}

void PairEmission::compare_large(const PairMemory& memory) {
  settled_words_ = 0;
  if (items_.large() == 0) return;
  large_.reserve(items_.large() * kWord, memory.block);
  PairUniforms u = run_.common;
  u.capacity = static_cast<std::uint32_t>(items_.large());
  run_.device.reset(kCutTotals);
  run_.device.run(PairProgram::find_large, items_.items(), u,
                  {{5, &items_.record_store()}, {6, &items_.record_heads()}, {8, &large_}});
  u.extra = {0, run_.scene.gathered(), 0, static_cast<std::uint32_t>(items_.large())};
  run_.scene.for_each_piece([&](std::size_t, std::size_t sent_ones) {
    for (std::size_t first = 0; first < items_.large(); first += kLargeBatch) {
      u.extra[2] = static_cast<std::uint32_t>(first);
      emit(sent_ones, memory,
           [&](std::uint64_t begin, std::uint64_t count, std::uint32_t capacity) {
             u.items = static_cast<std::uint32_t>(begin);
             u.capacity = capacity;
             run_.device.run(PairProgram::large, count, u,
                             run_.scene.bindings(items_.record_store(), items_.record_heads(),
                                                 {{8, &large_}, {9, &pairs_}}));
           });
    }
  });
}

}  // namespace farcull
