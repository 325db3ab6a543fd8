// The minimum of a step of the cloth: Newton's method, and interior points where that creeps; the
// matrix of both is factored by dense fronts.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "experiments/scenes/cloth/model.h"

namespace farcull::cloth {

/// A grid of side x side vertices cut in half again and again by lines two vertices wide. Vertices
/// that are at most two rows and two columns apart are on one side of a line, or one is on it.
struct Dissection {
  struct Part {
    std::uint32_t begin = 0;  // its places are begin to end - 1
    std::uint32_t end = 0;
    std::uint32_t parent = 0;  // index of the part that cuts it off; of the last: its own
  };
  std::vector<std::uint32_t> places;  // per vertex, row by row
  std::vector<Part> parts;            // by their places; parents come after what they cut off
};
Dissection dissect(std::uint32_t side);

class Factor {
 public:
  /// The pattern of `matrix`: the lower triangle of a symmetric matrix of 3 x 3 blocks (of which
  /// the diagonal ones are lower triangles), compressed, in the order of places. It couples only
  /// vertices that are at most two rows and two columns apart.
  Factor(const Dissection& dissection, const Eigen::SparseMatrix<double>& matrix);

  /// False iff the matrix, which has the pattern, is not positive definite in double.
  bool factorize(const Eigen::SparseMatrix<double>& matrix);
  /// Precondition: factorize() was last true. In the order of places.
  void solve_in_place(Eigen::VectorXd& x) const;

 private:
  struct Front {
    std::uint32_t begin = 0;  // places that are eliminated here
    std::uint32_t end = 0;
    std::uint32_t parent = 0;
    std::vector<std::uint32_t> rows;   // later places that these are coupled to, ascending
    std::vector<std::uint32_t> above;  // per row: its index among begin ... end, rows of the parent
    Eigen::MatrixXd panel;             // columns of the factor: of begin ... end; above the rest
    Eigen::MatrixXd update;            // what they leave to the parent, lower triangle
  };
  void assemble(const Eigen::SparseMatrix<double>& matrix, Front& front);
  static void extend(const Front& child, Front& parent);

  std::vector<Front> fronts_;
  std::vector<std::vector<std::uint32_t>> children_;
  std::vector<std::uint32_t> index_;  // scratch, per place: its index in the front at hand
};

/// A point of the cone t >= |d|, or of its dual, which is the same cone.
struct ConePoint {
  double t = 0;
  Vec3 d = Vec3::Zero();
};
/// t^2 - |d|^2.
double determinant(const ConePoint& u);
/// The largest a with u + a du in the cone; infinite if there is no largest one. u is inside.
double reach(const ConePoint& u, const ConePoint& du);

class Interior {
 public:
  /// Inside, from the positions. `complementarity`: of each spring and contact at first, J.
  /// The step must outlive it.
  Interior(const Step& step, const Eigen::VectorXd& x, double complementarity);

  /// Mean of the complementarities, J.
  double complementarity() const;

  /// The equations of the next direction, which aims at complementarity `target`. Per spring and
  /// vertex, what the unknown parts add to the matrix and, for d or x, to the force.
  void linearize(const Eigen::VectorXd& x, double target);
  const Block& spring_block(std::size_t spring) const { return springs_[spring].block; }
  const Vec3& spring_force(std::size_t spring) const { return springs_[spring].force; }
  Block contact_block(std::size_t vertex) const;
  Vec3 contact_force(std::size_t vertex) const;

  /// Goes along the direction as far as it may, the positions with it, and returns the part of it
  /// that was gone, at most 1. Precondition: linearize() came before, at x.
  double move(const Eigen::VectorXd& direction, Eigen::VectorXd& x);

 private:
  struct SpringState {
    double length = 0;  // l*
    ConePoint u;
    ConePoint z;
    ConePoint du;
    ConePoint dz;
    double across = 0;  // of the scaling: t with t, and stiffness
    double right = 0;   // of the equation of t
    Vec3 mixed;         // of the scaling: t with d
    Block whole;        // of the scaling: d with d
    Block block;        // of the matrix, t eliminated
    Vec3 force;         // of the right hand side
  };
  struct ContactState {
    double stiffness = 0;
    double s = 0;
    double f = 0;
    double ds = 0;
    double df = 0;
    double scaling = 0;  // f/s
    double block = 0;
    double force = 0;
    double right = 0;
    bool is_there = false;
  };

  const Step& step_;
  double target_ = 0;
  std::vector<SpringState> springs_;
  std::vector<ContactState> contacts_;  // per vertex
};

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
