#include "experiments/measure/bench.h"

#include <nlohmann/json.hpp>

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/scenes.h"

namespace farcull {
namespace {

// Two triangles in each object, so that no tree is a single leaf; objects stand one above the
// other, each twice as far from the one below as that is from its own.
Scene tower() {
  std::vector<std::vector<std::array<Vec3, 3>>> objects;
  for (const double z : {0.0, 1.0, 3.0, 7.0}) {
    objects.push_back({{Vec3(0, 0, z), Vec3(1, 0, z), Vec3(0, 1, z)},
                       {Vec3(1, 1, z), Vec3(1, 0, z), Vec3(0, 1, z)}});
  }
  return lab::scene_of(objects);
}

using Distances = std::vector<PeerDistance>;

Distances rounded_to_float(Distances all) {
  for (PeerDistance& d : all) d.distance = static_cast<float>(d.distance);
  return all;
}

TEST(DistancePeers, FindWhatCanBeReadOffATower) {
  const Distances all = {{0, 1, 1}, {0, 2, 3}, {0, 3, 7}, {1, 2, 2}, {1, 3, 6}, {2, 3, 4}};
  const Distances near = {{0, 1, 1}, {1, 2, 2}, {0, 2, 3}};
  const Distances nearest = {{0, 1, 1}, {1, 0, 1}, {2, 1, 2}, {3, 2, 4}};
  const auto sorted = [](Distances some) {
    std::ranges::sort(some, [](const PeerDistance& x, const PeerDistance& y) {
      return std::tie(x.a, x.b) < std::tie(y.a, y.b);
    });
    return some;
  };
  for (const DistancePeer& peer : distance_peers()) {
    if (!peer.missing.empty()) continue;
    for (const unsigned threads : {1u, 3u}) {
      SCOPED_TRACE(peer.name + ", threads " + std::to_string(threads));
      const auto ask = [&](DistanceTask task, double within) {
        return peer.run(tower(), {.task = task, .within = within}, threads).distances;
      };
      constexpr double kAll = std::numeric_limits<double>::infinity();
      EXPECT_TRUE(rounded_to_float(ask(DistanceTask::objects, kAll)) == all);
      EXPECT_TRUE(rounded_to_float(ask(DistanceTask::objects, 3.5)) == sorted(near));
      EXPECT_TRUE(rounded_to_float(ask(DistanceTask::nearest, kAll)) == nearest);
      EXPECT_EQ(ask(DistanceTask::nearest, 1.5).size(), 2u);
    }
  }
}

bool from_vertices_alone(const DistancePeer& peer) { return peer.name == "embree-points"; }

TEST(DistancePeers, CallObjectsThatMeetZero) {
  const Scene scene = make_builtin_scene("two-spheres");
  for (const DistancePeer& peer : distance_peers()) {
    if (!peer.missing.empty() || from_vertices_alone(peer)) continue;
    const PeerDistances answer = peer.run(scene, {}, 1);
    ASSERT_EQ(answer.distances.size(), 1u) << peer.name;
    EXPECT_EQ(answer.distances[0].distance, 0) << peer.name;
  }
}

// Where the nearest points are inside two edges that cross at a distance of 1, and where triangles
// pierce each other, the distance from vertices is larger. Where a vertex is nearest it is right.
TEST(DistancePeers, FromVerticesAloneTheyBoundFromAbove) {
  const auto wedge = [](double z, double up, bool turned) {
    const auto at = [turned](double x, double y, double w) {
      return turned ? Vec3(y, x, w) : Vec3(x, y, w);
    };
    return std::vector<std::array<Vec3, 3>>{{at(-2, 0, z), at(2, 0, z), at(0, 0, z + up)},
                                            {at(-2, 0, z), at(0, 0, z + up), at(-2, 0, z + up)}};
  };
  const Scene edges = lab::scene_of({wedge(0, -3, false), wedge(1, 3, true)});
  const Scene pierced = lab::scene_of({wedge(0, 3, false), wedge(1, -3, true)});
  const Scene vertex = lab::scene_of({wedge(0, 3, false), wedge(7, -3, true)});
  for (const DistancePeer& peer : distance_peers()) {
    if (!peer.missing.empty()) continue;
    SCOPED_TRACE(peer.name);
    const auto asked = [&peer](const Scene& scene) {
      const Distances all = peer.run(scene, {}, 1).distances;
      return all.size() == 1 ? static_cast<float>(all[0].distance) : -1.0F;
    };
    EXPECT_EQ(asked(vertex), 1);
    if (from_vertices_alone(peer)) {
      EXPECT_EQ(asked(edges), std::sqrt(5.0F)) << "from an end of one edge to the other edge";
      EXPECT_GT(asked(pierced), 0);
      EXPECT_FALSE(peer.comparable);
    } else {
      EXPECT_EQ(asked(edges), 1);
      EXPECT_EQ(asked(pierced), 0);
    }
  }
}

// The fastest peer is one that answers the same question in doubles.
TEST(DistanceBench, ABoundOrFloatsAreNotCalledTheFastestPeer) {
  const auto fastest = [](const char* peers) {
    const DistanceBenchResult result = bench_distances(tower(), {.peers = peers, .repeat = 1});
    return result.fastest_peer ? result.rows[*result.fastest_peer].name : "none";
  };
  EXPECT_EQ(fastest("embree-points,fcl-float"), "none");
  EXPECT_EQ(fastest("embree-points,cgal-aabb,fcl-float"), "cgal-aabb");
}

TEST(DistancePeers, RefuseDegenerateTriangles) {
  const Scene scene = make_builtin_scene("degenerate");
  for (const DistancePeer& peer : distance_peers()) {
    if (!peer.missing.empty()) continue;
    EXPECT_NE(peer.refuses(scene), "") << peer.name;
  }
}

TEST(DistanceBench, EachErrorIsCountedAsWhatItIs) {
  const Distances exact = {{0, 1, 1}, {0, 2, 0}, {1, 2, 4}, {1, 3, 8}};
  EXPECT_EQ(errors_of(DistanceTask::objects, exact, exact).exact, 4u);
  EXPECT_EQ(errors_of(DistanceTask::objects, exact, exact).largest_relative, 0);
  // One lacks, one is not asked for, one is called apart, one is off by an eighth.
  const Distances answer = {{0, 2, 1e-9}, {0, 3, 5}, {1, 2, 4.5}, {1, 3, 8}};
  const DistanceErrors errors = errors_of(DistanceTask::objects, answer, exact);
  EXPECT_EQ(errors.answers, 4u);
  EXPECT_EQ(errors.lacking, 1u);
  EXPECT_EQ(errors.beyond, 1u);
  EXPECT_EQ(errors.other_zero, 1u);
  EXPECT_EQ(errors.exact, 1u);
  EXPECT_EQ(errors.largest_relative, 0.125);
  EXPECT_EQ(errors_of(DistanceTask::objects, {}, exact).lacking, 4u);
  EXPECT_EQ(errors_of(DistanceTask::objects, exact, {}).beyond, 4u);
}

TEST(DistanceBench, AnotherNearestObjectIsAnErrorIfItIsNotAsNear) {
  const Distances exact = {{0, 1, 1}, {1, 0, 1}, {2, 1, 2}};
  EXPECT_EQ(errors_of(DistanceTask::nearest, {{0, 1, 1}, {1, 0, 1}, {2, 0, 2}}, exact).other_object,
            0u);
  const DistanceErrors errors =
      errors_of(DistanceTask::nearest, {{0, 1, 1}, {1, 0, 1}, {2, 0, 2.5}}, exact);
  EXPECT_EQ(errors.other_object, 1u);
  EXPECT_EQ(errors.largest_relative, 0.25);
}

TEST(DistanceBench, OursIsExactAndTheFastestPeerIsNamed) {
  DistanceBenchOptions options{.repeat = 1};
  for (const DistanceTask task : {DistanceTask::objects, DistanceTask::nearest}) {
    options.question.task = task;
    const DistanceBenchResult result = bench_distances(tower(), options);
    ASSERT_FALSE(result.rows.empty());
    EXPECT_FALSE(result.rows[0].peer);
    for (const DistanceBenchRow& row : result.rows) {
      EXPECT_EQ(row.errors.answers, task == DistanceTask::objects ? 6u : 4u) << row.name;
      EXPECT_EQ(row.errors.lacking, 0u) << row.name;
    }
    EXPECT_EQ(result.rows[0].errors.exact, result.rows[0].errors.answers);
    const auto json = to_json(tower(), options, result);
    EXPECT_EQ(json["rows"].size(), result.rows.size());
    EXPECT_TRUE(has_text(distance_bench_table(tower(), options, result), "farcull"));
  }
}

TEST(DistanceBench, AsksNobodyAboutAnObjectAndItself) {
  Scene scene = tower();
  for (Object& object : scene.objects) object.self = true;
  for (const DistanceBenchRow& row : bench_distances(scene, {.repeat = 1}).rows)
    EXPECT_EQ(row.errors.answers, 6u) << row.name;
}

TEST(DistanceBench, RefusesWhatItCannotMeasure) {
  DistanceBenchOptions options{.peers = "nope"};
  EXPECT_EQ(error_of([&] { bench_distances(tower(), options); }).where, "--peers");
  options = {.repeat = 0};
  EXPECT_EQ(error_of([&] { bench_distances(tower(), options); }).where, "--repeat");
}

}  // namespace
}  // namespace farcull
