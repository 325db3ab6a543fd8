// The programs of FAR pairs on a GL device, run so that none can be lost unnoticed (assumption A7),
// and the buffers they work on. For core/gl_pairs.cpp alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/gl_context.h"
#include "core/gl_objects.h"
#include "core/gl_pairs.h"

namespace farcull {

/// Totals that programs count, as words of the counter buffer; two words, low first, where noted.
/// The same names with FAR_ are macros of the shaders.
enum PairTotal : std::uint32_t {
  kTotalWholes,  // the first five belong to the items
  kTotalItems,
  kTotalLarge,
  kTotalRows,  // two words
  kTotalOverflow = kTotalRows + 2,
  kTotalScanned,
  kTotalCrowded,
  kTotalMismatches,
  kTotalListed,
  kTotalListedRows,
  kTotalParents,
  kTotalPairs,  // the last four belong together: an emission starts with all of them 0
  kTotalTests,  // two words
  kTotalMore = kTotalTests + 2,
  kTotals,
};

/// A storage buffer that grows and never shrinks.
struct PairStore {
  GlBuffer name;
  std::size_t bytes = 0;
  /// Makes room for `wanted` bytes, up to half as much again within `most`; the first `keep` bytes
  /// survive. True where the others are lost.
  bool reserve(std::size_t wanted, std::size_t most, std::size_t keep = 0);
};

/// A storage buffer with the contents of an array, of which only what changed is sent.
class PairMirror {
 public:
  /// The bytes that were sent.
  std::size_t update(std::span<const std::byte> bytes);
  GLuint name() const { return store_.name; }

 private:
  PairStore store_;
  std::vector<std::byte> sent_;
};

/// The uniforms of core/shaders/pair_common.glsl that do not belong to counting.
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

/// A text of core/shaders and a step of it each.
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
};
constexpr std::size_t kPairPrograms = 27;

// Work of one invocation, bounded far below the 65,535 iterations after which llvmpipe stops.
constexpr std::uint32_t kSpan = 1024;      // pixels of a row
constexpr std::uint32_t kUnit = 256;       // tests
constexpr std::uint32_t kLargeBatch = 64;  // large triangles

struct PairBinding {
  GLuint index;
  GLuint buffer;
};

class PairDevice {
 public:
  PairDevice(const GlContext& context, const GlPairOptions& options);

  std::size_t block() const { return block_; }  // bytes of a storage block
  /// Forgets all counts; counts dispatches from 0 where `fresh`.
  void start(bool fresh);
  void reset(PairTotal first, std::uint32_t words);
  /// Runs work(w) for 0 <= w < count < 2^31; every binding that the program reads must be given.
  void run(PairProgram program, std::uint64_t count, const PairUniforms& uniforms,
           const std::vector<PairBinding>& bindings);
  /// The sums before each of `count` numbers; their total becomes kTotalScanned.
  void scan(GLuint numbers, GLuint before, std::size_t count);
  /// Waits, reads the totals and throws Error naming `stage` unless every work item of every
  /// dispatch since the start finished and GL has no error.
  std::array<std::uint32_t, kTotals> read(const std::string& stage);

  PairFault fault = PairFault::none;
  std::size_t fault_at = 0;
  std::size_t dispatches = 0;

 private:
  GLuint program(std::size_t which);
  void check_finished(const std::string& stage);

  const GlContext& context_;
  std::size_t block_;
  std::array<GlProgram, kPairPrograms> programs_;  // compiled when first used
  GlBuffer counters_;
  PairStore sums_;
  std::vector<std::uint32_t> expected_;  // finished work items of each dispatch since the last read
  std::vector<std::uint32_t> words_;
};

}  // namespace farcull
