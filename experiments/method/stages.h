// The stages of run() behind find(). run_tile() puts one more between them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "experiments/method/record.h"
#include "experiments/method/session.h"

namespace farcull {

/// Decides the candidates by exact predicates, where the method has not done so.
Collisions decide(const Scene& scene, const Candidates& candidates, const ExactQuestion& question);

/// What the options ask of how pairs meet, one for each.
std::vector<ContactShape> contacts_of(const Scene& scene, const std::vector<TrianglePair>& pairs,
                                      ContactDetail contacts, unsigned threads);

/// How many of the colliding pairs, neighbours among them, meet in each way; all kinds in their
/// order.
std::vector<std::pair<ContactKind, std::uint64_t>> count_kinds(const Record& record);

/// Sets the triangles and objects that are left from the candidate pairs.
void count_kept(const Scene& scene, Candidates& found);

/// Decides the candidates by exact predicates, with the clearance and the limit of record.options.
/// Sets collisions, decided, complete and ms.exact. Adds a stage to the trace, unless the method
/// has decided already.
void decide_stage(const Scene& scene, Session& session, const Progress& progress, Record& record);

/// If record.options ask for it: accounts for every pair that is not in `left`. Sets verification
/// and missed. Adds a stage to the trace in any case.
void verify_stage(const Scene& scene, const std::vector<TrianglePair>& left,
                  const Progress& progress, Record& record);

/// If record.options ask for it: the kinds of contact of the colliding pairs, on as many threads as
/// the session has. Sets contacts, neighbour_contacts and ms.contacts.
void contact_stage(const Scene& scene, Session& session, const Progress& progress, Record& record);

}  // namespace farcull
