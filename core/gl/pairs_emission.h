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
  void settle(const PairLevel& pixels, PairMemory& memory);
  /// The tests of a level's cells that are not cut; false: too many.
  bool test(PairLevel& level, bool pixels, bool some_cut, PairMemory& memory);
  /// Large triangles with each active one.
  void compare_large(const PairMemory& memory);
  /// All pairs of the window; the next begin() comes before any other call.
  std::vector<TrianglePair> take();

 private:
  // Launches work items first .. first + count - 1, which may append `capacity` pairs.
  using Launch =
      std::function<void(std::uint64_t first, std::uint64_t count, std::uint32_t capacity)>;
  std::uint32_t emit(std::uint64_t count, const PairMemory& memory, const Launch& launch);
  void read_pairs(std::size_t emitted);

  PairRun& run_;
  PairItems& items_;
  GlStore pairs_, units_, units_before_, settled_, large_;
  std::size_t settled_words_ = 0;  // bits of pairs that the part has emitted; 0: it keeps none
  std::optional<PairPool> found_;
};

}  // namespace farcull
