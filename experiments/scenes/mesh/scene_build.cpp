// Places meshes and appends them to a scene, whole or in parts.
#include "experiments/scenes/mesh/scene_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr std::uint64_t kMaxCount = std::numeric_limits<std::uint32_t>::max();

// Rodrigues' formula. The diagonal is written k^2 + c (1 - k^2) by its other two squares, so that a
// rotation about a coordinate axis has exactly c, s, 0 and 1 in its matrix.
std::array<Vec3, 3> rotation_rows(const Placement::Rotation& rotation) {
  Vec3 k = rotation.axis /
           rotation.axis.cwiseAbs().maxCoeff();  // so that squares neither overflow nor vanish
  k /= std::sqrt(k.x() * k.x() + k.y() * k.y() + k.z() * k.z());
  const double c = std::cos(rotation.angle);
  const double s = std::sin(rotation.angle);
  const double xx = k.x() * k.x();
  const double yy = k.y() * k.y();
  const double zz = k.z() * k.z();
  const double xy = k.x() * k.y() * (1 - c);
  const double xz = k.x() * k.z() * (1 - c);
  const double yz = k.y() * k.z() * (1 - c);
  return {Vec3(xx + c * (yy + zz), xy - k.z() * s, xz + k.y() * s),
          Vec3(xy + k.z() * s, yy + c * (xx + zz), yz - k.x() * s),
          Vec3(xz - k.y() * s, yz + k.x() * s, zz + c * (xx + yy))};
}

// The part of each triangle that is connected through shared vertices, numbered by first triangle;
// and how many.
std::uint32_t connected_parts(const Mesh& mesh, std::vector<std::uint32_t>& part) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&parent](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root(a)] = root(b);
    parent[root(b)] = root(c);
  }
  constexpr std::uint32_t kNew = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNew);
  std::uint32_t parts = 0;
  part.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    std::uint32_t& n = number[root(triangle[0])];
    if (n == kNew) n = parts++;
    part.push_back(n);
  }
  return parts;
}

}  // namespace

std::vector<Vec3> place(std::vector<Vec3> points, const Placement& placement) {
  if (placement.scale) {
    for (Vec3& p : points) p = p.cwiseProduct(*placement.scale);
  }
  if (placement.rotate && placement.rotate->angle != 0) {
    const std::array<Vec3, 3> rows = rotation_rows(*placement.rotate);
    for (Vec3& p : points) {
      Vec3 turned;
      for (int i = 0; i < 3; ++i) {
        const Vec3& row = rows[static_cast<std::size_t>(i)];
        turned[i] = row.x() * p.x() + row.y() * p.y() + row.z() * p.z();
      }
      p = turned;
    }
  }
  if (placement.translate) {
    for (int i = 0; i < 3; ++i) {
      const double step = (*placement.translate)[i];
      if (step == 0) continue;  // -0.0 + 0.0 would lose its sign
      for (Vec3& p : points) p[i] += step;
    }
  }
  return points;
}

SceneBuilder::SceneBuilder(std::string scene_name, std::string where) : where_(std::move(where)) {
  scene_.name = std::move(scene_name);
}

std::string SceneBuilder::free_name(const std::string& name) {
  std::string candidate = name;
  int& suffix = names_.try_emplace(name, 0).first->second;
  if (suffix == 0) {
    suffix = 1;
    return candidate;
  }
  do {
    candidate = fmt::format("{}#{}", name, ++suffix);
  } while (names_.contains(candidate));
  names_.emplace(candidate, 1);
  return candidate;
}

void SceneBuilder::add(const Mesh& mesh, const std::string& name, Split split,
                       const Placement& placement, bool self) {
  if (mesh.triangles.size() > kMaxCount - scene_.triangles.size() ||
      mesh.vertices.size() > kMaxCount - scene_.vertices.size()) {
    throw Error(where_,
                fmt::format("with {} the scene has more than 4294967295 triangles or vertices",
                            quote_token(name)),
                "give fewer or smaller objects");
  }
  const std::vector<Vec3> placed = place(mesh.vertices, placement);
  if (!std::all_of(placed.begin(), placed.end(), [](const Vec3& p) { return p.allFinite(); })) {
    throw Error(where_, fmt::format("{} is moved beyond what a double can hold", quote_token(name)),
                "use smaller scales and translations");
  }
  const auto first_vertex = static_cast<std::uint32_t>(scene_.vertices.size());
  scene_.vertices.insert(scene_.vertices.end(), placed.begin(), placed.end());

  std::vector<std::uint32_t> part;
  std::uint32_t parts = 1;
  if (split == Split::kGroups) {
    part = mesh.group;
    parts = static_cast<std::uint32_t>(mesh.group_names.size());
  } else if (split == Split::kComponents) {
    parts = connected_parts(mesh, part);
  } else {
    part.assign(mesh.triangles.size(), 0);
  }

  // Counting sort of the triangles by part, which keeps their order within each.
  std::vector<std::uint32_t> size(parts, 0);
  for (const std::uint32_t p : part) ++size[p];
  const auto used = std::count_if(size.begin(), size.end(), [](std::uint32_t n) { return n > 0; });
  std::vector<std::uint32_t> next(parts), object_of_part(parts);
  auto start = static_cast<std::uint32_t>(scene_.triangles.size());
  for (std::uint32_t p = 0; p < parts; ++p) {
    next[p] = start;
    if (size[p] > 0) {
      std::string label = clean_name(name);
      if (used > 1)
        label += split == Split::kGroups ? "/" + mesh.group_names[p] : fmt::format("/{}", p + 1);
      object_of_part[p] = static_cast<std::uint32_t>(scene_.objects.size());
      scene_.objects.push_back({free_name(label), start, size[p], self});
    }
    start += size[p];
  }
  scene_.triangles.resize(start);
  scene_.source_face.resize(start);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const std::uint32_t to = next[part[t]]++;
    if (std::ranges::binary_search(mesh.folded, mesh.source_face[t]))
      scene_.folded.push_back({object_of_part[part[t]], mesh.source_face[t]});
    scene_.triangles[to] = {first_vertex + a, first_vertex + b, first_vertex + c};
    scene_.source_face[to] = mesh.source_face[t];
  }
  std::ranges::sort(scene_.folded);
  scene_.folded.erase(std::unique(scene_.folded.begin(), scene_.folded.end()), scene_.folded.end());
}

Scene SceneBuilder::take_part() {
  validate(scene_, where_);
  Scene next;
  next.name = scene_.name;
  return std::exchange(scene_, std::move(next));
}

void PartMaker::add(std::array<std::uint32_t, 3> corners) {
  for (std::uint32_t& corner : corners) {
    std::uint32_t& number = number_[corner];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(used_.size());
      used_.push_back(corner);
      part_.vertices.push_back(vertices_[corner]);
    }
    corner = number;
  }
  part_.triangles.push_back(corners);
}

MeshPart PartMaker::take() {
  for (const std::uint32_t vertex : used_) number_[vertex] = kNone;
  used_.clear();
  return std::exchange(part_, {});
}

void append_object(const std::string& name, std::span<const Vec3> vertices,
                   std::span<const std::array<std::uint32_t, 3>> triangles,
                   std::span<const std::uint32_t> source_face, Scene& scene) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.objects.push_back({name, static_cast<std::uint32_t>(scene.triangles.size()),
                           static_cast<std::uint32_t>(triangles.size())});
  scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
  for (const auto& [a, b, c] : triangles)
    scene.triangles.push_back({first + a, first + b, first + c});
  scene.source_face.insert(scene.source_face.end(), source_face.begin(), source_face.end());
}

namespace {

// The box of a scene or a mesh.
template <class Triangles>
Box box_around(const Triangles& of) {
  Box box = Box::empty();
  for (const auto& triangle : of.triangles) {
    for (const std::uint32_t v : triangle) box.add(of.vertices[v]);
  }
  return box;
}

}  // namespace

Box bounds(const Scene& scene) { return box_around(scene); }

Box bounds(const Mesh& mesh) { return box_around(mesh); }

Vec3 centre(const Box& box) { return box.lo + (box.hi - box.lo) / 2; }

double diagonal(const Box& box) {
  const Vec3 d = box.hi - box.lo;
  return std::sqrt(d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
}

}  // namespace farcull
