// Triangles are sorted into bands of rows, which the threads take in turn; each band is a tile.
#include "core/pairs/backend.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <thread>

#include "core/base/parallel.h"
#include "core/pairs/tile.h"
#include "core/scene/pair_sort.h"

namespace farcull {
namespace {

// Triangles are fetched this far ahead, since their corners may lie anywhere.
constexpr std::size_t kAhead = 16;

// PairItem holds a pixel in 16 bits, and a product of two such numbers fits an int.
static_assert(kMostCpuPixels < 1 << 15);

// Bands of rows: several for each thread, so that one dense band does not hold up the others.
constexpr int kBandsPerThread = 8;
constexpr int kLeastShift = 2;

// The pool may hold repeated pairs, of all threads together: in a kBufferPart-th of one thread's
// memory, or kLeastBuffer of them, whichever is more, or as many as are distinct.
constexpr std::size_t kBufferPart = 8;
constexpr std::size_t kLeastBuffer = 4096;

struct Bands {
  int shift;  // of 2^shift rows each, but the last
  int count;
  int rows() const { return 1 << shift; }
};

Bands bands_for(int height, std::size_t threads) {
  const int wanted = static_cast<int>(threads) * kBandsPerThread;
  int shift = kLeastShift;
  while ((height >> shift) > wanted) ++shift;
  return {shift, ((height - 1) >> shift) + 1};
}

bool meet(const PairBounds& a, const PairBounds& b) {
  return !PairBounds{interval::max(a.lo, b.lo), interval::min(a.hi, b.hi)}.empty();
}

/// A large triangle, and what comparing it with others takes.
struct Large {
  std::uint32_t triangle;
  std::uint32_t owner;
  PairBounds bounds;
};

// True where the depth intervals of a large triangle and a box overlap over the box's rectangle.
bool meets_over(const PairGrid& grid, const Large& large, const PairBounds& box) {
  const PairBounds real = grid.real_bounds(large.triangle);
  const interval::vec4 margin = interval::far_margin(real.lo, real.hi, grid.task().widening);
  interval::FarStrip strip;
  interval::far_strip(grid.corner(large.triangle, 0), grid.corner(large.triangle, 1),
                      grid.corner(large.triangle, 2), std::max(box.lo.y, real.lo.y) - margin.y,
                      std::min(box.hi.y, real.hi.y) + margin.y, strip);
  float near, far;
  return interval::far_depths(strip, std::max(box.lo.x, real.lo.x) - margin.x,
                              std::min(box.hi.x, real.hi.x) + margin.x, near, far) &&
         near - margin.z <= box.hi.z && box.lo.z <= far + margin.z;
}

class CpuPairs : public PairBackend {
 public:
  CpuPairs(unsigned threads, std::size_t memory, std::size_t sample_of = 0)
      : threads_(threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency())),
        memory_(memory),
        sample_of_(sample_of),
        workers_(threads_) {}

  std::string name() const override { return "cpu"; }
  unsigned threads() const override { return threads_; }

  std::vector<TrianglePair> raw_pairs(const PairTask& task, PairCounts& counts) override {
    if (task.width < 1 || task.height < 1 || std::max(task.width, task.height) > kMostCpuPixels) {
      throw std::logic_error("CpuPairs: a window without pixels, or with more than 32,767 a side");
    }
    const PairGrid grid(task);
    const Bands bands = bands_for(task.height, threads_);
    const std::size_t chunks = std::clamp<std::size_t>(task.active.size() / 1024, 1, threads_);
    WorkLimit work(task.most_tests);
    sort_into_bands(grid, bands, chunks, work);

    PairPool found(threads_, std::max(memory_ / kBufferPart / sizeof(TrianglePair), kLeastBuffer),
                   task.narrow);
    std::vector<PairCounts> parts(threads_);
    work.add(std::uint64_t{large_.size()} * task.active.size());
    if (!work.exceeded()) compare_large(grid, chunks, found);
    const bool masked = std::any_of(task.self.begin(), task.self.end(),
                                    [](std::uint8_t self) { return self == 0; });
    std::atomic<int> next = 0;
    for_chunks(threads_, threads_, [&](std::size_t thread, std::size_t, std::size_t) {
      std::vector<PairItem> items;
      workers_[thread].begin(grid, masked, memory_, found, thread, &work);
      for (int band = next++; band < bands.count && !work.exceeded(); band = next++) {
        items.clear();
        for (const auto& chunk : items_) {
          items.insert(items.end(), chunk[band].begin(), chunk[band].end());
        }
        const PairTile tile{0, task.width - 1, band * bands.rows(),
                            std::min(task.height, (band + 1) * bands.rows()) - 1};
        workers_[thread].run(tile, items, parts[thread]);
      }
    });

    std::vector<TrianglePair> pairs;
    if (!work.exceeded()) pairs = found.take(threads_);
    counts = {};
    counts.given_up = work.exceeded();
    counts.bands = bands.count;
    for (const PairCounts& part : parts) {
      counts.listed += part.listed;
      counts.entries += part.entries;
      counts.crowded += part.crowded;
      counts.tests += part.tests;
      counts.bands += part.bands - 1;
      counts.mark_ms += part.mark_ms;
      counts.list_ms += part.list_ms;
      counts.pair_ms += part.pair_ms;
    }
    counts.large = large_.size();
    return pairs;
  }

 private:
  // Finds the bounds of all active triangles; small ones become items of the bands that they meet.
  void sort_into_bands(const PairGrid& grid, const Bands& bands, std::size_t chunks,
                       WorkLimit& work) {
    const PairTask& task = grid.task();
    const float large = large_pixels(std::max(task.active.size(), sample_of_));
    items_.resize(chunks);
    std::vector<std::vector<Large>> large_of(chunks);
    for_chunks(
        task.active.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
          auto& mine = items_[chunk];
          mine.resize(bands.count);
          for (auto& band : mine) band.clear();
          std::uint64_t pixels = 0;
          for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t t = task.active[k];
            grid.prefetch(task.active[std::min(k + kAhead, end - 1)]);
            const PairBounds bounds = grid.bounds(t);
            if (bounds.empty()) continue;
            const PairItem item = grid.item(t, bounds);
            const float met =
                item.whole ? 0
                           : interval::far_footprint(grid.corner(t, 0), grid.corner(t, 1),
                                                     grid.corner(t, 2), bounds.hi.x - bounds.lo.x,
                                                     bounds.hi.y - bounds.lo.y);
            if (met > large) {
              large_of[chunk].push_back({t, task.owners[t], bounds});
              continue;
            }
            pixels += static_cast<std::uint64_t>(met);
            const int last = item.j1 >> bands.shift;
            for (int band = item.j0 >> bands.shift; band <= last; ++band)
              mine[band].push_back(item);
          }
          work.add(pixels);
        });
    large_.clear();
    for (const auto& part : large_of) large_.insert(large_.end(), part.begin(), part.end());
  }

  // Compares large triangles with each active one, over the rectangle of the active one's bounds.
  void compare_large(const PairGrid& grid, std::size_t chunks, PairPool& found) {
    if (large_.empty()) return;
    const PairTask& task = grid.task();
    for_chunks(task.active.size(), chunks,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) {
                   const std::uint32_t t = task.active[k];
                   const PairBounds bounds = grid.bounds(t);
                   if (bounds.empty()) continue;
                   const std::uint32_t owner = task.owners[t];
                   for (const Large& l : large_) {
                     if (l.triangle == t || (l.owner == owner && !task.self[owner])) continue;
                     if (meet(l.bounds, bounds) && meets_over(grid, l, bounds)) {
                       found.add(chunk, {std::min(t, l.triangle), std::max(t, l.triangle)});
                     }
                   }
                 }
               });
  }

  unsigned threads_;
  std::size_t memory_;
  std::size_t sample_of_;
  std::vector<TileWorker<>> workers_;
  std::vector<std::vector<std::vector<PairItem>>> items_;  // per chunk and band
  std::vector<Large> large_;
};

}  // namespace

std::unique_ptr<PairBackend> cpu_pair_backend(unsigned threads, std::size_t memory) {
  return std::make_unique<CpuPairs>(threads, memory);
}

std::unique_ptr<PairBackend> cpu_sample_backend(std::size_t count) {
  return std::make_unique<CpuPairs>(1, std::size_t{256} << 20, count);
}

}  // namespace farcull
