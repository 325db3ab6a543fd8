// Places meshes, appends them to a scene as one object or several, and makes shapes by formula.
#include "experiments/scenes/mesh/scene_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr std::uint64_t kMaxCount = std::numeric_limits<std::uint32_t>::max();

// Returns the rows of the rotation matrix of a quaternion, or of an axis k and an angle by
// Rodrigues' formula. Computes 1 - k_i^2, for each i, as the sum of the other two squares. So for
// a coordinate axis the matrix has exactly the entries 0, 1, cosine and +-sine. The quaternion or
// axis is first divided by its largest component, to avoid overflow and underflow.
std::array<Vec3, 3> rotation_rows(const Placement::Rotation& rotation) {
  if (rotation.quaternion) {
    auto [x, y, z, w] = *rotation.quaternion;
    const double most = std::max({std::abs(x), std::abs(y), std::abs(z), std::abs(w)});
    for (double* const c : {&x, &y, &z, &w}) *c /= most;
    const double s = 2 / (x * x + y * y + z * z + w * w);
    return {Vec3(1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
            Vec3(s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)),
            Vec3(s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y))};
  }
  Vec3 k = rotation.axis / rotation.axis.cwiseAbs().maxCoeff();
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

void transform(const std::array<Vec3, 3>& rows, std::vector<Vec3>& points) {
  for (Vec3& p : points) {
    Vec3 turned;
    for (int i = 0; i < 3; ++i) {
      const Vec3& row = rows[static_cast<std::size_t>(i)];
      turned[i] = row.x() * p.x() + row.y() * p.y() + row.z() * p.z();
    }
    p = turned;
  }
}

// Finds the parts of a mesh that are connected through shared vertices, and numbers these parts in
// the order of their first triangles. `part` receives the number of the part of each triangle.
// Returns how many parts there are.
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

bool turns(const Placement::Rotation& rotation) {
  if (!rotation.quaternion) return rotation.angle != 0;
  const auto& [x, y, z, w] = *rotation.quaternion;
  return x != 0 || y != 0 || z != 0;
}

struct Edge {
  double squared = 0;  // square of the length
  std::uint32_t a = 0, b = 0;

  // True if refined() divides this edge later than the other edge.
  bool operator<(const Edge& other) const {
    if (squared != other.squared) return squared < other.squared;
    return a != other.a ? a > other.a : b > other.b;
  }
  std::uint64_t key() const { return std::uint64_t{a} << 32 | b; }
};

Edge edge_between(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  return {(mesh.vertices[a] - mesh.vertices[b]).squaredNorm(), std::min(a, b), std::max(a, b)};
}

}  // namespace

std::vector<Vec3> place(std::vector<Vec3> points, const Placement& placement) {
  if (placement.matrix) {
    Placement translated;
    std::array<Vec3, 3> rows;
    Vec3 by;
    for (int i = 0; i < 3; ++i) {
      const std::array<double, 4>& row = (*placement.matrix)[static_cast<std::size_t>(i)];
      rows[static_cast<std::size_t>(i)] = Vec3(row[0], row[1], row[2]);
      by[i] = row[3];
    }
    if (rows != std::array<Vec3, 3>{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()})
      transform(rows, points);
    translated.translate = by;
    return place(std::move(points), translated);
  }
  if (placement.scale) {
    for (Vec3& p : points) p = p.cwiseProduct(*placement.scale);
  }
  if (placement.rotate && turns(*placement.rotate))
    transform(rotation_rows(*placement.rotate), points);
  if (placement.translate) {
    for (int i = 0; i < 3; ++i) {
      const double step = (*placement.translate)[i];
      if (step == 0) continue;  // adding 0.0 would change -0.0
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

  // Sorts the triangles by part, with a stable counting sort.
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

Vec3 centre(const Box& box) { return box.lo + (box.hi - box.lo) / 2; }

double diagonal(const Box& box) {
  const Vec3 d = box.hi - box.lo;
  return std::sqrt(d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
}

namespace shapes {

Mesh finished(std::vector<Vec3> vertices, std::vector<std::array<std::uint32_t, 3>> triangles) {
  Mesh mesh;
  mesh.vertices = std::move(vertices);
  mesh.triangles = std::move(triangles);
  mesh.source_face.resize(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.source_face.size(); ++t) mesh.source_face[t] = t;
  mesh.group.assign(mesh.triangles.size(), 0);
  mesh.group_names = {"default"};
  return mesh;
}

Mesh soup(const std::vector<Corners>& list) {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const Corners& corners : list) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), corners.begin(), corners.end());
    triangles.push_back({first, first + 1, first + 2});
  }
  return finished(std::move(vertices), std::move(triangles));
}

Mesh sphere(int level) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> vertices = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::array<std::uint32_t, 3>> triangles = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  const auto normalize = [](Vec3& p) {
    p /= std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
  };
  for (Vec3& p : vertices) normalize(p);
  for (int step = 0; step < level; ++step) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(vertices.size()));
      if (is_new) {
        Vec3 p = vertices[a] + vertices[b];
        normalize(p);
        vertices.push_back(p);
      }
      return entry->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return finished(std::move(vertices), std::move(triangles));
}

Mesh torus(double ring, double tube, std::uint32_t around, std::uint32_t across) {
  return surface(around, across, true, [&](std::uint32_t i, std::uint32_t j) {
    const double u = kTurn * i / around;
    const double v = kTurn * j / across;
    const double r = ring + tube * std::cos(v);
    return Vec3(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
  });
}

Mesh blob(int level, Random& random) {
  Mesh mesh = sphere(level);
  const std::array<Vec3, 4> poles = {random.direction(), random.direction(), random.direction(),
                                     random.direction()};
  for (Vec3& p : mesh.vertices) {
    double radius = 1;
    for (const Vec3& pole : poles) {
      const double h = pole.dot(p);
      radius += 0.15 * h * h * h;
    }
    p *= radius;
  }
  return mesh;
}

Corners shifted(Corners corners, const Vec3& by) {
  for (Vec3& p : corners) p += by;
  return corners;
}

Vec3 inner_point(const Corners& corners, Random& random) {
  const double a = random.between(0.2, 0.4);
  const double b = random.between(0.2, 0.4);
  return a * corners[0] + b * corners[1] + (1 - a - b) * corners[2];
}

Mesh grid(std::uint32_t cells) {
  return surface(cells, cells, false,
                 [&](double i, double j) { return Vec3(i / cells, j / cells, 0); });
}

std::array<Vec3, 4> square(const Vec3& centre, double side) {
  const double h = side / 2;
  return {Vec3(centre + Vec3(-h, -h, 0)), Vec3(centre + Vec3(h, -h, 0)),
          Vec3(centre + Vec3(h, h, 0)), Vec3(centre + Vec3(-h, h, 0))};
}

Vec3 across(const Vec3& along, double length, Random& random) {
  Vec3 out = along.cross(random.direction());
  while (out.norm() < 0.1) out = along.cross(random.direction());
  return out * (length / out.norm());
}

}  // namespace shapes

Mesh refined(Mesh mesh, std::uint64_t wanted) {
  assert(!mesh.triangles.empty());
  if (mesh.triangles.size() >= wanted) return mesh;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> around;  // triangles at each edge
  std::vector<Edge> first;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (a == b || b == c || c == a) continue;
    for (const Edge& edge :
         {edge_between(mesh, a, b), edge_between(mesh, b, c), edge_between(mesh, c, a)}) {
      std::vector<std::uint32_t>& of = around[edge.key()];
      if (of.empty()) first.push_back(edge);
      of.push_back(t);
    }
  }
  std::priority_queue<Edge> longest(std::less<Edge>(), std::move(first));
  const auto replace = [&](const Edge& edge, std::uint32_t before, std::uint32_t now) {
    std::vector<std::uint32_t>& of = around[edge.key()];
    std::replace(of.begin(), of.end(), before, now);
  };
  while (mesh.triangles.size() < wanted && !longest.empty()) {
    const Edge edge = longest.top();
    longest.pop();
    if (edge.squared == 0) break;  // all remaining edges have length 0
    const auto found = around.find(edge.key());
    const std::vector<std::uint32_t> of = std::move(found->second);
    around.erase(found);
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 p = mesh.vertices[edge.a] + (mesh.vertices[edge.b] - mesh.vertices[edge.a]) / 2;
    mesh.vertices.push_back(p);
    const auto add = [&](std::uint32_t u, std::uint32_t v, std::uint32_t t) {
      const Edge added = edge_between(mesh, u, v);
      std::vector<std::uint32_t>& triangles = around[added.key()];
      if (triangles.empty()) longest.push(added);
      triangles.push_back(t);
    };
    for (const std::uint32_t t : of) {
      // Orders the corners as a, b, c, so that a and b are the ends of the edge. Replaces the
      // triangle by (a, m, c) and (m, b, c), where m is the edge's midpoint.
      std::array<std::uint32_t, 3> c = mesh.triangles[t];
      const auto on_edge = [&](std::uint32_t v) { return v == edge.a || v == edge.b; };
      while (!on_edge(c[0]) || !on_edge(c[1])) std::rotate(c.begin(), c.begin() + 1, c.end());
      const auto other = static_cast<std::uint32_t>(mesh.triangles.size());
      mesh.triangles[t] = {c[0], middle, c[2]};
      mesh.triangles.push_back({middle, c[1], c[2]});
      mesh.source_face.push_back(mesh.source_face[t]);
      mesh.group.push_back(mesh.group[t]);
      replace(edge_between(mesh, c[1], c[2]), t, other);
      add(c[0], middle, t);
      add(middle, c[1], other);
      add(middle, c[2], t);
      around[edge_between(mesh, middle, c[2]).key()].push_back(other);
    }
  }
  return mesh;
}

}  // namespace farcull
