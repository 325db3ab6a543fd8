// Meshes of one object that is tested against itself: cloth, ropes, soup, fans and folds.
#include <algorithm>
#include <cstdlib>

#include "experiments/generators/mesh_makers.h"

namespace farcull {
namespace {

using Objects = std::vector<SuiteObject>;

std::uint32_t index(std::size_t i) { return static_cast<std::uint32_t>(i); }

/// A sheet of `columns` by `rows` cells whose vertex (i, j) is at place(i, j).
template <class Place>
SuiteObject sheet(int columns, int rows, const Place& place) {
  SuiteObject out;
  for (int i = 0; i <= columns; ++i) {
    for (int j = 0; j <= rows; ++j) out.vertices.push_back(place(i, j));
  }
  const auto at = [&](int i, int j) {
    return index(static_cast<std::size_t>(i) * (static_cast<std::size_t>(rows) + 1) +
                 static_cast<std::size_t>(j));
  };
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      out.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      out.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return out;
}

/// Where column i of a sheet is that is folded to and fro in layers of `width` columns.
double folded(int i, int width) {
  const int layer = i / width;
  const int within = i % width;
  return layer % 2 == 0 ? within : width - within;
}

/// A cloth in four layers with the gap between them, and noise of half a gap.
Objects cloth(SuiteDraws& draws, double gap, int cells) {
  const int width = cells / 2;
  return {sheet(4 * width, cells, [&](int i, int j) {
    const double x = folded(i, width) + 0.2 * draws.between(-1, 1);
    const double y = j + 0.2 * draws.between(-1, 1);
    const double layer = i / width;
    return Vec3(x, y, gap * (layer + 0.55 * draws.between(-1, 1)));
  })};
}

/// A sheet folded flat: every layer is in the plane z = 0 exactly, a little aside of the others.
Objects accordion(SuiteDraws&, double layers, int width) {
  const int columns = static_cast<int>(layers) * width;
  return {sheet(columns, 2 * width,
                [&](int i, int j) { return Vec3(folded(i, width), j + i * 0x1p-10, 0); })};
}

/// A sheet whose vertices are moved by up to `amount` cells.
Objects crumpled(SuiteDraws& draws, double amount, int cells) {
  return {sheet(cells, cells,
                [&](int i, int j) { return Vec3(Vec3(i, j, 0) + amount * draws.point()); })};
}

/// Points of the unit circle without sines: a rational parameter for each quarter.
Vec3 on_circle(int i, int per_quarter) {
  const double t = static_cast<double>(i % per_quarter) / per_quarter;
  const double c = (1 - t * t) / (1 + t * t);
  const double s = 2 * t / (1 + t * t);
  switch (i / per_quarter % 4) {
    case 0:
      return {c, s, 0};
    case 1:
      return {-s, c, 0};
    case 2:
      return {-c, -s, 0};
    default:
      return {s, -c, 0};
  }
}

/// A tube that winds three times around; windings are one pitch (in diameters) above each other.
Objects rope(SuiteDraws& draws, double pitch, int per_quarter) {
  const int around = 12;
  const int turn = 4 * per_quarter;
  SuiteObject out = sheet(3 * turn, around, [&](int i, int j) {
    const Vec3 along = on_circle(i, per_quarter);
    const Vec3 across = on_circle(j % around, around / 4);
    const double radius = 4 + across.x() * (1 + 0x1p-10 * draws.between(-1, 1));
    return Vec3(along.x() * radius, along.y() * radius, across.y() + 2 * pitch * i / turn);
  });
  // The last row of vertices around the tube is the first one.
  for (auto& triangle : out.triangles) {
    for (std::uint32_t& v : triangle) {
      if (v % (around + 1) == around) v -= around;
    }
  }
  return {std::move(out)};
}

/// Triangles that share no vertices.
Objects soup(SuiteDraws& draws, double size, int count) {
  SuiteObject out;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = draws.point();
    for (int k = 0; k < 3; ++k) out.vertices.emplace_back(at + size * draws.point());
    out.add(index(3 * i), index(3 * i + 1), index(3 * i + 2));
  }
  return {std::move(out)};
}

/// Triangles with one corner in common, all near one plane.
Objects fan(SuiteDraws& draws, double spread, int count) {
  SuiteObject out;
  out.vertices = {Vec3::Zero()};
  for (int i = 0; i < count; ++i) {
    const int from = draws.below(400);
    const int to = from + 1 + draws.below(20);
    for (const int at : {from, to}) {
      Vec3 p = on_circle(at, 100) * draws.between(0.5, 1);
      p.z() = spread * draws.between(-1, 1);
      out.vertices.push_back(p);
    }
    out.add(0, index(2 * i + 1), index(2 * i + 2));
  }
  return {std::move(out)};
}

/// Pages with one edge in common; some of them lie in one plane, on one side of the edge or on
/// both.
Objects book(SuiteDraws& draws, double pages, int directions) {
  SuiteObject out;
  out.vertices = {Vec3(0, 0, -1), Vec3(0, 0, 1)};
  for (int i = 0; i < static_cast<int>(pages); ++i) {
    const double x = draws.whole(-directions, directions);
    const double y = draws.whole(1, directions);
    const double length = draws.coarse(0.25, 1);
    const double z = draws.coarse(-1, 1);
    out.vertices.emplace_back(x * length, y * length, z);
    out.add(0, 1, index(out.vertices.size() - 1));
  }
  return {std::move(out)};
}

/// A crumpled sheet, of whose triangles one in so many is a segment or a point.
Objects degenerate(SuiteDraws& draws, double one_in, int cells) {
  SuiteObject out = sheet(cells, cells, [&](int i, int j) {
    const double x = i + draws.coarse(-0.75, 0.75);
    const double y = j + draws.coarse(-0.75, 0.75);
    return Vec3(x, y, draws.coarse(-0.5, 0.5));
  });
  for (auto& [i, j, k] : out.triangles) {
    if (!draws.chance(static_cast<int>(one_in))) continue;
    switch (draws.below(3)) {
      case 0:
        k = i;
        break;
      case 1:
        j = k = i;
        break;
      default: {  // the middle of an edge: three corners on a line
        const Vec3 middle = (out.vertices[i] + out.vertices[j]) / 2;
        out.vertices.push_back(middle);
        k = index(out.vertices.size() - 1);
      }
    }
  }
  return {std::move(out)};
}

}  // namespace

std::vector<MeshFamily> self_families() {
  const auto number = [](const char* text) { return std::strtod(text, nullptr); };
  return {
      {"cloth",
       "a cloth in four layers",
       "the gap between layers, in cells",
       true,
       cloth,
       {{number("1e-1"), 12}, {number("1e-3"), 48}, {number("1e-6"), 48}, {number("1e-12"), 32}},
       true},
      {"accordion", "a sheet folded flat", "its layers", true, accordion, {{4, 4}, {16, 6}}, true},
      {"crumpled",
       "a sheet whose vertices are moved",
       "by how much at most, in cells",
       true,
       crumpled,
       {{1, 20}, {2, 60}, {4, 30}},
       true},
      {"rope",
       "a rope in three windings",
       "from one winding to the next, in diameters",
       true,
       rope,
       {{0.9375, 12}, {1 + 0x1p-10, 40}, {1.0625, 40}},
       true},
      {"soup",
       "triangles that share no vertices",
       "their size, in halves of the box around them",
       true,
       soup,
       {{0.125, 1000}, {0.015625, 10000}, {0.5, 500}},
       true},
      {"fan",
       "triangles with one corner in common",
       "their heights above a plane",
       true,
       fan,
       {{0.125, 200}, {number("1e-3"), 500}, {number("1e-9"), 500}},
       true},
      {"book",
       "triangles with one edge in common",
       "their number",
       true,
       book,
       {{40, 2}, {200, 3}},
       false},
      {"degenerate",
       "a sheet with segments and points among its triangles",
       "one triangle in so many",
       true,
       degenerate,
       {{4, 20}, {2, 40}},
       true},
  };
}

}  // namespace farcull
