// Simulates a square cloth that falls on a fixed sphere. The model has springs along the edges,
// bending across the edges, and contact with friction. The cloth does not collide with itself: its
// folds pass through each other, so triangles of the cloth intersect.
//
// The positions after a step minimize a strictly convex function. So a step has one solution at
// every stiffness. The total energy grows in a step by at most ClothReport::slack, up to rounding.
// docs/cloth.md has the equations, the sources and the proof. On one machine, equal settings give
// bitwise equal positions.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <functional>
#include <memory>

#include "core/scene/scene.h"

namespace farcull {

/// The parameters of a cloth and its simulation. All are finite and in SI units.
struct ClothSettings {
  std::uint64_t triangles = 20000;  // desired, 8 to 200,000; the actual number is 2 m^2, m integer
  double stiffness = 1e4;           // stiffness of the spring along an edge, N/m; > 0
  double side = 1;                  // side of the square at rest, m; > 0
  double density = 0.2;             // kg/m^2; > 0
  double buckling_load = 1;         // N/m; >= 0; an edge of length l buckles under a
                                    // compressive force of buckling_load * l (N)
  double bending_rigidity = 2e-5;   // N m; >= 0
  double gravity = 9.81;            // acceleration along -z, m/s^2; >= 0
  double drag = 0.1;                // air resistance per area and speed, N s/m^3; >= 0
  double radius = 0.15;  // radius of the sphere about the origin, m; 0: there is no contact,
                         // and the object "sphere" has no triangles
  double contact_modulus = 1e6;  // pressure per depth below the sphere's surface, N/m^3; > 0
  double friction = 0.3;         // Coulomb's coefficient between cloth and sphere; >= 0
  double stick_speed = 0.01;     // m/s; > 0; below this speed friction is proportional to speed
  double height = 0.02;          // height of the cloth above the sphere at the start, m; >= 0
  double time_step = 0.01;       // s; > 0
  double tolerance = 1e-3;       // a step converges at this residual force, given as a fraction
                                 // of the weight of the heaviest vertex at 9.81 m/s^2; > 0
  int max_iterations = 400;      // maximum number of factorizations in a step; >= 0
  std::uint64_t seed = 1;        // seed of the random initial heights, which break the symmetry
};

// The cloth is modelled by springs, hinges and masses. A time step minimizes a convex function.
// Positions, velocities and forces are vectors of 3 numbers per vertex: x0 y0 z0 x1 y1 z1 ...
namespace cloth {

inline constexpr double kStandardGravity = 9.81;  // m/s^2, to convert masses to weights

/// A spring along an edge. At length l its tension is the larger of stiffness * (l - length) and
/// -buckling_load * l, since a short spring buckles. smooth_force() smooths the transition.
struct Spring {
  std::array<std::uint32_t, 2> vertices;
  double length = 0;  // length at rest, m
};

/// A spring of rest length 0 between a point of an edge and a point of the segment between the two
/// corners opposite to the edge. At rest the two points coincide. The vector between the points is
/// w = sum of weights[i] * vertices[i]; the weights sum to 0. The energy is stiffness / 2 * |w|^2.
struct Hinge {
  std::array<std::uint32_t, 4> vertices;
  std::array<double, 4> weights;
  double stiffness = 0;  // N/m
};

struct Model {
  ClothSettings settings;
  std::uint32_t cells = 0;  // cells along each side of the square
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<double> area;  // for each vertex, a third of the area of its triangles, m^2
  std::vector<double> mass;  // for each vertex, kg
  double crimp = 0;          // parameter `crimp` of smooth_force(), J
  std::vector<Spring> springs;
  std::vector<Hinge> hinges;
  Eigen::VectorXd rest;  // the initial positions, m
};

/// Builds the model. Throws Error naming "cloth" if a setting is out of range.
Model make_model(const ClothSettings& settings);

/// Energies of the cloth, J.
struct Energies {
  double kinetic = 0;
  double elastic = 0;  // energy of stretched and compressed springs
  double bending = 0;
  double gravitational = 0;  // 0 at the height of the sphere's centre
  double contact = 0;        // energy of the sphere's deformed surface; `contact` and `elastic` can
                             // be slightly below 0, because smooth_force() is never 0

  double total() const { return kinetic + elastic + bending + gravitational + contact; }
};
Energies energies(const Model& model, const Eigen::VectorXd& x, const Eigen::VectorXd& velocity);

/// A time step from positions x0 and velocities v0. The new positions minimize a strictly convex
/// function F (docs/cloth.md, "A step").
struct Step {
  const Model& model;
  Eigen::VectorXd x0;
  Eigen::VectorXd v0;
  std::vector<Vec3> normal;      // unit vector from the origin to each vertex; 0 without a sphere
  std::vector<double> friction;  // per vertex, friction coefficient * contact force at x0, N
  double stretch = 0;            // stiffness + buckling_load, N/m
};
/// Preconditions: x0 (m) and v0 (m/s) have 3 numbers per vertex; the model outlives the step.
Step make_step(const Model& model, const Eigen::VectorXd& x0, const Eigen::VectorXd& v0);

/// Writes the gradient of F at x, in N, to `result`. Resizes `result`.
void gradient(const Step& step, const Eigen::VectorXd& x, Eigen::VectorXd& result);

/// Returns the force f, in N, of a spring of stiffness c stretched by e: the positive solution of f
/// (f/c - e) = crimp. f is nearly c e if e is far above 0, and nearly 0 if e is far below 0.
double smooth_force(double c, double crimp, double e);
/// Return the derivative and the integral of smooth_force() with respect to e.
double smooth_stiffness(double c, double crimp, double e);
double smooth_energy(double c, double crimp, double e);

/// Returns the length l* (m) of docs/cloth.md. In F, a spring pulls above this length.
double slack_length(const Model& model, std::size_t spring);
/// Returns the stiffness of the sphere's surface at a vertex, N/m.
double contact_stiffness(const Model& model, std::size_t vertex);

/// Writes to `result` the part of gradient() without the smooth forces of springs and contacts.
void soft_gradient(const Step& step, const Eigen::VectorXd& x, Eigen::VectorXd& result);

/// A block of the Hessian of F, for one vertex or for two vertices of a spring or a hinge.
using Block = Eigen::Matrix3d;
/// Calls add(i, j, block) for the terms of the Hessian that do not depend on x: inertia, drag and
/// bending. A block may have several terms. By symmetry, each term is passed for (i, j) or (j, i).
void for_constant_blocks(
    const Model& model, const std::function<void(std::uint32_t, std::uint32_t, const Block&)>& add);
/// Returns the second derivatives of a spring's energy with respect to the position of one end, a
/// positive semidefinite block B. The other end also has the block B. The block of both ends is -B.
Block spring_block(const Step& step, std::size_t spring, const Eigen::VectorXd& x);
/// Return the contributions of contact and friction to a vertex's block; positive semidefinite.
Block contact_block(const Step& step, std::uint32_t vertex, const Eigen::VectorXd& x);
Block friction_block(const Step& step, std::uint32_t vertex, const Eigen::VectorXd& x);

/// A point of the cone t >= |d|. The cone is self-dual.
struct ConePoint {
  double t = 0;
  Vec3 d = Vec3::Zero();
};
double determinant(const ConePoint& u);
/// Returns the largest a with u + a du in the cone; infinite if there is no largest a.
/// Precondition: u is inside the cone.
double reach(const ConePoint& u, const ConePoint& du);

struct Minimum {
  Eigen::VectorXd x;
  Eigen::VectorXd gradient;  // gradient of the step's function at x, N
  double residual = 0;       // largest force on a vertex, N; infinite if a force is not finite
  int iterations = 0;        // number of factorizations
  bool converged = false;    // residual <= Solver::tolerance(x)
  std::string reason = {};   // why the minimization failed; empty if it converged
};

/// Minimizes the function F of each Step. Between steps, keeps the sparsity pattern of the Hessian,
/// and whether the last step needed the interior-point method. The model must outlive the Solver.
class Solver {
 public:
  explicit Solver(const Model& model);

  /// Minimizes from step.x0 by Newton's method with a line search. If Newton's method is too slow,
  /// uses an interior-point method, and then Newton's method from the interior-point result.
  Minimum minimize(const Step& step);

  /// Returns the largest residual (N) at which a step counts as converged: the setting `tolerance`
  /// times the weight of the heaviest vertex, plus the effect of rounding x.
  double tolerance(const Eigen::VectorXd& x) const;

  /// Returns the lower triangle of the Hessian at x.
  const Eigen::SparseMatrix<double>& hessian(const Step& step, const Eigen::VectorXd& x);

 private:
  using Slot = std::array<int, 3>;  // per block column, the index in matrix_ of the top value
  Slot slot(std::uint32_t a, std::uint32_t b) const;
  void assemble(const std::function<Block(std::size_t)>& of_spring,
                const std::function<Block(std::uint32_t)>& of_vertex);
  bool solve(const Eigen::VectorXd& right, Eigen::VectorXd& result);
  bool newton(const Step& step, int iterations, int most_short, Minimum& best);
  void interior(const Step& step, Minimum& best);

  const Model& model_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<double> constant_;    // the values of matrix_ without the terms that depend on x
  std::vector<Slot> vertex_slots_;  // for each vertex, the slot of its diagonal block
  std::vector<Slot> spring_slots_;  // for each spring, the slot of the mixed block of its ends
  bool was_stiff_ = false;          // true if the last step needed the interior-point method
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace cloth

/// The outcome of a step, and the energies after it.
struct ClothReport : cloth::Energies {
  long frame = 0;            // number of steps so far, including this step; 0: before step 1
  double residual = 0;       // largest force on a vertex that the step left unbalanced, N
  double slack = 0;          // work of the unbalanced forces in the step, J: the total energy
                             // grew by at most this work
  int iterations = 0;        // number of factorizations
  bool converged = true;     // residual <= Solver::tolerance()
  std::string warning = {};  // why the step failed, and what was kept; empty if it converged
};

/// The state between two steps, and the report of the last step.
struct ClothState {
  ClothReport report = {};
  Eigen::VectorXd positions, velocities;  // m and m/s, three numbers for each vertex of the cloth
};

class Cloth {
 public:
  /// Puts the cloth at rest above the sphere. Throws Error naming "cloth" if a setting is invalid.
  explicit Cloth(const ClothSettings& settings);
  ~Cloth();
  Cloth(Cloth&&) noexcept;
  Cloth& operator=(Cloth&&) noexcept;

  /// Returns a scene of two objects: "cloth", tested against itself, then "sphere". The first
  /// vertices are the cloth's, row by row. The scene always satisfies validate(). step() changes
  /// the vertices of the returned object.
  const Scene& scene() const;

  /// Makes one time step. If a step does not converge, every vertex stays where it was, at speed 0.
  /// The kinetic energy is then lost, and ClothReport::warning is set.
  ClothReport step();

  const ClothReport& report() const;

  ClothState state() const;
  /// Sets the state, and recomputes the energies in its report. If velocities are not finite, the
  /// next step does not converge. Throws std::logic_error unless positions and velocities have
  /// three numbers for each vertex.
  void restore(const ClothState& state);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
