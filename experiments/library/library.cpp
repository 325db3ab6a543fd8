// Implements Collider by run(), and DistanceFinder by distances(). Both copy the input to a Scene.
#include <algorithm>
#include <cmath>

#include "core/base/stopwatch.h"
#include "experiments/library/distance.h"
#include "experiments/library/input.h"
#include "experiments/method/distances.h"
#include "experiments/method/run.h"
#include "experiments/record/stage_words.h"

namespace farcull {
namespace {

RunOptions run_options(const Options& options) {
  require_threads(options.threads);
  if (!(options.clearance >= 0) || !std::isfinite(options.clearance))
    throw Error("clearance", "is no distance", "give a finite number, 0 or more");
  return {.method = Method::boxes,
          .clearance = options.clearance,
          .verify = false,
          .limit = options.limit,
          .contacts = static_cast<ContactDetail>(options.contacts)};
}

std::vector<Pair> to_public(const std::vector<TrianglePair>& pairs) {
  std::vector<Pair> out(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) out[k] = {pairs[k].a, pairs[k].b};
  return out;
}

}  // namespace

const char* version() { return FARCULL_VERSION; }

Cancelled::Cancelled() : Error("may_go_on", "ended the call", "call again for an answer") {}

struct Collider::State {
  Options options;
  RunOptions run;
  Session session;
  TakenInput taken;  // the input of the last call
  FrameChange change;
  std::optional<BlockDecision> decided;  // result of load_poses()
  std::uint64_t calls = 0;
  std::atomic_flag used;

  explicit State(const Options& given)
      : options(given), run(run_options(given)), session("native", given.threads, Say()) {}

  // Loads the scene of a call. From the third call on, also finds the changes since the last call.
  void take_scene(const Input& input);
  // Finds the collisions. start: measures time from the start of the call. callers: the caller's
  // floating-point environment.
  Result find(const Stopwatch& start, const FloatingPoint& callers, const Progress& progress);
};

void Collider::State::take_scene(const Input& input) {
  // Remembered frames take memory, so the first call remembers none.
  if (++calls == 2) session.remember_frames();
  const FrameMemory* const memory = session.frame_memory();
  change = {};
  decided.reset();
  if (!taken.poses.empty() && !input.poses.empty()) {
    const std::vector<ObjectPair> ignored = ignored_of(options.ignore, taken.scene.objects.size());
    const bool keeps = memory && memory->frame && !memory->moved.waits();
    decided = load_poses(input,
                         {.clearance = options.clearance,
                          .ignored = ignored,
                          .threads = session.threads(),
                          .keeps_frames = keeps},
                         taken);
    if (decided) return;
  }
  // If the last call did not move all vertices (`stale`), the changes cannot be found.
  const bool compares = memory && !memory->moved.waits() && !taken.stale;
  load_input(input, options.self, options.self_objects, taken, compares ? &change : nullptr);
}

Result Collider::State::find(const Stopwatch& start, const FloatingPoint& callers,
                             const Progress& progress) {
  run.ignored = ignored_of(options.ignore, taken.scene.objects.size());
  require_asked(taken.scene, run.ignored, "ignore", "test objects against themselves (self)");
  const Record record = farcull::run(taken.scene, run, session, progress,
                                     {.answer_only = true,
                                      .change = &change,
                                      .decided = decided ? &*decided : nullptr,
                                      .decide_neighbours = options.neighbours});
  Result out;
  Report& report = out.report;
  report.candidates_ms = start.ms() - record.ms.exact - record.ms.contacts;
  report.candidates = record.found.count;
  report.decided = record.decided;
  report.neighbours = record.collisions.neighbours;
  report.passed_over = taken.passed_over;
  report.exact_ms = record.ms.exact;
  report.contacts_ms = record.ms.contacts;
  out.pairs = to_public(record.collisions.pairs);
  out.neighbour_pairs = to_public(record.collisions.neighbour_pairs);
  out.contacts = to_public(record.contacts);
  out.neighbour_contacts = to_public(record.neighbour_contacts);
  out.complete = record.complete;
  if (callers != kProved) report.callers_arithmetic = to_string(callers);
  for (const Stage& s : record.trace)
    report.stages.push_back(
        {name_of(s), s.ran, reason_of(s), s.ms, s.in, s.out, to_string(s.unit)});
  return out;
}

Collider::Collider(const Options& options)
    : state_(as_proved([&] { return std::make_unique<State>(options); })) {}
Collider::Collider() : Collider(Options{}) {}
Collider::~Collider() = default;
Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;

Result Collider::find(const Input& input) {
  return exclusive(state_, "Collider", [&](State& state) {
    const Stopwatch start;
    const FloatingPoint callers = callers_floating_point();
    state.take_scene(input);
    try {
      return watched(state.options.may_go_on, [&](const Progress& progress) {
        return state.find(start, callers, progress);
      });
    } catch (...) {
      state.session.forget_device();
      throw;
    }
  });
}

Result collide(const Input& input, const Options& options) { return Collider(options).find(input); }

namespace {

// The enumerations of distance.h have the same values as the internal enumerations.
static_assert(same(DistanceKind::objects, DistancePairs::objects) &&
              same(DistanceKind::nearest, DistancePairs::nearest) &&
              same(DistanceKind::all, DistancePairs::all));
static_assert(same(DistanceInside::unknown, WhichInside::unknown) &&
              same(DistanceInside::none, WhichInside::none) &&
              same(DistanceInside::a, WhichInside::a) && same(DistanceInside::b, WhichInside::b) &&
              same(DistanceInside::not_closed, WhichInside::not_closed));

DistancePairs pairs_of(DistanceKind kind) {
  if (kind < DistanceKind::objects || kind > DistanceKind::all)
    throw Error("kind", "is none", "give objects, nearest or all");
  return static_cast<DistancePairs>(kind);
}

DistanceOptions checked(const DistanceFinderOptions& options) {
  DistanceOptions out{.pairs = pairs_of(options.kind),
                      .k = options.k,
                      .inside = options.inside,
                      .threads = options.threads};
  require_threads(options.threads);
  if (options.within && !(*options.within >= 0))
    throw Error("within", "is no distance", "give a number, 0 or more, or nothing for no limit");
  out.within = options.within.value_or(out.within);
  if (out.pairs == DistancePairs::all && !std::isfinite(out.within))
    throw Error("within", "is not finite, which pairs of all triangles need",
                "give a finite distance, 0 or more");
  const bool nearest = out.pairs == DistancePairs::nearest;
  if (nearest && options.k == 0) throw Error("k", "is 0", "give 1 or more");
  if (nearest && !options.ignore.empty())
    throw Error("ignore", "has no meaning with nearest", "leave it out, or give another kind");
  if (nearest && (options.self || std::ranges::count(options.self_objects, true) > 0))
    throw Error("self", "has no meaning with nearest", "leave it out, or give another kind");
  if (!nearest && options.k != 1)
    throw Error("k", "has no meaning without nearest", "leave it out, or give nearest");
  return out;
}

DistanceAnswer to_public(const ObjectPair& objects, const TrianglePair& triangles,
                         const NearContact& contact) {
  const auto three = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  return {.object_a = objects.a,
          .object_b = objects.b,
          .triangle_a = triangles.a,
          .triangle_b = triangles.b,
          .distance = contact.distance,
          .squared = {},
          .point_a = three(contact.points[0]),
          .point_b = three(contact.points[1]),
          .weights_a = three(contact.weights[0]),
          .weights_b = three(contact.weights[1]),
          .normal = three(contact.normal),
          .feature_a = to_string(contact.features[0]),
          .feature_b = to_string(contact.features[1])};
}

DistanceAnswer to_public(const Scene& scene, const Distance& d, bool exact) {
  const auto a = scene.corners(d.triangles.a), b = scene.corners(d.triangles.b);
  DistanceAnswer out = to_public(d.objects, d.triangles, exact_contact(a, b, d.closest));
  if (exact) out.squared = d.closest.squared.text();
  out.inside = static_cast<DistanceInside>(d.inside);
  return out;
}

}  // namespace

struct DistanceFinder::State {
  DistanceFinderOptions given;
  DistanceOptions options;
  TakenInput taken;  // the input of the last call
  DistanceMemory memory;
  std::atomic_flag used;

  explicit State(const DistanceFinderOptions& from) : given(from), options(checked(from)) {}
};

DistanceFinder::DistanceFinder(const DistanceFinderOptions& options)
    : state_(as_proved([&] { return std::make_unique<State>(options); })) {}
DistanceFinder::DistanceFinder() : DistanceFinder(DistanceFinderOptions{}) {}
DistanceFinder::~DistanceFinder() = default;
DistanceFinder::DistanceFinder(DistanceFinder&&) noexcept = default;
DistanceFinder& DistanceFinder::operator=(DistanceFinder&&) noexcept = default;

std::vector<DistanceAnswer> DistanceFinder::find(const Input& input) {
  return exclusive(state_, "DistanceFinder", [&](State& state) {
    load_input(input, state.given.self, state.given.self_objects, state.taken);
    Scene& scene = state.taken.scene;
    scene.ignored = ignored_of(state.given.ignore, scene.objects.size());
    require_asked(scene, {}, "ignore", "give `self`");
    return watched(state.given.may_go_on, [&](const Progress& progress) {
      std::vector<DistanceAnswer> out;
      const DistanceOptions& options = state.options;
      if (options.pairs == DistancePairs::all && !state.given.exact) {
        const auto parts =
            contacts_within(scene, options.within, options.threads, options.most_pairs, progress);
        for (const auto& part : parts) {
          for (const TriangleContact& c : part)
            out.push_back(to_public(c.objects, c.triangles, c.contact));
        }
        return out;
      }
      const DistanceRecord record = distances(scene, options, progress, &state.memory);
      for (const Distance& d : record.distances)
        out.push_back(to_public(scene, d, state.given.exact));
      return out;
    });
  });
}

std::vector<DistanceAnswer> distances(const Input& input, const DistanceFinderOptions& options) {
  return DistanceFinder(options).find(input);
}

}  // namespace farcull
