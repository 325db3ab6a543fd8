// ODE as its users run it: sweep and prune, trees (OPCODE, in float), and contacts of triangles.
// All three round. ODE's public interface does not return candidates, so exact tests cannot follow.
//
// ODE reports contacts. Each contact has two triangles. ODE merges two contacts that are within
// 1e-4 units of each other. If their depths are equal, ODE calls a callback, which here records the
// triangle pairs of both contacts. Else ODE keeps only the deeper contact. ODE reports at most
// 65,535 contacts of two objects, and no contact of an object with itself. All pairs that are lost
// in this way count as missed.
#include <ode/ode.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <type_traits>

#include "core/base/error.h"
#include "experiments/peers/peer.h"

namespace farcull {
namespace {

static_assert(std::is_same_v<dReal, double> && sizeof(Vec3) == 3 * sizeof(double));

constexpr const char* kLibrary = "ODE " dODE_VERSION;
constexpr int kMostContacts = 65535;  // the largest number that dCollide() accepts

[[noreturn]] void refuse(int, const char* message, std::va_list arguments) {
  char text[400];
  std::vsnprintf(text, sizeof text, message, arguments);
  throw Error(kLibrary, text, "leave it out");
}

/// Starts ODE once. A failed assertion of ODE throws Error. Messages of ODE are not printed.
void start_ode() {
  static const bool started = [] {
    dSetErrorHandler(refuse);
    dSetDebugHandler(refuse);
    dSetMessageHandler([](int, const char*, std::va_list) {});
    return dInitODE2(0) != 0;
  }();
  if (!started || dAllocateODEDataForThread(dAllocateMaskAll) == 0) {
    throw Error(kLibrary, "does not start", "build farcull without ODE");
  }
}

/// Merged contacts of two objects. For each merge, ODE calls note_merged() for the first object and
/// then for the second object. Each call names two triangles of the object: `had` is in the contact
/// that ODE keeps, and `merged` is in the contact that ODE drops.
struct Merged {
  dGeomID first = nullptr;
  int had = 0;
  int merged = 0;
  std::vector<std::pair<int, int>> pairs;  // a triangle of the first object and one of the second
};

/// An object with its tree in ODE. ODE keeps pointers to the scene's vertices and to faces_.
class Model {
 public:
  Model(const Scene& scene, const Object& object, Merged& merged)
      : first_(object.first_triangle), count_(object.triangle_count), merged_(merged) {
    const auto triangles = std::span(scene.triangles).subspan(first_, object.triangle_count);
    const auto [least, most] = vertices_of(scene, object);
    faces_.reserve(triangles.size());
    for (const auto& [a, b, c] : triangles) faces_.push_back({a - least, b - least, c - least});
    // In ODE 0.16.2, a mesh of one triangle has no contacts, and two such meshes crash ODE. So the
    // mesh gets its only triangle twice.
    if (faces_.size() == 1) faces_.push_back(faces_.front());
    data_ = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data_, scene.vertices[least].data(), sizeof(Vec3),
                                static_cast<int>(most - least + 1), faces_.data(),
                                static_cast<int>(3 * faces_.size()), sizeof(faces_[0]));
    geom_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
    dGeomTriMeshSetTriMergeCallback(geom_, note_merged);
    dGeomSetData(geom_, this);
  }
  ~Model() {
    dGeomDestroy(geom_);
    dGeomTriMeshDataDestroy(data_);
  }
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  static Model& of(dGeomID geom) { return *static_cast<Model*>(dGeomGetData(geom)); }
  dGeomID geom() const { return geom_; }
  std::uint32_t triangle(int face) const {
    return first_ + std::min(static_cast<std::uint32_t>(face), count_ - 1);
  }

 private:
  static int note_merged(dGeomID geom, int had, int merged) {
    Merged& note = of(geom).merged_;
    if (geom == note.first) {
      note.had = had;
      note.merged = merged;
    } else {
      note.pairs.insert(note.pairs.end(), {{note.had, had}, {note.merged, merged}});
    }
    return merged;
  }

  std::uint32_t first_, count_;
  Merged& merged_;
  std::vector<std::array<dTriIndex, 3>> faces_;
  dTriMeshDataID data_;
  dGeomID geom_;
};

/// Returns the pairs of objects whose boxes overlap, by ODE's sweep and prune.
std::vector<std::pair<const Model*, const Model*>> meeting(
    const std::vector<std::unique_ptr<Model>>& models) {
  std::vector<std::pair<const Model*, const Model*>> pairs;
  const dSpaceID space = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
  dSpaceSetCleanup(space, 0);  // the space does not own its geometries
  for (const auto& model : models) dSpaceAdd(space, model->geom());
  dSpaceCollide(space, &pairs, [](void* data, dGeomID a, dGeomID b) {
    static_cast<decltype(pairs)*>(data)->emplace_back(&Model::of(a), &Model::of(b));
  });
  for (const auto& model : models) dSpaceRemove(space, model->geom());
  dSpaceDestroy(space);
  return pairs;
}

/// Adds the pairs of triangles in the contacts of two objects. contacts: a buffer of kMostContacts
/// contacts.
void add_pairs(const Model& a, const Model& b, Merged& merged, std::vector<dContactGeom>& contacts,
               std::vector<TrianglePair>& pairs) {
  merged.first = a.geom();
  merged.pairs.clear();
  const int count =
      dCollide(a.geom(), b.geom(), kMostContacts, contacts.data(), sizeof(dContactGeom));
  for (int i = 0; i < count; ++i) merged.pairs.emplace_back(contacts[i].side1, contacts[i].side2);
  for (const auto& [of_a, of_b] : merged.pairs) {
    const std::uint32_t t = a.triangle(of_a), u = b.triangle(of_b);
    pairs.push_back({std::min(t, u), std::max(t, u)});
  }
}

/// Ignores the number of threads: ODE's collider has global state, so it runs on one thread.
BenchAnswer collide(const Scene& scene, unsigned) {
  start_ode();
  BenchAnswer answer;
  Merged merged;
  const Stopwatch building;
  std::vector<std::unique_ptr<Model>> models;
  for (const std::uint32_t o : objects_with_triangles(scene))
    models.push_back(std::make_unique<Model>(scene, scene.objects[o], merged));
  answer.build_ms = building.ms();
  const Stopwatch finding;
  std::vector<dContactGeom> contacts(kMostContacts);
  for (const auto& [a, b] : meeting(models)) add_pairs(*a, *b, merged, contacts, answer.pairs);
  std::sort(answer.pairs.begin(), answer.pairs.end());
  answer.pairs.erase(std::unique(answer.pairs.begin(), answer.pairs.end()), answer.pairs.end());
  answer.candidates_ms = finding.ms();
  answer.candidate_pairs = answer.pairs.size();
  return answer;
}

std::string refuses_self(const Scene& scene) {
  return has_self(scene) ? "it tests no object against itself" : "";
}

}  // namespace

LibraryPeers ode_library() {
  return {.narrow = {plain_peer("ode-trimesh", kLibrary, collide, refuses_self)}};
}

}  // namespace farcull
