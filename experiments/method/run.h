// The one pipeline, from a scene to a record: plan(), find(), then exact tests, accounting and
// kinds of contact. Command line, library, benchmark, tiles, studies and pictures call run().
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/method/plan.h"
#include "experiments/method/record.h"
#include "experiments/method/session.h"

namespace farcull {

/// Runs the method: finds the candidates of the planned scene, without those of ignored objects.
/// question: candidates from a tree of boxes are decided as they are found, so that memory does not
/// grow with their number; null: all are listed, except by a method that culls nothing. marks: if
/// false, triangles of candidates that are not listed are left out. Throws Error for any fault of
/// the device. After any exception the session has forgotten its device, and can be used again.
Candidates find(const Scene& scene, const Plan& plan, Session& session,
                const Progress& progress = {}, const ExactQuestion* question = nullptr,
                bool marks = true);

/// How a caller of run() uses it, besides the options of the user.
struct RunUse {
  /// Removes candidates that are left to other runs (tiles). Called before the exact tests, but
  /// after the accounting, which needs all candidates. Empty: none is removed.
  std::function<void(std::vector<TrianglePair>&)> filter = {};
  std::string scene_hash = {};  // scene_hash() of the scene, if the caller knows it
  /// True: the record has only the pairs, their contacts, counts, times and stages. It has no hash
  /// and no degenerate triangles of the scene, no accounting, no Promise, and no triangles of
  /// candidates.
  bool answer_only = false;
  /// What is new since the last run of the session, if the caller knows; null: the scenes are
  /// compared. Used only if the session remembers frames.
  const FrameChange* change = nullptr;
  /// For `boxes`: the blocks that overlap, by decide_by_motions(), if the caller knows them. Then
  /// only vertices of these blocks are read, and the session neither uses nor keeps frames.
  const BlockDecision* decided = nullptr;
  bool decide_neighbours = true;  // false: neighbours are counted, as if the options left them out
};

/// Plans, finds, decides and, if the options ask for it, accounts for every pair. Throws Error as
/// plan() and find() do.
Record run(const Scene& scene, const RunOptions& options, Session& session,
           const Progress& progress = {}, const RunUse& use = {});

/// Runs FAR twice more, with smaller balls and without accounting. This takes up to five times the
/// cull time of the record, since no view may be left out without a guarantee. Empty unless the
/// record is of `far` with a guarantee, drew, and accounts for all pairs.
std::optional<PairsAtRisk> pairs_at_risk(const Scene& scene, const Record& record, Session& session,
                                         const Progress& progress = {});

/// Decides candidates by exact predicates: all of them, or until `limit` of them collide (if > 0).
FirstCollisions decide(const Scene& scene, const std::vector<TrianglePair>& candidates,
                       const ExactQuestion& question, std::uint64_t limit);

/// How many of the colliding pairs, neighbours included, have each kind of contact; all kinds in
/// their order.
std::vector<std::pair<ContactKind, std::uint64_t>> count_kinds(const Record& record);

/// The pairs that were left to the exact tests, sorted. If they were not listed, since they were
/// decided as they were found: only the colliding pairs, neighbours included, so that every other
/// pair has to be accounted for.
std::vector<TrianglePair> pairs_left(const Record& record);

/// True if the record breaks a guarantee: a method that guarantees to miss no pair missed one.
/// strict: no method may miss a pair (`farcull verify`). Ignores the verdict about the
/// device.
bool broken(const Record& record, bool strict);

// One rule for program, library and Python: it is an error if nothing is tested, since an answer of
// 0 pairs would be taken for a scene without collisions.

/// Throws Error about the argument `where` if so many different pairs of objects are ignored that
/// none is left, and no object is tested against itself. The remedy is to ignore fewer pairs, or
/// what `otherwise` says.
void require_asked(std::uint64_t objects, bool self, std::uint64_t ignored,
                   const std::string& where, const std::string& otherwise);

/// The same for a scene: the pairs in scene.ignored count as well.
void require_asked(const Scene& scene, std::vector<ObjectPair> ignored, const std::string& where,
                   const std::string& otherwise);

}  // namespace farcull
