// Triangles by formula; nothing here depends on the platform but square roots, sines and cosines.
// A mesh is refined by dividing its longest edge again and again; a heap orders the edges.
#include "experiments/scenes/mesh/shapes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

namespace farcull {

namespace shapes {

Mesh finished(std::vector<Vec3> vertices, std::vector<std::array<std::uint32_t, 3>> triangles) {
  Mesh mesh;
  mesh.vertices = std::move(vertices);
  mesh.triangles = std::move(triangles);
  mesh.source_face.resize(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.source_face.size(); ++t) mesh.source_face[t] = t;
  mesh.group.assign(mesh.triangles.size(), 0);
  mesh.group_names = {"default"};
  return mesh;
}

Mesh soup(const std::vector<Corners>& list) {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const Corners& corners : list) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), corners.begin(), corners.end());
    triangles.push_back({first, first + 1, first + 2});
  }
  return finished(std::move(vertices), std::move(triangles));
}

Mesh sphere(int level) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> vertices = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::array<std::uint32_t, 3>> triangles = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  const auto normalize = [](Vec3& p) {
    p /= std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
  };
  for (Vec3& p : vertices) normalize(p);
  for (int step = 0; step < level; ++step) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(vertices.size()));
      if (is_new) {
        Vec3 p = vertices[a] + vertices[b];
        normalize(p);
        vertices.push_back(p);
      }
      return entry->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return finished(std::move(vertices), std::move(triangles));
}

Mesh torus(double ring, double tube, std::uint32_t around, std::uint32_t across) {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = kTurn * i / around;
      const double v = kTurn * j / across;
      const double r = ring + tube * std::cos(v);
      vertices.emplace_back(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
      const std::uint32_t next_i = (i + 1) % around;
      const std::uint32_t next_j = (j + 1) % across;
      const std::uint32_t a = i * across + j;
      const std::uint32_t b = next_i * across + j;
      const std::uint32_t c = next_i * across + next_j;
      const std::uint32_t d = i * across + next_j;
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    }
  }
  return finished(std::move(vertices), std::move(triangles));
}

Mesh blob(int level, Random& random) {
  Mesh mesh = sphere(level);
  const std::array<Vec3, 4> poles = {random.direction(), random.direction(), random.direction(),
                                     random.direction()};
  for (Vec3& p : mesh.vertices) {
    double radius = 1;
    for (const Vec3& pole : poles) {
      const double h = pole.dot(p);
      radius += 0.15 * h * h * h;
    }
    p *= radius;
  }
  return mesh;
}

Corners shifted(Corners corners, const Vec3& by) {
  for (Vec3& p : corners) p += by;
  return corners;
}

Vec3 inner_point(const Corners& corners, Random& random) {
  const double a = random.between(0.2, 0.4);
  const double b = random.between(0.2, 0.4);
  return a * corners[0] + b * corners[1] + (1 - a - b) * corners[2];
}

Mesh grid(std::uint32_t cells) {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t j = 0; j <= cells; ++j)
      vertices.emplace_back(static_cast<double>(i) / cells, static_cast<double>(j) / cells, 0);
  }
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t j = 0; j < cells; ++j) {
      const std::uint32_t a = i * (cells + 1) + j, b = a + cells + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  }
  return finished(std::move(vertices), std::move(triangles));
}

std::array<Vec3, 4> square(const Vec3& centre, double side) {
  const double h = side / 2;
  return {Vec3(centre + Vec3(-h, -h, 0)), Vec3(centre + Vec3(h, -h, 0)),
          Vec3(centre + Vec3(h, h, 0)), Vec3(centre + Vec3(-h, h, 0))};
}

Vec3 across(const Vec3& along, double length, Random& random) {
  Vec3 out = along.cross(random.direction());
  while (out.norm() < 0.1) out = along.cross(random.direction());
  return out * (length / out.norm());
}

}  // namespace shapes

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
