// The contacts of two objects, one of which moves: what a simulation asks for in each step.
#include <farcull/distance.h>

#include <cstdio>

int main() try {
  const std::vector<double> vertices = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 0, 1, 1, 4, 2, 1, 4};
  const std::vector<std::uint32_t> triangles = {0, 1, 2, 3, 4, 5}, object_starts = {0, 1};

  farcull::DistanceFinder finder({.kind = farcull::DistanceKind::all, .within = 0.6});
  farcull::Input input{vertices, triangles, object_starts};
  std::vector<farcull::Pose> poses(2);  // nothing moves, until r or t is set
  for (int step = 0; step < 4; ++step) {
    poses[1].r = {0, -1, 0, 1, 0, 0, 0, 0, 1};  // a quarter turn about z, row by row
    poses[1].t = {2, 0, 0.75 - 0.25 * step};
    input.poses = poses;
    std::printf("step %d\n", step);
    for (const farcull::DistanceAnswer& c : finder.find(input)) {
      const auto& [x, y, z] = c.normal;
      std::printf("  objects %u and %u: %g along (%g, %g, %g)\n", c.object_a, c.object_b,
                  c.distance, x, y, z);
      std::printf("    weights of triangle %u: %g, %g, %g\n", c.triangle_a, c.weights_a[0],
                  c.weights_a[1], c.weights_a[2]);
    }
    input = {};  // from now on the poses move the arrays of the first call
  }
} catch (const farcull::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
