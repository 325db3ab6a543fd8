// FAR pairs of one window on a GL device: the programs, the buffers they work on, and the parts of
// the window that fit the memory, one after the other. Programs run so that none can be lost
// unnoticed (assumption A7). For core/gl/pairs alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gl/base/objects.h"
#include "core/gl/pairs/pairs.h"
#include "core/pairs/backend.h"
#include "core/scene/pair_sort.h"

namespace farcull {

/// Totals that programs count, as words of the counter buffer; two words, low first, where noted,
/// or a word for each level. The same names with FAR_ are macros of the shaders. Totals that are
/// set to 0 together follow a serial number, which is sent with the zeros: if it comes back, the
/// zeros have arrived.
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
  kTotalParents = kTotalCrowded + kMaxLevel + 1,  // the same cells, counted when they are listed
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
  std::uint32_t words;  // with the serial number
};
constexpr PairTotals kItemTotals{kSerialItems, kSerialPairs - kSerialItems};
constexpr PairTotals kPairTotals{kSerialPairs, kTotals - kSerialPairs};

/// How many work items a dispatch has: `most` if no total is given. Else the device takes the
/// number from a total that it counted, so that the host need not wait: `times` work items for each
/// `per` of the total. The total may be at most `most`, the room for what it counts. If it is more,
/// this dispatch and later ones that use a total do no work, and read() says so.
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

/// The programs of FAR pairs. Each is one step of a shader file of core/gl/pairs.
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

/// The times at which a part of the window begins, its slices are marked, its lists are filled in
/// and its tests are done.
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
  /// Writes for each number the sum of all numbers before it; the sum of all becomes the total
  /// `sum`. There are `count` numbers, or as many as the total `counted` says, unless that is
  /// kSerialStart.
  void scan(const GlStore& numbers, const GlStore& before, std::size_t count, PairTotal counted,
            PairTotal sum);
  /// Lets the device sum what five stores hold; read() compares the sum with that of the data that
  /// were sent: a whole number of words each, or none.
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

  /// Counts a wait for results outside read().
  void add_readback() { ++readbacks_; }

  /// Since start(true).
  std::size_t dispatches() const { return dispatches_; }
  std::size_t readbacks() const { return readbacks_; }

 private:
  struct Program {
    GlProgram name;
    std::uint32_t bindings = 0;  // bit b: the program reads binding b
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
  bool overflow_ = false;           // there was too little room, or a sum was too large
  std::uint32_t expected_sum_ = 0;  // of what was sent since the start
  PairTotalWords serials_{};        // serial numbers that were sent, at their places
  std::uint32_t serial_ = 0;        // the last one
  std::vector<std::uint32_t> words_;
  GlClock clock_{kPairStamps};
};

// Bytes.
constexpr std::size_t kWord = sizeof(std::uint32_t);
constexpr std::size_t kVec4 = 16;
constexpr std::size_t kRecord = 5 * kVec4;
constexpr std::size_t kEntry = 2 * kVec4;

constexpr const char* kLostInvocation = "a compute invocation was lost";

/// A part of the window.
struct PairPart {
  int i0, i1, j0, j1;  // pixels, inclusive
  int width() const { return i1 - i0 + 1; }
  int height() const { return j1 - j0 + 1; }
  std::size_t cells() const { return static_cast<std::size_t>(width()) * height(); }
};

/// The memory of one part of the window.
struct PartMemory {
  std::size_t left = 0;
  std::size_t block = 0;
  bool last = false;  // a single pixel, which is done whatever it takes

  /// Takes `bytes` of one buffer. False: the part must be split. Throws Error if a single pixel
  /// needs more than a block.
  bool take(std::size_t bytes);
};

/// The owners that are in the window, each with a number.
struct PairOwners {
  std::uint32_t bits = 0;    // of the largest number
  std::uint32_t groups = 1;  // of entries, by owner
  bool same_group = true;    // entries of one group may collide
};

/// The triangles of a task as buffers of the device, which all parts of a window share. If an array
/// is larger than a storage block, triangles are gathered and sent in pieces, when they are needed.
class DeviceScene {
 public:
  explicit DeviceScene(PairQueue& device) : device_(device) {}

  /// Brings the buffers up to date; only what changed is sent. The task must outlive its use.
  PairOwners begin(const PairTask& task);
  bool gathered() const { return gathered_; }
  /// Bytes sent since begin().
  std::size_t sent_bytes() const { return sent_bytes_; }

  /// Calls launch(first, count) for the active triangles, all at once or as many as a block holds,
  /// when they are on the device.
  void for_each_piece(const std::function<void(std::size_t first, std::size_t count)>& launch);
  /// The buffers that every program about triangles reads, and `more`.
  std::vector<PairBinding> bindings(const GlStore& records, const GlStore& record_heads,
                                    std::initializer_list<PairBinding> more) const;

 private:
  /// A storage buffer with the contents of an array, of which only what changed is sent.
  struct Mirror {
    GlStore store;
    std::vector<std::byte> sent;
    /// Returns how many bytes were sent.
    std::size_t update(std::span<const std::byte> bytes);
  };
  // Brings the buffers up to date; what they then hold is compared when totals are read.
  void send(const std::array<std::span<const std::byte>, 5>& data);

  PairQueue& device_;
  const PairTask* task_ = nullptr;
  std::array<Mirror, 5> mirrors_;  // vertices, triangles, owners, active triangles, objects
  std::vector<std::uint32_t> object_words_;  // as in pair_source.glsl
  bool gathered_ = false;
  std::size_t sent_bytes_ = 0;
};

/// Room for the work on a window, as counted by the last windows or guessed: with it no count has
/// to be read before all is done.
struct PairForecast {
  std::size_t triangles = 0;  // of the scene it is about
  std::size_t wholes = 0, items = 0, large = 0, shown = 0, pairs = 0, more = 0;
  std::uint64_t row_items = 0;
  std::size_t levels = 0;                            // that are cut
  std::array<std::size_t, kMaxLevel + 1> entries{};  // of each level
  std::array<std::size_t, kMaxLevel + 1> crowded{};  // cells of each level

  /// Takes the larger one of each count.
  void join(const PairForecast& other);
  /// A quarter more of each count, except of zeros.
  PairForecast with_room() const;
  /// True if the room was enough for what the device counted, whose cells were cut `levels` times.
  bool holds(const PairTotalWords& totals, std::size_t cut) const;
};

/// Recognizes a window: its pixels, and the places of some objects in it.
struct SeenWindow {
  std::vector<float> places;  // px
  float side = 0;             // px; the larger one

  explicit SeenWindow(const PairTask& task);
  /// True if the other one shows this view, perhaps a step of a motion apart, or a view with
  /// objects at the same places.
  bool is_like(const SeenWindow& other) const;
};

/// Lists of the cells of one level: pixels, then parts of crowded ones. With a forecast the numbers
/// are upper bounds.
struct PairLevel {
  GlStore counts, first, entries, places, state, parents;
  std::size_t cells = 0;
  std::size_t listed = 0;                         // entries
  std::size_t crowded = 0;                        // cells that are cut
  std::array<std::uint32_t, 4> bins{1, 6, 1, 0};  // as u_bins
  bool dirty = false;                             // counts are not all 0

  std::size_t all_bins() const { return cells * bins[0]; }
  /// Chooses about as many bins as entries are `expected` and takes the memory of their counts;
  /// false: too much.
  bool shape(std::size_t n, std::uint32_t groups, std::uint64_t expected, PartMemory& memory);
  /// Takes the memory of n entries; false: too much.
  bool fill(std::size_t n, PartMemory& memory);
};

/// The method on the device. A part of the window takes three steps: items, lists, pairs. Each
/// returns false if the part is too much for the memory, or for the room of a forecast.
class PairFinder {
 public:
  PairFinder(const GlContext& context, const GlPairOptions& options)
      : options_(options), device_(context, options), scene_(device_) {}

  std::vector<TrianglePair> find(const PairTask& task, PairCounts& counts);
  /// The work of the last window: dispatches, bytes sent, portions of the pairs that were read, and
  /// the pairs in them.
  std::size_t dispatches() const { return device_.dispatches(); }
  std::size_t sent_bytes() const { return scene_.sent_bytes(); }
  std::size_t portions() const { return portions_; }
  std::size_t reported_pairs() const { return reported_; }

 private:
  // finder.cpp: the window and its parts.
  void begin_window(const PairTask& task);
  bool find_at_once(const PairPart& window, const PairForecast& room);
  void split(const PairPart& part);
  bool find_in(const PairPart& part, const PairForecast* room);
  void begin_part();
  void end_part(const PairTotalWords& totals);
  void break_off_lists();
  bool overflow(const PairTotalWords& totals) const;

  // forecast.cpp: the room that is expected to suffice, and the windows that it is expected from.
  std::optional<PairForecast> expected_room(const SeenWindow& window) const;
  void remember(const SeenWindow& window);

  // items.cpp: the triangles that meet the part. Whole ones (one interval in all their
  // pixels) are heads alone until they are listed, the others are records (pair_common.glsl).
  bool make_items();
  bool count_items();
  void reserve_items(std::size_t wholes, std::size_t items, std::size_t records);
  void launch_items(std::size_t whole_capacity, std::size_t capacity);
  bool make_records(std::size_t shown);
  std::size_t records() const { return items_ + shown_; }
  PairWork all_items() const { return {items_, kTotalItems}; }

  // lists.cpp: the lists of pixels, and of parts of crowded ones.
  bool make_lists();
  bool count_entries();
  bool fill_lists(std::size_t shown, std::size_t entries);
  void visit(PairProgram wholes_program, PairProgram rows_program, std::size_t capacity);
  void mark(std::size_t mask_bytes);
  bool take_parents(std::size_t l, std::size_t crowded);
  void check_cells(std::size_t l);
  void cut_cells(std::size_t l);
  bool fill_cut(std::size_t l, std::size_t entries);
  void cut_step(PairProgram program, std::size_t l, const PairWork& work, std::size_t capacity);
  PairWork all_entries(std::size_t l) const {
    return {levels_[l].listed, of_level(kTotalEntries, l)};
  }

  // emission.cpp: the tests of the lists, and the pairs that they report.
  struct Portion {
    // The work items whose number is k modulo `of`. A work item tests an entry with up to 256
    // others; its number is the index of the entry plus that of the 256 (pair_tests.comp).
    std::uint32_t k = 0, of = 1;
  };
  void begin_pairs();
  void settle_pairs();
  bool make_pairs(PairTotalWords& totals);
  bool run_portions(PairTotalWords& totals);
  void launch_portion(const Portion& portion);
  bool take_portion(const Portion& portion, const PairTotalWords& totals);
  void divide(const Portion& portion, std::uint64_t emitted, std::size_t more, std::uint64_t tests);
  void reserve_pairs(std::size_t pairs, std::size_t units);
  std::size_t most_bytes() const;
  std::size_t pair_capacity() const;
  std::size_t unit_capacity() const;
  void find_large();
  void run_tests(std::size_t l, bool more, const PairWork& work, const Portion& portion);
  void run_large(const Portion& portion);
  void read_pairs(std::size_t emitted);

  const GlPairOptions options_;
  PairQueue device_;
  DeviceScene scene_;
  // The window.
  const PairTask* task_ = nullptr;
  PairOwners owners_;
  PairCounts counts_;              // given_up: no more is done
  std::optional<PairPool> found_;  // its pairs
  std::size_t portions_ = 0, reported_ = 0;
  struct Seen {
    PairForecast counts;
    SeenWindow window;
  };
  std::deque<Seen> last_ones_;  // the last windows
  // The part.
  PairPart part_{};
  const PairForecast* room_ = nullptr;  // null: counts are read between the steps
  PartMemory memory_;
  PairUniforms common_;
  bool fresh_ = true;                 // the device was only sent data so far
  std::optional<PairForecast> seen_;  // its counts, when all of them are known
  // Its items. With a forecast the numbers are upper bounds.
  GlStore heads_, records_, record_heads_, listed_flags_, shown_list_;
  GlStore rows_;  // work items of the rows of each record
  std::size_t wholes_ = 0;
  std::size_t items_ = 0;        // that are not whole
  std::size_t large_count_ = 0;  // of those, compared with every triangle
  std::size_t shown_ = 0;        // whole ones that are listed
  std::uint64_t row_items_ = 0;  // work items of pixel rows
  // Its lists.
  GlStore rows_before_, masks_;
  std::array<PairLevel, kMaxLevel + 1> levels_;
  std::size_t levels_cut_ = 0;  // level l has lists for l <= levels_cut_
  // Its pairs.
  GlStore pairs_, units_, settled_, large_;
  std::size_t settled_words_ = 0;  // bits of pairs that the part has emitted; 0: it keeps none
  std::vector<Portion> left_;
  bool some_further_ = true;    // further tests are expected
  std::size_t emitted_ = 0;     // pairs that were reported
  std::size_t most_units_ = 0;  // most work items of further tests of a level in a portion
};

/// Throws Error unless every list was filled in as it was counted.
void check_lists(const PairTotalWords& totals);

}  // namespace farcull
