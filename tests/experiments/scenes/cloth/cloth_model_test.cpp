// What a step of the cloth is made of: derivatives against differences, and the minimum.

#include "experiments/scenes/cloth/cloth.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "tests/lab/test.h"

namespace farcull::cloth {
namespace {

using Eigen::VectorXd;

Vec3 at(const VectorXd& x, std::uint32_t vertex) { return x.segment<3>(3 * vertex); }

// The function of a step (model.h) up to a constant, J.
double value(const Step& step, const VectorXd& x) {
  const Model& model = step.model;
  const ClothSettings& s = model.settings;
  const double h = s.time_step;
  double sum = 0;
  for (std::uint32_t v = 0; v < model.mass.size(); ++v) {
    const Vec3 moved = at(x, v) - at(step.x0, v);
    sum += 0.5 * model.mass[v] * (moved / h - at(step.v0, v)).squaredNorm();
    sum += 0.5 * s.drag * model.area[v] / h * moved.squaredNorm();
    sum += model.mass[v] * s.gravity * x[3 * v + 2];
    if (step.normal[v].isZero(0)) continue;
    sum += smooth_energy(contact_stiffness(model, v), model.crimp,
                         s.radius - step.normal[v].dot(at(x, v)));
    if (step.friction[v] == 0) continue;
    const double slid = (moved - step.normal[v].dot(moved) * step.normal[v]).norm();
    const double stick = h * s.stick_speed;
    sum += step.friction[v] * (slid <= stick ? slid * slid / (2 * stick) : slid - stick / 2);
  }
  for (std::size_t i = 0; i < model.springs.size(); ++i) {
    const auto [a, b] = model.springs[i].vertices;
    const Vec3 d = at(x, b) - at(x, a);
    sum += smooth_energy(step.stretch, model.crimp, d.norm() - slack_length(model, i));
    sum -= s.buckling_load * (at(step.x0, b) - at(step.x0, a)).dot(d);
  }
  for (const Hinge& hinge : model.hinges) {
    Vec3 w = Vec3::Zero();
    for (int c = 0; c < 4; ++c) w += hinge.weights[c] * at(x, hinge.vertices[c]);
    sum += 0.5 * hinge.stiffness * w.squaredNorm();
  }
  return sum;
}

// Strong thrust, so that what it adds is not lost beside the inertia.
ClothSettings settings_of(std::uint64_t triangles) {
  ClothSettings s;
  s.triangles = triangles;
  s.stiffness = 500;
  s.buckling_load = 300;
  s.bending_rigidity = 0.5;
  s.contact_modulus = 1e5;
  s.drag = 3;
  return s;
}

VectorXd shaken(const VectorXd& x, double by, shapes::Random& random) {
  VectorXd result = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) result[i] += random.between(-by, by);
  return result;
}

// A state with springs stretched, pressed and buckled, and vertices inside the sphere and outside.
struct Sample {
  std::unique_ptr<const Model> owned;
  const Model& model;
  Step step;
  VectorXd x;
};
// Every third is pressed together, so that most springs are buckled, and every other of these more
// so by the end of the step.
Sample sample(std::uint64_t seed, const ClothSettings& settings = settings_of(32)) {
  shapes::Random random(seed);
  auto owned = std::make_unique<const Model>(make_model(settings));
  const Model& model = *owned;
  VectorXd x0 = model.rest;
  for (Eigen::Index i = 2; i < x0.size(); i += 3) x0[i] -= random.between(0, 0.05);
  if (seed % 3 == 0) x0 *= 0.5;
  x0 = shaken(x0, 0.3 * settings.side / model.cells, random);
  const VectorXd v0 = shaken(VectorXd::Zero(x0.size()), 1, random);
  VectorXd x = shaken(x0, 0.3 * settings.side / model.cells, random);
  if (seed % 6 == 0) x *= 0.5;
  Step step = make_step(model, x0, v0);
  return {std::move(owned), model, step, x};
}

// The central difference of f along a line, at 0, and how far it may be off. With steps d and 2d
// its errors are e and 4e but for higher orders, so 3e is what they differ by: three times that
// leaves room for those. Rounding: f is off by `sizes` * u, which is divided by d.
struct Difference {
  VectorXd value;
  double allowed = 0;
};
Difference difference(const auto& f, double d, double sizes) {
  const VectorXd near = (f(d) - f(-d)) / (2 * d), far = (f(2 * d) - f(-2 * d)) / (4 * d);
  return {near, (near - far).norm() + sizes * 0x1p-53 / d};
}

TEST(ClothModel, GradientIsThatOfTheValue) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Sample s = sample(seed);
    shapes::Random random(seed + 100);
    const VectorXd p = shaken(VectorXd::Zero(s.x.size()), 1, random);
    VectorXd g;
    gradient(s.step, s.x, g);
    const auto along = [&](double t) { return VectorXd::Constant(1, value(s.step, s.x + t * p)); };
    // The value is a sum of less than 1000 terms, of either sign, none larger than 1000 J.
    const Difference d = difference(along, 1e-6, 1e3 * 1e3 * 1e3);
    EXPECT_LE(std::abs(d.value[0] - g.dot(p)), d.allowed) << seed;
    EXPECT_LT(d.allowed, 1e-2 * std::abs(g.dot(p)) + 1) << "the bound says nothing";
    // The twin: one force that is a little too large.
    Step wrong = s.step;
    wrong.stretch *= 1.02;
    gradient(wrong, s.x, g);
    EXPECT_GT(std::abs(d.value[0] - g.dot(p)), d.allowed) << seed;
  }
}

TEST(ClothModel, HessianIsThatOfTheGradient) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Sample s = sample(seed);
    shapes::Random random(seed + 100);
    Solver solver(s.model);
    const Eigen::SparseMatrix<double>& lower = solver.hessian(s.step, s.x);
    const Eigen::SparseMatrix<double> whole = lower.selfadjointView<Eigen::Lower>();
    const VectorXd p = shaken(VectorXd::Zero(s.x.size()), 1, random);
    const VectorXd hp = whole * p;
    const auto along = [&](double t) {
      VectorXd g;
      gradient(s.step, s.x + t * p, g);
      return g;
    };
    // A force is a sum of less than 100 terms, none larger than 1000 N, on less than 100 numbers.
    const Difference d = difference(along, 1e-7, 1e2 * 1e2 * 1e3);
    EXPECT_LE((d.value - hp).norm(), d.allowed) << seed;
    EXPECT_LT(d.allowed, 1e-2 * hp.norm()) << "the bound says nothing";
    EXPECT_GT((d.value - 1.02 * hp).norm(), d.allowed) << seed;  // the twin
  }
}

TEST(ClothInterior, RoomEndsAtTheCone) {
  shapes::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const ConePoint u{1.01 + random.unit(), random.direction()};
    const ConePoint du{random.between(-1, 1), random.in_cube(1)};
    const double way = reach(u, du);
    const auto inside = [&](double a) {
      const ConePoint at{u.t + a * du.t, u.d + a * du.d};
      return at.t > 0 && determinant(at) > 0;
    };
    for (const double part : {0.1, 0.5, 0.9, 0.999})
      EXPECT_TRUE(inside(part * std::min(way, 1e6))) << i;
    if (std::isfinite(way)) {
      EXPECT_FALSE(inside(1.001 * way)) << i;
    }
  }
}

TEST(ClothInterior, EndsAtTheMinimum) {
  ClothSettings settings = settings_of(98);
  settings.triangles = 98;
  settings.stiffness = 1e6;
  settings.buckling_load = 1;
  settings.height = 0;
  const Model model = make_model(settings);
  const VectorXd thrown = VectorXd::Constant(model.rest.size(), -0.5);
  const Step step = make_step(model, model.rest, thrown);
  const Minimum minimum = Solver(model).minimize(step);
  ASSERT_TRUE(minimum.converged) << minimum.reason;
  VectorXd g;
  gradient(step, minimum.x, g);
  EXPECT_EQ(g, minimum.gradient);
  // Strong convexity: a point with gradient g is within |g| h^2/m of the minimum and no lower than
  // it by more than |g|^2 h^2/(2 m); so no other point may be lower than this one by more.
  double lightest = model.mass[0];
  for (const double mass : model.mass) lightest = std::min(lightest, mass);
  const double h = settings.time_step, gap = g.squaredNorm() * h * h / (2 * lightest);
  shapes::Random random(5);
  for (const double by : {1e-12, 1e-9, 1e-6, 1e-3}) {
    const VectorXd other = shaken(minimum.x, by, random);
    EXPECT_GE(value(step, other) - value(step, minimum.x), -gap - 1e3 * 1e3 * 0x1p-53) << by;
  }
  EXPECT_LT(value(step, minimum.x), value(step, step.x0));
}

}  // namespace
}  // namespace farcull::cloth
