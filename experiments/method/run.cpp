// The one pipeline. Command line, library, benchmark, studies and pictures call it.
#include "experiments/method/run.h"

#include <algorithm>
#include <limits>
#include <thread>

#include "core/base/stopwatch.h"
#include "core/scene/ignored.h"
#include "core/scene/members.h"
#include "experiments/method/stages.h"

namespace farcull {
void count_kept(const Scene& scene, Candidates& found) {
  found.triangles = members_of(found.pairs, scene.triangles.size());
  found.triangle_count = found.triangles.size();
  found.object_count = count_objects(scene, found.triangles);
}

void decide_stage(const Scene& scene, Session& session, const Progress& progress, Record& record) {
  Stage stage{.kind = StageKind::exact,
              .depends = !record.options.full,
              .reason = Reason::no_candidates,
              .unit = Unit::pairs};
  if (record.found.decided) {
    record.collisions = *std::move(record.found.decided);
    record.found.decided.reset();
    record.ms.exact = record.found.decided_ms;
    record.decided = record.found.count;
    return;
  }
  if (!record.found.pairs.empty() || record.options.full) {
    if (progress) progress("exact tests");
    const Stopwatch watch;
    const ExactQuestion question{.clearance = record.options.clearance,
                                 .neighbours = record.options.neighbours};
    FrameDecider* frames = session.frame_decider();
    if (record.options.limit > 0) {
      FirstCollisions first =
          decide_first(scene, record.found.pairs, record.options.limit, question);
      record.collisions = std::move(first.collisions);
      record.decided = first.decided;
      record.complete = first.complete;
    } else {
      record.collisions = frames ? frames->decide(scene, record.found.pairs, question)
                                 : decide(scene, record.found, question);
      record.decided = record.found.pairs.size();
    }
    stage.ran = true;
    stage.reason = Reason::predicates;
    stage.ms = record.ms.exact = watch.ms();
    stage.in = record.decided;
    stage.out = record.collisions.pairs.size() + record.collisions.neighbour_pairs.size();
  }
  record.trace.push_back(stage);
}

void verify_stage(const Scene& scene, const std::vector<TrianglePair>& left,
                  const Progress& progress, Record& record) {
  Stage stage{.kind = StageKind::verify, .reason = Reason::not_asked, .unit = Unit::pairs};
  if (record.options.verify) {
    if (progress) progress("accounting for every pair");
    record.verification = account(scene, left,
                                  {.clearance = record.options.clearance,
                                   .max_examples = std::numeric_limits<std::size_t>::max(),
                                   .ignored = record.options.ignored});
    Accounting& accounting = *record.verification;
    if (record.options.clearance == 0) record.missed = count_contacts(scene, accounting.examples);
    accounting.examples.resize(std::min(accounting.examples.size(), kExamples));
    stage.ran = true;
    stage.reason = Reason::every_pair;
    stage.ms = accounting.ms;
    stage.in = accounting.pairs_total;
    stage.out = accounting.false_negatives;
  }
  record.trace.push_back(stage);
}

void contact_stage(const Scene& scene, Session& session, const Progress& progress, Record& record) {
  if (record.options.contacts == ContactDetail::none) return;
  if (progress) progress("kinds of contact");
  const Stopwatch watch;
  const unsigned threads =
      session.threads() > 0 ? session.threads() : std::thread::hardware_concurrency();
  const ContactDetail asked = record.options.contacts;
  record.contacts = contacts_of(scene, record.collisions.pairs, asked, threads);
  record.neighbour_contacts = contacts_of(scene, record.collisions.neighbour_pairs, asked, threads);
  record.ms.contacts = watch.ms();
}

Candidates find(const Scene& scene, const Plan& plan, Session& session, const Progress& progress) {
  const FloatingPointGuard guard;
  try {
    Candidates found = traits(plan.options.method).find(scene, plan, session, progress);
    const std::uint64_t removed = remove_ignored(scene, plan.options.ignored, found.pairs);
    found.ignored += removed;
    found.count -= removed;
    return found;
  } catch (...) {
    session.forget_device();
    throw;
  }
}

Promise promise_of(const RunOptions& options, const UsedDevice& device, Session& session) {
  Promise promise;
  promise.holds = promises(options);
  promise.reason =
      promise.holds ? "nothing rests on a device" : "the method, or its radius, promises nothing";
  if (!promise.holds || !device.relies) return promise;
  promise.verdict = session.verdict(*device.relies);
  promise.holds = promise.verdict->holds;
  promise.reason = to_string(*promise.verdict, *device.relies);
  return promise;
}

Collisions decide(const Scene& scene, const Candidates& candidates, const ExactQuestion& question) {
  return candidates.decided ? *candidates.decided : decide(scene, candidates.pairs, question);
}

std::vector<ContactShape> contacts_of(const Scene& scene, const std::vector<TrianglePair>& pairs,
                                      ContactDetail contacts, unsigned threads) {
  if (contacts == ContactDetail::segments) return contact_shapes(scene, pairs, threads);
  std::vector<ContactShape> out;
  if (contacts == ContactDetail::none) return out;
  for (const ContactKind kind : contact_kinds(scene, pairs, threads)) out.push_back({.kind = kind});
  return out;
}

std::vector<std::pair<ContactKind, std::uint64_t>> count_kinds(const Record& record) {
  std::vector<std::pair<ContactKind, std::uint64_t>> out;
  for (const ContactKind kind : kContactKinds) {
    const auto is = [&](const ContactShape& shape) { return shape.kind == kind; };
    out.emplace_back(kind, std::ranges::count_if(record.contacts, is) +
                               std::ranges::count_if(record.neighbour_contacts, is));
  }
  return out;
}

Record run(const Scene& scene, const RunOptions& options, Session& session,
           const Progress& progress) {
  const FloatingPointGuard guard;
  Record record;
  record.callers = callers_floating_point();
  record.options = options;
  const Plan planned = plan(scene, options, session.threads(), progress, session.pair_memory());
  record.options.ignored = planned.options.ignored;
  record.plan = planned.stages();
  record.trace = planned.trace;
  record.scene_hash = scene_hash(scene);
  record.degenerate_triangles = degenerate_triangles(scene);

  record.found = find(scene, planned, session, progress);
  // Where the method gives pairs alone.
  if (!record.found.pairs.empty() && record.found.triangles.empty())
    count_kept(scene, record.found);
  record.trace.insert(record.trace.end(), record.found.trace.begin(), record.found.trace.end());
  try {
    record.promise = promise_of(options, record.found.device, session);
  } catch (...) {
    session.forget_device();
    throw;
  }
  record.ms.setup = record.found.setup_ms;
  record.ms.cull = planned.ms + record.found.ms;
  decide_stage(scene, session, progress, record);
  record.ms.total = record.ms.setup + record.ms.cull + record.ms.exact;
  std::vector<TrianglePair> decided;  // of a method that decides as it finds
  if (options.verify && !culls(options.method)) decided = pairs_left(record);
  verify_stage(scene, culls(options.method) ? record.found.pairs : decided, progress, record);
  // Of a method that decides as it finds: decide_first() has kept to the limit already.
  if (options.limit > 0 && keep_first(options.limit, record.collisions)) record.complete = false;
  contact_stage(scene, session, progress, record);
  require_proved("arithmetic");  // a driver's code ran in this thread too
  record.used = floating_point();
  return record;
}

std::vector<TrianglePair> pairs_left(const Record& record) {
  if (culls(record.options.method)) return record.found.pairs;
  return record.collisions.all();
}

bool broken(const Record& record, bool strict) {
  return (strict || promises(record.options)) && record.verification &&
         record.verification->false_negatives > 0;
}

}  // namespace farcull
