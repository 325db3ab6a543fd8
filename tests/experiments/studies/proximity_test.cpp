// Points of the study "proximity": what promises loses nothing, what is spoiled is seen, and rows
// of shards are those of one run.
#include "experiments/studies/run_point.h"

#include <nlohmann/json.hpp>

#include "experiments/studies/run_studies.h"
#include "tests/lab/store.h"

namespace farcull {
namespace {

const SetCounts& sets_of(const PointResult& result) { return std::get<SetCounts>(result.counts); }
const DistanceCounts& distances_of(const PointResult& result) {
  return std::get<DistanceCounts>(result.counts);
}

TEST(Proximity, WhatPromisesLosesNothingAndADiagramThatIsNotWidenedDoes) {
  Lab lab("cpu");
  const ClusteredScene scene{.ratio = 16, .seed = 3};
  for (const NeighbourPoint& point :
       {NeighbourPoint{.scene = scene, .method = NeighbourMethod::boxes},
        NeighbourPoint{.scene = scene, .method = NeighbourMethod::trees},
        NeighbourPoint{
            .scene = scene, .method = NeighbourMethod::voronoi_reliable, .resolution = 64}}) {
    const PointResult result = measure_neighbours(point, lab);
    EXPECT_EQ(sets_of(result).sizes.with_nearest, 202u) << describe(Point(point));
    EXPECT_EQ(sets_of(result).sizes.missed, 0u) << describe(Point(point));
    EXPECT_EQ(sets_of(result).sizes.missed_pairs, 0u) << describe(Point(point));
    EXPECT_TRUE(sets_of(result).promises);
    EXPECT_FALSE(breaks_promise(stored(result)));
  }
  // The twin.
  const PointResult narrow = measure_neighbours({.scene = scene,
                                                 .method = NeighbourMethod::voronoi_reliable,
                                                 .resolution = 64,
                                                 .widening = 0},
                                                lab);
  EXPECT_GT(sets_of(narrow).sizes.missed, 0u);
  EXPECT_FALSE(sets_of(narrow).promises);
  EXPECT_FALSE(breaks_promise(stored(narrow)));
  // If it promised, each of the two losses alone would break the promise.
  for (const bool objects : {true, false}) {
    SetCounts counts = sets_of(narrow);
    counts.promises = true;
    (objects ? counts.sizes.missed_pairs : counts.sizes.missed) = 0;
    EXPECT_TRUE(breaks_promise(stored({.counts = counts})));
  }
}

TEST(Proximity, ThePublishedDiagramLosesLessWithMoreCells) {
  Lab lab("cpu");
  const auto missed = [&](int cells) {
    return sets_of(measure_neighbours({.scene = ClusteredScene{.ratio = 64, .seed = 1},
                                       .method = NeighbourMethod::voronoi,
                                       .resolution = cells},
                                      lab))
        .sizes.missed;
  };
  const std::uint64_t coarse = missed(16), fine = missed(128);
  EXPECT_GT(coarse, fine);
  EXPECT_GT(fine, 0u);
}

const DistancePoint kNearest{.scene = NamedScene{"crowd:10"}, .contestant = "none"};

// `farcull distance`, spoiled by `spoil`.
DistancePeer liar(std::function<void(std::vector<PeerDistance>&)> spoil) {
  DistancePeer out = farcull_distances();
  out.name = "liar";
  out.run = [right = out.run, spoil = std::move(spoil)](
                const Scene& scene, const PeerQuestion& question, unsigned threads) {
    PeerDistances answer = right(scene, question, threads);
    spoil(answer.distances);
    return answer;
  };
  return out;
}

TEST(Proximity, APeerThatLiesShowsAnError) {
  Lab lab("cpu");
  const auto wrong = [](const PointResult& result) {
    return stored(result).counts["wrong"].get<std::uint64_t>();
  };
  for (const DistanceTask task : {DistanceTask::nearest, DistanceTask::objects}) {
    DistancePoint point = kNearest;
    point.task = task;
    const auto measured = [&](const DistancePeer& peer) {
      return measure_distances(point, peer, lab);
    };
    const PointResult honest = measured(liar([](auto&) {}));
    EXPECT_EQ(wrong(honest), 0u);
    EXPECT_EQ(distances_of(honest).errors.largest_relative, 0);
    EXPECT_GT(distances_of(honest).asked, 5u);
    const auto apart = [](std::vector<PeerDistance>& all) {
      return std::ranges::find_if(all, [](const PeerDistance& one) { return one.distance > 0; });
    };
    const PointResult by_an_ulp = measured(
        liar([&](auto& all) { apart(all)->distance = std::nextafter(apart(all)->distance, 9e9); }));
    EXPECT_EQ(wrong(by_an_ulp), 1u);
    EXPECT_GT(distances_of(by_an_ulp).errors.largest_relative, 0);
    EXPECT_LE(distances_of(by_an_ulp).errors.largest_relative, 0x1p-52);
    const PointResult touching = measured(liar([&](auto& all) { apart(all)->distance = 0; }));
    EXPECT_EQ(wrong(touching), 1u);
    EXPECT_EQ(distances_of(touching).errors.other_zero, 1u);
    const PointResult fewer = measured(liar([](auto& all) { all.pop_back(); }));
    EXPECT_EQ(wrong(fewer), 1u);
    EXPECT_EQ(distances_of(fewer).errors.lacking, 1u);
    EXPECT_FALSE(breaks_promise(stored(fewer))) << "it promises nothing";
    // The same by farcull would break its promise.
    DistancePeer ours = liar([](auto& all) { all.pop_back(); });
    ours.name = farcull_distances().name;
    EXPECT_TRUE(breaks_promise(stored(measured(ours))));
  }
}

TEST(Proximity, RefusesRunsThatDiffer) {
  Lab lab("cpu");
  const PointResult honest = measure_distances(kNearest, liar([](auto&) {}), lab),
                    lying =
                        measure_distances(kNearest, liar([](auto&all) { all.pop_back(); }), lab);
  EXPECT_NO_THROW(require_same(key_of(kNearest), honest, honest));
  const Error error = error_of([&] { require_same(key_of(kNearest), honest, lying); });
  EXPECT_TRUE(has_text(error.reason, "two runs of the same point differ"));
}

TEST(Proximity, LeavesOutWhatIsNotThereOrRefuses) {
  Lab lab("cpu");
  DistancePeer absent = liar([](auto&) {});
  absent.missing = "it was not found";
  EXPECT_EQ(measure_distances(kNearest, absent, lab).left_out, "it was not found");
  DistancePeer fastidious = liar([](auto&) {});
  fastidious.refuses = [](const Scene&) { return "it takes no crowds"; };
  EXPECT_EQ(measure_distances(kNearest, fastidious, lab).left_out, "it takes no crowds");
  EXPECT_THROW(measure_distances(kNearest, lab), std::logic_error) << "no contestant of that name";
}

TEST(Proximity, AsksEveryPeer) {
  std::set<std::string> asked;
  for (const Point& point : study_named("proximity").grid({.quick = true}))
    if (const auto* of = std::get_if<DistancePoint>(&point)) asked.insert(of->contestant);
  for (const DistancePeer& peer : distance_peers()) EXPECT_TRUE(asked.contains(peer.name));
  EXPECT_TRUE(asked.contains("farcull"));
}

// The study with few of its points.
Study few_points() {
  Study out = study_named("proximity");
  out.grid = [](const GridChoice& choice) -> std::vector<Point> {
    const NamedScene named{"crowd:10"};
    const MotionFrame frame{"crowd:10", 1, 3};
    const ClusteredScene drawn{.ratio = 16, .seed = choice.seed};
    return {NeighbourPoint{.scene = named, .method = NeighbourMethod::boxes},
            NeighbourPoint{.scene = named, .method = NeighbourMethod::trees, .repeat = 3},
            DistancePoint{.scene = named, .contestant = "farcull"},
            NeighbourPoint{.scene = frame, .method = NeighbourMethod::trees},
            NeighbourPoint{
                .scene = drawn, .method = NeighbourMethod::voronoi_reliable, .resolution = 32}};
  };
  return out;
}

TEST(Proximity, ShardsMakeTheUndividedResult) {
  const ScratchFolder whole, parts;
  run_studies(lab_request(whole.folder(), {few_points()}));
  for (int shard = 1; shard <= 2; ++shard) {
    StudiesRequest request = lab_request(parts.folder(), {few_points()});
    request.shard = {shard, 2};
    run_studies(request);
  }
  merge_stores(shard_files(parts.folder()), store_path(parts.folder()));
  EXPECT_EQ(difference(store_path(whole.folder()), store_path(parts.folder())), "");
  // Going on changes nothing, and a row holds what was measured.
  const StudiesSummary again = run_studies(lab_request(whole.folder(), {few_points()}, true));
  EXPECT_EQ(again.studies.at(0).measured, 0u);
  EXPECT_TRUE(again.failed.empty() && again.broken.empty());
  const StoredStudy rows =
      Store(store_path(whole.folder()), Store::Access::read).study("proximity");
  ASSERT_EQ(rows.rows.size(), 5u);
  Lab lab("cpu");
  const Measurement direct = stored(
      measure_neighbours({.scene = NamedScene{"crowd:10"}, .method = NeighbourMethod::boxes}, lab));
  EXPECT_EQ(rows.rows[0].measurement.counts->dump(), direct.counts->dump());
  EXPECT_EQ((*rows.rows[2].measurement.counts)["wrong"], 0);
  // The twin: another seed is another result.
  const ScratchFolder other;
  StudiesRequest seeded = lab_request(other.folder(), {few_points()});
  seeded.choice.seed = 2;
  run_studies(seeded);
  EXPECT_NE(difference(store_path(whole.folder()), store_path(other.folder())), "");
}

}  // namespace
}  // namespace farcull
