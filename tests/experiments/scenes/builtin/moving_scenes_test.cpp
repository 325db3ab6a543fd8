// Built-in scenes in motion: they are what they say, and boxes miss nothing in any
// frame of any of them.
#include <Eigen/Geometry>

#include "core/boxes/search.h"
#include "core/view/view.h"
#include "experiments/measure/frames.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/scene_file.h"
#include "tests/lab/moving.h"
#include "tests/lab/pairs.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using lab::kFrames;

const BuiltinScene& entry_of(const std::string& name) { return *parse_scene_name(name).entry; }

// How many triangles meet at each edge of a part of a scene, by vertex indices.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges_of(const Scene& scene,
                                                                const Object& object) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const auto& c = scene.triangles[object.first_triangle + t];
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(c[k], c[(k + 1) % 3])];
  }
  return edges;
}

std::size_t edges_with(const Scene& scene, const Object& object, int triangles) {
  std::size_t count = 0;
  for (const auto& [edge, n] : edges_of(scene, object)) count += n == triangles;
  return count;
}

bool same_topology(const Scene& a, const Scene& b) {
  return a.triangles == b.triangles && a.vertices.size() == b.vertices.size() &&
         a.objects.size() == b.objects.size();
}

// Moves, stays the same object and where promised the same memory, and forgets what was before.
void expect_motion(const std::string& name) {
  SCOPED_TRACE(name);
  const long first = lab::first_frame(name);
  MovingScene moving(name, first + kFrames);
  const Scene& scene = moving.at(first);
  std::vector<Scene> frames;
  std::set<std::string> hashes;
  bool changes = false;
  for (long frame = 0; frame < kFrames; ++frame) {
    const auto* const vertices = scene.vertices.data();
    const auto* const triangles = scene.triangles.data();
    EXPECT_EQ(&moving.at(first + frame), &scene);
    EXPECT_EQ(scene.name, name);
    if (frame > 0 && !same_topology(frames.back(), scene)) {
      changes = true;
    } else {
      EXPECT_EQ(scene.vertices.data(), vertices);
      EXPECT_EQ(scene.triangles.data(), triangles);
    }
    frames.push_back(scene);
    hashes.insert(scene_hash(scene));
  }
  EXPECT_EQ(changes, entry_of(name).topology_changes);
  EXPECT_GT(hashes.size(), static_cast<std::size_t>(kFrames / 2)) << "hardly moves";
  for (const long frame : {5L, 2L, 6L}) {
    const std::string hash = scene_hash(frames[static_cast<std::size_t>(frame)]);
    EXPECT_EQ(scene_hash(moving.at(first + frame)), hash);
    EXPECT_EQ(scene_hash(MovingScene(name, first + kFrames).at(first + frame)), hash);
  }
}

FramesResult frames_of(const std::string& name, Method method) {
  FramesQuestion question;
  question.options.method = method;
  question.options.device = "cpu";
  question.range = {lab::first_frame(name), lab::first_frame(name) + kFrames - 1};
  question.pairs = true;
  return run_frames({name}, question);
}

// All frames against the exact method, which shares nothing with boxes but the predicates.
void expect_nothing_missed(const std::string& name) {
  SCOPED_TRACE(name);
  const FramesResult pairs = frames_of(name, Method::boxes);
  const FramesResult exact = frames_of(name, Method::exact);
  EXPECT_EQ(pairs.json["summary"]["missed"], 0);
  EXPECT_EQ(pairs.broken, "");
  EXPECT_EQ(pairs.pairs_csv, exact.pairs_csv);
  int colliding = 0;
  std::set<int> numbers;
  for (const auto& frame : pairs.json["frames"]) {
    colliding += frame["colliding_pairs"].get<int>() > 0;
    numbers.insert(frame["candidate_pairs"].get<int>());
  }
  EXPECT_GE(colliding, 2) << "frames in which something collides";
  EXPECT_GE(numbers.size(), 3u) << "every frame is like the others";
  EXPECT_EQ(pairs.json["summary"]["topology_changes"] > 0, entry_of(name).topology_changes);
}

TEST(MovingScenes, MoveInPlaceAndForgetWhatWasBefore) {
  for (const std::string& name : lab::moving_scenes(false)) expect_motion(name);
}
TEST(PackagedScenes, MoveInPlaceAndForgetWhatWasBefore) {
  for (const std::string& name : lab::moving_scenes(true)) expect_motion(name);
}

TEST(MovingScenes, MissNothingInAnyFrame) {
  for (const std::string& name : lab::moving_scenes(false)) expect_nothing_missed(name);
}
TEST(PackagedScenes, MissNothingInAnyFrame) {
  for (const std::string& name : lab::moving_scenes(true)) expect_nothing_missed(name);
}

TEST(MovingScenes, SuffixesApplyToEveryFrameAndAGroundStays) {
  for (const std::string& base : lab::moving_scenes(false)) {
    const std::string name = base + "@ground@far";
    SCOPED_TRACE(name);
    MovingScene moving(name, kFrames), plain(base, kFrames);
    const Scene first = moving.at(0);
    const std::array<Vec3, 4> ground = {first.vertices.end()[-4], first.vertices.end()[-3],
                                        first.vertices.end()[-2], first.vertices.end()[-1]};
    const Scene& now = moving.at(3);
    const Scene& before = plain.at(3);
    ASSERT_EQ(now.objects.back().name, "ground");
    ASSERT_EQ(now.vertices.size(), before.vertices.size() + 4);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(now.vertices.end()[k - 4], ground[k]);
    const Vec3 step = now.vertices[0] - before.vertices[0];
    EXPECT_GT(step.x(), 1e5 * diagonal(bounds(before)));
    // One step for all, up to the rounding of a sum of its size.
    for (std::size_t v = 0; v < before.vertices.size(); ++v) {
      EXPECT_LE((now.vertices[v] - before.vertices[v] - step).cwiseAbs().maxCoeff(),
                4 * 0x1p-53 * (step.x() + diagonal(bounds(before))))
          << v;
    }
  }
  // The older motions move every object.
  for (const char* name : {"two-spheres", "crowd:50", "field:2000"}) {
    const Scene rest = make_builtin_scene(name);
    MovingScene moving(name, 11);
    const Scene& now = moving.at(3);
    for (const Object& object : rest.objects) {
      const std::uint32_t v = rest.triangles[object.first_triangle][0];
      EXPECT_NE(now.vertices[v], rest.vertices[v]) << name << ' ' << object.name;
    }
  }
  EXPECT_FALSE(has_motion("two-tori"));
  EXPECT_EQ(error_of([] { MovingScene("two-tori", 3); }).where, "two-tori");
  EXPECT_EQ(error_of([] { MovingScene("crowd:1", 3); }).where, "crowd:1");
}

TEST(MovingScenes, APathGoesFromFrameZeroToItsLast) {
  MovingScene five("cylinders:3", 5), nine("cylinders:3", 9);
  for (long frame = 0; frame < 5; ++frame)
    EXPECT_EQ(scene_hash(five.at(frame)), scene_hash(nine.at(2 * frame)));
  // So the end of a motion can be run by itself; with another last frame it is another motion.
  FrameSource end({"cylinders:3"}, {3, 8}, false), other({"cylinders:3"}, {3, 7}, false);
  for (long frame = 3; frame < 8; ++frame) {
    EXPECT_EQ(scene_hash(end.at(frame)), scene_hash(nine.at(frame)));
    EXPECT_NE(scene_hash(other.at(frame)), scene_hash(nine.at(frame)));
  }
}

TEST(MovingScenes, ASimulationDependsOnTheNumberOfItsFrame) {
  MovingScene few("cloth:200:1e3", 13), many("cloth:200:1e3", 20);
  for (long frame = 10; frame < 13; ++frame) {
    EXPECT_EQ(scene_hash(few.at(frame)), scene_hash(many.at(frame)));
    EXPECT_EQ(few.notes(), many.notes());
  }
  MovingScene stiff("cloth:200:1e6", 20);
  EXPECT_NE(scene_hash(stiff.at(12)), scene_hash(many.at(12)));
  EXPECT_TRUE(few.at(11).objects[0].self);
  EXPECT_FALSE(few.at(11).objects[1].self);
  EXPECT_EQ(few.warning(), "");
  const FramesResult result = frames_of("cloth:200:1e3", Method::boxes);
  for (const auto& frame : result.json["frames"]) {
    double sum = 0;
    for (const char* part : {"kinetic J", "elastic J", "bending J", "gravitational J", "contact J"})
      sum += frame["motion"][part].get<double>();
    EXPECT_NEAR(sum, frame["motion"]["total J"].get<double>(), 8 * 0x1p-53);  // of parts below 1
    EXPECT_EQ(frame["motion"]["converged"], 1);
    EXPECT_GT(frame["motion"]["iterations"], 0);
  }
  EXPECT_TRUE(has_text(result.table, "residual N"));
}

// Two triangles, one of which falls; it has something to say of some frames.
TEST(MovingScenes, NotesAndWarningsReachTheRecordAndTheTable) {
  BuiltScene built;
  built.scene.name = "noted";
  built.scene.vertices = {{0, 0, 0},     {1, 0, 0},     {0, 1, 0},
                          {0.1, 0.1, 1}, {0.5, 0.1, 1}, {0.1, 0.1, 2}};
  built.scene.triangles = {{0, 1, 2}, {3, 4, 5}};
  built.scene.source_face = {0, 0};
  built.scene.objects = {{"floor", 0, 1}, {"falling", 1, 1}};
  built.motion = [rest = built.scene.vertices](const Instant& now, Scene& out, FrameNotes& notes) {
    for (std::size_t v = 3; v < 6; ++v) out.vertices[v].z() = rest[v].z() - 3 * now.time;
    notes.values = {{"height", 1 - 3 * now.time}, {"odd", now.frame % 2 ? 1.0 : NAN}};
    if (now.frame >= 2) notes.warning = "it fell far";
    if (now.frame == 4) notes.warning = "it fell through";
  };
  FrameSource source{MovingScene(built, 5)};
  FramesQuestion question;
  question.options.method = Method::exact;
  question.range = {0, 4};
  const FramesResult result = run_frames(source, question);
  const auto& frames = result.json["frames"];
  EXPECT_EQ(frames[1]["motion"]["height"], 1 - 3 * 0.25);
  EXPECT_EQ(frames[1]["motion"]["odd"], 1);
  EXPECT_EQ(nlohmann::json::parse(result.json.dump())["frames"][0]["motion"]["odd"], nullptr);
  EXPECT_EQ(frames[1]["warning"], nullptr);
  EXPECT_EQ(frames[3]["warning"], "it fell far");
  EXPECT_EQ(frames[2]["colliding_pairs"], 1);
  EXPECT_TRUE(has_text(result.table, "height"));
  EXPECT_TRUE(has_text(result.table,
                       "\nwarning  it fell far (frame 2 and 1 more)\n"
                       "warning  it fell through (frame 4)\n"));
  EXPECT_TRUE(result.table.ends_with("(frame 4)\n"));
}

TEST(MovingScenes, SizesAreThoseOfTheirNames) {
  const std::map<std::string, std::pair<std::size_t, std::size_t>> expected = {
      {"cylinders:7", {7, 1400}},   {"torii:20000", {6, 120'000}}, {"torii:72", {6, 432}},
      {"tree-leaves:3", {4, 4600}}, {"shells:10", {10, 6960}},     {"needles:16", {4, 44}}};
  for (const auto& [name, counts] : expected) {
    const Scene scene = make_builtin_scene(name);
    EXPECT_EQ(scene.objects.size(), counts.first) << name;
    EXPECT_EQ(scene.triangles.size(), counts.second) << name;
  }
  for (const std::uint64_t size : {72u, 100u, 997u, 1234u, 5000u}) {
    const std::string name = "torii:" + std::to_string(size);
    const double each = static_cast<double>(make_builtin_scene(name).triangles.size()) / 6;
    EXPECT_NEAR(each / static_cast<double>(size), 1, 0.25) << name;
  }
}

TEST(MovingScenes, CrowdHasTheDensityOfItsName) {
  char usual[80];
  std::snprintf(usual, sizeof usual, "crowd:400:%.17g", 400.0 / (12 * 12 * 12));
  const std::string hash = scene_hash(make_builtin_scene("crowd"));
  EXPECT_EQ(scene_hash(make_builtin_scene(usual)), hash);
  EXPECT_EQ(scene_hash(make_builtin_scene("crowd:400")), hash);
  double colliding = 0;
  for (const char* density : {"0.05", "0.2", "0.8"}) {
    const Scene scene = make_builtin_scene(std::string("crowd:1000:") + density);
    Box centres = Box::empty();
    for (const Box& box : object_boxes(scene, triangle_boxes(scene)))
      centres.add(Vec3((box.lo + box.hi) / 2));
    // Of 1,000 drawn places one lies within a hundredth of a side, but for a chance of 0.99^1000,
    // and the middle of a box within 0.36 of its place: an object of scale 0.6 or less reaches 0.6
    // farther to one side than to the other. Half a side is 5.3 or more, so each extent is within
    // 0.078 of the cube's, and the density within 0.28.
    EXPECT_NEAR(1000 / (centres.hi - centres.lo).prod() / std::stod(density), 1, 0.28) << density;
    const auto pairs = static_cast<double>(all_colliding_pairs(scene).pairs.size());
    EXPECT_GT(pairs, 1.5 * colliding) << density;
    colliding = pairs;
  }
}

TEST(MovingScenes, NeedlesKeepTheirObliqueOnesAndLieAlongTheAxes) {
  const Scene few = make_builtin_scene("needles:8"), many = make_builtin_scene("needles");
  for (std::size_t o = 0; o < 2; ++o) {
    for (std::uint32_t t = 0; t < 8; ++t) {
      EXPECT_EQ(few.corners(few.objects[o].first_triangle + t),
                many.corners(many.objects[o].first_triangle + t));
    }
  }
  MovingScene moving("needles", kFrames);
  for (long frame = 0; frame < kFrames; ++frame) {
    const Scene& scene = moving.at(frame);
    std::array<int, 3> along = {};
    for (std::uint32_t t = scene.objects[2].first_triangle; t < scene.triangles.size(); ++t) {
      const auto [a, b, c] = scene.corners(t);
      int zeros = 0;
      for (int k = 0; k < 3; ++k) {
        zeros += a[k] == b[k];
        along[static_cast<std::size_t>(k)] += a[k] != b[k];
      }
      EXPECT_EQ(zeros, 2) << t;
    }
    for (const int n : along) EXPECT_EQ(n, 100);
  }
}

TEST(MovingScenes, CylindersAndLeavesAreOpenAndToriiClosed) {
  for (const char* name : {"cylinders:4", "tree-leaves:4", "torii:400"}) {
    const Scene scene = make_builtin_scene(name);
    for (const Object& object : scene.objects) {
      const std::size_t open = edges_with(scene, object, 1);
      std::size_t expected = 40;                         // both rims; the leaf's outline
      if (object.name == "tree") expected = 50 * 2 * 8;  // of 50 tubes
      if (object.name.starts_with("torus")) expected = 0;
      EXPECT_EQ(open, expected) << name << ' ' << object.name;
      EXPECT_EQ(edges_with(scene, object, 2) + open, edges_of(scene, object).size());
      EXPECT_EQ(object.triangle_count, object.name == "tree"              ? 4000u
                                       : object.name.starts_with("torus") ? 400u
                                                                          : 200u);
    }
  }
  // The tree stands still; every leaf falls.
  MovingScene moving("tree-leaves:6", kFrames);
  const Scene first = moving.at(0);
  const Scene& last = moving.at(kFrames - 1);
  const std::vector<Box> from = object_boxes(first, triangle_boxes(first));
  const std::vector<Box> to = object_boxes(last, triangle_boxes(last));
  EXPECT_EQ(from[0].lo, to[0].lo);
  for (std::size_t o = 1; o < to.size(); ++o) EXPECT_LT(to[o].lo.z(), from[o].lo.z() - 2);
}

// The gap is exact at every vertex, in every frame, so two neighbours in the stack are translates;
// and far below one step of a depth buffer of 24 bits, whatever the axis of the view.
TEST(MovingScenes, ShellsLieBelowADepthStepAndSomeCross) {
  MovingScene moving("shells:8", kFrames);
  for (long frame = 0; frame < kFrames; ++frame) {
    const Scene& scene = moving.at(frame);
    const std::size_t each = scene.vertices.size() / 8;
    for (std::size_t s = 1; s < 6; ++s) {
      for (std::size_t i = 0; i < each; ++i) {
        const Vec3& upper = scene.vertices[s * each + i];
        const Vec3& lower = scene.vertices[(s - 1) * each + i];
        ASSERT_EQ(upper, Vec3(lower.x(), lower.y(), upper.z()));
        ASSERT_EQ(upper.z() - lower.z(), kShellGap);
      }
    }
    const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
    for (const char* axis : {"x", "y", "z"}) {
      const auto window = fit_window(parse_view(axis), boxes, 512);
      ASSERT_TRUE(window);
      const double step = (window->hi.z() - window->lo.z()) / (0x1p24 - 1);  // px
      const double gap = kShellGap * window->map.row(2).norm();              // px, at most
      EXPECT_LT(16 * gap, step) << axis;
    }
    for (const Object& object : scene.objects) {
      EXPECT_EQ(edges_with(scene, object, 3), 24u);
      EXPECT_GT(edges_with(scene, object, 1), 72u);
    }
    const std::vector<std::uint32_t> owner = owners(scene);
    std::set<std::uint32_t> crossed;
    for (const TrianglePair& pair : all_colliding_pairs(scene).pairs) {
      EXPECT_GE(owner[pair.b], 6u) << "two sheets of the stack meet";
      crossed.insert(owner[pair.b]);
    }
    EXPECT_FALSE(crossed.empty());
  }
}

TEST(PackagedScenes, DragonBreaksIntoPiecesThatAreItsTriangles) {
  const Scene dragon = make_builtin_scene("bunny-dragon:19994");
  MovingScene moving("breaking-dragon:19994", kFrames);
  std::size_t objects = 0, vertices = 0, open = 0;
  for (long frame = 0; frame < kFrames; ++frame) {
    const Scene& scene = moving.at(frame);
    EXPECT_EQ(scene.triangles.size(), 19'994u);
    std::vector<std::uint32_t> faces = scene.source_face;
    std::ranges::sort(faces);
    std::vector<std::uint32_t> all(faces.size());
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(faces, all) << "each triangle once";
    std::size_t now_open = 0;
    for (const Object& object : scene.objects) now_open += edges_with(scene, object, 1);
    if (frame == 0) {
      EXPECT_EQ(scene.objects.size(), 1u);
      for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
        ASSERT_EQ(scene.corners(t), dragon.corners(t)) << "whole at the start";
    } else if (frame < 6) {  // times up to 5/7, the last comes off at 0.8
      EXPECT_GT(scene.objects.size(), objects);
      EXPECT_GT(scene.vertices.size(), vertices);
      EXPECT_GT(now_open, open);
    }
    objects = scene.objects.size();
    vertices = scene.vertices.size();
    open = now_open;
  }
  EXPECT_EQ(objects, 200u);
}

// Frame by frame with one memory. The twin: the candidates of the first frame miss in every later
// one.
TEST(MovingScenes, ChangedTopologyIsSeen) {
  lab::Reconnected reconnected;
  FrameMemory memory;
  std::vector<TrianglePair> first;
  for (long frame = 0; frame < 30; ++frame) {
    const Scene& scene = reconnected.at(frame);
    const std::vector<TrianglePair> truth = lab::truth_of(scene);
    memory.moved.update(scene);
    const std::vector<TrianglePair> found =
        find_boxes(scene, plan_boxes(scene, {}, 2, &memory), &memory).candidates;
    if (frame == 0) first = found;
    EXPECT_EQ(lab::missed(truth, found), 0u) << frame;
    EXPECT_EQ(lab::missed(truth, first) > 0, frame > 0) << frame;
  }
}

double area_of(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return 0.5 *
         (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
}

TEST(Refined, DividesTheLongestEdgesAndKeepsTheSurface) {
  shapes::Random random(5);
  const Mesh coarse = shapes::blob(2, random);
  for (const std::uint64_t wanted : {321u, 1000u, 5001u}) {
    const Mesh fine = refined(coarse, wanted);
    EXPECT_GE(fine.triangles.size(), wanted);
    EXPECT_LE(fine.triangles.size(), wanted + 1);  // closed: two a division
    EXPECT_EQ(fine.vertices, refined(coarse, wanted).vertices);
    SceneBuilder builder("fine", "fine");
    builder.add(fine, "fine", Split::kNone, {});
    const Scene scene = builder.finish();
    EXPECT_EQ(edges_with(scene, scene.objects[0], 2), edges_of(scene, scene.objects[0]).size());
    // The parts of a triangle have its area: a midpoint is off by at most 2 u of its size, 2 here,
    // in each coordinate, which changes an area by at most that times the perimeter, 6; and there
    // are at most all parts in one.
    std::vector<double> area(coarse.triangles.size(), 0);
    for (std::size_t t = 0; t < fine.triangles.size(); ++t)
      area[fine.source_face[t]] += area_of(fine, t);
    const double off = 4 * 0x1p-53 * 2 * 6 * static_cast<double>(fine.triangles.size());
    for (std::size_t t = 0; t < area.size(); ++t) EXPECT_NEAR(area[t], area_of(coarse, t), off);
  }
  EXPECT_EQ(refined(coarse, 5).triangles, coarse.triangles);
  // An open edge has one triangle, a fan of three at one edge divides at once.
  const Mesh fan = shapes::finished({{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, -1, 0}, {2, 0, 1}},
                                    {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 0, 1}});
  EXPECT_EQ(refined(fan, 5).triangles.size(), 7u);
}

}  // namespace
}  // namespace farcull
