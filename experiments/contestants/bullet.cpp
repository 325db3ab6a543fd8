// Bullet's GImpact meshes, by btCollisionWorld::contactPairTest(): its trees of boxes and its own
// test of two triangles. The file is compiled twice, for Bullet in float and in double.
//
// Contacts are a list of points, each with the triangles that it is between. GImpact adds a margin
// to every shape, and it is set to 0 here, as its documentation lets a user do.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <memory>

#include "experiments/contestants/contestant.h"

namespace farcull {
namespace {

#ifdef BT_USE_DOUBLE_PRECISION
constexpr const char* kName = "bullet-gimpact-double";
constexpr const char* kType = "double";
#else
constexpr const char* kName = "bullet-gimpact-float";
constexpr const char* kType = "float";
#endif

/// A mesh as Bullet holds it, which keeps the vertices and triangles of its maker.
class Body {
 public:
  explicit Body(const ContestMesh& mesh) {
    for (const ContestPoint& p : mesh.vertices) {
      for (const double x : p) vertices_.push_back(static_cast<btScalar>(x));
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t v : triangle) indices_.push_back(static_cast<int>(v));
    }
    arrays_ = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.triangles.size()), indices_.data(), 3 * sizeof(int),
        static_cast<int>(mesh.vertices.size()), vertices_.data(), 3 * sizeof(btScalar));
    shape_ = std::make_unique<btGImpactMeshShape>(arrays_.get());
    shape_->setMargin(0);
    shape_->updateBound();
    object_ = std::make_unique<btCollisionObject>();
    object_->setCollisionShape(shape_.get());
    object_->setWorldTransform(btTransform::getIdentity());
  }
  btCollisionObject* object() { return object_.get(); }

 private:
  std::vector<btScalar> vertices_;
  std::vector<int> indices_;
  std::unique_ptr<btTriangleIndexVertexArray> arrays_;
  std::unique_ptr<btGImpactMeshShape> shape_;
  std::unique_ptr<btCollisionObject> object_;
};

/// Notes the triangles of each contact.
struct Contacts : btCollisionWorld::ContactResultCallback {
  const btCollisionObject* first = nullptr;
  std::vector<std::pair<int, int>> pairs;

  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int,
                           int triangle_a, const btCollisionObjectWrapper*, int,
                           int triangle_b) override {
    if (point.getDistance() > 0) return 0;  // near, and no contact
    if (a->getCollisionObject() != first) std::swap(triangle_a, triangle_b);
    pairs.emplace_back(triangle_a, triangle_b);
    return 0;
  }
};

class World {
 public:
  World() : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &configuration_) {
    // registerAlgorithm() is for the steps of a simulation; contactPairTest() looks up the
    // algorithm in a table of its own.
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    dispatcher_.registerClosestPointsCreateFunc(GIMPACT_SHAPE_PROXYTYPE, GIMPACT_SHAPE_PROXYTYPE,
                                                &create_);
  }
  std::vector<std::pair<int, int>> contacts(Body& a, Body& b) {
    Contacts out;
    out.first = a.object();
    world_.contactPairTest(a.object(), b.object(), out);
    return out.pairs;
  }

 private:
  btGImpactCollisionAlgorithm::CreateFunc create_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_;
};

World& world() {
  static World one;
  return one;
}

ContestMesh mesh_of(const ContestTriangle& triangle) {
  return {.vertices = {triangle.begin(), triangle.end()}, .triangles = {{0, 1, 2}}};
}

bool pair(const ContestPair& asked) {
  Body a(mesh_of(asked.triangles[0])), b(mesh_of(asked.triangles[1]));
  return !world().contacts(a, b).empty();
}

std::vector<ContestFound> meshes(const ContestScene& scene) {
  if (scene.self) throw Refusal("GImpact tests no mesh against itself");
  std::vector<std::unique_ptr<Body>> bodies;
  for (const ContestMesh& mesh : scene.objects) bodies.push_back(std::make_unique<Body>(mesh));
  std::vector<ContestFound> out;
  for_each_object_pair(scene, [&](std::uint32_t a, std::uint32_t b) {
    for (const auto& [t, u] : world().contacts(*bodies[a], *bodies[b]))
      out.push_back({a, static_cast<std::uint32_t>(t), b, static_cast<std::uint32_t>(u)});
  });
  return out;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  return contest(
      argc, argv,
      {{.card = {.name = kName,
                 .library = "Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." +
                            std::to_string(BT_BULLET_VERSION % 100),
                 .means = Means::crossing,
                 .degenerate = false,
                 .call = std::string("btCollisionWorld::contactPairTest() of two "
                                     "btGImpactMeshShape with margin 0, btScalar ") +
                         kType,
                 .says =
                     "contacts are for the dynamics of bodies; the manual says nothing of exact "
                     "answers, and asks for sizes from 0.05 to 10 units",
                 .use = "games and simulation, where a contact that is lost for a step is found in "
                        "the next"},
        .pair = pair,
        .mesh = meshes}});
}
