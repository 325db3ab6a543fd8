// Bullet's GImpact meshes, by btCollisionWorld::contactPairTest(). This function uses Bullet's
// trees of boxes and Bullet's test of two triangles. This file is compiled twice, for Bullet in
// float and for Bullet in double.
//
// Bullet reports a list of contact points, each with two triangles. Bullet adds a margin to every
// shape, so it reports triangles that are apart. There are two contestants: with the default
// margin, as Bullet's manual advises, and with a margin of 0. The manual advises against 0, but
// with a larger margin Bullet cannot distinguish triangles that meet from triangles that are apart.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <memory>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

#ifdef BT_USE_DOUBLE_PRECISION
constexpr const char* kType = "double";
#else
constexpr const char* kType = "float";
#endif

/// An object in Bullet. Bullet keeps pointers to the members of this class.
class Body {
 public:
  Body(const Scene& scene, const Object& object, bool with_margin) {
    const auto [first, last] = vertices_of(scene, object);
    for (std::uint32_t v = first; v <= last; ++v) {
      for (const double x : scene.vertices[v]) vertices_.push_back(static_cast<btScalar>(x));
    }
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      for (const std::uint32_t v : scene.triangles[object.first_triangle + t])
        indices_.push_back(static_cast<int>(v - first));
    }
    arrays_ = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(object.triangle_count), indices_.data(), 3 * sizeof(int),
        static_cast<int>(last - first + 1), vertices_.data(), 3 * sizeof(btScalar));
    shape_ = std::make_unique<btGImpactMeshShape>(arrays_.get());
    if (!with_margin) shape_->setMargin(0);
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

/// Records the triangles of each contact.
struct Contacts : btCollisionWorld::ContactResultCallback {
  const btCollisionObject* first = nullptr;
  std::vector<std::pair<int, int>> pairs;

  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int,
                           int triangle_a, const btCollisionObjectWrapper*, int,
                           int triangle_b) override {
    if (point.getDistance() > 0) return 0;  // the triangles are near each other, but not in contact
    if (a->getCollisionObject() != first) std::swap(triangle_a, triangle_b);
    pairs.emplace_back(triangle_a, triangle_b);
    return 0;
  }
};

class World {
 public:
  World() : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &configuration_) {
    // registerAlgorithm() alone is enough for a simulation. contactPairTest() needs
    // registerClosestPointsCreateFunc(), too.
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

std::vector<TrianglePair> meshes(const Scene& scene, bool with_margin) {
  if (has_self(scene)) throw Refusal("GImpact tests no mesh against itself");
  static World world;
  std::vector<std::unique_ptr<Body>> bodies;
  for (const Object& object : scene.objects)
    bodies.push_back(std::make_unique<Body>(scene, object, with_margin));
  std::vector<TrianglePair> out;
  for_each_object_pair(scene, [&](const Object& a, const Object& b) {
    const auto body = [&](const Object& of) -> Body& {
      return *bodies[&of - scene.objects.data()];
    };
    for (const auto& [t, u] : world.contacts(body(a), body(b))) {
      out.push_back({a.first_triangle + static_cast<std::uint32_t>(t),
                     b.first_triangle + static_cast<std::uint32_t>(u)});
    }
  });
  return out;
}

/// margin: world units. Triangles at most this far apart are reported. 0: shapes have no margin.
Contestant contestant(const std::string& name, double margin) {
  ContestantCard card =
      crossing_card(name + kType, "Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." +
                                      std::to_string(BT_BULLET_VERSION % 100));
  card.margin = margin;
  const auto mesh = [margin](const Scene& scene) { return meshes(scene, margin > 0); };
  const auto pair = [mesh](const SuitePair& asked) { return !mesh(two_objects(asked)).empty(); };
  return {.card = card, .pair = pair, .mesh = mesh};
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  // According to Bullet's manual, each shape has a margin of 0.04. Two shapes have 0.08 together.
  return contest(argc, argv,
                 {contestant("bullet-gimpact-", 0), contestant("bullet-gimpact-margin-", 0.08)});
}
