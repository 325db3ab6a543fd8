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

/// The method if the user names no method. It misses nothing, and on most scenes it is the fastest
/// method (docs/bench.md).
inline constexpr Method kDefaultMethod = Method::boxes;

/// How much contact detail to report (verify/contact.h). segments: the kinds of contact, and the
/// common points of the triangles.
enum class ContactDetail : std::uint8_t { none, kinds, segments };

/// Which boxes decide what is drawn. objects: a triangle is drawn if its box meets the box of
/// another object, as published. triangles: a triangle is drawn if its box meets the box of another
/// object's triangle.
enum class BroadPhase : std::uint8_t { objects, triangles };

struct RunOptions {
  Method method = kDefaultMethod;
  bool method_is_default = false;       // true: the user named no method
  int resolution = 0;                   // px along the larger side of a view's window; 0: 512
  RadiusRule radius = {};               // far only
  std::string offset = "obb";           // far only
  std::optional<DepthMode> depth = {};  // default: fragment for far, fixed for the CULLIDE family
  DepthFormat depth_format = DepthFormat::float32;
  std::optional<QueryMode> query = {};                      // default: query_of()
  std::optional<std::vector<std::uint32_t>> clusters = {};  // default: usual_clusters()
  // Forms of the methods that draw (docs/methods.md, "Forms of CULLIDE").
  int rounds = 0;                    // largest number of rounds; 0: until a round changes nothing,
                                     // or for far, until a view culls little
  ClearRule clear = ClearRule::any;  // how many views have to clear a triangle
  bool objects_alone = false;        // culls only whole objects; not for s-cullide
  bool conservative = false;         // draws each pixel that a triangle touches; not for far
  BroadPhase broad_phase = BroadPhase::objects;  // not for s-cullide
  std::string views = {};                        // "": x,y,z (far: a sample orders them)
  std::string device = {};  // value of --device (kDeviceHelp); "": GL if a hardware device answers,
                            // else the cores of the CPU
  double clearance = 0;     // world units, finite, >= 0; boxes and exact only
  bool verify = true;
  bool neighbours = true;  // false: triangles of one object that share a vertex index are not
                           // tested
  std::vector<ObjectPair> ignored = {};  // pairs of objects not to test; sorted by in_order()
  std::uint64_t limit = 0;  // finds only this many colliding pairs, neighbours included; 0: all
  ContactDetail contacts = ContactDetail::none;
  bool full = false;          // run all stages, even stages that the scene does not need
  bool no_shortcuts = false;  // far draws as if it had no guarantee, to compare radii
  std::optional<std::uint64_t> seed = {};  // the seed of a random scene; empty: no random scene
  // The value of a new option goes here.
};

/// A value in a record. std::monostate stands for null.
using OptionValue = std::variant<std::monostate, bool, int, double, std::string>;

/// An option that a user gives by name. The table of options determines the command line, its help
/// and its completion, the keywords in Python, the options in records, and errors.
struct Option {
  const char* name;  // name of the parameter, such as depth_format (--depth-format in commands)
  const char* type;  // the value as the help shows it: "fragment|fixed"; "" for a flag
  std::string help;  // text of the help, in lines
  bool (*serves)(const Traits&);  // true for methods that have the option
  /// Reads a value ("" for a flag). Returns false if the text is no value of the option. May throw
  /// Error with a better message. Precondition: options.method is set. Null for an option about the
  /// scene; the caller reads such an option.
  bool (*take)(const std::string& text, RunOptions& options) = nullptr;
  const char* kind = "";    // the error for a bad value says that it "is no <kind>"
  const char* remedy = "";  // what the error says to give instead
  /// Returns the value as on the command line if it changes what methods do, else nothing. May be
  /// null. Methods without the option refuse such a value, and any value that the user gave.
  std::optional<std::string> (*unusual)(const RunOptions&) = nullptr;
  /// Returns why a method does not have the option. If null, the error is that the option "has no
  /// meaning" for the method.
  const char* (*why_not)(const Traits&) = nullptr;
  /// Copies the value. Null unless the option selects a form (docs/methods.md, "Forms of CULLIDE").
  void (*copy)(const RunOptions& from, RunOptions& to) = nullptr;
  /// Returns the value for records. Null if the record has the value elsewhere.
  OptionValue (*value)(const RunOptions&) = nullptr;
  /// True if the option is about drawing. Its value is null in the record of a run without drawing.
  bool of_drawing = false;
  std::vector<std::string> words = {};  // completed by a shell, besides those in `type`
};

/// Returns all options, in the order of the help.
std::span<const Option> run_options();
/// Returns the option with this name. Precondition: the option exists.
const Option& run_option(std::string_view name);
/// Returns the name as a command line has it: "--depth-format" for depth_format, "farcull doctor"
/// for doctor. Returns "" for an unknown name. spell_parameters() takes this function.
std::string option_word(const std::string& name);

/// Options that a user gave, by their names; a flag's value is "".
using GivenOptions = std::map<std::string, std::string, std::less<>>;

/// Reads the value of an option into `options`. Throws Error naming the option.
void take_option(std::string_view name, const std::string& text, RunOptions& options);
/// Reads the given options, then calls validate(). Throws Error naming the option that is bad.
RunOptions read_options(const GivenOptions& given, RunOptions options = {});
/// Throws Error if a value is out of range, if options exclude each other, or if the method does
/// not have an option that was given or that has an unusual value. Opens no device.
void validate(const RunOptions& options, const GivenOptions& given = {});

/// Reads an integer number of pixels, 1 or more. Throws Error naming `option`.
int parse_resolution(const std::string& text, const std::string& option = "{resolution}");
/// Reads "published", "budget" or a factor on the budget radius (0 to 100000). Throws Error naming
/// the option radius.
RadiusRule parse_radius(const std::string& text);
/// Reads a number of runs, 1 or more. Throws Error naming the option repeat.
int parse_repeat(const std::string& text);

/// True if the device is the cores of the CPU.
inline bool is_cpu(const std::string& device) { return device == "native" || device == "cpu"; }
inline constexpr const char* kDeviceHelp =
    "native (alias cpu: the cores of the CPU, no GPU), gl,\n"
    "software, hardware or a number that `farcull doctor`\n"
    "lists; default GL where hardware answers and keeps the\n"
    "assumptions, else native";

// Each of the next four functions returns the given value of an option, else the default.
int resolution_of(const RunOptions& options);
std::string views_of(const RunOptions& options);
DepthMode depth_of(const RunOptions& options);
QueryMode query_of(const RunOptions& options);
/// True if the method guarantees to miss no pair: boxes, i-collide, and far with fragment depth and
/// at least the budget radius. The guarantee of far also needs a device that keeps the assumptions
/// (Promise).
bool guaranteed(const RunOptions& options);
/// Returns the options that select a form (docs/methods.md, "Forms of CULLIDE") and are not at
/// their defaults, as in "--rounds 1 --clear all".
std::string form_text(const RunOptions& options);
/// Returns a copy in which each form option that the method lacks has its default. So the same
/// options can be used for several methods.
RunOptions with_fitting_form(RunOptions options);
/// Returns "published", "budget", or the factor on the budget radius.
std::string radius_text(const RadiusRule& radius);
/// Returns the method in words, such as "cullide at 512 px, --rounds 1". not_drawn: why nothing was
/// drawn; unless empty, this text replaces the resolution.
std::string describe(const RunOptions& options, const std::string& not_drawn = "");

/// Returns why the method was chosen: "--method" or "no --method: boxes misses nothing, ...".
std::string method_reason(const RunOptions& options);

}  // namespace farcull
