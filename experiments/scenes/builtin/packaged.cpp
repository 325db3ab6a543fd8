// Scenes made of the meshes that experiments/meshes.sh unpacks. Two scenes are from papers and use
// a dragon with refined triangles. In one scene, a bunny falls through the dragon (FAR:
// Govindaraju, Lin and Manocha, VRST 2004). In the other scene, the dragon breaks into pieces
// (CULLIDE: Govindaraju, Redon, Lin and Manocha, Graphics Hardware 2003).
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

std::string mesh_folder() {
  const char* const folder = std::getenv("FARCULL_MESHES");
  return folder != nullptr && *folder != '\0' ? folder : FARCULL_MESH_DIR;
}

Mesh packaged(const char* file) {
  const std::string path = (std::filesystem::path(mesh_folder()) / file).string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw Error(
        path, "the packaged mesh is not there",
        "run bash experiments/meshes.sh, or set FARCULL_MESHES to the folder that holds it");
  }
  return load_mesh(path);
}

namespace {

constexpr const char* kArmadillo = "armadillo.off";
constexpr const char* kElephant = "refined_elephant.off";
constexpr const char* kMannequin = "mannequin-devil.off";

// Returns a placement for the second mesh. Its bounding box then has the same centre and the same
// diagonal length as the first mesh's box.
Placement onto(const Mesh& first, const Mesh& second) {
  const double scale = diagonal(bounds(first)) / diagonal(bounds(second));
  return {.scale = Vec3(Vec3::Constant(scale)),
          .rotate = {},
          .translate = Vec3(centre(bounds(first)) - scale * centre(bounds(second)))};
}

Scene make_two_bunnies() {
  const Mesh bunny = packaged(kBunny);
  const Box box = bounds(bunny);
  const double half_extent = (box.hi.x() - box.lo.x()) / 2;
  return two_objects("two-bunnies", "first", bunny, "second", bunny,
                     {.scale = {},
                      .rotate = Placement::Rotation{Vec3(0, 0, 1), 0.7},
                      .translate = Vec3(half_extent * Vec3(0.02, 0.0026, 0.0014))});
}

Scene make_armadillo_elephant() {
  const Mesh armadillo = packaged(kArmadillo);
  const Mesh elephant = packaged(kElephant);
  return two_objects("armadillo-elephant", "armadillo", armadillo, "elephant", elephant,
                     onto(armadillo, elephant));
}

Scene make_dragon_bunny() {
  const Mesh dragon = packaged(kDragon);
  const Mesh bunny = packaged(kBunny);
  return two_objects("dragon-bunny", "dragon", dragon, "bunny", bunny, onto(dragon, bunny));
}

// Returns a mesh and a copy of the mesh. The copy is moved along (2, 3, 6) by `diagonals` times the
// diagonal of the mesh's box. The vector has length 7 and is parallel to no axis.
Scene with_copy(const std::string& name, const char* file, const char* first, const char* second,
                double diagonals) {
  const Mesh mesh = packaged(file);
  const Vec3 step = diagonals * diagonal(bounds(mesh)) / 7 * Vec3(2, 3, 6);
  return two_objects(name, first, mesh, second, mesh,
                     {.scale = {}, .rotate = {}, .translate = step});
}

Scene self_colliding(const std::string& name, const char* file) {
  SceneBuilder builder(name, name);
  builder.add(packaged(file), name);
  Scene scene = builder.finish();
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

constexpr std::uint64_t kPackagedDragon = 19'994;  // number of triangles
constexpr std::uint32_t kPieces = 200;
constexpr double kFirstBreak = 0.05, kLastBreak = 0.8;  // times of the first and last break

struct Piece {
  MeshPart part;
  std::vector<std::uint32_t> source_face;
  Vec3 middle;      // middle of the piece's box
  double late = 0;  // the time when the piece comes off
  Vec3 way;         // velocity at the break; then the piece falls
  Vec3 axis;        // axis of the piece's rotation
  double turn = 0;  // radians per unit of time
};

struct Breaking {
  std::string name;
  Mesh dragon;
  std::vector<std::uint32_t> piece_of;  // the piece of each triangle
  std::vector<Piece> pieces;            // in the order in which they come off; the last piece stays
  double height = 0;                    // height of the dragon
};

template <class Takes>
Piece part_of(const Mesh& mesh, const Takes& takes) {
  PartMaker maker(mesh.vertices);
  Piece piece;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!takes(t)) continue;
    maker.add(mesh.triangles[t]);
    piece.source_face.push_back(mesh.source_face[t]);
  }
  piece.part = maker.take();
  return piece;
}

// Breaks the dragon up. The centres of kPieces random triangles are the seeds of the pieces. Each
// triangle belongs to the piece with the nearest seed. The dragon is hit at its highest point. A
// piece whose seed is nearer to this point comes off earlier.
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
    for (const Vec3& p : piece.part.vertices) around.add(p);
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

// Sets the objects of the scene after the first `off` pieces have come off: the rest of the dragon,
// then these pieces. All objects have the positions that they had in the whole dragon.
void set_topology(const Breaking& dragon, std::size_t off, Scene& scene) {
  scene.vertices.clear();
  scene.triangles.clear();
  scene.source_face.clear();
  scene.objects.clear();
  const auto append = [&](const Piece& piece, const std::string& name) {
    append_object(name, piece.part.vertices, piece.part.triangles, piece.source_face, scene);
  };
  append(part_of(dragon.dragon, [&](std::uint32_t t) { return dragon.piece_of[t] >= off; }),
         "dragon");
  for (std::size_t s = 0; s < off; ++s) append(dragon.pieces[s], "piece" + std::to_string(s));
}

void break_at(const Breaking& dragon, double time, Scene& scene) {
  std::size_t off = 0;  // the last piece stays
  while (off + 1 < kPieces && dragon.pieces[off].late <= time) ++off;
  // The number of objects determines the topology: which triangles the scene has.
  if (scene.objects.size() != off + 1) set_topology(dragon, off, scene);
  std::size_t v = scene.vertices.size();
  for (std::size_t s = 0; s < off; ++s) v -= dragon.pieces[s].part.vertices.size();
  for (std::size_t s = 0; s < off; ++s) {
    const Piece& piece = dragon.pieces[s];
    const double since = time - piece.late;
    const Eigen::Matrix3d turned =
        Eigen::AngleAxisd(piece.turn * since, piece.axis).toRotationMatrix();
    const Vec3 fall(0, -1.5 * dragon.height * since * since, 0);
    const Vec3 to = piece.middle + since * piece.way + fall;
    for (const Vec3& p : piece.part.vertices)
      scene.vertices[v++] = turned * (p - piece.middle) + to;
  }
}

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
  const double way = place.hi.y() - place.lo.y() +
                     scale * (small.hi.y() - small.lo.y());  // distance that the bunny falls
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

std::vector<BuiltinScene> packaged_scenes() {
  std::vector<BuiltinScene> out = {
      entry("two-bunnies", 0, moved(make_two_bunnies, pass_through),
            "two interpenetrating Stanford bunnies", 2, 150816, "one passes through the other"),
      entry("armadillo-elephant", 0, make_armadillo_elephant,
            "armadillo and elephant of one size in one place", 2, 140928),
      entry("dragon-bunny", 0, make_dragon_bunny, "dragon and bunny of one size in one place", 2,
            95402),
      entry(
          "near-copy", 0,
          [] { return with_copy("near-copy", kArmadillo, "armadillo", "copy", 1e-9); },
          "armadillo and its copy moved by 1e-9 of its diagonal", 2, 104000),
      entry(
          "bunnies-far-apart", 0,
          [] { return with_copy("bunnies-far-apart", kBunny, "first", "second", 10); },
          "two bunnies ten diagonals from each other", 2, 150816),
      entry(
          "mannequin-devil", 0, [] { return self_colliding("mannequin-devil", kMannequin); },
          "a mannequin with horns; inside it 1,643 pairs = 1,581 + 62 of neighbours collide", 1,
          25888),
      entry(
          "armadillo", 0, [] { return self_colliding("armadillo", kArmadillo); },
          "the armadillo against itself, where nothing collides", 1, 52000),
      entry(
          "bunny", 0, [] { return self_colliding("bunny", kBunny); },
          "the Stanford bunny against itself, where nothing collides", 1, 75408),
      entry("bunny-dragon", 0, make_bunny_dragon,
            "bunny and dragon, its triangles divided (CULLIDE, FAR)", 2, 325'408,
            "the bunny falls through the dragon",
            {"triangles of the dragon", kPackagedDragon, 100'000'000, 250'000}),
      entry("breaking-dragon", 13, make_breaking_dragon,
            "a dragon that breaks into 200 pieces (CULLIDE)", 121, 250'000,
            "pieces come off, become objects, fly apart, turn and fall",
            {"triangles", kPackagedDragon, 100'000'000, 250'000}, {}, false, kChanges),
  };
  for (BuiltinScene& scene : out) scene.needs_meshes = true;
  return out;
}

}  // namespace farcull
