// The minimum of a step of the cloth: Newton's method within a proximal method of multipliers
// (Rockafellar 1976, "Augmented Lagrangians and applications of the proximal point algorithm").
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <string>
#include <vector>

#include "experiments/cloth_factor.h"
#include "experiments/cloth_model.h"

namespace farcull::cloth {

struct Minimum {
  Eigen::VectorXd x;
  Eigen::VectorXd gradient;  // of the step's function at x, N
  double residual = 0;       // largest force on a vertex in it, N; infinite where one is not finite
  int iterations = 0;        // of Newton's method: factorizations
  bool converged = false;    // residual <= tolerance(x)
  std::string reason = {};   // why it did not converge
};

/// Keeps from step to step the pattern of the matrix, which is that of the model, and the tensions
/// that the last step ended with, to begin the next with. The model must outlive it.
class Solver {
 public:
  explicit Solver(const Model& model);

  /// Minimizes from x0. Springs far stiffer than what else holds a vertex bend the valley that the
  /// minimum lies in so sharply that Newton's method creeps. So at first each is replaced by a
  /// softer one, of stiffness k r/(k + r), on a vector along it that is longer by tension/r; the
  /// tensions that come out go into the next round. Where the tensions stay, so does the minimum,
  /// and it is that of the springs as they are; the last round is with these.
  Minimum minimize(const Step& step);

  /// N: the setting, and what the rounding of the positions themselves leaves.
  double tolerance(const Eigen::VectorXd& x) const;

  /// The Hessian at x: the lower triangle, in the order of places().
  const Eigen::SparseMatrix<double>& hessian(const Step& step, const Eigen::VectorXd& x);
  /// Per vertex: its place in the matrix, in blocks of 3.
  const std::vector<std::uint32_t>& places() const { return dissection_.places; }

 private:
  using Slot = std::array<int, 3>;  // per column of a block: where its first value is stored
  Slot slot(std::uint32_t a, std::uint32_t b) const;
  void newton(const Step& step, double tolerance, Minimum& best);
  bool direction(const Step& step, const Minimum& best, Eigen::VectorXd& result);

  const Model& model_;
  Dissection dissection_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<double> constant_;    // values of the matrix that no x changes
  std::vector<Slot> vertex_slots_;  // per vertex
  std::vector<Slot> spring_slots_;  // per spring: of its two ends
  std::vector<Vec3> tensions_;      // per spring, N
  Factor factor_;
};

}  // namespace farcull::cloth
