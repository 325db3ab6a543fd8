// The few operations of a rasterizer that culling needs. There are three implementations: GL
// (core/gl/canvas/canvas.h), CPU (core/native/canvas.h), and a canvas that behaves as badly as the
// device assumptions allow (verify/worst_canvas.h).
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

/// Counts since the canvas was constructed. A canvas on the CPU leaves all counts 0.
struct CanvasWork {
  std::uint64_t passes = 0;         // calls of Canvas::run() with at least one step
  std::uint64_t draws = 0;          // draw calls
  std::uint64_t dispatches = 0;     // runs of compute programs
  std::uint64_t state_changes = 0;  // changes of program, target or depth test between steps
  std::uint64_t queries = 0;    // occlusion queries, and one query per pass that counts primitives
  std::uint64_t readbacks = 0;  // reports and queries that were read
  std::uint64_t waits = 0;      // waits for the device to finish its commands
  std::uint64_t uploaded_bytes = 0;    // bytes of elements and of draw lists
  std::uint64_t downloaded_bytes = 0;  // bytes of reports and queries
  std::uint64_t spans = 0;             // passes and uploads; the device may measure their times
  std::uint64_t timed = 0;             // spans whose time is known
  double device_ms = 0;                // sum of the known times, by the clock of the device

  /// Returns the sum of the times of all spans on the device, ms. Returns empty if there was no
  /// span, or if the time of a span is unknown.
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

/// How a primitive gets its depth. fragment: the primitive is a proxy parallel to the screen, and
/// the solid's shader function computes its entry and exit depths. fixed: the primitive is a
/// triangle, and its depth is interpolated from the corners.
enum class DepthMode { fragment, fixed };

/// The parameters of a solid: five vec4 that its shader function reads. The last three numbers are
/// 0, except in elements that the canvas itself draws at a fixed depth.
using Solid = std::array<std::array<float, 4>, 5>;

/// A convex quadrilateral (px, corners in cyclic order) and the solid that is seen through it.
struct Proxy {
  std::array<float, 8> corners;  // x, y of each corner
  Solid solid;
};

struct NativeJob;    // defined in core/native/canvas.h
struct NativeLines;  // defined in core/native/canvas.h

/// The shader function of a solid, one source for GLSL and C++ (core/base/glsl_shim.h):
///   bool solid_interval(vec2 c, vec4 s0, .. vec4 s4, out float entry, out float exit)
/// The function considers the line in depth direction through the pixel centre c. It returns false
/// if the line misses the solid. Otherwise [entry, exit] contains the line's part inside the solid.
/// The function widens this interval by a bound of its own rounding error.
struct SolidProgram {
  std::string name;
  std::string glsl;
  bool (*interval)(float cx, float cy, const Solid& solid, float& entry, float& exit) = nullptr;
  /// Computes solid_interval as the least accurate device that GLSL allows
  /// (core/base/glsl_worst.h). Returns false if some permitted rounding gives a miss. Otherwise
  /// sets the latest entry and the earliest exit.
  bool (*interval_worst)(float cx, float cy, const Solid& solid, float& entry,
                         float& exit) = nullptr;
  /// These two run solid_interval on this processor's vector lanes (core/native/canvas.h).
  /// draw_native draws proxies; lines_native computes the entries and exits of single lines.
  void (*draw_native)(const NativeJob& job) = nullptr;
  void (*lines_native)(const NativeLines& lines) = nullptr;
};

/// All corners of a proxy satisfy |x| <= bounds.x and |y| <= bounds.y (px), inside the viewport.
struct ProxyBounds {
  double x;
  double y;
};

/// The pixels of the window in which an element may have a fragment: [x0, x1) x [y0, y1), counted
/// from the window's lower left corner. Empty if x0 >= x1 or y0 >= y1.
struct PixelRange {
  std::uint16_t x0, x1, y0, y1;
};

/// Bounds of a proxy, known before the proxy is fitted to its triangle. For most proxies the bounds
/// suffice to show that drawing the proxy has no effect, or that the proxy is seen.
struct ProxyOutline {
  PixelRange range;         // pixels that the rectangle may cover, from its corners
  float nearest, farthest;  // px; bounds of all entries and exits of the proxy
  /// A pixel whose centre the proxy covers, and a depth (px) that is not behind the exit in this
  /// pixel (docs/budget.md, "The canvas on the CPU"). x = kNoPixel: no such pixel is known.
  std::uint16_t x, y;
  float depth;
};
constexpr std::uint16_t kNoPixel = 0xffff;

/// Triangles to fatten at once.
struct FattenBatch {
  const Scene* scene = nullptr;
  const std::uint32_t* items = nullptr;  // triangles
  std::size_t count = 0;
  const Window* window = nullptr;
  double radius = 0;  // px
  double reach = 0;   // px; pixel centres closer to a triangle's corner are covered; 0: unknown
  ProxyBounds bounds{};
  std::uint8_t* done = nullptr;  // per item: 1: its only proxy was made; 0: the item is not
                                 // drawable or has to be clipped to the region
  // One per item, valid only if `done` is 1. Either `out` or `outlines` is null.
  Proxy* out = nullptr;
  ProxyOutline* outlines = nullptr;
};

/// All elements that one view can draw: proxies (fragment) or triangles (fixed). Item i owns the
/// elements first[i] .. first[i + 1] - 1.
struct Drawables {
  DepthMode mode = DepthMode::fragment;
  std::vector<std::uint32_t> first{0};
  UninitializedVector<Proxy> proxies;            // fragment; if `fit` is null, one per element
  std::vector<std::array<float, 12>> triangles;  // fixed; x, y, z (px) and 0 for each corner
  std::vector<std::uint32_t> undrawable;         // items beyond the budget, without elements

  /// For canvases that fit proxies while drawing (Canvas::fits_proxies). Let s = sources[e]. If
  /// s >= kFitted, element e is proxies[s - kFitted]. Otherwise fit(batch) makes it from triangle
  /// s; the caller sets items, count, out and done of `batch`. Null: no sources and no outlines.
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

/// One element, drawn for a slot (the index of a result of the pass). kEverywhere is a quad over
/// the window at the nearest depth. This quad hides everything. It may be stored, but not tested.
struct Draw {
  std::uint32_t element;
  std::uint32_t slot;
};
constexpr std::uint32_t kEverywhere = 0xffffffff;

enum class Verb : std::uint8_t { ask, store };

/// A step of a pass: stores draws[first .. first + count - 1], or tests their visibility (ask).
struct Step {
  Verb verb;
  std::uint32_t first;
  std::uint32_t count;
};

/// Steps are drawn in order; the depth buffer is empty at first. A slot's draws are consecutive.
/// - store: each pixel keeps the nearest depth (the entry depth of a proxy).
/// - ask: a slot is seen if a fragment (exit depth of a proxy) is at the stored depth or behind it
///   (GEQUAL). In a pixel without a stored depth, no fragment is seen.
/// - touching = false: a fragment is seen only behind the stored depth (GREATER), as in S-CULLIDE.
///   Contacts at equal depth are not seen, so there is no guarantee.
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
  /// True if begin() accepts drawables whose proxies are not fitted yet (Drawables::fit).
  virtual bool fits_proxies() const { return false; }
  /// Later passes draw elements of `drawables`, which must exist until the next begin().
  virtual void begin(const Window& window, const Drawables& drawables) = 0;
  /// Returns for each slot 1 if it is seen and 0 if not. Throws Error unless every command of the
  /// pass is known to have run (assumption A7).
  virtual std::vector<std::uint8_t> run(const Pass& pass) = 0;
  /// Returns the depth (px) of `draws` in each pixel of the window: the nearest entry (store) or
  /// the farthest exit (ask). NaN: no fragment. Returns height rows of width values. If several
  /// fragments have the same mapped depth, any of their depths may be returned. Proxies only. For
  /// tests of lemmas and for pictures.
  virtual std::vector<float> samples(Verb /*verb*/, const std::vector<Draw>& /*draws*/) {
    throw std::logic_error("this canvas offers no samples");
  }
  /// Returns the depth buffer's value in each pixel of the window: the nearest entry (store) or the
  /// farthest exit (ask) of `draws`. Returns height rows of width values in [0, 1]. An empty pixel
  /// has 1 for store and 0 for ask. For tests of lemmas and for pictures.
  virtual std::vector<float> depths(Verb /*verb*/, const std::vector<Draw>& /*draws*/) {
    throw std::logic_error("this canvas offers no depths");
  }
  /// Returns the work of the device so far. On the CPU all counts are 0.
  virtual CanvasWork work() const { return {}; }
};

/// Returns the scale of a window's depth map. All code maps depths by the same float expression:
///   clamp(0.5 + z * scale, 0.25, 0.75)
/// The clear value 1 is farther. Fixed depths are 0 (kEverywhere) or above 0.75 (control items).
inline float depth_scale(const Window& window) {
  const double reach = std::max(std::abs(window.lo[2]), std::abs(window.hi[2])) + 2;
  return static_cast<float>(0.25 / reach);
}
/// Returns the largest step of a depth buffer in px.
inline double depth_step(const Window& window, [[maybe_unused]] int depth_bits) {
  // Mapped depths are in [1/4, 3/4]. The coarsest step of a 32-bit float there is 2^-24, as for 24
  // bits of fixed point.
  return 0x1p-24 / depth_scale(window);
}
/// Returns a bound, in units of 2^-24, for the difference between a depth read from a buffer and
/// the exact 0.5 + z * scale, in any rounding mode. The product is at most 1/4 and errs by at most
/// 2^-25. The sum is below 1 and errs by at most 2^-24. A buffer of 24 bits adds at most
/// 1 / (2^24 - 1) when it stores a depth, and 2^-24 when the depth is read back as a float.
inline double depth_rounding(int depth_bits) {
  return depth_bits == 24 ? 0.5 + 1 + 0x1p24 / (0x1p24 - 1) + 1 : 0.5 + 1;
}

/// Slack of visibility tests on GL, four units of 2^-24: a proxy is tested this far behind the
/// mapped depth of its exit. docs/budget.md, "Two programs", derives the slack; farcull_proofs
/// (depth.behind) proves it. One program stores depths and another program tests them. The two
/// programs may round the depth map in different directions, and may convert a depth to different
/// 24-bit neighbours. With the slack, a proxy with entry <= exit is still seen. 3/4 plus the slack
/// is below 1, the value of an empty pixel. The canvas's own items have fixed depths and need no
/// slack. The native canvas needs none, because one function rounds all its depths to nearest.
constexpr float kAskedBehind = 4 * 0x1p-24f;

// ---- questions to a kernel and its answers, wherever it runs: on a device or on the CPU.
// verify/kernel_check.h decides which answers are right.

/// A solid, and the line in depth direction through a pixel centre (px).
struct SolidCase {
  float cx, cy;
  Solid solid;
};
/// The result of solid_interval (SolidProgram) for a SolidCase. Without a hit, entry and exit are
/// meaningless.
struct SolidAnswer {
  bool hit;
  float entry, exit;
};

}  // namespace farcull
