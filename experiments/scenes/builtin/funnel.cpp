// A cloth that hangs in pleats in a funnel. In larger scenes only the cloth has more triangles, so
// the triangles of the funnel stay large.
#include <algorithm>
#include <cmath>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

using namespace shapes;

namespace {

// Returns the number of cells along a side of a square grid with about this many triangles.
std::uint32_t cells_for(std::uint64_t triangles) {
  return static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(triangles) / 2)));
}

// The funnel is upright, with a pipe below and a cone above. The cloth in the funnel is a square
// whose middle was pulled down into the pipe. The unit of length is half the side of the cloth.
constexpr double kCap =
    0.22;  // pleats grow between 0.3 and 1.3 times this distance from the cloth's middle
constexpr double kPipe = 0.62;   // distance from the cloth's middle where the cone begins
constexpr double kNarrow = 0.2;  // mean radius of the cloth in the pipe
constexpr double kSlope = 0.62;  // growth of the mean radius along the cloth in the cone
constexpr std::uint32_t kPleats = 14;

// The points of the cloth at one distance from its middle. Seen from above, these points form a
// sine-generated curve, whose direction swings by +-`swing` radians. The curve is as long as the
// circle of these points in the flat cloth, but goes around a smaller circle.
struct Ring {
  double radius = 0, height = 0;             // mean values over the points
  std::vector<std::array<double, 2>> pleat;  // points (along, outward) of one pleat of unit length
};

constexpr std::uint32_t kSteps = 64;  // number of segments of the curve in Ring::pleat
constexpr std::uint32_t kRings = 600;
constexpr double kReachOfCloth = 1.5;  // distance of the last ring from the middle; above sqrt(2)

// Returns the mean of cos(swing sin(u)) over u: the Bessel function J0(swing). The mean falls from
// 1 to 0 while the swing grows from 0 to 2.4.
double advance(double swing) {
  double sum = 0;
  for (std::uint32_t k = 0; k < kSteps; ++k) sum += std::cos(swing * std::sin(kTurn * k / kSteps));
  return sum / kSteps;
}

std::vector<std::array<double, 2>> pleat_of(double wanted) {
  double lo = 0, hi = 2.4;
  for (int step = 0; step < 30; ++step) {
    const double middle = (lo + hi) / 2;
    (advance(middle) > wanted ? lo : hi) = middle;
  }
  std::vector<std::array<double, 2>> out(kSteps + 1, {0, 0});
  for (std::uint32_t k = 0; k < kSteps; ++k) {
    const double turned = lo * std::sin(kTurn * (k + 0.5) / kSteps);
    out[k + 1] = {out[k][0] + std::cos(turned) / kSteps, out[k][1] + std::sin(turned) / kSteps};
  }
  // Shifts the curve so that its mean outward distance is 0.
  double mean = 0;
  for (std::uint32_t k = 0; k < kSteps; ++k) mean += out[k][1] / kSteps;
  for (auto& [along, outward] : out) outward -= mean;
  return out;
}

std::vector<Ring> rings() {
  std::vector<Ring> out(kRings + 1);
  const double step = kReachOfCloth / kRings;
  const auto smooth = [](double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
  double radius = 0, height = 0;
  for (std::uint32_t k = 0; k <= kRings; ++k) {
    const double s = k * step;
    const double wanted = s <= kNarrow ? s : std::max(kNarrow, kNarrow + kSlope * (s - kPipe));
    out[k].radius = s == 0 ? 0 : s + (wanted - s) * smooth(s / kCap - 0.3);
    const double grown = out[k].radius - radius;
    if (k > 0) height += std::sqrt(std::max(0.0, step * step - grown * grown));
    radius = out[k].radius;
    out[k].height = height;
    out[k].pleat = pleat_of(s == 0 ? 1 : std::min(1.0, radius / s));
  }
  return out;
}

// Returns the position of a point of the hung cloth. In the flat cloth, the polar coordinates of
// the point are s and `turns` (an angle in turns). uneven: shift of the pleats, in pleats.
Vec3 hung(const std::vector<Ring>& table, double s, double turns, double uneven) {
  const double row = s / kReachOfCloth * kRings;
  const auto k = std::min(static_cast<std::uint32_t>(row), kRings - 1);
  const double t = row - k;
  const double pleats = kPleats * turns + uneven;
  const double begun = std::floor(pleats);
  const double column = (pleats - begun) * kSteps;
  const auto c = std::min(static_cast<std::uint32_t>(column), kSteps - 1);
  const double f = column - c;
  const auto at = [&](std::size_t axis) {
    const auto of = [&](const Ring& ring) {
      return (1 - f) * ring.pleat[c][axis] + f * ring.pleat[c + 1][axis];
    };
    return (1 - t) * of(table[k]) + t * of(table[k + 1]);
  };
  const double radius = (1 - t) * table[k].radius + t * table[k + 1].radius;
  const double height = (1 - t) * table[k].height + t * table[k + 1].height;
  const double length = kTurn * s / kPleats;  // length of a pleat
  const double pitch = s == 0 ? 1 : std::min(1.0, radius / s);
  const double angle = kTurn * ((begun + at(0) / pitch - uneven) / kPleats);
  const double out = radius + length * at(1);
  return {out * std::cos(angle), out * std::sin(angle), height};
}

struct FunnelGrid {
  std::uint32_t around = 96, pipe_rings = 8, cone_rings = 12;
  std::uint64_t triangles() const { return 2ull * around * (pipe_rings + cone_rings); }
};

// Returns a surface of revolution around all points. Its distance to the nearest point is `gap`.
Mesh funnel_around(const std::vector<Vec3>& points, double gap, const FunnelGrid& quads) {
  const double begin = rings()[static_cast<std::size_t>(kPipe / kReachOfCloth * kRings)].height;
  const double slope = kSlope / std::sqrt(1 - kSlope * kSlope);
  double pipe = 0, top = 0;
  for (const Vec3& p : points) {
    const double r = std::sqrt(p.x() * p.x() + p.y() * p.y());
    pipe = std::max(pipe, r - slope * std::max(0.0, p.z() - begin));
    top = std::max(top, p.z());
  }
  // The sides of a ring are nearer to the axis than its corners, so the corners are moved outward.
  const double widen = 1 / std::cos(kTurn / 2 / quads.around);
  std::vector<std::array<double, 2>> profile;  // radius, height
  for (std::uint32_t k = 0; k <= quads.pipe_rings; ++k)
    profile.push_back({pipe + gap, begin * (0.2 + 0.8 * k / quads.pipe_rings)});
  for (std::uint32_t k = 1; k <= quads.cone_rings; ++k) {
    const double z = (top - begin) * k / (quads.cone_rings - quads.cone_rings / 12.0);
    profile.push_back({pipe + gap + slope * z, begin + z});
  }
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& [radius, height] : profile) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (std::uint32_t i = 0; i < quads.around; ++i) {
      const double angle = kTurn * i / quads.around;
      vertices.emplace_back(widen * radius * std::cos(angle), widen * radius * std::sin(angle),
                            height);
      if (first == 0) continue;
      const std::uint32_t a = first + i, b = first + (i + 1) % quads.around;
      triangles.push_back({a - quads.around, b - quads.around, b});
      triangles.push_back({a - quads.around, b, a});
    }
  }
  return finished(std::move(vertices), std::move(triangles));
}

}  // namespace

BuiltScene make_funnel(const SceneParameters& parameters, std::uint64_t seed) {
  constexpr std::size_t kWaves = 3;
  Random random(seed);
  const double turned = random.unit();
  std::array<std::array<double, 3>, kWaves> waves;  // amplitude in pleats, phase in turns, twist
  for (auto& [height, phase, twist] : waves) {
    height = random.between(0.15, 0.3);
    phase = random.unit();
    twist = random.between(-0.5, 0.5);
  }
  FunnelGrid quads;
  const auto large = static_cast<std::uint32_t>(std::lround(parameters.second));
  if (large > 0) quads = {.around = (large + 3) / 4, .pipe_rings = 1, .cone_rings = 1};
  const std::uint32_t cells = cells_for(parameters.size - quads.triangles());
  Mesh mesh = grid(cells);
  const std::vector<Ring> table = rings();
  for (Vec3& p : mesh.vertices) {
    // Shifts the cloth, so that the middle of the pleats lies on no grid line.
    const double x = 2 * p.x() - 1 + 0.013, y = 2 * p.y() - 1 + 0.007;
    const double s = std::sqrt(x * x + y * y);
    const double angle = std::atan2(y, x) / kTurn + 0.5;
    double uneven = turned;
    for (std::size_t k = 0; k < kWaves; ++k) {
      const auto& [height, phase, twist] = waves[k];
      uneven += height * std::sin(kTurn * (static_cast<double>(k + 1) * angle + phase + twist * s));
    }
    p = hung(table, s, angle, uneven);
  }
  const Mesh around = funnel_around(mesh.vertices, 0.002, quads);
  SceneBuilder builder("funnel", "funnel");
  if (large > 0) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [a, b, c] : around.triangles)
      mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.vertices.insert(mesh.vertices.end(), around.vertices.begin(), around.vertices.end());
    mesh = finished(std::move(mesh.vertices), std::move(mesh.triangles));
  }
  builder.add(mesh, "cloth", Split::kNone, {}, true);
  if (large == 0) builder.add(around, "funnel");
  return {builder.finish(), {}};
}

}  // namespace farcull
