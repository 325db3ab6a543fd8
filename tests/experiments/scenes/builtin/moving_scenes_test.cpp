// Built-in scenes in motion: they are what they say, and boxes miss nothing in any
// frame of any of them.
#include <Eigen/Geometry>

#include "experiments/measure/frames.h"
#include "tests/lab/moving.h"

namespace farcull {
namespace {

using lab::kFrames;

const BuiltinScene& entry_of(const std::string& name) { return *parse_scene_name(name).entry; }

// The scene moves in place, in the same memory where that is promised, and a frame does not depend
// on those before it.
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
    if (frame > 0 && (frames.back().triangles != scene.triangles ||
                      frames.back().vertices.size() != scene.vertices.size() ||
                      frames.back().objects.size() != scene.objects.size())) {
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

}  // namespace
}  // namespace farcull
