#include "experiments/cloth_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace farcull::cloth {
namespace {

constexpr double kStandardGravity = 9.81;  // of the unit of forces, whatever the setting
constexpr int kTrials = 60;                // along one direction; a double has no more halvings
// Measured on cloths of 800 triangles; they change how long a step takes and not where it ends.
constexpr double kFirstRound = 2000;  // stiffness of the first round, over mass / h^2
constexpr double kHarder = 3;         // factor between rounds
constexpr double kShrinks = 0.5;      // a round that shrinks the change to this is repeated
constexpr double kLoose = 0.1;        // tolerance of a round but the last, over the weight
constexpr double kSettled = 0.01;     // tensions that change by less, over the weight, are settled

// The lower triangle, with the values that no x changes.
Eigen::SparseMatrix<double> pattern(const Model& model, const std::vector<std::uint32_t>& places) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&](std::uint32_t a, std::uint32_t b, const Block& block) {
    const auto row = static_cast<int>(3 * std::max(places[a], places[b]));
    const auto column = static_cast<int>(3 * std::min(places[a], places[b]));
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        if (row + r >= column + c) entries.emplace_back(row + r, column + c, block(r, c));
      }
    }
  };
  for_constant_blocks(model, couple);
  for (const Spring& spring : model.springs) {
    couple(spring.vertices[0], spring.vertices[1], Block::Zero());
  }
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

Solver::Solver(const Model& model)
    : model_(model),
      dissection_(dissect(model.cells + 1)),
      matrix_(pattern(model, dissection_.places)),
      factor_(dissection_, matrix_) {
  constant_.assign(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());
  for (std::uint32_t v = 0; v < model.mass.size(); ++v) vertex_slots_.push_back(slot(v, v));
  for (const Spring& spring : model.springs) {
    spring_slots_.push_back(slot(spring.vertices[0], spring.vertices[1]));
  }
  tensions_.assign(model.springs.size(), Vec3::Zero());
}

Solver::Slot Solver::slot(std::uint32_t a, std::uint32_t b) const {
  const auto row = static_cast<int>(3 * std::max(dissection_.places[a], dissection_.places[b]));
  const auto column = static_cast<int>(3 * std::min(dissection_.places[a], dissection_.places[b]));
  const int* const rows = matrix_.innerIndexPtr();
  Slot result{};
  for (int c = 0; c < 3; ++c) {
    const int* const first = rows + matrix_.outerIndexPtr()[column + c];
    const int* const end = rows + matrix_.outerIndexPtr()[column + c + 1];
    // On the diagonal a column of the lower triangle begins with its own row.
    result[c] = static_cast<int>(std::lower_bound(first, end, std::max(row, column + c)) - rows);
  }
  return result;
}

const Eigen::SparseMatrix<double>& Solver::hessian(const Step& step, const Eigen::VectorXd& x) {
  double* const values = matrix_.valuePtr();
  std::copy(constant_.begin(), constant_.end(), values);
  const auto add_diagonal = [&](std::uint32_t v, const Block& block) {
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) values[vertex_slots_[v][c] + r - c] += block(r, c);
    }
  };
  for (std::size_t i = 0; i < model_.springs.size(); ++i) {
    const Block block = spring_block(step, i, x);
    add_diagonal(model_.springs[i].vertices[0], block);
    add_diagonal(model_.springs[i].vertices[1], block);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) values[spring_slots_[i][c] + r] -= block(r, c);
    }
  }
  for (std::uint32_t v = 0; v < model_.mass.size(); ++v) {
    add_diagonal(v, contact_block(step, v, x));
  }
  return matrix_;
}

double Solver::tolerance(const Eigen::VectorXd& x) const {
  const ClothSettings& s = model_.settings;
  const double heaviest = *std::max_element(model_.mass.begin(), model_.mass.end());
  // A coordinate is stored with an error of up to u |x|, at either end of a spring, which answers
  // with a force of (k + T) times the error; a vertex has at most 8 springs, and 3 coordinates.
  const double rounding =
      16 * std::sqrt(3.0) * 0x1p-53 * x.lpNorm<Eigen::Infinity>() * (s.stiffness + s.buckling_load);
  return s.tolerance * kStandardGravity * heaviest + rounding;
}

// Newton's direction; false where there is none.
bool Solver::direction(const Step& step, const Minimum& best, Eigen::VectorXd& result) {
  if (!factor_.factorize(hessian(step, best.x))) return false;
  Eigen::VectorXd permuted(best.x.size());
  for (std::size_t v = 0; v < dissection_.places.size(); ++v) {
    permuted.segment<3>(3 * dissection_.places[v]) = -best.gradient.segment<3>(3 * v);
  }
  factor_.solve_in_place(permuted);
  for (std::size_t v = 0; v < dissection_.places.size(); ++v) {
    result.segment<3>(3 * v) = permuted.segment<3>(3 * dissection_.places[v]);
  }
  return true;
}

// Each iteration goes along Newton's direction to where the slope, which begins below 0 and never
// falls, as the function is convex, is a tenth of what it was or less: the value falls on the way.
void Solver::newton(const Step& step, double tolerance, Minimum& best) {
  Eigen::VectorXd p(best.x.size());
  Eigen::VectorXd x(best.x.size());
  gradient(step, best.x, best.gradient);
  best.residual = largest_force(best.gradient);
  for (;;) {
    best.converged = best.residual <= tolerance;
    if (best.converged) return;
    if (!std::isfinite(best.residual)) {
      best.reason = "a force is not finite";
      return;
    }
    if (best.iterations >= model_.settings.max_iterations) {
      best.reason = fmt::format("{} iterations left a force of {:.3g} N, and {:.3g} N is allowed",
                                best.iterations, best.residual, tolerance);
      return;
    }
    ++best.iterations;
    if (!direction(step, best, p)) {
      best.reason = "the matrix has no Cholesky factor";
      return;
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
    best.residual = largest_force(best.gradient);
  }
}

Minimum Solver::minimize(const Step& step) {
  Minimum best;
  best.x = step.x0;
  const double h = model_.settings.time_step;
  const double heaviest = *std::max_element(model_.mass.begin(), model_.mass.end());
  const double weight = kStandardGravity * heaviest;
  double softness = kFirstRound * heaviest / (h * h);  // r, N/m
  double last_change = std::numeric_limits<double>::infinity();
  Step soft = step;
  while (softness < step.stretch) {
    soft.stretch = step.stretch * softness / (step.stretch + softness);
    soft.shift.resize(tensions_.size());
    for (std::size_t i = 0; i < tensions_.size(); ++i) soft.shift[i] = tensions_[i] / softness;
    newton(soft, kLoose * weight + tolerance(best.x), best);
    if (!best.converged) break;
    double change = 0;
    for (std::size_t i = 0; i < tensions_.size(); ++i) {
      const Vec3 now = tension(soft, i, best.x);
      change = std::max(change, (now - tensions_[i]).norm());
      tensions_[i] = now;
    }
    if (change <= kSettled * weight) break;
    if (change > kShrinks * last_change) softness *= kHarder;
    last_change = change;
  }
  if (best.converged || best.iterations == 0) newton(step, tolerance(best.x), best);
  // Where a softened problem failed, the residual is to be that of the step itself.
  if (!best.converged) {
    gradient(step, best.x, best.gradient);
    best.residual = largest_force(best.gradient);
    std::fill(tensions_.begin(), tensions_.end(), Vec3::Zero());
    return best;
  }
  for (std::size_t i = 0; i < tensions_.size(); ++i) tensions_[i] = tension(step, i, best.x);
  return best;
}

}  // namespace farcull::cloth
