// The pipeline: plan(), find(), the stages behind them, and all of it as run(), from a scene to a
// record.
#pragma once

#include <vector>

#include "experiments/method/plan.h"
#include "experiments/method/record.h"
#include "experiments/method/session.h"
#include "experiments/method/stages.h"

namespace farcull {

/// The method: candidates of the scene that was planned, without those of ignored objects. Throws
/// Error for any fault of the device;
/// after any exception the session has forgotten its device, and can be used again.
Candidates find(const Scene& scene, const Plan& plan, Session& session,
                const Progress& progress = {});

/// The promise of the method on the device that it used, whose verdict is the session's. After an
/// exception the session has forgotten its device, as after find().
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
