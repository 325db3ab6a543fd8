#include <algorithm>

#include "core/gl_pairs_parts.h"

namespace farcull {
namespace {

constexpr std::uint64_t kEmitted = std::uint64_t{1} << 22;  // work items of one emission
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
    const std::size_t capacity = std::min(pairs.bytes, most) / sizeof(TrianglePair);
    device.reset(kTotalPairs, 4);
    launch(first, n, static_cast<std::uint32_t>(capacity));
    const auto totals = device.read("pairs");
    check(totals);
    const std::size_t emitted = totals[kTotalPairs];
    if (emitted > capacity) {
      if (emitted * sizeof(TrianglePair) <= most) {
        pairs.reserve(emitted * sizeof(TrianglePair), most);
      } else {
        size = std::max<std::uint64_t>(n / 2, 1);
      }
      continue;
    }
    const std::size_t before = found.size();
    found.resize(before + emitted);
    if (emitted > 0) {
      glBindBuffer(GL_SHADER_STORAGE_BUFFER, pairs.name);
      glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                         static_cast<GLsizeiptr>(emitted * sizeof(TrianglePair)),
                         found.data() + before);
    }
    counts.tests += two_words(totals, kTotalTests);
    more += totals[kTotalMore];
    first += n;
  }
  return more;
}

// The tests of a level's cells that are not cut; false: too many.
bool GlPairs::State::test(std::size_t l, bool some_cut, PairRoom& room) {
  PairLevel& level = levels[l];
  if (level.listed == 0) return true;
  if (!room.take(level.listed * kWord) || !room.take(level.listed * kWord)) return false;
  units.reserve(level.listed * kWord, room.block);
  PairUniforms u = common;
  u.bins = level.bins;
  u.extra = {l == 0, same_group, static_cast<std::uint32_t>(level.listed), 0};
  const auto launch = [&](PairProgram program, GLuint unit_buffer) {
    return [&, program, unit_buffer](std::uint64_t first, std::uint64_t n, std::uint32_t capacity) {
      u.capacity = capacity;
      u.extra[3] = static_cast<std::uint32_t>(first);
      device.run(program, n, u,
                 {{2, pairs.name},
                  {3, unit_buffer},
                  {4, level.first.name},
                  {8, some_cut ? level.state.name : level.first.name},
                  {9, level.entries.name},
                  {10, level.places.name}});
    };
  };
  const std::uint32_t more =
      emit(level.listed, room,
           launch(some_cut ? PairProgram::uncut_tests : PairProgram::tests, units.name));
  if (more == 0) return true;
  units_before.reserve(level.listed * kWord, room.block);
  device.scan(units.name, units_before.name, level.listed);
  const auto totals = device.read("pair tests");
  if (overflow(totals, room)) return false;
  emit(totals[kTotalScanned], room,
       launch(some_cut ? PairProgram::more_uncut_tests : PairProgram::more_tests,
              units_before.name));
  return true;
}

void GlPairs::State::compare_large(const PairRoom& room) {
  if (large_ones == 0) return;
  large.reserve(large_ones * kWord, room.block);
  PairUniforms u = common;
  u.capacity = static_cast<std::uint32_t>(large_ones);
  device.reset(kTotalParents, 1);
  device.run(PairProgram::find_large, items, u,
             {{5, records.name}, {6, record_heads.name}, {8, large.name}});
  u.extra = {0, gathered, 0, static_cast<std::uint32_t>(large_ones)};
  send([&](std::size_t, std::size_t sent_ones) {
    for (std::size_t first = 0; first < large_ones; first += kLargeBatch) {
      u.extra[2] = static_cast<std::uint32_t>(first);
      emit(sent_ones, room, [&](std::uint64_t begin, std::uint64_t count, std::uint32_t capacity) {
        u.items = static_cast<std::uint32_t>(begin);
        u.capacity = capacity;
        device.run(PairProgram::large, count, u, with_scene({{8, large.name}, {9, pairs.name}}));
      });
    }
  });
}

}  // namespace farcull
