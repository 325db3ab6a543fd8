// Open3D's test of two triangles, and its self-intersections of one mesh that has all objects.
#include <open3d/Open3DConfig.h>
#include <open3d/geometry/IntersectionTest.h>
#include <open3d/geometry/TriangleMesh.h>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

bool pair(const SuitePair& asked) {
  const auto &a = asked.a, &b = asked.b;
  return open3d::geometry::IntersectionTest::TriangleTriangle3d(a[0], a[1], a[2], b[0], b[1], b[2]);
}

std::vector<TrianglePair> meshes(const Scene& scene) {
  open3d::geometry::TriangleMesh mesh;
  mesh.vertices_ = scene.vertices;
  for (const auto& [a, b, c] : scene.triangles)
    mesh.triangles_.emplace_back(static_cast<int>(a), static_cast<int>(b), static_cast<int>(c));
  std::vector<TrianglePair> out;
  for (const Eigen::Vector2i& found : mesh.GetSelfIntersectingTriangles()) {
    out.push_back({static_cast<std::uint32_t>(found[0]), static_cast<std::uint32_t>(found[1])});
  }
  leave_out_untested(scene, out);
  return out;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  return contest(
      argc, argv,
      {{.card = crossing_card("open3d", "Open3D " OPEN3D_VERSION), .pair = pair, .mesh = meshes}});
}
