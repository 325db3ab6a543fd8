// One tile of the window, on one core: which triangles meet another owner's slices, the lists of
// its pixels, and the pairs whose intervals overlap in one of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/interval.h"
#include "core/pair_backend.h"
#include "core/pair_settled.h"
#include "core/pair_sort.h"

namespace farcull {

/// A triangle in the window: the pixels of its bounds and the slices of its depth.
struct PairItem {
  std::uint32_t triangle;
  std::uint16_t i0, i1, j0, j1;  // inclusive, from the window's lower left pixel
  std::uint8_t s0, s1;           // slices, inclusive
  bool whole;                    // one interval in all its pixels
};

/// Real bounds of a triangle within its owner's limits (px); empty where lo > hi on some axis.
struct PairBounds {
  interval::vec4 lo, hi;
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
};

/// The parts of a task that every pixel needs.
class PairGrid {
 public:
  explicit PairGrid(const PairTask& task);

  const PairTask& task() const { return task_; }
  const interval::vec4& corner(std::uint32_t triangle, int k) const {
    return task_.vertices[task_.triangles[triangle][k]];
  }
  /// Fetches the corners, for a call that follows soon.
  void prefetch([[maybe_unused]] std::uint32_t triangle) const {
#ifdef __GNUC__
    for (const std::uint32_t v : task_.triangles[triangle]) __builtin_prefetch(&task_.vertices[v]);
#endif
  }
  /// Real bounds, and within the owner's limits.
  PairBounds real_bounds(std::uint32_t triangle) const {
    const std::array<std::uint32_t, 3>& t = task_.triangles[triangle];
    PairBounds out;
    interval::far_bounds(task_.vertices[t[0]], task_.vertices[t[1]], task_.vertices[t[2]],
                         task_.widening, out.lo, out.hi);
    return out;
  }
  PairBounds bounds(std::uint32_t triangle) const {
    const PairBounds real = real_bounds(triangle);
    const PixelBox& limit = task_.limits[task_.owners[triangle]];
    return {interval::max(real.lo, limit.lo), interval::min(real.hi, limit.hi)};
  }
  /// The item of a triangle with bounds that are not empty.
  PairItem item(std::uint32_t triangle, const PairBounds& bounds) const;
  int slice(float z) const { return interval::far_slice(z, task_.near_px, slices_per_px_); }

 private:
  PairTask task_;
  float slices_per_px_;
};

struct PairTile {
  int i0, i1, j0, j1;  // pixels, inclusive
  int width() const { return i1 - i0 + 1; }
  int height() const { return j1 - j0 + 1; }
};

/// Faults for tests: with each of them pairs are lost.
enum class TileFault {
  none,
  settled_apart,  // a pair is settled also where its intervals do not overlap
  wrong_pixel,    // a pair of whole triangles is left to the first pixel of either of them
};

/// Works on tiles one after the other; keeps its buffers.
class PairTileWorker {
 public:
  TileFault fault = TileFault::none;

  /// Begins a window, whose pairs go to a list of the pool. More entries than `memory` holds
  /// (bytes) split a tile.
  void begin(const PairGrid& grid, bool masked, std::size_t memory, PairPool& pool,
             std::size_t list);
  /// Adds the pairs of a tile, which may repeat. `items`: those that may meet it, ascending by
  /// triangle. `masked`: leave out entries whose slices no other owner touches.
  void run(const PairTile& tile, std::span<const PairItem> items, PairCounts& counts);

 private:
  /// A triangle with an entry.
  struct Shown {
    std::uint32_t triangle;
    std::uint32_t owner;
    std::array<std::uint32_t, 3> vertices;
    PairBounds bounds;
    bool whole;
    std::uint32_t number = 0;  // in settled_, where its round is
    std::uint32_t round = 0;   // this one
  };
  /// A triangle in a pixel, with all that comparing two of them takes.
  static constexpr std::uint32_t kWholeBit = 0x80000000;
  struct alignas(16) Entry {
    float x0, y0, near;   // px
    std::uint32_t shown;  // index into shown_; kWholeBit: one interval in all its pixels
    float x1, y1, far;
    std::uint32_t owner;
  };
  struct RawEntry {
    std::uint32_t cell;
    std::uint32_t shown;
    float near, far;  // px; not set for whole triangles
  };
  static bool meet(const Entry& a, const Entry& b);
  const Shown& shown(const Entry& e) const { return shown_[e.shown & ~kWholeBit]; }
  Shown& shown(const Entry& e) { return shown_[e.shown & ~kWholeBit]; }
  bool left_out(const Shown& a, const Shown& b) const;
  void keep(const Entry& a, const Entry& b);
  Entry entry(std::uint32_t index, float near, float far) const;

  template <class Visit>
  void for_each_pixel(const PairItem& item, const Visit& visit) const;
  std::size_t mark(std::span<const PairItem> items);
  bool list(std::span<const PairItem> items, std::size_t last, bool masked, std::size_t limit);
  void pair_pixel(std::span<Entry> entries, int i, int j);
  void pair_cell(std::span<Entry> entries, float x, float y, float size, int level);
  bool subdivide(std::span<Entry> entries, float x, float y, float size, int level);
  template <class Emit>
  void sweep(std::span<Entry> entries, const Emit& emit);
  bool sweep_unsettled(std::span<const Entry> entries);

  const PairGrid* grid_ = nullptr;
  bool masked_ = false;
  std::size_t memory_ = 0;
  PairPool* pool_ = nullptr;
  std::size_t pool_list_ = 0;
  PairTile tile_{};
  PairCounts* counts_ = nullptr;
  std::vector<std::uint64_t> any_;       // per pixel: slices that some owner touches
  std::vector<std::uint64_t> conflict_;  // per pixel: slices that two owners touch
  std::vector<Shown> shown_;
  std::vector<RawEntry> raw_;
  std::vector<std::uint32_t> first_;  // per pixel: into entries_
  std::vector<Entry> entries_;
  SettledPairs settled_;
  std::size_t added_ = 0, listed_ = 0;  // pairs and triangles of the window up to now
  // Of one list: the number of each entry, the entry of each number, and numbers of those to come.
  std::vector<std::uint32_t> numbers_, places_;
  std::vector<std::uint64_t> to_come_;
};

inline PairItem PairGrid::item(std::uint32_t triangle, const PairBounds& b) const {
  // Clamped as floats, since a conversion beyond int would be undefined; what is not negative is
  // rounded down by the conversion.
  const auto pixel = [](float x, int count) {
    return static_cast<std::uint16_t>(
        static_cast<int>(interval::clamp(x, 0, static_cast<float>(count - 1))));
  };
  PairItem out;
  out.triangle = triangle;
  out.i0 = pixel(b.lo.x, task_.width);
  out.i1 = pixel(b.hi.x, task_.width);
  out.j0 = pixel(b.lo.y, task_.height);
  out.j1 = pixel(b.hi.y, task_.height);
  out.s0 = static_cast<std::uint8_t>(slice(b.lo.z));
  out.s1 = static_cast<std::uint8_t>(slice(b.hi.z));
  out.whole = (out.i1 - out.i0 + 1) * (out.j1 - out.j0 + 1) <= kWholePixels;
  return out;
}

}  // namespace farcull
