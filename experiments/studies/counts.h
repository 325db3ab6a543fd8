// The result of a point: as structures, and as a row of the store. Fields have the names of the
// counts in the store; an empty optional is left out there.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/fields.h"
#include "experiments/measure/bench.h"
#include "experiments/measure/neighbour_sets.h"

namespace farcull {

/// Pairs of a scene of ContactCells whose contact varies with its number.
struct VaryingCounts {
  std::uint64_t varying = 0, missed_varying = 0;  // of `colliding` and `missed`
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

/// Work of a method that draws.
struct DrawnCounts {
  std::uint64_t queries = 0, draws = 0, queries_saved = 0, draws_saved = 0;
  FARCULL_FIELDS(queries, draws, queries_saved, draws_saved)
};
/// Radius and size of a pixel in the view with the widest budget.
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
  double mean_pixels = 0;        // mean number of pixels that a triangle covers at it
  FARCULL_FIELDS(resolution, mean_pixels)
};

/// How many candidates of a method are neighbours (verify/exact.h), and how many of these collide.
struct NeighbourCounts {
  std::uint64_t neighbour_candidates = 0, neighbours = 0;
  FARCULL_FIELDS(neighbour_candidates, neighbours)
};

/// Counts of a RunPoint.
struct RunCounts : AnswerCounts {
  std::uint64_t missed_penetrating = 0;  // of `missed` (verify/contact.h); the rest touches
  /// Pairs that the same run misses with 0.9 of its radius, and without a ball; empty: not
  /// measured. If both are 0, a run without misses says nothing about the radius.
  std::optional<std::uint64_t> at_risk = {}, at_risk_bare = {};
  /// Which stage culled: how many triangles boxes left to views or to a join, and how many views
  /// were drawn. If none was drawn, the boxes of triangles decided.
  std::uint64_t left_by_boxes = 0, views_used = 0;
  std::uint64_t colliding_triangles = 0;  // that truly collide
  std::uint64_t kept_triangles = 0, kept_objects = 0;
  bool promises = false;  // the method guarantees to miss nothing, by its options
  /// True if the method is guaranteed, but its device does not keep the assumptions; else empty.
  std::optional<bool> revoked = {};
  std::string scene_hash;
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
  std::optional<std::string> library = {};  // with its version
  std::optional<bool> promises = {};
  std::optional<std::string> scene_hash = {};
  FARCULL_FIELDS(colliding, missed, wrong, colliding_triangles, missed_triangles, candidates,
                 triangles, objects, library, promises, scene_hash, varying)
};

/// Counts of a LemmaPoint (lemma/lemma.h, LemmaRow).
struct LemmaCounts {
  std::uint64_t points = 0, violations = 0, no_sample = 0, not_bounding = 0, rounded = 0;
  double largest_px = 0, largest_steps = 0;
  double step_px = 0;  // of the depth buffer
  double radius_px = 0, budget_px = 0;
  bool promises = false;             // set with fragment depth and the budget radius or more
  std::optional<bool> revoked = {};  // as in RunCounts
  FARCULL_FIELDS(points, violations, no_sample, not_bounding, rounded, largest_px, largest_steps,
                 step_px, radius_px, budget_px, promises, revoked)
};

/// Where the published radius may miss a pair: in one of the views x, y and z the distance (|x| +
/// |y|) of the contact from a corner of the pixels is at most corner_px, and both rectangles are
/// turned from a diagonal by at most the angle of this cosine (placements.cpp derives both). The
/// probability is the sum over the views: 3 * 2 corner_px^2 (acos(corner_cosine) / 45 degrees)^2.
struct CornerStratum {
  double corner_px = 0, corner_cosine = 0;
  FARCULL_FIELDS(corner_px, corner_cosine)
};

/// Counts of a PlacementPoint (run_point.h).
struct PlacementCounts {
  std::uint64_t placements = 0;
  std::uint64_t colliding_placements = 0;   // with at least one colliding pair
  std::uint64_t missed_placements = 0;      // of these, those with at least one missed pair
  std::uint64_t colliding = 0, missed = 0;  // pairs
  double largest_miss_px = 0;               // the longest intersection of a missed pair
  double radius_px = 0, budget_px = 0;
  bool promises = false;
  std::optional<CornerStratum> stratum = {};  // from which placements were drawn; empty: from all
  FARCULL_FIELDS(placements, colliding_placements, missed_placements, colliding, missed,
                 largest_miss_px, radius_px, budget_px, promises, stratum)
};

/// Counts of a point of the study "model": a method that may miss, at several positions of the grid
/// of pixels, and the prediction of method/miss_model.h.
struct ForecastCounts {
  std::uint64_t colliding = 0, positions = 0;
  std::uint64_t missed_in_all = 0;                  // pairs, the sum over the positions
  std::uint64_t missed_least = 0, missed_most = 0;  // at one position
  double expected = 0, low = 0, high = 0;           // the prediction for one position
  std::uint64_t outside = 0;                        // positions whose misses are not in low .. high
  std::uint64_t triangles = 0;
  bool promises = false;
  std::string scene_hash;
  FARCULL_FIELDS(colliding, positions, missed_in_all, missed_least, missed_most, expected, low,
                 high, outside, triangles, promises, scene_hash)
};

/// Counts of a frame of the cloth with every pair of triangles accounted for (verify/accounting.h),
/// and results of the step to this frame (scenes/cloth/cloth.h).
struct ClothCounts {
  std::uint64_t colliding = 0, neighbours = 0, missed = 0;  // pairs; the first includes the others
  std::uint64_t candidates = 0;                             // pairs given to exact tests
  std::uint64_t neighbour_candidates = 0;                   // neighbours among them, never culled
  std::uint64_t kept_triangles = 0, triangles = 0;
  std::uint64_t accounted = 0, by_boxes = 0, by_predicates = 0;  // pairs
  std::uint64_t left_by_boxes = 0, views_used = 0;               // as in RunCounts
  std::optional<std::uint64_t> at_risk = {}, at_risk_bare = {};  // likewise
  bool promises = false;                                         // likewise
  std::optional<bool> revoked = {};                              // likewise
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

/// Pixels that a triangle covers at kSceneResolution in the views x, y and z (the area of its
/// image): the 10th, 50th and 90th percentile. They grow with the square of the resolution.
struct PixelCounts {
  double pixels_tenth = 0, pixels_half = 0, pixels_ninety = 0;
  FARCULL_FIELDS(pixels_tenth, pixels_half, pixels_ninety)
};

/// Counts of a scene without any method.
struct SceneCounts {
  std::uint64_t triangles = 0, objects = 0;
  std::uint64_t self_objects = 0;               // that are tested against themselves
  std::uint64_t colliding = 0, neighbours = 0;  // pairs; `colliding` without neighbours
  std::string scene_hash;
  std::optional<PixelCounts> pixels = {};  // empty: no two boxes of objects overlap
  FARCULL_FIELDS(triangles, objects, self_objects, colliding, neighbours, scene_hash, pixels)
};

/// The names and values of counts, in the order in which a store holds them.
using CountValue = std::variant<bool, std::uint64_t, double, std::string>;
using NamedCounts = std::vector<std::pair<std::string, CountValue>>;

/// Counts of a LibraryPoint, with the names of experiments/suite/ask.py. `missed` and `wrong`
/// count the answers that differ from those for closed triangles; names with `own_` count those
/// that differ from what the library's documentation guarantees. `scores` holds these counts
/// for each family, parameter and kind.
struct LibraryCounts {
  NamedCounts values = {};
};

/// Counts of a NeighbourPoint.
struct SetCounts {
  NeighbourSizes sizes;
  std::uint64_t triangles = 0, objects = 0;  // of the scene
  /// How many pairs of triangles of different objects the accounting of the exact answers decided:
  /// all of them (verify/distance_accounting.h).
  std::uint64_t accounted = 0;
  bool promises = false;  // to lose no nearest neighbour and no nearest pair of triangles
  std::string scene_hash;
  FARCULL_FIELDS(sizes, triangles, objects, accounted, promises, scene_hash)
};

/// Counts of a DistancePoint: the distances asked for, and the wrong ones by kind
/// (measure/bench.h).
struct DistanceCounts {
  std::uint64_t asked = 0;  // distances in the question
  DistanceErrors errors;
  std::uint64_t triangles = 0, objects = 0;
  std::uint64_t accounted = 0;  // as in SetCounts
  /// Distances that are not the nearest double, and distances that were not asked for.
  std::uint64_t wrong = 0;
  bool promises = false;     // that every distance is the nearest double
  std::string library = {};  // with its version
  std::string scene_hash;
  FARCULL_FIELDS(asked, errors, triangles, objects, accounted, wrong, promises, library, scene_hash)
};

/// std::monostate: nothing was measured.
using Counts = std::variant<std::monostate, RunCounts, PeerCounts, LemmaCounts, PlacementCounts,
                            ForecastCounts, ClothCounts, SceneCounts, LibraryCounts, SetCounts,
                            DistanceCounts>;

/// The names and values of counts. A member with fields is replaced by its fields.
NamedCounts to_columns(const Counts& counts);

/// Milliseconds; they differ between runs.
struct PointTimes {
  std::optional<double> build = {};  // of a library's hierarchies
  std::optional<double> cull = {}, exact = {};
  std::optional<double> total = {};  // without setup
  std::optional<double> setup = {};
  FARCULL_FIELDS(build, cull, exact, total, setup)
};

/// The result of one run of a point.
struct PointResult {
  Counts counts = {};  // the same on every run on the same device, bit for bit; on native and cpu
                       // the same on every machine
  PointTimes times = {};
  std::uint64_t answer = 0;   // a hash of the pairs, by which runs are compared; it is not stored
  std::string device = {};    // what answered: a renderer, "native" (the native canvas drew), or
                              // "cpu" (nothing was drawn)
  std::string left_out = {};  // why nothing was measured (a library that this build lacks, a
                              // resolution beyond the device); empty if it was measured
};

/// A JSON object that is copied like a value. A pointer hides it because <nlohmann/json.hpp> costs
/// up to a second of compile time per file: only files that use the contents include it.
class JsonObject {
 public:
  JsonObject();  // an empty object
  JsonObject(const JsonObject& other);
  JsonObject(JsonObject&& other) noexcept;  // `other` may then only be assigned to or destroyed
  JsonObject& operator=(const JsonObject& other);
  JsonObject& operator=(JsonObject&& other) noexcept;
  JsonObject& operator=(const nlohmann::ordered_json& value);
  ~JsonObject();

  nlohmann::ordered_json& operator*() { return *value_; }
  const nlohmann::ordered_json& operator*() const { return *value_; }
  nlohmann::ordered_json* operator->() { return value_.get(); }
  const nlohmann::ordered_json* operator->() const { return value_.get(); }
  /// As of nlohmann::ordered_json.
  nlohmann::ordered_json& operator[](const char* key);
  const nlohmann::ordered_json& operator[](const char* key) const;

 private:
  std::unique_ptr<nlohmann::ordered_json> value_;
};

/// A PointResult as a row of a store. Rows of other versions may have other names.
struct Measurement {
  JsonObject counts = {};
  JsonObject times = {};
  std::string device;
  std::string left_out = {};
};
Measurement stored(const PointResult& result);

/// True if a guarantee is broken: `promises` is true and `missed`, `missed_pairs`, `wrong` or
/// `violations` is above 0, or a contestant did not answer a question.
bool breaks_promise(const Measurement& measurement);

}  // namespace farcull
