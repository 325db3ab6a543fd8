// The simulated cloth as a scene in motion: energy, momentum, contact, and what it does where the
// solver does not converge.
#include "experiments/scenes/cloth/cloth.h"

#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Eigen::VectorXd;

void set_velocity(Cloth& cloth, const VectorXd& velocity) {
  ClothState state = cloth.state();
  state.velocities = velocity;
  cloth.restore(state);
}

ClothSettings small(double stiffness, std::uint64_t triangles = 800) {
  ClothSettings settings;
  settings.triangles = triangles;
  settings.stiffness = stiffness;
  return settings;
}

VectorXd positions(const Cloth& cloth) {
  VectorXd x(cloth.state().velocities.size());
  for (Eigen::Index v = 0; v < x.size() / 3; ++v)
    x.segment<3>(3 * v) = cloth.scene().vertices[static_cast<std::size_t>(v)];
  return x;
}

// What rounding may add to a total energy. Each of its sums has at most n = 3 terms per triangle,
// so it is off by n u of the sum of their sizes (Higham, section 4.2), and the terms' own few
// roundings are below the same once more. Sizes are the energies themselves where terms have one
// sign; heights, and the thrust of springs, of which each has at most T L^2/2 beside what remains,
// are bounded apart. The length of a spring is off by 4 u of itself, which its energy answers with
// its force times that: over all, at most sqrt(2 stiffness energy n) l 4 u.
double rounding(const ClothSettings& s, const Cloth& cloth) {
  const ClothReport& r = cloth.report();
  const auto n = 3 * static_cast<double>(cloth.scene().objects[0].triangle_count);
  const double cell = s.side / std::sqrt(n / 6);
  const double heights =
      s.density * s.side * s.side * s.gravity * positions(cloth).lpNorm<Eigen::Infinity>();
  const double thrust = s.buckling_load * 2 * cell * cell / 2 * n;
  const double sums = r.kinetic + r.elastic + r.bending + r.contact + heights + 2 * thrust;
  const double springs = std::sqrt(2 * s.stiffness * (r.elastic + thrust) * n) * 2 * cell * 4;
  return 2 * 0x1p-53 * (2 * n * sums + springs);
}

// Steps `frames` times. In every frame: the total energy gains no more than slack and rounding,
// and slack is no more than the residual on every vertex times the way it went.
struct Course {
  int most_iterations = 0, failed = 0;
  bool bounded = true, finite = true;
};
Course run(Cloth& cloth, const ClothSettings& settings, int frames) {
  Course course;
  double before = cloth.report().total();
  double allowed = rounding(settings, cloth);
  VectorXd from = positions(cloth);
  for (int f = 0; f < frames; ++f) {
    const ClothReport report = cloth.step();
    const VectorXd to = positions(cloth);
    double way = 0;
    for (Eigen::Index v = 0; v < to.size(); v += 3) way += (to - from).segment<3>(v).norm();
    course.bounded &= report.slack <= report.residual * way * (1 + 1e-12);
    course.bounded &= report.total() <= before + report.slack + allowed + rounding(settings, cloth);
    course.finite &= to.allFinite() && std::isfinite(report.total());
    course.most_iterations = std::max(course.most_iterations, report.iterations);
    course.failed += report.converged ? 0 : 1;
    EXPECT_EQ(report.warning.empty(), report.converged);
    before = report.total();
    allowed = rounding(settings, cloth);
    from = to;
  }
  return course;
}

class ClothAt : public ::testing::TestWithParam<double> {};

TEST_P(ClothAt, StaysFiniteAndGainsNoEnergyIn500Frames) {
  const ClothSettings settings = small(GetParam(), 200);
  Cloth cloth(settings);
  const double at_first = cloth.report().total();
  const Course course = run(cloth, settings, 500);
  EXPECT_TRUE(course.finite);
  EXPECT_TRUE(course.bounded);
  EXPECT_EQ(course.failed, 0);
  EXPECT_LT(cloth.report().total(), at_first);
  // It hangs, rather than having fallen off: its lowest point is above a free fall of 5 seconds,
  // and within the reach of the cloth.
  double lowest = 0;
  for (Eigen::Index v = 2; v < cloth.state().velocities.size(); v += 3)
    lowest = std::min(lowest, positions(cloth)[v]);
  EXPECT_GT(lowest, -settings.side);
  EXPECT_LT(lowest, -settings.radius);
  validate(cloth.scene(), "cloth");
  RecordProperty("most_iterations", course.most_iterations);
}
INSTANTIATE_TEST_SUITE_P(Stiffness, ClothAt, ::testing::Values(1e2, 1e4, 1e6, 1e8));

// The twin: an explicit step of the same forces, which the same check must catch.
TEST(Cloth, TheEnergyBoundCatchesExplicitEuler) {
  const ClothSettings settings = small(1e4, 200);
  const cloth::Model model = cloth::make_model(settings);
  const auto total = [&](const VectorXd& x, const VectorXd& v) {
    const cloth::Energies e = cloth::energies(model, x, v);
    return e.kinetic + e.elastic + e.bending + e.gravitational + e.contact;
  };
  VectorXd x = model.rest, v = VectorXd::Zero(x.size());
  VectorXd force;
  bool caught = false;
  for (int f = 0; f < 20 && !caught; ++f) {
    const double before = total(x, v);
    // At x0 with v = 0 the gradient is that of the energies alone.
    const cloth::Step step = cloth::make_step(model, x, VectorXd::Zero(x.size()));
    cloth::gradient(step, x, force);
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      const double mass = model.mass[static_cast<std::size_t>(i / 3)];
      const double old = v[i];
      v[i] -= settings.time_step / mass * force[i];
      x[i] += settings.time_step * old;
    }
    caught = !(total(x, v) <= before * (1 + 1e-6));
  }
  EXPECT_TRUE(caught);
}

TEST(Cloth, SaysThatItDidNotConvergeAndStays) {
  ClothSettings settings = small(1e4, 200);
  settings.max_iterations = 0;
  Cloth cloth(settings);
  VectorXd thrown = VectorXd::Constant(cloth.state().velocities.size(), 0.5);
  set_velocity(cloth, thrown);
  const VectorXd before = positions(cloth);
  const double total = cloth.report().total();
  const ClothReport report = cloth.step();
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(has_text(report.warning, "did not converge: 0 iterations left"));
  EXPECT_GT(report.residual, 0);
  EXPECT_EQ(positions(cloth), before);
  EXPECT_EQ(cloth.state().velocities, VectorXd::Zero(before.size()));
  EXPECT_EQ(report.kinetic, 0);
  EXPECT_LE(report.total(), total);
  EXPECT_EQ(report.frame, 1);
}

TEST(Cloth, RecoversFromNumbersThatAreNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), 1e200, 1e308}) {
    Cloth cloth(small(1e4, 200));
    for (int f = 0; f < 3; ++f) ASSERT_TRUE(cloth.step().converged);
    VectorXd velocity = cloth.state().velocities;
    velocity[7] = bad;
    set_velocity(cloth, velocity);
    const VectorXd before = positions(cloth);
    const ClothReport failed = cloth.step();
    EXPECT_FALSE(failed.converged) << bad;
    EXPECT_NE(failed.warning, "");
    EXPECT_EQ(positions(cloth), before);
    EXPECT_TRUE(std::isfinite(failed.total()));
    validate(cloth.scene(), "cloth");
    for (int f = 0; f < 5; ++f) EXPECT_TRUE(cloth.step().converged) << cloth.report().warning;
    EXPECT_NE(positions(cloth), before);
  }
}

TEST(Cloth, SameBitsOnEveryRun) {
  std::array<Cloth, 2> cloths = {Cloth(small(1e6, 200)), Cloth(small(1e6, 200))};
  for (int f = 0; f < 40; ++f)
    for (Cloth& cloth : cloths) cloth.step();
  const std::vector<Vec3>& a = cloths[0].scene().vertices;
  const std::vector<Vec3>& b = cloths[1].scene().vertices;
  EXPECT_EQ(scene_hash(cloths[0].scene()), scene_hash(cloths[1].scene()));
  EXPECT_EQ(0, std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)));
  ClothSettings other = small(1e6, 200);
  other.seed = 2;
  EXPECT_NE(scene_hash(Cloth(other).scene()), scene_hash(Cloth(small(1e6, 200)).scene()));
}

TEST(Cloth, RefusesSettingsOutOfRange) {
  const auto refused = [](auto change) {
    ClothSettings settings = small(1e4);
    change(settings);
    return error_of([&] { Cloth cloth(settings); }).where;
  };
  EXPECT_EQ(refused([](ClothSettings& s) { s.triangles = 7; }), "cloth");
  EXPECT_EQ(refused([](ClothSettings& s) { s.stiffness = 0; }), "cloth");
  EXPECT_EQ(refused([](ClothSettings& s) { s.stiffness = std::nan(""); }), "cloth");
  EXPECT_EQ(refused([](ClothSettings& s) { s.time_step = -1; }), "cloth");
  EXPECT_EQ(refused([](ClothSettings& s) { s.radius = INFINITY; }), "cloth");
  EXPECT_EQ(refused([](ClothSettings& s) { s.max_iterations = -1; }), "cloth");
  Cloth cloth(small(1e4));
  EXPECT_THROW(set_velocity(cloth, VectorXd::Zero(3)), std::logic_error);
}

}  // namespace
}  // namespace farcull
