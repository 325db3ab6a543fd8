// The diagram computed slice by slice on the CPU: the bounds of its kernel for any rounding that
// GLSL allows, against rationals; both forms against their definitions.
#include "core/voronoi/voronoi.h"

#include "core/base/error.h"
#include "tests/lab/voronoi.h"
#include "tests/lab/voronoi_device.h"

namespace farcull {

// A float whose operations err as much as GLSL allows, each time another way.
namespace noisy {

class Float {
 public:
  Float() = default;
  Float(float x) : x_(x) {}  // NOLINT(google-explicit-constructor): kernels mix in literals
  float value() const { return x_; }

  static inline std::optional<rational::Random> random;

  friend Float operator+(Float a, Float b) { return rounded(double{a.x_} + double{b.x_}, 0); }
  friend Float operator-(Float a, Float b) { return rounded(double{a.x_} - double{b.x_}, 0); }
  friend Float operator*(Float a, Float b) { return rounded(double{a.x_} * double{b.x_}, 0); }
  friend Float operator/(Float a, Float b) { return rounded(double{a.x_} / double{b.x_}, 2.5); }
  friend bool operator<(Float a, Float b) { return a.x_ < b.x_; }
  friend bool operator>(Float a, Float b) { return a.x_ > b.x_; }
  friend bool operator<=(Float a, Float b) { return a.x_ <= b.x_; }
  friend bool operator>=(Float a, Float b) { return a.x_ >= b.x_; }
  friend Float min(Float a, Float b) { return a < b ? a : b; }
  friend Float max(Float a, Float b) { return a < b ? b : a; }
  friend Float abs(Float a) { return {std::abs(a.x_)}; }
  friend Float sqrt(Float a) { return rounded(std::sqrt(double{a.x_}), root_units); }

  static inline double root_units = 5;  // of the last place, by which a root may err

 private:
  // One of the floats that are allowed, most often one at the end of their range.
  static Float rounded(double exact, double units) {
    const double share = random->coin() ? (random->coin() ? 1 : -1) : random->uniform(-1, 1);
    const double moved = exact + share * units * 0x1p-23 * std::abs(exact);
    auto out = static_cast<float>(moved);
    if (units == 0 && static_cast<double>(out) != moved && random->coin()) {
      const bool above = static_cast<double>(out) > moved;  // the float on the other side
      out = std::nextafter(out, above ? -HUGE_VALF : HUGE_VALF);
    }
    if (std::abs(out) < 0x1p-126f) out = 0;
    return {out};
  }

  float x_ = 0;
};

#define float Float
#include "core/voronoi/voronoi_bounds.glsl"
#undef float

}  // namespace noisy

namespace {

using lab::neighbours_scene;
using rational::Q;

template <class Step, class Number>
Step step_of(const GridPoint& p) {
  return {Number(p[0]), Number(p[1]), Number(p[2])};
}

struct Bounds {
  float computed = 0, lower = 0, upper = 0;
  bool root_fails = false;
};

Bounds noisy_bounds(const GridPoint& c, const GridTriangle& t, float error) {
  using Step = noisy::FarStep;
  const auto step = [](const GridPoint& p) { return step_of<Step, noisy::Float>(p); };
  noisy::Float computed, lower, upper;
  Bounds out;
  noisy::far_distance(step(c), step(t.corners[0]), step(t.corners[1]), step(t.corners[2]), error,
                      computed, lower, upper, out.root_fails);
  out.computed = computed.value();
  out.lower = lower.value();
  out.upper = upper.value();
  return out;
}

struct WrongBounds {
  int wrong = 0, roots = 0;
  double most = 0;  // of the difference of computed and exact distances, in units of v N
};
WrongBounds wrong_bounds(int count, float error_share) {
  rational::Random random(4);
  noisy::Float::random.emplace(5);
  WrongBounds out;
  for (int i = 0; i < count; ++i) {
    const int longest = 1 << random.below(15);
    const GridTriangle triangle = lab::drawn_triangle(random, static_cast<float>(longest));
    GridPoint point;
    for (float& x : point) x = static_cast<float>(random.below(longest)) + 0.5f;
    const Bounds d = noisy_bounds(point, triangle, error_share * voronoi_bounds::error(longest));
    const Q exact = lab::squared_distance(point, triangle);
    const Q lower = static_cast<double>(d.lower), upper = static_cast<double>(d.upper);
    out.wrong += lower * lower > exact || upper * upper < exact;
    out.roots += d.root_fails;
    out.most =
        std::max(out.most, std::abs(static_cast<double>(d.computed) - std::sqrt(exact.get_d())) /
                               (0x1p-23 * longest));
  }
  return out;
}

TEST(VoronoiBounds, HoldForAnyRounding) {
  const WrongBounds found = wrong_bounds(trials(30'000), 1);
  EXPECT_EQ(found.wrong, 0);
  EXPECT_EQ(found.roots, 0);
  EXPECT_GT(found.most, 1);
  RecordProperty("most", std::to_string(found.most));
}
// Twins: without the error, and with a root that is worse than allowed.
TEST(VoronoiBounds, FailWithoutTheError) { EXPECT_GT(wrong_bounds(trials(30'000), 0).wrong, 0); }
TEST(VoronoiBounds, SayWhereTheRootIsWorse) {
  noisy::Float::root_units = 40;
  const WrongBounds found = wrong_bounds(trials(10'000), 1);
  noisy::Float::root_units = 5;
  EXPECT_GT(found.roots, 0);
}

// ---- both forms ----

TEST(VoronoiDevice, PublishedIsThatOfAllCells) {
  const auto device = std::make_unique<lab::CpuVoronoiDevice>(0);
  lab::SliceCounts counts;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(trials(80)); ++seed) {
    const Scene scene = neighbours_scene(seed);
    for (const int resolution : {1, 2, 7, 16, 21})
      lab::compare_with_all_cells(scene, resolution, *device, counts);
    ASSERT_EQ(counts.wrong, 0u) << "seed " << seed;
  }
  EXPECT_GT(counts.cells, 40'000u / 8);
  EXPECT_GT(counts.same, counts.cells * 9 / 10);
}

TEST(VoronoiDevice, ReliableLosesNone) {
  const auto device = std::make_unique<lab::CpuVoronoiDevice>(0);
  const lab::SliceLosses losses = lab::losses_of_reliable(*device, trials(1000), 1);
  EXPECT_GT(losses.pairs, 2000u / 8);
  EXPECT_EQ(losses.lost, 0u);
  EXPECT_EQ(losses.upper, 0u);
}
// Twins: without the widening, and with half of it.
TEST(VoronoiDevice, ReliableLosesSomeWithoutTheWidening) {
  const auto device = std::make_unique<lab::CpuVoronoiDevice>(0);
  EXPECT_GT(lab::losses_of_reliable(*device, trials(500), 0).lost, 0u);
}
TEST(VoronoiDevice, ReliableLosesSomeWithHalfTheWidening) {
  const auto device = std::make_unique<lab::CpuVoronoiDevice>(0);
  EXPECT_GT(lab::losses_of_reliable(*device, trials(500), 0.5).lost, 0u);
}

TEST(VoronoiDevice, DoesNotDependOnThreads) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Scene scene = lab::random_scene(seed);
    const VoronoiOptions one{.resolution = 20, .threads = 1}, more{.resolution = 20, .threads = 3};
    const auto first = std::make_unique<lab::CpuVoronoiDevice>(1),
               other = std::make_unique<lab::CpuVoronoiDevice>(3);
    EXPECT_EQ(voronoi_neighbours(scene, one, *first).objects,
              voronoi_neighbours(scene, more, *other).objects);
    EXPECT_EQ(reliable_neighbours(scene, one, *first).triangles,
              reliable_neighbours(scene, more, *other).triangles);
  }
}

TEST(VoronoiDevice, TakesScenesWithoutNeighbours) {
  const auto device = std::make_unique<lab::CpuVoronoiDevice>(1);
  const std::array<Vec3, 3> point = {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)};
  for (const auto& objects : std::vector<std::vector<std::vector<std::array<Vec3, 3>>>>{
           {}, {{}}, {{}, {}}, {{point}}, {{point}, {}}}) {
    const Scene scene = lab::scene_of(objects);
    EXPECT_TRUE(reliable_neighbours(scene, {}, *device).triangles.empty());
    EXPECT_TRUE(voronoi_neighbours(scene, {}, *device).objects.empty());
  }
  const Scene two = lab::scene_of({{point}, {}, {point}});
  EXPECT_EQ(reliable_neighbours(two, {}, *device).triangles, (std::vector<TrianglePair>{{0, 1}}));
  EXPECT_EQ(voronoi_neighbours(two, {}, *device).objects, (std::vector<ObjectPair>{{0, 2}}));
}

}  // namespace
}  // namespace farcull
