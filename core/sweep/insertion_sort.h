// Insertion sort that gives up where a list is far from sorted, and the comparison of boxes that
// the sweeps share. For core/sweep alone.
#pragma once

#include <cstdint>
#include <span>

#include "core/scene/scene.h"

namespace farcull::sweep {

/// Moves of an insertion sort, per element of its list, after which sorting anew is cheaper than to
/// go on.
constexpr std::uint64_t kMoves = 8;

/// Sorts what is almost sorted. Calls exchanged(e, f) where e moves from behind f to before it:
/// once for each two elements that stand the wrong way round, and for no others. False, with the
/// list in some order, where it takes more than kMoves per element.
template <class Element, class Less, class Exchanged>
bool insertion_sort(std::span<Element> list, std::uint64_t& moves, const Less& less,
                    const Exchanged& exchanged) {
  const std::uint64_t most = kMoves * list.size();
  std::uint64_t moved = 0;
  for (std::size_t i = 1; i < list.size() && moved <= most; ++i) {
    const Element element = list[i];
    std::size_t to = i;
    for (; to > 0 && less(element, list[to - 1]); --to) {
      exchanged(element, list[to - 1]);
      list[to] = list[to - 1];
    }
    list[to] = element;
    moved += i - to;
  }
  moves += moved;
  return moved <= most;
}

/// The same as overlap(), of boxes that are not empty.
inline bool meet(const Box& a, const Box& b) {
  return a.lo.x() <= b.hi.x() && b.lo.x() <= a.hi.x() && a.lo.y() <= b.hi.y() &&
         b.lo.y() <= a.hi.y() && a.lo.z() <= b.hi.z() && b.lo.z() <= a.hi.z();
}

}  // namespace farcull::sweep
