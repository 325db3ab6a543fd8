#include <algorithm>

#include "core/error.h"
#include "core/gl_pairs_parts.h"

namespace farcull {
namespace {

constexpr std::uint64_t kEmitted = std::uint64_t{1} << 22;  // work items of one emission
// Entries of a record, on average, from which pairs are emitted once; and records whose pairs a
// 32-bit number of a bit can tell.
constexpr std::size_t kRepeatedFrom = 16, kMostSettled = std::size_t{1} << 16;
constexpr std::size_t kLeastPairs = std::size_t{64} << 10;  // bytes for pairs

}  // namespace

// Runs launch(first, count) over work items that append pairs, in as many parts as the memory for
// pairs asks for, and takes the pairs; the sum of kTotalMore.
std::uint32_t GlPairs::State::emit(std::uint64_t count, const PairRoom& room,
                                   const PairLaunch& launch) {
  const std::size_t most = std::max(std::min(options.memory / 4, room.block), kLeastPairs);
  std::uint32_t more = 0;
  std::uint64_t size = std::min(count, kEmitted);
  for (std::uint64_t first = 0; first < count;) {
    const std::uint64_t n = std::min(size, count - first);
    pairs.reserve(kLeastPairs, most);
    const std::size_t capacity = std::min(pairs.bytes(), most) / sizeof(TrianglePair);
    device.reset(kPairTotals);
    launch(first, n, static_cast<std::uint32_t>(capacity));
    const auto totals = device.read("pairs");
    check(totals);
    const std::size_t emitted = totals[kTotalPairs];
    if (emitted > capacity) {
      // Bits say that pairs were emitted which did not fit.
      if (settled_words > 0) device.zero(settled, settled_words);
      if (emitted * sizeof(TrianglePair) <= most) {
        pairs.reserve(emitted * sizeof(TrianglePair), most);
      } else if (n > 1) {
        size = n / 2;
      } else {
        throw Error("GL pairs", "one work item has more pairs than fit its memory",
                    "use --device cpu or a larger --resolution");
      }
      continue;
    }
    // No triangle has this number, so it stays only where nothing was read.
    constexpr std::uint32_t kUnread = 0xffffffff;
    const std::span<TrianglePair> read = found->append(0, emitted, {kUnread, kUnread});
    pairs.read(0, read.data(), read.size_bytes());
    if (emitted > 0 && read.back().a == kUnread) {
      throw Error("GL pairs", "the pairs were not read",
                  "a command was lost: run again, or with another --device");
    }
    found->shrink_if_full(0);
    counts.tests += two_words(totals, kTotalTests);
    more += totals[kTotalMore];
    first += n;
  }
  return more;
}

// Whether pairs of the part are emitted once, which takes a bit for each two records: where they
// may repeat often, and there is memory for it.
void GlPairs::State::settle(PairRoom& room) {
  settled_words = 0;
  const std::size_t all = items + shown_ones, listed_ones = levels[0].listed;
  if (counts.crowded == 0 && listed_ones <= kRepeatedFrom * all) return;
  const std::size_t words = (all * all + 31) / 32;
  if (all > kMostSettled || words * kWord > std::min(options.memory / 8, room.left)) return;
  if (words * kWord > room.block || !room.take(words * kWord)) return;
  settled.reserve(words * kWord, room.block);
  if (device.fault != PairFault::stale_bits) device.zero(settled, words);
  settled_words = words;
}

// The tests of a level's cells that are not cut; false: too many.
bool GlPairs::State::test(std::size_t l, bool some_cut, PairRoom& room) {
  PairLevel& level = levels[l];
  if (level.listed == 0) return true;
  if (!room.take(level.listed * kWord) || !room.take(level.listed * kWord)) return false;
  units.reserve(level.listed * kWord, room.block);
  PairUniforms u = common;
  u.bins = level.bins;
  u.items = static_cast<std::uint32_t>(items + shown_ones);
  u.extra = {l == 0, same_group, static_cast<std::uint32_t>(level.listed), 0};
  const auto launch = [&](PairProgram program, const GlStore& unit_store) {
    return [&, program, unit = &unit_store](std::uint64_t first, std::uint64_t n,
                                            std::uint32_t capacity) {
      u.capacity = capacity;
      u.extra[3] = static_cast<std::uint32_t>(first);
      device.run(program, n, u,
                 {{1, settled_words > 0 ? &settled : &pairs},
                  {2, &pairs},
                  {3, unit},
                  {4, &level.first},
                  {8, some_cut ? &level.state : &level.first},
                  {9, &level.entries},
                  {10, &level.places}});
    };
  };
  const std::uint32_t more =
      emit(level.listed, room,
           launch(settled_words > 0
                      ? (some_cut ? PairProgram::uncut_settled_tests : PairProgram::settled_tests)
                      : (some_cut ? PairProgram::uncut_tests : PairProgram::tests),
                  units));
  if (more == 0) return true;
  units_before.reserve(level.listed * kWord, room.block);
  device.scan(units, units_before, level.listed);
  const auto totals = device.read("pair tests");
  if (overflow(totals, room)) return false;
  emit(totals[kTotalScanned], room,
       launch(settled_words > 0
                  ? (some_cut ? PairProgram::more_uncut_settled_tests
                              : PairProgram::more_settled_tests)
                  : (some_cut ? PairProgram::more_uncut_tests : PairProgram::more_tests),
              units_before));
  return true;
}

void GlPairs::State::compare_large(const PairRoom& room) {
  settled_words = 0;
  if (large_ones == 0) return;
  large.reserve(large_ones * kWord, room.block);
  PairUniforms u = common;
  u.capacity = static_cast<std::uint32_t>(large_ones);
  device.reset(kCutTotals);
  device.run(PairProgram::find_large, items, u, {{5, &records}, {6, &record_heads}, {8, &large}});
  u.extra = {0, gathered, 0, static_cast<std::uint32_t>(large_ones)};
  send([&](std::size_t, std::size_t sent_ones) {
    for (std::size_t first = 0; first < large_ones; first += kLargeBatch) {
      u.extra[2] = static_cast<std::uint32_t>(first);
      emit(sent_ones, room, [&](std::uint64_t begin, std::uint64_t count, std::uint32_t capacity) {
        u.items = static_cast<std::uint32_t>(begin);
        u.capacity = capacity;
        device.run(PairProgram::large, count, u, with_scene({{8, &large}, {9, &pairs}}));
      });
    }
  });
}

}  // namespace farcull
