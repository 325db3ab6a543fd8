// Divides the grid into blocks of cells, level by level. Each block lists the triangles that can
// affect its cells. The parts of a block are on the next level and have shorter lists. A level
// reads only results of earlier levels, so the answer does not depend on the number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/voronoi/voronoi.h"

namespace farcull::voronoi {

inline constexpr float kInfinite = std::numeric_limits<float>::infinity();
inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// A block has the cells from .. to - 1 along each axis. Its triangles are the `count` elements of
// Level::triangles from index `first` on.
struct Block {
  std::array<int, 3> from, to;
  std::size_t first, count;

  bool is_cell() const {
    return to[0] - from[0] <= 1 && to[1] - from[1] <= 1 && to[2] - from[2] <= 1;
  }
};

struct Level {
  std::vector<Block> blocks;
  std::vector<std::uint32_t> triangles;

  void append(const Level& other) {
    for (Block block : other.blocks) {
      block.first += triangles.size();
      blocks.push_back(block);
    }
    triangles.insert(triangles.end(), other.triangles.begin(), other.triangles.end());
  }
};

inline GridPoint centre_of(const Block& block) {
  GridPoint out;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = 0.5f * static_cast<float>(block.from[k] + block.to[k]);
  return out;
}

// Halves the block along each axis with more than one cell. Adds the parts, which all have the
// triangles `kept`, to `below`.
inline void add_parts(const Block& block, std::span<const std::uint32_t> kept, Level& below) {
  std::array<std::vector<std::pair<int, int>>, 3> parts;
  for (std::size_t k = 0; k < 3; ++k) {
    const int from = block.from[k], to = block.to[k], middle = from + (to - from) / 2;
    parts[k].emplace_back(from, to - from > 1 ? middle : to);
    if (to - from > 1) parts[k].emplace_back(middle, to);
  }
  const std::size_t first = below.triangles.size();
  below.triangles.insert(below.triangles.end(), kept.begin(), kept.end());
  for (const auto& x : parts[0]) {
    for (const auto& y : parts[1]) {
      for (const auto& z : parts[2]) {
        below.blocks.push_back(
            {{x.first, y.first, z.first}, {x.second, y.second, z.second}, first, kept.size()});
      }
    }
  }
}

// The distance of an object from a point: the least values of GridDistance of its triangles.
struct Near {
  std::uint32_t object;
  float computed, lower, upper;
};

// The distances of a point from triangles and objects. The triangles must be sorted by object.
class Distances {
 public:
  void compute(const GridPoint& point, std::span<const std::uint32_t> ids,
               const std::vector<GridTriangle>& triangles, float error) {
    of_.clear();
    objects_.clear();
    for (const std::uint32_t id : ids) {
      const GridTriangle& triangle = triangles[id];
      const GridDistance d = distance_of(point, triangle, error);
      of_.push_back(d);
      if (objects_.empty() || objects_.back().object != triangle.object) {
        objects_.push_back({triangle.object, d.computed, d.lower, d.upper});
      } else {
        Near& near = objects_.back();
        near.computed = std::min(near.computed, d.computed);
        near.lower = std::min(near.lower, d.lower);
        near.upper = std::min(near.upper, d.upper);
      }
    }
  }
  const std::vector<GridDistance>& of() const { return of_; }  // in the order of the triangles
  const std::vector<Near>& objects() const { return objects_; }
  // Returns the K least upper bounds with their objects, ascending.
  template <std::size_t K>
  std::array<std::pair<float, std::uint32_t>, K> least_upper() const {
    std::array<std::pair<float, std::uint32_t>, K> out;
    out.fill({kInfinite, kNone});
    for (const Near& near : objects_) {
      std::pair<float, std::uint32_t> carried{near.upper, near.object};
      for (auto& kept : out) {
        if (carried.first < kept.first) std::swap(carried, kept);
      }
    }
    return out;
  }

 private:
  std::vector<GridDistance> of_;
  std::vector<Near> objects_;
};

/// Throws Error if an option is out of range.
inline void require(const VoronoiOptions& options) {
  if (options.resolution < 1 || options.resolution > kVoronoiLargest) {
    throw Error("resolution", "is " + std::to_string(options.resolution),
                "give 1 to " + std::to_string(kVoronoiLargest));
  }
  if (!(options.widening >= 0 && options.widening <= 1))
    throw Error("widening", "is not in 0 to 1", "leave it at 1, which the proof asks for");
}

inline ObjectPair pair_of(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Processes the blocks of the grid level by level. Calls form.look() for each block of a level, in
/// chunks that run in parallel; look() adds blocks to the next level. Then calls form.add() with
/// the Form::Found of each chunk, in the order of the chunks.
template <class Form>
void descend(Form& form, const VoronoiGrid& grid, std::size_t triangles,
             const VoronoiOptions& options, const Progress& progress, VoronoiCounts& counts) {
  counts.cells = grid.cells;
  Level level;
  level.blocks.push_back({{0, 0, 0}, grid.cells, 0, triangles});
  for (std::uint32_t t = 0; t < triangles; ++t) level.triangles.push_back(t);
  while (!level.blocks.empty()) {
    if (progress) progress(StageKind::near);
    const std::size_t chunks = chunks_for(level.blocks.size(), 16, options.threads);
    std::vector<Level> below(chunks);
    std::vector<typename Form::Found> found(chunks, form.nothing());
    for_chunks(level.blocks.size(), chunks, [&](std::size_t k, std::size_t begin, std::size_t end) {
      Distances distances;
      for (std::size_t i = begin; i < end; ++i) {
        const Block& block = level.blocks[i];
        form.look(block, std::span(level.triangles).subspan(block.first, block.count), distances,
                  found[k], below[k]);
      }
    });
    for (const Block& block : level.blocks) counts.distances += block.count;
    counts.blocks += level.blocks.size();
    level = {};
    for (std::size_t k = 0; k < chunks; ++k) {
      form.add(found[k]);
      level.append(below[k]);
    }
  }
}

}  // namespace farcull::voronoi
