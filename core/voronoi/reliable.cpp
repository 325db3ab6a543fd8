// The reliable form: each cell keeps the triangles that can hold an end of a shortest segment whose
// middle lies in the cell (docs/voronoi.md, theorem V9). Two rules cull all others. An end is about
// as near to the cell as any triangle is. And it is no farther than half the distance looked for,
// of which every point of space gives an upper bound.
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
    std::vector<float> upper;  // of each object, as upper_
    Level last;                // blocks that are not divided further
  };
  // smallest: sides of the blocks that are not divided further.
  Reliable(const std::vector<GridTriangle>& triangles, const VoronoiGrid& grid, std::size_t objects,
           double widening, int smallest)
      : triangles_(triangles),
        smallest_(smallest),
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
    if (block.fits(smallest_)) {
      Block alone = block;
      alone.first = found.last.triangles.size();
      alone.count = passed.size();
      found.last.blocks.push_back(alone);
      found.last.triangles.insert(found.last.triangles.end(), passed.begin(), passed.end());
    } else {
      add_parts(block, passed, below);
    }
  }

  void add(const Found& found) {
    for (std::size_t i = 0; i < upper_.size(); ++i) upper_[i] = std::min(upper_[i], found.upper[i]);
    last_.append(found.last);
  }

  // The pairs of the cells that are left, now that all upper bounds are known.
  std::vector<TrianglePair> pairs(const VoronoiOptions& options, VoronoiCounts& counts) const {
    const std::size_t lists = chunks_for(last_.blocks.size(), 16, options.threads);
    PairPool pool(lists, kPairsHeld);
    for (std::size_t first = 0; first < last_.blocks.size();) {
      // Takes cells until they may add some millions of pairs, and at least one cell.
      std::size_t next = first;
      std::uint64_t added = 0;
      while (next < last_.blocks.size() && (next == first || added < kPairsHeld)) {
        const std::uint64_t count = last_.blocks[next++].count;
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
    counts.blocks += last_.blocks.size();
    counts.distances += last_.triangles.size();
    return pool.take(options.threads);
  }

  const std::vector<float>& upper() const { return upper_; }

  // ---- cells of which a device computes the distances ----

  // Moves out the blocks that are left, so that they take no memory while the device works.
  VoronoiBricks take_bricks() {
    VoronoiBricks out;
    for (const Block& block : last_.blocks)
      out.bricks.push_back({block.from, block.to, block.first, block.count});
    out.triangles = std::move(last_.triangles);
    last_ = {};
    return out;
  }

  // Half the diagonal of a cell.
  float half_of_cell() const { return half_of({{0, 0, 0}, {1, 1, 1}, 0, 0}); }

  // As note_upper() below, for all cells of a slice.
  void note_upper(const std::vector<VoronoiNear>& slice) {
    for_cells(slice, [&](std::span<const VoronoiNear> cell) {
      const auto object_of = [&](const VoronoiNear& near) {
        return triangles_[near.triangle].object;
      };
      const auto nearer = [](const VoronoiNear& a, const VoronoiNear& b) {
        return a.upper < b.upper;
      };
      const std::uint32_t nearest = object_of(*std::min_element(cell.begin(), cell.end(), nearer));
      std::array<float, 2> least = {kInfinite, kInfinite};  // of that object, and of all others
      for (const VoronoiNear& near : cell) {
        float& of = least[object_of(near) == nearest ? 0 : 1];
        of = std::min(of, near.upper);
      }
      for (const VoronoiNear& near : cell) {
        const std::uint32_t object = object_of(near);
        const float other = least[object == nearest ? 1 : 0];
        upper_[object] = std::min(upper_[object], near.upper + other);
      }
    });
  }

  // Adds the pairs of all cells of a slice, now that all upper bounds are known.
  void add_pairs(const std::vector<VoronoiNear>& slice, PairPool& pool,
                 const VoronoiOptions& options) const {
    const float half = half_of_cell();
    std::vector<Kept> kept;
    for_cells(slice, [&](std::span<const VoronoiNear> cell) {
      kept.clear();
      for (const VoronoiNear& near : cell)
        kept.push_back({near.triangle, triangles_[near.triangle].object, near.lower});
      add_pairs(kept, half, 0, pool, options);
      if (pool.held() > options.most_pairs + 2 * kPairsHeld) refuse(options);
    });
  }

 private:
  struct Kept {
    std::uint32_t triangle, object;
    float lower;
  };

  float half_of(const Block& block) const {
    const float half = half_diagonal(block, 0);
    return block.is_cell() ? half * widening_ : half;
  }

  // The distance of two objects is at most the length of the way through the point.
  static void note_upper(const Distances& distances, std::vector<float>& upper) {
    const auto least = distances.least_upper<2>();
    for (const Near& near : distances.objects()) {
      const float other = least[least[0].second == near.object ? 1 : 0].first;
      upper[near.object] = std::min(upper[near.object], near.upper + other);
    }
  }

  // How far an end of a segment that is the shortest of this object may be from the point.
  float limit_of(std::uint32_t object, float half) const { return 0.5f * upper_[object] + half; }

  // The triangles that may hold an end; none if all of these are of one object.
  std::vector<Kept> filtered(const Distances& distances, std::span<const std::uint32_t> ids,
                             float half) const {
    const float nearest = distances.least_upper<1>()[0].first + 2 * half;
    // The two largest limits of different objects that may have an end here.
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

  // Calls work(the triangles of a cell) for each cell of a slice.
  template <class Work>
  static void for_cells(const std::vector<VoronoiNear>& slice, const Work& work) {
    for (std::size_t begin = 0, end = 0; begin < slice.size(); begin = end) {
      while (end < slice.size() && slice[end].cell == slice[begin].cell) ++end;
      work(std::span(slice).subspan(begin, end - begin));
    }
  }

  [[noreturn]] static void refuse(const VoronoiOptions& options) {
    throw Error("resolution",
                std::to_string(options.resolution) +
                    " cells along the longest side leave too many pairs of triangles",
                "take more cells, or objects that differ less in size");
  }

  void add_pairs(std::size_t cell, Distances& distances, std::size_t list, PairPool& pool,
                 const VoronoiOptions& options) const {
    const Block& block = last_.blocks[cell];
    const float half = half_of(block);
    const auto ids = std::span(last_.triangles).subspan(block.first, block.count);
    distances.compute(centre_of(block), ids, triangles_, error_);
    add_pairs(filtered(distances, ids, half), half, list, pool, options);
  }

  void add_pairs(const std::vector<Kept>& kept, float half, std::size_t list, PairPool& pool,
                 const VoronoiOptions& options) const {
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
  int smallest_;
  float error_, widening_;
  // Upper bounds of the distance of each object from the nearest other one, in units of the grid,
  // from the levels that are done.
  std::vector<float> upper_;
  Level last_;
};

ReliableNeighbours finished(std::vector<TrianglePair> pairs,
                            const std::vector<GridTriangle>& triangles, const Reliable& form,
                            const VoronoiGrid& grid, const VoronoiCounts& counts) {
  ReliableNeighbours out;
  out.counts = counts;
  out.triangles = std::move(pairs);
  for (const TrianglePair& pair : out.triangles) {
    const ObjectPair objects = pair_of(triangles[pair.a].object, triangles[pair.b].object);
    if (out.objects.empty() || out.objects.back() != objects) out.objects.push_back(objects);
  }
  sort_each_once(out.objects);
  for (const float upper : form.upper())
    out.upper.push_back(grid.world(static_cast<double>(upper)));
  return out;
}

}  // namespace
}  // namespace voronoi

ReliableNeighbours reliable_neighbours(const Scene& scene, const VoronoiOptions& options,
                                       const Progress& progress) {
  voronoi::require(options);
  const VoronoiGrid grid = voronoi_grid(scene, options.resolution);
  const std::vector<GridTriangle> triangles = grid_triangles(scene, grid, options.threads);
  voronoi::Reliable form(triangles, grid, scene.objects.size(), options.widening, 1);
  VoronoiCounts counts;
  voronoi::descend(form, grid, triangles.size(), options, progress, counts);
  std::vector<TrianglePair> pairs = form.pairs(options, counts);
  return voronoi::finished(std::move(pairs), triangles, form, grid, counts);
}

// Goes over the grid twice: for the upper bounds, and then with them for the pairs.
ReliableNeighbours reliable_neighbours(const Scene& scene, const VoronoiOptions& options,
                                       VoronoiDevice& device, const Progress& progress) {
  voronoi::require(options);
  const VoronoiGrid grid = voronoi_grid(scene, options.resolution);
  const std::vector<GridTriangle> triangles = grid_triangles(scene, grid, options.threads);
  voronoi::Reliable form(triangles, grid, scene.objects.size(), options.widening, voronoi::kBrick);
  VoronoiCounts counts;
  counts.cells = grid.cells;
  if (triangles.empty()) return voronoi::finished({}, triangles, form, grid, counts);
  device.start(triangles, grid);
  PairPool pool(1, voronoi::kPairsHeld);
  const auto over_grid = [&](const std::string& what, const auto& use) {
    voronoi::for_slabs(grid, triangles.size(), [&](const voronoi::Block& slab, int from, int to) {
      voronoi::descend(form, slab, triangles.size(), options, {}, counts);
      const VoronoiBricks bricks = form.take_bricks();
      for (int slice = from; slice < to; ++slice) {
        if (progress) {
          progress("voronoi: " + what + ", slice " + std::to_string(slice + 1) + " of " +
                   std::to_string(grid.cells[2]));
        }
        counts.distances += voronoi::distances_in(slice, bricks);
        use(device.near(slice, bricks, 2 * form.half_of_cell()));
      }
    });
  };
  over_grid("bounds", [&](const auto& slice) { form.note_upper(slice); });
  over_grid("pairs", [&](const auto& slice) { form.add_pairs(slice, pool, options); });
  return voronoi::finished(pool.take(options.threads), triangles, form, grid, counts);
}

}  // namespace farcull
