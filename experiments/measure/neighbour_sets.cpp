// Converts the potential neighbour sets of four methods to one form, counts their sizes, and
// compares the sets with the exact nearest neighbours.
#include "experiments/measure/neighbour_sets.h"

#include <algorithm>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/proximity/near_pairs.h"
#include "verify/closest.h"
#include "verify/exact.h"

namespace farcull {
namespace {

// The squares of the least and of the largest distance between points of two boxes, rounded.
struct SquaredRange {
  double least = 0, largest = 0;
};
SquaredRange range_of(const Box& a, const Box& b) {
  SquaredRange out;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({a.lo[k] - b.hi[k], b.lo[k] - a.hi[k], 0.0});
    const double reach = std::max(a.hi[k] - b.lo[k], b.hi[k] - a.lo[k]);
    out.least += gap * gap;
    out.largest += reach * reach;
  }
  return out;
}

// Returns a limit for computed squared distances. largest: the computed square of a distance D. A
// box whose computed squared distance is above the limit is farther away than D. Derivation: let
// u = 2^-53. Differences, squares and two sums round, so a computed squared distance is the exact
// one times a factor in [(1 - u)^5, (1 + u)^5]. Squares below 2^-1022 add an absolute error of at
// most 2^-1072. The factor 1 + 16 u covers the relative errors of two squared distances and of the
// product below. The term 2^-1000 covers the absolute errors. If `largest` overflows, the limit is
// infinite, and every box is kept.
double limit_of(double largest) { return largest * (1 + 0x1p-49) + 0x1p-1000; }

// Selects objects by a bound. For an object a, the bound is the minimum, over all other objects, of
// the largest distance between the two boxes. Object b may be nearest to a if the least distance of
// their boxes is at most the bound. The same bound selects triangles by their boxes.
NeighbourSets sets_of_boxes(const Scene& scene) {
  const std::vector<Box> triangles = triangle_boxes(scene), boxes = object_boxes(scene, triangles);
  const auto count = static_cast<std::uint32_t>(boxes.size());
  std::vector<double> limit(count, -1);  // negative: there is no other object
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = 0; b < count; ++b) {
      if (a == b || boxes[a].is_empty() || boxes[b].is_empty()) continue;
      const double found = limit_of(range_of(boxes[a], boxes[b]).largest);
      limit[a] = limit[a] < 0 ? found : std::min(limit[a], found);
    }
  }
  NeighbourSets out;
  const auto near = [&](std::uint32_t object, const Box& box, double most) {
    const Object& of = scene.objects[object];
    const auto first = triangles.begin() + of.first_triangle;
    return static_cast<std::uint64_t>(
        std::count_if(first, first + of.triangle_count,
                      [&](const Box& t) { return range_of(t, box).least <= most; }));
  };
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      const double most = std::max(limit[a], limit[b]);
      if (boxes[a].is_empty() || boxes[b].is_empty() ||
          !(range_of(boxes[a], boxes[b]).least <= most))
        continue;
      out.objects.push_back({a, b});
      out.left.push_back({near(a, boxes[b], most), near(b, boxes[a], most)});
    }
  }
  return out;
}

NeighbourSets sets_of_trees(const Scene& scene, const NeighbourOptions& options,
                            const Progress& progress) {
  NeighbourSets out{.objects = {}, .has_pairs = true};
  const ProximityTrees trees(scene, options.threads);
  for (const NearPairs& near :
       trees.nearest_objects(1, std::numeric_limits<double>::infinity(), progress)) {
    if (near.pairs.empty()) continue;
    out.objects.push_back(near.objects);
    out.pairs.insert(out.pairs.end(), near.pairs.begin(), near.pairs.end());
  }
  std::sort(out.pairs.begin(), out.pairs.end());
  return out;
}

NeighbourSets sets_of_diagram(const Scene& scene, const NeighbourOptions& options,
                              const Progress& progress) {
  const VoronoiOptions voronoi{.resolution = options.resolution,
                               .widening = options.widening,
                               .threads = options.threads,
                               .most_pairs = options.most_pairs};
  const bool reliable = options.method == NeighbourMethod::voronoi_reliable;
  VoronoiNeighbours found;
  try {
    found = (reliable ? reliable_neighbours : voronoi_neighbours)(scene, voronoi, progress);
  } catch (const Error& error) {
    // Passes on errors about options.
    if (error.reason.find("too many pairs") == std::string::npos) throw;
    return {.objects = {}, .left_out = error.reason};
  } catch (const std::bad_alloc&) {
    return {.objects = {}, .left_out = "the memory of this machine does not hold the diagram"};
  }
  NeighbourSets out{.objects = std::move(found.objects),
                    .has_pairs = reliable,
                    .pairs = std::move(found.triangles)};
  if (reliable) return out;
  for (const auto& [a, b] : out.objects)
    out.left.push_back({scene.objects[a].triangle_count, scene.objects[b].triangle_count});
  return out;
}

// For each object, counts the triangles of other objects in the object's pairs, each triangle once.
// The pairs (a, b) are sorted, a < b, and the triangles of an object have consecutive numbers. So
// pairs whose a is in one object are consecutive, and pairs of one a with one object are
// consecutive. The triangle b was counted before if the previous pair of b has an a in the same
// object. The triangle a was counted before if the previous pair of b's object has the same a.
void add_named(const Scene& scene, const std::vector<TrianglePair>& pairs,
               std::vector<SetSize>& sizes) {
  const std::vector<std::uint32_t> owner = owners(scene);
  constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> last_object(scene.triangles.size(), kNobody);
  std::vector<std::uint32_t> last_triangle(scene.objects.size(), kNobody);
  for (const TrianglePair& pair : pairs) {
    const std::uint32_t a = owner[pair.a], b = owner[pair.b];
    if (std::exchange(last_object[pair.b], a) != a) ++sizes[a].triangles;
    if (std::exchange(last_triangle[b], pair.a) != pair.a) ++sizes[b].triangles;
  }
}

void sum_up(std::vector<std::uint64_t> values, std::uint64_t& sum, std::uint64_t& median,
            std::uint64_t& most) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  for (const std::uint64_t value : values) sum += value;
  median = values[(values.size() - 1) / 2];
  most = values.back();
}

}  // namespace

std::vector<NearestObjects> nearest_objects(const Scene& scene, const Progress& progress) {
  const FloatingPointGuard guard;
  const ProximityTrees trees(scene);
  std::vector<NearestObjects> out(scene.objects.size());
  std::vector<std::optional<SquaredDistance>> least(out.size());
  for (const NearPairs& near :
       trees.nearest_objects(1, std::numeric_limits<double>::infinity(), progress)) {
    const std::optional<NearestPair> nearest = nearest_pair(scene, near.pairs);
    if (!nearest) continue;
    const SquaredDistance& squared = nearest->closest.squared;
    const auto add = [&](std::uint32_t object, std::uint32_t other) {
      if (least[object] && *least[object] < squared) return;
      if (!least[object] || squared < *least[object]) {
        least[object] = squared;
        out[object] = {};
      }
      out[object].objects.push_back(other);
      out[object].triangles.push_back(nearest->pair);
    };
    // Pairs of objects are sorted, so each object gets its nearest objects in ascending order.
    add(near.objects.a, near.objects.b);
    add(near.objects.b, near.objects.a);
  }
  return out;
}

std::string to_string(NeighbourMethod method) {
  constexpr std::array kNames = {"boxes", "trees", "voronoi", "voronoi-reliable"};
  return kNames.at(static_cast<std::size_t>(method));
}

bool has_cells(NeighbourMethod method) {
  return method == NeighbourMethod::voronoi || method == NeighbourMethod::voronoi_reliable;
}

NeighbourSets neighbour_sets(const Scene& scene, const NeighbourOptions& options,
                             const Progress& progress) {
  if (has_cells(options.method)) return sets_of_diagram(scene, options, progress);
  if (options.method == NeighbourMethod::trees) return sets_of_trees(scene, options, progress);
  return sets_of_boxes(scene);
}

std::vector<SetSize> set_sizes(const Scene& scene, const NeighbourSets& sets) {
  std::vector<SetSize> out(scene.objects.size());
  for (std::size_t i = 0; i < sets.objects.size(); ++i) {
    const auto [a, b] = sets.objects[i];
    ++out[a].objects;
    ++out[b].objects;
    if (sets.has_pairs) continue;
    out[a].triangles += sets.left[i][1];
    out[b].triangles += sets.left[i][0];
  }
  if (sets.has_pairs) add_named(scene, sets.pairs, out);
  return out;
}

bool has_objects(const NeighbourSets& sets, std::uint32_t a, std::uint32_t b) {
  return std::binary_search(sets.objects.begin(), sets.objects.end(),
                            ObjectPair{std::min(a, b), std::max(a, b)});
}

NeighbourSizes sizes_of(const Scene& scene, const NeighbourSets& sets,
                        const std::vector<NearestObjects>& truth) {
  if (!sets.left_out.empty() || truth.size() != scene.objects.size())
    throw std::logic_error("sizes_of: no sets, or the truth of another scene");
  NeighbourSizes out{.object_pairs = sets.objects.size(), .triangle_pairs = sets.pairs.size()};
  for (const auto& [a, b] : sets.left) out.triangle_pairs += a * b;
  const std::vector<SetSize> sizes = set_sizes(scene, sets);
  std::vector<std::uint64_t> with_objects, with_triangles;
  for (std::uint32_t object = 0; object < truth.size(); ++object) {
    const NearestObjects& nearest = truth[object];
    if (nearest.objects.empty()) continue;
    ++out.with_nearest;
    with_objects.push_back(sizes[object].objects);
    with_triangles.push_back(sizes[object].triangles);
    bool found = false;
    for (std::size_t i = 0; i < nearest.objects.size(); ++i) {
      const bool has_object = has_objects(sets, object, nearest.objects[i]);
      found |= has_object;
      ++out.nearest_pairs;
      out.missed_pairs +=
          !(sets.has_pairs ? std::ranges::binary_search(sets.pairs, nearest.triangles[i])
                           : has_object);
    }
    out.missed += !found;
  }
  sum_up(std::move(with_objects), out.set_objects, out.median_objects, out.most_objects);
  sum_up(std::move(with_triangles), out.set_triangles, out.median_triangles, out.most_triangles);
  return out;
}

}  // namespace farcull
