// A study is a declared grid of points. Each point is measured independently, in any order and on
// any machine, so that a study can be interrupted, resumed and divided among machines. The result
// of a point is a structure, stored as a row. The fields of the structure have the names of the
// counts in the row. An empty optional is left out of the row.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/fields.h"
#include "experiments/measure/bench.h"
#include "experiments/measure/neighbour_sets.h"
#include "experiments/studies/point.h"

namespace farcull {

class MeasurementContext;

// ---- the result of a point ----

/// Pairs of a scene of ContactCells whose contact depends on ContactCells::value.
struct VaryingCounts {
  std::uint64_t varying = 0, missed_varying = 0;  // colliding pairs; missed pairs
  FARCULL_FIELDS(varying, missed_varying)
};

/// An answer compared with the truth of its scene (measure/harness.h).
struct AnswerCounts {
  std::uint64_t colliding = 0, missed = 0;  // pairs
  std::uint64_t missed_triangles = 0;       // colliding triangles in no pair of the answer
  std::uint64_t candidates = 0;             // pairs given to exact tests
  std::uint64_t triangles = 0, objects = 0;
  std::optional<VaryingCounts> varying = {};
};

/// Counts of the work of a method that draws.
struct DrawnCounts {
  std::uint64_t queries = 0, draws = 0, queries_saved = 0, draws_saved = 0;
  FARCULL_FIELDS(queries, draws, queries_saved, draws_saved)
};
/// The ball's radius (px) and a pixel's size (world units) in the view with the largest budget.
struct RadiusCounts {
  double radius_px = 0, pixel_size = 0;
  FARCULL_FIELDS(radius_px, pixel_size)
};
/// Fragments of one drawing of FAR (Fragments in run_point.h).
struct FragmentCounts {
  std::uint64_t elements = 0, covered = 0, fragments = 0;
  FARCULL_FIELDS(elements, covered, fragments)
};

/// The resolution that was chosen for a RunPoint by the size of its triangles.
struct SizeCounts {
  std::uint64_t resolution = 0;  // px
  double mean_pixels = 0;        // mean number of pixels that a triangle covers at this resolution
  FARCULL_FIELDS(resolution, mean_pixels)
};

/// Candidate pairs that are neighbours (verify/exact.h), and the colliding pairs among these
/// candidates (`neighbours`).
struct NeighbourCounts {
  std::uint64_t neighbour_candidates = 0, neighbours = 0;
  FARCULL_FIELDS(neighbour_candidates, neighbours)
};

/// Counts of a RunPoint.
struct RunCounts : AnswerCounts {
  std::uint64_t missed_penetrating = 0;  // missed pairs that penetrate (verify/contact.h); the
                                         // other missed pairs touch
  /// Pairs that the same run misses with 0.9 times the budget radius (at_risk) and without a ball
  /// (at_risk_bare). Empty: not measured. If both counts are 0, a run without misses says nothing
  /// about the radius.
  std::optional<std::uint64_t> at_risk = {}, at_risk_bare = {};
  std::uint64_t left_by_boxes = 0;  // triangles that tests of boxes did not cull
  std::uint64_t views_used = 0;     // views that were drawn; 0: tests of boxes alone decided
  std::uint64_t colliding_triangles = 0;
  std::uint64_t kept_triangles = 0, kept_objects = 0;
  bool promises = false;  // true: the run is guaranteed to miss no pair
  /// True if the device breaks the assumptions of the method's guarantee; otherwise empty.
  std::optional<bool> revoked = {};
  std::string scene_hash = {};
  std::optional<std::uint64_t> object_triangles = {};  // only for i-collide
  std::optional<DrawnCounts> drawn = {};
  std::optional<RadiusCounts> radius = {};
  std::optional<FragmentCounts> fragments = {};
  std::optional<SizeCounts> size = {};
  std::optional<NeighbourCounts> neighbours = {};
  FARCULL_FIELDS(colliding, missed, missed_penetrating, colliding_triangles, missed_triangles,
                 candidates, kept_triangles, kept_objects, triangles, objects, promises, scene_hash,
                 revoked, left_by_boxes, views_used, at_risk, at_risk_bare, object_triangles, drawn,
                 radius, fragments, size, neighbours, varying)
};

/// Counts of a PeerPoint.
struct PeerCounts : AnswerCounts {
  std::uint64_t wrong = 0;  // reported pairs that do not collide
  std::optional<std::uint64_t> colliding_triangles = {};
  std::optional<std::string> library = {};  // name and version
  std::optional<bool> promises = {};
  std::optional<std::string> scene_hash = {};
  FARCULL_FIELDS(colliding, missed, wrong, colliding_triangles, missed_triangles, candidates,
                 triangles, objects, library, promises, scene_hash, varying)
};

/// Counts of a LemmaPoint (lemma/lemma.h, LemmaRow).
struct LemmaCounts {
  std::uint64_t points = 0, violations = 0, no_sample = 0, not_bounding = 0, rounded = 0;
  double largest_px = 0, largest_steps = 0;
  double step_px = 0;  // step of the depth buffer, px
  double radius_px = 0, budget_px = 0;
  bool promises = false;             // true with fragment depth and the budget radius or more
  std::optional<bool> revoked = {};  // as in RunCounts
  FARCULL_FIELDS(points, violations, no_sample, not_bounding, rounded, largest_px, largest_steps,
                 step_px, radius_px, budget_px, promises, revoked)
};

/// The placements at which the published radius may miss a pair. In one of the views x, y and z
/// - the distance |x| + |y| of the contact from a corner of the pixels is at most corner_px, and
/// - the rectangles of both triangles are turned from a diagonal of the pixels by at most the angle
/// whose cosine is corner_cosine.
/// placements.cpp derives the two limits. The stratum's probability, the sum over the views, is
/// 3 * 2 corner_px^2 (acos(corner_cosine) / 45 degrees)^2.
struct CornerStratum {
  double corner_px = 0, corner_cosine = 0;
  FARCULL_FIELDS(corner_px, corner_cosine)
};

/// Counts of a PlacementPoint (run_point.h).
struct PlacementCounts {
  std::uint64_t placements = 0;
  std::uint64_t colliding_placements = 0;   // placements with a colliding pair
  std::uint64_t missed_placements = 0;      // placements with a missed pair
  std::uint64_t colliding = 0, missed = 0;  // pairs
  double largest_miss_px = 0;               // the longest intersection of a missed pair
  double radius_px = 0, budget_px = 0;
  bool promises = false;
  std::optional<CornerStratum> stratum = {};  // of the placements; empty: placed anywhere
  FARCULL_FIELDS(placements, colliding_placements, missed_placements, colliding, missed,
                 largest_miss_px, radius_px, budget_px, promises, stratum)
};

/// Counts of a point of the study "model": the misses of a method at several positions of the grid
/// of pixels, and the prediction of method/miss_model.h.
struct ForecastCounts {
  std::uint64_t colliding = 0, positions = 0;
  std::uint64_t missed_in_all = 0;                  // missed pairs, summed over the positions
  std::uint64_t missed_least = 0, missed_most = 0;  // missed pairs at one position
  double expected = 0, low = 0, high = 0;           // the prediction for one position
  std::uint64_t outside = 0;  // positions with a number of misses outside of [low, high]
  std::uint64_t triangles = 0;
  bool promises = false;
  std::string scene_hash;
  FARCULL_FIELDS(colliding, positions, missed_in_all, missed_least, missed_most, expected, low,
                 high, outside, triangles, promises, scene_hash)
};

/// Counts of a frame of the cloth, with every pair of triangles accounted for
/// (verify/accounting.h), and results of the simulation step to this frame (scenes/cloth/cloth.h).
struct ClothCounts {
  std::uint64_t colliding = 0;  // pairs, including neighbours and missed pairs
  std::uint64_t neighbours = 0, missed = 0, candidates = 0;  // pairs
  std::uint64_t neighbour_candidates = 0;  // candidates that are neighbours, which are never culled
  std::uint64_t kept_triangles = 0, triangles = 0;
  std::uint64_t accounted = 0, by_boxes = 0, by_predicates = 0;  // pairs
  // The next fields up to scene_hash are as in RunCounts.
  std::uint64_t left_by_boxes = 0, views_used = 0;
  std::optional<std::uint64_t> at_risk = {}, at_risk_bare = {};
  bool promises = false;
  std::optional<bool> revoked = {};
  std::string scene_hash;
  double kinetic = 0, total = 0, slack = 0;  // J
  double residual = 0;                       // N
  std::uint64_t iterations = 0;
  bool converged = false;
  FARCULL_FIELDS(colliding, neighbours, missed, candidates, neighbour_candidates, kept_triangles,
                 triangles, accounted, by_boxes, by_predicates, promises, scene_hash, kinetic,
                 total, slack, residual, iterations, converged, revoked, left_by_boxes, views_used,
                 at_risk, at_risk_bare)
};

constexpr int kSceneResolution = 512;  // px, for PixelCounts

/// The 10th, 50th and 90th percentile of the area of a triangle's image, in pixels, in the views x,
/// y and z at kSceneResolution. The area grows with the square of the resolution.
struct PixelCounts {
  double pixels_tenth = 0, pixels_half = 0, pixels_ninety = 0;
  FARCULL_FIELDS(pixels_tenth, pixels_half, pixels_ninety)
};

/// Counts of a scene without any method.
struct SceneCounts {
  std::uint64_t triangles = 0, objects = 0;
  std::uint64_t self_objects = 0;               // objects that are tested against themselves
  std::uint64_t colliding = 0, neighbours = 0;  // pairs; `colliding` without neighbours
  std::string scene_hash;
  std::optional<PixelCounts> pixels = {};  // empty: no two boxes of objects overlap
  FARCULL_FIELDS(triangles, objects, self_objects, colliding, neighbours, scene_hash, pixels)
};

/// Names and values of counts, in the order in which a store holds the counts.
using CountValue = std::variant<bool, std::uint64_t, double, std::string>;
using NamedCounts = std::vector<std::pair<std::string, CountValue>>;

/// Counts of a LibraryPoint, with the names of experiments/suite/ask.py. `missed` and `wrong` count
/// answers that are not the answers for closed triangles. Counts with `own_` in their names count
/// answers that differ from what the library's documentation guarantees. `scores` holds the counts
/// for each family, parameter and kind.
struct LibraryCounts {
  NamedCounts values = {};
};

/// Counts of a NeighbourPoint.
struct SetCounts {
  NeighbourSizes sizes;
  std::uint64_t triangles = 0, objects = 0;  // numbers in the scene
  std::uint64_t accounted = 0;  // pairs of triangles of different objects; the accounting
                                // (verify/distance_accounting.h) decided all of them
  bool promises = false;        // true: guaranteed to keep all nearest neighbours and nearest pairs
  std::string scene_hash;
  FARCULL_FIELDS(sizes, triangles, objects, accounted, promises, scene_hash)
};

/// Counts of a DistancePoint.
struct DistanceCounts {
  std::uint64_t asked = 0;  // distances that the question asks for
  DistanceErrors errors;    // errors by kind (measure/bench.h)
  std::uint64_t triangles = 0, objects = 0;
  std::uint64_t accounted = 0;  // as in SetCounts
  std::uint64_t wrong = 0;      // distances that are not the nearest double, or were not asked for
  bool promises = false;        // true: guaranteed to give the double nearest to the truth
  std::string library = {};     // name and version
  std::string scene_hash;
  FARCULL_FIELDS(asked, errors, triangles, objects, accounted, wrong, promises, library, scene_hash)
};

/// std::monostate: nothing was measured.
using Counts = std::variant<std::monostate, RunCounts, PeerCounts, LemmaCounts, PlacementCounts,
                            ForecastCounts, ClothCounts, SceneCounts, LibraryCounts, SetCounts,
                            DistanceCounts>;

/// Returns the names and values of counts. The fields of a member replace the member.
NamedCounts to_columns(const Counts& counts);

/// Times in milliseconds. Times differ between runs.
struct PointTimes {
  std::optional<double> build = {};  // the time to build a library's hierarchies
  std::optional<double> cull = {}, exact = {};
  std::optional<double> total = {};  // the whole run without `setup`
  std::optional<double> setup = {};
  FARCULL_FIELDS(build, cull, exact, total, setup)
};

/// The result of one run of a point.
struct PointResult {
  Counts counts = {};  // bitwise equal in all runs on one device; if the device is "native" or
                       // "cpu", bitwise equal on all machines
  PointTimes times = {};
  std::uint64_t answer = 0;   // hash of the pairs, to compare runs; not stored
  std::string device = {};    // the GL renderer that drew, "native" (the native canvas drew), or
                              // "cpu" (nothing was drawn)
  std::string left_out = {};  // why nothing was measured (a library that this build lacks, a
                              // resolution beyond the device); empty: the point was measured
};

/// A PointResult as a row of a store. Rows of other versions of farcull may have other counts.
struct Measurement {
  nlohmann::ordered_json counts = nlohmann::ordered_json::object();
  nlohmann::ordered_json times = nlohmann::ordered_json::object();
  std::string device;
  std::string left_out = {};
};
Measurement stored(const PointResult& result);

/// True if a guarantee is broken: `promises` is true and `missed`, `missed_pairs`, `wrong` or
/// `violations` is above 0, or a contestant did not answer a question.
bool breaks_promise(const Measurement& measurement);

struct GridChoice {
  bool quick = false;      // the small grid, for a first look and for tests
  std::uint64_t seed = 1;  // seed of random points; at least 1
  std::string suite = {};  // for the study "libraries": folder of a suite; empty: generated
  std::vector<std::string> contestants = {};  // for the study "libraries"; empty: all
};

struct Study {
  std::string name;
  std::string title;     // one line
  std::string question;  // one or two sentences
  /// Returns the points, each once. Points of one scene are adjacent, except in a campaign. Equal
  /// choices give equal grids on every machine and in every build.
  std::function<std::vector<Point>(const GridChoice&)> grid;
  /// Measures a point. Throws Error for faults of the device or the machine. The point then fails,
  /// and a later run measures the point again.
  std::function<PointResult(const Point&, MeasurementContext&)> measure;
  /// Returns the library that would measure the point now, with its version, as in "CGAL 5.5.1".
  /// This is the count `library` in the point's row. Returns "" if no library measures the point,
  /// or if the library is missing. Null: no point of this study uses a library.
  std::function<std::string(const Point&)> library = {};
  /// True if RunPoints have exactly the counts of measure_run(). Then studies can share rows.
  bool plain = false;
  /// True for a campaign, which is not part of `all`. A campaign takes many hours, needs what most
  /// machines lack, or has its own page of results. The grid of a campaign may alternate between
  /// scenes, so that a campaign that ends early has results for all scenes.
  bool campaign = false;
};

/// Returns all studies, in the order of docs/experiments.md.
const std::vector<Study>& studies();
/// Returns the studies of `farcull experiment all`: all studies except campaigns.
std::vector<Study> studies_of_all();
/// Returns the study with this name. Throws Error naming all studies if there is none.
const Study& study_named(const std::string& name);
/// Throws Error naming all contestants if no contestant of the study "libraries" has this name.
void require_contestant(const std::string& name);

/// Returns the study reduced to points whose result may depend on the device: methods that draw,
/// placed pairs without subpixel bits, and the lemma experiment on a device.
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
