// Families about shapes: random triangles, slivers, degenerate ones, and neighbours that fold.
#include <cmath>

#include "experiments/generators/pair_makers.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

MadePair random_pair(SuiteDraws& draws, double) {
  MadePair out;
  for (Vec3& p : out.a) p = draws.point();
  for (Vec3& p : out.b) p = draws.point();
  return out;
}

/// A long edge through `centre`, and the third corner beside the edge by 1 / aspect.
Corners sliver(SuiteDraws& draws, const Vec3& centre, double aspect) {
  const Vec3 half = draws.point();
  const Vec3 beside = draws.point() / aspect;
  const double along = draws.between(-1, 1);
  return {centre - half, centre + half, centre + along * half + beside};
}

/// Two slivers whose long edges pass each other at about their width.
MadePair slivers(SuiteDraws& draws, double aspect) {
  const Vec3 centre = draws.point();
  const Corners a = sliver(draws, centre, aspect);
  const bool contact = draws.chance(4);
  const Vec3 beside = contact ? Vec3::Zero() : Vec3(draws.point() / (2 * aspect));
  return {a, sliver(draws, centre + beside, aspect)};
}

const std::vector<double> kBits = {8, 16, 24, 32, 40, 50};

MadePair in_units(MadePair pair, double bits) {
  for (Corners* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t) p *= std::ldexp(1, -static_cast<int>(bits));
  }
  return pair;
}

/// A point, a segment or a triangle that has the point `at`: in its inside, on an edge or as a
/// corner.
Corners shape_with(SuiteDraws& draws, int dimension, const Vec3& at, double extent) {
  if (dimension == 0) return {at, at, at};
  const Vec3 u = draws.whole_point(extent);
  if (dimension == 1) {
    switch (draws.below(4)) {
      case 0:
        return {at, at + u, at + u};  // the point is an end, and a corner stands twice
      case 1:
        return {at - u, at + u, at - u};
      case 2:
        return {at - u, at + 2 * u, at + u};  // three corners on a line
      default:
        return {at - u, at, at + u};
    }
  }
  const Vec3 v = draws.whole_point(extent);
  switch (draws.below(3)) {
    case 0:
      return {at, at + u, at + v};
    case 1:
      return {at - u, at + u, at + v};
    default:
      return {at - u - v, at + u, at + v};
  }
}

/// b moved by a unit, or far, every third time.
Vec3 step_aside(SuiteDraws& draws) {
  if (!draws.chance(3)) return Vec3::Zero();
  return draws.whole_point(1);
}

MadePair points(SuiteDraws& draws, double bits) {
  const double extent = std::ldexp(1, static_cast<int>(bits) - 3);
  const Vec3 at = draws.whole_point(extent);
  const Corners a = {at, at, at};
  const Vec3 step = step_aside(draws);
  return in_units({a, shape_with(draws, draws.below(3), at + step, extent)}, bits);
}

MadePair segments(SuiteDraws& draws, double bits) {
  const double extent = std::ldexp(1, static_cast<int>(bits) - 3);
  const Vec3 at = draws.whole_point(extent);
  const Corners a = shape_with(draws, 1, at, extent);
  const Vec3 step = step_aside(draws);
  Corners b = shape_with(draws, 1 + draws.below(2), at + step, extent);
  if (draws.chance(4)) {  // on the line of a
    const Vec3 u = a[1] - a[0];
    const double i = draws.whole(-1, 1);
    b = {at + i * u, at + i * u, a[1]};
    if (draws.chance(2)) b[2] = b[0];
  }
  return in_units({a, b}, bits);
}

/// Neighbours by their coordinates along the axes of a frame.
MadePair fold(SuiteDraws& draws, const Corners& a, const Corners& b) {
  const Frame frame = draws.chance(2) ? straight_frame(draws) : leaning_frame(draws);
  MadePair out;
  for (int i = 0; i < 3; ++i) {
    out.a[i] = frame.at(a[i]);
    out.b[i] = frame.at(b[i]);
  }
  out.neighbours = true;
  return out;
}

/// Both have the edge from 0 to 1 on the x axis; a lies in the plane z = 0, and b's third corner is
/// above it by the height, on the side of a or on the other.
MadePair fold_edge(SuiteDraws& draws, double height) {
  const double x = draws.coarse(0.25, 1);
  const double y = draws.coarse(0.25, 1);
  const double u = draws.coarse(-0.5, 1.5);
  const double side = draws.chance(3) ? -1 : 1;
  const double v = side * draws.coarse(0.25, 1);
  const Vec3 p(0, 0, 0);
  const Vec3 q(1, 0, 0);
  return fold(draws, {p, q, Vec3(x, y, 0)}, {p, q, Vec3(u, v, height)});
}

/// Both have the corner 0; a lies in the plane z = 0. b has a corner above the inside of a by the
/// height, or below it where that is negative, and one far above.
MadePair fold_vertex(SuiteDraws& draws, double height) {
  const double x = draws.coarse(0.5, 1);
  const double y = draws.coarse(0.5, 1);
  const bool outside = draws.chance(4);
  const double u = draws.coarse(0.25, 1.25);
  const double v = outside ? -u : draws.coarse(-0.25, 0.25) * u;
  const double s = draws.coarse(-1, 1);
  const double t = draws.coarse(-1, 1);
  const double top = draws.coarse(0.25, 1);
  const Vec3 p(0, 0, 0);
  return fold(draws, {p, Vec3(x, -y, 0), Vec3(x, y, 0)}, {p, Vec3(u, v, height), Vec3(s, t, top)});
}

/// 0 a few times, and 2^-k and -2^-k.
std::vector<double> heights() {
  std::vector<double> out;
  for (const int k : {1, 4, 8, 12, 16, 20, 23, 24, 25, 28, 32, 36, 40, 44, 48, 50, 52}) {
    out.push_back(0);
    out.push_back(std::ldexp(1, -k));
    out.push_back(-std::ldexp(1, -k));
  }
  return out;
}

}  // namespace

std::vector<PairFamily> shape_families() {
  const std::vector<double> aspects = {1,   1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                       1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  return {
      {"random", "corners anywhere in a cube", "", {0}, random_pair},
      {"slivers", "long thin triangles that pass each other at about their width",
       "length over width", aspects, slivers},
      {"points", "a point and a point, a segment or a triangle", "bits of the coordinates", kBits,
       points},
      {"segments", "a segment and a segment or a triangle", "bits of the coordinates", kBits,
       segments},
      {"fold-edge", "neighbours with an edge in common, folded until they are flat",
       "height of the fold, of triangles of the size 1", heights(), fold_edge},
      {"fold-vertex", "neighbours with a corner in common, one above the face of the other",
       "the gap, of triangles of the size 1; negative below", heights(), fold_vertex},
  };
}

}  // namespace farcull
