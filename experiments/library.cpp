#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/floating_point.h"
#include "core/gl_probe.h"
#include "core/pairs.h"
#include "core/stopwatch.h"
#include "core/view.h"
#include "experiments/device_verdict.h"
#include "experiments/farcull.h"
#include "experiments/pair_device.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr int kMostResolution = 16384;

// The call with the floating-point environment of the proofs, the caller's restored afterwards.
// Every Error that it throws becomes the one of the library.
template <class Call>
auto translated(const Call& call) {
  try {
    const FloatingPointGuard guard;
    return call();
  } catch (const Error& error) {
    throw ColliderError(error.what(), error.where, error.reason, error.remedy);
  }
}

constexpr unsigned kMostThreads = 1024;

void check(const ColliderOptions& options) {
  if (options.threads > kMostThreads)
    throw Error("threads", "are more than 1024", "give a number up to 1024, or 0");
  if (!(options.clearance >= 0) || !std::isfinite(options.clearance))
    throw Error("clearance", "is no distance", "give a finite number, 0 or more");
  if (options.resolution < 0 || options.resolution > kMostResolution)
    throw Error("resolution", "is outside 0 .. 16384", "give a number of pixels, or 0");
}

std::vector<View> views_of(const ColliderOptions& options) {
  if (options.views == "auto") return {};
  try {
    return parse_views(options.views);
  } catch (const Error& error) {
    throw Error("views", error.reason, error.remedy);
  }
}

// Into the scene of the last call, whose memory is used again.
void take(const ColliderInput& input, const ColliderOptions& options, Scene& scene) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (input.vertices.size() % 3 != 0 || input.vertices.size() / 3 > kMost)
    throw Error("vertices", "are not three doubles for each of at most 2^32 - 1 vertices",
                "give x, y, z of each");
  if (input.triangles.size() % 3 != 0 || input.triangles.size() / 3 > kMost)
    throw Error("triangles", "are not three indices for each of at most 2^32 - 1 triangles",
                "give three indices of each");
  const auto count = static_cast<std::uint32_t>(input.triangles.size() / 3);
  scene.vertices.resize(input.vertices.size() / 3);
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    scene.vertices[v] = {input.vertices[3 * v], input.vertices[3 * v + 1],
                         input.vertices[3 * v + 2]};
    if (scene.vertices[v].allFinite()) continue;
    throw Error("vertices", "vertex " + std::to_string(v) + " is not finite",
                "give finite coordinates");
  }
  scene.triangles.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = input.triangles[3 * t + k];
      scene.triangles[t][k] = v;
      if (v < scene.vertices.size()) continue;
      throw Error("triangles",
                  "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                      std::to_string(scene.vertices.size()),
                  "correct the index");
    }
  }
  scene.source_face.resize(count);
  const std::size_t objects = std::max<std::size_t>(input.object_starts.size(), 1);
  if (!options.self_objects.empty() && options.self_objects.size() != objects) {
    throw Error("self_objects",
                "are " + std::to_string(options.self_objects.size()) + " for " +
                    std::to_string(objects) + " objects",
                "give one for each object, or none");
  }
  scene.objects.resize(objects);
  for (std::size_t o = 0; o < objects; ++o) {
    const std::uint32_t first = input.object_starts.empty() ? 0 : input.object_starts[o];
    const std::uint32_t end = o + 1 < objects ? input.object_starts[o + 1] : count;
    if ((o == 0 && first != 0) || first > end) {
      throw Error("object_starts",
                  "object " + std::to_string(o) + " starts at triangle " + std::to_string(first) +
                      " and ends before " + std::to_string(end),
                  "begin with 0, and let no start be below the one before it or beyond the number "
                  "of triangles");
    }
    scene.objects[o].first_triangle = first;
    scene.objects[o].triangle_count = end - first;
    scene.objects[o].self =
        options.self || (!options.self_objects.empty() && options.self_objects[o]);
  }
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
  std::vector<View> views;
  std::unique_ptr<GlContext> context;
  bool promises = false;        // of the device that is open
  std::string promises_reason;  // of that device as well
  PairDevice device;            // goes before its context
  Scene scene;                  // of the last call

  explicit State(const ColliderOptions& given) : options(given) {
    check(options);
    views = views_of(options);
    open_device();
  }

  void open_device() {
    const auto open = [&]() -> const GlContext& {
      context = std::make_unique<GlContext>();
      return *context;
    };
    switch (options.device) {
      case ColliderDevice::cpu:
        device = cpu_pair_device(options.threads, "asked for");
        break;
      case ColliderDevice::gl:
        device = gl_pair_device(open(), "asked for");
        break;
      case ColliderDevice::best:
        device = open_pair_device("", options.threads, open);
        break;
    }
    // Of the device that is open now, whatever an earlier one promised.
    promises = !device.gl;
    promises_reason =
        device.gl ? "its probes have not run" : "on the CPU nothing rests on a device";
    if (device.gl) judge_device();
  }

  // Whether the device keeps what the promise rests on.
  void judge_device() {
    const DeviceVerdict verdict =
        device_verdict(*device.gl, Reliance::pairs, [&] { return pair_probes(*context); });
    promises = verdict.holds;
    promises_reason = to_string(verdict, Reliance::pairs);
  }

  // After a failure nothing that lies on a device is believed, the context included: the next call
  // opens it anew.
  PairResult candidates() {
    try {
      if (!device.backend) open_device();
      return find_pairs(
          scene, {.views = views, .resolution = options.resolution, .clearance = options.clearance},
          *device.backend);
    } catch (...) {
      device = {};
      context.reset();
      throw;
    }
  }
};

Collider::Collider(const ColliderOptions& options)
    : state_(translated([&] { return std::make_unique<State>(options); })) {}
Collider::Collider() : Collider(ColliderOptions{}) {}
Collider::~Collider() = default;
Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;

ColliderResult Collider::find(const ColliderInput& input) {
  return translated([&] {
    State& state = *state_;
    const Stopwatch start;
    take(input, state.options, state.scene);
    const PairResult found = state.candidates();
    ColliderResult out;
    ColliderReport& report = out.report;
    report.candidates_ms = start.ms();
    report.candidates = found.candidates.size();

    const Stopwatch deciding;
    const unsigned threads =
        state.options.threads > 0 ? state.options.threads : std::thread::hardware_concurrency();
    const Collisions decided = decide(state.scene, found.candidates,
                                      {.clearance = state.options.clearance,
                                       .threads = threads,
                                       .neighbours = state.options.neighbours});
    out.pairs = given_out(decided.pairs);
    out.neighbour_pairs = given_out(decided.neighbour_pairs);
    report.neighbours = decided.neighbours;
    report.exact_ms = deciding.ms();

    require_proved("arithmetic");  // the driver's code ran in this thread too
    const FloatingPoint callers = callers_floating_point();
    if (callers != kProved) report.callers_arithmetic = to_string(callers);
    report.device = state.device.backend->name();
    report.device_reason = state.device.reason;
    report.promises = state.promises;
    report.promises_reason = state.promises_reason;
    for (const Stage& s : found.stages)
      report.stages.push_back({s.name, s.ran, s.reason, s.ms, s.in, s.out, s.unit});
    report.stages.push_back({"exact", true, "exact predicates on the candidates", report.exact_ms,
                             report.candidates, out.pairs.size() + out.neighbour_pairs.size(),
                             "pairs"});
    for (const PairView& v : found.views)
      report.views.push_back({v.name, v.looked, v.reason, v.width, v.height});
    return out;
  });
}

}  // namespace farcull
