// The model of docs/misses.md: its probability on random grids, and its prediction beside runs at
// several positions of the grid. The twins are other constants and another exponent of the
// resolution.
#include <gtest/gtest.h>

#include "experiments/method/miss_model.h"
#include "experiments/studies/run_point.h"

namespace farcull {
namespace {

struct Flat {
  double x[3], y[3];
  double area() const {
    return 0.5 * ((x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]));
  }
  bool holds(double px, double py) const {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if ((x[j] - x[i]) * (py - y[i]) - (y[j] - y[i]) * (px - x[i]) < 0) return false;
    }
    return true;
  }
};

// The mean error of the probability, over triangles of all sizes and shapes around a pixel.
double mean_error(double sharpness) {
  shapes::Random random(7);
  double error = 0;
  int count = 0;
  while (count < 400) {
    const double size = std::pow(10, random.in_cube(0.8).x() + 0.3);
    const double thin = std::pow(10, random.in_cube(1).x() - 1);
    const double turn = random.in_cube(3.14).x();
    Flat t;
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = size * random.in_cube(1);
      t.x[i] = p.x() * std::cos(turn) - thin * p.y() * std::sin(turn);
      t.y[i] = p.x() * std::sin(turn) + thin * p.y() * std::cos(turn);
    }
    if (t.area() < 0.02 || t.area() > 6) continue;
    const auto [left, right] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [low, high] = std::minmax({t.y[0], t.y[1], t.y[2]});
    constexpr int kSide = 12;  // positions of the grid along each axis
    int held = 0;
    for (int k = 0; k < kSide * kSide; ++k) {
      const double dx = (k % kSide + 0.5) / kSide, dy = (k / kSide + 0.5) / kSide;
      bool found = false;
      for (double y = std::floor(low) + dy - 1; y <= high && !found; ++y) {
        for (double x = std::floor(left) + dx - 1; x <= right && !found; ++x) found = t.holds(x, y);
      }
      held += found;
    }
    error += centre_probability(t.area(), right - left, high - low, 0, sharpness) -
             static_cast<double>(held) / (kSide * kSide);
    ++count;
  }
  return error / count;
}

TEST(MissModel, ItsConstantIsThatOfRandomTrianglesOnRandomGrids) {
  EXPECT_LT(std::abs(mean_error(kMissSharpness)), 0.015);
  // The twins.
  EXPECT_LT(mean_error(2), -0.03);
  EXPECT_GT(mean_error(12), 0.02);
}

double factor_between(double a, double b) { return std::max(a / b, b / a); }

TEST(MissModel, PredictsTheMeanOverPositionsOfTheGrid) {
  const Study& study = study_named("model");
  MeasurementContext lab("native");
  int judged = 0, twins = 0;
  for (const Point& point : study.grid({.quick = true})) {
    const auto& of = std::get<RunPoint>(point);
    const std::string scene = key_of(point).scene;
    const bool far = of.method == Method::far;
    const bool chosen = scene == "crowd:60"
                            ? !far || (of.radius->factor == 0.3 && of.resolution == 64)
                            : scene == "two-spheres" && of.method == Method::cullide;
    if (!chosen) continue;
    const PointResult result = study.measure(point, lab);
    const auto& counts = std::get<ForecastCounts>(result.counts);
    const double mean =
        static_cast<double>(counts.missed_in_all) / static_cast<double>(counts.positions);
    if (mean < 20) continue;
    ++judged;
    EXPECT_LT(factor_between(counts.expected, mean), 1.5) << describe(point);
    EXPECT_LE(counts.low, counts.expected);
    EXPECT_GE(counts.high, counts.expected);
    if (mean > 0.7 * static_cast<double>(counts.colliding) || far) continue;
    // The twins: pixels of another size, and a region that is sure to hold a centre too late.
    const Scene& drawn = open_scene(of.scene, lab);
    RunOptions options = options_of(of, lab);
    const auto forecast = [&](double sharpness) {
      const Plan planned = plan(drawn, options);
      return predict_misses(drawn, std::get<DrawPlan>(planned.work), options, lab.truth().pairs,
                            sharpness)
          ->missed;
    };
    EXPECT_GT(factor_between(forecast(1), mean), 1.25) << describe(point);
    options.resolution *= 4;
    EXPECT_GT(factor_between(forecast(kMissSharpness), mean), 1.5) << describe(point);
    ++twins;
  }
  EXPECT_GE(judged, 10);
  EXPECT_GE(twins, 3);
}

// Triangular bars at random, each an object of six triangles.
Scene bars(int count, double width, std::uint64_t seed) {
  shapes::Random random(seed);
  Scene out;
  out.name = "bars";
  for (int k = 0; k < count; ++k) {
    const Vec3 along = random.direction(), middle = random.in_cube(0.5);
    const Vec3 u = along.unitOrthogonal(), v = along.cross(u);
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    for (std::uint32_t i = 0; i < 6; ++i) {
      const double angle =
          2 * std::numbers::pi * (i % 3) / 3 + k;  // turned: no face is seen edge-on
      out.vertices.emplace_back(middle + (i < 3 ? -0.5 : 0.5) * along +
                                width / 2 * (std::cos(angle) * u + std::sin(angle) * v));
    }
    out.objects.push_back({std::to_string(k), static_cast<std::uint32_t>(out.triangles.size()), 6});
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t a = first + i, b = first + (i + 1) % 3;
      out.triangles.push_back({a, b, a + 3});
      out.triangles.push_back({b, b + 3, a + 3});
    }
  }
  out.source_face.assign(out.triangles.size(), 0);
  return out;
}

// The hidden parts along a bar are small and far apart. Taken as one region, they would hold a
// centre twice as surely as they do.
TEST(MissModel, PartsFarApartOnABarHoldCentresEachByItself) {
  MeasurementContext lab("native");
  double expected = 0, missed = 0, twin = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Scene scene = bars(100, 0.012, seed);
    RunOptions options{.method = Method::cullide, .resolution = 512};
    const Record record = run(scene, options, lab.session(), {});
    const std::vector<TrianglePair> truth = all_colliding_pairs(scene, {}, {}).pairs;
    missed += static_cast<double>(lacking(truth, record.collisions.all()));
    const auto forecast = [&] {
      return misses_of(scene, plan(scene, options)).predicted.value_or(MissPrediction{}).missed;
    };
    expected += forecast();
    options.resolution = 1024;
    twin += forecast();
  }
  EXPECT_GT(missed, 200);
  EXPECT_LT(factor_between(expected, missed), 1.25) << expected << " " << missed;
  EXPECT_GT(factor_between(twin, missed), 1.5);
}

// One triangle and twenty others that all cross it in a point. If it is culled, all are missed. The
// variance of independent pairs is at most missed * (1 - missed / 20), and 20 times this if all are
// missed together.
TEST(MissModel, PairsOfOneTriangleAreMissedTogether) {
  shapes::Random random(3);
  Scene scene{.name = "star"};
  for (std::uint32_t k = 0; k < 21; ++k) {
    const Vec3 p = random.in_cube(1), q = random.in_cube(1);
    scene.vertices.insert(scene.vertices.end(), {p, q, -p - q});
    scene.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  scene.objects = {{"one", 0, 1}, {"others", 1, 20}};
  const RunOptions options{.method = Method::cullide, .resolution = 3};
  const MissPrediction of = misses_of(scene, plan(scene, options)).predicted.value();
  ASSERT_EQ(of.colliding, 20u);
  EXPECT_GT(of.deviation * of.deviation, 5 * of.missed * (1 - of.missed / 20));
}

TEST(MissModel, SaysWhereItHasNoPrediction) {
  RunOptions options{.method = Method::cullide};
  EXPECT_EQ(why_unpredicted(options), "");
  options.conservative = true;
  EXPECT_EQ(why_unpredicted(options), "conservative rasterization");
  EXPECT_EQ(why_unpredicted({.method = Method::far}), "the method misses nothing");
  EXPECT_EQ(why_unpredicted({.method = Method::far, .radius = {.factor = 0.5}}), "");
  const Scene scene = make_builtin_scene("needles:60");
  const auto line = [&](const RunOptions& of) {
    return misses_line(misses_of(scene, plan(scene, of)));
  };
  EXPECT_EQ(line({.method = Method::boxes}), "");
  EXPECT_EQ(line(options), "misses     not predicted: conservative rasterization\n");
  EXPECT_TRUE(line({.method = Method::cullide}).find(" colliding pairs expected, ") !=
              std::string::npos);
}

}  // namespace
}  // namespace farcull
