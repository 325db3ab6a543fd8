// Scenes for benchmarks with machine parts in contact: a plug in its socket, and a part cut in two.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

// A plug of six pins in its socket, triangulated as CAD tessellators do: flat faces with round
// holes as fans of slivers, cylinder walls as quads of the part's full length, split in two.

using namespace shapes;

namespace {

// Vertices around a face, counterclockwise seen from outside of the part.
using Loop = std::vector<std::uint32_t>;

struct Circle {
  Vec3 centre, u, v;  // u and v are unit vectors in its plane
  double radius;
};

class Part {
 public:
  bool inside_out = false;  // the added triangles face the other way

  Vec3 at(std::uint32_t vertex) const { return vertices_[vertex]; }
  std::uint32_t point(const Vec3& p) {
    vertices_.push_back(p);
    return static_cast<std::uint32_t>(vertices_.size() - 1);
  }
  Loop circle(const Circle& c, std::uint32_t sides, double phase) {
    Loop out;
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = kTurn * (i + phase) / sides;
      out.push_back(
          point(c.centre + c.radius * std::cos(angle) * c.u + c.radius * std::sin(angle) * c.v));
    }
    return out;
  }
  void quad(const std::array<std::uint32_t, 4>& corners) {
    add(corners[0], corners[1], corners[2]);
    add(corners[0], corners[2], corners[3]);
  }
  // A wall between loops of equally many vertices.
  void wall(const Loop& from, const Loop& to) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      const std::size_t next = (i + 1) % from.size();
      quad({from[i], from[next], to[next], to[i]});
    }
  }
  void fan(const Loop& loop) {
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) add(loop[0], loop[i], loop[i + 1]);
  }
  // Fills the region between a loop and a round hole in it; all of the loop is visible from the
  // middle of the hole. Each side of the hole is joined to the corner of the loop nearest in angle.
  void holed(const Loop& outer, const Loop& hole) {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : hole) middle += at(v) / static_cast<double>(hole.size());
    const auto towards = [&](std::uint32_t v) { return Vec3((at(v) - middle).normalized()); };
    const Vec3 up = towards(hole[0]).cross(towards(hole[1]));
    std::size_t begin = 0;
    for (std::size_t j = 1; j < hole.size(); ++j) {
      if (towards(hole[j]).dot(towards(outer[0])) > towards(hole[begin]).dot(towards(outer[0])))
        begin = j;
    }
    for (std::size_t i = 0, j = 0; i < outer.size() || j < hole.size();) {
      const std::uint32_t here = outer[i % outer.size()], next = outer[(i + 1) % outer.size()];
      const std::uint32_t in = hole[(begin + j) % hole.size()];
      const std::uint32_t after = hole[(begin + j + 1) % hole.size()];
      const Vec3 bisector = towards(here) + towards(next);
      const bool passed = bisector.cross(towards(in) + towards(after)).dot(up) >= 0;
      if (j == hole.size() || (i < outer.size() && passed)) {
        add(here, next, in);
        ++i;
      } else {
        add(here, after, in);
        ++j;
      }
    }
  }
  // The mesh rotated: its axes become x, y and z.
  Mesh placed(const Vec3& x, const Vec3& y, const Vec3& z) && {
    for (Vec3& p : vertices_) p = Vec3(p.x() * x + p.y() * y + p.z() * z);
    return finished(std::move(vertices_), std::move(triangles_));
  }

 private:
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (inside_out) std::swap(b, c);
    triangles_.push_back({a, b, c});
  }
  std::vector<Vec3> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

constexpr double kDeep = 6;           // depth of the socket; its face, 3 x 2, lies at z = 0
constexpr double kLong = 5.7;         // length of the pins
constexpr double kPlay = 0.02;        // gap between the faces of plug and socket
constexpr double kThick = 0.3;        // thickness of the plate of the plug
constexpr double kRound = 0.2;        // radius of the upright edges
constexpr double kFillet = 0.06;      // radius of the fillet at the root of a pin
constexpr double kChamfer = 0.1;      // chamfer of a bore
constexpr double kFloor = 0.15;       // thickness of the socket below its bores
constexpr double kTip = 0.05;         // chamfer of a pin
constexpr double kClearance = 0.005;  // radius of a bore minus that of a loose pin
constexpr std::uint32_t kBores = 6;
constexpr std::uint32_t kFillets = 2;  // steps of a fillet

// The outline of the part at a height, in pieces between the corners of its six cells: along the
// lower side, then the right, the upper and the left one.
struct Outline {
  std::array<std::uint32_t, 4> side;  // (-0.5, -1), (0.5, -1), (0.5, 1), (-0.5, 1)
  std::uint32_t right, left;          // (1.5, 0), (-1.5, 0)
  std::array<Loop, 4> arc;            // lower right, upper right, upper left, lower left

  Loop loop() const {
    Loop out = arc[0];
    out.push_back(right);
    out.insert(out.end(), arc[1].begin(), arc[1].end());
    out.insert(out.end(), {side[2], side[3]});
    out.insert(out.end(), arc[2].begin(), arc[2].end());
    out.push_back(left);
    out.insert(out.end(), arc[3].begin(), arc[3].end());
    out.insert(out.end(), {side[0], side[1]});
    return out;
  }
};

Outline outline(Part& part, double z, std::uint32_t sides) {
  Outline out{};
  const auto at = [&](double x, double y) { return part.point({x, y, z}); };
  out.side = {at(-0.5, -1), at(0.5, -1), at(0.5, 1), at(-0.5, 1)};
  out.right = at(1.5, 0);
  out.left = at(-1.5, 0);
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = k < 2 ? 1.5 - kRound : kRound - 1.5;
    const double y = k == 1 || k == 2 ? 1 - kRound : kRound - 1;
    for (std::uint32_t i = 0; i <= sides; ++i) {
      const double angle = kTurn / 4 * (static_cast<double>(k) - 1 + 1.0 * i / sides);
      out.arc[k].push_back(at(x + kRound * std::cos(angle), y + kRound * std::sin(angle)));
    }
  }
  return out;
}

// The middles of the cells, in the order of cells().
Vec3 middle(std::uint32_t cell, double z) {
  const double x[] = {-1, 0, 1, 1, 0, -1};
  return {x[cell], cell < 3 ? -0.5 : 0.5, z};
}

// The six cells of the face within an outline, 1 x 1 each except at the rounded corners,
// counterclockwise seen from above.
std::array<Loop, kBores> cells(Part& part, const Outline& o, double z) {
  const std::uint32_t west = part.point({-0.5, 0, z});
  const std::uint32_t east = part.point({0.5, 0, z});
  const auto around = [](Loop before, const Loop& arc, const Loop& after) {
    before.insert(before.end(), arc.begin(), arc.end());
    before.insert(before.end(), after.begin(), after.end());
    return before;
  };
  return {around({west, o.left}, o.arc[3], {o.side[0]}),
          Loop{o.side[0], o.side[1], east, west},
          around({east, o.side[1]}, o.arc[0], {o.right}),
          around({east, o.right}, o.arc[1], {o.side[2]}),
          Loop{west, east, o.side[2], o.side[3]},
          around({west, o.side[3]}, o.arc[2], {o.left})};
}

// A flat panel between two corners of the outline below and above, with a round recess.
void panel(Part& part, const std::array<std::uint32_t, 4>& corners, std::uint32_t sides) {
  const Vec3 along = part.at(corners[1]) - part.at(corners[0]);
  const double length = std::sqrt(along.squaredNorm());
  const Vec3 centre = (part.at(corners[0]) + part.at(corners[2])) / 2;
  const Circle rim{centre, along / length, Vec3::UnitZ(), 0.3 * length};
  Circle deep = rim;
  deep.centre -= 0.08 * rim.u.cross(rim.v);
  const Loop edge = part.circle(rim, sides, 0.5);
  const Loop floor = part.circle(deep, sides, 0.5);
  part.holed({corners.begin(), corners.end()}, edge);
  part.wall(edge, floor);
  part.fan(floor);
}

// A bore with a core in it, or a pin with a hole in it.
struct Bore {
  Vec3 middle;  // at z = 0
  double radius, phase;
  double inner;  // radius of the core or the hole; 0: none
  std::uint32_t sides;
};

Circle flat(const Vec3& middle, double z, double radius) {
  return {middle + z * Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY(), radius};
}

// Circles about the axis of a bore or a pin, each joined to the one before.
class Chain {
 public:
  Chain(Part& part, const Bore& bore, double z, double radius)
      : part_(part), bore_(bore), last_(loop(z, radius)) {}
  void to(double z, double radius) {
    const Loop next = loop(z, radius);
    part_.wall(last_, next);
    last_ = next;
  }
  const Loop& last() const { return last_; }

 private:
  Loop loop(double z, double radius) const {
    return part_.circle(flat(bore_.middle, z, radius), bore_.sides, bore_.phase);
  }
  Part& part_;
  const Bore& bore_;
  Loop last_;
};

void bore(Part& part, const Loop& cell, const Bore& bore) {
  Chain chain(part, bore, 0, bore.radius + kChamfer);
  part.holed(cell, chain.last());
  chain.to(-kChamfer, bore.radius);
  chain.to(kFloor - kDeep, bore.radius);
  if (bore.inner > 0) {
    chain.to(kFloor - kDeep, bore.inner);
    chain.to(-kChamfer, bore.inner);
  }
  part.fan(chain.last());
}

Part socket(const std::array<Bore, kBores>& bores, std::uint32_t sides) {
  Part part;
  const std::uint32_t coarse = std::max<std::uint32_t>(3, sides / 2);
  const Outline face = outline(part, 0, std::max<std::uint32_t>(2, sides / 8));
  const Outline back = outline(part, -kDeep, std::max<std::uint32_t>(2, sides / 8));
  const Loop above = face.loop(), below = back.loop();
  for (std::size_t i = 0; i < above.size(); ++i) {
    const std::size_t next = (i + 1) % above.size();
    const std::array<std::uint32_t, 4> corners = {below[i], below[next], above[next], above[i]};
    if ((part.at(above[next]) - part.at(above[i])).norm() > 0.6) {
      panel(part, corners, coarse);
    } else {
      part.quad(corners);
    }
  }
  const std::array<Loop, kBores> of_face = cells(part, face, 0);
  for (std::uint32_t b = 0; b < kBores; ++b) bore(part, of_face[b], bores[b]);
  part.inside_out = true;
  const Loop rim = part.circle(flat(Vec3::Zero(), -kDeep, 0.7), sides, 0);
  const Loop floor = part.circle(flat(Vec3::Zero(), 0.1 - kDeep, 0.7), sides, 0);
  part.holed(below, rim);
  part.wall(rim, floor);
  part.fan(floor);
  return part;
}

// A pin from its fillet in the lower face of the plate to its tip, and the hole in it.
void pin(Part& part, const Loop& cell, const Bore& pin) {
  Chain chain(part, pin, kPlay, pin.radius + kFillet);
  part.holed(cell, chain.last());
  for (std::uint32_t k = 1; k <= kFillets; ++k) {
    const double angle = kTurn / 4 * k / kFillets;
    chain.to(kPlay - kFillet * (1 - std::cos(angle)), pin.radius + kFillet * (1 - std::sin(angle)));
  }
  chain.to(kTip - kLong, pin.radius);
  chain.to(-kLong, pin.radius - kTip);
  if (pin.inner > 0) {
    chain.to(-kLong, pin.inner);
    chain.to(0, pin.inner);
  }
  part.fan(chain.last());
}

Part plug(const std::array<Bore, kBores>& pins, std::uint32_t sides) {
  Part part;
  const Outline below = outline(part, kPlay, std::max<std::uint32_t>(2, sides / 8));
  const Outline above = outline(part, kPlay + kThick, std::max<std::uint32_t>(2, sides / 8));
  part.wall(below.loop(), above.loop());
  const Loop root = part.circle(flat(Vec3::Zero(), kPlay + kThick, 0.7), sides, 0);
  const Loop top = part.circle(flat(Vec3::Zero(), kPlay + 3 * kThick, 0.65), sides, 0);
  part.holed(above.loop(), root);
  part.wall(root, top);
  part.fan(top);
  const std::array<Loop, kBores> of_face = cells(part, below, kPlay);
  part.inside_out = true;
  for (std::uint32_t b = 0; b < kBores; ++b) pin(part, of_face[b], pins[b]);
  return part;
}

}  // namespace

// The first pin is thinner and pressed into its bore: both have the same radius, but other corners.
// The other pins have a clearance, and are off the middle of the bore by up to 0.7 of it.
BuiltScene make_fans(const SceneParameters& parameters, std::uint64_t seed) {
  constexpr double kPerSide = 160;  // triangles for each side of a bore
  constexpr double kTube = 0.1;     // wall of a pin
  Random random(seed);
  const auto sides = static_cast<std::uint32_t>(
      std::max(8.0, std::round(static_cast<double>(parameters.size) / kPerSide)));
  std::array<Bore, kBores> bores, pins;
  for (std::uint32_t b = 0; b < kBores; ++b) {
    const double radius = b == 0 ? 0.15 : random.between(0.25, 0.34);
    bores[b] = {middle(b, 0), radius, random.unit(), 0, b == 0 ? sides / 2 : sides};
    pins[b] = bores[b];
    pins[b].phase = bores[b].phase + random.between(0.3, 0.7);
    if (b == 0) continue;
    const Vec3 off = 0.7 * kClearance * random.in_ball();
    pins[b].middle += Vec3(off.x(), off.y(), 0);
    pins[b].radius -= kClearance;
    pins[b].inner = radius - kTube;
    bores[b].inner = radius - kTube - kClearance;
  }
  // Oblique axes, so that the boxes of slivers are large.
  const Vec3 z = (Vec3(1, 0.9, 0.8) + random.in_cube(0.1)).normalized();
  const Vec3 x = across(z, 1, random);
  const Vec3 y = z.cross(x);
  const Mesh first = socket(bores, sides).placed(x, y, z);
  return {two_objects("fans", "socket", first, "plug", plug(pins, sides).placed(x, y, z)), {}};
}

// ---- a part cut in two ----

namespace {

// A plane over x and y.
struct Slope {
  double height, along_x, along_y;
  Vec3 over(double x, double y) const { return {x, y, height + along_x * x + along_y * y}; }
};

// A block, 1 x 1, between two planes, with a bore from one to the other. Each face is a fan of
// slivers around its end of the bore.
Part bored_block(const Bore& bore, const Slope& below, const Slope& above) {
  const auto rim = [&](Part& part, const Slope& face) {
    return part.circle({face.over(bore.middle.x(), bore.middle.y()),
                        {1, 0, face.along_x},
                        {0, 1, face.along_y},
                        bore.radius},
                       bore.sides, bore.phase);
  };
  const auto outline = [](Part& part, const Slope& face) {
    return Loop{part.point(face.over(-0.5, -0.5)), part.point(face.over(0.5, -0.5)),
                part.point(face.over(0.5, 0.5)), part.point(face.over(-0.5, 0.5))};
  };
  Part part;
  const Loop edge = outline(part, above), foot = outline(part, below);
  const Loop top = rim(part, above), bottom = rim(part, below);
  part.holed(edge, top);
  part.wall(top, bottom);
  part.wall(foot, edge);
  part.inside_out = true;
  part.holed(foot, bottom);
  return part;
}

}  // namespace

// The upper half is tilted a little about the middle of the cut, so that the two meet on one side
// of it and have a gap on the other.
BuiltScene make_cad_cut(const SceneParameters& parameters, std::uint64_t seed) {
  constexpr double kLength = 3;    // of either half
  constexpr double kTilt = 0.012;  // radians
  constexpr double kGap = 0.012;   // in the middle of the cut
  Random random(seed);
  const auto sides = static_cast<std::uint32_t>(
      std::max(8.0, std::round(static_cast<double>(parameters.size) / 8)));
  const Vec3 middle(random.between(-0.05, 0.05), random.between(-0.05, 0.05), 0);
  const Bore bore{middle, random.between(0.3, 0.44), random.unit(), 0, sides};
  const Slope cut{0, 1.5, 0.3};
  // Oblique axes, as of fans.
  const Vec3 z = (Vec3(1, 0.9, 0.8) + random.in_cube(0.1)).normalized();
  const Vec3 x = across(z, 1, random);
  const Vec3 y = z.cross(x);
  const Mesh lower = bored_block(bore, {-kLength, 0, 0}, cut).placed(x, y, z);
  // About the diagonal x + y; small enough for the sine to be the angle.
  const Vec3 tilted = (z + kTilt * (x - y) / std::sqrt(2.0)).normalized();
  const Vec3 along = (x - x.dot(tilted) * tilted).normalized();
  Mesh upper = bored_block(bore, cut, {kLength, 0, 0}).placed(along, tilted.cross(along), tilted);
  for (Vec3& p : upper.vertices) p += kGap * z + 0.001 * x;
  return {two_objects("cad-cut", "lower half", lower, "upper half", upper), {}};
}

}  // namespace farcull
