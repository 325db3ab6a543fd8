// A Canvas has the operations of a rasterizer that culling needs. There are three implementations:
// GL (core/gl/canvas/canvas.h), CPU (core/native/canvas.h), and one that is as inaccurate as the
// assumptions about devices allow (verify/worst_canvas.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/uninitialized.h"
#include "core/view/view.h"

namespace farcull {

/// Counts since the construction of the canvas. On a CPU canvas all counts are 0.
struct CanvasWork {
  std::uint64_t passes = 0;            // calls of Canvas::run() with at least one step
  std::uint64_t draws = 0;             // draw calls
  std::uint64_t dispatches = 0;        // runs of compute programs
  std::uint64_t state_changes = 0;     // changes of program, target or depth test between steps
  std::uint64_t queries = 0;           // occlusion queries, and one primitive-count query per pass
  std::uint64_t readbacks = 0;         // results read by the host: reports and queries
  std::uint64_t waits = 0;             // waits for the device to finish its commands
  std::uint64_t uploaded_bytes = 0;    // bytes of elements and of draw lists
  std::uint64_t downloaded_bytes = 0;  // bytes of reports and queries
  std::uint64_t spans = 0;             // intervals to be timed: one for each pass or upload
  std::uint64_t timed = 0;             // number of spans whose time is known
  double device_ms = 0;                // sum of the known times, by the device's clock

  /// Returns the sum of the device times of all spans, ms. Returns empty if there was no span, or
  /// if the time of some span is unknown.
  std::optional<double> known_ms() const {
    if (spans == 0 || timed < spans) return {};
    return device_ms;
  }
  /// Calls change(count, other.count) for each count.
  template <class Change>
  void for_each(const CanvasWork& other, const Change& change) {
    change(passes, other.passes);
    change(draws, other.draws);
    change(dispatches, other.dispatches);
    change(state_changes, other.state_changes);
    change(queries, other.queries);
    change(readbacks, other.readbacks);
    change(waits, other.waits);
    change(uploaded_bytes, other.uploaded_bytes);
    change(downloaded_bytes, other.downloaded_bytes);
    change(spans, other.spans);
    change(timed, other.timed);
    change(device_ms, other.device_ms);
  }
  CanvasWork& operator+=(const CanvasWork& other) {
    for_each(other, [](auto& mine, auto its) { mine += its; });
    return *this;
  }
  CanvasWork& operator-=(const CanvasWork& other) {
    for_each(other, [](auto& mine, auto its) { mine -= its; });
    return *this;
  }
};

/// How a primitive gets its depth. fragment: the primitive is a quadrilateral parallel to the
/// screen (Proxy), and a shader function computes entry and exit depths of a solid. fixed: the
/// primitive is a triangle, and its depth is interpolated from the corners.
enum class DepthMode { fragment, fixed };

/// The parameters of a solid: five vec4 for its shader function. The last three numbers are 0,
/// except in elements that the canvas itself adds, which have a fixed depth.
using Solid = std::array<std::array<float, 4>, 5>;

/// A convex quadrilateral (px, corners in cyclic order) that covers the pixels of a solid.
struct Proxy {
  std::array<float, 8> corners;  // x, y of each corner
  Solid solid;
};

struct NativeJob;    // defined in core/native/canvas.h
struct NativeLines;  // defined in core/native/canvas.h

/// The shader function of a solid, in one source text for GLSL and C++ (core/base/glsl_shim.h):
///   bool solid_interval(vec2 c, vec4 s0, .. vec4 s4, out float entry, out float exit)
/// The function intersects the solid with the line in depth direction through the pixel centre c.
/// The result is false if the line misses the solid. Otherwise the depths [entry, exit] contain the
/// intersection: the function widens the interval by a bound of its own rounding error.
struct SolidProgram {
  std::string name;
  std::string glsl;
  bool (*interval)(float cx, float cy, const Solid& solid, float& entry, float& exit) = nullptr;
  /// Simulates solid_interval on the least accurate device that GLSL allows
  /// (core/base/glsl_worst.h). Returns false if some permitted rounding gives a miss. Otherwise
  /// sets `entry` to the largest possible entry and `exit` to the smallest possible exit.
  bool (*interval_worst)(float cx, float cy, const Solid& solid, float& entry,
                         float& exit) = nullptr;
  /// draw_native draws proxies. lines_native computes the entries and exits of single lines. Both
  /// run solid_interval in vector instructions of the CPU (core/native/canvas.h).
  void (*draw_native)(const NativeJob& job) = nullptr;
  void (*lines_native)(const NativeLines& lines) = nullptr;
};

/// The corners of a proxy must satisfy |x| <= bounds.x and |y| <= bounds.y (px).
struct ProxyBounds {
  double x;
  double y;
};

/// A rectangle of pixels: [x0, x1) x [y0, y1), counted from the lower left corner of the window. An
/// element has fragments only in its range. The range is empty if x0 >= x1 or y0 >= y1.
struct PixelRange {
  std::uint16_t x0, x1, y0, y1;
};

/// Bounds of a proxy, computed without its corners and solid. For most proxies, the bounds already
/// show that drawing the proxy has no effect, or that the proxy is visible.
struct ProxyOutline {
  PixelRange range;         // all pixels that the proxy may cover
  float nearest, farthest;  // px; bounds of all entries and exits of the proxy
  /// A pixel whose centre the proxy covers, and a lower bound (px) of the exit depth in this pixel
  /// (docs/budget.md, "The canvas on the CPU"). x = kNoPixel: no such pixel is known.
  std::uint16_t x, y;
  float depth;
};
constexpr std::uint16_t kNoPixel = 0xffff;

/// Triangles to fatten in one call, and where to write their proxies or outlines.
struct FattenBatch {
  const Scene* scene = nullptr;
  const std::uint32_t* items = nullptr;  // indices of triangles of the scene
  std::size_t count = 0;
  const Window* window = nullptr;
  double radius = 0;  // px
  double reach = 0;   // px; a proxy covers pixel centres closer than this to a corner; 0: unknown
  ProxyBounds bounds{};
  std::uint8_t* done = nullptr;  // per item: 1: its proxy or outline was made; 0: the item is not
                                 // drawable or must be clipped to the region
  // One element per item, valid only if its `done` is 1. Either `out` or `outlines` is null.
  Proxy* out = nullptr;
  ProxyOutline* outlines = nullptr;
};

/// All elements that one view can draw: proxies (mode fragment) or triangles (mode fixed). Item i
/// (the i-th triangle to be tested) has the elements first[i] .. first[i + 1] - 1.
struct Drawables {
  DepthMode mode = DepthMode::fragment;
  std::vector<std::uint32_t> first{0};
  UninitializedVector<Proxy> proxies;            // mode fragment; one per element if `fit` is null
  std::vector<std::array<float, 12>> triangles;  // mode fixed; x, y, z (px) and 0 for each corner
  std::vector<std::uint32_t> undrawable;         // items without elements, beyond the error budget

  /// For canvases that make proxies while drawing (Canvas::fits_proxies). Let s = sources[e]. If
  /// s >= kFitted, element e is proxies[s - kFitted]. Else fit(batch) makes element e from triangle
  /// s; the caller first sets items, count, out and done. If `fit` is null, `sources` is empty.
  void (*fit)(const FattenBatch& batch) = nullptr;
  FattenBatch batch;
  UninitializedVector<std::uint32_t> sources;
  UninitializedVector<ProxyOutline> outlines;

  std::size_t items() const { return first.size() - 1; }
  std::size_t elements() const {
    if (mode == DepthMode::fixed) return triangles.size();
    return fit == nullptr ? proxies.size() : sources.size();
  }
};
constexpr std::uint32_t kFitted = 0x80000000;

/// Draws one element for a slot (the index of a result of the pass). The element kEverywhere is a
/// quad over the window at the nearest depth. It hides everything; it is only stored, never tested.
struct Draw {
  std::uint32_t element;
  std::uint32_t slot;
};
constexpr std::uint32_t kEverywhere = 0xffffffff;

enum class Verb : std::uint8_t { ask, store };

/// A step of a pass: stores the depths of draws[first .. first + count - 1], or tests them (ask).
struct Step {
  Verb verb;
  std::uint32_t first;
  std::uint32_t count;
};

/// Steps run in order, on a depth buffer that is empty at first. A slot's draws are consecutive.
/// - store: each pixel keeps the nearest depth. Proxies store their entry depths.
/// - ask: a slot is seen if one of its fragments is at the stored depth or behind it (GEQUAL).
///   Proxies use their exit depths. In a pixel without a stored depth, no fragment is seen.
/// - touching = false: a fragment is seen only behind the stored depth (GREATER), as in S-CULLIDE.
///   Contacts at equal depth are then missed, so culling gives no guarantee.
struct Pass {
  bool touching = true;
  std::uint32_t slots = 0;
  std::vector<Draw> draws;
  std::vector<Step> steps;
};

class Canvas {
 public:
  virtual ~Canvas() = default;
  virtual const RasterLimits& limits() const = 0;
  /// True if begin() accepts drawables whose proxies are not made yet (Drawables::fit).
  virtual bool fits_proxies() const { return false; }
  /// Selects the elements for later passes. `drawables` must exist until the next call of begin().
  virtual void begin(const Window& window, const Drawables& drawables) = 0;
  /// Runs the pass. Returns for each slot 1 if the slot is seen, else 0. Throws Error if a command
  /// of the pass may not have run (assumption A7 of docs/reliability.md).
  virtual std::vector<std::uint8_t> run(const Pass& pass) = 0;
  /// Returns the depth (px) of `draws` in each pixel of the window: the nearest entry (store) or
  /// the farthest exit (ask), or NaN if there is no fragment. Returns height rows of width values.
  /// If fragments are equal in the depth buffer, any of their depths may be returned. Proxies only.
  /// Used by tests of lemmas and for pictures.
  virtual std::vector<float> samples(Verb /*verb*/, const std::vector<Draw>& /*draws*/) {
    throw std::logic_error("this canvas offers no samples");
  }
  /// Returns the depth buffer's value in each pixel of the window: the nearest entry (store) or the
  /// farthest exit (ask) of `draws`. Returns height rows of width values in [0, 1]. An empty pixel
  /// has 1 for store and 0 for ask. Used by tests of lemmas and for pictures.
  virtual std::vector<float> depths(Verb /*verb*/, const std::vector<Draw>& /*draws*/) {
    throw std::logic_error("this canvas offers no depths");
  }
  /// Returns the work since the construction of the canvas.
  virtual CanvasWork work() const { return {}; }
};

/// Returns the scale of a window's depth map. All code maps a depth z (px) in floats to
///   clamp(0.5 + z * scale, 0.25, 0.75)
/// Other depths in the buffer are 0 (kEverywhere), above 0.75 (GL control items) and 1 (empty).
inline float depth_scale(const Window& window) {
  const double reach = std::max(std::abs(window.lo[2]), std::abs(window.hi[2])) + 2;
  return static_cast<float>(0.25 / reach);
}
/// Returns the largest distance (px) between neighbouring depths of a depth buffer.
inline double depth_step(const Window& window, [[maybe_unused]] int depth_bits) {
  // Mapped depths are in [1/4, 3/4]. The coarsest step of a 32-bit float there is 2^-24. Fixed
  // point with 24 bits has about the same step.
  return 0x1p-24 / depth_scale(window);
}
/// Returns a bound, in units of 2^-24, for the difference between a depth read from a buffer and
/// the exact value of 0.5 + z * scale, in any rounding mode. The product is at most 1/4 and errs by
/// at most 2^-25. The sum is below 1 and errs by at most 2^-24. Storing a depth in 24 bits adds at
/// most 1 / (2^24 - 1). Reading a 24-bit depth as a float adds at most 2^-24.
inline double depth_rounding(int depth_bits) {
  return depth_bits == 24 ? 0.5 + 1 + 0x1p24 / (0x1p24 - 1) + 1 : 0.5 + 1;
}

/// The slack of visibility tests on GL: a proxy is tested this far behind the depth of its exit.
/// docs/budget.md, "Two programs", derives the slack; farcull_proofs (depth.behind) proves it. One
/// program stores depths and another program tests them. The two programs may round the depth map
/// in different directions, and may convert a depth to different 24-bit neighbours. With the slack,
/// a proxy with entry <= exit is still seen. 3/4 plus the slack is below 1, the depth of an empty
/// pixel. Elements that the canvas itself adds have fixed depths and need no slack. The CPU canvas
/// needs no slack, because one function rounds all its depths to nearest.
constexpr float kAskedBehind = 4 * 0x1p-24f;

// Inputs and outputs of solid_interval, for tests of the function on a device and on the CPU.
// verify/kernel_check.h decides which outputs are correct.

/// Input: a solid, and the pixel centre (px) through which the line in depth direction passes.
struct SolidCase {
  float cx, cy;
  Solid solid;
};
/// Output of solid_interval (SolidProgram) for a SolidCase. If `hit` is false, entry and exit are
/// meaningless.
struct SolidAnswer {
  bool hit;
  float entry, exit;
};

}  // namespace farcull
