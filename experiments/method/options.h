// What a run is asked to do: options, their defaults, and which go together.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cull/cull.h"
#include "core/gl/canvas/canvas.h"
#include "core/scene/scene.h"
#include "experiments/method/method.h"

namespace farcull {

/// A whole number of pixels, 1 or more. Throws Error naming `option`.
int parse_resolution(const std::string& text, const std::string& option = "--resolution");
/// "published", "budget" or a factor on the budget radius (0 to 100000). Throws Error naming
/// --radius.
RadiusRule parse_radius(const std::string& text);

/// "flags" or "occlusion". Throws Error naming --query.
QueryMode parse_query(const std::string& text);
/// Sizes of clusters by commas, each 2 or more and below the one before; "none" for no clusters.
/// Throws Error naming --clusters.
std::vector<std::uint32_t> parse_clusters(const std::string& text);
/// A number of rounds, 1 or more. Throws Error naming --rounds.
int parse_rounds(const std::string& text);
/// "any" or "all". Throws Error naming --clear.
ClearRule parse_clear(const std::string& text);
/// Whether the text is "objects", not "triangles". Throws Error naming --level.
bool parse_level(const std::string& text);
/// A number of runs, 1 or more. Throws Error naming --repeat.
int parse_repeat(const std::string& text);

/// The method where none is named, on every device. It misses nothing, and on most scenes it is the
/// fastest (docs/bench.md).
inline constexpr Method kDefaultMethod = Method::far_pairs;

/// What a run says of how colliding triangles meet (verify/contact_kind.h). segments: with the
/// points that they have in common.
enum class ContactDetail : std::uint8_t { none, kinds, segments };

struct RunOptions {
  Method method = kDefaultMethod;
  bool method_is_default = false;  // nobody named it, so the record says why it is this one
  int resolution = 0;      // px along the larger side of a view's window; 0: 512, but chosen by the
                           // scene for far-pairs
  RadiusRule radius = {};  // far only
  std::string offset = "obb";           // far only
  std::optional<DepthMode> depth = {};  // default: fragment for far, fixed for the CULLIDE family
  DepthFormat depth_format = DepthFormat::float32;
  std::optional<QueryMode> query = {};  // default: flags; occlusion with fixed24 and for s-cullide
  std::optional<std::vector<std::uint32_t>> clusters = {};  // default: usual_clusters()
  // Forms of the methods that draw (docs/methods.md, "Forms of CULLIDE").
  int rounds = 0;                    // at most; 0: until one changes nothing, or far's rule
  ClearRule clear = ClearRule::any;  // how many views have to clear a triangle
  bool objects_alone = false;        // objects are culled, their triangles are not; not s-cullide
  bool conservative = false;         // a fragment in each pixel touched; not far
  std::string views = {};            // "": x,y,z, but chosen by the scene for far-pairs
  std::string device = {};  // native or cpu: the cores of the CPU; gl: GL, even where a software
                            // renderer answers; hardware, software or a number: that GL device;
                            // "": GL where hardware answers, else the cores of the CPU
  double clearance = 0;     // world units, finite, >= 0; far-pairs and exact only
  bool verify = true;
  bool neighbours = true;  // false: pairs of one object that share a vertex index are neither
                           // candidates of far and far-pairs nor decided
  std::vector<ObjectPair> ignored = {};  // objects that are not tested against each other; as
                                         // in_order() gives them
  std::uint64_t limit = 0;  // only the first so many colliding pairs, neighbours among them; 0: all
  ContactDetail contacts = ContactDetail::none;
  bool full = false;  // leave nothing out that the scene does not need (docs/methods.md)
  std::optional<std::uint64_t> seed = {};  // what the scene was drawn with; empty: it is not random
};

/// px; far-pairs takes no more. Nothing depends on it but time: a window has the square of it.
constexpr int kMostPairResolution = 16384;
/// Throws Error naming `option` for more.
void require_pair_resolution(int resolution, const std::string& option = "--resolution");

/// Whether a device is the cores of the CPU: "native" or, as far-pairs has called it, "cpu".
inline bool is_cpu(const std::string& device) { return device == "native" || device == "cpu"; }

/// What applies where the option is not given. resolution_of: 0 and views_of: "" where the scene
/// chooses.
int resolution_of(const RunOptions& options);
std::string views_of(const RunOptions& options);
DepthMode depth_of(const RunOptions& options);
QueryMode query_of(const RunOptions& options);
/// Whether the method promises to miss nothing: far-pairs and i-collide, and far at the budget
/// radius or more with fragment depth. A run promises if the device keeps its assumptions as well.
bool promises(const RunOptions& options);
/// The options of a form that are not as usual, as on the command line: "--rounds 1 --clear all";
/// empty where all are.
std::string form_text(const RunOptions& options);
/// The same without what the method cannot take, so that one choice serves several methods.
RunOptions with_fitting_form(RunOptions options);
/// The method in words for messages, such as "cullide at 512 px, --rounds 1".
std::string describe(const RunOptions& options);

/// Why the method was run, as "--method" or "no --method: far-pairs misses nothing, ...".
std::string method_reason(const RunOptions& options);

/// Throws Error naming the option where one is out of range or options do not go together. Opens no
/// device.
void validate(const RunOptions& options);

}  // namespace farcull
