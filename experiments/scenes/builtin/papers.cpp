// Scenes that move. Most scenes imitate the shapes, numbers and motions of scenes in papers, with
// generated meshes: deforming cylinders and torii (CULLIDE: Govindaraju, Redon, Lin and Manocha,
// Graphics Hardware 2003); falling leaves and a simulated cloth (FAR: Govindaraju, Lin and Manocha,
// VRST 2004).
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/cloth/cloth.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

using namespace shapes;

namespace {

// The closed path of an object in a box, from time 0 to time 1.
struct Way {
  Vec3 centre;
  Vec3 reach;  // amplitude of the motion along each axis
  Vec3 phase;  // phases of the motion along the axes, in turns
  Vec3 axis;   // axis of the object's rotation
  double turns = 1;
  double swell = 0;  // phase of the object's deformation, in turns

  Vec3 at(double time) const {
    Vec3 p = centre;
    for (int k = 0; k < 3; ++k) p[k] += reach[k] * std::sin(kTurn * (time + phase[k]));
    return p;
  }
  Eigen::Matrix3d turned(double time) const {
    return Eigen::AngleAxisd(kTurn * (turns * time + swell), axis).toRotationMatrix();
  }
};

Way draw_way(double room, double reach, Random& random) {
  Way way;
  way.centre = random.in_cube(room);
  way.reach = reach * random.direction();
  way.phase = random.in_cube(0.5);
  way.axis = random.direction();
  way.swell = random.unit();
  return way;
}

// Makes a scene of objects of one shape. Each object moves along its own Way. `deformed` returns
// the position of a vertex of the shape at a time, in the coordinates of the object.
template <class Deformed>
BuiltScene on_their_ways(const std::string& name, const std::string& object, const Mesh& shape,
                         std::vector<Way> ways, Deformed deformed) {
  SceneBuilder builder(name, name);
  for (std::size_t o = 0; o < ways.size(); ++o) builder.add(shape, object + std::to_string(o));
  BuiltScene built{builder.finish(), {}};
  built.motion = [shape = shape.vertices, ways = std::move(ways), deformed](
                     const Instant& now, Scene& out, FrameNotes&) {
    std::size_t v = 0;
    for (const Way& way : ways) {
      const Eigen::Matrix3d turned = way.turned(now.time);
      const Vec3 at = way.at(now.time);
      for (std::size_t i = 0; i < shape.size(); ++i)
        out.vertices[v++] = turned * deformed(i, shape[i], way.swell, now.time) + at;
    }
  };
  return halfway(std::move(built));
}

// Returns an open tube of radius 1 about the z axis, from z = 0 to 1. The tube has `along` x
// `around` cells of two triangles. Vertex i * around + j is at height i / along.
Mesh tube(std::uint32_t around, std::uint32_t along) {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i <= along; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const double u = kTurn * j / around;
      vertices.emplace_back(std::cos(u), std::sin(u), static_cast<double>(i) / along);
    }
  }
  for (std::uint32_t i = 0; i < along; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const std::uint32_t a = i * around + j;
      const std::uint32_t b = i * around + (j + 1) % around;
      triangles.push_back({a, b, b + around});
      triangles.push_back({a, b + around, a + around});
    }
  }
  return finished(std::move(vertices), std::move(triangles));
}

// Returns the numbers of cells around the ring and around the tube of a torus with about this many
// triangles. If possible, the torus has exactly this many triangles.
std::pair<std::uint32_t, std::uint32_t> torus_grid(std::uint64_t triangles) {
  const std::uint64_t cells = triangles / 2;
  const auto square = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(cells) / 2));
  std::uint64_t across = square;
  while (across > square / 2 && cells % across != 0) --across;
  if (across < 3 || cells % across != 0) across = square;
  across = std::max<std::uint64_t>(across, 3);
  const std::uint64_t around = std::max<std::uint64_t>((cells + across / 2) / across, 3);
  return {static_cast<std::uint32_t>(around), static_cast<std::uint32_t>(across)};
}

// ---- the tree: a trunk, 7 branches, 6 twigs on each, all tubes of 8 by 5 cells ----

constexpr int kBranches = 7, kTwigs = 6;
constexpr double kTrunk = 3;  // height of the trunk

struct Wood {
  Vec3 from, to;
  double thick = 0, thin = 0;  // radii at both ends

  Vec3 at(double part) const { return from + part * (to - from); }
};

void add_wood(const Wood& wood, const Mesh& shape, Mesh& tree) {
  const Vec3 along = wood.to - wood.from;
  const Vec3 aside =
      along.cross(std::abs(along.x()) < std::abs(along.z()) ? Vec3::UnitX() : Vec3::UnitZ())
          .normalized();
  const Vec3 other = along.normalized().cross(aside);
  const auto first = static_cast<std::uint32_t>(tree.vertices.size());
  for (const Vec3& p : shape.vertices) {
    const double radius = wood.thick + p.z() * (wood.thin - wood.thick);
    tree.vertices.push_back(wood.at(p.z()) + radius * (p.x() * aside + p.y() * other));
  }
  for (const auto& [a, b, c] : shape.triangles)
    tree.triangles.push_back({first + a, first + b, first + c});
}

Mesh make_tree(Random& random) {
  const Mesh shape = tube(8, 5);
  Mesh tree;
  const Wood trunk{Vec3(0, 0, 0), Vec3(0.1, 0.05, kTrunk), 0.2, 0.08};
  add_wood(trunk, shape, tree);
  for (int b = 0; b < kBranches; ++b) {
    const double turn = kTurn * (b + random.between(-0.2, 0.2)) / kBranches;
    const Vec3 from = trunk.at(random.between(0.35, 0.95));
    const double rise = random.between(0.2, 0.7);
    const Vec3 to =
        from + random.between(1.0, 1.5) * Vec3(std::cos(turn), std::sin(turn), rise).normalized();
    const Wood branch{from, to, 0.08, 0.03};
    add_wood(branch, shape, tree);
    for (int t = 0; t < kTwigs; ++t) {
      const Vec3 start = branch.at((t + random.between(0.5, 1)) / kTwigs);
      const Vec3 way = (branch.to - branch.from).normalized() + 0.9 * random.direction();
      const double length = random.between(0.4, 0.7);
      add_wood({start, start + length * way.normalized(), 0.025, 0.01}, shape, tree);
    }
  }
  return finished(std::move(tree.vertices), std::move(tree.triangles));
}

// Returns an arched leaf of 10 by 10 cells. It is 0.24 long, with a blunt tip and a blunt stem.
Mesh make_leaf() {
  Mesh leaf = grid(10);
  for (Vec3& p : leaf.vertices) {
    const double u = p.x();          // 0 at the stem, 1 at the tip
    const double v = 2 * p.y() - 1;  // -1 and 1 at the sides
    const double width = 0.01 + 0.25 * u * (1 - u);
    p = Vec3(0.24 * (u - 0.5), width * v, 0.03 * (1 - 4 * (u - 0.5) * (u - 0.5)) + 0.02 * v * v);
  }
  return leaf;
}

struct Leaf {
  Vec3 from;
  double late = 0;   // the time when the leaf comes off
  double sway = 0;   // amplitude of the sideways motion
  double phase = 0;  // phase of the sway, in turns
  Vec3 axis;         // axis of the leaf's rotation
  double turns = 0;  // turns per unit of time while the leaf falls
};

BuiltScene make_cylinders(const SceneParameters& parameters, std::uint64_t seed) {
  constexpr double kRoom = 2.5;  // half the side of the room for 100 cylinders of length 1
  const double room = kRoom * std::cbrt(static_cast<double>(parameters.size) / 100);
  Random random(seed);
  std::vector<Way> ways;
  for (std::uint64_t i = 0; i < parameters.size; ++i) ways.push_back(draw_way(room, 1, random));
  Mesh shape = tube(20, 5);
  for (Vec3& p : shape.vertices) p = Vec3(0.25 * p.x(), 0.25 * p.y(), p.z() - 0.5);
  return on_their_ways("cylinders", "cylinder", shape, std::move(ways),
                       [](std::size_t, const Vec3& p, double swell, double time) {
                         const double phase = kTurn * (2 * time + swell);
                         const double breath = 1 + 0.3 * std::sin(phase + 4 * p.z());
                         const double bend = 0.6 * std::sin(phase) * p.z() * p.z();
                         return Vec3(breath * p.x() + bend, breath * p.y(), p.z());
                       });
}

// size: wanted number of triangles of a torus. The grid may have a few more or fewer triangles.
BuiltScene make_torii(const SceneParameters& parameters, std::uint64_t seed) {
  Random random(seed);
  std::vector<Way> ways;
  for (int i = 0; i < 6; ++i) ways.push_back(draw_way(1.2, 0.8, random));
  const auto [around, across] = torus_grid(parameters.size);
  return on_their_ways(
      "torii", "torus", torus(1, 0.3, around, across), std::move(ways),
      [around = around, across = across](std::size_t i, const Vec3& p, double swell, double time) {
        const double u = kTurn * static_cast<double>(i / across) / around;  // angle along the ring
        const Vec3 ring(std::cos(u), std::sin(u), 0);
        const double wave = 1 + 0.25 * std::sin(3 * u + kTurn * (time + swell));
        const double lift = 0.2 * std::sin(2 * u - kTurn * (time + swell));
        return Vec3(ring + wave * (p - ring) + Vec3(0, 0, lift));
      });
}

BuiltScene make_tree_leaves(const SceneParameters& parameters, std::uint64_t seed) {
  constexpr double kFall = 4;  // fall of a leaf per unit of time
  Random random(seed);
  SceneBuilder builder("tree-leaves", "tree-leaves");
  const Mesh tree = make_tree(random);
  builder.add(tree, "tree");
  const Mesh shape = make_leaf();
  std::vector<Leaf> leaves;
  for (std::uint64_t i = 0; i < parameters.size; ++i) {
    builder.add(shape, "leaf" + std::to_string(i));
    Leaf leaf;
    const double turn = kTurn * random.unit();
    const double far = 1.6 * std::sqrt(random.unit());  // distance from the trunk
    const double height = random.between(1.6, 4.6);
    leaf.from = Vec3(far * std::cos(turn), far * std::sin(turn), height);
    leaf.late = random.between(0, 0.3);
    leaf.sway = random.between(0.05, 0.25);
    leaf.phase = random.unit();
    leaf.axis = random.direction();
    leaf.turns = random.between(-2, 2);
    leaves.push_back(leaf);
  }
  BuiltScene built{builder.finish(), {}};
  built.motion = [shape = shape.vertices, leaves = std::move(leaves), first = tree.vertices.size()](
                     const Instant& now, Scene& out, FrameNotes&) {
    std::size_t v = first;
    for (const Leaf& leaf : leaves) {
      const double fall = std::max(0.0, now.time - leaf.late);
      const double side = leaf.sway * std::sin(kTurn * (3 * fall + leaf.phase));
      const Vec3 at = leaf.from + Vec3(side, 0.5 * side, -kFall * fall);
      const Eigen::Matrix3d turned =
          Eigen::AngleAxisd(kTurn * (leaf.phase + leaf.turns * fall), leaf.axis).toRotationMatrix();
      for (const Vec3& p : shape) out.vertices[v++] = turned * p + at;
    }
  };
  return halfway(std::move(built));
}

// ---- Open sheets. Arguments about closed meshes do not hold for these sheets, and a depth buffer
// of 24 bits cannot separate them. ----

constexpr std::uint32_t kCells = 18;  // cells along a side; the side is 1 long
constexpr double kGrain = 0x1p-40;    // heights are multiples of kGrain

std::uint32_t at(std::uint32_t i, std::uint32_t j) { return i * (kCells + 1) + j; }

// Returns a square of 18 by 18 cells of two triangles, with two flaps of 12 by 1 cells. The flaps
// are joined to the grid lines i = 6 and i = 12, so three triangles meet at each edge of a joint. A
// flap lies over the next row of cells. Vertices of flaps come last, and make_shells() raises these
// vertices.
Mesh sheet() {
  auto [vertices, triangles, source_face, group, group_names, folded, notes] = grid(kCells);
  for (const std::uint32_t line : {6u, 12u}) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (std::uint32_t j = 3; j <= kCells - 3; ++j) {
      const Vec3 below = vertices[at(line + 1, j)];
      vertices.push_back(below);
    }
    for (std::uint32_t j = 3; j < kCells - 3; ++j) {
      const std::uint32_t a = first + j - 3;
      triangles.push_back({at(line, j), a, a + 1});
      triangles.push_back({at(line, j), a + 1, at(line, j + 1)});
    }
  }
  return finished(std::move(vertices), std::move(triangles));
}

double rounded(double height) { return std::nearbyint(height / kGrain) * kGrain; }

// size: number of sheets. All heights are multiples of 2^-40 below 2^10, so sums with the gap
// (2^-34) are exact. A sheet of the stack is an exact copy of the sheet below, moved up by the gap.
// So these two sheets never meet. Flaps rise by half a gap, so no flap meets the sheet above.
BuiltScene make_shells(const SceneParameters& parameters, std::uint64_t seed) {
  static_assert(kShellGap / 2 >= kGrain);
  const Mesh shape = sheet();
  const std::size_t grid = at(kCells, kCells) + 1;
  const std::uint64_t stacked = parameters.size - parameters.size / 4;
  SceneBuilder builder("shells", "shells");
  for (std::uint64_t s = 0; s < parameters.size; ++s)
    builder.add(shape, (s < stacked ? "sheet" : "crossing") + std::to_string(s));
  Random random(seed);
  std::vector<double> phases(parameters.size);
  for (double& phase : phases) phase = random.unit();
  BuiltScene built{builder.finish(), {}};
  built.motion = [shape = shape.vertices, grid, stacked, phases = std::move(phases)](
                     const Instant& now, Scene& out, FrameNotes&) {
    std::vector<double> heights;
    for (const Vec3& p : shape) {
      heights.push_back(rounded(0.1 * std::sin(kTurn * (p.x() + now.time)) +
                                0.05 * std::cos(kTurn * (1.5 * p.y() - now.time))));
    }
    const double thick = static_cast<double>(stacked) * kShellGap;
    std::size_t v = 0;
    for (std::size_t s = 0; s < phases.size(); ++s) {
      for (std::size_t i = 0; i < shape.size(); ++i) {
        const Vec3& p = shape[i];
        double lift = i < grid ? 0 : kShellGap / 2;
        if (s < stacked) {
          lift += static_cast<double>(s) * kShellGap;
        } else {
          // The sheet is tilted: one side is below the stack, and the other side is above the
          // stack. The direction of the tilt rotates with time.
          const double turn = kTurn * (now.time + phases[s]);
          const double across =
              0.5 + (p.x() - 0.5) * std::cos(turn) + (p.y() - 0.5) * std::sin(turn);
          lift += rounded((across - 0.1) * thick * 1.25);
        }
        out.vertices[v++] = Vec3(p.x(), p.y(), heights[i] + lift);
      }
    }
  };
  return halfway(std::move(built));
}

// ---- the simulated cloth; a frame is a time step ----

FrameNotes notes_of(const ClothReport& report) {
  return {.values = {{"kinetic J", report.kinetic},
                     {"elastic J", report.elastic},
                     {"bending J", report.bending},
                     {"gravitational J", report.gravitational},
                     {"contact J", report.contact},
                     {"total J", report.total()},
                     {"slack J", report.slack},
                     {"residual N", report.residual},
                     {"iterations", report.iterations},
                     {"converged", report.converged ? 1 : 0}},
          .warning = report.warning};
}

// size: wanted number of triangles; the grid has nearly as many. second: stiffness, N/m.
BuiltScene make_cloth(const SceneParameters& parameters) {
  ClothSettings settings;
  settings.triangles = parameters.size;
  settings.stiffness = parameters.second;
  const auto now = std::make_shared<Cloth>(settings);
  BuiltScene built{now->scene(), {}};
  built.motion = [now, settings](const Instant& wanted, Scene& out, FrameNotes& notes) {
    if (wanted.frame < now->report().frame) *now = Cloth(settings);
    while (now->report().frame < wanted.frame) now->step();
    out.vertices = now->scene().vertices;
    notes = notes_of(now->report());
  };
  return built;
}

}  // namespace

std::vector<BuiltinScene> paper_scenes() {
  return {
      entry("cylinders", 9, make_cylinders, "open cylinders of 200 triangles in a room (CULLIDE)",
            100, 20000, "each goes its own way, turns, bends and breathes",
            {"cylinders", 2, 100'000, 100}),
      entry("torii", 10, make_torii, "six torii in a room (CULLIDE)", 6, 120'000,
            "each goes its own way and turns while waves run around it",
            {"triangles of each torus", 72, 2'000'000, 20'000}, {}, kCostly),
      entry("tree-leaves", 11, make_tree_leaves,
            "a tree of 4,000 triangles and leaves of 200 (FAR)", 201, 44'000,
            "the leaves fall and turn through the branches", {"leaves", 1, 100'000, 200}, {},
            kCostly),
      entry("shells", 12, make_shells,
            "open non-manifold sheets, three in four of them stacked at gaps of 2^-34 of their "
            "width, the others through them at angles as small",
            16, 11'136, "waves run through the stack while the others tilt",
            {"sheets", 4, 10'000, 16}),
      entry("cloth", 0, make_cloth, "a cloth above a sphere, against itself as well (FAR)", 2,
            25'120, "it falls on the sphere and folds over itself; a frame is a time step",
            {"triangles of the cloth", 8, 200'000, 20'000}, {"stiffness in N/m", 1e2, 1e8, 1e4},
            kCostly),
  };
}

}  // namespace farcull
