// Each pair of triangles whose boxes overlap belongs to exactly one tile, and both triangles meet
// that tile (docs/tiles.md). Twins with one word of the definitions changed lose or repeat pairs.
#include "experiments/tiles/run_tile.h"

#include "core/base/random.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

// The definitions, as they are or changed.
struct Rules {
  std::function<bool(const Slab&, const Box&)> meets = farcull::meets;
  std::function<bool(const Slab&, double)> holds = farcull::holds;
  std::function<double(double, double)> place = [](double a, double b) { return std::max(a, b); };
};

struct Faults {
  int lost = 0, repeated = 0;
};

// Boxes and cuts on whole numbers, which are equal often.
Faults faults_of(const Rules& rules) {
  RandomNumbers random(1);
  Faults out;
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<Box> boxes(4);
    for (Box& box : boxes) {
      for (int i = 0; i < 3; ++i) {
        box.lo[i] = random.below(5);
        box.hi[i] = box.lo[i] + random.below(3);
      }
    }
    std::vector<double> cuts(random.below(std::size_t{5}));
    for (double& cut : cuts) cut = random.below(6);
    std::ranges::sort(cuts);
    const int axis = random.below(3);
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (!overlap(boxes[a], boxes[b])) continue;
        int times = 0;
        for (std::size_t k = 0; k <= cuts.size(); ++k) {
          const Slab slab = slab_of(axis, cuts, k);
          times += rules.meets(slab, boxes[a]) && rules.meets(slab, boxes[b]) &&
                   rules.holds(slab, rules.place(boxes[a].lo[axis], boxes[b].lo[axis]));
        }
        out.lost += times == 0;
        out.repeated += times > 1;
      }
    }
  }
  return out;
}

TEST(Tiles, EachPairBelongsToOneTile) {
  const Faults faults = faults_of({});
  EXPECT_EQ(faults.lost, 0);
  EXPECT_EQ(faults.repeated, 0);
}

TEST(Tiles, ATriangleThatEndsOnTheCutMustNotBeDropped) {
  const Faults faults = faults_of({.meets = [](const Slab& slab, const Box& box) {
    return box.lo[slab.axis] < slab.to && box.hi[slab.axis] > slab.from;
  }});
  EXPECT_GT(faults.lost, 0);
}

TEST(Tiles, TilesMustNotHoldBothEnds) {
  const Faults faults = faults_of(
      {.meets =
           [](const Slab& slab, const Box& box) {
             return box.lo[slab.axis] <= slab.to && box.hi[slab.axis] >= slab.from;
           },
       .holds = [](const Slab& slab, double at) { return at >= slab.from && at <= slab.to; }});
  EXPECT_EQ(faults.lost, 0);
  EXPECT_GT(faults.repeated, 0);
}

TEST(Tiles, ThePlaceOfAPairIsTheLaterBeginning) {
  const Faults faults = faults_of({.place = [](double a, double b) { return std::min(a, b); }});
  EXPECT_GT(faults.lost, 0);
}

TEST(Tiles, TheFirstAndTheLastTileHaveNoEnd) {
  const std::vector<double> cuts = {1, 1, 2};
  EXPECT_TRUE(holds(slab_of(0, cuts, 0), -HUGE_VAL));
  EXPECT_FALSE(holds(slab_of(0, cuts, 0), 1));
  EXPECT_FALSE(holds(slab_of(0, cuts, 1), 1));  // between equal cuts lies nothing
  EXPECT_TRUE(holds(slab_of(0, cuts, 2), 1));
  EXPECT_TRUE(holds(slab_of(0, cuts, 3), 1e308));
}

}  // namespace
}  // namespace farcull
