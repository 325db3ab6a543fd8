// Scenes for benchmarks with objects in contact: a crumpled sheet, a heap of spheres, and a CAD
// part that is cut in two.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

using namespace shapes;

namespace {

// The control points of a uniform cubic B-spline over the unit square. Point i * side + j belongs
// to the parameters u = (i - 1) / spans, v = (j - 1) / spans.
struct Lattice {
  explicit Lattice(std::uint32_t spans) : spans(spans), side(spans + 3), points(side * side) {}
  std::uint32_t spans;
  std::uint32_t side;
  std::vector<Vec3> points;
};

struct Weights {
  std::uint32_t first;
  std::array<double, 4> w;
};

Weights weights_at(double u, std::uint32_t spans) {
  const double scaled = u * spans;
  const auto first = std::min(static_cast<std::uint32_t>(scaled), spans - 1);
  const double t = scaled - first;
  const double s = 1 - t;
  return {first,
          {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
           t * t * t / 6}};
}

Vec3 value(const Lattice& lattice, const Weights& u, const Weights& v) {
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Vec3* const row = &lattice.points[(u.first + i) * lattice.side + v.first];
    sum += u.w[i] * (v.w[0] * row[0] + v.w[1] * row[1] + v.w[2] * row[2] + v.w[3] * row[3]);
  }
  return sum;
}

// Moves two points so that their distance is in [least, most].
void keep_distance(Vec3& a, Vec3& b, double least, double most) {
  const Vec3 d = b - a;
  const double length = std::sqrt(d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
  if ((length >= least && length <= most) || length == 0) return;
  const Vec3 step = 0.5 * (1 - std::clamp(length, least, most) / length) * d;
  a += step;
  b -= step;
}

// Restores the flat sheet's distances between neighbours in the lattice, by position based dynamics
// (Müller et al. 2007). Keeps points i and i + 2 of a row apart, which limits bending.
void relax(Lattice& sheet, int rounds) {
  constexpr double kBend = 1.5;  // least distance of points i and i + 2 of a row, in units of h
  const double h = 1.0 / sheet.spans;
  const double across = h * std::sqrt(2.0);
  const std::uint32_t n = sheet.side;
  const auto point = [&](std::uint32_t i, std::uint32_t j) -> Vec3& {
    return sheet.points[i * n + j];
  };
  for (int round = 0; round < rounds; ++round) {
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < n; ++j) {
        Vec3& here = point(i, j);
        if (i + 2 < n) keep_distance(here, point(i + 2, j), kBend * h, 2 * h);
        if (j + 2 < n) keep_distance(here, point(i, j + 2), kBend * h, 2 * h);
        if (i + 1 < n && j + 1 < n) {
          keep_distance(here, point(i + 1, j + 1), 0.8 * across, 1.2 * across);
          keep_distance(point(i + 1, j), point(i, j + 1), 0.8 * across, 1.2 * across);
        }
        if (i + 1 < n) keep_distance(here, point(i + 1, j), h, h);
        if (j + 1 < n) keep_distance(here, point(i, j + 1), h, h);
      }
    }
  }
}

// Makes a random smooth map of the unit square into a ball, then relaxes the map until it hardly
// stretches the sheet.
Lattice crumple(Random& random) {
  constexpr std::uint32_t kFolds = 10;  // spans of the random map: more spans make smaller folds
  constexpr std::uint32_t kSpans = 84;  // spans of the sheet that is relaxed
  constexpr double kReach = 0.26;       // radius of the ball; the side of the sheet is 1
  Lattice coarse(kFolds);
  for (Vec3& p : coarse.points) p = kReach * random.in_ball();
  Lattice sheet(kSpans);
  for (std::uint32_t i = 0; i < sheet.side; ++i) {
    const Weights u = weights_at(static_cast<double>(i) / (sheet.side - 1), kFolds);
    for (std::uint32_t j = 0; j < sheet.side; ++j) {
      const Weights v = weights_at(static_cast<double>(j) / (sheet.side - 1), kFolds);
      sheet.points[i * sheet.side + j] = value(coarse, u, v);
    }
  }
  relax(sheet, 60);
  return sheet;
}

struct Ball {
  Vec3 centre;
  double radius;
};

// Returns the pairs of balls whose centres are nearer than the sum of the radii plus the margin.
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

// Returns balls of radius 0.5 to 1 that have settled in a box without a lid. A mesh lies inside its
// ball, so the meshes of two balls that just touch are apart. So the distance of balls in contact
// is (1 - kDeep) times the sum of their radii.
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
      const double apart = (1 - kDeep) * (balls[i].radius + balls[j].radius);
      keep_distance(balls[i].centre, balls[j].centre, apart, HUGE_VAL);
    }
    for (Ball& ball : balls) {
      for (int k = 0; k < 2; ++k)
        ball.centre[k] = std::clamp(ball.centre[k], ball.radius, width - ball.radius);
      ball.centre.z() = std::max(ball.centre.z(), ball.radius);
    }
  }
  return balls;
}

// A part with a bore is cut in two. Its triangles are like those of CAD programs: a fan of slivers
// for a flat face with a round hole, and full-length quads, split in two, for a wall.

// Vertices around a face, counterclockwise seen from outside the part.
using Loop = std::vector<std::uint32_t>;

struct Circle {
  Vec3 centre, u, v;  // u and v are unit vectors in the circle's plane
  double radius;
};

class Part {
 public:
  bool inside_out = false;  // the triangles added from now on get the opposite orientation

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
  void wall(const Loop& from, const Loop& to) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      const std::size_t next = (i + 1) % from.size();
      quad({from[i], from[next], to[next], to[i]});
    }
  }
  // Triangulates the region between a loop and a round hole inside the loop. Joins each side of the
  // hole to the corner of the loop that is nearest in angle. Precondition: segments from the hole's
  // middle to the loop cross no other side of the loop.
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

struct Bore {
  Vec3 middle;  // where the axis of the bore meets z = 0
  double radius, phase;
  std::uint32_t sides;
};

// The plane z = height + along_x x + along_y y.
struct Slope {
  double height, along_x, along_y;
  Vec3 over(double x, double y) const { return {x, y, height + along_x * x + along_y * y}; }
};

// Returns a block over a square of side 1, between the planes `below` and `above`. A bore goes
// through both planes. The block's face in each plane is a fan of slivers around the bore.
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

BuiltScene make_crumpled(const SceneParameters& parameters, std::uint64_t seed) {
  Random random(seed);
  const Lattice sheet = crumple(random);
  const auto cells =
      static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(parameters.size) / 2)));
  std::vector<Weights> at;
  for (std::uint32_t i = 0; i <= cells; ++i)
    at.push_back(weights_at(static_cast<double>(i) / cells, sheet.spans));
  const Mesh mesh = surface(cells, cells, false, [&](std::uint32_t i, std::uint32_t j) {
    return value(sheet, at[i], at[j]);
  });
  SceneBuilder builder("crumpled", "crumpled");
  builder.add(mesh, "sheet", Split::kNone, {}, true);
  return {builder.finish(), {}};
}

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

// The upper half is tilted a little about the middle of the cut. So the halves meet on one side of
// the cut, and have a gap on the other side.
BuiltScene make_cad_cut(const SceneParameters& parameters, std::uint64_t seed) {
  constexpr double kLength = 3;    // length of either half
  constexpr double kTilt = 0.012;  // radians
  constexpr double kGap = 0.012;   // width of the gap in the middle of the cut
  Random random(seed);
  const auto sides = static_cast<std::uint32_t>(
      std::max(8.0, std::round(static_cast<double>(parameters.size) / 8)));
  const Vec3 middle(random.between(-0.05, 0.05), random.between(-0.05, 0.05), 0);
  const Bore bore{middle, random.between(0.3, 0.44), random.unit(), sides};
  const Slope cut{0, 1.5, 0.3};
  // The part's axes are oblique, so that slivers have large bounding boxes.
  const Vec3 z = (Vec3(1, 0.9, 0.8) + random.in_cube(0.1)).normalized();
  const Vec3 x = across(z, 1, random);
  const Vec3 y = z.cross(x);
  const Mesh lower = bored_block(bore, {-kLength, 0, 0}, cut).placed(x, y, z);
  // Tilts the upper half about the diagonal x + y, by an angle whose tangent is kTilt.
  const Vec3 tilted = (z + kTilt * (x - y) / std::sqrt(2.0)).normalized();
  const Vec3 along = (x - x.dot(tilted) * tilted).normalized();
  Mesh upper = bored_block(bore, cut, {kLength, 0, 0}).placed(along, tilted.cross(along), tilted);
  for (Vec3& p : upper.vertices) p += kGap * z + 0.001 * x;
  return {two_objects("cad-cut", "lower half", lower, "upper half", upper), {}};
}

std::vector<BuiltinScene> contact_scenes() {
  return {
      entry("crumpled", 16, make_crumpled,
            "a sheet of cloth crumpled to a ball, against itself: 57,243 pairs = 57,043 + 200 of "
            "neighbours collide",
            1, 91'592, "", {"triangles", 1000, 100'000'000, 92'000}, {}, kCostly),
      entry("spheres", 18, make_spheres,
            "spheres of 320 triangles, settled in a heap: 23,513 pairs collide", 458, 146'560, "",
            {"triangles", 1000, 100'000'000, 146'560}, {}, kCostly),
      entry("cad-cut", 21, make_cad_cut,
            "a part with a bore, cut in two, as slivers of its whole length: 34,488,537 boxes "
            "overlap, 2587 collide",
            2, 31'032, "", {"triangles", 2000, 10'000'000, 31'000}, {}, kCostly),
      entry("funnel", 20, make_funnel,
            "a cloth that hangs in a funnel in pleats, against itself as well, where nothing "
            "collides",
            2, 29'832, "", {"triangles", 5000, 100'000'000, 30'000},
            {"triangles of a coarse funnel, in one mesh with the cloth; 0: 3,840 in another", 0,
             2000, 0},
            kCostly),
  };
}

}  // namespace farcull
