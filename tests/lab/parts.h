// Parts of assemblies whose clashes are known: boxes, rings, and solids of unit cubes.
#pragma once

#include "core/base/random.h"
#include "tests/lab/test.h"

namespace farcull::lab {

class Parts {
 public:
  Scene scene;

  Parts() { scene.name = "parts"; }

  void vertex(double x, double y, double z) { scene.vertices.emplace_back(x, y, z); }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene.triangles.push_back({a, b, c});
    scene.source_face.push_back(0);
  }
  /// Two triangles with a corner each of the four, counted from `first`.
  void quad(std::uint32_t first, std::array<std::uint32_t, 4> q, bool other = false) {
    if (other) q = {q[1], q[2], q[3], q[0]};
    triangle(first + q[0], first + q[1], first + q[2]);
    triangle(first + q[0], first + q[2], first + q[3]);
  }
  std::uint32_t next() const { return static_cast<std::uint32_t>(scene.vertices.size()); }
  /// What was added since the last object is one.
  std::uint32_t end(const std::string& name) {
    const std::uint32_t first = scene.objects.empty() ? 0
                                                      : scene.objects.back().first_triangle +
                                                            scene.objects.back().triangle_count;
    const auto count = static_cast<std::uint32_t>(scene.triangles.size()) - first;
    scene.objects.push_back({.name = name, .first_triangle = first, .triangle_count = count});
    return static_cast<std::uint32_t>(scene.objects.size() - 1);
  }

  /// A box, its faces outward, or inward as a hollow; without its lid (high z) where `open`.
  void box(const Vec3& lo, const Vec3& hi, bool inward = false, bool open = false) {
    const std::uint32_t first = next();
    for (int k = 0; k < 8; ++k)
      vertex(k & 1 ? hi.x() : lo.x(), k & 2 ? hi.y() : lo.y(), k & 4 ? hi.z() : lo.z());
    for (std::array<std::uint32_t, 4> q :
         {std::array{0u, 2u, 3u, 1u}, std::array{4u, 5u, 7u, 6u}, std::array{0u, 1u, 5u, 4u},
          std::array{2u, 6u, 7u, 3u}, std::array{0u, 4u, 6u, 2u}, std::array{1u, 3u, 7u, 5u}}) {
      if (inward) std::swap(q[1], q[3]);
      if (!open || q[0] != 4) quad(first, q);
    }
  }
  std::uint32_t add_box(const std::string& name, const Vec3& lo, const Vec3& hi) {
    box(lo, hi);
    return end(name);
  }

  /// A plate with a square hole through it along z.
  std::uint32_t add_ring(const std::string& name, const Vec3& lo, const Vec3& hi,
                         const Vec3& hole_lo, const Vec3& hole_hi) {
    const std::uint32_t first = next();
    const std::array<std::array<Vec3, 2>, 2> squares = {{{lo, hi}, {hole_lo, hole_hi}}};
    for (const double z : {lo.z(), hi.z()}) {
      for (const auto& [p, q] : squares) {
        vertex(p.x(), p.y(), z);
        vertex(q.x(), p.y(), z);
        vertex(q.x(), q.y(), z);
        vertex(p.x(), q.y(), z);
      }
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4;
      quad(first, {j, i, 4 + i, 4 + j});            // low z
      quad(first, {8 + i, 8 + j, 12 + j, 12 + i});  // high z
      quad(first, {i, j, 8 + j, 8 + i});            // outside
      quad(first, {4 + j, 4 + i, 12 + i, 12 + j});  // the hole
    }
    return end(name);
  }

  std::uint32_t add_tetrahedron(const std::string& name, const std::array<Vec3, 4>& corners) {
    const std::uint32_t first = next();
    for (const Vec3& p : corners) vertex(p.x(), p.y(), p.z());
    triangle(first, first + 2, first + 1);
    triangle(first, first + 1, first + 3);
    triangle(first + 1, first + 2, first + 3);
    triangle(first, first + 3, first + 2);
    return end(name);
  }

  /// A solid of unit cubes: the squares between a cube and what is none, each of two triangles with
  /// a diagonal by chance.
  std::uint32_t add_cubes(const std::string& name, const std::set<std::array<int, 3>>& cubes,
                          RandomNumbers& random) {
    for (const std::array<int, 3>& cube : cubes) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
          std::array<int, 3> beside = cube;
          beside[axis] += 2 * side - 1;
          if (cubes.contains(beside)) continue;
          const std::uint32_t first = next();
          for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
            std::array<int, 3> at = cube;
            at[axis] += side;
            at[(axis + 1) % 3] += u;
            at[(axis + 2) % 3] += v;
            vertex(at[0], at[1], at[2]);
          }
          quad(first, side == 1 ? std::array{0u, 1u, 2u, 3u} : std::array{0u, 3u, 2u, 1u},
               random.below(2) == 1);
        }
      }
    }
    return end(name);
  }
};

}  // namespace farcull::lab
