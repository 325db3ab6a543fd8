// The pairs of a part of the window: tests of its lists on a GL device, and what they report.
#pragma once

#include <cstddef>
#include <cstdint>
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
  /// The tests of all lists, and large triangles with each active one; false: too many. Totals are
  /// read once, and again with each portion of the pairs.
  bool make(PairLists& lists, const PartMemory& memory, PairTotalWords& totals);
  /// The same with room for as many pairs as the forecast says, up to the first portion, whose
  /// totals are read: false where there was too little room for something since the part began, so
  /// that nothing is believed. Else finish_foreseen() follows, where the caller believes the
  /// totals.
  bool begin_foreseen(PairLists& lists, const PairForecast& forecast, const PartMemory& memory,
                      PairTotalWords& totals);
  bool finish_foreseen(PairLists& lists, const PartMemory& memory, const PairTotalWords& totals);
  /// All pairs of the window; the next begin() comes before any other call.
  std::vector<TrianglePair> take();

  /// Of the part: pairs that were reported, and the most work items of further tests of a level in
  /// a portion.
  std::size_t emitted() const { return emitted_; }
  std::size_t most_units() const { return most_units_; }
  /// Of the window: portions that were read, and the pairs in them.
  std::size_t portions() const { return portions_; }
  std::size_t reported() const { return reported_; }

 private:
  // The work items of all tests whose number is k modulo `of`. The tests of an entry with 256
  // others are one, and their number is that of the entry and of the 256.
  struct Portion {
    std::uint32_t k = 0, of = 1;
  };

  bool run_portions(PairLists& lists, const PartMemory& memory, PairTotalWords& totals);
  void launch(PairLists& lists, const Portion& portion, const PartMemory& memory);
  bool take_portion(const Portion& portion, const PartMemory& memory, const PairTotalWords& totals);
  void prepare(std::size_t pairs, std::size_t units, const PartMemory& memory);
  static std::size_t most_units_of(const PairTotalWords& totals);
  std::size_t most_bytes(const PartMemory& memory) const;
  std::size_t pair_capacity(const PartMemory& memory) const;
  std::size_t unit_capacity(const PartMemory& memory) const;
  void find_large(const PartMemory& memory);
  void run_tests(PairLists& lists, std::size_t l, bool more, const PairWork& work,
                 const Portion& portion, const PartMemory& memory);
  void run_large(const Portion& portion, const PartMemory& memory);
  void read_pairs(std::size_t emitted);

  PairRun& run_;
  PairItems& items_;
  GlStore pairs_, units_, settled_, large_;
  std::size_t settled_words_ = 0;  // bits of pairs that the part has emitted; 0: it keeps none
  std::optional<PairPool> found_;
  std::vector<Portion> left_;  // of the part
  bool some_further_ = true;   // further tests are expected
  std::size_t emitted_ = 0, most_units_ = 0;
  std::size_t portions_ = 0, reported_ = 0;
};

}  // namespace farcull
