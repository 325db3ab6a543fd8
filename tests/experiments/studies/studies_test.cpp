// What every study promises of its grid.
#include "experiments/record/stage_words.h"

#include "experiments/studies/run_point.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

// Empty, or what is wrong with a grid.
std::string fault_of(const std::vector<PointKey>& points, bool in_turns = false) {
  if (points.empty()) return "no points";
  std::set<PointKey> seen;
  std::set<std::string> scenes;
  std::string scene;
  for (const PointKey& point : points) {
    if (!seen.insert(point).second) return "twice: " + describe(point);
    if (point.method.empty()) return "no method: " + describe(point);
    if (!in_turns && point.scene != scene && !scenes.insert(point.scene).second)
      return "not together: " + point.scene;
    scene = point.scene;
  }
  return "";
}

class EveryStudy : public testing::TestWithParam<std::string> {
 protected:
  const Study& study() const { return study_named(GetParam()); }
};

TEST_P(EveryStudy, HasAGridOfDifferentPointsWithScenesTogether) {
  for (const bool quick : {false, true}) {
    EXPECT_EQ(fault_of(keys_of(study().grid({.quick = quick, .seed = 1})), study().campaign), "")
        << (quick ? "quick" : "full");
  }
}

TEST_P(EveryStudy, HasTheSameGridTwice) {
  for (const bool quick : {false, true}) {
    for (const std::uint64_t seed : {1, 7}) {
      const GridChoice choice{.quick = quick, .seed = seed};
      EXPECT_EQ(keys_of(study().grid(choice)), keys_of(study().grid(choice)));
    }
  }
}

TEST_P(EveryStudy, HasFewerPointsWhereQuick) {
  // The same questions to the small suite, and the same methods on a smaller scene.
  if (study().name == "libraries" || study().name == "headline") {
    EXPECT_EQ(study().grid({.quick = true}).size(), study().grid({.quick = false}).size());
    return;
  }
  EXPECT_LT(study().grid({.quick = true}).size(), study().grid({.quick = false}).size());
}

// Every figure and table needs the same kinds of points.
TEST_P(EveryStudy, HasEveryMethodWhereQuickToo) {
  const auto methods = [&](bool quick) {
    std::set<std::tuple<std::string, std::string, std::string>> out;
    for (const PointKey& point : keys_of(study().grid({.quick = quick})))
      if (!point.method.starts_with("s-cullide"))
        out.insert({point.method, point.offset, column_text(point.depth_mode)});
    return out;
  };
  EXPECT_EQ(methods(true), methods(false));
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const Study& study : studies()) out.push_back(study.name);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Studies, EveryStudy, testing::ValuesIn(names()), [](const auto& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// The twin of the tests of grids: each fault is seen.
TEST(Studies, AreRefusedWithAFaultyGrid) {
  std::vector<PointKey> good = keys_of(study_named("accuracy").grid({.quick = true}));
  ASSERT_EQ(fault_of(good), "");
  ASSERT_NE(good.front().scene, good.back().scene);
  std::vector<PointKey> twice = good;
  twice.insert(twice.begin(), good.front());
  EXPECT_EQ(fault_of(twice), "twice: " + describe(good.front()));
  std::vector<PointKey> apart = good;
  std::swap(apart.front(), apart.back());
  EXPECT_TRUE(fault_of(apart).starts_with("not together: "));
  EXPECT_EQ(fault_of({}), "no points");
  EXPECT_TRUE(fault_of({PointKey{}}).starts_with("no method"));
}

// What the figure of the study is about must be among its points.
TEST(Accuracy, ComparesEveryMethodFrom64To4096) {
  for (const bool quick : {false, true}) {
    std::map<std::string, std::set<int>> resolutions;
    for (const PointKey& point : keys_of(study_named("accuracy").grid({.quick = quick})))
      if (point.radius != kPublishedRadius)
        resolutions[point.method + " " + point.offset].insert(point.resolution);
    std::set<int> powers = {64, 128, 256, 512, 1024, 2048, 4096};
    for (const char* name : {"cullide ", "quick-cullide ", "far obb", "far exact"})
      EXPECT_EQ(resolutions[name], powers) << name;
    EXPECT_GE(resolutions["s-cullide "].size(), quick ? 5u : powers.size());
    EXPECT_EQ(resolutions["boxes "], std::set<int>{0});
  }
}

TEST(ErrorTime, HasEveryLibraryOnEveryScene) {
  for (const bool quick : {false, true}) {
    std::map<std::string, std::set<std::string>> methods;
    for (const PointKey& point : keys_of(study_named("error-time").grid({.quick = quick})))
      methods[point.scene].insert(point.method);
    for (const auto& [scene, of] : methods)
      for (const char* peer :
           {"cgal-boxes", "cgal-aabb", "embree-low", "fcl-double", "fcl-float", "ode-trimesh"})
        EXPECT_TRUE(of.contains(peer)) << peer << " on " << scene;
  }
}

// ---- That a point's row depends on the point alone, not on what the lab measured before, nor on
// which of several runs was looked at.

PointResult measured(MeasurementContext& lab, const std::string& scene, Method method) {
  return measure_run(plain_point(NamedScene{scene}, method), lab);
}

TEST(RunPoint, DoesNotDependOnEarlierRunsOfTheSession) {
  MeasurementContext fresh("cpu");
  const PointResult first = measured(fresh, "far-apart", Method::boxes);
  MeasurementContext used("cpu");
  measured(used, "two-spheres", Method::boxes);
  const PointResult later = measured(used, "far-apart", Method::boxes);
  EXPECT_EQ(to_columns(first.counts), to_columns(later.counts));
  EXPECT_EQ(first.device, later.device);
}

TEST(RunPoint, StartsICollideWithoutListsEachTimeWhereNothingMoves) {
  MeasurementContext lab("cpu");
  const auto stages_of = [&](const RunPoint& point) {
    Record record;
    measure_run(point, lab, &record);
    std::string out;
    for (const Stage& stage : record.trace) out += name_of(stage) + ": " + reason_of(stage) + "\n";
    return out;
  };
  const RunPoint still = plain_point(NamedScene{"crowd"}, Method::i_collide);
  const std::string cold = stages_of(still);
  EXPECT_EQ(stages_of(still), cold);
  // The lists are those of the run just before, else nothing is there to be forgotten.
  EXPECT_EQ(lab.session().sweep().find(lab.current()).counts.sorts, 0u);
  EXPECT_EQ(stages_of(still), cold);
  // The twin: a point of a motion keeps the lists.
  RunPoint moving = still;
  moving.scene = MotionFrame{"crowd", 0, 2};
  const std::string first = stages_of(moving);
  EXPECT_NE(stages_of(moving), first);
  EXPECT_THROW(measure_run(repeated(moving, 2), lab), std::logic_error);
}

// The values of the study, family by family, with fewer cells.
std::map<std::string, std::vector<ContactCells>> contact_families(bool quick) {
  std::map<std::string, std::vector<ContactCells>> out;
  std::string last;
  for (const Point& point : stability_study().grid({.quick = quick})) {
    const auto* run = std::get_if<RunPoint>(&point);
    const auto* cells = run != nullptr ? std::get_if<ContactCells>(&run->scene) : nullptr;
    if (cells == nullptr || last == cells->family + cells->value) continue;
    last = cells->family + cells->value;
    out[cells->family].push_back({cells->family, 18, cells->value});
  }
  return out;
}

constexpr std::uint64_t kAtRisk = 18 * 18 / 6;  // cells with a contact that only the budget finds

RunCounts stability_counts(const RunPoint& point, MeasurementContext& lab) {
  return std::get<RunCounts>(stability_study().measure(point, lab).counts);
}

// The first, the middle and the last value of every family: FAR culls and misses none. The twin
// with 0.9 of the radius misses exactly the pairs at risk, as many at every value. A method without
// a radius has nothing at risk of it, and without a view nothing is drawn.
TEST(ContactCells, AreFoundByTheBudgetAndAsManyLostBySmallerBallsAtEveryValue) {
  MeasurementContext lab("native");
  for (const auto& [family, values] : contact_families(true)) {
    EXPECT_EQ(values.size(), 3u) << family;
    for (const ContactCells& cells : values) {
      SCOPED_TRACE(family + ", " + cells.value);
      const RunPoint point = far_point(cells, "obb", kBudgetRadius, kCellsResolution);
      const RunCounts far = stability_counts(point, lab);
      // At each of two corners of the box every two objects meet, in triangles that touch.
      const std::uint64_t corners = far.objects * (far.objects - 1);
      const std::uint64_t pairs = family == "gap" ? 0 : family == "stack" ? 3 : 1;
      EXPECT_EQ(far.varying->varying, pairs * 2 * kAtRisk);
      EXPECT_EQ(far.colliding, far.varying->varying + kAtRisk + corners);
      EXPECT_EQ(far.missed, 0u);
      EXPECT_GT(far.views_used, 0u);
      EXPECT_EQ(far.left_by_boxes, far.triangles) << "boxes of objects cull nothing here";
      EXPECT_LE(10 * far.kept_triangles, 7 * far.triangles) << "at least 30 % are culled";
      EXPECT_EQ(far.at_risk, kAtRisk + corners);
      EXPECT_GE(far.at_risk_bare.value_or(0), kAtRisk + corners);
      RunPoint smaller = point;
      smaller.radius = RadiusRule{.factor = 0.9};
      const RunCounts twin = stability_counts(smaller, lab);
      EXPECT_EQ(twin.missed, kAtRisk + corners);
      EXPECT_EQ(twin.varying->missed_varying, 0u);
      const RunCounts found = stability_counts(plain_point(cells, Method::boxes), lab);
      EXPECT_EQ(found.missed, 0u);
      EXPECT_EQ(found.views_used, 0u);
      EXPECT_FALSE(found.at_risk.has_value());
    }
  }
}

// Where CULLIDE begins to fail, a curve shows it: it misses almost none of the contacts that vary
// at the first value, almost all at the last, and hardly ever fewer at a value than at the one
// before. Only the sheets of a stack, below a step of the depth buffer, have equal depths and keep
// each other.
TEST(ContactCells, AreMissedByCullideMoreAndMore) {
  MeasurementContext lab("native");
  for (const auto& [family, values] : contact_families(false)) {
    std::vector<double> missed;  // per cent
    for (const ContactCells& cells : values) {
      // Sheets nearer than a step of depth have equal depths, which hide each other, so CULLIDE
      // finds them again. The range of depths is that of the window; floats below 1 have 24 bits.
      if (family == "stack" && std::stod(cells.value) < kCellsResolution * 0x1p-24) continue;
      const RunCounts counts =
          stability_counts(cullide_point(cells, Method::cullide, kCellsResolution), lab);
      if (counts.varying->varying == 0) continue;
      missed.push_back(100.0 * static_cast<double>(counts.varying->missed_varying) /
                       static_cast<double>(counts.varying->varying));
    }
    if (missed.empty()) {
      EXPECT_EQ(family, "gap");
      continue;
    }
    SCOPED_TRACE(family + ": " + fmt::format("{}", fmt::join(missed, " ")));
    EXPECT_LE(missed.front(), 2);
    const bool responds = family != "offset" && family != "scale";
    EXPECT_TRUE(responds ? missed.back() >= 95 : missed.back() <= 2);
    for (std::size_t i = 1; i < missed.size(); ++i) EXPECT_GE(missed[i], missed[i - 1] - 3);
  }
}

// The twin: each way in which two runs may differ is refused, and said.
TEST(RunPoint, RefusesRunsThatDiffer) {
  const PointKey point = key_of(plain_point(NamedScene{"crowd"}, Method::boxes));
  const PointResult good{.counts = RunCounts{}, .answer = 7, .device = "cpu"};
  EXPECT_NO_THROW(require_same(point, good, good));
  const auto said = [&](const PointResult& other) -> std::string {
    try {
      require_same(point, good, other);
    } catch (const Error& error) {
      EXPECT_EQ(error.where, describe(point));
      return error.reason;
    }
    return "nothing";
  };
  PointResult other = good;
  std::get<RunCounts>(other.counts).missed = 3;
  EXPECT_TRUE(has_text(said(other), "missed 0 and 3"));
  other = good;
  std::get<RunCounts>(other.counts).drawn = DrawnCounts{.queries = 7};
  EXPECT_TRUE(has_text(said(other), "queries none and 7"));
  other = good;
  other.answer = 8;
  EXPECT_TRUE(has_text(said(other), "the pairs themselves"));
  other = good;
  other.device = "another";
  EXPECT_TRUE(has_text(said(other), "device cpu and another"));
}

// ---- Placements stand apart in every view, collide as they are meant to, and are missed where the
// ball is far too small.

TEST(Placements, LengthsOfIntersections) {
  const std::array<Vec3, 3> flat = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const std::array<Vec3, 3> through = {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(-9, 1, 0)};
  EXPECT_NEAR(intersection_length(flat, through), 1, 1e-12);
  EXPECT_EQ(intersection_length(through, flat), intersection_length(flat, through));
  std::array<Vec3, 3> above = through;
  for (Vec3& p : above) p[2] += 3;
  EXPECT_EQ(intersection_length(flat, above), 0) << "the twin: they do not meet";
}

TEST(Placements, AreTheSameForASeed) {
  const PatchSource source(make_builtin_scene("random-soup"));
  const auto vertices = [&](std::uint64_t seed) {
    const PlacementPoint point{
        .from = "random-soup", .grazing = true, .side = 0.25, .resolution = 64};
    return source.place(point, {}, 20, seed).scene.vertices;
  };
  EXPECT_EQ(vertices(5), vertices(5));
  EXPECT_NE(vertices(5), vertices(6));
}

PlacementCounts measured(const RadiusRule& radius, int bits) {
  MeasurementContext lab("native");
  const PlacementPoint point{.from = "random-soup",
                             .grazing = true,
                             .side = 1,
                             .placements = 500,
                             .subpixel_bits = bits,
                             .radius = radius,
                             .resolution = 256};
  return std::get<PlacementCounts>(measure_placements(point, lab).counts);
}

TEST(Placements, AreMissedOnlyBelowTheBudget) {
  for (const int bits : {0, 4, 8}) {
    const PlacementCounts budget = measured({}, bits);
    EXPECT_EQ(budget.placements, 500u);
    EXPECT_GT(budget.colliding_placements, 400u);
    EXPECT_TRUE(budget.promises);
    EXPECT_EQ(budget.missed, 0u) << bits;
    EXPECT_EQ(budget.radius_px, budget.budget_px);
  }
  const PlacementCounts small = measured({.published = false, .factor = 0.1}, 8);
  EXPECT_FALSE(small.promises);
  EXPECT_GT(small.missed, 0u) << "the twin: a small ball misses";
  EXPECT_GT(small.missed_placements, 0u);
  EXPECT_LE(small.missed_placements, small.colliding_placements);
  EXPECT_GT(small.largest_miss_px, 0);
}

// The stratum holds what the published radius misses on a device that snaps. The twins: the budget
// radius misses nothing there, 0.8 of it most pairs, and without snapping nothing is missed.
TEST(Placements, OfPairsAreMissedAtThePublishedRadiusNearPixelCorners) {
  MeasurementContext lab("native");
  const auto counts = [&](const std::string& radius, int bits, int widening) {
    const PlacementPoint point{.from = "random-soup",
                               .pairs = true,
                               .widening = widening,
                               .side = 0x1p-4,
                               .placements = 40'000,
                               .subpixel_bits = bits,
                               .radius = parse_radius(radius),
                               .resolution = 1024};
    const auto out = std::get<PlacementCounts>(measure_placements(point, lab).counts);
    EXPECT_EQ(out.colliding, out.colliding_placements) << "not the points that make the window";
    EXPECT_GT(out.colliding_placements, 39'000u);
    return out;
  };
  const PlacementCounts published = counts("published", 4, 1);
  EXPECT_GT(published.missed, 0u);
  EXPECT_EQ(published.promises, false);
  EXPECT_EQ(counts("published", 4, 0).missed, 0u) << "anywhere: one in a million is missed";
  EXPECT_EQ(counts("published", 0, 1).missed, 0u);
  EXPECT_EQ(counts("budget", 4, 1).missed, 0u);
  const PlacementCounts smaller = counts("0.8", 4, 1);
  EXPECT_GT(2 * smaller.missed, smaller.colliding);
}

// The contacts that both strips of the proof hold, for rectangles that are turned by t and u. The
// twin: a stratum that is a thousandth narrower lacks some.
TEST(Placements, AStratumHoldsTheLimitsOfTheProof) {
  for (const int bits : {4, 8}) {
    const double grid = std::ldexp(1, -bits);
    const CornerStratum once = corner_stratum(1, bits, 1024), twice = corner_stratum(2, bits, 1024);
    const double most = std::acos(once.corner_cosine);
    const auto reach = [&](double angle) {
      return std::sqrt(0.5) * ((1 + grid) * std::cos(angle) - 1);
    };
    double largest = 0;
    constexpr int kSteps = 1000;
    for (int i = -kSteps; i <= kSteps; ++i) {
      for (int j = -kSteps; j <= kSteps; ++j) {
        const double t = most * i / kSteps, u = most * j / kSteps;
        const double p = std::numbers::pi / 4 + t, q = 3 * std::numbers::pi / 4 + u;
        for (const double sign : {-1.0, 1.0}) {
          const Vec3 a{std::cos(p), std::sin(p), -reach(t)},
              b{std::cos(q), std::sin(q), -sign * reach(u)};
          const Vec3 corner = a.cross(b);  // of both strips
          largest = std::max(largest,
                             (std::abs(corner.x()) + std::abs(corner.y())) / std::abs(corner.z()));
        }
      }
    }
    EXPECT_LE(largest, once.corner_px + 1e-12);
    EXPECT_GT(largest, 0.999 * once.corner_px);
    EXPECT_NEAR(std::acos(twice.corner_cosine), 2 * most, 1e-9);
    EXPECT_EQ(twice.corner_px, 2 * once.corner_px);
  }
}

}  // namespace
}  // namespace farcull
