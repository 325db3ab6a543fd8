// The programs of FAR pairs on a GL device, run so that none can be lost unnoticed (assumption A7),
// and the buffers they work on. For core/gl/pairs*.cpp alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/gl/context.h"
#include "core/gl/objects.h"
#include "core/gl/pairs_options.h"

namespace farcull {

/// Totals that programs count, as words of the counter buffer; two words, low first, where noted.
/// The same names with FAR_ are macros of the shaders. Totals that are set to 0 together follow a
/// serial number, which is sent with the zeros: where it comes back, they have arrived.
enum PairTotal : std::uint32_t {
  kSerialStart,
  kTotalOverflow,
  kTotalScanned,
  kTotalMismatches,
  kTotalListed,
  kTotalListedRows,
  kTotalSent,  // two words
  kSerialItems = kTotalSent + 2,
  kTotalWholes,
  kTotalItems,
  kTotalLarge,
  kTotalRows,  // two words
  kSerialCut = kTotalRows + 2,
  kTotalCrowded,
  kTotalParents,
  kSerialPairs,
  kTotalPairs,
  kTotalTests,  // two words
  kTotalMore = kTotalTests + 2,
  kTotals,
};

/// Totals that are set to 0 together, by the place of their serial number.
struct PairTotals {
  PairTotal serial;
  std::uint32_t words;  // with it
};
constexpr PairTotals kItemTotals{kSerialItems, kSerialCut - kSerialItems};
constexpr PairTotals kCutTotals{kSerialCut, kSerialPairs - kSerialCut};
constexpr PairTotals kPairTotals{kSerialPairs, kTotals - kSerialPairs};

/// A storage buffer with the contents of an array, of which only what changed is sent.
class PairMirror {
 public:
  /// The bytes that were sent.
  std::size_t update(std::span<const std::byte> bytes);
  const GlStore& store() const { return store_; }

 private:
  GlStore store_;
  std::vector<std::byte> sent_;
};

/// The uniforms of core/gl/shaders/pair_common.glsl that do not belong to counting.
struct PairUniforms {
  std::array<float, 4> widen{};
  std::array<std::int32_t, 4> tile{};
  std::array<std::int32_t, 2> window{};
  std::array<float, 2> depth{};
  std::array<std::uint32_t, 4> bins{1, 6, 1, 0};
  std::uint32_t cells = 0;
  std::uint32_t masked = 0;
  std::uint32_t capacity = 0;
  std::uint32_t items = 0;
  std::array<std::uint32_t, 4> extra{};
  std::array<float, 4> numbers{};
};

/// Each is a text of core/gl/shaders and a step of it.
enum class PairProgram {
  items,
  records,
  spans,
  mark_wholes,
  count_wholes,
  fill_wholes,
  mark_rows,
  count_rows,
  fill_rows,
  conflicts,
  sum_numbers,
  sum_sums,
  scan_top,
  scan_sums,
  scan_numbers,
  crowded,
  filled,
  tests,
  more_tests,
  uncut_tests,
  more_uncut_tests,
  parents,
  cut_count,
  cut_decide,
  cut_fill,
  find_large,
  large,
  sum,
  copy,
  zero,
  settled_tests,
  more_settled_tests,
  uncut_settled_tests,
  more_uncut_settled_tests,
};
constexpr std::size_t kPairPrograms = 34;

// Work of one invocation, bounded far below the 65,535 iterations after which llvmpipe stops.
constexpr std::uint32_t kSpan = 1024;      // pixels of a row
constexpr std::uint32_t kUnit = 256;       // tests
constexpr std::uint32_t kLargeBatch = 64;  // large triangles

struct PairBinding {
  GLuint index;
  const GlStore* store;
};

class PairQueue {
 public:
  PairQueue(const GlContext& context, const GlPairOptions& options);

  std::size_t block() const { return block_; }  // bytes of data in a storage block
  /// Forgets all counts; counts dispatches from 0 where `fresh`.
  void start(bool fresh);
  void reset(PairTotals totals);
  /// Runs work(w) for 0 <= w < count < 2^31; every binding that the program reads must be given.
  void run(PairProgram program, std::uint64_t count, const PairUniforms& uniforms,
           const std::vector<PairBinding>& bindings);
  /// The sums before each of `count` numbers; their total becomes kTotalScanned.
  void scan(const GlStore& numbers, const GlStore& before, std::size_t count);
  /// Lets the device sum what the store holds; read() compares the sum with that of `data`, of a
  /// whole number of words.
  void expect(const GlStore& store, std::span<const std::byte> data);
  /// Grows to hold `wanted` bytes of data, of which the first `keep` survive.
  void grow(GlStore& store, std::size_t wanted, std::size_t keep);
  /// Sets the first `words` words of data to 0, by a dispatch, so that it cannot be lost unnoticed.
  void zero(const GlStore& store, std::size_t words) {
    run(PairProgram::zero, words, {}, {{1, &store}});
  }
  /// Waits, reads the totals and throws Error naming `stage` unless every work item of every
  /// dispatch since the start finished, each read the uniforms and the buffers that were meant,
  /// what was sent and what was set to 0 has arrived, and GL has no error.
  std::array<std::uint32_t, kTotals> read(const std::string& stage);

  /// Counts a wait for results that read() does not make.
  void add_readback() { ++readbacks_; }

  /// Since start(true).
  std::size_t dispatches() const { return dispatches_; }
  std::size_t readbacks() const { return readbacks_; }

 private:
  struct Program {
    GlProgram name;
    std::uint32_t bindings = 0;  // a bit for each that it reads
  };
  struct Dispatch {
    std::uint32_t items;
    std::uint32_t echo;  // as in core/gl/shaders/pair_main.glsl
  };
  const Program& program(std::size_t which);
  void check_finished(const std::string& stage);

  const GlContext& context_;
  std::size_t block_;
  std::size_t dispatches_ = 0, readbacks_ = 0;
  std::array<Program, kPairPrograms> programs_;  // compiled when first used
  GlStore counters_;
  GlStore sums_;
  std::vector<Dispatch> expected_;                // of each dispatch since the last read
  std::uint32_t expected_sum_ = 0;                // of what was sent since the start
  std::array<std::uint32_t, kTotals> serials_{};  // those that were sent, at their places
  std::uint32_t serial_ = 0;                      // the last one
  std::vector<std::uint32_t> words_;
};

}  // namespace farcull
