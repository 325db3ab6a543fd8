// Makes the meshes of the test suite. docs/suite.md describes each family of meshes.
#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/generators/pair_generators.h"

namespace farcull {
namespace {

using Objects = std::vector<SuiteObject>;

std::uint32_t last(const SuiteObject& object) {
  return static_cast<std::uint32_t>(object.vertices.size() - 1);
}

void add_last(SuiteObject& object) { object.add(last(object) - 2, last(object) - 1, last(object)); }

/// Returns a sheet of `columns` by `rows` cells. Vertex (i, j) is at place(i, j).
template <class Place>
SuiteObject sheet(int columns, int rows, const Place& place) {
  Mesh mesh = shapes::surface(static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows),
                              false, [&](std::uint32_t i, std::uint32_t j) -> Vec3 {
                                return place(static_cast<int>(i), static_cast<int>(j));
                              });
  return {std::move(mesh.vertices), std::move(mesh.triangles)};
}

/// Returns the x coordinate of column i of a sheet folded in zigzag, in layers of `width` columns.
double folded(int i, int width) {
  const int layer = i / width;
  const int within = i % width;
  return layer % 2 == 0 ? within : width - within;
}

Objects cloth(RandomDraws& draws, double gap, int cells) {
  const int width = cells / 2;
  return {sheet(4 * width, cells, [&](int i, int j) {
    const double x = folded(i, width) + 0.2 * draws.between(-1, 1);
    const double y = j + 0.2 * draws.between(-1, 1);
    const double layer = i / width;
    return Vec3(x, y, gap * (layer + 0.55 * draws.between(-1, 1)));
  })};
}

Objects accordion(RandomDraws&, double layers, int width) {
  const int columns = static_cast<int>(layers) * width;
  return {sheet(columns, 2 * width,
                [&](int i, int j) { return Vec3(folded(i, width), j + i * 0x1p-10, 0); })};
}

/// Returns point i of the unit circle, by a rational parametrization of each quarter, not sines.
Vec3 on_circle(int i, int per_quarter) {
  const double t = static_cast<double>(i % per_quarter) / per_quarter;
  const double c = (1 - t * t) / (1 + t * t);
  const double s = 2 * t / (1 + t * t);
  const std::array<Vec3, 4> turned = {Vec3(c, s, 0), Vec3(-s, c, 0), Vec3(-c, -s, 0),
                                      Vec3(s, -c, 0)};
  return turned[i / per_quarter % 4];
}

Objects rope(RandomDraws& draws, double pitch, int per_quarter) {
  const int around = 12;
  const int turn = 4 * per_quarter;
  SuiteObject out = sheet(3 * turn, around, [&](int i, int j) {
    const Vec3 along = on_circle(i, per_quarter);
    const Vec3 across = on_circle(j % around, around / 4);
    const double radius = 4 + across.x() * (1 + 0x1p-10 * draws.between(-1, 1));
    return Vec3(along.x() * radius, along.y() * radius, across.y() + 2 * pitch * i / turn);
  });
  // Closes the tube: triangles use the first vertex of each ring instead of the last vertex.
  for (auto& triangle : out.triangles) {
    for (std::uint32_t& v : triangle) {
      if (v % (around + 1) == around) v -= around;
    }
  }
  return {std::move(out)};
}

Objects book(RandomDraws& draws, double pages, int directions) {
  SuiteObject out;
  out.vertices = {Vec3(0, 0, -1), Vec3(0, 0, 1)};
  for (int i = 0; i < static_cast<int>(pages); ++i) {
    const double x = draws.whole(-directions, directions);
    const double y = draws.whole(1, directions);
    const double length = draws.coarse(0.25, 1);
    const double z = draws.coarse(-1, 1);
    out.vertices.emplace_back(x * length, y * length, z);
    out.add(0, 1, last(out));
  }
  return {std::move(out)};
}

Objects degenerate(RandomDraws& draws, double one_in, int cells) {
  SuiteObject out = sheet(cells, cells, [&](int i, int j) {
    const double x = i + draws.coarse(-0.75, 0.75);
    const double y = j + draws.coarse(-0.75, 0.75);
    return Vec3(x, y, draws.coarse(-0.5, 0.5));
  });
  for (auto& [i, j, k] : out.triangles) {
    if (!draws.chance(static_cast<int>(one_in))) continue;
    const int way = draws.below(3);
    if (way < 2) k = i;
    if (way == 1) j = i;
    if (way == 2) {  // k is the middle of an edge, so the three corners are on a line
      const Vec3 middle = (out.vertices[i] + out.vertices[j]) / 2;
      out.vertices.push_back(middle);
      k = last(out);
    }
  }
  return {std::move(out)};
}

SuiteObject sphere(int level) {
  Mesh mesh = shapes::sphere(level);
  return {std::move(mesh.vertices), std::move(mesh.triangles)};
}

template <class Function>
void each_vertex(SuiteObject& object, const Function& function) {
  for (Vec3& p : object.vertices) p = function(p);
}

/// Returns a closed surface with bumps, and with noise of about a twentieth of an edge's length.
SuiteObject scan(RandomDraws& draws, int level) {
  SuiteObject out = sphere(level);
  std::array<Vec3, 8> bumps;
  for (Vec3& bump : bumps) bump = draws.point();
  const Frame turn = turned_frame(draws);
  const double noise = std::ldexp(0.05, -level);
  each_vertex(out, [&](const Vec3& p) {
    double radius = 1;
    for (const Vec3& bump : bumps) {
      const double along = bump.dot(p);
      radius += 0.1 * along * along * along;
    }
    return turn.at(radius * (1 + noise * draws.between(-1, 1)) * p);
  });
  return out;
}

/// Returns two scans. The leftmost vertex of the second scan is `depth` to the left of the
/// rightmost vertex of the first scan.
Objects scans(RandomDraws& draws, double depth, int level) {
  SuiteObject a = scan(draws, level);
  SuiteObject b = scan(draws, level);
  const auto by_x = [](const Vec3& p, const Vec3& q) { return p.x() < q.x(); };
  const Vec3 right = *std::max_element(a.vertices.begin(), a.vertices.end(), by_x);
  const Vec3 left = *std::min_element(b.vertices.begin(), b.vertices.end(), by_x);
  const Vec3 move = right - left - Vec3(depth, 0, 0);
  each_vertex(b, [&](const Vec3& p) { return Vec3(p + move); });
  return {std::move(a), std::move(b)};
}

Objects far_scans(RandomDraws& draws, double distance, int level) {
  Objects out = scans(draws, 0.25, level);
  const Vec3 to(1, draws.between(-1, 1), -0.75);
  for (SuiteObject& object : out)
    each_vertex(object, [&](const Vec3& p) { return Vec3(p + distance * to); });
  return out;
}

Objects scaled_scans(RandomDraws& draws, double scale, int level) {
  Objects out = scans(draws, 0.25, level);
  for (SuiteObject& object : out)
    each_vertex(object, [&](const Vec3& p) { return Vec3(p * scale); });
  return out;
}

/// Returns a box. Its top and its bottom are fans of long thin triangles from one corner to `steps`
/// points on each of the two opposite edges.
SuiteObject plate(const Vec3& lo, const Vec3& hi, int steps) {
  SuiteObject out;
  for (const double z : {lo.z(), hi.z()}) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.emplace_back(lo.x(), lo.y(), z);
    for (int i = 0; i <= steps; ++i)
      out.vertices.emplace_back(hi.x(), lo.y() + (hi.y() - lo.y()) * i / steps, z);
    for (int i = 1; i <= steps; ++i)
      out.vertices.emplace_back(hi.x() - (hi.x() - lo.x()) * i / steps, hi.y(), z);
    for (std::uint32_t i = 1; i <= 2 * static_cast<std::uint32_t>(steps); ++i)
      out.add(first, first + i, first + i + 1);
  }
  const auto n = static_cast<std::uint32_t>(steps);
  const std::uint32_t above = 2 * n + 2;
  const std::array<std::uint32_t, 5> corner = {0, 1, n + 1, 2 * n + 1, 0};
  for (int i = 0; i < 4; ++i) {
    out.add(corner[i], corner[i + 1], above + corner[i + 1]);
    out.add(corner[i], above + corner[i + 1], above + corner[i]);
  }
  return out;
}

/// The coordinates have few bits, so that touching faces lie exactly in one plane.
Objects plates(RandomDraws&, double slivers, int halvings) {
  const double width = std::ldexp(1, -halvings);
  const int steps = static_cast<int>(slivers * width);
  Objects out = {plate(Vec3(0, 0, 0), Vec3(1, 1, 0.125), steps),
                 plate(Vec3(0.25, 0.375, 0.125), Vec3(1.25, 1.375, 0.25), steps),
                 plate(Vec3(0.5, 0.5, -0.5), Vec3(0.625, 0.625, 0.75), 1)};
  for (SuiteObject& object : out)
    each_vertex(object, [&](const Vec3& p) { return Vec3(p.x(), p.y() * width, p.z()); });
  return out;
}

/// Makes three shells. The outermost shell is moved, and mostly crosses the middle shell.
Objects shells(RandomDraws& draws, double gap, int level) {
  Objects out;
  const Vec3 move = draws.point() * gap;
  for (int i = 0; i < 3; ++i) {
    out.push_back(sphere(level));
    const Vec3 by = i == 2 ? Vec3(move + Vec3(1.5 * gap, 0, 0)) : Vec3::Zero();
    each_vertex(out.back(), [&](const Vec3& p) { return Vec3(p * (1 + i * gap) + by); });
  }
  return out;
}

Objects copies(RandomDraws& draws, double units, int level) {
  SuiteObject a = scan(draws, level);
  SuiteObject b = a;
  std::reverse(b.triangles.begin(), b.triangles.end());
  each_vertex(b, [&](const Vec3& p) { return Vec3(p + Vec3(units * 0x1p-52, 0, 0)); });
  return {std::move(a), std::move(b)};
}

Objects ground(RandomDraws& draws, double ratio, int count) {
  SuiteObject large;
  large.vertices = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
  large.add(0, 1, 2);
  large.add(0, 2, 3);
  SuiteObject small;
  for (int i = 0; i < count; ++i) {
    Vec3 at = draws.point();
    at.z() = draws.chance(3) ? 1 / ratio : 0;
    for (int k = 0; k < 3; ++k) small.vertices.emplace_back(at + draws.point() / ratio);
    if (draws.chance(4)) small.vertices[last(small) - 2].z() = 0;
    add_last(small);
  }
  return {std::move(large), std::move(small)};
}

Objects sheets(RandomDraws& draws, double gap, int cells) {
  const auto above = [&](int i, int j) {
    const double height = draws.chance(20) ? gap * draws.whole(-1, 0) : gap;
    return Vec3(i + 0.25, j + 0.125, height);
  };
  return {sheet(cells, cells, [](int i, int j) { return Vec3(i, j, 0); }),
          sheet(cells, cells, above)};
}

/// Merges vertices that have the same position, and removes vertices that no triangle uses.
void join_vertices(SuiteObject& object) {
  std::map<std::array<double, 3>, std::uint32_t> first;
  std::vector<Vec3> kept;
  for (auto& triangle : object.triangles) {
    for (std::uint32_t& v : triangle) {
      const Vec3& p = object.vertices[v];
      const auto [at, is_new] = first.try_emplace({p.x(), p.y(), p.z()}, kept.size());
      if (is_new) kept.push_back(p);
      v = at->second;
    }
  }
  object.vertices = std::move(kept);
}

// The motions. All frames of a motion are made with the same random draws; only `now` and `frame`
// differ. Except in the family cogs, coordinates have few bits, so that contacts are exact, and no
// face is parallel to an axis.

SuiteObject box_object(const Vec3& lo, const Vec3& hi) {
  SuiteObject out;
  for (int i = 0; i < 8; ++i) {
    out.vertices.emplace_back((i & 1) != 0 ? hi.x() : lo.x(), (i & 2) != 0 ? hi.y() : lo.y(),
                              (i & 4) != 0 ? hi.z() : lo.z());
  }
  out.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return out;
}

Objects leaning(RandomDraws& draws, Objects objects) {
  const Frame frame = leaning_frame(draws);
  for (SuiteObject& object : objects)
    each_vertex(object, [&](const Vec3& p) { return frame.at(p); });
  return objects;
}

Objects tunnel(RandomDraws& draws, double now, int) {
  return leaning(draws, {box_object(Vec3(-0x1p-4, -4, -4), Vec3(0x1p-4, 4, 4)),
                         box_object(Vec3(now, -1, -1), Vec3(now + 0x1p-10, 1, 1))});
}

Objects stack(RandomDraws& draws, double now, int) {
  Objects out = {box_object(Vec3(-4, -4, -1), Vec3(4, 4, 0))};
  for (int i = 0; i < 6; ++i) {
    const double lift = i < 3 ? 0 : now;
    const Vec3 lo(draws.coarse(-0.25, 0.25), draws.coarse(-0.25, 0.25), i + lift);
    out.push_back(box_object(lo, lo + Vec3::Ones()));
  }
  return leaning(draws, std::move(out));
}

/// Makes a rod in a ring. If `now` is 7/8, the side of the rod touches an edge of the ring.
Objects thread(RandomDraws& draws, double now, int frame) {
  Mesh ring = shapes::surface(16, 4, true, [](std::uint32_t i, std::uint32_t j) -> Vec3 {
    const double radius = j == 0 || j == 3 ? 1 : 1.5;
    return radius * on_circle(static_cast<int>(i), 4) + Vec3(0, 0, j < 2 ? -0.25 : 0.25);
  });
  SuiteObject rod = sheet(24, 4, [&](int i, int j) {
    const Vec3 across = 0.125 * Vec3(j % 4 < 2 ? 1 : -1, j % 4 == 0 || j % 4 == 3 ? 1 : -1, 0);
    return Vec3(across + Vec3(now, 0, 0.5 * i - 14 + 1.5 * frame));
  });
  return leaning(draws, {{std::move(ring.vertices), std::move(ring.triangles)}, std::move(rod)});
}

Objects cogs(RandomDraws&, double now, int) {
  const Vec3 turn = on_circle(static_cast<int>(now), 32);
  SuiteObject cog;
  for (const double z : {-0.25, 0.25}) {
    cog.vertices.emplace_back(0.0, 0.0, z);
    for (int i = 0; i < 32; ++i) {
      const Vec3 p = on_circle(i, 8) * (i % 4 < 2 ? 1 : 0.75);
      cog.vertices.emplace_back(p.x() * turn.x() + p.y() * turn.y(),
                                p.y() * turn.x() - p.x() * turn.y(), z);
    }
  }
  for (std::uint32_t i = 0; i < 32; ++i) {
    const std::uint32_t a = 1 + i, b = 1 + (i + 1) % 32, above = 33;
    cog.add(0, b, a);
    cog.add(above, above + a, above + b);
    cog.add(a, b, above + b);
    cog.add(a, above + b, above + a);
  }
  SuiteObject other = cog;
  each_vertex(other, [](const Vec3& p) { return Vec3(2 - p.x(), p.y(), p.z()); });
  return {std::move(cog), std::move(other)};
}

Objects bars(RandomDraws&, double, int n) {
  Objects out(2);
  const double width = 0.25 / n;
  for (int i = 0; i < n; ++i) {
    const double at = (2.0 * i + 1) / n - 1;
    out[0].vertices.insert(out[0].vertices.end(),
                           {Vec3(-1, at - width, 0), Vec3(1, at, 0), Vec3(-1, at + width, 0)});
    out[1].vertices.insert(out[1].vertices.end(),
                           {Vec3(at, -1, -width), Vec3(at, 1, 0), Vec3(at, -1, width)});
    for (SuiteObject& object : out) add_last(object);
  }
  return out;
}

Objects hub(RandomDraws& draws, double, int n) {
  Objects out(2);
  out[0].vertices = {Vec3(-8, -8, 0), Vec3(8, -8, 0), Vec3(0, 8, 0)};
  out[0].add(0, 1, 2);
  for (int i = 0; i < n * n; ++i) {
    const Vec3 at(4.0 * (i % n) / n - 2, 4.0 * (i / n) / n - 6, -0.5 / n);
    for (int k = 0; k < 3; ++k)
      out[1].vertices.emplace_back(at + Vec3(k == 1, k == 2, k > 0 ? 1 : -draws.unit()) / n);
    add_last(out[1]);
  }
  return out;
}

MeshFamily motion(const char* name, decltype(MeshFamily::make) make,
                  const std::vector<double>& values) {
  MeshFamily out{.name = name, .make = make, .members = {}};
  for (const double value : values)
    out.members.push_back({value, static_cast<int>(out.members.size())});
  out.small = out.members.size();
  out.motion = true;
  return out;
}

/// Returns a row of the table of families. small: a small suite has the first member.
MeshFamily family(const char* name, decltype(MeshFamily::make) make, bool self, bool small,
                  std::vector<MeshFamily::Member> members) {
  return {name, self, make, std::move(members), small ? 1u : 0u};
}

constexpr bool kSelf = true, kSmall = true;

}  // namespace

const std::vector<MeshFamily>& mesh_families() {
  static const std::vector<MeshFamily> families = [] {
    std::vector<MeshFamily> out = {
        family("accordion", accordion, kSelf, kSmall, {{4, 4}, {16, 6}}),
        family("book", book, kSelf, !kSmall, {{40, 2}, {200, 3}}),
        family("cloth", cloth, kSelf, kSmall, {{1e-1, 12}, {1e-3, 48}, {1e-6, 48}, {1e-12, 32}}),
        family("copies", copies, !kSelf, kSmall, {{0, 2}, {1, 3}, {1024, 3}}),
        family("degenerate", degenerate, kSelf, kSmall, {{4, 20}, {2, 40}}),
        family("far-scans", far_scans, !kSelf, kSmall, {{1e6, 3}, {1e10, 4}, {1e14, 4}}),
        family("ground", ground, !kSelf, !kSmall, {{1e6, 1000}, {1e12, 1000}}),
        family("plates", plates, !kSelf, kSmall, {{64, 0}, {0x1p16, 10}, {0x1p36, 30}}),
        family("rope", rope, kSelf, kSmall, {{0.9375, 12}, {1 + 0x1p-10, 40}, {1.0625, 40}}),
        family("scaled-scans", scaled_scans, !kSelf, !kSmall, {{1e-100, 3}, {1e100, 3}}),
        family("scans", scans, !kSelf, kSmall, {{0.25, 3}, {0.25, 5}, {1e-3, 5}, {1e-9, 5}}),
        family("sheets", sheets, !kSelf, !kSmall, {{0x1p-20, 40}, {0x1p-50, 40}}),
        family("shells", shells, !kSelf, kSmall, {{0x1p-10, 3}, {0x1p-20, 4}, {0x1p-34, 4}}),
        motion("cogs", cogs, {0, 1, 2, 3, 4, 5, 8, 12, 15, 16, 17, 20}),
        motion("stack", stack, {0, 0, 0x1p-40, 0, 0, -0x1p-40, 0, 0x1p-10, 0, 0, 0, 0}),
        motion("thread", thread,
               {0, 0.875, 0, 0.875, 0.5, 0.875 + 0x1p-30, 0, -0.875, 0, 0.875, 0.875, 0}),
        motion("tunnel", tunnel,
               {-2, -1.5, -1, -0.5, -0x1p-4 - 0x1p-10, -0x1p-4 - 0x1p-10 + 0x1p-30, 0,
                0x1p-4 - 0x1p-10, 0x1p-4, 0.5, 1, 2}),
        family("bars", bars, !kSelf, kSmall, {{66049, 257}, {1048576, 1024}}),
        family("hub", hub, !kSelf, kSmall, {{4900, 70}, {70225, 265}}),
    };
    std::sort(out.begin(), out.end(),
              [](const MeshFamily& x, const MeshFamily& y) { return x.name < y.name; });
    return out;
  }();
  return families;
}

std::vector<SuiteObject> make_suite_mesh(const MeshFamily& family, std::uint64_t seed,
                                         std::size_t index) {
  RandomDraws draws(seed_of_item(seed, "mesh " + family.name, family.motion ? 0 : index));
  const MeshFamily::Member& member = family.members.at(index);
  std::vector<SuiteObject> out = family.make(draws, member.parameter, member.detail);
  if (family.self) {
    for (SuiteObject& object : out) join_vertices(object);
  }
  return out;
}

}  // namespace farcull
