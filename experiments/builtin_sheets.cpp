// Sheets that no closed-mesh argument helps with: open, with edges of three triangles, and stacked
// so closely that no depth buffer of 24 bits tells them apart.
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "experiments/builtin_parts.h"
#include "experiments/builtin_shapes.h"
#include "experiments/scene_build.h"

namespace farcull {

using namespace shapes;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::uint32_t kCells = 18;  // along a side, which is 1 long
constexpr double kGrain = 0x1p-40;    // heights are multiples of it

std::uint32_t at(std::uint32_t i, std::uint32_t j) { return i * (kCells + 1) + j; }

// A square of 18 by 18 cells of two triangles. From the middle of its grid lines i = 6 and i = 12
// rise flaps of 12 by 1 cells, over the cells beyond: on these edges three triangles meet. The
// raised vertices come after those of the grid.
Mesh sheet() {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i <= kCells; ++i) {
    for (std::uint32_t j = 0; j <= kCells; ++j)
      vertices.emplace_back(static_cast<double>(i) / kCells, static_cast<double>(j) / kCells, 0);
  }
  for (std::uint32_t i = 0; i < kCells; ++i) {
    for (std::uint32_t j = 0; j < kCells; ++j) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
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

}  // namespace

// All heights are multiples of 2^-40 below 2^10, so that sums with the gap, 2^-34, are exact: a
// sheet of the stack is an exact translate of the one below it and never meets it; nor do the
// flaps, half a gap high over cells of the same corners.
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
  FrameNotes none;
  built.motion({.frame = 0, .time = 0.5}, built.scene, none);
  return built;
}

}  // namespace farcull
