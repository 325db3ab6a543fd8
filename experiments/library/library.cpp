// The collider: input is checked and copied into a scene, then planned, found and decided.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/gl/base/context.h"
#include "core/view/view.h"
#include "experiments/library/answers.h"
#include "experiments/library/farcull.h"
#include "experiments/library/input.h"
#include "experiments/method/run.h"

namespace farcull {
namespace {

std::string device_of(const ColliderOptions& options) {
  switch (options.device) {
    case ColliderDevice::cpu:
      return "cpu";
    case ColliderDevice::gl:
      return "gl";
    case ColliderDevice::best:
      return "";
  }
  return "";
}

RunOptions run_options(const ColliderOptions& options) {
  check(options);
  RunOptions out{.method = Method::far_pairs,
                 .resolution = options.resolution,
                 .views = options.views == "auto" ? "" : options.views,
                 .clearance = options.clearance};
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
  std::atomic_flag used;

  explicit State(const ColliderOptions& given)
      : options(given), run(run_options(given)), session(device_of(given), given.threads, Say()) {
    session.remember_frames();
    device();
    promise();
  }

  // Opened where it is not: at first, and after a failure.
  PairDevice& device() { return session.pairs(); }

  // Of the device that is open, whatever an earlier one promised.
  Promise promise() {
    const std::optional<Reliance> relies =
        device().gl ? std::optional(Reliance::pairs) : std::nullopt;
    return promise_of(run, {.gl = device().gl, .cpu = !device().gl, .note = "", .relies = relies},
                      session);
  }
  // Of an answer that a device took part in, or none did.
  void report_device(const UsedDevice& used, ColliderReport& report);

  /// The collisions of the scene; `start`: when the call began. After an exception nothing on the
  /// device may be believed.
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

ColliderResult Collider::State::find(const Stopwatch& start) {
  device();
  const unsigned threads =
      options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
  run.ignored = ignored_of(options, scene.objects.size());
  const Plan planned = plan(scene, run, options.threads, {}, session.pair_memory());
  const Candidates found = farcull::find(scene, planned, session);
  ColliderResult out;
  ColliderReport& report = out.report;
  report.candidates_ms = start.ms();
  report.candidates = found.count;

  const Stopwatch deciding;
  const ExactQuestion question{
      .clearance = options.clearance, .threads = threads, .neighbours = options.neighbours};
  Collisions decided;
  report.decided = found.pairs.size();
  if (options.limit > 0) {
    FirstCollisions first = decide_first(scene, found.pairs, options.limit, question);
    decided = std::move(first.collisions);
    report.decided = first.decided;
    out.complete = first.complete;
  } else {
    decided = session.frame_decider()->decide(scene, found.pairs, question);
  }
  out.pairs = given_out(decided.pairs);
  out.neighbour_pairs = given_out(decided.neighbour_pairs);
  report.neighbours = decided.neighbours;
  report.exact_ms = deciding.ms();

  const Stopwatch contacts;
  const ContactDetail detail = detail_of(options.contacts);
  out.contacts = given_out(contacts_of(scene, decided.pairs, detail, threads));
  out.neighbour_contacts = given_out(contacts_of(scene, decided.neighbour_pairs, detail, threads));
  report.contacts_ms = contacts.ms();

  require_proved("arithmetic");  // the driver's code ran in this thread too
  const FloatingPoint callers = callers_floating_point();
  if (callers != kProved) report.callers_arithmetic = to_string(callers);
  report_device(found.device, report);
  std::vector<Stage> stages = planned.trace;
  stages.insert(stages.end(), found.trace.begin(), found.trace.end());
  stages.push_back({.kind = StageKind::exact,
                    .ran = true,
                    .reason = Reason::predicates,
                    .ms = report.exact_ms,
                    .in = report.decided,
                    .out = out.pairs.size() + out.neighbour_pairs.size(),
                    .unit = Unit::pairs});
  for (const Stage& s : stages)
    report.stages.push_back(
        {name_of(s), s.ran, reason_of(s), s.ms, s.in, s.out, to_string(s.unit)});
  for (const PairView& v : found.pair_views())
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
    take(input, state.options.self, state.options.self_objects, state.scene);
    try {
      return state.find(start);
    } catch (...) {
      state.session.forget_device();
      throw;
    }
  });
}

}  // namespace farcull
