// The pipeline: plan(), find(), decide(), and all of it as run(), from a scene to a record.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/floating_point.h"
#include "experiments/method/candidates.h"
#include "experiments/method/plan.h"
#include "experiments/method/session.h"
#include "verify/accounting.h"
#include "verify/contact.h"
#include "verify/contact_kind.h"

namespace farcull {

struct RunTimes {
  double setup = 0;     // context, shaders; 0 where an earlier run of the process had made them
  double cull = 0;      // plan, fattening, passes, box join of what is kept
  double exact = 0;     // exact predicates on the candidates
  double total = 0;     // of all stages but the verification and the kinds of contact
  double contacts = 0;  // kinds of contact
};

/// Whether a miss would break a guarantee.
struct Promise {
  bool holds = false;  // the method promises (see promises()), and the device that it used keeps
                       // what the promise rests on
  std::string reason;  // why, or why not
  std::optional<DeviceVerdict> verdict;  // of that device; empty where the promise rests on none
};

struct Record {
  RunOptions options;
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<Stage> plan;   // as it was before anything ran
  std::vector<Stage> trace;  // as it went
  Promise promise;
  Candidates found;
  Collisions collisions;
  std::uint64_t decided = 0;  // candidates that exact predicates decided
  bool complete = true;       // false: the limit was reached, so candidates were left undecided, or
                              // colliding ones behind the last were left out
  std::vector<ContactShape> contacts;            // of collisions.pairs, where they are asked for;
  std::vector<ContactShape> neighbour_contacts;  // of collisions.neighbour_pairs. Without segments
                                                 // the kinds alone are set
  std::optional<Accounting> verification;        // with kExamples examples
  std::optional<ContactCounts> missed;  // by the kind of contact; with a verification, without a
                                        // clearance
  RunTimes ms;
  FloatingPoint callers, used;  // floating-point environment of our caller, and of this run
};

constexpr std::size_t kExamples = 10;  // missed pairs that a record names

/// The method: candidates of the scene that was planned, without those of ignored objects. Throws
/// Error for any fault of the device;
/// after any exception the session has forgotten its device, and can be used again.
Candidates find(const Scene& scene, const Plan& plan, Session& session,
                const Progress& progress = {});

/// Decides the candidates by exact predicates, where the method has not done so.
Collisions decide(const Scene& scene, const Candidates& candidates, const ExactQuestion& question);

/// What the options ask of how pairs meet, one for each.
std::vector<ContactShape> contacts_of(const Scene& scene, const std::vector<TrianglePair>& pairs,
                                      ContactDetail contacts, unsigned threads);

/// How many of the colliding pairs, neighbours among them, meet in each way; all kinds in their
/// order.
std::vector<std::pair<ContactKind, std::uint64_t>> count_kinds(const Record& record);

/// The promise of the method on the device that it used, whose verdict is the session's.
Promise promise_of(const RunOptions& options, const UsedDevice& device, Session& session);

/// Plans, finds, decides and, where the options ask for it, accounts for every pair. Throws Error
/// as plan() and find() do.
Record run(const Scene& scene, const RunOptions& options, Session& session,
           const Progress& progress = {});

/// The pairs that were left to the exact tests, sorted; for a method that culls nothing the
/// colliding ones, neighbours among them, so that every other pair has to be accounted for.
std::vector<TrianglePair> pairs_left(const Record& record);

/// Whether the record breaks a guarantee: `strict` asks it of every method (`farcull verify`). The
/// verdict about the device is not looked at: a miss is a miss.
bool broken(const Record& record, bool strict);

}  // namespace farcull
