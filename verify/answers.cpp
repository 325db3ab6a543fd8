// No class is what the others leave over: an answer that nobody gave must not count as one.
#include "verify/answers.h"

#include <stdexcept>

namespace farcull {

Collisions count_answers(std::span<const TrianglePair> candidates,
                         std::span<const PairAnswer> answers) {
  if (answers.size() != candidates.size())
    throw std::logic_error("decide: not one answer for each candidate");
  Collisions result;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    switch (answers[i]) {
      case PairAnswer::apart:
        ++result.apart;
        continue;
      case PairAnswer::colliding:
        result.pairs.push_back(candidates[i]);
        continue;
      case PairAnswer::neighbours_apart:
        ++result.neighbours;
        ++result.neighbours_apart;
        continue;
      case PairAnswer::neighbours_colliding:
        ++result.neighbours;
        result.neighbour_pairs.push_back(candidates[i]);
        continue;
      case PairAnswer::neighbours_unasked:
        ++result.neighbours;
        continue;
      case PairAnswer::undecided:
        break;
    }
    throw std::logic_error("decide: a candidate was left undecided");
  }
  return result;
}

}  // namespace farcull
