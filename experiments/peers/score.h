// Compares the answers of a contestant with the labels of a suite: with closed triangles, and with
// what its own documentation calls a collision. And the smallest example of a fault: the same fault
// with fewer digits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "experiments/peers/runner.h"

namespace farcull {

/// Counts of the pairs of one parameter and one kind, or of one mesh.
struct Score {
  double parameter = 0;
  std::string kind = {};       // as in a suite; "mesh"
  std::uint64_t asked = 0;     // pairs that were put to it; of a mesh all that collide
  std::uint64_t answered = 0;  // of them, by apart or meets; of a mesh, one question, all or none
  std::uint64_t missed = 0;    // it called a pair apart that meets
  std::uint64_t wrong = 0;     // it called a pair meeting that is apart
  /// The same of the pairs that were answered and about which its documentation promises something.
  std::uint64_t own_asked = 0, own_missed = 0, own_wrong = 0;
  std::uint64_t refused = 0, unanswered = 0, crashed = 0, hung = 0, no_memory = 0;
  std::uint64_t not_asked = 0;             // not among `asked`: too many processes had ended badly
  std::uint64_t twice = 0, differing = 0;  // asked twice, and answered otherwise then
  FARCULL_FIELDS(asked, answered, missed, wrong, own_asked, own_missed, own_wrong, refused,
                 unanswered, crashed, hung, no_memory, not_asked, twice, differing)
  double ns = 0;            // of all answers
  std::string reason = {};  // of the first refusal or death

  bool operator==(const Score&) const = default;
};

/// Adds all counts of `more`; parameter, kind and the first reason stay.
void add(const Score& more, Score& to);

/// A pair of a suite that a contestant is asked about: neighbours only where its card says so.
bool takes(const ContestantCard& card, const SuitePair& pair);

/// The answer about a pair that the documentation of a contestant promises; empty: no promise. It
/// promises the label to the pairs that cross and to those that are apart. About those that touch
/// or overlap in a plane it promises the label where it speaks of closed triangles. About
/// degenerate triangles it promises nothing where it does not take them, and nothing about
/// triangles that are apart by no more than its margin.
std::optional<bool> promised(const ContestantCard& card, const SuitePair& pair);

/// By kind and parameter, in the order of the pairs. `answer` is of these pairs.
std::vector<Score> score_pairs(const ContestantCard& card, const std::vector<SuitePair>& pairs,
                               const PairsAnswer& answer);

/// Pairs of triangles that share vertices count where the card speaks of neighbours. Where the card
/// speaks of crossing triangles, or takes no degenerate ones, `own_` counts leave the others out.
Score score_mesh(const ContestantCard& card, const SuiteMesh& mesh, const MeshAnswer& answer);

/// One line without `;` between scores: for a row of a store.
std::string scores_text(const std::vector<Score>& scores);
/// The inverse of scores_text(). Throws Error for any other text.
std::vector<Score> parse_scores(const std::string& text);

/// A fault about one pair: the outcome, which the label contradicts, or a death.
struct PairFault {
  SuitePair pair;  // with its kind
  ContestOutcome outcome = ContestOutcome::apart;
};

/// The number of characters of the coordinates in decimal: what is minimized.
std::size_t cost_of(const SuitePair& pair);

/// A simpler pair with the same fault, also if it is the only one that a process is asked about;
/// empty if the fault depends on what was asked before. By the oracles it meets or not as before. A
/// search of at most `rounds` rounds minimizes the characters of its coordinates: it moves and
/// scales both triangles, rounds coordinates, and takes whatever keeps the fault. A round asks one
/// process. Shared corners stay shared. The kind is that of the new pair.
std::optional<SuitePair> minimized(const Invited& invited, const PairFault& fault,
                                   const ContestLimits& limits, int rounds = 8);

/// The 18 coordinates in decimal, with blanks between.
std::string coordinates_text(const SuitePair& pair);

}  // namespace farcull
