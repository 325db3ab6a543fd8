// Counts the answers. Each class is counted by its own answers, never as the rest of the others: a
// candidate that nobody decided must not count as decided.
#include "verify/answers.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace farcull {

std::vector<TrianglePair> Collisions::all() const {
  std::vector<TrianglePair> both;
  both.reserve(pairs.size() + neighbour_pairs.size());
  std::merge(pairs.begin(), pairs.end(), neighbour_pairs.begin(), neighbour_pairs.end(),
             std::back_inserter(both));
  return both;
}

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
