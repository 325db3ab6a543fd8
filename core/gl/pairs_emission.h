// The pairs of a part of the window: tests of its lists on a GL device, and what they report.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/gl/pairs_lists.h"
#include "core/gl/pairs_run.h"
#include "core/scene/pair_sort.h"

namespace farcull {

class PairEmission {
 public:
  PairEmission(PairRun& run, PairItems& items) : run_(run), items_(items) {}

  /// Begins a window: no pairs yet.
  void begin();
  /// Decides whether pairs of the part are emitted once, which takes a bit for each two records:
  /// where they may repeat often, and there is memory for it.
  void settle(const PairLevel& pixels, PartMemory& memory);
  /// The tests of all lists, and large triangles with each active one; false: too many. `totals`
  /// are those of all tests together where they were done at once, else nothing.
  bool make(PairLists& lists, const PartMemory& memory, std::optional<PairTotalWords>& totals);
  /// The same with room for as many pairs as the forecast says; reads the totals once. False: there
  /// was too little room for something since the part began, so that nothing is believed.
  bool make(PairLists& lists, const PairForecast& forecast, const PartMemory& memory,
            PairTotalWords& totals);
  /// All pairs of the window; the next begin() comes before any other call.
  std::vector<TrianglePair> take();

 private:
  // Launches work items first .. first + count - 1, which may append `capacity` pairs.
  using Launch =
      std::function<void(std::uint64_t first, std::uint64_t count, std::uint32_t capacity)>;
  // Is told how many work items of further tests some work items have left.
  using After = std::function<void(std::uint32_t more)>;
  void emit(std::uint64_t count, std::size_t level, const PartMemory& memory, const Launch& launch,
            const After& after);
  void emit_tests(PairLists& lists, std::size_t l, const PartMemory& memory);
  void emit_large(const PartMemory& memory);
  std::size_t most_bytes(const PartMemory& memory) const;
  std::size_t pair_capacity(const PartMemory& memory) const;
  std::size_t unit_capacity(const PartMemory& memory) const;
  void find_large(const PartMemory& memory);
  void run_tests(PairLists& lists, std::size_t l, bool more, const PairWork& work,
                 std::uint64_t first, const PartMemory& memory);
  void run_large(const PairWork& work, std::size_t sent, std::uint64_t first, std::size_t capacity);
  void launch_all(PairLists& lists, bool more, const PartMemory& memory);
  void read_pairs(std::size_t emitted);

  PairRun& run_;
  PairItems& items_;
  GlStore pairs_, units_, settled_, large_;
  std::size_t settled_words_ = 0;  // bits of pairs that the part has emitted; 0: it keeps none
  std::optional<PairPool> found_;
  std::size_t emitted_bytes_ = 0;  // of a part whose tests are not done at once
  // Triangles of the scene whose pairs were too many to be emitted at once; 0: none.
  std::size_t too_many_of_ = 0;
};

}  // namespace farcull
