// FAR pairs asks a device for the raw pairs of one view. Two implementations share one kernel
// (core/pairs/interval.glsl): threads of the CPU, which compile it as C++, and GL compute shaders
// (core/gl/pairs/pairs.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/glsl_shim.h"
#include "core/scene/scene.h"

namespace farcull {

/// A vertex in pixel space, x and y from the window's lower left corner; w is 0.
using PixelVertex = glsl::vec4;

/// A closed box of pixel space; w is 0. Empty where lo > hi on some axis.
struct PixelBox {
  glsl::vec4 lo;
  glsl::vec4 hi;
};

/// The depth of a window is cut into this many slices, one bit each.
constexpr int kSlices = 64;
/// A triangle whose bounds meet at most this many pixels has one interval, its whole depth, in all.
constexpr int kWholePixels = 16;
/// A pixel with more entries is crowded: it is cut into kSubdivision^2 sub-pixels, and each of them
/// again, up to kMaxLevel times, wherever that leaves at most half of the tests.
constexpr int kCrowded = 1024;
constexpr int kSubdivision = 8;
constexpr int kMaxLevel = 3;
/// A triangle that meets more pixels than this, and more than an eighth of the number of active
/// triangles, is large: compared with each of them directly.
constexpr int kLargePixels = 256;
inline float large_pixels(std::size_t active) {
  return std::max<float>(kLargePixels, 0.125f * static_cast<float>(active));
}

/// One view of the scene as a backend sees it.
struct PairTask {
  std::span<const PixelVertex>
      vertices;  // finite, |coordinate| <= 2^20 px, of the active triangles
  std::span<const std::array<std::uint32_t, 3>> triangles;  // of the scene
  std::span<const std::uint32_t> owners;                    // object of each triangle
  std::span<const std::uint8_t> self;                       // per object: tested against itself
  std::span<const PixelBox> limits;       // per object: contains every point it can share
  std::span<const std::uint32_t> active;  // ascending indices into triangles: those that take part
  bool neighbours = true;  // false: pairs of one object that share a vertex index may be left out
  int width = 0;           // px; pixel (i, j) is [i, i + 1] x [j, j + 1]
  int height = 0;          // px; 0 <= i < width, 0 <= j < height
  float near_px = 0;       // the depth range of the window, for the slices
  float far_px = 0;
  /// Work after which the answer is given up: pairs of intervals compared, pixels of triangles and
  /// entries of their lists, and large triangles times active ones.
  std::uint64_t most_tests = UINT64_MAX;
  /// Takes away pairs that the caller knows to be apart, so that lists that fill up stay short;
  /// null: the caller knows of no such pair. Called by several threads at once.
  std::function<void(std::vector<TrianglePair>&)> narrow = {};
  glsl::vec4 widening{};  // px per axis: every point of a triangle is within this of the
                          // triangle of its PixelVertex corners, up to float rounding
};

/// Work done, for stages and studies.
struct PairCounts {
  std::uint64_t listed = 0;      // triangles that met another owner's depth slices, per band
  std::uint64_t entries = 0;     // in the lists of pixels and sub-pixels
  std::uint64_t crowded = 0;     // pixels that were subdivided
  std::uint64_t large = 0;       // triangles compared directly instead of being listed
  std::uint64_t tests = 0;       // pairs of intervals compared
  std::uint64_t bands = 1;       // parts the window was split into
  std::uint64_t undrawable = 0;  // triangles that the view could not show: joined by boxes
  // On a GL device, else 0: kernels that were started, and waits for results to be read.
  std::uint64_t dispatches = 0, readbacks = 0;
  // How often the work was done again, since it needed more room than expected.
  std::uint64_t redone = 0;
  bool given_up = false;  // there is more work than PairTask::most_tests; no pairs
  double prepare_ms = 0;  // to pixel space
  double mark_ms = 0, list_ms = 0, pair_ms = 0;  // CPU: summed over threads
  // The three times by the clock of a GL device; negative if it has no clock, and on the CPU.
  double mark_device_ms = -1, list_device_ms = -1, pair_device_ms = -1;
};

class PairBackend {
 public:
  virtual ~PairBackend() = default;
  virtual std::string name() const = 0;  // "cpu" or the renderer
  /// Threads of the CPU that the rest of the work may use too; 0: as many as there are cores.
  virtual unsigned threads() const { return 0; }
  /// Pairs a < b (indices into task.triangles), sorted, each once: of different owners, or of one
  /// that is `self`. Pairs that task.narrow takes away may be missing. None where counts.given_up.
  /// Throws Error unless every command is known to have run (A7).
  virtual std::vector<TrianglePair> raw_pairs(const PairTask& task, PairCounts& counts) = 0;
};

/// The most pixels on a side of a window that the CPU back end takes.
constexpr int kMostCpuPixels = 32767;

/// threads: 0 for as many as there are cores. memory: bytes, about, that the masks and lists of one
/// part of the window may take in each thread; more entries split the window further, down to
/// single pixels, which take what they need. An eighth more holds the table of settled pairs, and
/// another eighth, for all threads together, pairs that may repeat; beyond that as many pairs are
/// held as are distinct (core/scene/pair_sort.h). The answer depends on neither.
std::unique_ptr<PairBackend> cpu_pair_backend(unsigned threads = 0,
                                              std::size_t memory = std::size_t{256} << 20);

/// A CPU back end in one thread, for tasks whose active triangles are a sample of `count`: a
/// triangle is large if it would be large among all `count`.
std::unique_ptr<PairBackend> cpu_sample_backend(std::size_t count);

}  // namespace farcull
