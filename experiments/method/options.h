// The options of a run: as one table and as one struct.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/cull/cull.h"
#include "core/gl/canvas/canvas.h"
#include "core/scene/scene.h"
#include "experiments/method/method.h"

namespace farcull {

/// The method if the user names none, on every device. It misses nothing, and on most scenes it is
/// the fastest (docs/bench.md).
inline constexpr Method kDefaultMethod = Method::boxes;

/// How much contact detail to report (verify/contact.h). segments: kinds, and the points that the
/// triangles have in common.
enum class ContactDetail : std::uint8_t { none, kinds, segments };

/// Which boxes decide what is drawn. objects: a triangle is drawn if its box meets the box of
/// another object, as published. triangles: if it meets the box of a triangle of another object.
enum class BroadPhase : std::uint8_t { objects, triangles };

struct RunOptions {
  Method method = kDefaultMethod;
  bool method_is_default = false;  // the user named no method; records say why this one was chosen
  int resolution = 0;              // px along the larger side of a view's window; 0: 512
  RadiusRule radius = {};          // far only
  std::string offset = "obb";      // far only
  std::optional<DepthMode> depth = {};  // default: fragment for far, fixed for the CULLIDE family
  DepthFormat depth_format = DepthFormat::float32;
  std::optional<QueryMode> query = {};  // default: flags; occlusion with fixed24 and for s-cullide
  std::optional<std::vector<std::uint32_t>> clusters = {};  // default: usual_clusters()
  // Forms of the methods that draw (docs/methods.md, "Forms of CULLIDE").
  int rounds = 0;                    // the most rounds; 0: until a round changes nothing, for far
                                     // until it culls little
  ClearRule clear = ClearRule::any;  // how many views have to clear a triangle
  bool objects_alone = false;        // culls only objects, not triangles; not s-cullide
  bool conservative = false;         // draws each pixel that a triangle touches; not far
  BroadPhase broad_phase = BroadPhase::objects;  // not s-cullide
  std::string views = {};                        // "": x,y,z
  std::string device = {};  // native or cpu: the cores of the CPU; gl: GL, even if only a software
                            // renderer answers; hardware, software or a number: that GL device;
                            // "": GL if a hardware device answers, else the cores of the CPU
  double clearance = 0;     // world units, finite, >= 0; boxes and exact only
  bool verify = true;
  bool neighbours = true;  // false: triangles of one object that share a vertex index are not
                           // decided, and are no candidates of far and boxes
  std::vector<ObjectPair> ignored = {};  // objects that are not tested against each other, sorted
                                         // by in_order()
  std::uint64_t limit = 0;  // finds only this many colliding pairs, neighbours included; 0: all
  ContactDetail contacts = ContactDetail::none;
  bool full = false;          // do also what the scene does not need (docs/methods.md)
  bool no_shortcuts = false;  // far draws all that a radius without a guarantee has to draw, so
                              // that radii can be compared; `full` leaves out even less
  std::optional<std::uint64_t> seed = {};  // the seed of a random scene; empty: no random scene
  // The value of a new option goes here.
};

/// A value as records hold it; empty: null.
using OptionValue = std::variant<std::monostate, bool, int, double, std::string>;

/// An option that a user gives by name. The table of options determines the command line, its help
/// and completion, errors for options that do not fit, Python's keywords, and options in records.
struct Option {
  const char* name;  // of the parameter, as in depth_format (--depth-format on a command line)
  const char* type;  // the value as the help shows it, as in "fragment|fixed"; "" for a flag
  std::string help;  // text of the help, in lines
  bool (*serves)(const Traits&);  // which methods have the option
  /// Reads a value ("" for a flag). Returns false if the text is no value of the option, or throws
  /// Error if another message says more. Precondition: options.method is set. Null: the option is
  /// about the scene, and the caller reads it.
  bool (*take)(const std::string& text, RunOptions& options) = nullptr;
  const char* kind = "";    // the error for a bad value says that it "is no <kind>"
  const char* remedy = "";  // what the error says to give instead
  /// The value as on the command line if it changes what methods do, else nothing. Methods without
  /// the option refuse such a value. Null: they refuse only a value that the user gave, and ignore
  /// others.
  std::optional<std::string> (*unusual)(const RunOptions&) = nullptr;
  /// Why a method does not have the option; null: it "has no meaning" for the method.
  const char* (*why_not)(const Traits&) = nullptr;
  /// Copies the value; only for options of a form (docs/methods.md, "Forms of CULLIDE").
  void (*copy)(const RunOptions& from, RunOptions& to) = nullptr;
  /// The value for records; null: the record has it elsewhere.
  OptionValue (*value)(const RunOptions&) = nullptr;
  /// True: the option says how to draw, so it is null in the record of a run that drew nothing.
  bool of_drawing = false;
  std::vector<std::string> words = {};  // words that a shell completes, if not listed by `type`
};

/// All options, in the order of the help.
std::span<const Option> run_options();
/// The option with this name. Precondition: there is one.
const Option& run_option(std::string_view name);
/// The option as a word of a command line, as in --depth-format, or one of the commands that
/// messages name, as in "farcull doctor"; empty for other names. For spell_parameters().
std::string option_word(const std::string& name);

/// Options that a user gave, by their names; a flag's value is "".
using GivenOptions = std::map<std::string, std::string, std::less<>>;

/// Reads the value of an option into `options`. Throws Error naming it.
void take_option(std::string_view name, const std::string& text, RunOptions& options);
/// Reads all given options that RunOptions holds, then validates. Throws Error naming the option
/// that is bad.
RunOptions read_options(const GivenOptions& given, RunOptions options = {});
/// Throws Error for an option whose value is out of its range, for options that do not go together,
/// and for an option that was given or has an unusual value but that the method does not have.
/// Opens no device.
void validate(const RunOptions& options, const GivenOptions& given = {});

/// A whole number of pixels, 1 or more. Throws Error naming `option`.
int parse_resolution(const std::string& text, const std::string& option = "{resolution}");
/// "published", "budget" or a factor on the budget radius (0 to 100000). Throws Error naming
/// radius.
RadiusRule parse_radius(const std::string& text);
/// A number of runs, 1 or more. Throws Error naming repeat.
int parse_repeat(const std::string& text);

/// Whether a device is the cores of the CPU: "native", or its other name "cpu".
inline bool is_cpu(const std::string& device) { return device == "native" || device == "cpu"; }
inline constexpr const char* kDeviceHelp =
    "native (alias cpu: the cores of the CPU, no GPU), gl,\n"
    "software, hardware or a number that `farcull doctor`\n"
    "lists; default GL where hardware answers and keeps the\n"
    "assumptions, else native";

/// The value that was given, else the default.
int resolution_of(const RunOptions& options);
std::string views_of(const RunOptions& options);
DepthMode depth_of(const RunOptions& options);
QueryMode query_of(const RunOptions& options);
/// True if the method guarantees to miss nothing: boxes and i-collide, and far at the budget radius
/// or more with fragment depth. For a run, the device must keep its assumptions as well.
bool guaranteed(const RunOptions& options);
/// The options of a form (docs/methods.md, "Forms of CULLIDE") that have unusual values, as on the
/// command line: "--rounds 1 --clear all"; empty if there are none.
std::string form_text(const RunOptions& options);
/// The options; those of a form that the method does not have are reset, so that one choice of
/// options serves several methods.
RunOptions with_fitting_form(RunOptions options);
/// "published", "budget", or the factor on the budget radius.
std::string radius_text(const RadiusRule& radius);
/// The method in words for messages, such as "cullide at 512 px, --rounds 1". not_drawn: why a
/// method that draws did not, in place of the resolution; empty if it did.
std::string describe(const RunOptions& options, const std::string& not_drawn = "");

/// Why the method was run, as "--method" or "no --method: boxes misses nothing, ...".
std::string method_reason(const RunOptions& options);

}  // namespace farcull
