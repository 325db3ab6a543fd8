// The minimum of a step of the cloth: Newton's method, and interior points where that creeps.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "experiments/scenes/cloth/factor.h"
#include "experiments/scenes/cloth/model.h"

namespace farcull::cloth {

struct Minimum {
  Eigen::VectorXd x;
  Eigen::VectorXd gradient;  // of the step's function at x, N
  double residual = 0;       // largest force on a vertex in it, N; infinite where one is not finite
  int iterations = 0;        // factorizations
  bool converged = false;    // residual <= tolerance(x)
  std::string reason = {};   // why it did not converge
};

/// Keeps from step to step the pattern of the matrix, which is that of the model, and whether the
/// last step needed interior points. The model must outlive it.
class Solver {
 public:
  explicit Solver(const Model& model);

  /// Minimizes from x0: by Newton's method with a search along each direction; if that gets stuck,
  /// by interior points and Newton's method from where they end.
  Minimum minimize(const Step& step);

  /// Whether the last step needed interior points: all that a step leaves to the next one.
  bool was_stiff() const { return was_stiff_; }
  void set_was_stiff(bool was_stiff) { was_stiff_ = was_stiff; }

  /// N: the setting, and what the rounding of the positions themselves leaves.
  double tolerance(const Eigen::VectorXd& x) const;

  /// The Hessian at x: the lower triangle, in the order of places().
  const Eigen::SparseMatrix<double>& hessian(const Step& step, const Eigen::VectorXd& x);
  /// Per vertex: its place in the matrix, in blocks of 3.
  const std::vector<std::uint32_t>& places() const { return dissection_.places; }

 private:
  using Slot = std::array<int, 3>;  // per column of a block: where its first value is stored
  Slot slot(std::uint32_t a, std::uint32_t b) const;
  void assemble(const std::function<Block(std::size_t)>& of_spring,
                const std::function<Block(std::uint32_t)>& of_vertex);
  bool solve(const Eigen::VectorXd& right, Eigen::VectorXd& result);
  bool newton(const Step& step, int iterations, int creeps, Minimum& best);
  void interior(const Step& step, Minimum& best);

  const Model& model_;
  Dissection dissection_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<double> constant_;    // values of the matrix that no x changes
  std::vector<Slot> vertex_slots_;  // per vertex
  std::vector<Slot> spring_slots_;  // per spring: of its two ends
  bool was_stiff_ = false;
  Factor factor_;
};

}  // namespace farcull::cloth
