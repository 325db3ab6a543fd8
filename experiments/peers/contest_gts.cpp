// GTS: the faces of one surface that intersect, by gts_surface_foreach_intersecting_face(), which
// leaves out what faces have in common by an edge or a vertex. The only test of two triangles that
// it has for its users is this one.
#include <gts.h>

#include <unordered_map>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

/// One surface of all objects, and where its faces are from.
class Surface {
 public:
  Surface()
      : surface_(gts_surface_new(gts_surface_class(), gts_face_class(), gts_edge_class(),
                                 gts_vertex_class())) {}
  ~Surface() { gts_object_destroy(GTS_OBJECT(surface_)); }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  GtsVertex* vertex(const ContestPoint& p) {
    return gts_vertex_new(surface_->vertex_class, p[0], p[1], p[2]);
  }
  void add(GtsVertex* a, GtsVertex* b, GtsVertex* c, std::uint32_t object, std::uint32_t triangle) {
    if (a == b || b == c || c == a) throw Refusal("GTS has no face that names a vertex twice");
    GtsFace* const face = gts_face_new(surface_->face_class, edge(a, b), edge(b, c), edge(c, a));
    gts_surface_add_face(surface_, face);
    from_[GTS_BOUNDED(GTS_TRIANGLE(face))] = {object, triangle};
  }
  std::vector<ContestFound> intersecting() {
    found_.clear();
    gts_surface_foreach_intersecting_face(surface_, note, this);
    return found_;
  }

 private:
  static constexpr auto GTS_BOUNDED = [](GtsTriangle* t) { return static_cast<void*>(t); };

  GtsEdge* edge(GtsVertex* a, GtsVertex* b) {
    GtsSegment* const there = gts_vertices_are_connected(a, b);
    if (there != nullptr) return GTS_EDGE(there);
    return gts_edge_new(surface_->edge_class, a, b);
  }
  static void note(GtsBBox* a, GtsBBox* b, gpointer data) {
    auto& self = *static_cast<Surface*>(data);
    const auto &x = self.from_.at(a->bounded), &y = self.from_.at(b->bounded);
    self.found_.push_back({x.first, x.second, y.first, y.second});
  }

  GtsSurface* surface_;
  std::unordered_map<void*, std::pair<std::uint32_t, std::uint32_t>> from_;
  std::vector<ContestFound> found_;
};

bool pair(const ContestPair& asked) {
  Surface surface;
  std::array<GtsVertex*, 3> first, second;
  for (int i = 0; i < 3; ++i) first[i] = surface.vertex(asked.triangles[0][i]);
  for (int i = 0; i < 3; ++i) {
    second[i] = nullptr;
    for (const auto& [a, b] : asked.shared) {
      if (b == i) second[i] = first[a];
    }
    if (second[i] == nullptr) second[i] = surface.vertex(asked.triangles[1][i]);
  }
  surface.add(first[0], first[1], first[2], 0, 0);
  surface.add(second[0], second[1], second[2], 0, 1);
  return !surface.intersecting().empty();
}

std::vector<ContestFound> meshes(const ContestScene& scene) {
  Surface surface;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const ContestMesh& mesh = scene.objects[o];
    std::vector<GtsVertex*> at;
    for (const ContestPoint& p : mesh.vertices) at.push_back(surface.vertex(p));
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      surface.add(at[a], at[b], at[c], o, t);
    }
  }
  std::vector<ContestFound> found = surface.intersecting();
  if (!scene.self)
    std::erase_if(found, [](const ContestFound& of) { return of.object_a == of.object_b; });
  return found;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  return contest(
      argc, argv,
      {{.card =
            {.name = "gts",
             .library = "GTS " + std::to_string(gts_major_version) + "." +
                        std::to_string(gts_minor_version) + "." + std::to_string(gts_micro_version),
             .means = Means::crossing,
             .degenerate = false,
             .neighbours = true,
             .call = "gts_surface_foreach_intersecting_face() of one surface of both triangles, "
                     "or of all objects",
             .says = "its test of a segment and a triangle is \"geometrically robust in the sense "
                     "that it will not return a point if s and t do not intersect\"; coplanar "
                     "ones it leaves out, of touching it says nothing",
             .source = "GTS Library Reference Manual, Points, "
                       "gts_segment_triangle_intersection(); boolean.c, "
                       "gts_surface_foreach_intersecting_face()",
             .use = "\"collision and intersection detection\" of triangulated surfaces (README)"},
        .pair = pair,
        .mesh = meshes}});
}
