// Computes the reliable neighbours (docs/voronoi.md, theorem V9). A cell keeps each triangle that
// can hold an end of a shortest segment whose middle lies in the cell. Let H be half the diagonal
// of a block of cells. filtered() drops a triangle if its distance from the block's centre is more
// than 2 H above the least distance, or above H plus half the segment's length.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/scene/pair_sort.h"
#include "core/voronoi/blocks.h"

namespace farcull {
namespace voronoi {
namespace {

constexpr std::size_t kPairsHeld = std::size_t{1} << 22;

class Reliable {
 public:
  struct Found {
    std::vector<float> upper;  // per object, see upper_
    Level cells;
  };
  Reliable(const std::vector<GridTriangle>& triangles, const VoronoiGrid& grid, std::size_t objects,
           double widening)
      : triangles_(triangles),
        error_(voronoi_error(grid.longest())),
        widening_(static_cast<float>(widening)),
        upper_(objects, kInfinite) {}

  Found nothing() const { return {std::vector<float>(upper_.size(), kInfinite), {}}; }

  void look(const Block& block, std::span<const std::uint32_t> ids, Distances& distances,
            Found& found, Level& below) const {
    distances.compute(centre_of(block), ids, triangles_, error_);
    note_upper(distances, found.upper);
    std::vector<std::uint32_t> passed;
    for (const Kept& kept : filtered(distances, ids, half_of(block)))
      passed.push_back(kept.triangle);
    if (passed.empty()) return;
    if (block.is_cell()) {
      found.cells.blocks.push_back(
          {block.from, block.to, found.cells.triangles.size(), passed.size()});
      found.cells.triangles.insert(found.cells.triangles.end(), passed.begin(), passed.end());
    } else {
      add_parts(block, passed, below);
    }
  }

  void add(const Found& found) {
    for (std::size_t i = 0; i < upper_.size(); ++i) upper_[i] = std::min(upper_[i], found.upper[i]);
    cells_.append(found.cells);
  }

  // Returns the pairs of triangles that the cells keep. Precondition: all upper bounds are known.
  std::vector<TrianglePair> pairs(const VoronoiOptions& options, VoronoiCounts& counts) const {
    const std::size_t lists = chunks_for(cells_.blocks.size(), 16, options.threads);
    PairPool pool(lists, kPairsHeld);
    for (std::size_t first = 0; first < cells_.blocks.size();) {
      // Takes at least one cell, and more cells until they may add some millions of pairs.
      std::size_t next = first;
      std::uint64_t added = 0;
      while (next < cells_.blocks.size() && (next == first || added < kPairsHeld)) {
        const std::uint64_t count = cells_.blocks[next++].count;
        added += count * count / 2;
      }
      const std::size_t chunks = std::min(lists, next - first);
      for_chunks(next - first, chunks, [&](std::size_t k, std::size_t begin, std::size_t end) {
        Distances distances;
        for (std::size_t i = first + begin; i < first + end; ++i)
          add_pairs(i, distances, k, pool, options);
      });
      if (pool.held() > options.most_pairs + 2 * kPairsHeld) refuse(options);
      first = next;
    }
    counts.blocks += cells_.blocks.size();
    counts.distances += cells_.triangles.size();
    return pool.take(options.threads);
  }

  const std::vector<float>& upper() const { return upper_; }

 private:
  struct Kept {
    std::uint32_t triangle, object;
    float lower;
  };

  // Returns half the diagonal of the block, rounded up. Multiplies it by the widening for a cell.
  float half_of(const Block& block) const {
    float square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto side = static_cast<float>(block.to[k] - block.from[k]);
      square += side * side;
    }
    const float half = 0.5f * std::sqrt(square) * (1 + 0x1p-20f);
    return block.is_cell() ? half * widening_ : half;
  }

  // Lowers upper bounds. The distance of two objects is at most the sum of their distances from the
  // block's centre.
  static void note_upper(const Distances& distances, std::vector<float>& upper) {
    const auto least = distances.least_upper<2>();
    for (const Near& near : distances.objects()) {
      const float other = least[least[0].second == near.object ? 1 : 0].first;
      upper[near.object] = std::min(upper[near.object], near.upper + other);
    }
  }

  // Bounds the distance of the block's centre from the ends of the object's shortest segment.
  float limit_of(std::uint32_t object, float half) const { return 0.5f * upper_[object] + half; }

  // Returns the triangles that may hold an end of a segment, or none if all belong to one object.
  std::vector<Kept> filtered(const Distances& distances, std::span<const std::uint32_t> ids,
                             float half) const {
    const float nearest = distances.least_upper<1>()[0].first + 2 * half;
    // The two largest limits, with their objects, among objects that may have an end in this list.
    std::array<std::pair<float, std::uint32_t>, 2> largest;
    largest.fill({-kInfinite, kNone});
    for (const Near& near : distances.objects()) {
      std::pair<float, std::uint32_t> carried{limit_of(near.object, half), near.object};
      if (near.lower > std::min(nearest, carried.first)) continue;
      for (auto& kept : largest) {
        if (carried.first > kept.first) std::swap(carried, kept);
      }
    }
    std::vector<Kept> out;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::uint32_t object = triangles_[ids[i]].object;
      const float of_other = largest[largest[0].second == object ? 1 : 0].first;
      const float limit = std::max(limit_of(object, half), of_other);
      const float lower = distances.of()[i].lower;
      if (lower <= std::min(nearest, limit)) out.push_back({ids[i], object, lower});
    }
    if (out.empty() || out.front().object == out.back().object) out.clear();
    return out;
  }

  [[noreturn]] static void refuse(const VoronoiOptions& options) {
    throw Error("resolution",
                std::to_string(options.resolution) +
                    " cells along the longest side leave too many pairs of triangles",
                "take more cells, or objects that differ less in size");
  }

  void add_pairs(std::size_t cell, Distances& distances, std::size_t list, PairPool& pool,
                 const VoronoiOptions& options) const {
    const Block& block = cells_.blocks[cell];
    const float half = half_of(block);
    const auto ids = std::span(cells_.triangles).subspan(block.first, block.count);
    distances.compute(centre_of(block), ids, triangles_, error_);
    const std::vector<Kept> kept = filtered(distances, ids, half);
    std::uint64_t added = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (added > options.most_pairs) refuse(options);
      const float limit = limit_of(kept[i].object, half);
      for (std::size_t j = i + 1; j < kept.size(); ++j) {
        if (kept[i].object == kept[j].object) continue;
        if (std::max(kept[i].lower, kept[j].lower) <=
            std::max(limit, limit_of(kept[j].object, half))) {
          pool.add(list, {kept[i].triangle, kept[j].triangle});
          ++added;
        }
      }
    }
  }

  const std::vector<GridTriangle>& triangles_;
  float error_, widening_;
  // For each object, an upper bound of its distance from the nearest other object, in units of the
  // grid. The bounds come from finished levels.
  std::vector<float> upper_;
  Level cells_;
};

}  // namespace
}  // namespace voronoi

VoronoiNeighbours reliable_neighbours(const Scene& scene, const VoronoiOptions& options,
                                      const Progress& progress) {
  voronoi::require(options);
  const VoronoiGrid grid = voronoi_grid(scene, options.resolution);
  const std::vector<GridTriangle> triangles = grid_triangles(scene, grid, options.threads);
  voronoi::Reliable form(triangles, grid, scene.objects.size(), options.widening);
  VoronoiNeighbours out;
  voronoi::descend(form, grid, triangles.size(), options, progress, out.counts);
  out.triangles = form.pairs(options, out.counts);
  for (const TrianglePair& pair : out.triangles) {
    const ObjectPair objects = voronoi::pair_of(triangles[pair.a].object, triangles[pair.b].object);
    if (out.objects.empty() || out.objects.back() != objects) out.objects.push_back(objects);
  }
  out.objects = in_order(std::move(out.objects));
  for (const float upper : form.upper())
    out.upper.push_back(grid.world(static_cast<double>(upper)));
  return out;
}

}  // namespace farcull
