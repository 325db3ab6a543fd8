// A study: a declared grid of points. Every point is measured by itself, in any order and on any
// machine, so that a study can be interrupted, resumed and divided among machines.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/studies/counts.h"
#include "experiments/studies/point.h"

namespace farcull {

class Lab;

/// Which grid of a study.
struct GridChoice {
  bool quick = false;      // the small one, for a first look and for tests
  std::uint64_t seed = 1;  // what random points are drawn from; at least 1
  std::string suite = {};  // of the study "libraries": the folder of a suite; empty: it is made
  std::vector<std::string> contestants = {};  // of the same study: those to ask; empty: all
};

struct Study {
  std::string name;
  std::string title;     // a line
  std::string question;  // what it asks, a sentence or two
  /// The points, each once, in an order that keeps those of one scene together, but for a campaign.
  /// The same choice gives the same grid on every machine and in every build.
  std::function<std::vector<Point>(const GridChoice&)> grid;
  /// Throws Error for faults of the device or the machine: the run ends there, and can be resumed.
  std::function<PointResult(const Point&, Lab&)> measure;
  /// The library that would answer the point now, with its version, as in "CGAL 5.5.1": what the
  /// row of the point will hold as its count `library`. Empty: no library answers it, or the
  /// library is not here. Null: no point of this study asks a library.
  std::function<std::string(const Point&)> library = {};
  /// It takes many hours, needs what most machines have not, or has a page of results of its own,
  /// so it is not among `all`. Its scenes may take turns: what is measured after an hour is then of
  /// all of them.
  bool campaign = false;
};

/// All of them, in the order of docs/experiments.md.
const std::vector<Study>& studies();
/// Those of `farcull experiment all`: no campaigns.
std::vector<Study> studies_of_all();
/// Throws Error naming the studies where no study has that name.
const Study& study_named(const std::string& name);

/// The study with those of its points alone whose answer may depend on the device: those of methods
/// that draw or choose views, and of the lemma experiment on a device.
Study on_devices(const Study& study);

/// Each defined in a file of its own.
Study scenes_study();
Study accuracy_study();
Study error_time_study();
Study radius_study();
Study offsets_study();
Study precision_study();
Study stability_study();
Study efficiency_study();
Study scaling_study();
Study cloth_study();
Study culling_study();
Study libraries_study();
Study proximity_study();

}  // namespace farcull
