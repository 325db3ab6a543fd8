// Pairs whose triangles have one common point, or lie in one plane. They are made of whole numbers
// with ever more bits, so that the contact is exact; b is then moved by one unit in one pair of
// three. This file also has the list of all families of pairs.
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/random.h"
#include "experiments/generators/pair_generators.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

const std::vector<double> kBits = {8, 16, 24, 32, 40, 52};

/// `v`, or -v if `v` points against `towards`.
Vec3 along(const Vec3& v, const Vec3& towards) { return v.dot(towards) < 0 ? Vec3(-v) : v; }

Vec3 normal(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

/// A triangle whose coordinates are multiples of 4, so that their quarters are whole. The extents
/// below keep all sums of a contact under 2^bits.
Corners first_triangle(RandomDraws& draws, double bits) {
  const double extent = std::ldexp(1, static_cast<int>(bits) - 4);
  return {4 * draws.whole_point(extent), 4 * draws.whole_point(extent),
          4 * draws.whole_point(extent)};
}

Vec3 arm(RandomDraws& draws, double bits) {
  return draws.whole_point(std::ldexp(1, static_cast<int>(bits) - 3));
}

/// Moves b by a unit one time in three, and scales all coordinates by 2^-bits, so they are below 1.
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

/// True three times in four: b then keeps to one side of a. Else b goes to any side of the contact
/// point.
bool keeps_aside(RandomDraws& draws) { return !draws.chance(4); }

MadePair vertex_vertex(RandomDraws& draws, double bits) {
  const Corners a = first_triangle(draws, bits);
  Vec3 u = arm(draws, bits);
  Vec3 v = arm(draws, bits);
  if (keeps_aside(draws)) {
    const Vec3 away = 2 * a[0] - a[1] - a[2];
    u = along(u, away);
    v = along(v, away);
  }
  return finished(draws, bits, a, {a[0], a[0] + u, a[0] + v});
}

/// b has a corner at `at`, a point of a.
MadePair corner_at(RandomDraws& draws, double bits, const Corners& a, const Vec3& at) {
  Vec3 u = arm(draws, bits);
  Vec3 v = arm(draws, bits);
  if (keeps_aside(draws)) {
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

/// b has an edge in the plane of a: parallel to an edge of a from a point inside a, or that edge
/// itself.
MadePair edge_face(RandomDraws& draws, double bits) {
  const Corners a = first_triangle(draws, bits);
  const Vec3 quarter = (a[1] - a[0]) / 4;
  const bool hinge = draws.chance(4);
  const Vec3 at = hinge ? a[0] : Vec3((2 * a[0] + a[1] + a[2]) / 4);
  const Vec3 to = hinge ? a[1] : Vec3(at + draws.whole(1, 3) * quarter);
  Vec3 v = arm(draws, bits);
  if (keeps_aside(draws)) v = along(v, normal(a) * draws.sign());
  return finished(draws, bits, a, {at, to, at + v});
}

MadePair edge_edge(RandomDraws& draws, double bits) {
  const Corners a = first_triangle(draws, bits);
  const double weight = draws.whole(1, 3);
  const Vec3 at = (weight * a[0] + (4 - weight) * a[1]) / 4;
  const Vec3 u = arm(draws, bits);
  Vec3 v = arm(draws, bits);
  if (keeps_aside(draws)) {
    // The plane of both edges has a on one side; v points to the other side.
    const Vec3 across = (a[1] - a[0]).cross(u);
    v = along(v, across.dot(a[2] - at) > 0 ? Vec3(-across) : across);
  }
  return finished(draws, bits, a, {at - u, at + draws.whole(1, 3) * u, at + v});
}

/// Two triangles of one plane: their corners are whole combinations of two whole vectors.
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
  if (way == 0) {  // both have an edge in common
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

/// Two triangles of one plane. b is then moved by `steps` of the shortest steps: out of the plane,
/// or in the plane across the edge at which both touch.
MadePair coplanar_step(RandomDraws& draws, double steps) {
  const bool leaning = draws.chance(2);
  const Frame frame = leaning ? leaning_frame(draws) : straight_frame(draws);
  constexpr double kExtent = 0x1p44;
  const auto drawn = [&] { return draws.whole(-kExtent, kExtent); };
  // a is below the edge from (0, 0) to (length, 0). If b moves in the plane, it is above that edge.
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
  // If b moves out of the plane, it is on a's side, so that without the move both would overlap.
  const double top = in_plane ? height : -height;
  const double from = std::floor(in_plane ? shift : length / 4);
  pair.b = {at(from, step, out), at(from + std::floor(length / 2), step, out),
            at(from, top + step, out)};
  each_corner(pair, [&](Vec3& p) { p *= 0x1p-48; });
  return pair;
}

/// A copy of a triangle, moved along one axis of the coordinates.
MadePair duplicates(RandomDraws& draws, double units) {
  constexpr double kExtent = 0x1p50;
  MadePair out;
  for (Vec3& p : out.a) p = draws.whole_point(kExtent);
  const bool level = draws.chance(3);  // parallel to a plane of the coordinates
  const int axis = draws.below(3);
  if (level) out.a[1][axis] = out.a[2][axis] = out.a[0][axis];
  out.b = out.a;
  const int moved = draws.chance(2) ? axis : draws.below(3);
  const double by = units * draws.sign();
  for (Vec3& p : out.b) p[moved] += by;
  if (units == 0) {
    out.neighbours = draws.chance(3);
    // b equals a but for one corner, which moves by one unit.
    if (!out.neighbours && draws.chance(2)) out.b[draws.below(3)][moved] += draws.sign();
  }
  each_corner(out, [&](Vec3& p) { p *= 0x1p-50; });
  return out;
}

std::vector<PairFamily> contact_families() {
  const std::string bits = "bits of the coordinates";
  return {
      {"vertex-vertex", "a corner on a corner, or one unit beside it", bits, kBits, vertex_vertex},
      {"vertex-edge", "a corner on an edge, or one unit beside it", bits, kBits, vertex_edge},
      {"vertex-face", "a corner on a face, or one unit beside it", bits, kBits, vertex_face},
      {"edge-face", "an edge in a face, or one unit beside it", bits, kBits, edge_face},
      {"edge-edge", "an edge across an edge, or one unit beside it", bits, kBits, edge_edge},
      {"coplanar", "in one plane: overlapping, touching, apart, or one unit out of it", bits, kBits,
       coplanar},
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
  };
}

}  // namespace

std::uint64_t seed_of_item(std::uint64_t seed, std::string_view name, std::uint64_t number) {
  std::uint64_t out = scrambled(seed + kGolden);
  for (const char c : name) out = scrambled(out + static_cast<unsigned char>(c));
  return scrambled(out + number);
}

const std::vector<PairFamily>& pair_families() {
  static const std::vector<PairFamily> families = [] {
    std::vector<PairFamily> out;
    for (auto* part : {&shape_families, &contact_families, &distance_families}) {
      std::vector<PairFamily> more = part();
      out.insert(out.end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
    }
    return out;
  }();
  return families;
}

}  // namespace farcull
