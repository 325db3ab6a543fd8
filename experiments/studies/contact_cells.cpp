// Pairs of triangles in cells, for the study "stability": a family of contacts, in which one number
// goes from a harmless value to an extreme. Cell (i, j) lies at (i, j, i + j modulo side), so that
// in each of the views x, y and z every cell has pixels of its own. A unit is a pixel, and corners
// of pixels are at whole numbers in all three views. Of six cells
// - one has a contact at risk, which does not depend on the number: in one of the views, the axes
// in
//   turn, the images of its triangles are segments at 45 degrees that cross at the corner of a
//   pixel. No pixel centre is nearer to both than half a pixel's diagonal, 0.707 px. A ball of this
//   radius is needed to find such a contact; the budget has 0.709 px;
// - two have a contact that varies with the number. It lies at most 15/64 px from the centre of a
//   pixel along each axis, so that much smaller balls find it at every value;
// - three have triangles that are far apart, so that there is something to cull.
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

// The triangles of a contact at risk, at the origin, with segments as images in the view z. slope:
// of their common line along the depth.
std::vector<Corners> at_risk(double slope) {
  const Vec3 up(3, 3, 3 * slope), down(3, -3, -1.5 * slope), depth(0, 0, 2.5);
  return {{-up - depth, up - depth, depth}, {depth - down, depth + down, -depth}};
}

// The triangles of a contact that varies, about the origin: one of each object. With harmless
// values each triangle is about 11 px long, and both sides of the line along which the two cross
// have room for the centre of a pixel in each view.
std::vector<Corners> varying(const std::string& family, double value) {
  const auto sheet = [](const Vec3& along, const Vec3& across, double aspect) {
    const Vec3 u = 2.25 * along, v = 2.5 / aspect * across;
    return Corners{-u - v, u - v, 2 * v};
  };
  const auto crossing = [&](double aspect) {
    return std::vector<Corners>{sheet(Vec3(1, -2, 1), Vec3(1, 0, -1), aspect),
                                sheet(Vec3(2, -1, 1), Vec3(0, -1, -1), aspect)};
  };
  // Its tip goes through the sheet of crossing(1), whose plane is x + y + z = 0.
  const auto wedge = [](const Vec3& tip) { return Corners{tip, {7.5, -1.5, 6}, {-1.5, 7.5, 6}}; };
  std::vector<Corners> out = crossing(family == "slivers" ? value : 1);
  if (family == "mixed") {
    for (Vec3& p : out[1]) p /= value;
  } else if (family == "edge-on") {
    for (Vec3& p : out[1]) p -= (1 - 1 / value) / 2 * (p[0] + p[1]) * Vec3(1, 1, 0);
  } else if (family == "overlap" || family == "gap") {
    const double depth = std::nearbyint(value / kUlp) * (family == "gap" ? -kUlp : kUlp);
    out[1] = wedge(-depth * Vec3(1, 1, 2));
  } else if (family == "stack") {
    const double distance = stack_gap(value);
    out = {wedge(-distance * Vec3(2, 2, 3)), out[0]};
    for (const double at : {-distance, distance})
      out.push_back(shapes::shifted(out[1], Vec3::Constant(at)));
  } else if (family != "slivers" && family != "offset" && family != "scale") {
    throw std::logic_error("contact_cells: no family " + family);
  }
  return out;
}

// Far enough from each other that a view shows it, also with oriented boxes of triangles.
std::vector<Corners> apart(std::vector<Corners> triangles) {
  triangles.resize(2);
  for (const int o : {0, 1}) {
    for (Vec3& p : triangles[o]) p = p / 2 + Vec3::Constant(4 * o - 2);
  }
  return triangles;
}

}  // namespace

bool varies(const TrianglePair& pair, const ContactCells& cells) {
  return pair.a < static_cast<std::uint32_t>(cells.side * cells.side) && pair.a % 2 == 0 &&
         pair.a % 6 != 0;
}

Scene contact_cells(const ContactCells& wanted) {
  const double value = std::strtod(wanted.value.c_str(), nullptr);
  shapes::Random random(17);
  const auto near = [&random] { return (static_cast<double>(random.below(16)) - 7.5) / 32; };
  const std::vector<Corners> contact = varying(wanted.family, value);
  std::vector<std::vector<Corners>> objects(contact.size());
  for (int cell = 0; cell < wanted.side * wanted.side; ++cell) {
    const int i = cell / wanted.side, j = cell % wanted.side, axis = cell / 6 % 3, kind = cell % 6;
    Vec3 middle =
        kCell * (Vec3(i, j, (i + j) % wanted.side) - Vec3::Constant((wanted.side - 1) / 2.0));
    for (const int k : {0, 1, 2}) middle[k] += kind == 0 ? 0 : 0.5 + near();
    const std::vector<Corners> triangles = kind == 0       ? at_risk((cell % 5 - 2) / 8.0)
                                           : kind % 2 == 0 ? contact
                                                           : apart(contact);
    for (std::size_t o = 0; o < triangles.size(); ++o) {
      Corners& placed = objects[o].emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& p = triangles[o][c];
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
