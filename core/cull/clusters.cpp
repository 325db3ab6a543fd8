// Sorts triangles along a Morton curve and cuts them into clusters of equal size.
#include "core/cull/clusters.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace farcull {
namespace {

// Measured (docs/results/clusters.md, "Clusters"): for 10,000 triangles, a level of clusters costs
// more time than it saves. For 100,000 triangles, one level saves time, a second level does not.
constexpr std::uint32_t kClusterSize = 32;
constexpr std::size_t kClusterLeast = 32768;

constexpr int kCellBits = 20;  // bits per coordinate: 3 * 20 bits fit into a 64-bit code

// Returns the index of the grid cell of x in [lo, hi]. Uses halves, because hi - lo may overflow.
std::uint64_t cell(double x, double lo, double hi) {
  const double span = 0.5 * hi - 0.5 * lo;
  const double at = (0.5 * x - 0.5 * lo) / span;
  constexpr double kCells = 1 << kCellBits;
  if (!(at > 0)) return 0;  // also if `at` is NaN, because lo == hi
  return static_cast<std::uint64_t>(std::min(at * kCells, kCells - 1));
}

std::uint64_t morton_code(const Box& box, const Box& within) {
  std::uint64_t code = 0;
  std::uint64_t cells[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double centre = 0.5 * box.lo[axis] + 0.5 * box.hi[axis];
    cells[axis] = cell(centre, within.lo[axis], within.hi[axis]);
  }
  for (int bit = kCellBits - 1; bit >= 0; --bit) {
    for (int axis = 0; axis < 3; ++axis) code = code << 1 | (cells[axis] >> bit & 1);
  }
  return code;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(std::span<const std::uint32_t> triangles,
                                         std::span<const std::uint32_t> owner,
                                         std::span<const Box> boxes) {
  std::uint32_t owners = 0;
  for (const std::uint32_t t : triangles) owners = std::max(owners, owner[t] + 1);
  std::vector<Box> within(owners, Box::empty());
  for (const std::uint32_t t : triangles) within[owner[t]].add(boxes[t]);

  using Key = std::tuple<std::uint32_t, std::uint64_t, std::uint32_t>;
  std::vector<Key> keys;
  keys.reserve(triangles.size());
  for (const std::uint32_t t : triangles)
    keys.emplace_back(owner[t], morton_code(boxes[t], within[owner[t]]), t);
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(std::get<2>(key));
  return order;
}

std::vector<std::uint32_t> cluster_numbers(std::span<const std::uint32_t> order,
                                           std::span<const std::uint32_t> owner,
                                           std::uint32_t size) {
  if (size == 0) throw std::logic_error("cluster_numbers: clusters of no triangle");
  std::vector<std::uint32_t> numbers(owner.size());
  std::uint32_t number = 0, filled = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool other = i > 0 && owner[order[i]] != owner[order[i - 1]];
    if (other || filled == size) {
      ++number;
      filled = 0;
    }
    numbers[order[i]] = number;
    ++filled;
  }
  return numbers;
}

Clusters usual_clusters(bool occlusion_queries, std::size_t triangles) {
  if (!occlusion_queries) return {.sizes = {}, .reason = Reason::clusters_flags};
  if (triangles <= kClusterLeast)
    return {.sizes = {}, .reason = Reason::clusters_small, .n = triangles, .m = kClusterLeast};
  return {.sizes = {kClusterSize}, .reason = Reason::clusters_large, .n = kClusterLeast};
}

}  // namespace farcull
