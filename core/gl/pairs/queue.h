// The programs of FAR pairs on a GL device, run so that none can be lost unnoticed (assumption A7),
// and the buffers they work on. For core/gl/pairs alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/gl/base/objects.h"
#include "core/gl/pairs/pairs.h"
#include "core/pairs/backend.h"

namespace farcull {

/// Totals that programs count, as words of the counter buffer; two words, low first, where noted,
/// or a word for each level. The same names with FAR_ are macros of the shaders. Totals that are
/// set to 0 together follow a serial number, which is sent with the zeros: where it comes back,
/// they have arrived.
enum PairTotal : std::uint32_t {
  kSerialStart,
  kTotalMismatches,
  kTotalListed,
  kTotalListedRows,
  kTotalSent,                       // two words
  kTotalRowItems = kTotalSent + 2,  // work items of pixel rows, as scanned
  kTotalLargeFound,
  kTotalEntries,                                  // of each level
  kTotalCrowded = kTotalEntries + kMaxLevel + 1,  // cells, of each level, before they are filled
  kTotalParents = kTotalCrowded + kMaxLevel + 1,  // the same, when they are listed
  kSerialItems = kTotalParents + kMaxLevel + 1,
  kTotalWholes,
  kTotalItems,
  kTotalLarge,
  kTotalRows,  // two words
  kSerialPairs = kTotalRows + 2,
  kTotalOverflow,
  kTotalPairs,                    // two words
  kTotalTests = kTotalPairs + 2,  // two words
  kTotalMore = kTotalTests + 2,   // work items of further tests, of each level
  kTotals = kTotalMore + kMaxLevel + 1,
};
using PairTotalWords = std::array<std::uint32_t, kTotals>;
/// A total of two words.
inline std::uint64_t two_words(const PairTotalWords& totals, PairTotal low) {
  return std::uint64_t{totals[low]} | std::uint64_t{totals[low + 1]} << 32;
}
/// The total of a level.
constexpr PairTotal of_level(PairTotal first, std::size_t level) {
  return static_cast<PairTotal>(first + level);
}

/// Totals that are set to 0 together, by the place of their serial number.
struct PairTotals {
  PairTotal serial;
  std::uint32_t words;  // with it
};
constexpr PairTotals kItemTotals{kSerialItems, kSerialPairs - kSerialItems};
constexpr PairTotals kPairTotals{kSerialPairs, kTotals - kSerialPairs};

/// How many work items a dispatch has: `most` where no total is given. Else a total that the device
/// counts says it, so that nobody has to wait and read it: one work item for each `per` of it,
/// `times`. The total may be `most`, the room that there is for what it counts. Where it is more,
/// no work is done, nor by the dispatches after it that ask for a total, and read() says so.
struct PairWork {
  PairWork(std::uint64_t count) : most(count) {}
  PairWork(std::uint64_t room, PairTotal counted, std::uint32_t each = 1, std::uint32_t times_ = 1)
      : most(room), total(counted), per(each), times(times_) {}
  std::uint64_t most;
  PairTotal total = kSerialStart;  // none
  std::uint32_t per = 1, times = 1;

  std::uint64_t items(std::uint64_t of) const {
    return total == kSerialStart ? of : (of + per - 1) / per * times;
  }
};

/// The uniforms of core/gl/pairs/pair_common.glsl that do not belong to counting.
struct PairUniforms {
  std::array<float, 4> widen{};
  std::array<std::int32_t, 4> tile{};
  std::array<std::int32_t, 2> window{};
  float steps_per_px = 1;  // DepthSlices
  std::int32_t first_step = 0, slices_per_step = 0;
  std::array<std::uint32_t, 4> bins{1, 6, 1, 0};
  std::uint32_t cells = 0;
  std::uint32_t masked = 0;
  std::uint32_t capacity = 0;
  std::uint32_t items = 0;
  std::array<std::uint32_t, 4> extra{};
  std::array<float, 4> numbers{};
};

/// Each is a text of core/gl/pairs and a step of it.
enum class PairProgram {
  items,
  records,
  mark_wholes,
  count_wholes,
  fill_wholes,
  mark_rows,
  count_rows,
  fill_rows,
  conflicts,
  sum_numbers,
  scan_numbers,
  crowded,
  sum,
  zero,
  parents,
  tests,
  more_tests,
  uncut_tests,
  more_uncut_tests,
  cut_count,
  cut_decide,
  cut_fill,
  find_large,
  large,
  copy,
  settled_tests,
  more_settled_tests,
  uncut_settled_tests,
  more_uncut_settled_tests,
};
constexpr std::size_t kPairPrograms = 29;

// Work of one invocation, bounded far below the 65,535 iterations after which llvmpipe stops.
constexpr std::uint32_t kSpan = 1024;      // pixels of a row
constexpr std::uint32_t kUnit = 256;       // tests
constexpr std::uint32_t kLargeBatch = 64;  // large triangles

struct PairBinding {
  GLuint index;
  const GlStore* store;
};

/// When a part of the window begins, when its slices are marked, its lists filled in, and its tests
/// done.
enum class PairStamp : std::size_t { begun, marked, listed, done };
constexpr std::size_t kPairStamps = 4;

class PairQueue {
 public:
  PairQueue(const GlContext& context, const GlPairOptions& options);

  std::size_t block() const { return block_; }  // bytes of data in a storage block
  /// Forgets all counts, and all that was not read; counts dispatches from 0 where `fresh`.
  void start(bool fresh);
  void reset(PairTotals totals);
  /// Runs work(w) for each work item, fewer than 2^31 of them; every binding that the program reads
  /// must be given.
  void run(PairProgram program, const PairWork& work, const PairUniforms& uniforms,
           const std::vector<PairBinding>& bindings);
  /// The sums before each of `count` numbers, or of as many as the total `counted` says, unless it
  /// is kSerialStart; their sum becomes the total `sum`.
  void scan(const GlStore& numbers, const GlStore& before, std::size_t count, PairTotal counted,
            PairTotal sum);
  /// Lets the device sum what five stores hold; read() compares the sum with that of the data, of a
  /// whole number of words each, none where nothing was sent.
  struct Sent {
    const GlStore* store;
    std::span<const std::byte> data;
  };
  void expect(const std::array<Sent, 5>& sent);
  /// Grows to hold `wanted` bytes of data, of which the first `keep` survive.
  void grow(GlStore& store, std::size_t wanted, std::size_t keep);
  /// Sets the first `words` words of data to 0, by a dispatch, so that it cannot be lost unnoticed.
  /// `bits`: they are bits of pairs.
  void zero(const GlStore& store, std::size_t words, bool bits = false) {
    PairUniforms u;
    u.extra[0] = bits;
    run(PairProgram::zero, words, u, {{1, &store}});
  }
  /// Waits, reads the totals and throws Error naming `stage` unless every work item of every
  /// dispatch since the start finished, each read the uniforms and the buffers that were meant,
  /// what was sent and what was set to 0 has arrived, and GL has no error. Where kTotalOverflow is
  /// not 0, there was not room enough for a total, or a sum went beyond 32 bits: what was done
  /// since the start is not complete then.
  PairTotalWords read(const std::string& stage);

  /// Notes the time at which the device gets here, where it has a clock (GL_TIMESTAMP).
  void stamp(PairStamp at) { clock_.stamp(static_cast<std::size_t>(at)); }
  /// ms on the device between two stamps since the start; negative where they are not known. It
  /// does not wait: read() comes before. Throws Error where a stamp was lost.
  double between(PairStamp from, PairStamp to) const {
    return clock_.between(static_cast<std::size_t>(from), static_cast<std::size_t>(to));
  }

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
    PairWork work;
    std::uint32_t echo;  // as in core/gl/pairs/pair_main.glsl
  };
  const Program& program(std::size_t which);
  void check_finished(const std::string& stage);

  const GlContext& context_;
  std::size_t block_;
  std::size_t dispatches_ = 0, readbacks_ = 0;
  std::array<Program, kPairPrograms> programs_;  // compiled when first used
  GlStore counters_;
  GlStore sums_;
  std::vector<Dispatch> expected_;  // of each dispatch since the last read
  std::vector<PairWork> needed_;    // totals for which there has to be room
  bool overflow_ = false;           // there was not, or a sum was too large
  std::uint32_t expected_sum_ = 0;  // of what was sent since the start
  PairTotalWords serials_{};        // those that were sent, at their places
  std::uint32_t serial_ = 0;        // the last one
  std::vector<std::uint32_t> words_;
  GlClock clock_{kPairStamps};
};

}  // namespace farcull
