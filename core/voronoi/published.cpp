// Computes the published neighbours. Each cell names the two objects nearest to its centre. A block
// of cells is left out if other cells have already named all pairs that its cells may name.
#include <algorithm>
#include <cmath>

#include "core/voronoi/blocks.h"

namespace farcull {
namespace voronoi {
namespace {

// dominates() below tests whether one object is nearer than another to every point of a block. The
// test stays sharp for distant objects; a comparison of distances from the block's middle does not.
//
// Let v be a corner of one object, T a triangle of the other object, and c a point of the block.
// Two upper bounds of |c - v|^2 - |c - T|^2 hold for all c. If one bound is below 0, v is nearer
// than T to every c.
//
// Box: if [lo, hi] is the box of T, the difference is at most the sum over the axes of (c - v)^2 -
// |c - [lo, hi]|^2. Each term is convex in c: its slope is 2 (lo - v) below lo, grows to 2 (hi - v)
// at hi, and is constant above hi. So its largest value is at an end of the block (Emrich, Kriegel,
// Kroger, Renz, Zufle: Boosting Spatial Pruning: On Optimal Pruning of MBRs, SIGMOD 2010).
//
// Corners: for a point p of T with weights l_i of its corners p_i,
//   |c - v|^2 - |c - p|^2 = sum l_i (|c - v|^2 - |c - p_i|^2) + sum_{i<j} l_i l_j |p_i - p_j|^2.
// The second sum is at most a third of the square of the longest side. Each bracket of the first
// sum is linear in c, so it is largest at a corner of the block.
using Exactly = std::array<double, 3>;  // a point or a vector, in units of the grid

// The points x with |x - centre| <= half along each axis.
struct BlockBox {
  Exactly centre, half;
};

Exactly from(const Exactly& centre, const GridPoint& p) {
  return {static_cast<double>(p[0]) - centre[0], static_cast<double>(p[1]) - centre[1],
          static_cast<double>(p[2]) - centre[2]};
}
double squared(const Exactly& p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }

using Corners = std::array<Exactly, 3>;  // relative to the centre of the block

double by_box(const Exactly& v, const Corners& t, const Exactly& half) {
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [lo, hi] = std::minmax({t[0][k], t[1][k], t[2][k]});
    const auto term = [&, lo = lo, hi = hi](double x) {
      const double to_box = std::max({0.0, lo - x, x - hi});
      return (x - v[k]) * (x - v[k]) - to_box * to_box;
    };
    most += std::max(term(-half[k]), term(half[k]));
  }
  return most;
}

double by_corners(const Exactly& v, const Corners& t, const Exactly& half) {
  double most = -HUGE_VAL, longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double along = squared(v) - squared(t[i]);
    Exactly side;
    for (std::size_t k = 0; k < 3; ++k) {
      along += 2 * half[k] * std::abs(t[i][k] - v[k]);
      side[k] = t[i][k] - t[(i + 1) % 3][k];
    }
    most = std::max(most, along);
    longest = std::max(longest, squared(side));
  }
  return most + longest / 3;
}

// Returns the corner of the triangles `ids` that is nearest to the block's centre, relative to that
// centre. Precondition: ids is not empty.
Exactly nearest_corner(std::span<const std::uint32_t> ids,
                       const std::vector<GridTriangle>& triangles, const BlockBox& block) {
  Exactly out{};
  double least = HUGE_VAL;
  for (const std::uint32_t id : ids) {
    for (const GridPoint& corner : triangles[id].corners) {
      const Exactly relative = from(block.centre, corner);
      const double square = squared(relative);
      if (square >= least) continue;
      least = square;
      out = relative;
    }
  }
  return out;
}

// Returns true only if every point of the block is nearer to `corner` than to all triangles `ids`
// of another object, in exact and in computed distances. corner: nearest_corner() of an object.
// `margin` bounds the error of a difference of two squared distances. It is the sum of the
// distances (at most 1.74 N each) times the sum of their errors. Errors of double are far smaller.
bool dominates(const Exactly& corner, std::span<const std::uint32_t> ids,
               const std::vector<GridTriangle>& triangles, const BlockBox& block, int longest) {
  const double margin =
      2 * static_cast<double>(voronoi_error(longest)) * 3.5 * static_cast<double>(longest);
  return std::all_of(ids.begin(), ids.end(), [&](std::uint32_t id) {
    const auto& corners = triangles[id].corners;
    const Corners t = {from(block.centre, corners[0]), from(block.centre, corners[1]),
                       from(block.centre, corners[2])};
    return by_corners(corner, t, block.half) < -margin || by_box(corner, t, block.half) < -margin;
  });
}

class Published {
 public:
  using Found = std::vector<ObjectPair>;
  Published(const std::vector<GridTriangle>& triangles, const VoronoiGrid& grid)
      : triangles_(triangles), longest_(grid.longest()) {}

  Found nothing() const { return {}; }

  // Computes distances from the middle cell's centre, which bound those from the other cells.
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

  void add(const Found& found) { pairs_ = in_order(std::move(pairs_), found); }
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

  // An object that may be one of the two nearest to a cell.
  struct Candidate {
    const Near* near;
    std::size_t dominators = 0;  // number of other candidates that dominate this one
    std::size_t by = 0;          // index of one dominator
  };

  // Returns, ascending, the objects that may be among the two nearest to a cell of the block.
  // Returns none if all pairs that these cells may name have been named. slack: largest change of a
  // difference of two distances from the middle cell to another cell.
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
        // a and b can be the nearest two only if neither is certainly farther than a third object.
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

  // True if no candidate except `other` dominates this one.
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

  static constexpr std::size_t kMostCompared = 64;  // with more candidates, none are compared

  const std::vector<GridTriangle>& triangles_;
  int longest_;
  float error_ = voronoi_error(longest_);
  std::vector<ObjectPair> pairs_;  // pairs that earlier levels found
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

}  // namespace farcull
