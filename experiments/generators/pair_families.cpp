// Makes the pairs of triangles of the test suite. docs/suite.md describes each family of pairs.
#include <cmath>

#include "experiments/generators/pair_generators.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

/// Returns the rotation matrix of the quaternion w + xi + yj + zk, times its squared length.
Frame scaled_rotation(double w, double x, double y, double z) {
  const Vec3 first(w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y));
  const Vec3 second(2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x));
  const Vec3 third(2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z);
  return {{first, second, third}};
}

/// Returns the three coordinate axes, in random order and with random signs.
Frame straight_frame(RandomDraws& draws) {
  Frame out{{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}};
  std::swap(out.axis[0], out.axis[draws.below(3)]);
  std::swap(out.axis[1], out.axis[1 + draws.below(2)]);
  for (Vec3& axis : out.axis) axis *= draws.sign();
  return out;
}

// The families of contacts: the two triangles touch in a point or a segment, or lie in one plane.
// The parameter is the number of bits of the integer coordinates.

const std::vector<double> kContactBits = {8, 16, 24, 32, 40, 52};

/// Returns v, or -v if the angle between v and `towards` is above 90 degrees.
Vec3 along(const Vec3& v, const Vec3& towards) { return v.dot(towards) < 0 ? Vec3(-v) : v; }

Vec3 normal(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

/// Returns a triangle whose coordinates are multiples of 4. The extents here and in arm() keep all
/// coordinates of a pair below 2^bits.
Corners first_triangle(RandomDraws& draws, double bits) {
  const double extent = std::ldexp(1, static_cast<int>(bits) - 4);
  return {4 * draws.whole_point(extent), 4 * draws.whole_point(extent),
          4 * draws.whole_point(extent)};
}

Vec3 arm(RandomDraws& draws, double bits) {
  return draws.whole_point(std::ldexp(1, static_cast<int>(bits) - 3));
}

/// Returns the pair, scaled by 2^-bits. In 1 of 3 calls, b first moves by -1, 0 or 1 along each
/// axis.
MadePair finished(RandomDraws& draws, double bits, const Corners& a, Corners b) {
  if (draws.chance(3)) {
    const Vec3 step = draws.whole_point(1);
    for (Vec3& p : b) p += step;
  }
  const double unit = std::ldexp(1, -static_cast<int>(bits));
  MadePair out{{a, b}};
  each_corner(out, [&](Vec3& p) { p *= unit; });
  return out;
}

/// Returns true with probability 3/4. If true, the caller keeps b on one side of a.
bool stays_aside(RandomDraws& draws) { return !draws.chance(4); }

MadePair vertex_vertex(RandomDraws& draws, double bits) {
  const Corners a = first_triangle(draws, bits);
  Vec3 u = arm(draws, bits);
  Vec3 v = arm(draws, bits);
  if (stays_aside(draws)) {
    const Vec3 away = 2 * a[0] - a[1] - a[2];
    u = along(u, away);
    v = along(v, away);
  }
  return finished(draws, bits, a, {a[0], a[0] + u, a[0] + v});
}

/// Returns a pair in which b has a corner at `at`, a point of a.
MadePair corner_at(RandomDraws& draws, double bits, const Corners& a, const Vec3& at) {
  Vec3 u = arm(draws, bits);
  Vec3 v = arm(draws, bits);
  if (stays_aside(draws)) {
    const Vec3 up = normal(a) * draws.sign();
    u = along(u, up);
    v = along(v, up);
  }
  return finished(draws, bits, a, {at, at + u, at + v});
}

MadePair vertex_edge(RandomDraws& draws, double bits) {
  const Corners a = first_triangle(draws, bits);
  const double weight = draws.whole(1, 3);
  return corner_at(draws, bits, a, (weight * a[0] + (4 - weight) * a[1]) / 4);
}

MadePair vertex_face(RandomDraws& draws, double bits) {
  const Corners a = first_triangle(draws, bits);
  return corner_at(draws, bits, a, (2 * a[0] + a[1] + a[2]) / 4);
}

/// Makes a pair in which b has an edge in the plane of a. This edge is an edge of a, or begins
/// inside a and is parallel to an edge of a.
MadePair edge_face(RandomDraws& draws, double bits) {
  const Corners a = first_triangle(draws, bits);
  const Vec3 quarter = (a[1] - a[0]) / 4;
  const bool hinge = draws.chance(4);
  const Vec3 at = hinge ? a[0] : Vec3((2 * a[0] + a[1] + a[2]) / 4);
  const Vec3 to = hinge ? a[1] : Vec3(at + draws.whole(1, 3) * quarter);
  Vec3 v = arm(draws, bits);
  if (stays_aside(draws)) v = along(v, normal(a) * draws.sign());
  return finished(draws, bits, a, {at, to, at + v});
}

MadePair edge_edge(RandomDraws& draws, double bits) {
  const Corners a = first_triangle(draws, bits);
  const double weight = draws.whole(1, 3);
  const Vec3 at = (weight * a[0] + (4 - weight) * a[1]) / 4;
  const Vec3 u = arm(draws, bits);
  Vec3 v = arm(draws, bits);
  if (stays_aside(draws)) {
    // Corner a[2] is on one side of the plane of both edges. v points to the other side.
    const Vec3 across = (a[1] - a[0]).cross(u);
    v = along(v, across.dot(a[2] - at) > 0 ? Vec3(-across) : across);
  }
  return finished(draws, bits, a, {at - u, at + draws.whole(1, 3) * u, at + v});
}

/// Makes two triangles in one plane. Each corner is `origin` plus integer multiples of u and v.
MadePair coplanar(RandomDraws& draws, double bits) {
  const double extent = std::ldexp(1, static_cast<int>(bits) - 5);
  const Vec3 u = draws.whole_point(extent);
  const Vec3 v = draws.whole_point(extent);
  const Vec3 origin = draws.whole_point(extent);
  const auto corner = [&](double i, double j) { return Vec3(origin + i * u + j * v); };
  const auto drawn = [&] {
    const double i = draws.whole(-5, 5);
    const double j = draws.whole(-5, 5);
    return corner(i, j);
  };
  Corners a = {drawn(), drawn(), drawn()};
  Corners b = {drawn(), drawn(), drawn()};
  const int way = draws.below(4);
  if (way == 0) {  // a and b have a common edge
    b[0] = a[0];
    b[1] = a[1];
  }
  if (way == 1) {  // b is a copy of a, moved in the plane
    const double i = draws.whole(-2, 2);
    const double j = draws.whole(-2, 2);
    const Vec3 move = i * u + j * v;
    for (int c = 0; c < 3; ++c) b[c] = a[c] + move;
  }
  return finished(draws, bits, a, b);
}

/// Makes two triangles in one plane that touch along an edge, or overlap. Then moves b by `steps`
/// times an axis of the frame: in the plane, perpendicular to the edge, or out of the plane.
MadePair coplanar_step(RandomDraws& draws, double steps) {
  const bool leaning = draws.chance(2);
  const Frame frame = leaning ? leaning_frame(draws) : straight_frame(draws);
  constexpr double kExtent = 0x1p44;
  const auto drawn = [&] { return draws.whole(-kExtent, kExtent); };
  // a is below the edge from (0, 0) to (length, 0). b is above that edge if b moves in the plane.
  const double length = draws.whole(kExtent / 2, kExtent);
  const double depth = draws.whole(1, kExtent);
  const double height = draws.whole(1, kExtent);
  const Vec3 origin = draws.whole_point(kExtent);
  const bool in_plane = draws.chance(2);
  const double step = in_plane ? steps * draws.sign() : 0;
  const double out = in_plane ? 0 : steps * draws.sign();
  const auto at = [&](double x, double y, double z) { return Vec3(origin + frame.at(x, y, z)); };
  const double shift = drawn() / 2;
  MadePair pair;
  pair.a = {at(0, 0, 0), at(length, 0, 0), at(drawn(), -depth, 0)};
  // If b moves out of the plane, b is on the same side of the edge as a. Without the move, a and b
  // would overlap.
  const double top = in_plane ? height : -height;
  const double from = std::floor(in_plane ? shift : length / 4);
  pair.b = {at(from, step, out), at(from + std::floor(length / 2), step, out),
            at(from, top + step, out)};
  each_corner(pair, [&](Vec3& p) { p *= 0x1p-48; });
  return pair;
}

MadePair duplicates(RandomDraws& draws, double units) {
  constexpr double kExtent = 0x1p50;
  MadePair out;
  for (Vec3& p : out.a) p = draws.whole_point(kExtent);
  const bool level = draws.chance(3);  // true: a is parallel to a coordinate plane
  const int axis = draws.below(3);
  if (level) out.a[1][axis] = out.a[2][axis] = out.a[0][axis];
  out.b = out.a;
  const int moved = draws.chance(2) ? axis : draws.below(3);
  const double by = units * draws.sign();
  for (Vec3& p : out.b) p[moved] += by;
  if (units == 0) {
    out.neighbours = draws.chance(3);
    // b equals a. Moves one corner of b by one unit.
    if (!out.neighbours && draws.chance(2)) out.b[draws.below(3)][moved] += draws.sign();
  }
  each_corner(out, [&](Vec3& p) { p *= 0x1p-50; });
  return out;
}

// Families of triangles with a small gap, and families of shapes: slivers, points, segments, folds.

/// Returns 0, then 2^-k and -2^-k for each k in the list. zero_each: puts 0 before each 2^-k.
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

MadePair far_away(RandomDraws& draws, double distance) {
  MadePair pair = near_pair(draws);
  Vec3 to = draws.point();
  to[draws.below(3)] = draws.sign();
  each_corner(pair, [&](Vec3& p) { p += distance * to; });
  return pair;
}

/// Returns a scaled pair. In half of the calls, the scale is a power of two: contacts stay exact.
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
    for (Vec3& p : a) p.z() = 0;
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

/// Returns a triangle with a long edge through `centre`. Its third corner is about 1 / aspect away
/// from the edge.
Corners sliver(RandomDraws& draws, const Vec3& centre, double aspect) {
  const Vec3 half = draws.point();
  const Vec3 beside = draws.point() / aspect;
  const double along = draws.between(-1, 1);
  return {centre - half, centre + half, centre + along * half + beside};
}

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

/// Returns a point, a segment or a triangle (dimension 0, 1 or 2) that contains the point `at`.
Corners shape_with(RandomDraws& draws, int dimension, const Vec3& at, double extent) {
  if (dimension == 0) return {at, at, at};
  const Vec3 u = draws.whole_point(extent);
  if (dimension == 1) {
    const int way = draws.below(4);
    if (way == 0) return {at, at + u, at + u};
    if (way == 1) return {at - u, at + u, at - u};
    if (way == 2) return {at - u, at + 2 * u, at + u};
    return {at - u, at, at + u};
  }
  const Vec3 v = draws.whole_point(extent);
  return with_point(draws.below(3), at, u, v);
}

/// Returns a step for b: with probability 1/3, -1, 0 or 1 along each axis; else the zero vector.
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
  if (draws.chance(4)) {  // b lies on the line of a
    const Vec3 u = a[1] - a[0];
    const double i = draws.whole(-1, 1);
    b = {at + i * u, at + i * u, a[1]};
    if (draws.chance(2)) b[2] = b[0];
  }
  return in_units({{a, b}}, bits);
}

/// Returns a pair of neighbours. a, b: corners in the coordinates of a random frame.
MadePair fold(RandomDraws& draws, const Corners& a, const Corners& b) {
  MadePair out = mapped(frame_of(draws), a, b);
  out.neighbours = true;
  return out;
}

/// Makes a and b with a common edge, from 0 to 1 on the x axis. a lies in the plane z = 0. The
/// third corner of b is `height` above this plane, on either side of the edge.
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

/// Makes a and b with a common corner at the origin. a lies in the plane z = 0. The second corner
/// of b is `height` above the plane, mostly over the interior of a. The third corner is far above.
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
const std::vector<double> kMagnitudes = {1e-150, 1e-120, 1e-100, 1e-80, 1e-60, 1e-40, 1e-30, 1e-20,
                                         1e-15,  1e-10,  1e-5,   1,     1e5,   1e10,  1e15,  1e20,
                                         1e30,   1e40,   1e60,   1e80,  1e100, 1e120, 1e150};

}  // namespace

std::uint64_t seed_of_item(std::uint64_t seed, std::string_view name, std::uint64_t number) {
  std::uint64_t out = scrambled(seed + kGolden);
  for (const char c : name) out = scrambled(out + static_cast<unsigned char>(c));
  return scrambled(out + number);
}

void shuffle(RandomDraws& draws, DrawnPair& pair) {
  for (std::array<Vec3, 3>* t : {&pair.a, &pair.b}) {
    std::swap((*t)[0], (*t)[draws.below(3)]);
    std::swap((*t)[1], (*t)[1 + draws.below(2)]);
  }
  if (draws.chance(2)) std::swap(pair.a, pair.b);
}

Frame leaning_frame(RandomDraws& draws) {
  const double w = draws.sign();
  const double x = draws.sign();
  const double y = draws.sign();
  // One part is 0: a quaternion with all four parts +-1 would only permute the coordinate axes.
  return scaled_rotation(w, x, y, 0);
}

Frame turned_frame(RandomDraws& draws) {
  const double w = draws.whole(1, 9);
  const double x = draws.whole(-9, 9);
  const double y = draws.whole(-9, 9);
  const double z = draws.whole(-9, 9);
  Frame out = scaled_rotation(w, x, y, z);
  const double square = w * w + x * x + y * y + z * z;
  for (Vec3& axis : out.axis) axis /= square;
  return out;
}

const std::vector<PairFamily>& pair_families() {
  const std::string bits = "bits of the coordinates";
  const std::string gap = "the gap, of triangles of the size 1; negative below";
  static const std::vector<PairFamily> families = {
      {"random", "corners anywhere in a cube", "", {0}, random_pair},
      {"slivers", "long thin triangles that pass each other at about their width",
       "length over width", kTo1e15, slivers},
      {"points", "a point and a point, a segment or a triangle", bits, kBits, points},
      {"segments", "a segment and a segment or a triangle", bits, kBits, segments},
      {"fold-edge", "neighbours with an edge in common, folded until they are flat",
       "height of the fold, of triangles of the size 1", signed_powers(true), fold_edge},
      {"fold-vertex", "neighbours with a corner in common, one above the face of the other", gap,
       signed_powers(true), fold_vertex},
      {"vertex-vertex", "a corner on a corner, or one unit beside it", bits, kContactBits,
       vertex_vertex},
      {"vertex-edge", "a corner on an edge, or one unit beside it", bits, kContactBits,
       vertex_edge},
      {"vertex-face", "a corner on a face, or one unit beside it", bits, kContactBits, vertex_face},
      {"edge-face", "an edge in a face, or one unit beside it", bits, kContactBits, edge_face},
      {"edge-edge", "an edge across an edge, or one unit beside it", bits, kContactBits, edge_edge},
      {"coplanar", "in one plane: overlapping, touching, apart, or one unit out of it", bits,
       kContactBits, coplanar},
      {"coplanar-step",
       "moved out of a common plane, or in it over the edge where both touch",
       "shortest steps by which it is moved",
       {0, 1, 2, 4, 16, 1024, 1048576},
       coplanar_step},
      {"duplicates",
       "a triangle and its copy, moved along an axis",
       "units of 2^-50 of the extent",
       {0, 1, 2, 4, 16, 1024, 1048576},
       duplicates},
      {"gap-face", "a corner above a face, or below it", gap, signed_powers(false), gap_face},
      {"gap-edge", "an edge above an edge, or below it", gap, signed_powers(false), gap_edge},
      {"far-away", "moved away from the origin", "the distance, in sizes of the triangles", kTo1e15,
       far_away},
      {"scales", "tiny and huge triangles", "the size", kMagnitudes, scales},
      {"mixed-scales", "a triangle and a small one at it", "the ratio of their sizes", kTo1e15,
       mixed_scales},
  };
  return families;
}

}  // namespace farcull
