// The pipeline from a scene to a record: plan(), find(), exact tests, accounting and kinds of
// contact. The command line, the library, benchmarks, tiles, studies and pictures call run().
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

/// Finds the candidates of the planned scene, without pairs of ignored objects. question: if not
/// null, candidates from a tree of boxes are decided when they are found. These candidates are not
/// listed, which saves memory. marks: if false, the triangles of these candidates are not recorded
/// in Candidates::triangles. Throws Error for any fault of the device. After an exception the
/// session has no device. The next run opens a device again.
Candidates find(const Scene& scene, const Plan& plan, Session& session,
                const Progress& progress = {}, const ExactQuestion* question = nullptr,
                bool marks = true);

/// Arguments of run() that the calling code sets. The user's options are in RunOptions.
struct RunUse {
  /// Removes candidates that runs of other tiles decide. May be empty. Called after the accounting,
  /// which needs all candidates, and before the exact tests.
  std::function<void(std::vector<TrianglePair>&)> filter = {};
  std::string scene_hash = {};  // scene_hash() of the scene, if the caller knows it
  /// True: the record has only pairs with their contacts, counts, times and stages.
  bool answer_only = false;
  /// The changes of the scene since the last run of the session. If null, run() compares the two
  /// scenes. Used only if the session remembers frames.
  const FrameChange* change = nullptr;
  /// Only for `boxes`: the overlapping blocks that decide_by_motions() found. May be null. If set,
  /// only vertices of these blocks are read, and the session's memory of frames is not used.
  const BlockDecision* decided = nullptr;
  bool decide_neighbours = true;  // false: neighbours are only counted
};

/// Plans the run, finds the candidates and decides them exactly. If RunOptions::verify is set, also
/// tests all other pairs of triangles. Throws Error as plan() and find() do.
Record run(const Scene& scene, const RunOptions& options, Session& session,
           const Progress& progress = {}, const RunUse& use = {});

/// Runs FAR two more times, with smaller radii. This takes up to five times the cull time of the
/// record, since without a guarantee all views are drawn. Returns nothing unless the record has a
/// guarantee of `far`, `far` drew, and the record accounts for all pairs.
std::optional<PairsAtRisk> pairs_at_risk(const Scene& scene, const Record& record, Session& session,
                                         const Progress& progress = {});

/// Decides candidates by exact predicates. If limit > 0, stops when `limit` candidates collide.
FirstCollisions decide(const Scene& scene, const std::vector<TrianglePair>& candidates,
                       const ExactQuestion& question, std::uint64_t limit);

/// Counts the colliding pairs of each kind of contact, neighbours included. Returns one entry per
/// kind, in the order of kContactKinds.
std::vector<std::pair<ContactKind, std::uint64_t>> count_kinds(const Record& record);

/// Returns the candidates of the exact tests, sorted. If the candidates were not listed, returns
/// only the colliding pairs, neighbours included. (Then the accounting has to test all other
/// pairs.)
std::vector<TrianglePair> pairs_left(const Record& record);

/// True if a method with a guarantee missed a pair. strict: also true if a method without a
/// guarantee missed a pair (`farcull verify`). Does not use the verdict about the device.
bool broken(const Record& record, bool strict);

// The next two functions throw Error if no pair of objects is tested. The answer would be 0 pairs,
// as for a scene without collisions.

/// Throws Error about the argument `where` if all pairs of objects are ignored and no object is
/// tested against itself. self: an object is tested against itself. ignored: number of different
/// ignored pairs. otherwise: text of a second remedy, besides "ignore fewer pairs"; may be "".
void require_asked(std::uint64_t objects, bool self, std::uint64_t ignored,
                   const std::string& where, const std::string& otherwise);

/// The same check for a scene. Adds the pairs of scene.ignored to `ignored`.
void require_asked(const Scene& scene, std::vector<ObjectPair> ignored, const std::string& where,
                   const std::string& otherwise);

}  // namespace farcull
