// Motions and loads of the suite, and our own answers about them.
#include <fmt/format.h>

#include "experiments/method/run.h"
#include "experiments/suite/writer.h"
#include "tests/lab/flat.h"

namespace farcull {
namespace {

using Lists = std::vector<TrianglePair>;

Lists listed(const SuiteMesh& mesh) {
  Lists out;
  for (const SuiteMeshPair& pair : mesh.pairs) out.push_back(pair.pair);
  return out;
}

Lists pairs_by(Method method, Session& session, const Scene& scene) {
  RunOptions options;
  options.method = method;
  options.device = "native";
  options.verify = false;
  Lists out = run(scene, options, session).collisions.all();
  std::ranges::sort(out);
  return out;
}

Lists pairs_by(Collider& collider, const Scene& scene) {
  const Result result = collider.find(Flat(scene).input());
  Lists out;
  for (const auto* some : {&result.pairs, &result.neighbour_pairs}) {
    for (const Pair& pair : *some) out.push_back({pair.a, pair.b});
  }
  std::ranges::sort(out);
  return out;
}

/// The meshes of the families in the small suite, in the order of their numbers.
std::vector<SuiteMesh> meshes_of(const std::set<std::string>& families) {
  std::vector<SuiteMesh> out;
  for (const MeshFamily& family : mesh_families()) {
    if (!families.contains(family.name)) continue;
    for (std::size_t i = 0; i < family.small; ++i)
      out.push_back(make_mesh(fmt::format("{}-{}", family.name, i + 1), {}));
  }
  return out;
}

TEST(Loads, AreFoundWithAllTheContactsThatTheyPromise) {
  Session session("native", 1, {});
  std::size_t most = 0;
  for (const SuiteMesh& mesh : meshes_of({"bars", "hub"})) {
    EXPECT_EQ(static_cast<double>(mesh.pairs.size()), mesh.parameter) << mesh.name;
    for (const Method method : {Method::far, Method::boxes, Method::exact})
      EXPECT_EQ(pairs_by(method, session, mesh.scene), listed(mesh))
          << to_string(method) << ", " << mesh.name;
    most = std::max(most, mesh.pairs.size());
  }
  EXPECT_GT(most, 65535u);  // what 16 bits can count
}

std::vector<std::vector<SuiteMesh>> motions() {
  std::vector<std::vector<SuiteMesh>> out;
  for (const MeshFamily& family : mesh_families()) {
    if (family.motion) out.push_back(meshes_of({family.name}));
  }
  return out;
}

TEST(Motions, KeepTheirTrianglesAndChangeTheirContacts) {
  EXPECT_EQ(motions().size(), 4u);
  for (const std::vector<SuiteMesh>& frames : motions()) {
    ASSERT_EQ(frames.size(), 12u);
    int changes = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].scene.triangles, frames[0].scene.triangles) << frames[i].name;
      // The twin of the next test: who repeats the answer of the frame before is wrong here.
      changes += frames[i].pairs != frames[i - 1].pairs;
    }
    EXPECT_GE(changes, 4) << frames[0].family;
  }
}

TEST(Motions, AreAnsweredRightlyByWhatKeepsItsState) {  // forwards and backwards
  for (const std::vector<SuiteMesh>& frames : motions()) {
    Session session("native", 1, {});
    Collider collider({.threads = 1});
    std::vector<const SuiteMesh*> asked;
    for (const SuiteMesh& mesh : frames) asked.push_back(&mesh);
    for (const SuiteMesh& mesh : frames) asked.insert(asked.begin() + 12, &mesh);
    for (const SuiteMesh* mesh : asked) {
      EXPECT_EQ(pairs_by(collider, mesh->scene), listed(*mesh)) << mesh->name;
      for (const Method method : {Method::far, Method::boxes, Method::exact, Method::i_collide})
        EXPECT_EQ(pairs_by(method, session, mesh->scene), listed(*mesh))
            << to_string(method) << ", " << mesh->name;
    }
  }
}

}  // namespace
}  // namespace farcull
