// The collider: input is checked and copied into a scene, then planned, found and decided.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/scene/ignored.h"
#include "core/view/view.h"
#include "experiments/library/farcull.h"
#include "experiments/library/input.h"
#include "experiments/method/run.h"

namespace farcull {
namespace {

constexpr int kMostResolution = 16384;

void check(const ColliderOptions& options) {
  if (options.threads > kMostThreads)
    throw Error("threads", "are more than 1024", "give a number up to 1024, or 0");
  if (!(options.clearance >= 0) || !std::isfinite(options.clearance))
    throw Error("clearance", "is no distance", "give a finite number, 0 or more");
  if (options.resolution < 0 || options.resolution > kMostResolution)
    throw Error("resolution", "is outside 0 .. 16384", "give a number of pixels, or 0");
}

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

ContactDetail detail_of(ColliderContacts contacts) {
  switch (contacts) {
    case ColliderContacts::none:
      return ContactDetail::none;
    case ColliderContacts::kinds:
      return ContactDetail::kinds;
    case ColliderContacts::segments:
      return ContactDetail::segments;
  }
  return ContactDetail::none;
}

ColliderContactKind given_out(ContactKind kind) {
  switch (kind) {
    case ContactKind::apart:
      return ColliderContactKind::apart;
    case ContactKind::equal:
      return ColliderContactKind::equal;
    case ContactKind::touch_vertex:
      return ColliderContactKind::touch_vertex;
    case ContactKind::touch_edge:
      return ColliderContactKind::touch_edge;
    case ContactKind::coplanar:
      return ColliderContactKind::coplanar;
    case ContactKind::crossing:
      return ColliderContactKind::crossing;
    case ContactKind::touch_face:
      return ColliderContactKind::touch_face;
  }
  throw std::logic_error("library: a kind of contact that there is not");
}

ColliderContact given_out(const ContactShape& shape) {
  const auto point = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  return {.kind = given_out(shape.kind),
          .dimension = shape.dimension,
          .ends = {point(shape.ends[0]), point(shape.ends[1])}};
}

std::vector<ColliderContact> given_out(const std::vector<ContactShape>& shapes) {
  std::vector<ColliderContact> out;
  out.reserve(shapes.size());
  for (const ContactShape& shape : shapes) out.push_back(given_out(shape));
  return out;
}

/// The ignored pairs of a scene with so many objects.
std::vector<ObjectPair> ignored_of(const ColliderOptions& options, std::size_t objects) {
  std::vector<ObjectPair> out;
  for (const auto& [a, b] : options.ignore) {
    const std::string text = "names objects " + std::to_string(a) + " and " + std::to_string(b);
    if (std::max(a, b) >= objects) {
      throw Error("ignore", text + " of " + std::to_string(objects) + ", numbered from 0",
                  "give two objects of the input in each pair");
    }
    if (a == b) {
      throw Error("ignore", text + ", which are one",
                  "give two different objects; self_objects says which are tested against "
                  "themselves");
    }
    out.push_back({a, b});
  }
  return in_order(std::move(out));
}

std::vector<ColliderPair> given_out(const std::vector<TrianglePair>& pairs) {
  std::vector<ColliderPair> out(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) out[k] = {pairs[k].a, pairs[k].b};
  return out;
}

}  // namespace

const char* to_string(ColliderContactKind kind) {
  for (const ContactKind own : kContactKinds) {
    if (given_out(own) == kind) return name_of(own).data();  // of a literal, so it ends with a 0
  }
  throw std::logic_error("library: a kind of contact that there is not");
}

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
  report.promises_reason = used.gl ? kept.reason : "on the CPU nothing rests on a device";
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
  } else {
    decided = session.frame_decider()->decide(scene, found.pairs, question);
  }
  out.complete = report.decided == found.pairs.size();
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
  return translated([&] {
    const Stopwatch start;
    take(input, state_->options.self, state_->options.self_objects, state_->scene);
    try {
      return state_->find(start);
    } catch (...) {
      state_->session.forget_device();
      throw;
    }
  });
}

}  // namespace farcull
