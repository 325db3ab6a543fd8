// Both tasks of a peer that has a tree of triangles for each object.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "experiments/peers/distance_peers.h"

namespace farcull {

/// The distances that a task asks for, sorted; tasks are divided over the threads.
/// numbers: of the objects that have triangles, ascending; the functions take indices into it.
/// most: the bound to begin with. gap(i, k): at most what bound() can find, and cheap.
/// bound(i, k, least): what the peer finds, if that is below `least`; otherwise `least` or more.
/// distance(found): the distance in world units, or infinity where the question does not ask for
/// it.
template <class Scalar, class Gap, class Bound, class Distance>
std::vector<PeerDistance> distances_of_trees(const std::vector<std::uint32_t>& numbers,
                                             DistanceTask task, Scalar most, unsigned threads,
                                             const Gap& gap, const Bound& bound,
                                             const Distance& distance) {
  const std::size_t count = numbers.size();
  std::vector<PeerDistance> out;
  if (task == DistanceTask::objects) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = i + 1; k < count; ++k) pairs.emplace_back(i, k);
    }
    out.resize(pairs.size());
    for_each_taken(pairs.size(), 1, threads, [&](std::size_t t) {
      const auto [i, k] = pairs[t];
      out[t] = {numbers[i], numbers[k], distance(bound(i, k, most))};
    });
  } else {
    out.resize(count);
    for_each_taken(count, 1, threads, [&](std::size_t i) {
      std::vector<std::pair<Scalar, std::size_t>> others;
      for (std::size_t k = 0; k < count; ++k) {
        if (k != i) others.emplace_back(gap(i, k), k);
      }
      std::sort(others.begin(), others.end());  // the nearest boxes first
      Scalar least = most;
      std::size_t nearest = i;
      for (const auto& [apart, k] : others) {
        if (apart >= least) break;
        const Scalar found = bound(i, k, least);
        if (!(found < least)) continue;
        least = found;
        nearest = k;
      }
      out[i] = {numbers[i], numbers[nearest],
                nearest == i ? std::numeric_limits<double>::infinity() : distance(least)};
    });
  }
  std::erase_if(out, [](const PeerDistance& d) { return std::isinf(d.distance); });
  return out;
}

}  // namespace farcull
