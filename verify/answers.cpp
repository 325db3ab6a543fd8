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
  std::uint64_t unasked = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    // Most answers are counted without a branch.
    const PairAnswer answer = answers[i];
    result.apart += answer == PairAnswer::apart;
    result.neighbours_apart += answer == PairAnswer::neighbours_apart;
    unasked += answer == PairAnswer::neighbours_unasked;
    if (answer == PairAnswer::colliding) result.pairs.push_back(candidates[i]);
    if (answer == PairAnswer::neighbours_colliding) result.neighbour_pairs.push_back(candidates[i]);
  }
  result.neighbours = result.neighbour_pairs.size() + result.neighbours_apart + unasked;
  if (result.pairs.size() + result.apart + result.neighbours != candidates.size())
    throw std::logic_error("decide: a candidate was left undecided");
  return result;
}

}  // namespace farcull
