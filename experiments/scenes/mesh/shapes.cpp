// Triangles by formula; nothing here depends on the platform but square roots, sines and cosines.
#include "experiments/scenes/mesh/shapes.h"

#include <map>
#include <utility>

namespace farcull::shapes {

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

}  // namespace farcull::shapes
