// Points of the study "proximity": what promises loses nothing, what is spoiled is seen, and rows
// of shards are those of one run.
#include "experiments/studies/run_point.h"

#include "tests/lab/store.h"

namespace farcull {
namespace {

const SetCounts& sets_of(const PointResult& result) { return std::get<SetCounts>(result.counts); }
const DistanceCounts& distances_of(const PointResult& result) {
  return std::get<DistanceCounts>(result.counts);
}

TEST(Proximity, WhatPromisesLosesNothingAndADiagramThatIsNotWidenedDoes) {
  MeasurementContext lab("cpu");
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
  MeasurementContext lab("cpu");
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
  MeasurementContext lab("cpu");
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

}  // namespace
}  // namespace farcull
