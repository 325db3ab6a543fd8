// Compares the answers of a contestant with the labels of a suite: with closed triangles, and with
// what its own documentation calls a collision. Also minimizes the example of a fault: finds a pair
// with the same fault and fewer digits.
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
  std::string kind = {};       // as in a suite, or "mesh"
  std::uint64_t asked = 0;     // pairs that it was asked about; of a mesh all that collide
  std::uint64_t answered = 0;  // those answered by apart or meets; of a mesh, all or none
  std::uint64_t missed = 0;    // pairs that it called apart but that meet
  std::uint64_t wrong = 0;     // pairs that it called meeting but that are apart
  /// These counts for the answered pairs about which its documentation promises something.
  std::uint64_t own_asked = 0, own_missed = 0, own_wrong = 0;
  std::uint64_t refused = 0, unanswered = 0, crashed = 0, hung = 0, no_memory = 0;
  std::uint64_t not_asked = 0;             // not among `asked`: too many processes had ended badly
  std::uint64_t twice = 0, differing = 0;  // asked twice, and answered differently then
  FARCULL_FIELDS(asked, answered, missed, wrong, own_asked, own_missed, own_wrong, refused,
                 unanswered, crashed, hung, no_memory, not_asked, twice, differing)
  double ns = 0;            // of all answers
  std::string reason = {};  // of the first refusal or death

  bool operator==(const Score&) const = default;
};

/// Adds all counts of `more`; parameter, kind and the first reason stay.
void add(const Score& more, Score& to);

/// Whether a contestant is asked about a pair of a suite: about neighbours only if its card says
/// so.
bool takes(const ContestantCard& card, const SuitePair& pair);

/// The answer about a pair that the documentation of a contestant promises; empty: no promise. It
/// promises the label for pairs that cross and for pairs that are apart. For pairs that touch or
/// overlap in a plane it promises the label if it speaks of closed triangles. It promises nothing
/// about degenerate triangles if the library does not take them, and nothing about triangles that
/// are apart by no more than its margin.
std::optional<bool> promised(const ContestantCard& card, const SuitePair& pair);

/// The scores by kind and parameter, in the order of the pairs. answer: the answers about `pairs`.
std::vector<Score> score_pairs(const ContestantCard& card, const std::vector<SuitePair>& pairs,
                               const PairsAnswer& answer);

/// The score of a mesh. Pairs of triangles that share vertices count only if the card has
/// `neighbours`. The `own_` counts have only triangles that cross if the card means `crossing`, and
/// no degenerate ones if it does not take them.
Score score_mesh(const ContestantCard& card, const SuiteMesh& mesh, const MeshAnswer& answer);

/// The scores as one line, with `;` between them, for a row of a store.
std::string scores_text(const std::vector<Score>& scores);
/// The inverse of scores_text(). Throws Error for any other text.
std::vector<Score> parse_scores(const std::string& text);

/// A fault about one pair: an outcome that the label contradicts, or a death.
struct PairFault {
  SuitePair pair;  // with its kind
  ContestOutcome outcome = ContestOutcome::apart;
};

/// The number of characters of the coordinates in decimal, which minimized() minimizes.
std::size_t cost_of(const SuitePair& pair);

/// A simpler pair with the same fault, also if it is the only pair that a process is asked about;
/// empty if the fault depends on earlier questions. By the exact oracles it meets iff the first
/// pair meets. A search of at most `rounds` rounds minimizes the characters of its coordinates: it
/// moves and scales both triangles, rounds coordinates, and keeps a change if the fault stays. The
/// pairs of a round go to one process. Shared corners stay shared. The kind is that of the new
/// pair.
std::optional<SuitePair> minimized(const Invited& invited, const PairFault& fault,
                                   const ContestLimits& limits, int rounds = 8);

/// The 18 coordinates in decimal, with blanks between them.
std::string coordinates_text(const SuitePair& pair);

}  // namespace farcull
