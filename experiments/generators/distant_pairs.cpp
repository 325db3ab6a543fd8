// Families of pairs that vary distance (gaps on both sides of contact, distances from the origin,
// scales) or shape (random triangles, slivers, degenerate triangles, neighbours that fold).
#include <cmath>

#include "experiments/generators/pair_generators.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

/// 2^-k and -2^-k for each k below. 0 comes first; with zero_each, before each k.
std::vector<double> signed_powers(bool zero_each) {
  std::vector<double> out;
  for (const int k : {1, 4, 8, 12, 16, 20, 23, 24, 25, 28, 32, 36, 40, 44, 48, 50, 52}) {
    if (zero_each || out.empty()) out.push_back(0);
    out.push_back(std::ldexp(1, -k));
    out.push_back(-std::ldexp(1, -k));
  }
  return out;
}

Frame frame_of(RandomDraws& draws) {
  return draws.chance(2) ? straight_frame(draws) : leaning_frame(draws);
}

MadePair mapped(const Frame& frame, const Corners& a, const Corners& b) {
  MadePair out;
  for (int i = 0; i < 3; ++i) {
    out.a[i] = frame.at(a[i]);
    out.b[i] = frame.at(b[i]);
  }
  return out;
}

/// b has a corner above the inside of a, by the gap; a negative gap puts the corner below.
MadePair gap_face(RandomDraws& draws, double gap) {
  const Corners a = {Vec3(draws.coarse(-1, 0), -1, 0), Vec3(1, draws.coarse(-0.5, 0.5), 0),
                     Vec3(draws.coarse(-1, 0), 1, 0)};
  const double x = draws.coarse(0, 0.25);
  const double y = draws.coarse(-0.25, 0.25);
  const auto above = [&] {
    const double u = draws.coarse(-1, 1);
    const double v = draws.coarse(-1, 1);
    const double h = draws.coarse(0.25, 1);
    return Vec3(u, v, h);
  };
  const Corners b = {Vec3(x, y, gap), above(), above()};
  return mapped(frame_of(draws), a, b);
}

/// An edge of b crosses above an edge of a, by the gap; a negative gap puts it below.
MadePair gap_edge(RandomDraws& draws, double gap) {
  const double left = -draws.coarse(0.25, 1);
  const double right = draws.coarse(0.25, 1);
  const double depth = -draws.coarse(0.25, 1);
  const Corners a = {Vec3(left, 0, 0), Vec3(right, 0, 0), Vec3(draws.coarse(-1, 1), 0, depth)};
  const double back = -draws.coarse(0.25, 1);
  const double front = draws.coarse(0.25, 1);
  const double lean = draws.coarse(-0.25, 0.25);
  const double height = draws.coarse(0.25, 1);
  const double x = draws.coarse(-1, 1);
  const double y = draws.coarse(-1, 1);
  const Corners b = {Vec3(lean, back, gap), Vec3(-lean, front, gap), Vec3(x, y, height)};
  return mapped(frame_of(draws), a, b);
}

/// Two triangles of about the size 1 that may meet in any way.
MadePair near_pair(RandomDraws& draws) {
  const double side = draws.sign();
  const double gap = std::ldexp(side, -draws.below(12));
  const int kind = draws.below(3);
  if (kind == 0) return gap_face(draws, gap);
  if (kind == 1) return gap_edge(draws, gap);
  MadePair out;
  const Vec3 centre = draws.point() / 2;
  for (Vec3& p : out.a) p = draws.point();
  for (Vec3& p : out.b) p = centre + draws.point();
  return out;
}

/// A pair moved away from the origin, so that coordinates lose their last bits.
MadePair far_away(RandomDraws& draws, double distance) {
  MadePair pair = near_pair(draws);
  Vec3 to = draws.point();
  to[draws.below(3)] = draws.sign();
  each_corner(pair, [&](Vec3& p) { p += distance * to; });
  return pair;
}

/// A scaled pair; half of the time the scale is a power of two, which keeps contact exact.
MadePair scales(RandomDraws& draws, double scale) {
  MadePair pair = draws.chance(3) ? gap_face(draws, 0) : near_pair(draws);
  if (draws.chance(2)) {
    int exponent = 0;
    std::frexp(scale, &exponent);
    scale = std::ldexp(1, exponent);
  }
  each_corner(pair, [&](Vec3& p) { p *= scale; });
  return pair;
}

/// A triangle, and one that is `ratio` times smaller at a corner, an edge or the face of the first.
MadePair mixed_scales(RandomDraws& draws, double ratio) {
  const Frame frame = frame_of(draws);
  const auto drawn = [&] {
    const double x = draws.coarse(-1, 1);
    const double y = draws.coarse(-1, 1);
    const double z = draws.coarse(-1, 1);
    return Vec3(x, y, z);
  };
  Corners a = {drawn(), drawn(), drawn()};
  if (draws.chance(2)) {
    for (Vec3& p : a) p.z() = 0;  // in a plane of the frame: its points are not rounded out of it
  }
  const Vec3 at[] = {a[0], (a[0] + a[1]) / 2, (2 * a[0] + a[1] + a[2]) / 4};
  const Vec3 place = at[draws.below(3)];
  const Vec3 beside = draws.chance(3) ? Vec3(drawn() * 2) : Vec3::Zero();
  Corners b;
  for (Vec3& p : b) p = place + (beside + drawn()) / ratio;
  if (draws.chance(2)) b[0] = place + beside / ratio;
  return mapped(frame, a, b);
}

MadePair random_pair(RandomDraws& draws, double) {
  MadePair out;
  each_corner(out, [&](Vec3& p) { p = draws.point(); });
  return out;
}

/// A long edge through `centre`; the third corner is 1 / aspect away from the edge.
Corners sliver(RandomDraws& draws, const Vec3& centre, double aspect) {
  const Vec3 half = draws.point();
  const Vec3 beside = draws.point() / aspect;
  const double along = draws.between(-1, 1);
  return {centre - half, centre + half, centre + along * half + beside};
}

/// Two slivers whose long edges pass each other at about their width.
MadePair slivers(RandomDraws& draws, double aspect) {
  const Vec3 centre = draws.point();
  const Corners a = sliver(draws, centre, aspect);
  const bool contact = draws.chance(4);
  const Vec3 beside = contact ? Vec3::Zero() : Vec3(draws.point() / (2 * aspect));
  return {{a, sliver(draws, centre + beside, aspect)}};
}

const std::vector<double> kBits = {8, 16, 24, 32, 40, 50};

MadePair in_units(MadePair pair, double bits) {
  each_corner(pair, [&](Vec3& p) { p *= std::ldexp(1, -static_cast<int>(bits)); });
  return pair;
}

/// A point, a segment or a triangle (dimension 0, 1 or 2) that contains the point `at`: in its
/// inside, on an edge or as a corner.
Corners shape_with(RandomDraws& draws, int dimension, const Vec3& at, double extent) {
  if (dimension == 0) return {at, at, at};
  const Vec3 u = draws.whole_point(extent);
  if (dimension == 1) {
    const int way = draws.below(4);
    if (way == 0) return {at, at + u, at + u};  // the point is an end, and two corners are equal
    if (way == 1) return {at - u, at + u, at - u};
    if (way == 2) return {at - u, at + 2 * u, at + u};  // three corners on a line
    return {at - u, at, at + u};
  }
  const Vec3 v = draws.whole_point(extent);
  return with_point(draws.below(3), at, u, v);
}

/// The step by which b moves: one time in three up to a unit along each axis, else none.
Vec3 step_aside(RandomDraws& draws) {
  if (!draws.chance(3)) return Vec3::Zero();
  return draws.whole_point(1);
}

MadePair points(RandomDraws& draws, double bits) {
  const double extent = std::ldexp(1, static_cast<int>(bits) - 3);
  const Vec3 at = draws.whole_point(extent);
  const Corners a = {at, at, at};
  const Vec3 step = step_aside(draws);
  return in_units({{a, shape_with(draws, draws.below(3), at + step, extent)}}, bits);
}

MadePair segments(RandomDraws& draws, double bits) {
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
  return in_units({{a, b}}, bits);
}

/// Neighbours, from their coordinates along the axes of a frame.
MadePair fold(RandomDraws& draws, const Corners& a, const Corners& b) {
  MadePair out = mapped(frame_of(draws), a, b);
  out.neighbours = true;
  return out;
}

/// Both have the edge from 0 to 1 on the x axis. a lies in the plane z = 0; b's third corner is
/// above this plane by the height, on a's side of the edge or on the other side.
MadePair fold_edge(RandomDraws& draws, double height) {
  const double x = draws.coarse(0.25, 1);
  const double y = draws.coarse(0.25, 1);
  const double u = draws.coarse(-0.5, 1.5);
  const double side = draws.chance(3) ? -1 : 1;
  const double v = side * draws.coarse(0.25, 1);
  const Vec3 p(0, 0, 0);
  const Vec3 q(1, 0, 0);
  return fold(draws, {p, q, Vec3(x, y, 0)}, {p, q, Vec3(u, v, height)});
}

/// Both have the corner 0; a lies in the plane z = 0. A second corner of b is above a by the height
/// (below if it is negative), mostly over the inside of a; the third is far above.
MadePair fold_vertex(RandomDraws& draws, double height) {
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

const std::vector<double> kTo1e15 = {1,   1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                     1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

}  // namespace

std::vector<PairFamily> distance_families() {
  const std::vector<double> magnitudes = {1e-150, 1e-120, 1e-100, 1e-80, 1e-60, 1e-40, 1e-30, 1e-20,
                                          1e-15,  1e-10,  1e-5,   1,     1e5,   1e10,  1e15,  1e20,
                                          1e30,   1e40,   1e60,   1e80,  1e100, 1e120, 1e150};
  return {
      {"gap-face", "a corner above a face, or below it",
       "the gap, of triangles of the size 1; negative below", signed_powers(false), gap_face},
      {"gap-edge", "an edge above an edge, or below it",
       "the gap, of triangles of the size 1; negative below", signed_powers(false), gap_edge},
      {"far-away", "moved away from the origin", "the distance, in sizes of the triangles", kTo1e15,
       far_away},
      {"scales", "tiny and huge triangles", "the size", magnitudes, scales},
      {"mixed-scales", "a triangle and a small one at it", "the ratio of their sizes", kTo1e15,
       mixed_scales},
  };
}

std::vector<PairFamily> shape_families() {
  return {
      {"random", "corners anywhere in a cube", "", {0}, random_pair},
      {"slivers", "long thin triangles that pass each other at about their width",
       "length over width", kTo1e15, slivers},
      {"points", "a point and a point, a segment or a triangle", "bits of the coordinates", kBits,
       points},
      {"segments", "a segment and a segment or a triangle", "bits of the coordinates", kBits,
       segments},
      {"fold-edge", "neighbours with an edge in common, folded until they are flat",
       "height of the fold, of triangles of the size 1", signed_powers(true), fold_edge},
      {"fold-vertex", "neighbours with a corner in common, one above the face of the other",
       "the gap, of triangles of the size 1; negative below", signed_powers(true), fold_vertex},
  };
}

}  // namespace farcull
