// A study: a declared grid of points. Every point is measured by itself, in any order and on any
// machine, so that a study can be interrupted, resumed and divided among machines.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace farcull {

class Lab;

/// What is measured at a point. What does not apply is empty, 0 or -1; no two points of a grid are
/// equal.
struct Point {
  std::string scene;         // as on the command line, or a generator of triangles
  std::string method;        // as --method, a peer, or what draws by itself, such as "lemma"
  std::string offset;        // obb or exact
  std::string radius;        // as --radius
  std::string depth_format;  // float32 or fixed24
  std::string depth_mode;    // fragment or fixed
  int resolution = 0;        // px; 0: none, or chosen by the scene
  std::string views;         // "": the method's own
  long frame = -1;           // -1: the scene without frames
  std::uint64_t seed = 0;    // of what is random in the point; 0: nothing is

  auto operator<=>(const Point&) const = default;
};

/// "accuracy"-like names of the axes in the order of Point, for tables and the store.
const std::vector<std::string>& axis_names();
/// The values of a point as text, in that order; empty where the axis does not apply.
std::vector<std::string> axis_values(const Point& point);
/// In words, for progress and errors: "two-bunnies, cullide, 512 px".
std::string describe(const Point& point);

/// What came of a point.
struct Measurement {
  /// Numbers and texts that every run on the same device and CPU features gives again, bit for bit.
  nlohmann::ordered_json counts = nlohmann::ordered_json::object();
  /// Milliseconds, which no two runs share.
  nlohmann::ordered_json times = nlohmann::ordered_json::object();
  std::string device;         // what answered: a renderer, or "cpu"
  std::string left_out = {};  // why nothing was measured (a library that this build is without, a
                              // resolution beyond the device); empty: it was
};

/// Which grid of a study.
struct GridChoice {
  bool quick = false;      // the small one, for a first look and for tests
  std::uint64_t seed = 1;  // what random points are drawn from; at least 1
};

struct Study {
  std::string name;
  std::string title;     // a line
  std::string question;  // what it asks, a sentence or two
  /// The points, each once, in an order that keeps those of one scene together. The same choice
  /// gives the same grid on every machine and in every build.
  std::function<std::vector<Point>(const GridChoice&)> grid;
  /// Throws Error for faults of the device or the machine: the run ends there, and can be resumed.
  std::function<Measurement(const Point&, Lab&)> measure;
};

/// All of them, in the order of docs/experiments.md.
const std::vector<Study>& studies();
/// Throws Error naming the studies where there is none of that name.
const Study& study_named(const std::string& name);

/// Each defined in a file of its own.
Study accuracy_study();
Study error_time_study();
Study radius_study();
Study offsets_study();
Study precision_study();
Study stability_study();
Study efficiency_study();
Study scaling_study();

}  // namespace farcull
