#include <farcull/farcull.h>

#include <cstdio>

int main() try {
  // Two triangles that cross, each an object of its own.
  std::vector<double> points = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, -4, 1, 1, 4, 2, 2, 4};
  const std::vector<std::uint32_t> triangles = {0, 1, 2, 3, 4, 5}, starts = {0, 1};
  farcull::Collider collider({.clearance = 0.01});
  for (int frame = 0; frame < 3; ++frame) {
    const auto found = collider.find({points, triangles, starts});
    std::printf("frame %d, on %s: %zu\n", frame, found.report.device.c_str(), found.pairs.size());
    for (const auto& pair : found.pairs) std::printf("  %u and %u\n", pair.a, pair.b);
    for (std::size_t x = 9; x < points.size(); x += 3) points[x] -= 0.9;  // the second moves
  }
} catch (const farcull::ColliderError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
