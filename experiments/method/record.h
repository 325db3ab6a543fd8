// The record of a run: what was asked and planned, what each stage found, and how long each took.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/fields.h"
#include "core/base/floating_point.h"
#include "core/base/stage.h"
#include "core/boxes/join.h"
#include "core/canvas/canvas.h"
#include "core/cull/cull.h"
#include "core/gl/base/context.h"
#include "experiments/method/device_verdict.h"
#include "experiments/method/options.h"
#include "verify/accounting.h"
#include "verify/contact.h"
#include "verify/exact.h"

namespace farcull {

// ---- what a method finds: pairs of triangles that may collide ----

/// The device that answered.
struct UsedDevice {
  std::optional<GlInfo> gl;  // the GL device; empty: none, or the cores of the CPU
  bool cpu = false;          // the cores of the CPU answered
  std::string lanes = {};    // the instruction set of the native canvas; empty for others
  int depth_bits = 0;        // of the canvas
  std::string note;          // why this device; empty: none was used
  bool relies = false;       // the guarantee depends on the GL device
};

/// For sweep and prune: the number of triangles of the objects that are left after comparing boxes
/// of objects. This is the result of I-COLLIDE as published.
struct SweptObjects {
  std::uint64_t triangles = 0;
};

struct Candidates {
  std::vector<TrianglePair> pairs;  // sorted; empty if streamed
  bool streamed = false;            // pairs were decided as they were found, and not listed
  std::uint64_t count = 0;          // of candidate pairs
  std::uint64_t ignored = 0;        // candidates of ignored objects, which were removed
  /// The potentially colliding set, ascending. For boxes run() fills it from the pairs. Empty for a
  /// method that culls nothing, since it keeps all triangles.
  std::vector<std::uint32_t> triangles;
  std::uint64_t triangle_count = 0;  // of the potentially colliding set
  std::uint64_t object_count = 0;
  std::optional<Collisions> decided;  // the answers, if streamed
  /// The views of a drawing method, or the objects of a sweep.
  std::variant<std::monostate, std::vector<ViewReport>, SweptObjects> by;
  std::vector<std::uint8_t> bits;  // of a drawing method, per triangle: CullResult::bits
  UsedDevice device;
  CanvasWork asked;  // work of the GL device in drawing; all 0 for other methods
  std::vector<Stage> trace;
  double setup_ms = 0;    // context, shaders; 0 if an earlier run had made them
  double ms = 0;          // of finding, without setup
  double decided_ms = 0;  // of deciding, if streamed; not part of ms

  /// The views in `by`; empty if it holds another kind.
  const std::vector<ViewReport>& views() const {
    static const std::vector<ViewReport> none;
    const auto* views = std::get_if<std::vector<ViewReport>>(&by);
    return views ? *views : none;
  }
  /// True if a drawing method drew. It does not if boxes left nothing or no view is resolvable.
  bool drew() const { return std::ranges::any_of(views(), &ViewReport::drawn); }
  std::optional<std::uint64_t> swept_triangles() const {
    const auto* swept = std::get_if<SweptObjects>(&by);
    return swept ? std::optional(swept->triangles) : std::nullopt;
  }
};

// ---- the record ----

struct RunTimes {
  double setup = 0;     // context, shaders; 0 if an earlier run of the process had made them
  double cull = 0;      // plan, fattening, passes, box join of the kept triangles
  double exact = 0;     // exact predicates on the candidates
  double total = 0;     // setup, cull and exact together
  double contacts = 0;  // kinds of contact
  FARCULL_FIELDS(setup, cull, exact, total, contacts)
};

/// Whether a miss would break a guarantee.
struct Promise {
  /// The method is guaranteed(), and its device keeps the assumptions that the guarantee needs.
  bool holds = false;
  std::string reason;                    // why, or why not
  std::optional<DeviceVerdict> verdict;  // of that device; empty if the guarantee needs no device
};

/// How many colliding pairs FAR loses in the same scene, views and pixels: with 0.9 of the budget
/// radius (at_risk), and with radius 0 (at_risk_bare). If both are 0, a run without misses says
/// nothing about the radius.
struct PairsAtRisk {
  std::uint64_t at_risk = 0, at_risk_bare = 0;
};

struct Record {
  RunOptions options;
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<Stage> plan;   // the stages as planned, before anything ran
  std::vector<Stage> trace;  // the stages as they ran
  Promise promise;
  Candidates found;
  Collisions collisions;
  std::uint64_t decided = 0;  // candidates that exact predicates decided
  bool complete = true;       // false: the limit was reached, so candidates are undecided, or
                              // colliding pairs after the last one listed are left out
  bool limited = false;       // the limit ended the search, so nothing accounts for the pairs
  /// Of collisions.pairs and collisions.neighbour_pairs, if contacts are asked for; only the kinds,
  /// unless segments are asked for.
  std::vector<ContactShape> contacts, neighbour_contacts;
  std::optional<Accounting> verification;  // with at most kExamples examples
  /// How many missed pairs touch, and how many penetrate; set with a verification and without a
  /// clearance.
  std::optional<ContactCounts> missed;
  std::optional<PairsAtRisk> risk;  // if pairs_at_risk() was asked
  RunTimes ms;
  FloatingPoint callers, used;  // floating-point environment of our caller, and of this run
};

constexpr std::size_t kExamples = 10;  // missed pairs that a record names

}  // namespace farcull
