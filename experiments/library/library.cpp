// The collider: input is checked and copied into a scene, which is run (experiments/method/run.h).
#include <utility>

#include "core/base/error.h"
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
  std::uint64_t calls = 0;
  std::atomic_flag used;

  explicit State(const ColliderOptions& given)
      : options(given), run(run_options(given)), session(device_of(given), given.threads, Say()) {
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
  run.ignored = ignored_of(options, scene.objects.size());
  // What is remembered is two more copies of the scene, which one call alone has no use for.
  if (++calls == 2) session.remember_frames();
  const Record record = farcull::run(
      scene, run, session, {}, {.answer_only = true, .decide_neighbours = options.neighbours});
  ColliderResult out;
  ColliderReport& report = out.report;
  report.candidates_ms = start.ms() - record.ms.exact - record.ms.contacts;
  report.candidates = record.found.count;
  report.decided = record.decided;
  report.neighbours = record.collisions.neighbours;
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
