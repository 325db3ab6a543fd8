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
  EXPECT_FALSE(has_motion("two-tori"));
  EXPECT_EQ(error_of([] { MovingScene("two-tori", 3); }).where, "two-tori");
  EXPECT_EQ(error_of([] { MovingScene("crowd:1", 3); }).where, "crowd:1");
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

}  // namespace
}  // namespace farcull
