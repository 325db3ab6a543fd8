// Collects the faces of a mesh.
#include "experiments/scenes/mesh/builder.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "core/base/error.h"
#include "experiments/scenes/mesh/polygon.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr std::uint64_t kMaxCount = std::numeric_limits<std::uint32_t>::max();
constexpr const char* kCorrectIndex = "correct the index, or see whether the file is damaged";

}  // namespace

MeshBuilder::MeshBuilder(std::string name) : name_(std::move(name)) {}

void MeshBuilder::add_vertex(const Vec3& p, long line) {
  if (mesh_.vertices.size() == kMaxCount) {
    throw Error(name_, "more than 4294967295 vertices", "split the mesh", line);
  }
  mesh_.vertices.push_back(p);
}

void MeshBuilder::set_group(std::string_view group_name) {
  const std::string group = group_name.empty() ? "default" : clean_name(group_name);
  const auto [entry, is_new] =
      groups_.try_emplace(group, static_cast<std::uint32_t>(groups_.size()));
  if (is_new) mesh_.group_names.push_back(group);
  group_ = entry->second;
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners, long line) {
  if (corners.size() < 3) {
    throw Error(name_, fmt::format("face {} is a polygon with {} vertices", faces_, corners.size()),
                "give it 3 or more, or delete it", line);
  }
  std::vector<Vec3> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    if (corner >= mesh_.vertices.size()) {
      throw Error(name_,
                  fmt::format("face {} names vertex {} (counted from 0) of {}", faces_, corner,
                              mesh_.vertices.size()),
                  kCorrectIndex, line);
    }
    points.push_back(mesh_.vertices[corner]);
  }
  if (corners.size() - 2 > kMaxCount - mesh_.triangles.size()) {
    throw Error(name_, "more than 4294967295 triangles", "split the mesh", line);
  }
  if (mesh_.group_names.empty()) set_group("");

  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(corners.size() - 2);
  const Triangulation made = triangulate(points, triangles);
  if (made == Triangulation::folded) mesh_.folded.push_back(faces_);
  if (made == Triangulation::too_large) {
    throw Error(name_,
                fmt::format("face {} is a polygon with {} vertices that is not convex, too large "
                            "to triangulate here",
                            faces_, corners.size()),
                "triangulate the mesh where it was made", line);
  }
  for (const auto& [a, b, c] : triangles) {
    mesh_.triangles.push_back({corners[a], corners[b], corners[c]});
    mesh_.source_face.push_back(faces_);
    mesh_.group.push_back(group_);
  }
  ++faces_;
}

Mesh MeshBuilder::finish() {
  if (mesh_.triangles.empty()) {
    throw Error(name_, "the mesh has no triangles", "give a mesh with at least one face");
  }
  return std::move(mesh_);
}

}  // namespace farcull
