// The record of a run: what was asked and planned, what each stage found, and how long it took.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/base/floating_point.h"
#include "experiments/method/candidates.h"
#include "experiments/method/options.h"
#include "verify/accounting.h"
#include "verify/contact.h"

namespace farcull {

struct RunTimes {
  double setup = 0;     // context, shaders; 0 where an earlier run of the process had made them
  double cull = 0;      // plan, fattening, passes, box join of what is kept
  double exact = 0;     // exact predicates on the candidates
  double total = 0;     // of all stages but the verification and the kinds of contact
  double contacts = 0;  // kinds of contact
  FARCULL_FIELDS(setup, cull, exact, total, contacts)
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

}  // namespace farcull
