// The diagram on the CPU, cell by cell, with the kernel that devices run.
#pragma once

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/voronoi/voronoi.h"

namespace farcull::lab {

/// Runs the kernel of devices on the cores of the CPU. threads: 0 for as many as there are cores.
class CpuVoronoiDevice : public VoronoiDevice {
 public:
  explicit CpuVoronoiDevice(unsigned threads) : threads_(threads) {}

  void start(const std::vector<GridTriangle>& triangles, const VoronoiGrid& grid) override {
    triangles_ = &triangles;
    cells_ = grid.cells;
    error_ = voronoi_bounds::error(grid.longest());
  }

  std::vector<std::array<std::uint32_t, 2>> nearest_two(int slice,
                                                        const VoronoiBricks& bricks) override {
    std::vector<std::array<std::uint32_t, 2>> out(
        static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]), {kNone, kNone});
    for_cells(slice, bricks, [&](std::size_t, std::uint32_t cell, auto ids, const auto& bounds) {
      using Nearest = std::pair<float, std::uint32_t>;
      const Nearest none{std::numeric_limits<float>::infinity(), kNone};
      std::array<Nearest, 2> nearest = {none, none};
      for (std::size_t i = 0; i < ids.size(); ++i) {
        Nearest one{bounds[i].computed, (*triangles_)[ids[i]].object};
        if (nearest[0].second == one.second) {
          nearest[0] = std::min(nearest[0], one);
        } else if (one < nearest[0]) {
          nearest[1] = std::exchange(nearest[0], one);
        } else {
          nearest[1] = std::min(nearest[1], one);
        }
      }
      out[cell] = {nearest[0].second, nearest[1].second};
    });
    return out;
  }

  std::vector<VoronoiNear> near(int slice, const VoronoiBricks& bricks, float reach) override {
    std::vector<std::vector<VoronoiNear>> found(chunks(bricks));
    std::atomic<std::size_t> listed = 0;
    for_cells(slice, bricks,
              [&](std::size_t chunk, std::uint32_t cell, auto ids, const auto& bounds) {
                float least = std::numeric_limits<float>::infinity();
                for (const Bounds& b : bounds) least = std::min(least, b.upper);
                const std::size_t before = found[chunk].size();
                for (std::size_t i = 0; i < ids.size(); ++i) {
                  if (bounds[i].lower <= least + reach)
                    found[chunk].push_back({cell, ids[i], bounds[i].lower, bounds[i].upper});
                }
                listed += found[chunk].size() - before;
                require_voronoi_list(listed);
              });
    std::vector<VoronoiNear> out;
    for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
    std::sort(out.begin(), out.end(), [](const VoronoiNear& a, const VoronoiNear& b) {
      return std::pair(a.cell, a.triangle) < std::pair(b.cell, b.triangle);
    });
    return out;
  }

 private:
  struct Bounds {
    float computed, lower, upper;
  };

  static voronoi_bounds::FarStep step(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

  std::size_t chunks(const VoronoiBricks& bricks) const {
    return chunks_for(bricks.bricks.size(), 4, threads_);
  }

  // Calls work(chunk, cell, triangles, their bounds) for each cell of the slice.
  template <class Work>
  void for_cells(int slice, const VoronoiBricks& bricks, const Work& work) const {
    for_chunks(bricks.bricks.size(), chunks(bricks),
               [&](std::size_t k, std::size_t begin, std::size_t end) {
                 std::vector<Bounds> bounds;
                 for (std::size_t b = begin; b < end; ++b) {
                   const VoronoiBrick& brick = bricks.bricks[b];
                   if (slice < brick.from[2] || slice >= brick.to[2]) continue;
                   const auto ids = bricks.of(brick);
                   for (int y = brick.from[1]; y < brick.to[1]; ++y) {
                     for (int x = brick.from[0]; x < brick.to[0]; ++x) {
                       const std::array<float, 3> centre = {static_cast<float>(x) + 0.5f,
                                                            static_cast<float>(y) + 0.5f,
                                                            static_cast<float>(slice) + 0.5f};
                       bounds.resize(ids.size());
                       for (std::size_t i = 0; i < ids.size(); ++i) {
                         const auto& q = (*triangles_)[ids[i]].corners;
                         bool root_fails = false;  // std::sqrt rounds correctly
                         voronoi_bounds::far_distance(step(centre), step(q[0]), step(q[1]),
                                                      step(q[2]), error_, bounds[i].computed,
                                                      bounds[i].lower, bounds[i].upper, root_fails);
                       }
                       work(k, static_cast<std::uint32_t>(x + cells_[0] * y), ids, bounds);
                     }
                   }
                 }
               });
  }

  unsigned threads_;
  const std::vector<GridTriangle>* triangles_ = nullptr;
  std::array<int, 3> cells_{};
  float error_ = 0;
};

}  // namespace farcull::lab
