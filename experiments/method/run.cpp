// Fills a record. Each stage is one function that fills a part. run() calls the stages in order.
#include "experiments/method/run.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "core/boxes/join.h"
#include "core/scene/pair_sort.h"

namespace farcull {
namespace {

// Decides candidates as soon as they are found. marks: true to record their triangles.
class StreamingDecider {
 public:
  StreamingDecider(const Scene& scene, const Plan& plan, const ExactQuestion& question, bool marks)
      : scene_(scene),
        is_ignored_(scene, plan.options.ignored),
        question_(question),
        all_threads_(question.threads),
        kept_(marks ? scene.triangles.size() : 0, 0) {
    question_.threads = 1;
  }

  void operator()(std::vector<TrianglePair>& some) {
    const Stopwatch watch;
    const std::uint64_t removed =
        is_ignored_.any() ? std::erase_if(some, std::cref(is_ignored_)) : 0;
    if (!kept_.empty()) {
      for (const TrianglePair& pair : some) {
        std::atomic_ref(kept_[pair.a]).store(1, std::memory_order_relaxed);
        std::atomic_ref(kept_[pair.b]).store(1, std::memory_order_relaxed);
      }
    }
    Collisions decided = decide(scene_, some, question_);
    const std::scoped_lock lock(mutex_);
    pairs_.add(std::exchange(decided.pairs, {}));
    neighbour_pairs_.add(std::exchange(decided.neighbour_pairs, {}));
    counts_.append(decided);
    ignored_ += removed;
    threads_.insert(std::this_thread::get_id());
    ms_ += watch.ms();
  }

  // Moves the answers to `found`. Subtracts the time of deciding from the time of finding.
  void finish(Candidates& found) {
    const Stopwatch watch;
    if (threads_.size() > 1) ms_ /= static_cast<double>(threads_.size());
    found.ignored = ignored_;
    found.count -= ignored_;
    counts_.pairs = std::move(pairs_).sorted(all_threads_);
    counts_.neighbour_pairs = std::move(neighbour_pairs_).sorted(all_threads_);
    found.decided = std::move(counts_);
    found.decided_ms = ms_ + watch.ms();
    found.ms -= ms_;
    found.trace.back().ms -= ms_;
    for (std::uint32_t t = 0; t < kept_.size(); ++t) {
      if (kept_[t] != 0) found.triangles.push_back(t);
    }
    found.triangle_count = found.triangles.size();
    found.object_count = count_objects(scene_, found.triangles);
  }

 private:
  const Scene& scene_;
  const IgnoredObjects is_ignored_;
  ExactQuestion question_;
  const unsigned all_threads_;
  std::vector<std::uint8_t> kept_;  // 1 for a triangle of a candidate; empty if `marks` is false
  std::mutex mutex_;                // guards all members below
  GatheredPairs pairs_, neighbour_pairs_;
  Collisions counts_;  // has no pairs until finish() adds them
  std::uint64_t ignored_ = 0;
  std::set<std::thread::id> threads_;
  double ms_ = 0;  // time of deciding, summed over the threads
};

// True if the plan searches a tree of boxes and the tree has more than kMostListed candidates. A
// run with a limit then calls search_first() instead of listing all candidates.
bool is_crowded(const Scene& scene, const Plan& planned, const ExactQuestion& question,
                unsigned threads) {
  constexpr std::uint64_t kMostListed = std::uint64_t{1} << 22;
  const std::uint64_t triangles = scene.triangles.size();
  const auto by_tree = [](const Stage& stage) {
    return stage.ran &&
           (stage.reason == Reason::join_uneven || stage.reason == Reason::join_many_blocks ||
            stage.reason == Reason::join_often || stage.reason == Reason::join_crowded);
  };
  if (triangles * (triangles - 1) / 2 <= kMostListed ||
      std::ranges::none_of(planned.stages(), by_tree))
    return false;
  OrderedPairs ordered(scene, planned.options.clearance, planned.options.ignored,
                       question.neighbours, threads);
  std::uint64_t listed = 0;
  std::vector<TrianglePair> some;
  while (listed <= kMostListed && !ordered.at_end()) {
    ordered.next(std::size_t{1} << 16, some);
    listed += some.size();
  }
  return listed > kMostListed;
}

// Tests candidates in the order of pairs until options.limit pairs collide. Gives up after about
// kMostSearched + 16 * limit candidates, since the scene may have too few colliding pairs.
void search_first(const Scene& scene, const Session& session, const Progress& progress,
                  const ExactQuestion& question, Record& record) {
  constexpr std::uint64_t kMostSearched = std::uint64_t{1} << 24;
  constexpr std::size_t kStep = std::size_t{1} << 14;
  const Stopwatch watch;
  const RunOptions& options = record.options;
  OrderedPairs ordered(scene, options.clearance, options.ignored, question.neighbours,
                       session.cpu_threads());
  std::uint64_t left = options.limit;
  bool whole = true;
  std::vector<TrianglePair> some;
  while (left > 0 && whole && !ordered.at_end() &&
         record.decided < kMostSearched + 16 * std::min(options.limit, kMostSearched)) {
    if (progress) progress("pairs in order");
    ordered.next(kStep, some);
    if (some.empty()) continue;
    FirstCollisions first = decide(scene, some, question, left);
    left -= first.collisions.pairs.size() + first.collisions.neighbour_pairs.size();
    record.decided += first.decided;
    whole = first.complete;
    record.collisions.append(first.collisions);
  }
  record.complete = whole && ordered.at_end();
  record.limited = true;
  record.found.count = record.decided;
  record.ms.cull += watch.ms();
  record.trace.push_back({.kind = StageKind::exact,
                          .ran = true,
                          .reason = Reason::limited,
                          .ms = watch.ms(),
                          .in = record.decided,
                          .out = options.limit - left,
                          .unit = Unit::pairs});
}

// Plans the run and finds candidates. Frees the memory of the plan before it returns.
void find_stage(const Scene& scene, Session& session, const Progress& progress,
                const ExactQuestion& question, const RunUse& use, Record& record) {
  const Stopwatch comparing;
  FrameMemory* const memory = use.decided ? nullptr : session.frame_memory();
  if (memory) memory->moved.update(scene, use.change);
  const double compared_ms = comparing.ms();
  const Plan planned =
      plan(scene, record.options, session.threads(), progress, memory, use.decided);
  record.options = planned.options;
  record.plan = planned.stages();
  // A filter needs the list of all candidates. A limit needs the list unless search_first() runs.
  const bool filters = static_cast<bool>(use.filter), limits = record.options.limit > 0;
  if (limits && !filters && !memory &&
      is_crowded(scene, planned, question, session.cpu_threads())) {
    record.trace = planned.trace;
    record.ms.cull = planned.ms;
    return search_first(scene, session, progress, question, record);
  }
  record.found = find(scene, planned, session, progress, filters || limits ? nullptr : &question,
                      !use.answer_only);
  record.trace = planned.trace;
  record.trace.insert(record.trace.end(), record.found.trace.begin(), record.found.trace.end());
  record.ms.setup = record.found.setup_ms;
  record.ms.cull = compared_ms + planned.ms + record.found.ms;
}

// Decides the candidates by exact tests, unless find() has decided them.
void decide_stage(const Scene& scene, Session& session, const Progress& progress,
                  const ExactQuestion& question, bool keeps_frames, Record& record) {
  if (record.limited) return;  // search_first() has decided the candidates
  const RunOptions& options = record.options;
  Stage stage{.kind = StageKind::exact,
              .depends = !options.full && culls(options.method),
              .reason = Reason::no_candidates,
              .unit = Unit::pairs};
  const auto ran = [&](double ms) {
    stage.ran = true;
    stage.reason = Reason::predicates;
    stage.ms = record.ms.exact = ms;
    stage.in = record.decided;
    stage.out = record.collisions.pairs.size() + record.collisions.neighbour_pairs.size();
  };
  if (record.found.decided) {
    record.collisions = *std::move(record.found.decided);
    record.found.decided.reset();
    record.decided = record.found.count;
    if (record.decided > 0 || !stage.depends) ran(record.found.decided_ms);
  } else if (!record.found.pairs.empty() || options.full) {
    if (progress) progress(StageKind::exact);
    const Stopwatch watch;
    const std::vector<TrianglePair>& pairs = record.found.pairs;
    FrameDecider* const frames =
        keeps_frames && options.limit == 0 ? session.frame_decider() : nullptr;
    FirstCollisions first =
        frames ? FirstCollisions{.collisions = frames->decide(
                                     scene, pairs, session.frame_memory()->moved, question),
                                 .decided = pairs.size()}
               : decide(scene, pairs, question, options.limit);
    record.collisions = std::move(first.collisions);
    record.decided = first.decided;
    record.complete = first.complete;
    ran(watch.ms());
  }
  record.trace.push_back(stage);
  if (FrameMemory* const memory = keeps_frames ? session.frame_memory() : nullptr)
    memory->moved.notify(mostly_unmoved(memory->moved, record.found.pairs));
}

// If options.verify is set, counts the colliding pairs that the method missed.
void verify_stage(const Scene& scene, const Progress& progress, Record& record) {
  Stage stage{.kind = StageKind::verify,
              .reason = record.limited ? Reason::limited : Reason::not_asked,
              .unit = Unit::pairs};
  if (record.options.verify && !record.limited) {
    if (progress) progress(StageKind::verify);
    const bool streamed = record.found.streamed;
    const std::vector<TrianglePair> colliding =
        streamed ? record.collisions.all() : std::vector<TrianglePair>();
    record.verification = account(scene, streamed ? colliding : record.found.pairs,
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

// Returns the guarantee of the method on the device that was used. If session.verdict() throws, the
// session forgets its device.
Promise promise_of(const RunOptions& options, const UsedDevice& device, Session& session) {
  Promise promise;
  promise.holds = guaranteed(options);
  promise.reason =
      promise.holds ? "nothing rests on a device" : "the method, or its radius, promises nothing";
  if (!promise.holds || !device.relies) return promise;
  try {
    promise.verdict = session.verdict();
  } catch (...) {
    session.forget_device();
    throw;
  }
  promise.holds = promise.verdict->holds;
  promise.reason = to_string(*promise.verdict);
  return promise;
}

std::vector<ContactShape> contacts_of(const Scene& scene, const std::vector<TrianglePair>& pairs,
                                      ContactDetail contacts, unsigned threads) {
  if (contacts == ContactDetail::segments) return contact_shapes(scene, pairs, threads);
  std::vector<ContactShape> out;
  for (const ContactKind kind : contact_kinds(scene, pairs, threads)) out.push_back({.kind = kind});
  return out;
}

void contact_stage(const Scene& scene, Session& session, const Progress& progress, Record& record) {
  const ContactDetail asked = record.options.contacts;
  if (asked == ContactDetail::none) return;
  if (progress) progress(StageKind::contacts);
  const Stopwatch watch;
  const unsigned threads = session.cpu_threads();
  record.contacts = contacts_of(scene, record.collisions.pairs, asked, threads);
  record.neighbour_contacts = contacts_of(scene, record.collisions.neighbour_pairs, asked, threads);
  record.ms.contacts = watch.ms();
}

}  // namespace

Candidates find(const Scene& scene, const Plan& plan, Session& session, const Progress& progress,
                const ExactQuestion* question, bool marks) {
  const FloatingPointGuard guard;
  try {
    std::optional<StreamingDecider> deciding;
    if (question) deciding.emplace(scene, plan, *question, marks);
    Candidates found = traits(plan.options.method)
                           .find(scene, plan, session, progress,
                                 question ? TakePairs(std::ref(*deciding)) : TakePairs());
    if (found.streamed && !found.decided) deciding->finish(found);
    const std::uint64_t removed = remove_ignored(scene, plan.options.ignored, found.pairs);
    found.ignored += removed;
    found.count -= removed;
    return found;
  } catch (...) {
    session.forget_device();
    throw;
  }
}

Record run(const Scene& scene, const RunOptions& options, Session& session,
           const Progress& progress, const RunUse& use) {
  const FloatingPointGuard guard;
  Record record;
  record.callers = callers_floating_point();
  record.options = options;
  const ExactQuestion question{.clearance = options.clearance,
                               .threads = session.cpu_threads(),
                               .neighbours = options.neighbours && use.decide_neighbours};
  find_stage(scene, session, progress, question, use, record);
  Candidates& found = record.found;
  if (!use.answer_only) {
    record.scene_hash = use.scene_hash.empty() ? scene_hash(scene) : use.scene_hash;
    record.degenerate_triangles = degenerate_triangles(scene);
    record.promise = promise_of(options, found.device, session);
  }
  if (use.filter) {
    if (found.streamed) throw std::logic_error("run: no filter, since the method culls nothing");
    verify_stage(scene, progress, record);
    use.filter(found.pairs);
    found.count = found.pairs.size();
  }
  // If the method returned only pairs, the triangles of the pairs are listed here.
  const bool only_pairs = use.filter || (!found.pairs.empty() && found.triangles.empty());
  if (only_pairs && !use.answer_only) {
    found.triangles = members_of(found.pairs, scene.triangles.size());
    found.triangle_count = found.triangles.size();
    found.object_count = count_objects(scene, found.triangles);
  }
  decide_stage(scene, session, progress, question, !use.decided, record);
  record.ms.total = record.ms.setup + record.ms.cull + record.ms.exact;
  if (!use.filter && !use.answer_only) verify_stage(scene, progress, record);
  // A method that culls nothing decides all pairs, so the limit is applied here. For other methods
  // decide_stage() has applied the limit.
  if (options.limit > 0 && keep_first(options.limit, record.collisions)) record.complete = false;
  contact_stage(scene, session, progress, record);
  require_proved("arithmetic");  // a driver may have changed the rounding mode of this thread
  record.used = floating_point();
  return record;
}

std::optional<PairsAtRisk> pairs_at_risk(const Scene& scene, const Record& record, Session& session,
                                         const Progress& progress) {
  if (!fattens(record.options.method) || !guaranteed(record.options) || !record.found.drew() ||
      !record.verification || !record.complete)
    return std::nullopt;
  const auto pairs = [](const Record& of) {
    return of.collisions.pairs.size() + of.collisions.neighbour_pairs.size();
  };
  const auto lost_at = [&](double factor) {
    RunOptions smaller = record.options;
    smaller.radius = {.published = false, .factor = factor};
    smaller.verify = false;
    smaller.contacts = ContactDetail::none;
    const Record found = run(scene, smaller, session, progress, {.answer_only = true});
    return pairs(record) + record.verification->false_negatives - pairs(found);
  };
  return PairsAtRisk{.at_risk = lost_at(0.9), .at_risk_bare = lost_at(0)};
}

FirstCollisions decide(const Scene& scene, const std::vector<TrianglePair>& candidates,
                       const ExactQuestion& question, std::uint64_t limit) {
  if (limit > 0) return decide_first(scene, candidates, limit, question);
  return {.collisions = decide(scene, candidates, question), .decided = candidates.size()};
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

std::vector<TrianglePair> pairs_left(const Record& record) {
  const bool listed = !record.found.streamed && culls(record.options.method);
  return listed ? record.found.pairs : record.collisions.all();
}

bool broken(const Record& record, bool strict) {
  return (strict || guaranteed(record.options)) && record.verification &&
         record.verification->false_negatives > 0;
}

void require_asked(std::uint64_t objects, bool self, std::uint64_t ignored,
                   const std::string& where, const std::string& otherwise) {
  const std::uint64_t pairs = objects * (objects - 1) / 2;
  if (objects < 2 || self || ignored < pairs) return;
  throw Error(where, "nothing to test: every pair of objects is ignored",
              otherwise.empty() ? "ignore fewer pairs" : "ignore fewer pairs, or " + otherwise);
}

void require_asked(const Scene& scene, std::vector<ObjectPair> ignored, const std::string& where,
                   const std::string& otherwise) {
  ignored.insert(ignored.end(), scene.ignored.begin(), scene.ignored.end());
  require_asked(scene.objects.size(), has_self(scene), in_order(std::move(ignored)).size(), where,
                otherwise);
}

}  // namespace farcull
