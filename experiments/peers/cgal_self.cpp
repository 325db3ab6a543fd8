// CGAL's self_intersections() (Polygon_mesh_processing): the pairs of a mesh with itself, found by
// box_intersection_d with cutoff 2000 and decided at once by CGAL's exact predicates. So nothing
// here is decided by farcull, and there are no candidates to be counted but the pairs reported.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version.h>

#include <algorithm>
#include <memory>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#endif

#include "experiments/peers/parts.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr const char* kLibrary = "CGAL " CGAL_VERSION_STR;

/// The only object with triangles, where it is tested against itself; else null.
const Object* only_self(const Scene& scene) {
  const Object* only = nullptr;
  for (const Object& object : scene.objects) {
    if (object.triangle_count == 0) continue;
    if (only || !object.self) return nullptr;
    only = &object;
  }
  return only;
}

/// A mesh whose face i is triangle i of the object. A triangle that would make the mesh no manifold
/// gets corners of its own. Its neighbours are then reported as pairs, and dropped by position.
Mesh mesh_of(const Scene& scene, const Object& object) {
  Mesh mesh;
  mesh.reserve(static_cast<Mesh::size_type>(scene.vertices.size()),
               object.triangle_count + object.triangle_count / 2, object.triangle_count);
  const auto add_vertex = [&](std::uint32_t v) {
    const Vec3& p = scene.vertices[v];
    return mesh.add_vertex({p.x(), p.y(), p.z()});
  };
  std::vector<Mesh::Vertex_index> made(scene.vertices.size(), Mesh::null_vertex());
  for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
    const auto& [a, b, c] = scene.triangles[object.first_triangle + i];
    for (const std::uint32_t v : {a, b, c}) {
      if (made[v] == Mesh::null_vertex()) made[v] = add_vertex(v);
    }
    if (mesh.add_face(made[a], made[b], made[c]) == Mesh::null_face()) {
      mesh.add_face(add_vertex(a), add_vertex(b), add_vertex(c));
    }
  }
  return mesh;
}

/// self_intersections() writes here, from one thread.
struct Collector {
  const Scene& scene;
  std::uint32_t first;
  BenchAnswer& answer;

  void operator()(const std::pair<Mesh::Face_index, Mesh::Face_index>& faces) const {
    const std::uint32_t a = first + faces.first.idx(), b = first + faces.second.idx();
    ++answer.candidate_pairs;
    if (share_position(scene.corners(a), scene.corners(b))) return;
    answer.pairs.push_back({std::min(a, b), std::max(a, b)});
  }
};

template <class Tag>
BenchAnswer self_intersections(const Scene& scene) {
  BenchAnswer answer;
  const Object* const object = only_self(scene);
  if (!object) return answer;
  const Stopwatch building;
  const Mesh mesh = mesh_of(scene, *object);
  answer.build_ms = building.ms();
  const Stopwatch finding;
  const Collector collect{scene, object->first_triangle, answer};
  CGAL::Polygon_mesh_processing::self_intersections<Tag>(
      mesh, boost::make_function_output_iterator(collect));
  std::sort(answer.pairs.begin(), answer.pairs.end());
  answer.candidates_ms = finding.ms();
  return answer;
}

/// self_intersections() makes no box for a degenerate triangle, and so reports none of its pairs.
std::string refuses(const Scene& scene) {
  if (!only_self(scene)) return "it takes one object, tested against itself";
  if (degenerate_triangles(scene) > 0) return "it leaves degenerate triangles out";
  return "";
}

#ifdef CGAL_LINKED_WITH_TBB
BenchRun parallel(unsigned threads) {
  const auto limit =
      std::make_shared<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
  return [limit](const Scene& scene) { return self_intersections<CGAL::Parallel_tag>(scene); };
}
#endif

}  // namespace

std::vector<Peer> cgal_self_peers(unsigned threads) {
  const auto sequential = [](unsigned) -> BenchRun {
    return self_intersections<CGAL::Sequential_tag>;
  };
  std::vector<Peer> peers = {
      {"cgal-self-intersections", kLibrary, "", sequential, refuses},
      {"cgal-self-intersections-parallel", kLibrary, "", {}, refuses},
  };
#ifdef CGAL_LINKED_WITH_TBB
  peers[1].set_up = parallel;
  if (threads == 1) peers[1].missing = "the same as without -parallel on one thread";
#else
  (void)threads;
  peers[1].missing = "built without TBB (Debian: libtbb-dev)";
#endif
  return peers;
}

}  // namespace farcull
