// Scenes for benchmarks with objects in contact: a plug in its socket, a rope, a heap of spheres,
// and the list, which includes those of contact_cloth.cpp.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

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

// ---- the rope and the heap ----

namespace {

// A rope of three strands, wound in turns around a ring. The unit of length is the radius of a
// strand. The strands are one closed tube: after the ring a strand continues as the next one.
constexpr std::uint32_t kStrands = 3;
constexpr double kApart = 1.05;  // distance of strands; 1 is contact
constexpr double kWinding = 5;   // radius of the turns
constexpr double kLay = 20;      // length of rope in which its strands turn once
// Distance of a strand from the rope's middle; the factor is 2 / sqrt(3).
constexpr double kStrandAt = kApart * 1.1547005383792517;
constexpr double kRope = kStrandAt + 1;

struct RopeShape {
  std::uint32_t turns;
  std::uint32_t sides;  // of a strand
  std::uint32_t steps;  // of one turn
  double ring;          // radius of the middle of the turns
  double twist;         // turns of the strands in one way around the ring: a whole number and 1/3
};

// Below the usual size the rope is shorter; above it, it is divided more finely.
RopeShape rope_shape(std::uint64_t triangles) {
  constexpr double kUsual = 80'000, kUsualTurns = 24, kUsualSides = 12;
  const auto wanted = static_cast<double>(triangles);
  RopeShape out{};
  out.turns = static_cast<std::uint32_t>(
      std::clamp(std::round(kUsualTurns * wanted / kUsual), 6.0, kUsualTurns));
  const double part = out.turns / kUsualTurns;
  out.sides = static_cast<std::uint32_t>(
      std::max(4.0, std::round(kUsualSides * std::sqrt(wanted / kUsual / part))));
  out.steps = static_cast<std::uint32_t>(
      std::max(8.0, std::round(wanted / (2.0 * kStrands * out.sides * out.turns))));
  // At the inside of the ring, neighbouring turns are kApart + 0.02 times the rope's width apart.
  out.ring = kWinding + out.turns * kRope * (kApart + 0.02) / std::numbers::pi;
  const double length = out.turns * kTurn * kWinding;
  out.twist = std::round(length / kLay) + 1.0 / kStrands;
  return out;
}

// The middle of the rope and two directions across it, after a number of turns.
struct RopeFrame {
  Vec3 middle, out, aside;
};

RopeFrame rope_at(const RopeShape& shape, double turn) {
  const double around = kTurn * turn / shape.turns;
  const double wound = kTurn * turn;
  const Vec3 radial(std::cos(around), std::sin(around), 0);
  const Vec3 forward(-std::sin(around), std::cos(around), 0);
  const Vec3 out = std::cos(wound) * radial + std::sin(wound) * Vec3::UnitZ();
  const Vec3 up = std::cos(wound) * Vec3::UnitZ() - std::sin(wound) * radial;
  const double far = shape.ring + kWinding * std::cos(wound);
  const Vec3 along = (far / shape.turns * forward + kWinding * up).normalized();
  return {far * radial + kWinding * std::sin(wound) * Vec3::UnitZ(), out, along.cross(out)};
}

// A smooth one-to-one map of space: the derivatives of its waves stay far below 1.
class Bend {
 public:
  Bend(double size, Random& random) {
    for (Wave& wave : waves_) {
      wave.along = random.direction() * (random.between(0.5, 1) * kTurn / size);
      wave.by = random.direction() * (0.06 / wave.along.norm());
      wave.phase = kTurn * random.unit();
    }
  }
  Vec3 operator()(const Vec3& p) const {
    Vec3 out = p;
    for (const Wave& wave : waves_) out += std::sin(wave.along.dot(p) + wave.phase) * wave.by;
    return out;
  }

 private:
  struct Wave {
    Vec3 along, by;
    double phase;
  };
  std::array<Wave, 4> waves_;
};

}  // namespace

// Rings of a strand are perpendicular to the rope, not to the strand. They turn about the rope's
// middle with all strands, so that strands stay apart between two rings as they do at the rings.
BuiltScene make_rope(const SceneParameters& parameters, std::uint64_t seed) {
  Random random(seed);
  const RopeShape shape = rope_shape(parameters.size);
  const Bend bend(2 * (shape.ring + kWinding), random);
  const double begin = random.unit();
  const std::uint32_t around = shape.steps * shape.turns;  // cross-sections, once around the ring
  const std::uint32_t rings = kStrands * around;
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  vertices.reserve(std::size_t{rings} * shape.sides);
  triangles.reserve(std::size_t{rings} * shape.sides * 2);
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const RopeFrame frame = rope_at(shape, static_cast<double>(ring % around) / shape.steps);
    const double turned = kTurn * (begin + shape.twist * ring / around);
    const double c = std::cos(turned), s = std::sin(turned);
    for (std::uint32_t side = 0; side < shape.sides; ++side) {
      const double angle = kTurn * side / shape.sides;
      const double x = kStrandAt + std::cos(angle), y = std::sin(angle);
      vertices.push_back(
          bend(frame.middle + (c * x - s * y) * frame.out + (s * x + c * y) * frame.aside));
      const std::uint32_t next = (ring + 1) % rings * shape.sides;
      const std::uint32_t a = ring * shape.sides + side;
      const std::uint32_t b = ring * shape.sides + (side + 1) % shape.sides;
      const std::uint32_t d = next + side;
      const std::uint32_t e = next + (side + 1) % shape.sides;
      triangles.push_back({a, b, d});
      triangles.push_back({b, e, d});
    }
  }
  SceneBuilder builder("rope", "rope");
  builder.add(finished(std::move(vertices), std::move(triangles)), "rope", Split::kNone, {}, true);
  return {builder.finish(), {}};
}

namespace {

struct Ball {
  Vec3 centre;
  double radius;
};

// Pairs of balls whose distance is below the sum of their radii plus a margin.
std::vector<std::array<std::uint32_t, 2>> near_pairs(const std::vector<Ball>& balls,
                                                     double margin) {
  const double cell = 2 + margin;  // a radius is at most 1
  Box box = Box::empty();
  for (const Ball& ball : balls) box.add(ball.centre);
  std::array<std::int64_t, 3> cells;
  for (int k = 0; k < 3; ++k)
    cells[k] = static_cast<std::int64_t>((box.hi[k] - box.lo[k]) / cell) + 1;
  const auto cell_of = [&](const Vec3& p, int k) {
    return static_cast<std::int64_t>((p[k] - box.lo[k]) / cell);
  };
  std::vector<std::vector<std::uint32_t>> in(
      static_cast<std::size_t>(cells[0] * cells[1] * cells[2]));
  std::vector<std::array<std::uint32_t, 2>> out;
  for (std::uint32_t i = 0; i < balls.size(); ++i) {
    const Vec3& p = balls[i].centre;
    const std::int64_t x = cell_of(p, 0), y = cell_of(p, 1), z = cell_of(p, 2);
    for (std::int64_t n = 0; n < 27; ++n) {
      const std::int64_t a = x + n % 3 - 1, b = y + n / 3 % 3 - 1, c = z + n / 9 - 1;
      if (a < 0 || b < 0 || c < 0 || a >= cells[0] || b >= cells[1] || c >= cells[2]) continue;
      for (const std::uint32_t j :
           in[static_cast<std::size_t>((c * cells[1] + b) * cells[0] + a)]) {
        const double most = balls[i].radius + balls[j].radius + margin;
        if ((balls[j].centre - p).squaredNorm() < most * most) out.push_back({j, i});
      }
    }
    in[static_cast<std::size_t>((z * cells[1] + y) * cells[0] + x)].push_back(i);
  }
  return out;
}

// Balls of radius 0.5 to 1, settled in a box without a lid. Balls in contact are nearer than the
// sum of their radii, by the fraction kDeep of that sum, because their meshes lie inside them.
std::vector<Ball> heap(std::uint64_t count, Random& random) {
  constexpr double kDeep = 0.03;
  constexpr double kSpacing = 1.62;
  constexpr int kRounds = 240, kFalling = 160;
  std::uint64_t wide = 1;
  while (wide * wide * wide < count) ++wide;
  const double width = kSpacing * static_cast<double>(wide);
  std::vector<Ball> balls;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Vec3 cell(static_cast<double>(i % wide), static_cast<double>(i / wide % wide),
                    static_cast<double>(i / wide / wide));
    const Vec3 centre = kSpacing * (cell + Vec3::Constant(0.5)) + random.in_cube(0.3);
    balls.push_back({centre, random.between(0.5, 1)});
  }
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (int round = 0; round < kRounds; ++round) {
    if (round % 4 == 0) pairs = near_pairs(balls, 0.3);
    const double fall =
        round < kFalling ? 0.6 * width / kFalling * (1 - 1.0 * round / kFalling) : 0;
    for (Ball& ball : balls) ball.centre.z() -= fall;
    for (const auto& [i, j] : pairs) {
      const Vec3 d = balls[j].centre - balls[i].centre;
      const double apart = (1 - kDeep) * (balls[i].radius + balls[j].radius);
      const double distance = std::sqrt(d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
      if (distance >= apart || distance == 0) continue;
      const Vec3 step = 0.5 * (apart / distance - 1) * d;
      balls[i].centre -= step;
      balls[j].centre += step;
    }
    for (Ball& ball : balls) {
      for (int k = 0; k < 2; ++k)
        ball.centre[k] = std::clamp(ball.centre[k], ball.radius, width - ball.radius);
      ball.centre.z() = std::max(ball.centre.z(), ball.radius);
    }
  }
  return balls;
}

}  // namespace

// Each sphere has 320 triangles.
BuiltScene make_spheres(const SceneParameters& parameters, std::uint64_t seed) {
  Random random(seed);
  const Mesh shape = sphere(2);
  const std::vector<Ball> balls =
      heap(std::max<std::uint64_t>(2, (parameters.size + 160) / 320), random);
  SceneBuilder builder("spheres", "spheres");
  for (std::size_t i = 0; i < balls.size(); ++i) {
    Placement placement = random.anywhere(balls[i].centre);
    placement.scale = Vec3::Constant(balls[i].radius);
    builder.add(shape, "sphere" + std::to_string(i), Split::kNone, placement);
  }
  return {builder.finish(), {}};
}

std::vector<BuiltinScene> contact_scenes() {
  return {
      entry("crumpled", 16, make_crumpled,
            "a sheet of cloth crumpled to a ball, against itself: 57,243 pairs = 57,043 + 200 of "
            "neighbours collide",
            1, 91'592, "", {"triangles", 1000, 100'000'000, 92'000}, {}, kCostly),
      entry("rope", 17, make_rope,
            "a rope of three strands wound around a ring, against itself, where nothing collides",
            1, 79'488, "", {"triangles", 2000, 100'000'000, 80'000}, {}, kCostly),
      entry("spheres", 18, make_spheres,
            "spheres of 320 triangles, settled in a heap: 23,513 pairs collide", 458, 146'560, "",
            {"triangles", 1000, 100'000'000, 146'560}, {}, kCostly),
      entry("fans", 19, make_fans,
            "a plug in its socket, triangulated in fans and slivers: 30,979,610 boxes overlap, "
            "1164 collide",
            2, 31'112, "", {"triangles", 2000, 10'000'000, 31'000}, {}, kCostly),
      entry("funnel", 20, make_funnel,
            "a cloth that hangs in a funnel in pleats, against itself as well, where nothing "
            "collides",
            2, 29'832, "", {"triangles", 5000, 100'000'000, 30'000}, {}, kCostly),
  };
}

}  // namespace farcull
