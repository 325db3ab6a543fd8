// The one pipeline, from a scene to a record: plan(), find(), then exact tests, accounting and
// kinds of contact. Command line, library, benchmark, tiles, studies and pictures call run().
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/method/plan.h"
#include "experiments/method/record.h"
#include "experiments/method/session.h"

namespace farcull {

/// Runs the method: candidates of the planned scene, without those of ignored objects. Throws Error
/// for any fault of the device. After any exception the session has forgotten its device, and can
/// be used again.
Candidates find(const Scene& scene, const Plan& plan, Session& session,
                const Progress& progress = {});

/// The promise of the method on the device that it used, whose verdict is the session's. After an
/// exception the session has forgotten its device, as after find().
Promise promise_of(const RunOptions& options, const UsedDevice& device, Session& session);

/// How a caller uses a run, beside what its user asks for.
struct RunUse {
  /// Removes candidates that other runs answer for (tiles), after the accounting, which is about
  /// all candidates, and before the exact tests. Empty: none is removed.
  std::function<void(std::vector<TrianglePair>&)> filter = {};
  std::string scene_hash = {};  // as scene_hash() of the scene, where the caller knows it
  /// Only the pairs, their contacts, counts, times and stages: the hash and the degenerate
  /// triangles of the scene, the accounting, the promise, and the triangles of candidates are left
  /// out.
  bool answer_only = false;
  bool decide_neighbours = true;  // false: neighbours are counted, as if the options left them out
};

/// Plans, finds, decides and, where the options ask for it, accounts for every pair. Throws Error
/// as plan() and find() do.
Record run(const Scene& scene, const RunOptions& options, Session& session,
           const Progress& progress = {}, const RunUse& use = {});

/// Decides candidates by exact predicates: all of them, or where limit > 0 until so many collide.
/// frames: null, or what is kept of the scene's last frame, for a call without a limit.
FirstCollisions decide(const Scene& scene, const std::vector<TrianglePair>& candidates,
                       const ExactQuestion& question, std::uint64_t limit, FrameDecider* frames);

/// One contact for each pair, with the detail asked for; empty if that is `none`.
std::vector<ContactShape> contacts_of(const Scene& scene, const std::vector<TrianglePair>& pairs,
                                      ContactDetail contacts, unsigned threads);

/// How many of the colliding pairs, neighbours among them, meet in each way; all kinds in their
/// order.
std::vector<std::pair<ContactKind, std::uint64_t>> count_kinds(const Record& record);

/// The pairs that were left to the exact tests, sorted; for a method that culls nothing the
/// colliding ones, neighbours among them, so that every other pair has to be accounted for.
std::vector<TrianglePair> pairs_left(const Record& record);

/// Whether the record breaks a guarantee: `strict` asks it of every method (`farcull verify`). The
/// verdict about the device is not looked at: a miss is a miss.
bool broken(const Record& record, bool strict);

}  // namespace farcull
