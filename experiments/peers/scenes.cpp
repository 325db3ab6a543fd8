// Makes scenes of questions, and answers of pairs.
#include "experiments/peers/scenes.h"

namespace farcull {
namespace {

void add(Scene& scene, const ContestMesh& mesh, bool self) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.objects.push_back({.name = std::to_string(scene.objects.size()),
                           .first_triangle = static_cast<std::uint32_t>(scene.triangles.size()),
                           .triangle_count = static_cast<std::uint32_t>(mesh.triangles.size()),
                           .self = self});
  for (const auto& [x, y, z] : mesh.vertices) scene.vertices.emplace_back(x, y, z);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    scene.triangles.push_back({first + a, first + b, first + c});
    scene.source_face.push_back(t);
  }
}

}  // namespace

Scene scene_of(const ContestPair& pair) {
  Scene out;
  out.name = "pair";
  const auto& [a, b] = pair.triangles;
  if (pair.shared.empty()) {
    for (const ContestTriangle& t : pair.triangles)
      add(out, {.vertices = {t.begin(), t.end()}, .triangles = {{0, 1, 2}}}, false);
    return out;
  }
  ContestMesh mesh{.vertices = {a.begin(), a.end()}, .triangles = {{0, 1, 2}, {3, 4, 5}}};
  mesh.vertices.insert(mesh.vertices.end(), b.begin(), b.end());
  for (const auto& [first, second] : pair.shared)
    mesh.triangles[1][second] = static_cast<std::uint32_t>(first);
  add(out, mesh, true);
  return out;
}

Scene scene_of(const ContestScene& scene) {
  Scene out;
  out.name = "scene";
  for (const ContestMesh& mesh : scene.objects) add(out, mesh, scene.self);
  return out;
}

std::vector<ContestFound> found_in(const Scene& scene, const std::vector<TrianglePair>& pairs) {
  const std::vector<std::uint32_t> owner = owners(scene);
  const auto within = [&](std::uint32_t t) { return t - scene.objects[owner[t]].first_triangle; };
  std::vector<ContestFound> out;
  for (const auto& [a, b] : pairs) out.push_back({owner[a], within(a), owner[b], within(b)});
  return out;
}

}  // namespace farcull
