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

// Without contact inner forces cancel: the centre of mass obeys
//   M (w' - w)/h = -M g - drag area w'   with w its velocity,
// which is solved for w'. Each step may be off by the residuals, n times at most, over the mass.
TEST(Cloth, CentreOfMassFallsByTheRecurrence) {
  for (const double stiffness : {1e2, 1e8}) {
    ClothSettings s = small(stiffness, 200);
    s.radius = 0;
    s.time_step = 0.02;
    Cloth cloth(s);
    VectorXd start = cloth.state().velocities;
    for (Eigen::Index i = 0; i < start.size(); ++i) start[i] = 0.3 * std::sin(1.0 * i);
    set_velocity(cloth, start);
    const cloth::Model model = cloth::make_model(s);
    const auto mean = [&](const VectorXd& q) {
      Vec3 sum = Vec3::Zero();
      for (Eigen::Index v = 0; v < q.size() / 3; ++v)
        sum += model.mass[static_cast<std::size_t>(v)] * q.segment<3>(3 * v);
      return Vec3(sum / (s.density * s.side * s.side));
    };
    Vec3 w = mean(start), c = mean(positions(cloth));
    const double n = static_cast<double>(start.size()) / 3, mass = s.density * s.side * s.side;
    const double h = s.time_step;
    double allowed_w = n * 0x1p-52, allowed_c = n * 0x1p-52;
    for (int f = 0; f < 30; ++f) {
      const ClothReport report = cloth.step();
      ASSERT_TRUE(report.converged) << report.warning;
      w = (w - h * s.gravity * Vec3::UnitZ()) / (1 + h * s.drag / s.density);
      c += h * w;
      // Rounding: n terms in each mean, positions of size |c| + 1 from which speeds are 1/h times
      // differences.
      const double rounding = 4 * n * 0x1p-53 * (c.norm() + 1);
      allowed_w += h * n * report.residual / mass + rounding / h;
      allowed_c += h * allowed_w + rounding;
      EXPECT_LE((mean(cloth.state().velocities) - w).norm(), allowed_w) << f;
      EXPECT_LE((mean(positions(cloth)) - c).norm(), allowed_c) << f;
    }
    EXPECT_LT(allowed_c, 1e-3);  // the bound says something: it fell by more than a metre
    EXPECT_LT(c.z(), -1);
  }
}

TEST(Cloth, CentreOfMassIsCaughtWithoutTheAir) {
  ClothSettings s = small(1e4, 200);
  s.radius = 0;
  Cloth with(s);
  s.drag = 0;
  Cloth without(s);
  for (int f = 0; f < 30; ++f) {
    with.step();
    without.step();
  }
  EXPECT_GT(positions(with).mean(), positions(without).mean() + 1e-3);
}

// The penalty holds: a vertex sinks in by what carries the cloth, which is far below a cell.
TEST(Cloth, RestsOnTheSphere) {
  const ClothSettings settings = small(1e4, 200);
  Cloth cloth(settings);
  double deepest = 0;
  for (int f = 0; f < 300; ++f) cloth.step();
  const VectorXd x = positions(cloth);
  for (Eigen::Index v = 0; v < x.size(); v += 3)
    deepest = std::max(deepest, settings.radius - x.segment<3>(v).norm());
  EXPECT_GT(deepest, 0);
  EXPECT_LT(deepest, 1e-3);
  EXPECT_GT(cloth.report().contact, 0);
  EXPECT_LT(cloth.report().kinetic, 1e-3);
}

TEST(Cloth, FoldsThroughItself) {
  Cloth cloth(small(1e4));
  EXPECT_TRUE(all_colliding_pairs(cloth.scene()).pairs.empty());
  std::size_t most = 0;
  for (int f = 0; f < 80; ++f) {
    cloth.step();
    if (f % 10 != 9) continue;
    std::size_t of_itself = 0;
    for (const TrianglePair& pair : all_colliding_pairs(cloth.scene()).pairs)
      of_itself += pair.b < cloth.scene().objects[0].triangle_count ? 1 : 0;
    most = std::max(most, of_itself);
  }
  EXPECT_GT(most, 0u);
  RecordProperty("most_pairs_of_itself", static_cast<int>(most));
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

TEST(Cloth, SceneHasTheSizeAskedFor) {
  for (const std::uint64_t triangles : {8, 9, 200, 19800, 20000}) {
    const Cloth cloth(small(1e4, triangles));
    const Scene& scene = cloth.scene();
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.objects[0].name, "cloth");
    EXPECT_TRUE(scene.objects[0].self);
    EXPECT_EQ(scene.objects[1].name, "sphere");
    EXPECT_FALSE(scene.objects[1].self);
    const double m = std::round(std::sqrt(static_cast<double>(triangles) / 2));
    EXPECT_EQ(scene.objects[0].triangle_count, 2 * m * m);
    EXPECT_GE(scene.objects[1].triangle_count, 20u);
    EXPECT_EQ(cloth.report().frame, 0);
  }
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
