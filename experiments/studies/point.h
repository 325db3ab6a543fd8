// Defines the points of studies. Each kind of point has its own structure. PointKey has the columns
// that identify a point in a store.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/fields.h"
#include "experiments/measure/neighbour_sets.h"
#include "experiments/method/options.h"
#include "experiments/peers/peer.h"

namespace farcull {

/// A scene, given by its name on the command line.
struct NamedScene {
  std::string name;
};
/// A frame of a scene that moves. With more frames for the same motion, each step is smaller.
struct MotionFrame {
  std::string name;
  long frame = 0;
  long frames = 1;  // number of frames of the whole motion
};
/// A frame of the scene "cloth", in which the cloth is not tested against itself.
struct ClothApart {
  std::string name;
  long frame = 0;
};
/// Segments that cross near corners of pixels (pixel_corners() in run_point.cpp).
struct PixelCorners {};

/// Clusters of small objects in a large cube, drawn at random (clusters() in run_point.cpp).
struct ClusteredScene {
  int ratio = 64;  // side of the cube / side of a cluster
  std::uint64_t seed = 1;
};

/// A scene of contacts that depend on one number (contact_cells() in run_point.cpp).
struct ContactCells {
  std::string family;  // slivers, mixed, edge-on, overlap, gap, stack, offset or scale
  int side = 24;       // cells in a row; there are side * side cells
  std::string value;   // the number as text, from harmless to extreme, such as "1e6"
};

using PointScene =
    std::variant<NamedScene, MotionFrame, ClothApart, PixelCorners, ClusteredScene, ContactCells>;

/// The form of a method that draws. RunOptions explains the fields.
struct CullideForm {
  int rounds = 0;
  ClearRule clear = ClearRule::any;
  bool objects_alone = false;
  bool conservative = false;
  std::string views = {};
};

/// A run of a method of `farcull run` on a scene. The method chooses the value of an empty field.
struct RunPoint {
  PointScene scene;
  Method method = Method::far;
  std::string offset = {};                       // obb or exact; only for far
  std::optional<RadiusRule> radius = {};         // only for far
  std::optional<DepthMode> depth_mode = {};      // how a fragment gets its depth
  std::optional<DepthFormat> depth_format = {};  // how the depth buffer stores a depth
  int resolution = 0;  // px; 0: the method has no resolution, or mean_pixels chooses
  /// If above 0, the run has the lowest resolution at which triangles that may collide cover this
  /// many pixels on average (size_for() in run_point.cpp).
  double mean_pixels = 0;
  CullideForm form = {};
  int repeat = 1;  // number of timed runs (runs_of()); 1 for a MotionFrame
};

/// A run of a library in place of a method (peers/peer.h).
struct PeerPoint {
  PointScene scene;
  std::string peer;
  int repeat = 1;  // number of timed runs (runs_of())
};

/// The lemma experiment (lemma/lemma.h) with one generator at one radius.
struct LemmaPoint {
  std::string generator;     // one of lemma_generators()
  std::uint64_t points = 0;  // minimum number of tested points
  double depth = 256;        // depth of the window, px
  bool worst = false;  // true: on WorstCanvas (verify/worst_canvas.h), with corners displaced by
                       // the largest error of double arithmetic; false: on the device of the run
  RadiusRule radius = {};
  DepthMode depth_mode = DepthMode::fragment;  // fixed: boxes are drawn as surfaces
  /// The samples are depths as a buffer of this format stores them. Empty: depths as the shader
  /// computes them; with fixed depth, depths as the device's buffer stores them.
  std::optional<DepthFormat> depth_format = {};
  bool coarse = false;  // the samples are depths as a buffer of 16-bit fixed point stores them
  int side = 0;         // side of the window, px; 0: the generator chooses it
  std::uint64_t seed = 1;
};

/// FAR on many pairs of small patches of triangles that meet at random places (run_point.h).
struct PlacementPoint {
  std::string from;      // built-in scene; patches are cut from its first two objects
  bool grazing = false;  // a corner of one patch pokes through the other; false: patches cross
  bool pairs = false;    // each patch is one triangle, and the two triangles cross
  int widening = 0;  // only for pairs; 0: drawn anywhere; 1, 2 or 4: drawn from a CornerStratum of
                     // this multiple of the usual width
  double side = 1;   // px, mean longest side of a triangle
  std::uint64_t placements = 0;
  /// Corners of proxies are snapped to multiples of 2^-bits px. 0: they are not snapped, and pairs
  /// are drawn on the device of the run.
  int subpixel_bits = 0;
  RadiusRule radius = {};
  int resolution = 0;  // px
  std::uint64_t seed = 1;
};

/// A contestant (studies/libraries.cpp) and one kind of question of a suite.
struct LibraryPoint {
  std::string contestant = {};
  std::string question = "pair";  // as in docs/ask.md
  bool small = false;             // true: the small suite; false: the full suite
  std::uint64_t seed = 1;         // seed of the suite
  std::string suite = {};         // folder of the suite; empty: a suite is generated
  std::string suite_name = {};    // for a suite in a folder: the first digits of its checksum
};

/// A method that finds potential neighbours (measure/neighbour_sets.h).
struct NeighbourPoint {
  PointScene scene;
  NeighbourMethod method = NeighbourMethod::trees;
  int resolution = 0;   // cells of the diagram along the scene's longest side; 0: no diagram
  double widening = 1;  // factor of the reliable diagram; below 1: no guarantee
  int repeat = 1;       // number of timed runs (runs_of())
};

/// The distances of a scene, computed by farcull or by a library (peers/peer.h).
struct DistancePoint {
  PointScene scene;
  std::string contestant;  // "farcull", or the name of a peer
  DistanceTask task = DistanceTask::nearest;
  int repeat = 1;  // number of timed runs (runs_of())
};

using Point = std::variant<RunPoint, PeerPoint, LemmaPoint, PlacementPoint, LibraryPoint,
                           NeighbourPoint, DistancePoint>;

inline bool operator==(const RadiusRule& a, const RadiusRule& b) {
  return a.published == b.published && a.factor == b.factor;
}
inline auto operator<=>(const RadiusRule& a, const RadiusRule& b) {
  return std::pair(a.published, a.factor) <=> std::pair(b.published, b.factor);
}

/// The columns that identify a point in a store. A column that does not apply is empty, 0 or -1. No
/// two points of a grid have the same key.
struct PointKey {
  std::string scene = {};  // as on the command line, or as key_of() writes it
  /// The value of --method with the options of its form, as in "cullide --rounds 1", perhaps with
  /// the mean size of triangles, as in "@4px". For other kinds of points: a peer; "lemma",
  /// "lemma-worst" or "lemma-fixed16"; "far" or "far-snapped-8" for placements; a contestant,
  /// perhaps with its question, as in "cgal-aabb nearest"; "boxes", "trees", "voronoi" or
  /// "voronoi-reliable" for potential neighbours.
  std::string method = {};
  std::string offset = {};  // obb or exact
  std::optional<RadiusRule> radius = {};
  std::optional<DepthFormat> depth_format = {};
  std::optional<DepthMode> depth_mode = {};
  int resolution = 0;  // in px; in cells for "voronoi" and "voronoi-reliable"
  std::string views = {};
  long frame = -1;
  std::uint64_t seed = 0;

  auto operator<=>(const PointKey&) const = default;
  FARCULL_FIELDS(scene, method, offset, radius, depth_format, depth_mode, resolution, views, frame,
                 seed)
};

/// Returns a typed column as the store and tables write it, such as "0.9", "float32" or "fragment".
/// Returns "" if the column does not apply.
std::string column_text(const std::optional<RadiusRule>& radius);
std::string column_text(const std::optional<DepthFormat>& format);
std::string column_text(const std::optional<DepthMode>& mode);
/// Reads what column_text() wrote. Throws Error if no value is written as `text`.
template <class T>
std::optional<T> column_of(const std::string& text);

/// A timed point is measured in this many rounds (run_studies.h).
inline constexpr int kRounds = 3;
/// Returns the number of runs of the point in all rounds together. A point with at most 1 run is
/// not timed; it is run once, for its counts.
int runs_of(const Point& point);
inline bool is_timed(const Point& point) { return runs_of(point) > 1; }

PointKey key_of(const Point& point);
std::vector<PointKey> keys_of(const std::vector<Point>& points);

/// Returns the point in words, for progress and errors, such as "two-bunnies, cullide, 512 px".
std::string describe(const PointKey& key);
std::string describe(const Point& point);

/// The column `scene` of a LemmaPoint: lemma:GENERATOR:POINTS:DEPTH.
struct LemmaScene {
  std::string generator;
  std::uint64_t points = 0;
  double depth = 256;

  std::string name() const;
};
/// Reads what LemmaScene::name() wrote. Throws std::logic_error for any other text.
LemmaScene parse_lemma_scene(const std::string& text);

// The next functions return points for several studies. A point is timed only if `repeat` is set.

/// Returns a point of FAR with fragment depth in 32-bit float. offset: obb or exact.
inline RunPoint far_point(PointScene scene, const std::string& offset, const RadiusRule& radius,
                          int resolution) {
  return {.scene = std::move(scene),
          .method = Method::far,
          .offset = offset,
          .radius = radius,
          .depth_mode = DepthMode::fragment,
          .depth_format = DepthFormat::float32,
          .resolution = resolution};
}

/// Returns a point of CULLIDE or a variant, with the rasterizer's depth in 32-bit float.
inline RunPoint cullide_point(PointScene scene, Method method, int resolution,
                              const CullideForm& form = {}) {
  return {.scene = std::move(scene),
          .method = method,
          .depth_mode = DepthMode::fixed,
          .depth_format = DepthFormat::float32,
          .resolution = resolution,
          .form = form};
}

/// CULLIDE as published: one round.
inline const CullideForm kPublishedForm = {.rounds = 1};
/// The form of CULLIDE that misses the fewest pairs.
inline const CullideForm kStrictForm = {.rounds = 1, .clear = ClearRule::all, .conservative = true};

/// Returns the names of a randomly drawn scene with the first `count` of five seeds: the scene's
/// default seed, then 101 to 104.
inline std::vector<std::string> drawn_scenes(const std::string& name, int count = 5) {
  std::vector<std::string> out = {name};
  for (int i = 1; i < count; ++i) out.push_back(name + "@seed" + std::to_string(100 + i));
  return out;
}

/// Returns a point of a method that draws nothing: boxes, i-collide or exact.
inline RunPoint plain_point(PointScene scene, Method method) {
  return {.scene = std::move(scene), .method = method};
}

inline constexpr RadiusRule kBudgetRadius = {};
inline constexpr RadiusRule kPublishedRadius = {.published = true};

/// Returns the point with `repeat` timed runs. Precondition: `repeat` is a multiple of kRounds.
template <class OfPoint>
OfPoint repeated(OfPoint point, int repeat) {
  point.repeat = repeat;
  return point;
}

}  // namespace farcull
