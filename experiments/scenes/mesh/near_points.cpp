// Keeps points in a grid, and looks for near ones in the 27 cells around a point. The cells are
// twice as wide as the tolerance, so that rounding moves no near point beyond these 27.
#include "experiments/scenes/mesh/near_points.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace farcull {

std::uint32_t NearPoints::number(const Vec3& p, std::uint32_t own) {
  // With a tolerance of 0 each position is a cell of its own.
  const Cell centre = cell_of(p);
  const int reach = tolerance_ > 0 ? 1 : 0;
  double best = tolerance_;
  std::optional<std::uint32_t> found;
  Cell cell;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      for (int k = -reach; k <= reach; ++k) {
        cell = {centre[0] + i, centre[1] + j, centre[2] + k};
        const auto at = cells_.find(cell);
        if (at == cells_.end()) continue;
        for (const auto& [q, number] : at->second) {
          const double distance = (p - q).norm();
          if (distance > best || (found && distance == best && number > *found)) continue;
          best = distance;
          found = number;
        }
      }
    }
  }
  if (found) return *found;
  cells_[centre].emplace_back(p, own);
  return own;
}

NearPoints::Cell NearPoints::cell_of(const Vec3& p) const {
  Cell out;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = p[static_cast<int>(k)] + 0.0;  // no -0.0
    // From 2^53 on cells may share a number, but two doubles are then a cell or more apart.
    out[k] = tolerance_ > 0 ? std::floor(x / tolerance_ / 2) + 0.0 : x;
    if (!std::isfinite(out[k])) out[k] = x;
  }
  return out;
}

namespace {

using Edge = std::array<std::uint32_t, 2>;

// The edges that occur an odd number of times. Edges between equal numbers do not count.
std::vector<Edge> odd_edges(std::vector<Edge> edges) {
  std::ranges::sort(edges);
  std::vector<Edge> out;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end] == edges[i]; ++end) {
    }
    if ((end - i) % 2 != 0 && edges[i][0] != edges[i][1]) out.push_back(edges[i]);
  }
  return out;
}

}  // namespace

std::optional<WeldHint> weld_hint(const Scene& scene, const Object& object) {
  // Equal positions get one number.
  NearPoints exact(0);
  std::vector<Vec3> place;
  std::unordered_map<std::uint32_t, std::uint32_t> number_of;  // by the index of the vertex
  std::vector<Edge> edges;
  Box box = Box::empty();
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    std::array<std::uint32_t, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = scene.triangles[object.first_triangle + k][i];
      const auto [entry, is_new] = number_of.try_emplace(v, 0);
      if (is_new) {
        entry->second = exact.number(scene.vertices[v], static_cast<std::uint32_t>(place.size()));
        if (entry->second == place.size()) place.push_back(scene.vertices[v]);
      }
      at[i] = entry->second;
      box.add(scene.vertices[v]);
    }
    if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
    for (std::size_t i = 0; i < 3; ++i)
      edges.push_back({std::min(at[i], at[(i + 1) % 3]), std::max(at[i], at[(i + 1) % 3])});
  }
  const std::vector<Edge> open = odd_edges(std::move(edges));
  if (open.empty()) return std::nullopt;
  const double size = (box.hi - box.lo).norm();
  for (int power = -13; power <= -5; ++power) {
    const double tolerance = std::pow(10.0, power);
    NearPoints near(tolerance * size);
    std::map<std::uint32_t, std::uint32_t> now;  // in order, as weld() goes through the vertices
    for (const Edge& edge : open) now[edge[0]] = now[edge[1]] = 0;
    for (auto& [of, to] : now) to = near.number(place[of], of);
    std::vector<Edge> after;
    for (const Edge& edge : open) {
      const auto [low, high] = std::minmax(now[edge[0]], now[edge[1]]);
      after.push_back({low, high});
    }
    if (odd_edges(std::move(after)).empty())
      return WeldHint{open.size(), tolerance, place[open.front()[0]]};
  }
  return std::nullopt;
}

}  // namespace farcull
