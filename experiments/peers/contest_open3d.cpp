// Open3D: its test of two triangles, and the self-intersections of one mesh of all objects.
#include <open3d/Open3DConfig.h>
#include <open3d/geometry/IntersectionTest.h>
#include <open3d/geometry/TriangleMesh.h>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

Eigen::Vector3d point(const ContestPoint& p) { return {p[0], p[1], p[2]}; }

bool pair(const ContestPair& asked) {
  const auto& [a, b] = asked.triangles;
  return open3d::geometry::IntersectionTest::TriangleTriangle3d(
      point(a[0]), point(a[1]), point(a[2]), point(b[0]), point(b[1]), point(b[2]));
}

std::vector<ContestFound> meshes(const ContestScene& scene) {
  open3d::geometry::TriangleMesh mesh;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> from;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const auto first = static_cast<int>(mesh.vertices_.size());
    for (const ContestPoint& p : scene.objects[o].vertices) mesh.vertices_.push_back(point(p));
    for (std::uint32_t t = 0; t < scene.objects[o].triangles.size(); ++t) {
      const auto& [a, b, c] = scene.objects[o].triangles[t];
      mesh.triangles_.emplace_back(first + static_cast<int>(a), first + static_cast<int>(b),
                                   first + static_cast<int>(c));
      from.emplace_back(o, t);
    }
  }
  std::vector<ContestFound> out;
  for (const Eigen::Vector2i& found : mesh.GetSelfIntersectingTriangles()) {
    const auto &x = from[static_cast<std::size_t>(found[0])],
               &y = from[static_cast<std::size_t>(found[1])];
    if (scene.self || x.first != y.first) out.push_back({x.first, x.second, y.first, y.second});
  }
  return out;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  return contest(argc, argv,
                 {{.card = {.name = "open3d",
                            .library = "Open3D " OPEN3D_VERSION,
                            .means = Means::crossing,
                            .degenerate = false,
                            .call = "IntersectionTest::TriangleTriangle3d(); meshes by "
                                    "TriangleMesh::GetSelfIntersectingTriangles() of all objects "
                                    "as one",
                            .says = "nothing of exactness or of touching: the test of two "
                                    "triangles has no comment, the other is a \"list of triangles "
                                    "that are intersecting the mesh\"",
                            .source = "open3d/geometry/IntersectionTest.h; TriangleMesh.h, "
                                      "GetSelfIntersectingTriangles()",
                            .use = "to inspect and repair scanned meshes"},
                   .pair = pair,
                   .mesh = meshes}});
}
