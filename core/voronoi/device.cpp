// The grid, and the diagram on the CPU, cell by cell, with the kernel that devices run.
#include <algorithm>
#include <atomic>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/voronoi/voronoi.h"

namespace farcull {

// The box of the triangles, scaled by a power of two so that no difference overflows or is
// subnormal, and divided into cubes. All roundings of the grid itself go outward.

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double up(double x) { return std::nextafter(x, kInfinite); }

}  // namespace

int VoronoiGrid::longest() const { return *std::max_element(cells.begin(), cells.end()); }

double VoronoiGrid::world(double distance) const {
  if (!(distance > 0)) return 0;
  return up(std::ldexp(up(distance * cell), -exponent));
}

VoronoiGrid voronoi_grid(const Scene& scene, int resolution) {
  Box box = Box::empty();
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (const Vec3& p : scene.corners(t)) box.add(p);
  }
  VoronoiGrid out;
  if (box.is_empty()) return out;
  const double largest =
      std::max(box.lo.lpNorm<Eigen::Infinity>(), box.hi.lpNorm<Eigen::Infinity>());
  if (!(largest > 0)) return out;
  // The largest coordinate is then in [1, 2). A coordinate that becomes subnormal is off by less
  // than 2^-1074, where a cell is at least 2^-52 / kVoronoiLargest.
  out.exponent = -std::ilogb(largest);
  Vec3 extent;
  for (int k = 0; k < 3; ++k) {
    out.lo[k] = std::ldexp(box.lo[k], out.exponent);
    extent[k] = std::ldexp(box.hi[k], out.exponent) - out.lo[k];
    if (extent[k] > 0) extent[k] = up(extent[k]);
  }
  const double most = extent.maxCoeff();
  if (!(most > 0)) return out;
  out.cell = up(most / resolution);
  for (std::size_t k = 0; k < 3; ++k) {
    // The quotient is rounded twice, so the factor makes up for more than that.
    const double sides = extent[static_cast<int>(k)] / out.cell * (1 + 0x1p-50);
    out.cells[k] = std::min(resolution, static_cast<int>(sides) + 1);
  }
  return out;
}

std::vector<GridTriangle> grid_triangles(const Scene& scene, const VoronoiGrid& grid,
                                         unsigned threads) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<GridTriangle> out(scene.triangles.size());
  const std::size_t chunks = chunks_for(out.size(), 4096, threads);
  for_chunks(out.size(), chunks, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<Vec3, 3> corners = scene.corners(static_cast<std::uint32_t>(t));
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto axis = static_cast<int>(k);
          const double moved = std::ldexp(corners[i][axis], grid.exponent) - grid.lo[axis];
          out[t].corners[i][k] = static_cast<float>(moved / grid.cell);
        }
      }
      out[t].object = owner[t];
    }
  });
  return out;
}

namespace {

struct Bounds {
  float computed, lower, upper;
};

class CpuDevice : public VoronoiDevice {
 public:
  explicit CpuDevice(unsigned threads) : threads_(threads) {}

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

}  // namespace

void require_voronoi_list(std::size_t listed) {
  if (listed <= kVoronoiMostListed) return;
  throw Error("resolution",
              "a slice has " + std::to_string(listed) +
                  " triangles or more that may be nearest to its cells, too many to list",
              "take more cells, or objects that differ less in size");
}

std::unique_ptr<VoronoiDevice> cpu_voronoi_device(unsigned threads) {
  return std::make_unique<CpuDevice>(threads);
}

}  // namespace farcull
