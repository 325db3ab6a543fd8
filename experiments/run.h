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
#include "verify/accounting.h"

namespace farcull {

enum class Method { far, cullide, exact };
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
  int resolution = 512;            // px along the larger side of a view's window
  RadiusRule radius;               // far only
  std::string offset = "obb";      // far only
  std::optional<DepthMode> depth;  // default: fragment for far, fixed for cullide
  DepthFormat depth_format = DepthFormat::float32;
  std::optional<QueryMode> query;  // default: flags with float32, occlusion with fixed24
  std::string views = "x,y,z";
  std::string device;  // "": hardware first, then software
  bool verify = true;
  std::optional<std::uint64_t> seed;  // what the scene was drawn with; empty: it is not random
};

/// What applies where the option is not given.
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
  bool promises = false;    // far, budget radius or more, fragment depth: a miss breaks a guarantee
  std::string device_note;  // why no device was used, where none was
  std::optional<GlInfo> device;  // what drew
  int depth_bits = 0;            // of the canvas
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<ViewReport> views;
  std::vector<Stage> stages;
  std::uint64_t pcs_objects = 0;
  std::uint64_t pcs_triangles = 0;
  std::uint64_t candidate_pairs = 0;
  std::vector<TrianglePair>
      kept;  // sorted: the candidates; for exact, which tests them all, the colliding ones
  std::vector<TrianglePair> pairs;  // colliding, sorted
  std::optional<Accounting> verification;
  RunTimes ms;
};

/// Holds the GL context between the runs of one process; made when first needed.
class Session {
 public:
  explicit Session(std::string device) : device_(std::move(device)) {}
  const GlContext& context();

 private:
  std::string device_;
  std::unique_ptr<GlContext> context_;
};

/// Runs the method. Throws Error for bad options and for any fault of the device.
RunRecord run_scene(const Scene& scene, const RunOptions& options, Session& session,
                    const Progress& progress = {});

/// Whether the record breaks a guarantee: `strict` asks it of every method (`farcull verify`).
bool broken(const RunRecord& record, bool strict);

}  // namespace farcull
