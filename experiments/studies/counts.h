// The result of a point: as structures, and as a row of the store.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "experiments/measure/bench.h"
#include "experiments/measure/neighbour_sets.h"
#include "experiments/studies/json_object.h"

namespace farcull {

/// An answer compared with the truth of its scene (measure/lab.h).
struct AnswerCounts {
  std::uint64_t colliding = 0, missed = 0;  // pairs
  std::uint64_t missed_triangles = 0;       // colliding triangles that are in none of its pairs
  std::uint64_t candidates = 0;             // pairs given to exact tests
  std::uint64_t triangles = 0, objects = 0;
};

/// Work of a method that draws.
struct DrawnCounts {
  std::uint64_t queries = 0, draws = 0, queries_saved = 0, draws_saved = 0;
};
/// Radius and size of a pixel in the view with the widest budget.
struct RadiusCounts {
  double radius_px = 0, pixel_size = 0;
};
/// FAR: fragments of one drawing (fragments.h). FAR pairs: entries in the lists of pixels
/// (`fragments`), comparisons (`tests`) and the views that it looked with.
struct FragmentCounts {
  std::optional<std::uint64_t> elements = {}, covered = {};
  std::uint64_t fragments = 0;
  std::optional<std::uint64_t> tests = {}, views = {};
};

/// The resolution that was chosen for a RunPoint by the size of triangles.
struct SizeCounts {
  std::uint64_t resolution = 0;  // px
  double mean_pixels = 0;        // that a triangle covers there
};

/// Neighbours (verify/exact.h) among the candidates of a method, and those of them that collide.
struct NeighbourCounts {
  std::uint64_t candidates = 0, colliding = 0;
};

/// Counts of a RunPoint.
struct RunCounts : AnswerCounts {
  std::uint64_t missed_penetrating = 0;  // of `missed` (verify/contact.h); the rest touches
  /// Pairs that the same run misses with 0.9 of its radius; empty: not asked. Where there are none,
  /// that nothing was missed says nothing of the radius.
  std::optional<std::uint64_t> at_risk = {};
  std::uint64_t colliding_triangles = 0;  // of the truth
  std::uint64_t kept_triangles = 0, kept_objects = 0;
  bool promises = false;  // the method, by its options; a miss then breaks the promise
  bool revoked = false;   // it promises, and its device does not keep what the promise rests on
  std::string scene_hash;
  std::optional<std::uint64_t> object_triangles = {};  // of i-collide
  std::optional<DrawnCounts> drawn = {};
  std::optional<RadiusCounts> radius = {};
  std::optional<FragmentCounts> fragments = {};
  std::optional<SizeCounts> size = {};
  std::optional<NeighbourCounts> neighbours = {};
};

/// Counts of a PeerPoint.
struct PeerCounts : AnswerCounts {
  std::uint64_t wrong = 0;  // reported pairs that do not collide
  std::optional<std::uint64_t> colliding_triangles = {};
  std::string library = {};     // with its version; empty: not said
  std::string scene_hash = {};  // empty: not said; else `promises` is said as well
};

/// Counts of a LemmaPoint (lemma/lemma.h, LemmaRow).
struct LemmaCounts {
  std::uint64_t points = 0, violations = 0, no_sample = 0, not_bounding = 0, rounded = 0;
  double largest_px = 0, largest_steps = 0;
  double step_px = 0;  // of the depth buffer
  double radius_px = 0, budget_px = 0;
  bool promises = false;  // fragment depth at the budget radius or more: a violation breaks it
  bool revoked = false;   // as in RunCounts
};

/// Counts of a PlacementPoint (placements.h).
struct PlacementCounts {
  std::uint64_t placements = 0;
  std::uint64_t colliding_placements = 0;   // with at least one colliding pair
  std::uint64_t missed_placements = 0;      // of these, with at least one missed pair
  std::uint64_t colliding = 0, missed = 0;  // pairs
  double largest_miss_px = 0;               // the longest intersection of a missed pair
  double radius_px = 0, budget_px = 0;
  bool promises = false;
};

/// Counts of a frame of the cloth, with every pair of triangles accounted for
/// (verify/accounting.h), and what the step to it left (scenes/cloth/cloth.h).
struct ClothCounts {
  std::uint64_t colliding = 0, neighbours = 0, missed = 0;  // pairs; neighbours of the colliding
  std::uint64_t candidates = 0;                             // pairs given to exact tests
  std::uint64_t kept_triangles = 0, triangles = 0;
  std::uint64_t accounted = 0, by_boxes = 0, by_predicates = 0;  // pairs
  bool promises = false, revoked = false;                        // as in RunCounts
  std::string scene_hash;
  double kinetic = 0, total = 0, slack = 0;  // J
  double residual = 0;                       // N
  std::uint64_t iterations = 0;
  bool converged = false;
};

constexpr int kSceneResolution = 512;  // px, of PixelCounts

/// Pixels that triangles cover at kSceneResolution in the views x, y and z: the area of a
/// triangle's image. Of a tenth of them it is at most `tenth`, of half `half`, of nine tenths
/// `ninety`. At another resolution they are as the squares of the resolutions.
struct PixelCounts {
  double tenth = 0, half = 0, ninety = 0;
};

/// Counts of a scene by itself.
struct SceneCounts {
  std::uint64_t triangles = 0, objects = 0;
  std::uint64_t self_objects = 0;               // that are tested against themselves
  std::uint64_t colliding = 0, neighbours = 0;  // pairs, apart from each other
  std::string scene_hash;
  std::optional<PixelCounts> pixels = {};  // empty: no two boxes of objects overlap
};

/// Counts of a LibraryPoint (peers/score.h): pairs of triangles, of which `missed` and
/// `wrong` are measured by closed triangles, and `own_` by what the library's documentation
/// promises.
struct LibraryCounts {
  std::uint64_t asked = 0, answered = 0, missed = 0, wrong = 0;
  std::uint64_t own_asked = 0, own_missed = 0, own_wrong = 0;
  std::uint64_t refused = 0, unanswered = 0, crashed = 0, hung = 0, no_memory = 0;
  std::uint64_t not_asked = 0;             // not among `asked`: too many processes had ended badly
  std::uint64_t timed = 0;                 // answers of which `total` is the sum of times
  std::uint64_t twice = 0, differing = 0;  // asked a second time, and answered otherwise then
  std::uint64_t neighbours_left_out = 0;   // pairs that it is not made for
  bool promises = false;                   // as in RunCounts
  std::string library = {}, means = {}, call = {};  // as on its card
  std::string says = {}, source = {}, use = {};     // as on its card
  std::string reason = {};                          // of the first refusal or death
  std::string scores = {};                          // by kind and parameter: scores_text()
  /// IDs of the first pairs of their kind in the family.
  std::optional<std::uint64_t> first_missed = {}, first_wrong = {}, first_death = {};
  /// Minimized (peers/minimize.h) from the first of their kind about which the documentation
  /// promises the answer: the line of a pair with ID 0 (suite/writer.h); empty where there is none.
  std::string example_missed = {}, example_wrong = {}, example_death = {};
};

/// Counts of a NeighbourPoint.
struct SetCounts {
  NeighbourSizes sizes;
  std::uint64_t triangles = 0, all_objects = 0;  // of the scene
  /// All pairs of triangles of different objects: how many the accounting of the exact answers
  /// decided (verify/distance_accounting.h).
  std::uint64_t accounted = 0;
  bool promises = false;  // to lose no nearest neighbour and no nearest pair of triangles
  std::string scene_hash;
};

/// Counts of a DistancePoint: distances that are wrong in some way, of those asked for
/// (measure/bench.h).
struct DistanceCounts {
  DistanceErrors errors;
  std::uint64_t asked = 0;  // distances that the question has
  std::uint64_t triangles = 0, objects = 0;
  std::uint64_t accounted = 0;  // as in SetCounts
  bool promises = false;        // that every distance is the nearest double
  std::string library = {};     // with its version
  std::string scene_hash;
};

/// std::monostate: nothing was measured.
using Counts = std::variant<std::monostate, RunCounts, PeerCounts, LemmaCounts, PlacementCounts,
                            ClothCounts, SceneCounts, LibraryCounts, SetCounts, DistanceCounts>;

/// The names and values of counts, in the order in which a store holds them.
using CountValue = std::variant<bool, std::uint64_t, double, std::string>;
using NamedCounts = std::vector<std::pair<std::string, CountValue>>;
NamedCounts named(const Counts& counts);

/// Milliseconds, which no two runs share.
struct PointTimes {
  std::optional<double> build = {};  // of the hierarchies of a library
  std::optional<double> cull = {}, exact = {};
  std::optional<double> total = {};  // without setup
  std::optional<double> setup = {};
  std::optional<double> total_min = {}, total_max = {};  // of several runs
  std::vector<double> totals = {};                       // of several runs, each, in their order
};

/// The result of a point.
struct PointResult {
  Counts counts = {};  // the same on every run on the same device, bit for bit; those of methods on
                       // native and cpu are the same on every machine
  PointTimes times = {};
  std::string device = {};    // what answered: a renderer, "native" (the native canvas drew), or
                              // "cpu" (nothing was drawn)
  std::string left_out = {};  // why nothing was measured (a library that this build is without, a
                              // resolution beyond the device); empty: it was
};

/// The same as a row of a store holds it. Rows of other versions may have other names.
struct Measurement {
  JsonObject counts = {};
  JsonObject times = {};
  std::string device;
  std::string left_out = {};
};
Measurement stored(const PointResult& result);

/// True where a promise was not kept: `promises` is true and `missed`, `missed_pairs`, `wrong` or
/// `violations` above 0, or a contestant had no answer to a question.
bool breaks_promise(const Measurement& measurement);

}  // namespace farcull
