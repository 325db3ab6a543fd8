// A study: a declared grid of points. Each point is measured independently, in any order and on any
// machine, so that a study can be interrupted, resumed and divided among machines.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/studies/counts.h"
#include "experiments/studies/point.h"

namespace farcull {

class MeasurementContext;

/// Chooses the grid of a study.
struct GridChoice {
  bool quick = false;      // the small one, for a first look and for tests
  std::uint64_t seed = 1;  // seed of random points; at least 1
  std::string suite = {};  // of the study "libraries": the folder of a suite; empty: generated
  std::vector<std::string> contestants = {};  // of the same study: those to measure; empty: all
};

struct Study {
  std::string name;
  std::string title;     // one line
  std::string question;  // one or two sentences
  /// The points, each once. Points of one scene are together, except in a campaign. The same choice
  /// gives the same grid on every machine and in every build.
  std::function<std::vector<Point>(const GridChoice&)> grid;
  /// Throws Error for faults of the device or the machine: the point fails; a later run repeats it.
  std::function<PointResult(const Point&, MeasurementContext&)> measure;
  /// The library that would answer the point now, with its version, as in "CGAL 5.5.1": the value
  /// of the count `library` in its row. Empty: no library answers it, or the library is missing.
  /// Null: no point of this study asks a library.
  std::function<std::string(const Point&)> library = {};
  /// RunPoints have exactly the counts of measure_run(), so that studies can share their rows.
  bool plain = false;
  /// A campaign is not part of `all`: it takes many hours, needs what most machines lack, or has
  /// its own page of results. It may alternate between its scenes, so that an early stop has
  /// results for all of them.
  bool campaign = false;
};

/// All studies, in the order of docs/experiments.md.
const std::vector<Study>& studies();
/// The studies of `farcull experiment all`: no campaigns.
std::vector<Study> studies_of_all();
/// Throws Error naming the studies if none has that name.
const Study& study_named(const std::string& name);

/// The study reduced to points whose answer may depend on the device: methods that draw or choose
/// views, and the lemma experiment on a device.
Study on_devices(const Study& study);

/// The studies; each is defined in one of the .cpp files beside this one.
Study headline_study();
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
Study model_study();

}  // namespace farcull
