// Divides the longest edge of a mesh again and again; a heap orders the edges.
#include "experiments/scenes/mesh/refine.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <queue>
#include <unordered_map>
#include <vector>

namespace farcull {
namespace {

struct Edge {
  double squared = 0;  // length
  std::uint32_t a = 0, b = 0;

  // Whether it comes after another.
  bool operator<(const Edge& other) const {
    if (squared != other.squared) return squared < other.squared;
    return a != other.a ? a > other.a : b > other.b;
  }
  std::uint64_t key() const { return std::uint64_t{a} << 32 | b; }
};

Edge edge_between(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  return {(mesh.vertices[a] - mesh.vertices[b]).squaredNorm(), std::min(a, b), std::max(a, b)};
}

}  // namespace

Mesh refined(Mesh mesh, std::uint64_t wanted) {
  assert(!mesh.triangles.empty());
  if (mesh.triangles.size() >= wanted) return mesh;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> around;  // triangles of an edge
  std::vector<Edge> first;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (a == b || b == c || c == a) continue;
    for (const Edge& edge :
         {edge_between(mesh, a, b), edge_between(mesh, b, c), edge_between(mesh, c, a)}) {
      std::vector<std::uint32_t>& of = around[edge.key()];
      if (of.empty()) first.push_back(edge);
      of.push_back(t);
    }
  }
  std::priority_queue<Edge> longest(std::less<Edge>(), std::move(first));
  const auto replace = [&](const Edge& edge, std::uint32_t before, std::uint32_t now) {
    std::vector<std::uint32_t>& of = around[edge.key()];
    std::replace(of.begin(), of.end(), before, now);
  };
  while (mesh.triangles.size() < wanted && !longest.empty()) {
    const Edge edge = longest.top();
    longest.pop();
    if (edge.squared == 0) break;  // points alone
    const auto found = around.find(edge.key());
    const std::vector<std::uint32_t> of = std::move(found->second);
    around.erase(found);
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 p = mesh.vertices[edge.a] + (mesh.vertices[edge.b] - mesh.vertices[edge.a]) / 2;
    mesh.vertices.push_back(p);
    const auto add = [&](std::uint32_t u, std::uint32_t v, std::uint32_t t) {
      const Edge added = edge_between(mesh, u, v);
      std::vector<std::uint32_t>& triangles = around[added.key()];
      if (triangles.empty()) longest.push(added);
      triangles.push_back(t);
    };
    for (const std::uint32_t t : of) {
      // (a, b, c) in its own order becomes (a, m, c) and (m, b, c).
      std::array<std::uint32_t, 3> c = mesh.triangles[t];
      const auto on_edge = [&](std::uint32_t v) { return v == edge.a || v == edge.b; };
      while (!on_edge(c[0]) || !on_edge(c[1])) std::rotate(c.begin(), c.begin() + 1, c.end());
      const auto other = static_cast<std::uint32_t>(mesh.triangles.size());
      mesh.triangles[t] = {c[0], middle, c[2]};
      mesh.triangles.push_back({middle, c[1], c[2]});
      mesh.source_face.push_back(mesh.source_face[t]);
      mesh.group.push_back(mesh.group[t]);
      replace(edge_between(mesh, c[1], c[2]), t, other);
      add(c[0], middle, t);
      add(middle, c[1], other);
      add(middle, c[2], t);
      around[edge_between(mesh, middle, c[2]).key()].push_back(other);
    }
  }
  return mesh;
}

}  // namespace farcull
