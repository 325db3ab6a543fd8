// Objects that poses move, calls that may be ended, and matrices of Eigen as input. Each answer is
// held against that of plain arrays.

#include "experiments/library/distance.h"
#include "experiments/library/eigen.h"
#include "experiments/library/input.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/flat.h"
#include "tests/lab/motions.h"

namespace farcull {
namespace {

/// The first coordinate that a row of r and a number of t give, as farcull.h says.
double as_stated(const double* r, const double* p, double t) {
  double sum = r[0] * p[0];
  sum = sum + r[1] * p[1];
  sum = sum + r[2] * p[2];
  return sum + t;
}
/// Twins: the same with one rounding for a product and a sum, and in another order.
double fused(const double* r, const double* p, double t) {
  return std::fma(r[2], p[2], std::fma(r[1], p[1], r[0] * p[0])) + t;
}
double reordered(const double* r, const double* p, double t) {
  return r[0] * p[0] + (r[1] * p[1] + (r[2] * p[2] + t));
}

/// The scene after each object was moved. Objects must not share vertices.
template <class Row>
Flat moved(const Flat& flat, const std::vector<Pose>& poses, const Row& row) {
  Flat out = flat;
  for (std::size_t k = 0; k < flat.triangles.size(); ++k) {
    const auto after = std::ranges::upper_bound(flat.starts, k / 3);
    const Pose& pose = poses[static_cast<std::size_t>(after - flat.starts.begin()) - 1];
    const double* const p = flat.vertices.data() + 3 * flat.triangles[k];
    for (std::size_t axis = 0; axis < 3; ++axis)
      out.vertices[3 * flat.triangles[k] + axis] = row(pose.r.data() + 3 * axis, p, pose.t[axis]);
  }
  return out;
}

Pose random_pose(RandomNumbers& random, double far) {
  const Eigen::Vector3d axis(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  Eigen::Isometry3d out(Eigen::AngleAxisd(random.between(0, 6), axis.normalized()));
  for (int k = 0; k < 3; ++k) out.translation()[k] = far * random.between(-1, 1);
  return pose_of(out);
}

/// taken: the input of the last call.
std::vector<double> taken_vertices(const Input& input, TakenInput&& taken = {}) {
  load_input(input, false, {}, taken);
  std::vector<double> out;
  for (const Vec3& p : taken.scene.vertices) out.insert(out.end(), p.data(), p.data() + 3);
  return out;
}

TEST(LibraryPoses, MoveEachVertexByTheStatedOperations) {
  RandomNumbers random(39);
  const Flat flat(make_builtin_scene("two-spheres"));
  const std::vector<Pose> poses = {random_pose(random, 0.3), random_pose(random, 0.3)};
  Input input = flat.input();
  input.poses = poses;
  const std::vector<double> found = taken_vertices(input);
  EXPECT_EQ(found, moved(flat, poses, as_stated).vertices);
  EXPECT_NE(found, moved(flat, poses, fused).vertices);
  EXPECT_NE(found, moved(flat, poses, reordered).vertices);
  const std::vector<Pose> still(2);
  input.poses = still;
  EXPECT_EQ(taken_vertices(input), flat.vertices);
}

// Poses with arrays, poses alone, and arrays alone follow each other; some objects stay in their
// pose. Each answer is that of a new call about the moved arrays.
TEST(LibraryPoses, FramesAreAsFresh) {
  RandomNumbers random(40);
  Flat flat(make_builtin_scene("two-spheres"));
  std::vector<Pose> poses(2);
  Collider collider({.self_objects = {true, false}});
  DistanceFinder finder({.inside = false, .exact = true});
  TakenInput kept;
  int changes = 0, alone = 0;
  bool arrays = true;
  std::vector<Pair> last;
  for (int frame = 0; frame < 40; ++frame) {
    if (random.below(3) == 0) {
      const std::size_t at = 3 * random.below(flat.vertices.size() / 3);
      for (std::size_t k = at; k < std::min(at + 90, flat.vertices.size()); ++k)
        flat.vertices[k] += 0.05 * random.between(-1, 1);
      arrays = true;
    }
    for (Pose& pose : poses)
      if (random.below(2) == 0) pose = random_pose(random, 0.2);
    if (random.below(6) == 0) poses = {Pose(), Pose()};
    Input input = flat.input();
    if (!arrays && random.below(4) > 0) input = {};
    if (random.below(8) > 0 || input.vertices.empty()) input.poses = poses;
    alone += input.vertices.empty();
    const Flat expected = input.poses.empty() ? flat : moved(flat, poses, as_stated);
    ASSERT_EQ(taken_vertices(input, std::move(kept)), expected.vertices) << frame;
    const Result found = collider.find(input);
    const Result fresh = collide(expected.input(), {.self_objects = {true, false}});
    ASSERT_EQ(found.pairs, fresh.pairs) << frame;
    ASSERT_EQ(found.neighbour_pairs, fresh.neighbour_pairs) << frame;
    ASSERT_EQ(finder.find(input)[0].squared,
              distances(expected.input(), {.inside = false, .exact = true})[0].squared)
        << frame;
    changes += found.pairs != last;  // so what is not moved, or moved twice, gives another answer
    last = found.pairs;
    arrays = false;
  }
  EXPECT_GT(changes, 20);
  EXPECT_GT(alone, 10);
}

Pose pose_by(RandomNumbers& random, int kind) {
  const RigidMotion motion = lab::random_motion(random, kind);
  return {motion.r, motion.t};
}

// Whether boxes moved with their objects.
bool moved_boxes(const Result& result) {
  return std::ranges::any_of(result.report.stages, [](const Report::Stage& stage) {
    return has_text(stage.reason, "moved with their objects");
  });
}

// Poses alone, of all kinds, between calls with arrays. The answers are those of new calls,
// contacts and candidates as well, whether boxes or all vertices move.
TEST(LibraryPoses, AloneAreAsFresh) {
  RandomNumbers random(test_seed(42));
  const int frames = trials(4) == 4 ? 10'000 : 300;  // 4 of 4: in a campaign
  int by_boxes = 0, with_pairs = 0, limited = 0;
  std::array<int, lab::kMotionKinds> of_kind{};
  std::optional<Collider> collider;
  Options options;
  std::optional<Flat> flat;
  std::vector<Pose> poses;
  // Until all has been seen that the answers are compared for; a bound that no seed reaches.
  const auto lacks_any = [&] {
    return by_boxes <= frames / 4 || with_pairs <= frames / 4 || limited == 0 ||
           std::count(of_kind.begin(), of_kind.end(), 0) > 0;
  };
  for (int frame = 0; frame < frames || (lacks_any() && frame < 40 * frames); ++frame) {
    if (frame % 25 == 0) {
      flat.emplace(make_builtin_scene(frame % 50 == 0 ? "two-spheres" : "crowd:12"));
      options = {.threads = 2,
                 .clearance = random.below(3) == 0 ? 0.01 : 0,
                 .contacts = random.below(2) == 0 ? Contacts::segments : Contacts::none,
                 .limit = random.below(4) == 0 ? 20u : 0u};
      if (random.below(3) == 0 && flat->starts.size() > 2) options.ignore = {{0, 1}, {2, 1}};
      collider.emplace(options);
      poses.assign(flat->starts.size(), Pose());
      Input first = flat->input();
      if (random.below(2) == 0) first.poses = poses;
      collider->find(first);
    }
    int kind = random.below(lab::kMotionKinds);
    if (kind == lab::kTinyMotion && options.clearance > 0) kind = 0;  // else all pairs collide
    for (Pose& pose : poses)
      if (random.below(8) > 0) pose = pose_by(random, kind);
    Input input;
    const int arrays = random.below(12);  // 0: others, 1: the same again, else poses alone
    if (arrays == 0)
      for (double& x : flat->vertices) x += 0.001 * random.between(-1, 1);
    if (arrays <= 1) input = flat->input();
    if (input.vertices.empty() || random.below(2) == 0) input.poses = poses;
    Input whole = flat->input();
    whole.poses = input.poses;
    const Result found = collider->find(input), fresh = collide(whole, options);
    ASSERT_EQ(found.pairs, fresh.pairs) << frame << " kind " << kind;
    ASSERT_EQ(found.contacts, fresh.contacts) << frame;
    ASSERT_EQ(found.complete, fresh.complete) << frame;
    ASSERT_EQ(found.neighbour_pairs, fresh.neighbour_pairs) << frame;
    limited += !found.complete;
    with_pairs += !found.pairs.empty();
    if (!moved_boxes(found)) continue;
    ++by_boxes;
    of_kind[static_cast<std::size_t>(kind)] += !found.pairs.empty();
  }
  EXPECT_GT(by_boxes, frames / 4);
  EXPECT_GT(with_pairs, frames / 4);
  EXPECT_GT(limited, 0);
  for (const int pairs : of_kind) EXPECT_GT(pairs, 0);
}

// Between the calls that answer, some are ended or refused, the scene changes, and some vertices
// that no triangle uses are not finite. Nothing of these calls is left in an answer.
TEST(LibraryPoses, AreAsFreshAfterCallsThatFailed) {
  RandomNumbers random(test_seed(44));
  std::vector<Flat> scenes;
  for (const char* name : {"two-spheres", "crowd:12", "ground"}) {
    scenes.emplace_back(make_builtin_scene(name));
    scenes.back().vertices.insert(scenes.back().vertices.end(), 3, std::nan(""));
  }
  enum { answered, ended, refused, other_scene } last = answered;
  bool may_go_on = true;
  Collider collider({.may_go_on = [&](const std::string&) { return may_go_on; }});
  const Flat* flat = &scenes[0];
  std::vector<Pose> poses;
  std::array<int, 4> by_boxes_after{};
  bool alone = false;  // whether poses alone are enough
  for (int frame = 0; frame < 250; ++frame) {
    const int next = random.below(6);
    if (next == 0) {
      flat = &scenes[random.below(scenes.size())];
      alone = false;
      last = other_scene;
    }
    const int kind = random.below(2);
    poses.assign(flat->starts.size(), Pose());
    for (Pose& pose : poses)
      if (random.below(3) > 0) pose = pose_by(random, kind);
    Input whole = flat->input();
    whole.poses = poses;
    if (next == 1) {
      std::vector<Pose> bad = poses;
      bad.back().t[1] = std::nan("");
      EXPECT_EQ(refusal([&] { collider.find({.poses = bad}); })[0], "poses");
      alone = false;
      last = refused;
    }
    const Input input = alone && random.below(4) > 0 ? Input{.poses = poses} : whole;
    if (next == 2) {
      may_go_on = false;
      EXPECT_THROW(collider.find(input), Cancelled);
      may_go_on = true;
      for (Pose& pose : poses) pose = pose_by(random, kind);
      last = ended;
    }
    const Result found = collider.find(next == 2 ? Input{.poses = poses} : input);
    ASSERT_EQ(found.pairs, collide(whole).pairs) << frame << " " << next;
    EXPECT_EQ(found.report.passed_over, 1u);
    alone = true;
    if (moved_boxes(found)) ++by_boxes_after[std::exchange(last, answered)];
  }
  for (const int calls : by_boxes_after) EXPECT_GT(calls, 3);
}

// Where boxes of blocks do not decide, they move in vain in few calls, and move again where they
// do.
TEST(LibraryPoses, BackOffWhereBoxesDoNotDecide) {
  RandomNumbers random(test_seed(45));
  const Flat flat(make_builtin_scene("needles-layers"));
  TakenInput taken;
  std::vector<Pose> poses(2);
  Input first = flat.input();
  first.poses = poses;
  load_input(first, false, {}, taken);
  const auto tries = [&](int calls, double apart, int& decided) {
    int out = 0;
    decided = 0;
    for (int call = 0; call < calls; ++call) {
      poses[1].t = {0, 0, apart + 1e-3 * random.between(-1, 1)};
      const Input input{.poses = poses};
      out += taken.skips == 0;
      const bool by_boxes = load_poses(input, {.ignored = {}, .threads = 1}, taken).has_value();
      decided += by_boxes;
      if (!by_boxes) load_input(input, false, {}, taken);
    }
    return out;
  };
  int decided = 0;
  EXPECT_EQ(tries(100, 0, decided), 7);  // calls 0, 2, 5, 10, 19, 36, 69
  EXPECT_EQ(decided, 0);
  EXPECT_GT(tries(100, 1e6, decided), 60);
  EXPECT_GT(decided, 60);
  EXPECT_EQ(taken.next_skips, 1);
}

// A vertex that the boxes left where it was is moved when a later call needs it.
TEST(LibraryPoses, VerticesThatWereLeftBehindAreMovedLater) {
  RandomNumbers random(43);
  const Flat flat(make_builtin_scene("two-spheres"));
  Collider collider;
  collider.find(flat.input());
  std::vector<Pose> poses(2);
  const auto find_by_boxes = [&] {
    bool by_boxes = false;
    for (int frame = 0; frame < 8 && !by_boxes; ++frame) {
      poses[1] = random_pose(random, 0.01);
      by_boxes = moved_boxes(collider.find({.poses = poses}));
    }
    return by_boxes;
  };
  ASSERT_TRUE(find_by_boxes());
  // The same arrays without poses, and poses that flatten nothing but are too large for boxes.
  EXPECT_EQ(collider.find(flat.input()).pairs, collide(flat.input()).pairs);
  EXPECT_EQ(collider.find(flat.input()).pairs, collide(flat.input()).pairs);
  ASSERT_TRUE(find_by_boxes());
  for (Pose& pose : poses) {
    pose = Pose();
    for (double& x : pose.r) x *= 0x1p1022;
  }
  Input whole = flat.input();
  whole.poses = poses;
  const Result large = collider.find({.poses = poses});
  EXPECT_FALSE(moved_boxes(large));
  EXPECT_EQ(large.pairs, collide(whole).pairs);
  EXPECT_FALSE(large.pairs.empty());
}

TEST(LibraryPoses, RefuseWhatIsBadAndGoOn) {
  const Flat flat(make_builtin_scene("two-spheres"));
  Collider collider;
  const std::vector<Pair> expected = collider.find(flat.input()).pairs;
  const auto reason = [&](const std::vector<Pose>& poses, bool alone, const Flat& of) {
    Input input = alone ? Input() : of.input();
    input.poses = poses;
    return refusal([&] { collider.find(input); })[1];
  };
  Pose infinite, huge, flat_pose;
  infinite.r[4] = HUGE_VAL;
  flat_pose.r = {1, 0, 0, 0, 1, 0, 1, 1, 0};
  huge.t[1] = huge.r[4] = std::numeric_limits<double>::max();
  for (const bool alone : {true, false}) {
    EXPECT_EQ(collider.find(flat.input()).pairs, expected);
    EXPECT_EQ(reason({Pose()}, alone, flat), "are 1 for 2 objects");
    // What was refused is not there for poses alone.
    EXPECT_EQ(reason({Pose(), Pose()}, true, flat),
              "are given without triangles, and there are none of an earlier call");
    EXPECT_EQ(collider.find(flat.input()).pairs, expected);
    EXPECT_EQ(reason({Pose(), infinite}, alone, flat), "that of object 1 is not finite");
    EXPECT_EQ(collider.find(flat.input()).pairs, expected);
    EXPECT_EQ(reason({flat_pose, Pose()}, alone, flat),
              "the matrix of object 0 has no inverse, so it flattens it");
    EXPECT_EQ(collider.find(flat.input()).pairs, expected);
    EXPECT_TRUE(has_text(reason({huge, Pose()}, alone, flat), "beyond the largest double"));
  }
  Flat shared = flat;
  shared.triangles.back() = 0;
  EXPECT_EQ(reason({Pose(), Pose()}, false, shared),
            "vertex 0 is used by objects 0 and 1, which have a pose each");
  const std::vector<Pose> poses(2);
  EXPECT_EQ(refusal([&] { collide({.poses = poses}); })[0], "poses");
  EXPECT_EQ(collider.find(flat.input()).pairs, expected);
  EXPECT_EQ(reason({Pose(), Pose()}, true, flat), "nothing was thrown");
}

// ---- calls that may be ended

TEST(LibraryMayGoOn, IsAskedInTheThreadOfTheCallerAndChangesNothing) {
  const Flat flat(make_builtin_scene("two-spheres"));
  int asked = 0;
  bool here = true;
  const MayGoOn may_go_on = [&, caller = std::this_thread::get_id()](const std::string&) {
    ++asked;
    here = here && std::this_thread::get_id() == caller;
    return true;
  };
  std::fesetround(FE_UPWARD);
  const Result found = collide(flat.input(), {.may_go_on = may_go_on});
  EXPECT_EQ(std::fegetround(), FE_UPWARD);
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(found.pairs, collide(flat.input()).pairs);
  EXPECT_EQ(found.report.callers_arithmetic, "rounds upward, keeps subnormals");
  EXPECT_EQ(distances(flat.input(), {.exact = true, .may_go_on = may_go_on})[0].squared,
            distances(flat.input(), {.exact = true})[0].squared);
  EXPECT_GE(asked, 2);
  EXPECT_TRUE(here);
}

TEST(LibraryMayGoOn, EndsACallWithoutAnAnswerAndTheNextOneIsRight) {
  const Flat flat(make_builtin_scene("two-spheres"));
  enum { go, end, fail } now = go;
  const MayGoOn may_go_on = [&](const std::string&) {
    if (now == fail) throw std::out_of_range("of the caller");
    return now == go;
  };
  Collider collider({.may_go_on = may_go_on});
  DistanceFinder finder({.may_go_on = may_go_on});
  const std::vector<Pair> expected = collide(flat.input()).pairs;
  Flat other = flat;
  for (double& x : other.vertices) x += 1;
  for (int frame = 0; frame < 4; ++frame) {
    now = end;
    EXPECT_THROW(collider.find(other.input()), Cancelled);
    EXPECT_EQ(refusal([&] { finder.find(other.input()); })[0], "may_go_on");
    now = fail;
    EXPECT_THROW(collider.find(other.input()), std::out_of_range);
    EXPECT_THROW(finder.find(other.input()), std::out_of_range);
    now = go;
    EXPECT_EQ(collider.find(flat.input()).pairs, expected);
    EXPECT_EQ(finder.find(flat.input()).size(), 1u);
  }
}

// ---- matrices

TEST(LibraryEigen, MatricesOfAnyTypeAndOrderAnswerAsArrays) {
  Flat flat(make_builtin_scene("two-spheres"));
  for (double& x : flat.vertices) x = static_cast<float>(x);
  const auto rows = static_cast<Eigen::Index>(flat.vertices.size() / 3);
  const auto faces = static_cast<Eigen::Index>(flat.triangles.size() / 3);
  using ByRows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const ByRows V = Eigen::Map<const ByRows>(flat.vertices.data(), rows, 3);
  const Eigen::MatrixXf by_columns = V.cast<float>();
  Eigen::MatrixXi F(faces, 3);
  for (Eigen::Index k = 0; k < 3 * faces; ++k)
    F(k / 3, k % 3) = static_cast<int>(flat.triangles[static_cast<std::size_t>(k)]);
  const std::vector<Pair> expected = collide(flat.input()).pairs;
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(collide(V, F, flat.starts).pairs, expected);
  EXPECT_EQ(collide(by_columns, F.cast<std::int64_t>(), flat.starts).pairs, expected);
  EXPECT_EQ(distances(EigenInput(V, F, flat.starts), {.exact = true})[0].squared,
            distances(flat.input(), {.exact = true})[0].squared);
  // Twins: rows for columns, and an index below 0.
  EXPECT_EQ(refusal([&] { collide(V.transpose(), F, flat.starts); })[0], "vertices");
  EXPECT_EQ(refusal([&] { collide(V, F.transpose(), flat.starts); })[0], "triangles");
  F(5, 1) = -1;
  EXPECT_EQ(refusal([&] { collide(V, F, flat.starts); })[1],
            "triangle 5 names vertex -1 of " + std::to_string(rows));
}

}  // namespace
}  // namespace farcull
