// The collider, the stream and distances. Each copies its input into a scene and asks about the
// scene (experiments/method/run.h, experiments/method/distances.h).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/boxes/join.h"
#include "core/gl/base/context.h"
#include "core/view/view.h"
#include "experiments/library/farcull.h"
#include "experiments/library/input.h"
#include "experiments/method/distances.h"
#include "experiments/method/run.h"

namespace farcull {
namespace {

std::string device_of(const ColliderOptions& options) {
  if (options.device == ColliderDevice::cpu) return "cpu";
  return options.device == ColliderDevice::gl ? "gl" : "";
}

RunOptions run_options(const ColliderOptions& options) {
  check(options);
  RunOptions out{.method = Method::far_pairs,
                 .resolution = options.resolution,
                 .views = options.views == "auto" ? "" : options.views,
                 .clearance = options.clearance,
                 .verify = false,
                 .limit = options.limit,
                 .contacts = detail_of(options.contacts)};
  out.device = device_of(options);
  try {
    if (options.views != "auto") parse_views(options.views);
  } catch (const Error& error) {
    throw Error("views", error.reason, error.remedy);
  }
  return out;
}

std::vector<ColliderPair> given_out(const std::vector<TrianglePair>& pairs) {
  std::vector<ColliderPair> out(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) out[k] = {pairs[k].a, pairs[k].b};
  return out;
}

}  // namespace

ColliderError::ColliderError(const std::string& what, std::string where, std::string reason,
                             std::string remedy)
    : std::runtime_error(what),
      where(std::move(where)),
      reason(std::move(reason)),
      remedy(std::move(remedy)) {}

struct Collider::State {
  ColliderOptions options;
  RunOptions run;
  Session session;
  Scene scene;  // of the last call
  FrameChange change;
  std::uint64_t calls = 0, passed_over = 0;
  std::atomic_flag used;

  explicit State(const ColliderOptions& given)
      : options(given), run(run_options(given)), session(device_of(given), given.threads, Say()) {
    device();
    promise();
  }

  // Opens the device if it is not open: at first, and after a failure.
  PairDevice& device() { return session.pairs(); }

  // The promise on the device that is open now, not on an earlier one.
  Promise promise() {
    const std::optional<Reliance> relies =
        device().gl ? std::optional(Reliance::pairs) : std::nullopt;
    return promise_of(run, {.gl = device().gl, .cpu = !device().gl, .note = "", .relies = relies},
                      session);
  }
  // Reports the device of an answer; `used` may have none.
  void report_device(const UsedDevice& used, ColliderReport& report);

  // Takes the scene of a call; from the third call on, what is new in it as well.
  void take_scene(const ColliderInput& input);
  /// The collisions of the scene; `start`: when the call began. After an exception nothing on the
  /// device can be trusted.
  ColliderResult find(const Stopwatch& start);
};

void Collider::State::report_device(const UsedDevice& used, ColliderReport& report) {
  const PairDevice& open = device();
  if (open.gl && !used.gl) {
    report.device = "cpu";
    report.device_reason = used.note;
  } else {
    report.device = open.backend->name();
    report.device_reason = options.device == ColliderDevice::best ? open.reason : "asked for";
  }
  const Promise kept = promise_of(run, used, session);
  report.promises = kept.holds;
  report.promises_reason = "on the CPU nothing rests on a device";
  if (!used.gl) return;
  const std::string risk = risk_of_threads(used.gl->renderer);
  report.promises_reason = kept.reason + (risk.empty() ? "" : "; " + risk);
}

void Collider::State::take_scene(const ColliderInput& input) {
  // Remembering takes more memory, which is of no use to a single call.
  if (++calls == 2) session.remember_frames();
  const PairMemory* const memory = session.pair_memory();
  const bool compares = memory && !memory->moved.waits();
  change = {};
  take(input, options.self, options.self_objects, scene, compares ? &change : nullptr, true,
       &passed_over);
}

ColliderResult Collider::State::find(const Stopwatch& start) {
  device();
  run.ignored = ignored_of(options, scene.objects.size());
  const Record record = farcull::run(
      scene, run, session, {},
      {.answer_only = true, .change = &change, .decide_neighbours = options.neighbours});
  ColliderResult out;
  ColliderReport& report = out.report;
  report.candidates_ms = start.ms() - record.ms.exact - record.ms.contacts;
  report.candidates = record.found.count;
  report.decided = record.decided;
  report.neighbours = record.collisions.neighbours;
  report.passed_over = passed_over;
  report.exact_ms = record.ms.exact;
  report.contacts_ms = record.ms.contacts;
  out.pairs = given_out(record.collisions.pairs);
  out.neighbour_pairs = given_out(record.collisions.neighbour_pairs);
  out.contacts = given_out(record.contacts);
  out.neighbour_contacts = given_out(record.neighbour_contacts);
  out.complete = record.complete;
  if (record.callers != kProved) report.callers_arithmetic = to_string(record.callers);
  report_device(record.found.device, report);
  for (const Stage& s : record.trace)
    report.stages.push_back(
        {name_of(s), s.ran, reason_of(s), s.ms, s.in, s.out, to_string(s.unit)});
  for (const PairView& v : record.found.pair_views())
    report.views.push_back({v.name, v.looked, v.reason, v.width, v.height});
  return out;
}

Collider::Collider(const ColliderOptions& options)
    : state_(translated([&] { return std::make_unique<State>(options); })) {}
Collider::Collider() : Collider(ColliderOptions{}) {}
Collider::~Collider() = default;
Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;

ColliderResult Collider::find(const ColliderInput& input) {
  return exclusive(state_, "Collider", [&](State& state) {
    const Stopwatch start;
    state.take_scene(input);
    try {
      return state.find(start);
    } catch (...) {
      state.session.forget_device();
      throw;
    }
  });
}

// The stream: makes candidates in order, a part at a time, and decides each part exactly.

namespace {

constexpr const char* kName = "ColliderStream";
constexpr std::size_t kPart = std::size_t{1} << 16;  // candidates at a time

}  // namespace

struct ColliderStream::State {
  ColliderOptions options;
  unsigned threads;
  Scene scene;
  std::optional<OrderedPairs> candidates;
  std::vector<TrianglePair> part;
  std::uint64_t decided = 0, given = 0;
  bool complete = false;
  bool failed = false;  // a call began and did not end, so its pairs are lost
  std::atomic_flag used;

  State(const ColliderInput& input, const ColliderOptions& of)
      : options(of), threads(of.threads > 0 ? of.threads : std::thread::hardware_concurrency()) {
    check(options);
    if (options.device == ColliderDevice::gl)
      throw Error("device", "gl is not used by a stream", "give cpu or best");
    take(input, options.self, options.self_objects, scene);
    candidates.emplace(scene, options.clearance, ignored_of(options, scene.objects.size()), true,
                       threads);
  }

  bool next(std::vector<ColliderFound>& pairs);
  void decide_part(std::vector<ColliderFound>& pairs);
};

bool ColliderStream::State::next(std::vector<ColliderFound>& pairs) {
  pairs.clear();
  if (!failed && options.limit > 0 && given == options.limit) return false;
  if (!failed && candidates->at_end()) {
    complete = true;
    return false;
  }
  if (std::exchange(failed, true))
    throw Error("stream", "an earlier call failed, and its pairs are lost", "make a new stream");
  decide_part(pairs);
  failed = false;
  return true;
}

void ColliderStream::State::decide_part(std::vector<ColliderFound>& pairs) {
  candidates->next(kPart, part);
  const ExactQuestion question{
      .clearance = options.clearance, .threads = threads, .neighbours = options.neighbours};
  const std::uint64_t limit = part.empty() || options.limit == 0 ? 0 : options.limit - given;
  const auto [found, count, whole] = decide(scene, part, question, limit);
  decided += count;
  if (limit > 0) complete = whole && candidates->at_end();
  const auto append = [&](const std::vector<TrianglePair>& those, bool neighbours) {
    const std::vector<ContactShape> contacts =
        contacts_of(scene, those, detail_of(options.contacts), threads);
    for (std::size_t k = 0; k < those.size(); ++k) {
      pairs.push_back({.pair = {those[k].a, those[k].b},
                       .neighbours = neighbours,
                       .contact = contacts.empty() ? ColliderContact() : given_out(contacts[k])});
    }
  };
  append(found.pairs, false);
  append(found.neighbour_pairs, true);
  std::ranges::sort(pairs, {}, &ColliderFound::pair);
  given += pairs.size();
}

ColliderStream::ColliderStream(const ColliderInput& input, const ColliderOptions& options)
    : state_(translated([&] { return std::make_unique<State>(input, options); })) {}
ColliderStream::~ColliderStream() = default;
ColliderStream::ColliderStream(ColliderStream&&) noexcept = default;
ColliderStream& ColliderStream::operator=(ColliderStream&&) noexcept = default;

bool ColliderStream::next(std::vector<ColliderFound>& pairs) {
  return exclusive(state_, kName, [&](State& state) { return state.next(pairs); });
}

std::uint64_t ColliderStream::decided() const {
  return exclusive(state_, kName, [](const State& state) { return state.decided; });
}

bool ColliderStream::complete() const {
  return exclusive(state_, kName, [](const State& state) { return state.complete; });
}

namespace {

// The enumerations of farcull.h have the order of the internal ones.
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
  if (options.threads > kMostThreads)
    throw Error("threads", "are more than 1024", "give a number up to 1024, or 0");
  if (std::isnan(options.within))
    throw Error("within", "is no number", "give a distance, or a negative number for no limit");
  if (options.within >= 0) out.within = options.within;
  if (out.pairs == DistancePairs::all && !std::isfinite(out.within))
    throw Error("within", "is not finite, which pairs of all triangles need",
                "give a finite distance, 0 or more");
  if (out.pairs == DistancePairs::nearest && options.k == 0)
    throw Error("k", "is 0", "give 1 or more");
  return out;
}

DistanceAnswer given_out(const Distance& d) {
  const auto point = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  return {.object_a = d.objects.a,
          .object_b = d.objects.b,
          .triangle_a = d.triangles.a,
          .triangle_b = d.triangles.b,
          .distance = d.closest.distance,
          .squared = d.closest.squared.text(),
          .point_a = point(d.closest.points[0]),
          .point_b = point(d.closest.points[1]),
          .feature_a = to_string(d.closest.features[0]),
          .feature_b = to_string(d.closest.features[1]),
          .inside = static_cast<DistanceInside>(d.inside)};
}

}  // namespace

struct DistanceFinder::State {
  DistanceFinderOptions given;
  DistanceOptions options;
  Scene scene;  // of the last call
  DistanceMemory memory;
  std::atomic_flag used;

  explicit State(const DistanceFinderOptions& from) : given(from), options(checked(from)) {}
};

DistanceFinder::DistanceFinder(const DistanceFinderOptions& options)
    : state_(translated([&] { return std::make_unique<State>(options); })) {}
DistanceFinder::DistanceFinder() : DistanceFinder(DistanceFinderOptions{}) {}
DistanceFinder::~DistanceFinder() = default;
DistanceFinder::DistanceFinder(DistanceFinder&&) noexcept = default;
DistanceFinder& DistanceFinder::operator=(DistanceFinder&&) noexcept = default;

std::vector<DistanceAnswer> DistanceFinder::find(const ColliderInput& input) {
  return exclusive(state_, "DistanceFinder", [&](State& state) {
    take(input, state.given.self, state.given.self_objects, state.scene);
    const DistanceRecord record = distances(state.scene, state.options, {}, &state.memory);
    std::vector<DistanceAnswer> out;
    out.reserve(record.distances.size());
    for (const Distance& d : record.distances) out.push_back(given_out(d));
    return out;
  });
}

std::vector<DistanceAnswer> distances(const ColliderInput& input,
                                      const DistanceFinderOptions& options) {
  return DistanceFinder(options).find(input);
}

}  // namespace farcull
