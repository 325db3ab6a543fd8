// One run of a method on a scene, from triangles to a record: plan, cull, join, exact tests,
// accounting.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/cull.h"
#include "core/floating_point.h"
#include "core/gl_context.h"
#include "core/pairs.h"
#include "core/sweep_prune.h"
#include "experiments/device_verdict.h"
#include "experiments/pair_device.h"
#include "experiments/run_options.h"
#include "verify/accounting.h"
#include "verify/contact.h"

namespace farcull {

struct RunTimes {
  double setup = 0;  // context, shaders; 0 where an earlier run of the process had made them
  double cull = 0;   // plan, fattening, passes, box join of what is kept
  double exact = 0;  // exact predicates on the candidates
  double total = 0;  // of all stages but the verification
};

struct RunRecord {
  RunOptions options;
  bool promises = false;       // the method promises (see promises()), and the device that it used
                               // keeps what the promise rests on: a miss breaks a guarantee
  std::string promise_reason;  // why, or why not
  std::optional<DeviceVerdict> verdict;  // of that device; empty where the promise rests on none
  bool on_cpu = false;                   // far-pairs on the cores of the CPU
  std::string device_note;  // why no device was used, where none was; for far-pairs, why this one
  std::optional<GlInfo> device;  // what drew
  int depth_bits = 0;            // of the canvas
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<ViewReport> views;     // of far and the CULLIDE family
  std::vector<PairView> pair_views;  // of far-pairs
  std::vector<Stage> stages;
  std::uint64_t pcs_objects = 0;
  std::uint64_t pcs_triangles = 0;
  std::vector<std::uint32_t> pcs;      // those triangles, ascending; not of exact, which keeps all
  std::uint64_t object_triangles = 0;  // of i-collide: of the objects that their boxes leave, which
                                       // is where I-COLLIDE as published ends
  std::uint64_t candidate_pairs = 0;
  std::vector<TrianglePair>
      kept;  // sorted: the candidates; for exact, which tests them all, the colliding ones
  std::vector<TrianglePair> pairs;            // colliding, sorted; not neighbours
  std::vector<TrianglePair> neighbour_pairs;  // colliding neighbours, sorted (verify/exact.h)
  std::uint64_t neighbours = 0;               // candidates that are neighbours, colliding or not
  std::optional<Accounting> verification;     // with kExamples examples
  std::optional<ContactCounts> missed;        // what was missed, by the kind of contact; with a
                                              // verification, without a clearance
  RunTimes ms;
  FloatingPoint callers, used;  // floating-point environment of our caller, and of this run
};

constexpr std::size_t kExamples = 10;  // missed pairs that a record names

/// Holds the GL context and what FAR pairs and I-COLLIDE keep between the runs of one process; each
/// made when first needed.
class Session {
 public:
  explicit Session(std::string device) : device_(std::move(device)) {}
  const GlContext& context();
  /// Whether the context's device keeps the assumptions; probed, and told in one line on stderr,
  /// where no verdict is kept. GL state is not kept.
  const DeviceVerdict& verdict(Reliance reliance);
  /// The canvas for the drawables of this fattener, by its name.
  GlCanvas& canvas(const Fattener& fattener, const GlCanvasOptions& options);
  PairDevice& pairs();
  bool has_pairs() const { return pairs_.has_value(); }
  SweepPrune& sweep() { return sweep_; }
  /// Drops the canvases, the pair device and the context: after a failure nothing that lies on a
  /// device is believed. Each is made again when it is next needed.
  void forget_device();

 private:
  std::string device_;
  std::unique_ptr<GlContext> context_;
  std::map<Reliance, DeviceVerdict> verdicts_;
  std::map<std::tuple<std::string, DepthFormat, QueryMode>, GlCanvas> canvases_;
  std::optional<PairDevice> pairs_;  // these two go before the context
  SweepPrune sweep_;
};

/// Whether the method promises to miss nothing: far-pairs and i-collide, and far at the budget
/// radius or more with fragment depth. A run promises if the device keeps its assumptions as well.
bool promises(const RunOptions& options);

/// Takes the session's verdict into the record of a method that promises.
void rely_on_device(Session& session, Reliance reliance, RunRecord& record);

/// What all stages together drew and asked, and saved of it; the rest is empty.
Stage work_of(const std::vector<Stage>& stages);

/// Whether an object of the scene is tested against itself.
bool has_self(const Scene& scene);

/// Throws Error where an object of the scene is tested against itself and the method does not look
/// for that, or none is and it looks for nothing else.
void require_scene(const Scene& scene, Method method);

/// Runs the method. Throws Error for bad options, as require_scene(), and for any fault of the
/// device. After any exception the session has forgotten its device, and can be used again.
RunRecord run_scene(const Scene& scene, const RunOptions& options, Session& session,
                    const Progress& progress = {});

/// Whether the record breaks a guarantee: `strict` asks it of every method (`farcull verify`).
bool broken(const RunRecord& record, bool strict);

}  // namespace farcull
