// A scene for benchmarks with machine parts in contact: a part with a bore, cut in two. It is
// triangulated as CAD tessellators do: flat faces with a round hole as fans of slivers, walls as
// quads of the part's full length, split in two.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

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
  // Fills the region between a loop and a round hole in it, whose middle must see all of the loop.
  // Each side of the hole is joined to the corner of the loop nearest in angle.
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

struct Bore {
  Vec3 middle;  // at z = 0
  double radius, phase;
  std::uint32_t sides;
};

// The plane z = height + along_x x + along_y y.
struct Slope {
  double height, along_x, along_y;
  Vec3 over(double x, double y) const { return {x, y, height + along_x * x + along_y * y}; }
};

// A block over a square of side 1, between two planes, with a bore from one to the other. Each face
// is a fan of slivers around its end of the bore.
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

// The upper half is tilted a little about the middle of the cut, so that the halves meet on one
// side of the cut and have a gap on the other.
BuiltScene make_cad_cut(const SceneParameters& parameters, std::uint64_t seed) {
  constexpr double kLength = 3;    // of either half
  constexpr double kTilt = 0.012;  // radians
  constexpr double kGap = 0.012;   // in the middle of the cut
  Random random(seed);
  const auto sides = static_cast<std::uint32_t>(
      std::max(8.0, std::round(static_cast<double>(parameters.size) / 8)));
  const Vec3 middle(random.between(-0.05, 0.05), random.between(-0.05, 0.05), 0);
  const Bore bore{middle, random.between(0.3, 0.44), random.unit(), sides};
  const Slope cut{0, 1.5, 0.3};
  // Oblique axes, so that the boxes of slivers are large.
  const Vec3 z = (Vec3(1, 0.9, 0.8) + random.in_cube(0.1)).normalized();
  const Vec3 x = across(z, 1, random);
  const Vec3 y = z.cross(x);
  const Mesh lower = bored_block(bore, {-kLength, 0, 0}, cut).placed(x, y, z);
  // Tilts about the diagonal x + y; the angle is so small that it can replace its tangent.
  const Vec3 tilted = (z + kTilt * (x - y) / std::sqrt(2.0)).normalized();
  const Vec3 along = (x - x.dot(tilted) * tilted).normalized();
  Mesh upper = bored_block(bore, cut, {kLength, 0, 0}).placed(along, tilted.cross(along), tilted);
  for (Vec3& p : upper.vertices) p += kGap * z + 0.001 * x;
  return {two_objects("cad-cut", "lower half", lower, "upper half", upper), {}};
}

}  // namespace farcull
