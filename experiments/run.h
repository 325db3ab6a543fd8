// One run of a method on a scene, from triangles to a record: plan, cull, join, exact tests,
// accounting.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/cull.h"
#include "core/gl_canvas.h"
#include "core/gl_context.h"
#include "core/pairs.h"
#include "experiments/pair_device.h"
#include "verify/accounting.h"

namespace farcull {

enum class Method { far, cullide, far_pairs, exact };
std::string to_string(Method method);
/// Throws Error naming `option` for an unknown one.
Method parse_method(const std::string& name, const std::string& option = "--method");
/// A whole number of pixels, 1 or more. Throws Error naming `option`.
int parse_resolution(const std::string& text, const std::string& option = "--resolution");
/// "published", "budget" or a factor on the budget radius (0 to 100000). Throws Error naming
/// --radius.
RadiusRule parse_radius(const std::string& text);

struct RunOptions {
  Method method = Method::far;
  int resolution = 0;  // px along the larger side of a view's window; 0: 512, but chosen by the
                       // scene for far-pairs
  RadiusRule radius;   // far only
  std::string offset = "obb";      // far only
  std::optional<DepthMode> depth;  // default: fragment for far, fixed for cullide
  DepthFormat depth_format = DepthFormat::float32;
  std::optional<QueryMode> query;  // default: flags with float32, occlusion with fixed24
  std::string views;               // "": x,y,z, but chosen by the scene for far-pairs
  std::string device;    // "": hardware first, then software; for far-pairs see pair_device.h
  double clearance = 0;  // world units, finite, >= 0; far-pairs and exact only
  bool verify = true;
  std::optional<std::uint64_t> seed;  // what the scene was drawn with; empty: it is not random
};

/// px; far-pairs takes no more. Nothing depends on it but time: a window has the square of it.
constexpr int kMostPairResolution = 16384;
/// Throws Error naming `option` for more.
void require_pair_resolution(int resolution, const std::string& option = "--resolution");

/// What applies where the option is not given. resolution_of: 0 and views_of: "" where the scene
/// chooses.
int resolution_of(const RunOptions& options);
std::string views_of(const RunOptions& options);
DepthMode depth_of(const RunOptions& options);
QueryMode query_of(const RunOptions& options);
/// The method in words for messages, such as "cullide at 512 px".
std::string describe(const RunOptions& options);

/// Throws Error naming the option where one is out of range or options do not go together. Opens no
/// device.
void validate(const RunOptions& options);

struct RunTimes {
  double setup = 0;  // context, shaders; 0 where an earlier run of the process had made them
  double cull = 0;   // plan, fattening, passes, box join of what is kept
  double exact = 0;  // exact predicates on the candidates
  double total = 0;  // of all stages but the verification
};

struct RunRecord {
  RunOptions options;
  bool promises = false;  // far-pairs; far at the budget radius or more with fragment depth: a miss
                          // breaks a guarantee
  bool on_cpu = false;    // far-pairs on the cores of the CPU
  std::string device_note;  // why no device was used, where none was; for far-pairs, why this one
  std::optional<GlInfo> device;  // what drew
  int depth_bits = 0;            // of the canvas
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<ViewReport> views;     // of far and cullide
  std::vector<PairView> pair_views;  // of far-pairs
  std::vector<Stage> stages;
  std::uint64_t pcs_objects = 0;
  std::uint64_t pcs_triangles = 0;
  std::uint64_t candidate_pairs = 0;
  std::vector<TrianglePair>
      kept;  // sorted: the candidates; for exact, which tests them all, the colliding ones
  std::vector<TrianglePair> pairs;            // colliding, sorted; not neighbours
  std::vector<TrianglePair> neighbour_pairs;  // colliding neighbours, sorted (verify/exact.h)
  std::uint64_t neighbours = 0;               // candidates that are neighbours, colliding or not
  std::optional<Accounting> verification;
  RunTimes ms;
};

/// Holds the GL context and what FAR pairs keeps between the runs of one process; each made when
/// first needed.
class Session {
 public:
  explicit Session(std::string device) : device_(std::move(device)) {}
  const GlContext& context();
  PairDevice& pairs();

 private:
  std::string device_;
  std::unique_ptr<GlContext> context_;
  std::optional<PairDevice> pairs_;  // goes before the context
};

/// Whether an object of the scene is tested against itself.
bool has_self(const Scene& scene);

/// Runs the method. Throws Error for bad options, for a scene with an object that collides with
/// itself where the method does not look for that (far, cullide), and for any fault of the device.
RunRecord run_scene(const Scene& scene, const RunOptions& options, Session& session,
                    const Progress& progress = {});

/// Whether the record breaks a guarantee: `strict` asks it of every method (`farcull verify`).
bool broken(const RunRecord& record, bool strict);

}  // namespace farcull
