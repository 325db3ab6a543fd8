// The steps of FAR pairs on a GL device share this while they work on a window: the device, the
// scene, the numbers of the part, and the counts. For core/gl/pairs*.cpp alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/gl/pairs_device.h"
#include "core/gl/pairs_scene.h"

namespace farcull {

// Bytes.
constexpr std::size_t kWord = sizeof(std::uint32_t);
constexpr std::size_t kVec4 = 16;
constexpr std::size_t kRecord = 5 * kVec4;
constexpr std::size_t kEntry = 2 * kVec4;

/// A part of the window.
struct PairPart {
  int i0, i1, j0, j1;  // pixels, inclusive
  int width() const { return i1 - i0 + 1; }
  int height() const { return j1 - j0 + 1; }
  std::size_t cells() const { return static_cast<std::size_t>(width()) * height(); }
};

/// The memory of one part of the window.
struct PartMemory {
  std::size_t left;
  std::size_t block;
  bool last;  // a single pixel, which is done whatever it takes

  /// False: the part must be split. `bytes` of one buffer. Throws Error where a single pixel needs
  /// more than a block.
  bool take(std::size_t bytes);
};

using PairTotalWords = std::array<std::uint32_t, kTotals>;

/// A total of two words.
inline std::uint64_t two_words(const PairTotalWords& totals, PairTotal low) {
  return std::uint64_t{totals[low]} | std::uint64_t{totals[low + 1]} << 32;
}

/// Room for the work on a window, as counted by the last windows or guessed (pairs_guess.h): with
/// it no count has to be read before all is done.
struct PairForecast {
  std::size_t triangles = 0;  // of the scene it is about
  std::size_t wholes = 0, items = 0, large = 0, shown = 0, pairs = 0, more = 0;
  std::uint64_t row_items = 0;
  std::size_t levels = 0;                            // that are cut
  std::array<std::size_t, kMaxLevel + 1> entries{};  // of each level
  std::array<std::size_t, kMaxLevel + 1> crowded{};  // cells of each level

  /// The largest of both.
  void join(const PairForecast& other);
  /// Room for a quarter more, except where there was nothing.
  PairForecast with_room() const;
};

struct PairRun {
  PairRun(const GlContext& context, const GlPairOptions& wanted)
      : options(wanted), device(context, wanted), scene(device) {}

  /// Begins a window: sends the scene.
  void begin(const PairTask& task);

  GlPairOptions options;
  PairQueue device;
  PairSceneStores scene;
  const PairTask* task = nullptr;
  PairOwners owners;
  PairUniforms common;  // of the part
  PairCounts counts;    // of the window; given_up: no more is done
};

/// Throws Error unless every list was filled in as it was counted.
void check_lists(const PairTotalWords& totals);
/// True where a sum went beyond 32 bits, so that the part must be split. Throws Error where it is a
/// single pixel.
bool overflow(const PairTotalWords& totals, const PartMemory& memory);

}  // namespace farcull
