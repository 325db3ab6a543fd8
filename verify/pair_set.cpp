// The sum is over hashes of the pairs, which SplitMix64's finalizer makes.
#include "verify/pair_set.h"

#include <vector>

#include "verify/certificate/box_pairs.h"

namespace farcull {

void PairSet::add(const TrianglePair& pair) {
  ++count;
  // The finalizer of SplitMix64: sums of its values differ for different sets of one size.
  std::uint64_t x = std::uint64_t{pair.a} << 32 | pair.b;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  sum += x ^ x >> 31;
}

PairSet pairs_with_overlapping_boxes(const Scene& scene, double clearance) {
  constexpr std::size_t kBlock = 1 << 16;
  PairSet out;
  BoxPairs enumeration(scene, clearance);
  std::vector<TrianglePair> pairs;
  while (enumeration.next(pairs, kBlock)) {
    for (const TrianglePair& pair : pairs) out.add(pair);
  }
  return out;
}

}  // namespace farcull
