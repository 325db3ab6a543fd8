// Functions of CGAL as contestants: the test of two triangles (with exact predicates, and with
// plain doubles), self-intersections of a mesh, intersections of meshes, the tree of boxes, and the
// side of a mesh on which a point is.
//
// NDEBUG is undefined, so CGAL's checks are on: a broken precondition gives an error, not an
// answer.
#undef NDEBUG
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/intersection.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version.h>

#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Plain = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Exact::Point_3>;

constexpr const char* kLibrary = "CGAL " CGAL_VERSION_STR;

template <class Kernel>
typename Kernel::Point_3 point(const Vec3& p) {
  return {p[0], p[1], p[2]};
}
template <class Kernel>
typename Kernel::Triangle_3 triangle(const std::array<Vec3, 3>& t) {
  return {point<Kernel>(t[0]), point<Kernel>(t[1]), point<Kernel>(t[2])};
}

template <class Kernel>
bool do_intersect(const SuitePair& pair) {
  return CGAL::do_intersect(triangle<Kernel>(pair.a), triangle<Kernel>(pair.b));
}

/// Adds a face. Reverses a triangle whose orientation differs from its neighbours' orientation.
/// Throws Refusal if more than two triangles would have an edge in common.
void add_face(Mesh& mesh, const std::array<Mesh::Vertex_index, 3>& corners) {
  const auto& [a, b, c] = corners;
  if (a == b || b == c || c == a)
    throw Refusal("Surface_mesh takes no triangle with a vertex twice");
  if (!mesh.add_face(a, b, c).is_valid() && !mesh.add_face(a, c, b).is_valid())
    throw Refusal("Surface_mesh holds no mesh that is not manifold");
}

/// Returns one mesh that has all objects. Face i is triangle i.
Mesh mesh_of(const Scene& scene) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> at;
  for (const Vec3& p : scene.vertices) at.push_back(mesh.add_vertex(point<Exact>(p)));
  for (const auto& [a, b, c] : scene.triangles) add_face(mesh, {at[a], at[b], at[c]});
  return mesh;
}

/// Returns the self-intersections of one mesh that has all objects.
std::vector<TrianglePair> self_scene(const Scene& scene) {
  const Mesh mesh = mesh_of(scene);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  PMP::self_intersections(mesh, std::back_inserter(pairs));
  std::vector<TrianglePair> out;
  for (const auto& [a, b] : pairs) out.push_back({a.idx(), b.idx()});
  leave_out_untested(scene, out);  // a pair of a face with itself marks a degenerate face
  return out;
}

bool self_pair(const SuitePair& pair) { return !self_scene(scene_of(pair)).empty(); }

bool side_of_mesh(const Scene& scene, const Vec3& p) {
  const Mesh mesh = mesh_of(scene);
  if (!CGAL::is_closed(mesh)) throw Refusal("Side_of_triangle_mesh takes closed meshes alone");
  const CGAL::Side_of_triangle_mesh<Mesh, Exact> side(mesh);
  return side(point<Exact>(p)) != CGAL::ON_UNBOUNDED_SIDE;
}

bool mesh_pair(const SuitePair& pair) {
  std::array<Mesh, 2> meshes;
  for (int i = 0; i < 2; ++i) {
    const auto& t = i == 0 ? pair.a : pair.b;
    const auto add = [&](int corner) { return meshes[i].add_vertex(point<Exact>(t[corner])); };
    const auto a = add(0), b = add(1), c = add(2);
    meshes[i].add_face(a, b, c);
  }
  return PMP::do_intersect(meshes[0], meshes[1]);
}

/// For each pair (a, b) of objects, finds the triangles of b that each triangle of a intersects.
std::vector<TrianglePair> tree_scene(const Scene& scene) {
  using Triangles = std::vector<Exact::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Exact, Triangles::const_iterator>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Exact, Primitive>>;
  Triangles triangles;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
    triangles.push_back(triangle<Exact>(scene.corners(t)));
  std::vector<TrianglePair> out;
  for_each_object_pair(scene, [&](const Object& a, const Object& b) {
    const auto first = triangles.cbegin() + b.first_triangle;
    const Tree tree(first, first + b.triangle_count);
    for (std::uint32_t i = 0; i < a.triangle_count; ++i) {
      const std::uint32_t t = a.first_triangle + i;
      std::vector<Triangles::const_iterator> found;
      tree.all_intersected_primitives(triangles[t], std::back_inserter(found));
      for (const auto at : found) {
        const auto u = static_cast<std::uint32_t>(at - triangles.cbegin());
        if (&a != &b || t < u) out.push_back({t, u});
      }
    }
  });
  return out;
}

ContestantCard card(const char* name, bool neighbours = false) {
  return {.name = name, .library = kLibrary, .degenerate = false, .neighbours = neighbours};
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  const auto self = [](const Scene& scene) { return PMP::does_self_intersect(mesh_of(scene)); };
  return contest(argc, argv,
                 {{.card = card("cgal-exact"),
                   .pair = do_intersect<Exact>,
                   .mesh = tree_scene,
                   .inside = side_of_mesh},
                  {.card = card("cgal-double"), .pair = do_intersect<Plain>},
                  {.card = card("cgal-self-intersections", true),
                   .pair = self_pair,
                   .mesh = self_scene,
                   .self = self},
                  {.card = card("cgal-do-intersect"), .pair = mesh_pair}});
}
