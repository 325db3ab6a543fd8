// The options of a run, as a struct and as a table.
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

/// The method if the user names no method. It guarantees that no pair is missed. On most scenes it
/// is the fastest method (docs/bench.md).
inline constexpr Method kDefaultMethod = Method::boxes;

/// How much contact detail to report (verify/contact.h). segments: the kind of contact of each
/// pair, and the common points of its triangles.
enum class ContactDetail : std::uint8_t { none, kinds, segments };

/// Which boxes decide what is drawn. objects: as published, a triangle is drawn if its box overlaps
/// the box of another object. triangles: a triangle is drawn if its box overlaps the box of a
/// triangle of another object.
enum class BroadPhase : std::uint8_t { objects, triangles };

struct RunOptions {
  Method method = kDefaultMethod;
  bool method_is_default = false;       // true: the user did not name a method
  int resolution = 0;                   // px along the larger side of a view's window; 0: 512
  RadiusRule radius = {};               // only for the method far
  std::string offset = "obb";           // only for the method far
  std::optional<DepthMode> depth = {};  // default: fragment for far, fixed for the CULLIDE family
  DepthFormat depth_format = DepthFormat::float32;
  std::optional<QueryMode> query = {};                      // default: query_of()
  std::optional<std::vector<std::uint32_t>> clusters = {};  // default: usual_clusters()
  // Variants of the methods that draw (docs/methods.md, "Forms of CULLIDE").
  int rounds = 0;                    // maximum number of rounds; 0: stops after a round that
                                     // changes nothing, or for far after a view that culls little
  ClearRule clear = ClearRule::any;  // how many views must find a triangle fully visible
  bool objects_alone = false;        // true: culls only whole objects; not for s-cullide
  bool conservative = false;         // true: conservative rasterization; not for far
  BroadPhase broad_phase = BroadPhase::objects;  // not for s-cullide
  std::string views = {};                        // viewing directions; "": x,y,z
  std::string device = {};  // value of --device (kDeviceHelp); "": GL if a hardware device answers,
                            // else the cores of the CPU
  double clearance = 0;     // largest distance that counts as colliding; world units
  bool verify = true;
  bool neighbours = true;  // false: triangles of one object that share a vertex index are not
                           // tested
  std::vector<ObjectPair> ignored = {};  // pairs of objects not to test; sorted by in_order()
  std::uint64_t limit = 0;  // maximum number of colliding pairs, neighbours included; 0: all
  ContactDetail contacts = ContactDetail::none;
  bool full = false;          // true: runs all stages, even stages that the scene does not need
  bool no_shortcuts = false;  // true: far draws all views, so that radii can be compared
  std::optional<std::uint64_t> seed = {};  // seed of a random scene; empty: the scene is not random
  // The value of a new option goes here.
};

/// The value of an option in a JSON record. std::monostate stands for null.
using OptionValue = std::variant<std::monostate, bool, int, double, std::string>;

/// An option that a user gives by name. A table of options determines the command line with its
/// help and completion, the keywords in Python, and the options in records.
struct Option {
  const char* name;  // name of the parameter, such as depth_format (--depth-format in commands)
  const char* type;  // the value in the help text: "fragment|fixed"; "" for a flag
  std::string help;  // help text, with line breaks
  bool (*serves)(const Traits&);  // true for methods that accept the option
  /// Parses a value ("" for a flag). Returns false if the text is not a value of the option. May
  /// throw Error with a better message. Precondition: options.method is set. Null for an option
  /// about the scene, since the caller parses such an option.
  bool (*take)(const std::string& text, RunOptions& options) = nullptr;
  const char* kind = "";    // noun in the message about a bad value: "is no <kind>"
  const char* remedy = "";  // remedy in this message: what to give instead
  /// Returns the value as text if the value changes what methods do, else nothing. May be null. A
  /// method that does not accept the option throws Error if this function returns a value.
  std::optional<std::string> (*unusual)(const RunOptions&) = nullptr;
  /// Returns why a method does not accept the option. If null, the message is that the option "has
  /// no meaning" for the method.
  const char* (*why_not)(const Traits&) = nullptr;
  /// Copies the value. Null for options that are not listed in docs/methods.md, "Forms of CULLIDE".
  void (*copy)(const RunOptions& from, RunOptions& to) = nullptr;
  /// Returns the value for records. Null if another part of the record has the value.
  OptionValue (*value)(const RunOptions&) = nullptr;
  /// True if the option affects only drawing. Its value is null in records of runs without drawing.
  bool of_drawing = false;
  std::vector<std::string> words = {};  // values for shell completion, besides those in `type`
};

/// Returns all options, in the order of the help.
std::span<const Option> run_options();
/// Returns the option with this name. Precondition: the option exists.
const Option& run_option(std::string_view name);
/// Returns the name as on the command line: "--depth-format" for depth_format, "farcull doctor" for
/// doctor. Returns "" for an unknown name. An argument for spell_parameters().
std::string option_word(const std::string& name);

/// The options that a user gave: name and value. The value of a flag is "".
using GivenOptions = std::map<std::string, std::string, std::less<>>;

/// Parses the text of one option into `options`. Throws Error naming the option.
void take_option(std::string_view name, const std::string& text, RunOptions& options);
/// Parses the given options, then calls validate(). Throws Error naming the bad option.
RunOptions read_options(const GivenOptions& given, RunOptions options = {});
/// Throws Error if a value is out of range, or if options exclude each other. Throws Error if the
/// method does not accept an option that is in `given` or has an unusual value. Opens no device.
void validate(const RunOptions& options, const GivenOptions& given = {});

/// Reads an integer number of pixels, 1 or more. Throws Error naming `option`.
int parse_resolution(const std::string& text, const std::string& option = "{resolution}");
/// Reads "published", "budget" or a factor on the budget radius (0 to 100000). Throws Error naming
/// the option radius.
RadiusRule parse_radius(const std::string& text);
/// Reads a number of runs, 1 or more. Throws Error naming the option repeat.
int parse_repeat(const std::string& text);

/// True if `device` names the cores of the CPU.
inline bool is_cpu(const std::string& device) { return device == "native" || device == "cpu"; }
inline constexpr const char* kDeviceHelp =
    "native (alias cpu: the cores of the CPU, no GPU), gl,\n"
    "software, hardware or a number that `farcull doctor`\n"
    "lists; default GL where hardware answers and keeps the\n"
    "assumptions, else native";

// Each of the next four functions returns the option's value if it is set, else its default.
int resolution_of(const RunOptions& options);
std::string views_of(const RunOptions& options);
DepthMode depth_of(const RunOptions& options);
QueryMode query_of(const RunOptions& options);
/// True if the method guarantees to miss no pair: boxes, i-collide, and far with fragment depth and
/// at least the budget radius. The guarantee of far also requires a device that keeps the
/// assumptions (Promise in record.h).
bool guaranteed(const RunOptions& options);
/// Returns the options of docs/methods.md, "Forms of CULLIDE", that do not have their default
/// values, as in "--rounds 1 --clear all".
std::string form_text(const RunOptions& options);
/// Returns a copy in which those options of form_text() that the method does not accept have their
/// defaults. So the same options can be used for several methods.
RunOptions with_fitting_form(RunOptions options);
/// Returns "published", "budget", or the factor on the budget radius.
std::string radius_text(const RadiusRule& radius);
/// Returns a description such as "cullide at 512 px, --rounds 1". not_drawn: why nothing was drawn;
/// if not empty, this text replaces everything after the method's name.
std::string describe(const RunOptions& options, const std::string& not_drawn = "");

/// Returns why the method was chosen: "--method", or "no --method: boxes misses nothing, ...".
std::string method_reason(const RunOptions& options);

}  // namespace farcull
