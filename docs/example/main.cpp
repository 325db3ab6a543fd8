#include <farcull/distance.h>
#include <farcull/farcull.h>

#include <cstdio>

int main() try {
  std::printf("farcull %s\n", farcull::version());
  // Two triangles that cross, each an object of its own.
  const std::vector<double> points = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, -4, 1, 1, 4, 2, 2, 4};
  const std::vector<std::uint32_t> triangles = {0, 1, 2, 3, 4, 5}, starts = {0, 1};
  const farcull::Input input{points, triangles, starts};
  std::printf("pairs: %zu\n", farcull::collide(input).pairs.size());

  farcull::Collider collider({.clearance = 0.01});
  collider.find(input);
  std::vector<farcull::Pose> poses(2);
  for (int frame = 1; frame < 4; ++frame) {
    poses[1].t[0] -= 0.9;  // the second object moves
    const farcull::Result found = collider.find({.poses = poses});
    std::printf("frame %d: %zu\n", frame, found.pairs.size());
    for (const farcull::Pair& pair : found.pairs) std::printf("  %u and %u\n", pair.a, pair.b);
  }
  farcull::Input apart = input;
  apart.poses = poses;
  std::printf("distance: %.3g\n", farcull::distances(apart)[0].distance);
} catch (const farcull::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
