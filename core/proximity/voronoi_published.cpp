// The published form: each cell names its two nearest objects. A block is left out where every two
// objects that its cells may name have been named by others.
#include "core/proximity/voronoi.h"

#include <algorithm>
#include <cmath>

#include "core/proximity/voronoi_blocks.h"
#include "core/proximity/voronoi_bounds.h"
#include "core/proximity/voronoi_device.h"
#include "core/proximity/voronoi_domination.h"

namespace farcull {
namespace voronoi {
namespace {

class Published {
 public:
  using Found = std::vector<ObjectPair>;
  Published(const std::vector<GridTriangle>& triangles, const VoronoiGrid& grid)
      : triangles_(triangles), longest_(grid.longest()), error_(voronoi_error(grid.longest())) {}

  Found nothing() const { return {}; }

  // Computes the distances of one cell of the block. The bounds for its other cells follow.
  void look(const Block& block, std::span<const std::uint32_t> ids, Distances& distances,
            Found& found, Level& below) const {
    GridPoint centre;
    float square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int cell = block.from[k] + (block.to[k] - block.from[k]) / 2;
      centre[k] = static_cast<float>(cell) + 0.5f;
      const auto far = static_cast<float>(cell - block.from[k]);  // no other cell is farther
      square += far * far;
    }
    const float reach = std::sqrt(square) * (1 + 0x1p-20f);
    distances.compute(centre, ids, triangles_, error_);
    const std::vector<Near>& objects = distances.objects();
    if (objects.size() < 2) return;
    add_nearest_two(objects, found);
    if (block.is_cell()) return;
    const std::vector<std::uint32_t> candidates =
        candidates_of(block, ids, distances, 2 * (reach + error_));
    if (candidates.empty()) return;
    std::vector<std::uint32_t> kept;
    const float limit = distances.least_upper<2>()[1].first + 2 * (reach + error_);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (distances.of()[i].lower <= limit &&
          std::binary_search(candidates.begin(), candidates.end(), triangles_[ids[i]].object))
        kept.push_back(ids[i]);
    }
    add_parts(block, kept, below);
  }

  void add(const Found& found) {
    pairs_.insert(pairs_.end(), found.begin(), found.end());
    sort_each_once(pairs_);
  }
  std::vector<ObjectPair> take() { return std::move(pairs_); }

 private:
  static void add_nearest_two(const std::vector<Near>& objects, Found& found) {
    const Near *first = &objects[0], *second = &objects[1];
    if (second->computed < first->computed) std::swap(first, second);
    for (std::size_t i = 2; i < objects.size(); ++i) {
      const Near& near = objects[i];
      if (near.computed < first->computed) {
        second = first;
        first = &near;
      } else if (near.computed < second->computed) {
        second = &near;
      }
    }
    const ObjectPair pair = pair_of(first->object, second->object);
    if (found.empty() || found.back() != pair) found.push_back(pair);
  }

  // An object that may be one of the nearest two of a cell.
  struct Candidate {
    const Near* near;
    std::size_t dominators = 0;  // of the others, by how many it is dominated
    std::size_t by = 0;          // one of them
  };

  // The objects that may be among the nearest two of a cell of the block, ascending. None where
  // every two that a cell may name have been named. slack: what a distance may change, from the
  // cell at the centre to any other, more than another one does.
  std::vector<std::uint32_t> candidates_of(const Block& block, std::span<const std::uint32_t> ids,
                                           const Distances& distances, float slack) const {
    const auto least = distances.least_upper<3>();
    std::vector<Candidate> candidates;
    for (const Near& near : distances.objects()) {
      if (near.lower <= least[1].first + slack) candidates.push_back({.near = &near});
    }
    if (candidates.size() <= kMostCompared) count_dominators(block, ids, candidates);
    bool adds = false;
    for (std::size_t i = 0; i < candidates.size() && !adds; ++i) {
      for (std::size_t j = i + 1; j < candidates.size() && !adds; ++j) {
        const std::uint32_t a = candidates[i].near->object, b = candidates[j].near->object;
        // Only where both are as near as any third one may be can they be the nearest two.
        const auto third = std::find_if(least.begin(), least.end(), [&](const auto& upper) {
          return upper.second != a && upper.second != b;
        });
        adds = std::max(candidates[i].near->lower, candidates[j].near->lower) <=
                   third->first + slack &&
               only_by(candidates[i], j) && only_by(candidates[j], i) &&
               !std::binary_search(pairs_.begin(), pairs_.end(), pair_of(a, b));
      }
    }
    std::vector<std::uint32_t> out;
    for (const Candidate& candidate : candidates) {
      if (adds && candidate.dominators < 2) out.push_back(candidate.near->object);
    }
    return out;
  }

  // Whether the candidate is dominated by no other one than that.
  static bool only_by(const Candidate& candidate, std::size_t other) {
    return candidate.dominators == 0 || (candidate.dominators == 1 && candidate.by == other);
  }

  void count_dominators(const Block& block, std::span<const std::uint32_t> ids,
                        std::vector<Candidate>& candidates) const {
    BlockBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.centre[k] = 0.5 * (block.from[k] + block.to[k]);
      box.half[k] = 0.5 * (block.to[k] - block.from[k] - 1);
    }
    std::vector<std::span<const std::uint32_t>> of;
    std::vector<Exactly> corners;
    std::size_t at = 0;
    for (const Candidate& candidate : candidates) {
      const auto is_of = [&](std::size_t i) {
        return triangles_[ids[i]].object == candidate.near->object;
      };
      while (!is_of(at)) ++at;
      const std::size_t first = at;
      while (at < ids.size() && is_of(at)) ++at;
      of.push_back(ids.subspan(first, at - first));
      corners.push_back(nearest_corner(of.back(), triangles_, box));
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      for (std::size_t j = 0; j < candidates.size() && candidates[i].dominators < 2; ++j) {
        if (i == j || !dominates(corners[j], of[i], triangles_, box, longest_)) continue;
        ++candidates[i].dominators;
        candidates[i].by = j;
      }
    }
  }

  static constexpr std::size_t kMostCompared = 64;  // candidates of a block

  const std::vector<GridTriangle>& triangles_;
  int longest_;
  float error_;
  std::vector<ObjectPair> pairs_;  // of the levels above
};

// Divides a slab into bricks: each has the triangles of the objects that a device may find among
// the nearest two of a cell. From the centre of a block to that of a cell a distance changes by at
// most half the diagonal between the outer centres, and the device's distances err by at most
// voronoi_bounds::error().
class Candidates {
 public:
  using Found = VoronoiBricks;
  Candidates(const std::vector<GridTriangle>& triangles, const VoronoiGrid& grid)
      : triangles_(triangles),
        error_(voronoi_error(grid.longest())),
        of_device_(voronoi_bounds::error(grid.longest())) {}

  Found nothing() const { return {}; }
  void look(const Block& block, std::span<const std::uint32_t> ids, Distances& distances,
            Found& found, Level& below) const {
    distances.compute(centre_of(block), ids, triangles_, error_);
    const float slack = 2 * (half_diagonal(block, 1) + of_device_);
    const float limit = distances.least_upper<2>()[1].first + slack;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (distances.of()[i].lower <= limit) kept.push_back(ids[i]);
    }
    if (!block.fits(kBrick)) return add_parts(block, kept, below);
    found.bricks.push_back({block.from, block.to, found.triangles.size(), kept.size()});
    found.triangles.insert(found.triangles.end(), kept.begin(), kept.end());
  }
  void add(const Found& found) {
    for (VoronoiBrick brick : found.bricks) {
      brick.first += all_.triangles.size();
      all_.bricks.push_back(brick);
    }
    all_.triangles.insert(all_.triangles.end(), found.triangles.begin(), found.triangles.end());
  }
  const VoronoiBricks& bricks() const { return all_; }

 private:
  const std::vector<GridTriangle>& triangles_;
  float error_, of_device_;
  VoronoiBricks all_;
};

}  // namespace
}  // namespace voronoi

VoronoiNeighbours voronoi_neighbours(const Scene& scene, const VoronoiOptions& options,
                                     const Progress& progress) {
  voronoi::require(options);
  const VoronoiGrid grid = voronoi_grid(scene, options.resolution);
  const std::vector<GridTriangle> triangles = grid_triangles(scene, grid, options.threads);
  voronoi::Published form(triangles, grid);
  VoronoiNeighbours out;
  voronoi::descend(form, grid, triangles.size(), options, progress, out.counts);
  out.objects = form.take();
  return out;
}

VoronoiNeighbours voronoi_neighbours(const Scene& scene, const VoronoiOptions& options,
                                     VoronoiDevice& device, const Progress& progress) {
  voronoi::require(options);
  const VoronoiGrid grid = voronoi_grid(scene, options.resolution);
  const std::vector<GridTriangle> triangles = grid_triangles(scene, grid, options.threads);
  VoronoiNeighbours out;
  out.counts.cells = grid.cells;
  if (triangles.empty()) return out;
  device.start(triangles, grid);
  voronoi::for_slabs(grid, triangles.size(), [&](const voronoi::Block& slab, int from, int to) {
    voronoi::Candidates candidates(triangles, grid);
    voronoi::descend(candidates, slab, triangles.size(), options, {}, out.counts);
    for (int slice = from; slice < to; ++slice) {
      if (progress) {
        progress("voronoi: slice " + std::to_string(slice + 1) + " of " +
                 std::to_string(grid.cells[2]));
      }
      out.counts.distances += voronoi::distances_in(slice, candidates.bricks());
      for (const auto& [a, b] : device.nearest_two(slice, candidates.bricks())) {
        if (b == VoronoiDevice::kNone) continue;
        const ObjectPair pair = voronoi::pair_of(a, b);
        if (out.objects.empty() || out.objects.back() != pair) out.objects.push_back(pair);
      }
      voronoi::sort_each_once(out.objects);
    }
  });
  return out;
}

}  // namespace farcull
