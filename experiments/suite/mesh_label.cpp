// The colliding pairs of a mesh, found by the method `exact` and proved by the certificate checker.
#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "experiments/suite/label.h"
#include "verify/certificate/certificate.h"
#include "verify/exact.h"

namespace farcull {
namespace {

/// Throws Error where two vertices that triangles of the object use are at one position.
void require_distinct(const Scene& scene, const Object& object, const std::string& where) {
  std::vector<std::uint32_t> used;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const auto& corners = scene.triangles[object.first_triangle + t];
    used.insert(used.end(), corners.begin(), corners.end());
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto position = [&](std::uint32_t v) {
    const Vec3& p = scene.vertices[v];
    return std::array<double, 3>{p.x(), p.y(), p.z()};
  };
  std::sort(used.begin(), used.end(),
            [&](std::uint32_t v, std::uint32_t w) { return position(v) < position(w); });
  const auto same = std::adjacent_find(
      used.begin(), used.end(),
      [&](std::uint32_t v, std::uint32_t w) { return position(v) == position(w); });
  if (same == used.end()) return;
  const Vec3& p = scene.vertices[*same];
  throw Error(
      where,
      fmt::format("object {} has two vertices at ({}, {}, {})", object.name, p.x(), p.y(), p.z()),
      "join them, so that neighbours share an index wherever they share a position");
}

}  // namespace

std::vector<SuiteMeshPair> decide_mesh(const Scene& scene, const std::string& where) {
  for (const Object& object : scene.objects) {
    if (object.self) require_distinct(scene, object, where);
  }
  const ExactResult found = all_colliding_pairs(scene);
  std::vector<TrianglePair> all = found.pairs;
  all.insert(all.end(), found.neighbour_pairs.begin(), found.neighbour_pairs.end());
  std::sort(all.begin(), all.end());
  const CheckResult checked = check_certificate(certificate_of_list(scene, all), scene);
  if (checked.verdict != Verdict::proved || checked.meeting != all) {
    throw Error(where,
                fmt::format("CGAL's predicates find {} colliding pairs, and the certificate "
                            "checker says: {} {}",
                            all.size(), to_string(checked.verdict), checked.reason),
                "one of the oracles is wrong; report the mesh");
  }
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<SuiteMeshPair> out;
  out.reserve(all.size());
  for (const TrianglePair& pair : all) {
    const bool one_object = owner[pair.a] == owner[pair.b];
    out.push_back({pair, one_object ? shared_vertices(scene, pair) : 0});
  }
  return out;
}

}  // namespace farcull
