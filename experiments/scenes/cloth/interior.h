// A step of the cloth as a second-order cone program, for a primal-dual method of interior points:
// of each spring, a point (t, d) of the cone t >= |d| and its dual (f, -g), f >= |g|, with
//   d the edge, t = l* + f/c, and at the solution f t - g.d = crimp or so, g the pull along d;
// of each contact, a distance s >= 0 and a force f >= 0, f s = crimp. Where Newton's method on
// positions alone creeps along the curved valley of stiff springs, here the pull g turns freely.
// Steps are those of Nesterov and Todd (1997, "Self-scaled barriers and interior-point methods").
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/scenes/cloth/model.h"

namespace farcull::cloth {

/// A point of the cone t >= |d|, or of its dual, which is the same cone.
struct ConePoint {
  double t = 0;
  Vec3 d = Vec3::Zero();
};
/// t^2 - |d|^2.
double determinant(const ConePoint& u);
/// The largest a with u + a du in the cone; infinite where there is none. u is inside.
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

}  // namespace farcull::cloth
