// Minimizes the function of a time step by Newton's method with a line search, or by an
// interior-point method with the scaling of Nesterov and Todd (docs/cloth.md, "Solver").
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "experiments/scenes/cloth/cloth.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull::cloth {

double determinant(const ConePoint& u) {
  const double n = u.d.norm();
  return (u.t - n) * (u.t + n);
}

double reach(const ConePoint& u, const ConePoint& du) {
  // Finds the least a > 0 at which t or the determinant of u + a du is 0. The determinant equals
  // c + 2 b a + q a^2 with c > 0.
  const double q = determinant(du);
  const double b = u.t * du.t - u.d.dot(du.d);
  const double c = determinant(u);
  double first = std::numeric_limits<double>::infinity();
  const double discriminant = b * b - q * c;
  if (discriminant >= 0) {
    const double root = -(b + std::copysign(std::sqrt(discriminant), b));
    for (const double a : {root / q, c / root}) {
      if (a > 0) first = std::min(first, a);
    }
  }
  if (du.t < 0) first = std::min(first, -u.t / du.t);
  return first;
}

namespace {

constexpr double kWidth = 1e-2;          // initial distance from the boundary, in spring lengths
constexpr double kToTheBoundary = 0.95;  // a step goes this fraction of the way to the boundary

// The unknowns of the interior-point method. Each spring has a point u of the cone and a dual point
// z; the complementarity is the inner product u.z (J). Each contact has a distance s and a force f;
// the complementarity is s f (J). At the minimum a complementarity is about Model::crimp.
class Interior {
 public:
  // Starts at the positions x. Chooses the other unknowns inside the cones, so that each
  // complementarity has the given value (J). The step must outlive this object.
  Interior(const Step& step, const Eigen::VectorXd& x, double complementarity);

  // Returns the mean of the complementarities (J).
  double complementarity() const;

  // Sets up the linear equations for a search direction that aims at complementarity `target` (J).
  // Eliminates the unknowns of springs and contacts. The next four functions return the blocks and
  // forces that springs and contacts add to the equations of the positions.
  void linearize(const Eigen::VectorXd& x, double target);
  const Block& spring_block(std::size_t spring) const { return springs_[spring].block; }
  const Vec3& spring_force(std::size_t spring) const { return springs_[spring].force; }
  Block contact_block(std::size_t vertex) const {
    if (contacts_.empty()) return Block::Zero();
    const Vec3& n = step_.normal[vertex];
    return contacts_[vertex].block * n * n.transpose();
  }
  Vec3 contact_force(std::size_t vertex) const {
    if (contacts_.empty()) return Vec3::Zero();
    return contacts_[vertex].force * step_.normal[vertex];
  }

  // Moves the positions and all other unknowns along the direction, as far as the cones allow.
  // Returns the moved fraction of `direction`, at most 1. Precondition: linearize() ran at x.
  double move(const Eigen::VectorXd& direction, Eigen::VectorXd& x);

 private:
  struct SpringState {
    double length = 0;  // l* of docs/cloth.md
    ConePoint u, z, du, dz;
    double across = 0;  // entry (t, t) of the scaling, plus Step::stretch
    double right = 0;   // right-hand side of the equation of t
    Vec3 mixed;         // entries (t, d) of the scaling
    Block whole;        // entries (d, d) of the scaling
    Block block;        // added to the matrix when t is eliminated
    Vec3 force;         // added to the gradient when t is eliminated
  };
  struct ContactState {
    double stiffness = 0;
    double s = 0, f = 0, ds = 0, df = 0;
    double scaling = 0;  // f / s
    double right = 0;    // right-hand side of the equation of s
    double block = 0, force = 0;
  };

  const Step& step_;
  double target_ = 0;
  std::vector<SpringState> springs_;
  std::vector<ContactState> contacts_;  // one for each vertex; none without a sphere
};

Interior::Interior(const Step& step, const Eigen::VectorXd& x, double complementarity)
    : step_(step),
      springs_(step.model.springs.size()),
      contacts_(step.model.settings.radius > 0 ? step.model.mass.size() : 0) {
  const Model& model = step.model;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    SpringState& spring = springs_[i];
    const auto [a, b] = model.springs[i].vertices;
    spring.length = slack_length(model, i);
    spring.u.d = x.segment<3>(3 * b) - x.segment<3>(3 * a);
    spring.u.t = std::max(spring.length, spring.u.d.norm()) + kWidth * model.springs[i].length;
    const double scale = complementarity / determinant(spring.u);
    spring.z = {scale * spring.u.t, -scale * spring.u.d};
  }
  for (std::size_t v = 0; v < contacts_.size(); ++v) {
    ContactState& contact = contacts_[v];
    contact.stiffness = contact_stiffness(model, v);
    const double away = step.normal[v].dot(x.segment<3>(3 * v)) - model.settings.radius;
    contact.s = std::max(away, kWidth * model.springs[0].length);
    contact.f = complementarity / contact.s;
  }
}

double Interior::complementarity() const {
  double sum = 0;
  for (const SpringState& spring : springs_)
    sum += spring.u.t * spring.z.t + spring.u.d.dot(spring.z.d);
  for (const ContactState& contact : contacts_) sum += contact.s * contact.f;
  return sum / static_cast<double>(springs_.size() + contacts_.size());
}

void Interior::linearize(const Eigen::VectorXd& x, double target) {
  target_ = target;
  for (SpringState& spring : springs_) {
    const ConePoint& u = spring.u;
    const ConePoint& z = spring.z;
    // The scaling matrix W^-2 = eta (2 w w^T - J) maps u to z. Here J = diag(1, -1, -1, -1),
    // w = J (u/|u| + J z/|z|) / (2 g), and |u| is the square root of the determinant of u.
    const double size_u = std::sqrt(determinant(u));
    const double size_z = std::sqrt(determinant(z));
    const double cosine = (u.t * z.t + u.d.dot(z.d)) / (size_u * size_z);
    const double g = std::sqrt(0.5 * (1 + cosine));
    const double wt = (u.t / size_u + z.t / size_z) / (2 * g);
    const Vec3 wd = (z.d / size_z - u.d / size_u) / (2 * g);
    const double eta = size_z / size_u;
    const double tt = eta * (2 * wt * wt - 1);
    spring.mixed = eta * 2 * wt * wd;
    spring.whole = eta * (2 * wd * wd.transpose() + Block::Identity());
    spring.across = step_.stretch + tt;
    // The unknown du_t is eliminated with c = stretch and these two equations:
    // dz = target u^-1 - z - W^-2 du, and du_t = dz_t/c - (t - length - z_t/c).
    const double inverse = target / (size_u * size_u);
    spring.right =
        inverse * u.t - z.t - step_.stretch * (u.t - spring.length - z.t / step_.stretch);
    spring.block = spring.whole - spring.mixed * spring.mixed.transpose() / spring.across;
    spring.force = inverse * u.d + spring.mixed * spring.right / spring.across;
  }
  for (std::size_t v = 0; v < contacts_.size(); ++v) {
    ContactState& contact = contacts_[v];
    const double away = step_.normal[v].dot(x.segment<3>(3 * v)) - step_.model.settings.radius;
    contact.scaling = contact.f / contact.s;
    // The equation s = f / stiffness + away is linearized like a spring's equation.
    const double off = contact.s - contact.f / contact.stiffness - away;
    contact.right = (target / contact.s - contact.f) / contact.stiffness - off;
    const double divisor = 1 + contact.scaling / contact.stiffness;
    contact.block = contact.scaling / divisor;
    contact.force = -target / contact.s + contact.scaling * contact.right / divisor;
  }
}

double Interior::move(const Eigen::VectorXd& direction, Eigen::VectorXd& x) {
  double way = 1 / kToTheBoundary;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    SpringState& spring = springs_[i];
    const auto [a, b] = step_.model.springs[i].vertices;
    const double inverse = target_ / determinant(spring.u);
    const double tt = spring.across - step_.stretch;
    spring.du.d = direction.segment<3>(3 * b) - direction.segment<3>(3 * a);
    spring.du.t = (spring.right - spring.mixed.dot(spring.du.d)) / spring.across;
    spring.dz.t =
        inverse * spring.u.t - spring.z.t - tt * spring.du.t - spring.mixed.dot(spring.du.d);
    spring.dz.d = -inverse * spring.u.d - spring.z.d - spring.mixed * spring.du.t -
                  spring.whole * spring.du.d;
    way = std::min({way, reach(spring.u, spring.du), reach(spring.z, spring.dz)});
  }
  for (std::size_t v = 0; v < contacts_.size(); ++v) {
    ContactState& contact = contacts_[v];
    const double out = step_.normal[v].dot(direction.segment<3>(3 * v));
    contact.ds = (contact.right + out) / (1 + contact.scaling / contact.stiffness);
    contact.df = target_ / contact.s - contact.f - contact.scaling * contact.ds;
    if (contact.ds < 0) way = std::min(way, -contact.s / contact.ds);
    if (contact.df < 0) way = std::min(way, -contact.f / contact.df);
  }
  way *= kToTheBoundary;
  x += way * direction;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    SpringState& spring = springs_[i];
    const auto [a, b] = step_.model.springs[i].vertices;
    spring.u.d = x.segment<3>(3 * b) - x.segment<3>(3 * a);
    spring.u.t += way * spring.du.t;
    spring.z.t += way * spring.dz.t;
    spring.z.d += way * spring.dz.d;
  }
  for (ContactState& contact : contacts_) {
    contact.s += way * contact.ds;
    contact.f += way * contact.df;
  }
  return way;
}

constexpr int kTrials = 60;  // maximum number of step lengths tried along a direction
// The constants below change the time that a step takes, but not its result.
constexpr int kMostIterations = 40;  // maximum number of Newton iterations before interior() runs
constexpr double kShort = 0.125;     // a step below this fraction of Newton's step is short
constexpr int kMostShort = 3;        // maximum number of short steps before interior() runs
constexpr double kStart = 1;         // initial complementarity / (weight of a vertex * length)
constexpr double kEnd = 2;           // final complementarity / crimp; then Newton's method is fast

// Returns the lower triangle of the Hessian, with only the terms that do not depend on x.
Eigen::SparseMatrix<double> pattern(const Model& model) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&](std::uint32_t a, std::uint32_t b, const Block& block) {
    const auto row = static_cast<int>(3 * std::max(a, b));
    const auto column = static_cast<int>(3 * std::min(a, b));
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        if (row + r >= column + c) entries.emplace_back(row + r, column + c, block(r, c));
      }
    }
  };
  for_constant_blocks(model, couple);
  for (const Spring& spring : model.springs)
    couple(spring.vertices[0], spring.vertices[1], Block::Zero());
  const auto size = static_cast<Eigen::Index>(3 * model.mass.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

double largest_force(const Eigen::VectorXd& gradient) {
  double largest = 0;
  for (Eigen::Index v = 0; v < gradient.size(); v += 3) {
    const double force = gradient.segment<3>(v).norm();
    if (!std::isfinite(force)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, force);
  }
  return largest;
}

}  // namespace

Solver::Solver(const Model& model) : model_(model), matrix_(pattern(model)) {
  factor_.analyzePattern(matrix_);
  constant_.assign(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());
  for (std::uint32_t v = 0; v < model.mass.size(); ++v) vertex_slots_.push_back(slot(v, v));
  for (const Spring& spring : model.springs)
    spring_slots_.push_back(slot(spring.vertices[0], spring.vertices[1]));
}

Solver::Slot Solver::slot(std::uint32_t a, std::uint32_t b) const {
  const auto row = static_cast<int>(3 * std::max(a, b));
  const auto column = static_cast<int>(3 * std::min(a, b));
  const int* const rows = matrix_.innerIndexPtr();
  Slot result{};
  for (int c = 0; c < 3; ++c) {
    const int* const first = rows + matrix_.outerIndexPtr()[column + c];
    const int* const end = rows + matrix_.outerIndexPtr()[column + c + 1];
    // In a block on the diagonal, column c of the lower triangle begins with row c.
    result[c] = static_cast<int>(std::lower_bound(first, end, std::max(row, column + c)) - rows);
  }
  return result;
}

void Solver::assemble(const std::function<Block(std::size_t)>& of_spring,
                      const std::function<Block(std::uint32_t)>& of_vertex) {
  double* const values = matrix_.valuePtr();
  std::copy(constant_.begin(), constant_.end(), values);
  const auto add_diagonal = [&](std::uint32_t v, const Block& block) {
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) values[vertex_slots_[v][c] + r - c] += block(r, c);
    }
  };
  for (std::size_t i = 0; i < model_.springs.size(); ++i) {
    const Block block = of_spring(i);
    add_diagonal(model_.springs[i].vertices[0], block);
    add_diagonal(model_.springs[i].vertices[1], block);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) values[spring_slots_[i][c] + r] -= block(r, c);
    }
  }
  for (std::uint32_t v = 0; v < model_.mass.size(); ++v) add_diagonal(v, of_vertex(v));
}

const Eigen::SparseMatrix<double>& Solver::hessian(const Step& step, const Eigen::VectorXd& x) {
  assemble([&](std::size_t i) { return spring_block(step, i, x); },
           [&](std::uint32_t v) {
             return Block(contact_block(step, v, x) + friction_block(step, v, x));
           });
  return matrix_;
}

double Solver::tolerance(const Eigen::VectorXd& x) const {
  const ClothSettings& s = model_.settings;
  const double heaviest = *std::max_element(model_.mass.begin(), model_.mass.end());
  // A coordinate has a rounding error of at most 2^-53 |x|. A spring's force changes by at most
  // (stiffness + buckling_load) times this error. A vertex has up to 8 springs, with 2 ends each.
  const double rounding =
      16 * std::sqrt(3.0) * 0x1p-53 * x.lpNorm<Eigen::Infinity>() * (s.stiffness + s.buckling_load);
  return s.tolerance * kStandardGravity * heaviest + rounding;
}

// Solves with the assembled matrix. Returns false if the matrix has no Cholesky factor.
bool Solver::solve(const Eigen::VectorXd& right, Eigen::VectorXd& result) {
  factor_.factorize(matrix_);
  if (factor_.info() != Eigen::Success) return false;
  result = factor_.solve(right);
  return true;
}

// Each iteration searches along Newton's direction until |slope| is at most a tenth of its initial
// value. The function is convex, so the slope is negative at first and rises. Stops after
// `iterations` iterations or `most_short` short steps. Returns false if a force is not finite, if
// the matrix has no Cholesky factor, or if max_iterations is used up.
bool Solver::newton(const Step& step, int iterations, int most_short, Minimum& best) {
  Eigen::VectorXd p(best.x.size());
  Eigen::VectorXd x(best.x.size());
  gradient(step, best.x, best.gradient);
  for (int i = 0;; ++i) {
    best.residual = largest_force(best.gradient);
    best.converged = best.residual <= tolerance(best.x);
    if (best.converged) return true;
    if (!std::isfinite(best.residual)) {
      best.reason = "a force is not finite";
      return false;
    }
    if (best.iterations >= model_.settings.max_iterations) {
      best.reason = fmt::format("{} iterations left a force of {:.3g} N, and {:.3g} N is allowed",
                                best.iterations, best.residual, tolerance(best.x));
      return false;
    }
    if (i == iterations || most_short == 0) return true;
    ++best.iterations;
    hessian(step, best.x);
    if (!solve(-best.gradient, p)) {
      best.reason = "the matrix has no Cholesky factor";
      return false;
    }
    const double first = best.gradient.dot(p);
    double lo = 0;
    double hi = std::numeric_limits<double>::infinity();
    double at_lo = first;
    double at_hi = 0;
    double length = 1;
    for (int trial = 0; trial < kTrials; ++trial) {
      x = best.x + length * p;
      gradient(step, x, best.gradient);
      const double slope = best.gradient.dot(p);
      if (!(std::abs(slope) > 0.1 * std::abs(first))) break;
      (slope < 0 ? lo : hi) = length;
      (slope < 0 ? at_lo : at_hi) = slope;
      if (std::isinf(hi)) {
        length *= 2;
        continue;
      }
      const double secant = lo + (hi - lo) * at_lo / (at_lo - at_hi);
      const double margin = 0.1 * (hi - lo);
      length = std::clamp(secant, lo + margin, hi - margin);
    }
    best.x = x;
    if (length < kShort) --most_short;
  }
}

// Moves best.x close to the minimum. On failure, leaves best.x unchanged.
void Solver::interior(const Step& step, Minimum& best) {
  const double heaviest = *std::max_element(model_.mass.begin(), model_.mass.end());
  Eigen::VectorXd x = best.x;
  Interior interior(step, x, kStart * kStandardGravity * heaviest * model_.springs[0].length);
  Eigen::VectorXd force;
  Eigen::VectorXd p;
  double aim = 0.1;  // desired ratio of the next complementarity to the present one
  for (;;) {
    const double now = interior.complementarity();
    if (now <= kEnd * model_.crimp && aim < 0.2) break;
    if (!std::isfinite(now) || best.iterations >= model_.settings.max_iterations) return;
    ++best.iterations;
    interior.linearize(x, std::max(model_.crimp, aim * now));
    assemble([&](std::size_t i) { return interior.spring_block(i); },
             [&](std::uint32_t v) {
               return Block(interior.contact_block(v) + friction_block(step, v, x));
             });
    soft_gradient(step, x, force);
    for (std::size_t i = 0; i < model_.springs.size(); ++i) {
      const auto [a, b] = model_.springs[i].vertices;
      force.segment<3>(3 * b) += interior.spring_force(i);
      force.segment<3>(3 * a) -= interior.spring_force(i);
    }
    for (std::uint32_t v = 0; v < model_.mass.size(); ++v)
      force.segment<3>(3 * v) += interior.contact_force(v);
    if (!solve(-force, p)) return;
    const double way = interior.move(p, x);
    aim = way > 0.8 ? 0.1 : way > 0.3 ? 0.4 : 0.9;
  }
  best.x = x;
}

Minimum Solver::minimize(const Step& step) {
  Minimum best;
  best.x = step.x0;
  if (!newton(step, kMostIterations, was_stiff_ ? 1 : kMostShort, best) || best.converged) {
    was_stiff_ = false;
    return best;
  }
  was_stiff_ = true;
  const int all = model_.settings.max_iterations;
  interior(step, best);
  newton(step, all, all, best);
  return best;
}

}  // namespace farcull::cloth

namespace farcull {
namespace {

// Returns the highest level at which shapes::sphere() has at most triangles / 2 triangles, or 0.
int sphere_level(std::uint64_t triangles) {
  int level = 0;
  while (20 * (std::uint64_t{4} << (2 * level)) <= triangles / 2) ++level;
  return level;
}

Scene make_scene(const cloth::Model& model) {
  std::vector<Vec3> rest;
  for (Eigen::Index v = 0; v < model.rest.size(); v += 3)
    rest.emplace_back(model.rest.segment<3>(v));
  const Mesh square = shapes::finished(std::move(rest), model.triangles);
  Mesh ball;
  if (model.settings.radius > 0) ball = shapes::sphere(sphere_level(model.triangles.size()));
  for (Vec3& p : ball.vertices) p *= model.settings.radius;
  Scene scene;
  scene.name = "cloth";
  append_object("cloth", square.vertices, square.triangles, square.source_face, scene);
  append_object("sphere", ball.vertices, ball.triangles, ball.source_face, scene);
  scene.objects[0].self = true;
  validate(scene, "cloth");
  return scene;
}

}  // namespace

struct Cloth::State {
  explicit State(const ClothSettings& settings)
      : model(cloth::make_model(settings)),
        solver(model),
        x(model.rest),
        velocity(Eigen::VectorXd::Zero(model.rest.size())),
        scene(make_scene(model)) {}

  void move_to(Eigen::VectorXd positions) {
    x = std::move(positions);
    for (Eigen::Index v = 0; v < x.size(); v += 3) scene.vertices[v / 3] = x.segment<3>(v);
  }

  void measure() { static_cast<cloth::Energies&>(report) = cloth::energies(model, x, velocity); }

  const cloth::Model model;
  cloth::Solver solver;
  Eigen::VectorXd x;
  Eigen::VectorXd velocity;
  Scene scene;
  ClothReport report;
};

Cloth::Cloth(const ClothSettings& settings) : state_(std::make_unique<State>(settings)) {
  state_->measure();
}
Cloth::~Cloth() = default;
Cloth::Cloth(Cloth&&) noexcept = default;
Cloth& Cloth::operator=(Cloth&&) noexcept = default;

const Scene& Cloth::scene() const { return state_->scene; }
const ClothReport& Cloth::report() const { return state_->report; }

ClothState Cloth::state() const {
  return {.report = state_->report, .positions = state_->x, .velocities = state_->velocity};
}

void Cloth::restore(const ClothState& state) {
  State& s = *state_;
  if (state.positions.size() != s.x.size() || state.velocities.size() != s.x.size())
    throw std::logic_error("Cloth::restore: not three numbers for each vertex");
  s.move_to(state.positions);
  s.velocity = state.velocities;
  s.report = state.report;
  s.measure();
}

ClothReport Cloth::step() {
  State& s = *state_;
  const cloth::Step step = cloth::make_step(s.model, s.x, s.velocity);
  cloth::Minimum minimum = s.solver.minimize(step);
  ClothReport report;
  report.frame = s.report.frame + 1;
  report.residual = minimum.residual;
  report.iterations = minimum.iterations;
  report.converged = minimum.converged && minimum.x.allFinite();
  if (report.converged) {
    const Eigen::VectorXd moved = minimum.x - s.x;
    report.slack = minimum.gradient.dot(moved);
    s.velocity = moved / s.model.settings.time_step;
    s.move_to(std::move(minimum.x));
  } else {
    s.velocity.setZero();
    report.warning = "the solver did not converge: " + minimum.reason +
                     "; the cloth stays where it was, at rest";
  }
  s.report = std::move(report);
  s.measure();
  return s.report;
}

}  // namespace farcull
