// Assembles the Hessian into a fixed pattern, and minimizes by Newton's method with a line search
// or by interior points.
#include "experiments/scenes/cloth/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/scenes/cloth/interior.h"

namespace farcull::cloth {
namespace {

constexpr int kTrials = 60;  // along one direction; a double has no more halvings
// These change how long a step takes and not where it ends.
constexpr int kPatience = 40;      // iterations of Newton's method before interior points,
constexpr double kCreeps = 0.125;  // or three steps shorter than this; one, if the last step of
constexpr int kCreepsAtMost = 3;   // the cloth needed interior points
constexpr double kStart = 1;       // complementarity at first, over weight * length
constexpr double kEnd = 2;         // at the end, over crimp: Newton's method is quick from there

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
  // A coordinate is stored with an error of up to u |x|, at either end of a spring, which answers
  // with a force of (k + T) times the error; a vertex has at most 8 springs, and 3 coordinates.
  const double rounding =
      16 * std::sqrt(3.0) * 0x1p-53 * x.lpNorm<Eigen::Infinity>() * (s.stiffness + s.buckling_load);
  return s.tolerance * kStandardGravity * heaviest + rounding;
}

// With the matrix as it is assembled; false where it has no factor.
bool Solver::solve(const Eigen::VectorXd& right, Eigen::VectorXd& result) {
  if (!factor_.factorize(matrix_)) return false;
  Eigen::VectorXd permuted(right.size());
  for (std::size_t v = 0; v < places().size(); ++v) {
    permuted.segment<3>(3 * places()[v]) = right.segment<3>(3 * v);
  }
  factor_.solve_in_place(permuted);
  result.resize(right.size());
  for (std::size_t v = 0; v < places().size(); ++v) {
    result.segment<3>(3 * v) = permuted.segment<3>(3 * places()[v]);
  }
  return true;
}

// Each iteration goes along Newton's direction to where the slope, which begins below 0 and never
// falls, as the function is convex, is a tenth of what it was or less: the value falls on the way.
// At most `iterations`, and no more after `creeps` short steps. False if it failed for good.
bool Solver::newton(const Step& step, int iterations, int creeps, Minimum& best) {
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
    if (i == iterations || creeps == 0) return true;
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
    if (length < kCreeps) --creeps;
  }
}

// Moves best.x close to the minimum; where it fails, best.x stays.
void Solver::interior(const Step& step, Minimum& best) {
  const double heaviest = *std::max_element(model_.mass.begin(), model_.mass.end());
  Eigen::VectorXd x = best.x;
  Interior interior(step, x, kStart * kStandardGravity * heaviest * model_.springs[0].length);
  Eigen::VectorXd force;
  Eigen::VectorXd p;
  double aim = 0.1;  // the smaller, the better the last direction did
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
    for (std::uint32_t v = 0; v < model_.mass.size(); ++v) {
      force.segment<3>(3 * v) += interior.contact_force(v);
    }
    if (!solve(-force, p)) return;
    const double way = interior.move(p, x);
    aim = way > 0.8 ? 0.1 : way > 0.3 ? 0.4 : 0.9;
  }
  best.x = x;
}

Minimum Solver::minimize(const Step& step) {
  Minimum best;
  best.x = step.x0;
  if (!newton(step, kPatience, was_stiff_ ? 1 : kCreepsAtMost, best) || best.converged) {
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
