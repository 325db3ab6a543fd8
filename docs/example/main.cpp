#include <farcull/farcull.h>

#include <cstdio>

int main() try {
  // Two triangles that cross, each an object of its own.
  std::vector<double> vertices = {0,   0,   0,  1,   0,   0, 0,   1,   0,
                                  0.2, 0.2, -1, 0.2, 0.2, 1, 0.3, 0.3, 1};
  const std::vector<std::uint32_t> triangles = {0, 1, 2, 3, 4, 5}, starts = {0, 1};
  farcull::Collider collider({.clearance = 0.01});
  for (int frame = 0; frame < 3; ++frame) {
    const farcull::ColliderResult found = collider.find({vertices, triangles, starts});
    std::printf("frame %d: %zu of %llu candidates collide, on %s\n", frame, found.pairs.size(),
                static_cast<unsigned long long>(found.report.candidates),
                found.report.device.c_str());
    for (const farcull::ColliderPair& pair : found.pairs)
      std::printf("  %u and %u\n", pair.a, pair.b);
    for (std::size_t x = 9; x < vertices.size(); x += 3)
      vertices[x] -= 0.15;  // the second one moves
  }
} catch (const farcull::ColliderError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
