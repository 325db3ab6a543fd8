// Merges vertices that nearly coincide, and finds out whether merging would close an object.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {
namespace {

// Finds stored points that are within the tolerance of a given point. Stores points in the cells of
// a grid, and searches the 27 cells around the given point. The cells are twice as wide as the
// tolerance, so that rounding moves no near point out of these 27 cells.
class NearPoints {
 public:
  // tolerance: finite, >= 0.
  explicit NearPoints(double tolerance) : tolerance_(tolerance) {}

  // Returns the number of the nearest stored point whose distance, in double, is at most the
  // tolerance. If several points are equally near, returns the lowest number. If no stored point is
  // this near, stores p with the number `own` and returns `own`.
  std::uint32_t number(const Vec3& p, std::uint32_t own);

 private:
  using Cell = std::array<double, 3>;
  Cell cell_of(const Vec3& p) const;

  double tolerance_;
  std::unordered_map<Cell, std::vector<std::pair<Vec3, std::uint32_t>>, PositionHash> cells_;
};

std::uint32_t NearPoints::number(const Vec3& p, std::uint32_t own) {
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
    const double x = p[static_cast<int>(k)] + 0.0;  // turns -0.0 into 0.0
    // If the tolerance is 0, each position is a cell. Cell numbers above 2^53 are not exact. But
    // coordinates of this size differ by 0 or by more than the tolerance, so no near point is lost.
    out[k] = tolerance_ > 0 ? std::floor(x / tolerance_ / 2) + 0.0 : x;
    if (!std::isfinite(out[k])) out[k] = x;
  }
  return out;
}

using Edge = std::array<std::uint32_t, 2>;

// Returns the edges that occur an odd number of times, without edges from a vertex to itself.
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

WeldTolerance parse_weld(const std::string& text, const char* option) {
  WeldTolerance out;
  constexpr std::string_view kSize = "*size";
  out.relative = text.ends_with(kSize);
  const std::string number = text.substr(0, text.size() - (out.relative ? kSize.size() : 0));
  const std::optional<double> value = parse_number<double>(number);
  if (!value || !std::isfinite(*value) || *value < 0) {
    throw Error(option, "'" + text + "' is no tolerance",
                "give a length of 0 or more in the units of the meshes, or one relative to the "
                "diagonal of the "
                "box around them, as in 1e-7*size");
  }
  out.value = *value;
  return out;
}

std::uint64_t weld(Mesh& mesh, const WeldTolerance& tolerance) {
  const Box box = bounds(mesh);
  const double size = std::min((box.hi - box.lo).norm(), std::numeric_limits<double>::max());
  NearPoints near(tolerance.value * (tolerance.relative ? size : 1));
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> now(mesh.vertices.size(), kNone);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) now[v] = v;
  }
  std::uint64_t merged = 0;
  for (std::uint32_t v = 0; v < now.size(); ++v) {
    if (now[v] == kNone) continue;
    now[v] = near.number(mesh.vertices[v], v);
    merged += now[v] != v;
  }
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = now[v];
  }
  return merged;
}

std::optional<WeldHint> weld_hint(const Scene& scene, const Object& object) {
  NearPoints exact(0);  // gives equal positions the same number
  std::vector<Vec3> place;
  std::unordered_map<std::uint32_t, std::uint32_t> number_of;  // keys: indices of vertices
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
    std::map<std::uint32_t, std::uint32_t> now;  // ascending, as weld() processes vertices
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
