// The dragon of the papers, its triangles divided: a bunny falls through it (FAR: Govindaraju, Lin
// and Manocha, VRST 2004), or it breaks into pieces (CULLIDE: Govindaraju, Redon, Lin and Manocha,
// Graphics Hardware 2003).
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "experiments/scenes/builtin/generators.h"
#include "experiments/scenes/builtin/packaged.h"
#include "experiments/scenes/mesh/refine.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {
namespace {

constexpr std::uint64_t kPackagedDragon = 19'994;  // triangles
constexpr std::uint32_t kPieces = 200;
constexpr double kFirstBreak = 0.05, kLastBreak = 0.8;  // times

// A part of the dragon with vertices of its own.
struct Piece {
  std::vector<Vec3> vertices;                           // where they are in the dragon
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
  std::vector<std::uint32_t> source_face;
  Vec3 middle;      // of its box
  double late = 0;  // when it comes off
  Vec3 way;         // of its flight, per unit of time
  Vec3 axis;        // it turns about
  double turn = 0;  // radians per unit of time
};

struct Breaking {
  std::string name;
  Mesh dragon;
  std::vector<std::uint32_t> piece_of;  // per triangle
  std::vector<Piece> pieces;            // in the order in which they come off; the last one stays
  double height = 0;                    // of the dragon
};

// The triangles that `takes`, with vertices of their own in order of first mention.
template <class Takes>
Piece part_of(const Mesh& mesh, const Takes& takes) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNone);
  Piece part;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!takes(t)) continue;
    std::array<std::uint32_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& n = number[mesh.triangles[t][k]];
      if (n == kNone) {
        n = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[mesh.triangles[t][k]]);
      }
      corners[k] = n;
    }
    part.triangles.push_back(corners);
    part.source_face.push_back(mesh.source_face[t]);
  }
  return part;
}

// Triangles belong to the nearest of some of their centres, drawn; pieces come off in the order of
// their distance from where the dragon is hit, its highest point.
std::shared_ptr<const Breaking> broken_up(Mesh dragon, std::uint64_t seed) {
  shapes::Random random(seed);
  auto out = std::make_shared<Breaking>();
  out->name = "breaking-dragon";
  out->dragon = std::move(dragon);
  const Mesh& mesh = out->dragon;
  const Box box = bounds(mesh);
  out->height = box.hi.y() - box.lo.y();
  const Vec3 hit = *std::max_element(mesh.vertices.begin(), mesh.vertices.end(),
                                     [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  const auto centre_of = [&](std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return Vec3((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  };
  std::vector<Vec3> seeds;
  while (seeds.size() < kPieces) {
    const Vec3 p = centre_of(random.below(static_cast<std::uint32_t>(mesh.triangles.size())));
    if (std::find(seeds.begin(), seeds.end(), p) == seeds.end()) seeds.push_back(p);
  }
  std::stable_sort(seeds.begin(), seeds.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - hit).squaredNorm() < (b - hit).squaredNorm();
  });
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 p = centre_of(t);
    std::uint32_t best = 0;
    for (std::uint32_t s = 1; s < kPieces; ++s) {
      if ((p - seeds[s]).squaredNorm() < (p - seeds[best]).squaredNorm()) best = s;
    }
    out->piece_of.push_back(best);
  }
  for (std::uint32_t s = 0; s < kPieces; ++s) {
    Piece piece = part_of(mesh, [&](std::uint32_t t) { return out->piece_of[t] == s; });
    Box around = Box::empty();
    for (const Vec3& p : piece.vertices) around.add(p);
    piece.middle = centre(around);
    piece.late = kFirstBreak + (kLastBreak - kFirstBreak) * s / (kPieces - 1);
    const Vec3 outward = piece.middle - centre(box) + 0.05 * out->height * random.direction();
    piece.way = 2 * outward + Vec3(0, 0.3 * out->height, 0);
    piece.axis = random.direction();
    piece.turn = random.between(-6, 6);
    out->pieces.push_back(std::move(piece));
  }
  return out;
}

void append(const Piece& part, const std::string& name, Scene& scene) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.objects.push_back({name, static_cast<std::uint32_t>(scene.triangles.size()),
                           static_cast<std::uint32_t>(part.triangles.size())});
  scene.vertices.insert(scene.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.triangles)
    scene.triangles.push_back({first + a, first + b, first + c});
  scene.source_face.insert(scene.source_face.end(), part.source_face.begin(),
                           part.source_face.end());
}

// The topology when the first `off` pieces have come off: what is left, then these.
void set_topology(const Breaking& dragon, std::size_t off, Scene& scene) {
  scene.vertices.clear();
  scene.triangles.clear();
  scene.source_face.clear();
  scene.objects.clear();
  append(part_of(dragon.dragon, [&](std::uint32_t t) { return dragon.piece_of[t] >= off; }),
         "dragon", scene);
  for (std::size_t s = 0; s < off; ++s)
    append(dragon.pieces[s], "piece" + std::to_string(s), scene);
}

void break_at(const Breaking& dragon, double time, Scene& scene) {
  std::size_t off = 0;  // the last piece stays
  while (off + 1 < kPieces && dragon.pieces[off].late <= time) ++off;
  // The number of objects determines the topology.
  if (scene.objects.size() != off + 1) set_topology(dragon, off, scene);
  std::size_t v = scene.vertices.size();
  for (std::size_t s = 0; s < off; ++s) v -= dragon.pieces[s].vertices.size();
  for (std::size_t s = 0; s < off; ++s) {
    const Piece& piece = dragon.pieces[s];
    const double since = time - piece.late;
    const Eigen::Matrix3d turned =
        Eigen::AngleAxisd(piece.turn * since, piece.axis).toRotationMatrix();
    const Vec3 fall(0, -1.5 * dragon.height * since * since, 0);
    const Vec3 to = piece.middle + since * piece.way + fall;
    for (const Vec3& p : piece.vertices) scene.vertices[v++] = turned * (p - piece.middle) + to;
  }
}

// size: triangles of the dragon.
BuiltScene make_bunny_dragon(const SceneParameters& parameters) {
  const Mesh dragon = refined(packaged(kDragon), parameters.size);
  const Mesh bunny = packaged(kBunny);
  const Box place = bounds(dragon);
  const double scale = 0.5 * diagonal(place) / diagonal(bounds(bunny));
  BuiltScene built{
      two_objects("bunny-dragon", "dragon", dragon, "bunny", bunny,
                  {.scale = Vec3(Vec3::Constant(scale)), .rotate = {}, .translate = {}}),
      {}};
  const std::size_t first = dragon.vertices.size();
  const std::vector<Vec3> rest(built.scene.vertices.begin() + static_cast<std::ptrdiff_t>(first),
                               built.scene.vertices.end());
  const Box small = bounds(bunny);
  const double way =
      place.hi.y() - place.lo.y() + scale * (small.hi.y() - small.lo.y());  // down, all in all
  built.motion = [rest, first, way, from = Vec3(scale * centre(small)), to = centre(place)](
                     const Instant& now, Scene& out, FrameNotes&) {
    const Eigen::Matrix3d turned =
        Eigen::AngleAxisd(0.5 + 2 * now.time, Vec3(1, 3, 2).normalized()).toRotationMatrix();
    const Vec3 at = to + Vec3(0, (0.5 - now.time) * way, 0);
    for (std::size_t v = 0; v < rest.size(); ++v)
      out.vertices[first + v] = turned * (rest[v] - from) + at;
  };
  return halfway(std::move(built));
}

BuiltScene make_breaking_dragon(const SceneParameters& parameters, std::uint64_t seed) {
  const std::shared_ptr<const Breaking> dragon =
      broken_up(refined(packaged(kDragon), parameters.size), seed);
  BuiltScene built;
  built.scene.name = dragon->name;
  built.motion = [dragon](const Instant& now, Scene& out, FrameNotes&) {
    break_at(*dragon, now.time, out);
  };
  return halfway(std::move(built));
}

}  // namespace

std::vector<BuiltinScene> dragon_scenes() {
  return {
      taking({.name = "bunny-dragon",
              .description = "bunny and dragon, its triangles divided (CULLIDE, FAR)",
              .objects = 2,
              .triangles = 325'408,
              .needs_meshes = true,
              .size = SceneSize{"triangles of the dragon", kPackagedDragon, 100'000'000, 250'000},
              .motion = "the bunny falls through the dragon"},
             make_bunny_dragon),
      drawn({.name = "breaking-dragon",
             .description = "a dragon that breaks into 200 pieces (CULLIDE)",
             .objects = 121,
             .triangles = 250'000,
             .needs_meshes = true,
             .size = SceneSize{"triangles", kPackagedDragon, 100'000'000, 250'000},
             .motion = "pieces come off, become objects, fly apart, turn and fall",
             .topology_changes = true},
            13, make_breaking_dragon),
  };
}

}  // namespace farcull
