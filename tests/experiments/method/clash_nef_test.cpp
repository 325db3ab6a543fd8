// Which parts of an assembly overlap, by CGAL's Nef polyhedra: the insides of two closed parts have
// a point in common iff `farcull clash` calls them a clash or contained.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/boost/graph/graph_traits_Polyhedron_3.h>

#include <Eigen/Geometry>

#include "tests/lab/assembly.h"

namespace farcull {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;

/// The solid of a closed object: its shells that face outward, less those that face inward.
Nef solid_of(const Scene& scene, const Object& object) {
  std::vector<std::uint32_t> leader(scene.vertices.size());  // of the vertices of a shell
  std::iota(leader.begin(), leader.end(), 0u);
  const auto leader_of = [&](std::uint32_t v) {
    while (leader[v] != v) v = leader[v] = leader[leader[v]];
    return v;
  };
  const auto triangles =
      std::span(scene.triangles).subspan(object.first_triangle, object.triangle_count);
  for (const auto& t : triangles) {
    for (const std::uint32_t v : {t[1], t[2]}) leader[leader_of(v)] = leader_of(t[0]);
  }
  std::map<std::uint32_t, std::vector<std::array<std::uint32_t, 3>>> shells;
  for (const auto& t : triangles) shells[leader_of(t[0])].push_back(t);
  Nef out(Nef::EMPTY);
  std::vector<Nef> hollows;
  for (const auto& [of, shell] : shells) {
    double volume = 0;
    std::map<std::uint32_t, std::size_t> number;
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> faces;
    for (const auto& t : shell) {
      volume += scene.vertices[t[0]].dot(scene.vertices[t[1]].cross(scene.vertices[t[2]]));
      std::vector<std::size_t>& face = faces.emplace_back();
      for (const std::uint32_t v : t) {
        const auto [at, is_new] = number.try_emplace(v, points.size());
        const Vec3& p = scene.vertices[v];
        if (is_new) points.emplace_back(p.x(), p.y(), p.z());
        face.push_back(at->second);
      }
    }
    if (volume < 0) {
      for (auto& face : faces) std::swap(face[1], face[2]);
    }
    Polyhedron polyhedron;
    CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, faces, polyhedron);
    if (volume < 0) {
      hollows.emplace_back(polyhedron);
    } else {
      out += Nef(polyhedron);
    }
  }
  // A part that is turned inside out as a whole has its inside where its winding number is -1.
  const bool turned = out.is_empty();
  for (const Nef& hollow : hollows) {
    if (turned) out += hollow;
    if (!turned) out -= hollow.interior();  // its surface stays
  }
  return out;
}

TEST(Clash, OfAnAssemblyIsAsNefPolyhedraSay) {
  const lab::Assembly assembly;
  const Scene& scene = assembly.parts.scene;
  std::map<ObjectPair, ClashVerdict> ours;
  for (const ClashRow& row : clashes(scene, {}).rows) ours[row.objects] = row.verdict;
  const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
  std::map<std::uint32_t, Nef> solids;
  const auto solid = [&](std::uint32_t o) -> const Nef& {
    if (!solids.contains(o)) solids.emplace(o, solid_of(scene, scene.objects[o]));
    return solids.at(o);
  };
  int compared = 0, wrong = 0, noticed = 0, touching = 0;
  for (std::uint32_t a = 0; a < scene.objects.size(); ++a) {
    for (std::uint32_t b = a + 1; b < scene.objects.size(); ++b) {
      if (!overlap(boxes[a], boxes[b]) || !is_closed(scene, a) || !is_closed(scene, b)) continue;
      ++compared;
      const auto at = ours.find({a, b});
      const bool said = at != ours.end() && at->second <= ClashVerdict::contained;
      wrong += said == (solid(a).interior() * solid(b).interior()).is_empty();
      touching += at != ours.end() && at->second == ClashVerdict::touch;
      // The twin: closed solids have a point in common where they touch, too.
      noticed += said == (solid(a) * solid(b)).is_empty();
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(noticed, touching);
  EXPECT_GT(touching, 5);
  EXPECT_GT(compared, 30);
}

}  // namespace
}  // namespace farcull
