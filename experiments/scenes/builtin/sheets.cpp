// Sheets of which no argument about closed meshes holds: open, with edges of three triangles, and
// stacked so closely that a depth buffer of 24 bits cannot separate them.
#include <cmath>
#include <string>
#include <utility>

#include "experiments/scenes/builtin/generators.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {

using namespace shapes;

namespace {

constexpr std::uint32_t kCells = 18;  // along a side, which is 1 long
constexpr double kGrain = 0x1p-40;    // heights are multiples of it

std::uint32_t at(std::uint32_t i, std::uint32_t j) { return i * (kCells + 1) + j; }

// A square of 18 by 18 cells of two triangles. From the middle of its grid lines i = 6 and i = 12
// rise flaps of 12 by 1 cells, over the cells beyond: on these edges three triangles meet. The
// raised vertices come after those of the grid.
Mesh sheet() {
  auto [vertices, triangles, source_face, group, group_names, folded] = grid(kCells);
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

// size: sheets. All heights are multiples of 2^-40 below 2^10, so that sums with the gap, 2^-34,
// are exact: a sheet of the stack is an exact translate of the one below it and never meets it; nor
// do the flaps, half a gap high over cells of the same corners.
BuiltScene make_shells(const SceneParameters& parameters, std::uint64_t seed) {
  static_assert(kShellGap / 2 >= kGrain);
  const Mesh shape = sheet();
  const std::size_t grid = at(kCells, kCells) + 1;
  const std::uint64_t stacked = parameters.size - parameters.size / 4;
  SceneBuilder builder("shells", "shells");
  for (std::uint64_t s = 0; s < parameters.size; ++s) {
    builder.add(shape, (s < stacked ? "sheet" : "crossing") + std::to_string(s), Split::kNone, {});
  }
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
          // From below the stack to above it, the direction turning with time.
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

}  // namespace

std::vector<BuiltinScene> sheet_scenes() {
  return {
      drawn({.name = "shells",
             .description = "open non-manifold sheets, three in four of them stacked at gaps of "
                            "2^-34 of their width, the others through them at angles as small",
             .objects = 16,
             .triangles = 11'136,
             .size = SceneSize{"sheets", 4, 10'000, 16},
             .motion = "waves run through the stack while the others tilt"},
            12, make_shells),
  };
}

}  // namespace farcull
