// The points of studies: several kinds with their own fields, and the columns that identify a point
// in a store.
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

/// A scene as on the command line.
struct NamedScene {
  std::string name;
};
/// A frame of a scene that moves. With more frames for the same motion, each step is smaller.
struct MotionFrame {
  std::string name;
  long frame = 0;
  long frames = 1;  // of the whole motion
};
/// A frame of the scene "cloth", named with its numbers; the cloth is not tested against itself.
struct ClothApart {
  std::string name;
  long frame = 0;
};
/// Segments that cross next to corners of pixels (pixel_corners() in run_point.cpp).
struct PixelCorners {};

/// Clusters of small objects in a large cube, drawn at random (clusters() in run_point.cpp).
struct ClusteredScene {
  int ratio = 64;  // side of the cube / side of a cluster
  std::uint64_t seed = 1;
};

/// Contacts of a family in which one number goes to an extreme (contact_cells() in
/// contact_cells.cpp).
struct ContactCells {
  std::string family;  // slivers, mixed, edge-on, overlap, gap, stack, offset or scale
  int side = 24;       // cells in a row; there are side * side of them
  std::string value;   // the number, as in 1e6
};

using PointScene =
    std::variant<NamedScene, MotionFrame, ClothApart, PixelCorners, ClusteredScene, ContactCells>;

/// Options that choose the form of a method that draws, as in RunOptions.
struct CullideForm {
  int rounds = 0;
  ClearRule clear = ClearRule::any;
  bool objects_alone = false;
  bool conservative = false;
  std::string views = {};
};

/// A method of `farcull run`. If a field is empty, the method chooses its value.
struct RunPoint {
  PointScene scene;
  Method method = Method::far;
  std::string offset = {};                       // obb or exact; only for far
  std::optional<RadiusRule> radius = {};         // only for far
  std::optional<DepthMode> depth_mode = {};      // how a fragment gets its depth
  std::optional<DepthFormat> depth_format = {};  // how the depth buffer stores it
  int resolution = 0;                            // px; 0: none, or see mean_pixels
  /// If not 0, the resolution is the least one at which triangles that can take part cover this
  /// many pixels on average (size_for() in run_point.cpp).
  double mean_pixels = 0;
  CullideForm form = {};
  int repeat = 1;  // see runs_of(); 1 for a MotionFrame
};

/// A library in place of a method (peers/peer.h).
struct PeerPoint {
  PointScene scene;
  std::string peer;
  int repeat = 1;  // see runs_of()
};

/// The lemma experiment (lemma/lemma.h) with one generator at one radius.
struct LemmaPoint {
  std::string generator;     // one of lemma_generators()
  std::uint64_t points = 0;  // from this generator, at least
  double depth = 256;        // px, of the window
  bool worst = false;        // on verify/worst_canvas.h, displacing what is drawn as far as
                             // rounding in double may; else on the device of the run
  RadiusRule radius = {};
  DepthMode depth_mode = DepthMode::fragment;  // fixed: the boxes as surfaces
  /// The samples are what a buffer of this format stores. Empty: what the shader computes (with
  /// fixed depth, what the device's buffer stores).
  std::optional<DepthFormat> depth_format = {};
  bool coarse = false;  // the samples are what a buffer of 16-bit fixed point stores
  int side = 0;         // px, of the window; 0: the generator's own
  std::uint64_t seed = 1;
};

/// FAR on many small patches of triangles that are placed into each other at random (run_point.h).
struct PlacementPoint {
  std::string from;      // built-in scene; patches are cut from its first two objects
  bool grazing = false;  // a corner of one patch pokes through the other; else they cross
  bool pairs = false;    // patches of one triangle, which cross
  int widening = 0;  // of pairs: 0: drawn anywhere; 1, 2 or 4: drawn from a CornerStratum that is
                     // so many times as wide as the usual one
  double side = 1;   // px, mean longest side of a triangle
  std::uint64_t placements = 0;
  /// Corners of proxies are snapped to 2^-bits px; 0: not, and pairs are drawn on the device.
  int subpixel_bits = 0;
  RadiusRule radius = {};
  int resolution = 0;  // px
  std::uint64_t seed = 1;
};

/// A contestant (studies/libraries.cpp) and one kind of question of a suite.
struct LibraryPoint {
  std::string contestant = {};
  std::string question = "pair";  // as in docs/ask.md
  bool small = false;             // of the small suite; else of the full one
  std::uint64_t seed = 1;         // of the suite
  std::string suite = {};         // the folder of a given suite; empty: generated
  std::string suite_name = {};    // of a given suite: the beginning of its checksum
};

/// The potential neighbours that a method leaves (measure/neighbour_sets.h).
struct NeighbourPoint {
  PointScene scene;
  NeighbourMethod method = NeighbourMethod::trees;
  int resolution = 0;   // of a diagram, in cells; 0: the method has none
  double widening = 1;  // of the reliable diagram; below 1 there is no guarantee
  int repeat = 1;       // see runs_of()
};

/// The distances of a scene, by farcull or by a library (peers/peer.h).
struct DistancePoint {
  PointScene scene;
  std::string contestant;  // "farcull", or the name of a peer
  DistanceTask task = DistanceTask::nearest;
  int repeat = 1;  // see runs_of()
};

using Point = std::variant<RunPoint, PeerPoint, LemmaPoint, PlacementPoint, LibraryPoint,
                           NeighbourPoint, DistancePoint>;

inline bool operator==(const RadiusRule& a, const RadiusRule& b) {
  return a.published == b.published && a.factor == b.factor;
}
inline auto operator<=>(const RadiusRule& a, const RadiusRule& b) {
  return std::pair(a.published, a.factor) <=> std::pair(b.published, b.factor);
}

/// The columns that identify a point in a store. A column that does not apply is empty, 0 or -1; no
/// two points of a grid have the same key.
struct PointKey {
  std::string scene = {};  // as on the command line, or as key_of() writes it
  /// As --method with the options of its form ("cullide --rounds 1"), perhaps with the mean size of
  /// triangles ("@4px"); or a peer; "lemma", "lemma-worst", "lemma-fixed16"; of placements "far",
  /// "far-snapped-8"; a contestant, perhaps with its question ("cgal-aabb nearest"); of potential
  /// neighbours "boxes", "trees", "voronoi", "voronoi-reliable".
  std::string method = {};
  std::string offset = {};  // obb or exact
  std::optional<RadiusRule> radius = {};
  std::optional<DepthFormat> depth_format = {};
  std::optional<DepthMode> depth_mode = {};
  int resolution = 0;  // px; for "voronoi" and "voronoi-reliable" in cells
  std::string views = {};
  long frame = -1;
  std::uint64_t seed = 0;

  auto operator<=>(const PointKey&) const = default;
  FARCULL_FIELDS(scene, method, offset, radius, depth_format, depth_mode, resolution, views, frame,
                 seed)
};

/// A typed column as the store and tables write it, as in "0.9", "float32", "fragment"; "" if it
/// does not apply.
std::string column_text(const std::optional<RadiusRule>& radius);  // as --radius
std::string column_text(const std::optional<DepthFormat>& format);
std::string column_text(const std::optional<DepthMode>& mode);
/// The inverse for these three types. Throws Error if no value is written as `text`.
template <class T>
std::optional<T> column_of(const std::string& text);

/// In how many rounds a point is timed (run_studies.h).
inline constexpr int kRounds = 3;
/// The runs of the point in all rounds. At most 1: it is run once, for its counts, and not timed.
int runs_of(const Point& point);
inline bool is_timed(const Point& point) { return runs_of(point) > 1; }

PointKey key_of(const Point& point);
std::vector<PointKey> keys_of(const std::vector<Point>& points);

/// In words, for progress and errors: "two-bunnies, cullide, 512 px".
std::string describe(const PointKey& key);
std::string describe(const Point& point);

/// The column `scene` of a LemmaPoint: lemma:GENERATOR:POINTS:DEPTH.
struct LemmaScene {
  std::string generator;
  std::uint64_t points = 0;
  double depth = 256;

  std::string name() const;
};
/// Precondition: name() wrote the text; std::logic_error otherwise.
LemmaScene parse_lemma_scene(const std::string& text);

// Points that several studies use. They are not timed unless `repeat` is set.

/// FAR at a resolution, with fragment depth in 32 bits. offset: obb or exact.
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

/// A method of the CULLIDE family at a resolution, with the depth of the rasterizer in 32 bits.
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
/// The form that misses least.
inline const CullideForm kStrictForm = {.rounds = 1, .clear = ClearRule::all, .conservative = true};

/// A randomly drawn scene with the first `count` of the five seeds that are measured: the scene's
/// default seed, and 101 to 104.
inline std::vector<std::string> drawn_scenes(const std::string& name, int count = 5) {
  std::vector<std::string> out = {name};
  for (int i = 1; i < count; ++i) out.push_back(name + "@seed" + std::to_string(100 + i));
  return out;
}

/// A method that draws nothing: boxes, i-collide, exact.
inline RunPoint plain_point(PointScene scene, Method method) {
  return {.scene = std::move(scene), .method = method};
}

inline constexpr RadiusRule kBudgetRadius = {};
inline constexpr RadiusRule kPublishedRadius = {.published = true};

/// The same point, timed with `repeat` runs, a multiple of kRounds.
template <class OfPoint>
OfPoint repeated(OfPoint point, int repeat) {
  point.repeat = repeat;
  return point;
}

}  // namespace farcull
