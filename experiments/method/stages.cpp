// As stages.h says.
#include "experiments/method/stages.h"

#include <algorithm>
#include <limits>
#include <thread>

#include "core/base/stopwatch.h"
#include "core/scene/scene.h"

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

}  // namespace farcull
