// What FAR pairs asks of a device: the raw pairs of one view. Two implementations from one kernel
// text (core/interval.glsl): threads of the CPU (core/pairs_cpu.h) and GL compute shaders
// (core/gl_pairs.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// A vertex in pixel space as a float; w is not used.
struct alignas(16) PixelVertex {
  float x, y, z, w;
};

/// One view of the scene as a backend sees it.
struct PairTask {
  std::span<const PixelVertex> vertices;  // finite, |coordinate| <= 2^20 px, of the active triangles
  std::span<const std::array<std::uint32_t, 3>> triangles;  // of the scene
  std::span<const std::uint32_t> owners;                    // object of each triangle
  std::span<const std::uint8_t> self;     // per object: tested against itself
  std::span<const std::uint32_t> active;  // ascending indices into triangles: who takes part
  int width = 0;    // px; pixel (i, j) is [i - width/2, i + 1 - width/2] x [j - height/2, ...]
  int height = 0;   // px; both even
  float near_px = 0;  // the depth range of the window, for the slices
  float far_px = 0;
  std::array<float, 3> widening{};  // px per axis: every point of a triangle is within this of the
                                    // triangle of its PixelVertex corners, up to float rounding
};

/// Work done, for stages and studies.
struct PairCounts {
  std::uint64_t listed = 0;       // triangles that met another owner's depth slices
  std::uint64_t entries = 0;      // in the lists of pixels and sub-pixels
  std::uint64_t crowded = 0;      // pixels that were subdivided
  std::uint64_t large = 0;        // triangles compared directly instead of being listed
  std::uint64_t tests = 0;        // pairs of intervals compared
  std::uint64_t bands = 1;        // parts the window was split into
  double mark_ms = 0, list_ms = 0, pair_ms = 0;
};

class PairBackend {
 public:
  virtual ~PairBackend() = default;
  virtual std::string name() const = 0;  // "cpu" or the renderer
  /// Pairs a < b (indices into task.triangles), sorted, each once: of different owners, or of one
  /// that is `self`. Throws Error unless every command is known to have run (A7).
  virtual std::vector<TrianglePair> raw_pairs(const PairTask& task, PairCounts& counts) = 0;
};

}  // namespace farcull
