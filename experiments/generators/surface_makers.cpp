// Meshes of two or three objects: scans, plates, shells, copies, and what stands on a ground.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "experiments/generators/mesh_makers.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {
namespace {

using Objects = std::vector<SuiteObject>;

/// An icosahedron, each triangle divided into 4^level, on the unit sphere.
SuiteObject sphere(int level) {
  Mesh mesh = shapes::sphere(level);
  return {std::move(mesh.vertices), std::move(mesh.triangles)};
}

template <class Function>
void each_vertex(SuiteObject& object, const Function& function) {
  for (Vec3& p : object.vertices) p = function(p);
}

/// A closed surface with bumps, and with noise of about a twentieth of an edge.
SuiteObject scan(SuiteDraws& draws, int level) {
  SuiteObject out = sphere(level);
  std::array<Vec3, 8> bumps;
  for (Vec3& bump : bumps) bump = draws.point();
  const Frame turn = turned_frame(draws);
  const double noise = std::ldexp(0.05, -level);
  each_vertex(out, [&](const Vec3& p) {
    double radius = 1;
    for (const Vec3& bump : bumps) {
      const double along = bump.dot(p);
      radius += 0.1 * along * along * along;
    }
    return turn.at(radius * (1 + noise * draws.between(-1, 1)) * p);
  });
  return out;
}

/// Two scans; the outermost vertex of the second along x is inside the first by the depth.
Objects scans(SuiteDraws& draws, double depth, int level) {
  SuiteObject a = scan(draws, level);
  SuiteObject b = scan(draws, level);
  const auto by_x = [](const Vec3& p, const Vec3& q) { return p.x() < q.x(); };
  const Vec3 right = *std::max_element(a.vertices.begin(), a.vertices.end(), by_x);
  const Vec3 left = *std::min_element(b.vertices.begin(), b.vertices.end(), by_x);
  const Vec3 move = right - left - Vec3(depth, 0, 0);
  each_vertex(b, [&](const Vec3& p) { return Vec3(p + move); });
  return {std::move(a), std::move(b)};
}

Objects far_scans(SuiteDraws& draws, double distance, int level) {
  Objects out = scans(draws, 0.25, level);
  const Vec3 to(1, draws.between(-1, 1), -0.75);
  for (SuiteObject& object : out)
    each_vertex(object, [&](const Vec3& p) { return Vec3(p + distance * to); });
  return out;
}

Objects scaled_scans(SuiteDraws& draws, double scale, int level) {
  Objects out = scans(draws, 0.25, level);
  for (SuiteObject& object : out)
    each_vertex(object, [&](const Vec3& p) { return Vec3(p * scale); });
  return out;
}

/// A box from `lo` to `hi` whose top and bottom are fans of long thin triangles to `steps` points
/// on each of two edges.
SuiteObject plate(const Vec3& lo, const Vec3& hi, int steps) {
  SuiteObject out;
  for (const double z : {lo.z(), hi.z()}) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.emplace_back(lo.x(), lo.y(), z);
    for (int i = 0; i <= steps; ++i)
      out.vertices.emplace_back(hi.x(), lo.y() + (hi.y() - lo.y()) * i / steps, z);
    for (int i = 1; i <= steps; ++i)
      out.vertices.emplace_back(hi.x() - (hi.x() - lo.x()) * i / steps, hi.y(), z);
    for (std::uint32_t i = 1; i <= 2 * static_cast<std::uint32_t>(steps); ++i)
      out.add(first, first + i, first + i + 1);
  }
  // The sides: from each of the four corners below to the same ones above.
  const auto n = static_cast<std::uint32_t>(steps);
  const std::uint32_t above = 2 * n + 2;
  const std::array<std::uint32_t, 5> corner = {0, 1, n + 1, 2 * n + 1, 0};
  for (int i = 0; i < 4; ++i) {
    out.add(corner[i], corner[i + 1], above + corner[i + 1]);
    out.add(corner[i], above + corner[i + 1], above + corner[i]);
  }
  return out;
}

/// Two plates that lie on each other, and a bar through both, made narrower by 2^halvings. Every
/// coordinate is short, so the faces are in one plane exactly.
Objects plates(SuiteDraws&, double slivers, int halvings) {
  const double width = std::ldexp(1, -halvings);
  const int steps = static_cast<int>(slivers * width);
  Objects out = {plate(Vec3(0, 0, 0), Vec3(1, 1, 0.125), steps),
                 plate(Vec3(0.25, 0.375, 0.125), Vec3(1.25, 1.375, 0.25), steps),
                 plate(Vec3(0.5, 0.5, -0.5), Vec3(0.625, 0.625, 0.75), 1)};
  for (SuiteObject& object : out)
    each_vertex(object, [&](const Vec3& p) { return Vec3(p.x(), p.y() * width, p.z()); });
  return out;
}

/// Three shells, each outside the one before by the gap; the outermost is moved by 1.5 gaps, so
/// that it crosses the one below it.
Objects shells(SuiteDraws& draws, double gap, int level) {
  Objects out;
  const Vec3 move = draws.point() * gap;
  for (int i = 0; i < 3; ++i) {
    out.push_back(sphere(level));
    const Vec3 by = i == 2 ? Vec3(move + Vec3(1.5 * gap, 0, 0)) : Vec3::Zero();
    each_vertex(out.back(), [&](const Vec3& p) { return Vec3(p * (1 + i * gap) + by); });
  }
  return out;
}

/// A surface and its copy with the triangles in the opposite order, moved by some units.
Objects copies(SuiteDraws& draws, double units, int level) {
  SuiteObject a = scan(draws, level);
  SuiteObject b = a;
  std::reverse(b.triangles.begin(), b.triangles.end());
  each_vertex(b, [&](const Vec3& p) { return Vec3(p + Vec3(units * 0x1p-52, 0, 0)); });
  return {std::move(a), std::move(b)};
}

/// Two large triangles, and many small ones that stand on them, above and below.
Objects ground(SuiteDraws& draws, double ratio, int count) {
  SuiteObject large;
  large.vertices = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
  large.add(0, 1, 2);
  large.add(0, 2, 3);
  SuiteObject small;
  for (int i = 0; i < count; ++i) {
    Vec3 at = draws.point();
    at.z() = draws.chance(3) ? 1 / ratio : 0;
    const auto first = static_cast<std::uint32_t>(small.vertices.size());
    for (int k = 0; k < 3; ++k) small.vertices.emplace_back(at + draws.point() / ratio);
    if (draws.chance(4)) small.vertices[first].z() = 0;
    small.add(first, first + 1, first + 2);
  }
  return {std::move(large), std::move(small)};
}

/// A square of unit cells; vertex i * (cells + 1) + j is at (i, j).
SuiteObject sheet(int cells) {
  Mesh mesh = shapes::grid(static_cast<std::uint32_t>(cells));
  SuiteObject out{std::move(mesh.vertices), std::move(mesh.triangles)};
  for (std::size_t v = 0; v < out.vertices.size(); ++v) {
    const std::size_t row = static_cast<std::size_t>(cells) + 1;
    out.vertices[v] = Vec3(static_cast<double>(v / row), static_cast<double>(v % row), 0);
  }
  return out;
}

/// A sheet above another one by the gap; some of its vertices touch the lower one or are below it.
Objects sheets(SuiteDraws& draws, double gap, int cells) {
  SuiteObject above = sheet(cells);
  each_vertex(above, [&](const Vec3& p) {
    const double height = draws.chance(20) ? gap * draws.whole(-1, 0) : gap;
    return Vec3(p.x() + 0.25, p.y() + 0.125, height);
  });
  return {sheet(cells), std::move(above)};
}

}  // namespace

std::vector<MeshFamily> surface_families() {
  const auto number = [](const char* text) { return std::strtod(text, nullptr); };
  return {
      {"scans",
       "two bumpy surfaces with noise",
       "depth to which they go into each other",
       false,
       scans,
       {{0.25, 3}, {0.25, 5}, {number("1e-3"), 5}, {number("1e-9"), 5}},
       true},
      {"far-scans",
       "two scans far from the origin",
       "the distance, in their radii",
       false,
       far_scans,
       {{1e6, 3}, {1e10, 4}, {1e14, 4}},
       true},
      {"scaled-scans",
       "tiny and huge scans",
       "the radius",
       false,
       scaled_scans,
       {{number("1e-100"), 3}, {number("1e100"), 3}},
       false},
      {"plates",
       "plates of long thin triangles that lie on each other, and a bar through both",
       "length over width of the triangles, about",
       false,
       plates,
       {{64, 0}, {0x1p16, 10}, {0x1p36, 30}},
       true},
      {"shells",
       "nested shells, of which the outermost crosses the one below it",
       "the gap between two, in radii",
       false,
       shells,
       {{0x1p-10, 3}, {0x1p-20, 4}, {0x1p-34, 4}},
       true},
      {"copies",
       "a surface and its copy",
       "units of 2^-52 by which the copy is moved",
       false,
       copies,
       {{0, 2}, {1, 3}, {1024, 3}},
       true},
      {"ground",
       "two large triangles and small ones on them",
       "the ratio of their sizes",
       false,
       ground,
       {{1e6, 1000}, {1e12, 1000}},
       false},
      {"sheets",
       "a sheet above another one, touching it here and there",
       "the gap, in cells",
       false,
       sheets,
       {{0x1p-20, 40}, {0x1p-50, 40}},
       false},
  };
}

}  // namespace farcull
