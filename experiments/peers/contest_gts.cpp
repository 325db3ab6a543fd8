// GTS finds the faces of one surface that intersect, by gts_surface_foreach_intersecting_face().
// Common edges and vertices of faces do not count. GTS has no other public test of two triangles.
#include <gts.h>

#include <unordered_map>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

/// One surface that has all objects.
class Surface {
 public:
  explicit Surface(std::size_t vertices)
      : surface_(gts_surface_new(gts_surface_class(), gts_face_class(), gts_edge_class(),
                                 gts_vertex_class())),
        vertices_(vertices) {}
  ~Surface() { gts_object_destroy(GTS_OBJECT(surface_)); }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  void add(const Scene& scene, std::uint32_t triangle) {
    std::array<GtsVertex*, 3> of;
    for (int i = 0; i < 3; ++i) of[i] = vertex(scene, scene.triangles[triangle][i]);
    const auto& [a, b, c] = of;
    if (a == b || b == c || c == a) throw Refusal("GTS has no face that names a vertex twice");
    GtsFace* const face = gts_face_new(surface_->face_class, edge(a, b), edge(b, c), edge(c, a));
    gts_surface_add_face(surface_, face);
    number_[GTS_TRIANGLE(face)] = triangle;
  }
  std::vector<TrianglePair> intersecting() {
    found_.clear();
    gts_surface_foreach_intersecting_face(surface_, note, this);
    return found_;
  }

 private:
  /// Returns vertex v. Makes the vertex when a face first uses it, since GTS destroys only vertices
  /// that belong to faces.
  GtsVertex* vertex(const Scene& scene, std::uint32_t v) {
    const Vec3& p = scene.vertices[v];
    if (vertices_[v] == nullptr)
      vertices_[v] = gts_vertex_new(surface_->vertex_class, p[0], p[1], p[2]);
    return vertices_[v];
  }
  GtsEdge* edge(GtsVertex* a, GtsVertex* b) {
    GtsSegment* const there = gts_vertices_are_connected(a, b);
    if (there != nullptr) return GTS_EDGE(there);
    return gts_edge_new(surface_->edge_class, a, b);
  }
  static void note(GtsBBox* a, GtsBBox* b, gpointer data) {
    auto& self = *static_cast<Surface*>(data);
    self.found_.push_back({self.number_.at(a->bounded), self.number_.at(b->bounded)});
  }

  GtsSurface* surface_;
  std::vector<GtsVertex*> vertices_;
  std::unordered_map<void*, std::uint32_t> number_;  // from a GtsFace to the number of its triangle
  std::vector<TrianglePair> found_;
};

std::vector<TrianglePair> meshes(const Scene& scene) {
  Surface surface(scene.vertices.size());
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) surface.add(scene, t);
  std::vector<TrianglePair> found = surface.intersecting();
  leave_out_untested(scene, found);
  return found;
}

bool pair(const SuitePair& asked) { return !meshes(scene_of(asked)).empty(); }

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  ContestantCard card = crossing_card("gts", "GTS " + std::to_string(gts_major_version) + "." +
                                                 std::to_string(gts_minor_version) + "." +
                                                 std::to_string(gts_micro_version));
  card.neighbours = true;
  return contest(argc, argv, {{.card = card, .pair = pair, .mesh = meshes}});
}
