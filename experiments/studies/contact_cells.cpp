// Pairs of triangles in cells, for the study "stability": one family of contacts, in which one
// number goes to an extreme. Cell (i, j) lies at (i, j, i + j modulo side), so that in each of the
// views x, y and z every cell has pixels of its own. A unit is a pixel, and contacts are at whole
// numbers, which are corners of pixels in all three views.
//
// In one of the views, the axes in turn, the images of the two triangles of a contact are segments
// (or nearly) at 45 degrees to the axes, one rising and one falling. They meet at the corner of a
// pixel alone, so no pixel centre is nearer to both than half a pixel's diagonal, 0.707 px. A ball
// of this radius is needed to find such a contact; the budget has 0.709 px.
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/studies/run_point.h"

namespace farcull {
namespace {

using shapes::Corners;

constexpr double kCell = 20;      // px, of a cell along each axis
constexpr double kUlp = 0x1p-45;  // of the largest coordinates, 128 to 256

// A triangle about the origin whose image in the view z is a segment of the slope `rise`, 1 or -1.
// Its longest side, `half` to both sides along x, is at the depth `base` in its middle, and the
// third corner is at the depth `top` there.
Corners fin(double rise, double half, double slope, double base, double top) {
  const Vec3 along = half * Vec3(1, rise, slope);
  return {Vec3(0, 0, base) - along, Vec3(0, 0, base) + along, Vec3(0, 0, top)};
}

// The triangles of a contact at the origin in the view z, one of each object. rise: slope of the
// second one, or of the last one of a stack.
std::vector<Corners> contact(const std::string& family, double value, double slope, double rise) {
  const auto crossing = [&](double first, double second, double ratio) {
    return std::vector<Corners>{fin(1, 3, slope, -first / 2, first / 2),
                                fin(rise, 3 / ratio, -slope / 2, second / 2, -second / 2)};
  };
  if (family == "slivers") {
    const double height = 6 * std::sqrt(2 + slope * slope) / value;
    return crossing(height, height, 1);
  }
  if (family == "mixed") return crossing(5, 5 / value, value);
  if (family == "offset" || family == "scale") return crossing(5, 5, 1);
  if (family == "gap") {
    const double gap = rise > 0 ? -1 : std::nearbyint(value) * kUlp;
    return {fin(1, 3, 0, 0, -3), fin(rise, 3, 0, gap, 3 + gap)};
  }
  if (family != "stack") throw std::logic_error("contact_cells: no family " + family);
  // Three thin sheets across the view, about 8 px long, and a fin through all of them.
  constexpr double kHalf = 3;
  const double distance = 8 * stack_gap(value);
  const Vec3 along(kHalf, kHalf, 0), aside(0x1p-5, -0x1p-5, 0);
  std::vector<Corners> out;
  for (const double at : {-distance, 0.0, distance}) {
    const Vec3 up(0, 0, at);
    out.push_back({up - along - aside / 4, up + along - aside / 4, up + aside});
  }
  out.push_back(fin(rise, kHalf, 0, 2, -2));
  return out;
}

}  // namespace

Scene contact_cells(const ContactCells& wanted) {
  const double value = std::strtod(wanted.value.c_str(), nullptr);
  std::vector<std::vector<Corners>> objects;
  for (int cell = 0; cell < wanted.side * wanted.side; ++cell) {
    const int i = cell / wanted.side, j = cell % wanted.side, axis = cell / 2 % 3;
    const bool apart = cell % 2 != 0;
    const Vec3 middle =
        kCell * (Vec3(i, j, (i + j) % wanted.side) - Vec3::Constant((wanted.side - 1) / 2.0));
    const double slope = (cell % 5 - 2) / 8.0;
    const std::vector<Corners> triangles = contact(wanted.family, value, slope, apart ? 1 : -1);
    objects.resize(triangles.size());
    for (std::size_t o = 0; o < triangles.size(); ++o) {
      // In every other cell the triangles are parallel, 2.1 px beside each other.
      const double beside =
          apart ? 1.5 * static_cast<double>(o) - 0.75 * static_cast<double>(objects.size() - 1) : 0;
      Corners& placed = objects[o].emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 p = triangles[o][c] + Vec3(beside, -beside, 0);
        placed[c] = middle + Vec3(p[(5 - axis) % 3], p[(6 - axis) % 3], p[(7 - axis) % 3]);
      }
    }
  }
  // Small triangles at two corners give all objects the same box, as wide as the window.
  for (std::size_t o = 0; o < objects.size(); ++o) {
    for (const double at : {-kCellsResolution / 2.0, kCellsResolution / 2.0}) {
      Corners& corner = objects[o].emplace_back();
      corner.fill(Vec3::Constant(at));
      for (const std::size_t k : {1, 2})
        corner[k][static_cast<Eigen::Index>((o + k) % 3)] -= std::copysign(0x1p-6, at);
    }
  }
  SceneBuilder scene("contacts", "contacts");
  for (std::size_t o = 0; o < objects.size(); ++o)
    scene.add(shapes::soup(objects[o]), "object" + std::to_string(o));
  return transformed(scene.finish(), wanted.family == "scale" ? value : 1,
                     Vec3::Constant(wanted.family == "offset" ? value : 0));
}

}  // namespace farcull
