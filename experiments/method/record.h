// The record of a run: its options and plan, and the results and times of its stages.
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

/// The device on which a method drew triangles.
struct UsedDevice {
  std::optional<GlInfo> gl;  // the GL device; empty if no GL device was used
  bool cpu = false;          // true: the cores of the CPU were used
  std::string lanes = {};    // the CPU's instruction set; empty for a GL device
  int depth_bits = 0;        // bits of a depth value
  std::string note;          // why this device was used; empty if no device was used
  bool relies = false;       // true: the guarantee depends on the GL device
};

/// The result of I-COLLIDE as published: the number of triangles in objects that remain after the
/// comparison of the objects' boxes.
struct SweptObjects {
  std::uint64_t triangles = 0;
};

struct Candidates {
  std::vector<TrianglePair> pairs;  // sorted; empty if streamed
  bool streamed = false;            // true: pairs were decided when found, and not listed
  std::uint64_t count = 0;          // number of candidate pairs
  std::uint64_t ignored = 0;        // candidates removed because their objects are ignored
  /// The triangles of the potentially colliding set, ascending. For the method `boxes`, run() sets
  /// this member from `pairs`. Empty for a method that culls nothing.
  std::vector<std::uint32_t> triangles;
  std::uint64_t triangle_count = 0;   // triangles of the potentially colliding set
  std::uint64_t object_count = 0;     // objects of the potentially colliding set
  std::optional<Collisions> decided;  // the exact decisions, if `streamed`
  /// The views of a method that draws, or the result of I-COLLIDE's sweep.
  std::variant<std::monostate, std::vector<ViewReport>, SweptObjects> by;
  std::vector<std::uint8_t> bits;  // CullResult::bits of a method that draws, one per triangle
  UsedDevice device;
  CanvasWork asked;  // number of GL operations while drawing; 0 without a GL device
  std::vector<Stage> trace;
  double setup_ms = 0;    // time for the context and shaders
  double ms = 0;          // time of finding candidates, without setup_ms and decided_ms
  double decided_ms = 0;  // time of exact decisions, if `streamed`

  /// Returns the views in `by`; empty if `by` has no views.
  const std::vector<ViewReport>& views() const {
    static const std::vector<ViewReport> none;
    const auto* views = std::get_if<std::vector<ViewReport>>(&by);
    return views ? *views : none;
  }
  /// True if at least one view was drawn.
  bool drew() const { return std::ranges::any_of(views(), &ViewReport::drawn); }
  std::optional<std::uint64_t> swept_triangles() const {
    const auto* swept = std::get_if<SweptObjects>(&by);
    return swept ? std::optional(swept->triangles) : std::nullopt;
  }
};

struct RunTimes {
  double setup = 0;     // making the context and shaders
  double cull = 0;      // planning and finding the candidates
  double exact = 0;     // exact predicates on the candidates
  double total = 0;     // setup + cull + exact
  double contacts = 0;  // finding the kinds of contact
  FARCULL_FIELDS(setup, cull, exact, total, contacts)
};

/// States whether the run guaranteed that no pair is missed. Then a missed pair is an error.
struct Promise {
  /// True if the method is guaranteed() and its device keeps the assumptions of the guarantee.
  bool holds = false;
  std::string reason;                    // why `holds` is true or false
  std::optional<DeviceVerdict> verdict;  // on the device; empty if none was needed
};

/// Numbers of colliding pairs that FAR misses with smaller radii, if the scene, the pixel grid and
/// the views are the same. at_risk: with 0.9 of the budget radius. at_risk_bare: with radius 0. If
/// both numbers are 0, this scene does not show that the radius is needed.
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
  std::uint64_t decided = 0;  // number of candidates that exact predicates decided
  bool complete = true;       // false: RunOptions::limit was reached, so pairs may be left out
  bool limited = false;       // true: the limit ended the search, so nothing was verified
  /// The contacts of collisions.pairs and of collisions.neighbour_pairs, one per pair.
  /// RunOptions::contacts selects the detail. Empty if the detail is `none`.
  std::vector<ContactShape> contacts, neighbour_contacts;
  std::optional<Accounting> verification;  // with at most kExamples missed pairs
  /// How many missed pairs touch, and how many penetrate. Set if `verification` is set and the
  /// clearance is 0.
  std::optional<ContactCounts> missed;
  std::optional<PairsAtRisk> risk;
  RunTimes ms;
  FloatingPoint callers, used;  // floating-point environments of the caller and of this run
};

constexpr std::size_t kExamples = 10;  // maximum number of missed pairs that a record lists

}  // namespace farcull
