// A square cloth that falls on a fixed sphere: springs along the edges, bending across them,
// contact with friction. The cloth has no contact with itself, so its folds pass through each
// other: the scene has intersecting triangles within one moving object. docs/cloth.md derives it.
//
// A step is implicit Euler, as the minimum of a convex function of the new positions (Gast et al.
// 2015, "Optimization integrator for large time steps", made convex as in Eyre 1998). So it has one
// solution at every stiffness, and the total energy grows in a step by at most ClothReport::slack,
// up to rounding. The same settings give the same bits on the same machine.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

// The numbers that describe a cloth and its simulation.

/// All numbers are finite and in SI units.
struct ClothSettings {
  std::uint64_t triangles = 20000;  // of the cloth, 8 to 200,000; rounded to 2 m^2 for a whole m
  double stiffness = 1e4;           // of the spring along an edge, N/m; > 0
  double side = 1;                  // of the square at rest, m; > 0
  double density = 0.2;             // kg/m^2; > 0
  double buckling_load = 1;         // an edge of length l buckles at a thrust of this times l,
                                    // N/m; >= 0
  double bending_rigidity = 2e-5;   // N m; >= 0
  double gravity = 9.81;            // along -z, m/s^2; >= 0
  double drag = 0.1;                // of the air, per area and speed, N s/m^3; >= 0
  double radius = 0.15;             // of the sphere about the origin, m; 0: there is no contact,
                                    // and the object "sphere" has no triangles
  double contact_modulus = 1e6;     // pressure per depth below the sphere's surface, N/m^3; > 0
  double friction = 0.3;            // Coulomb's coefficient between cloth and sphere; >= 0
  double stick_speed = 0.01;        // below it friction falls linearly to 0, m/s; > 0
  double height = 0.02;             // of the cloth above the sphere at the start, m; >= 0
  double time_step = 0.01;          // s; > 0
  double tolerance = 1e-3;          // largest residual, as a fraction of the weight of the heaviest
                                    // vertex (at 9.81 m/s^2); > 0
  int max_iterations = 400;         // factorizations in a step, at most; >= 0
  std::uint64_t seed = 1;           // of the random heights that break the symmetry at the start
};

}  // namespace farcull

// Minimizes the function of a time step.
namespace farcull::cloth {

// The cloth as springs, hinges and masses, and the convex function whose minimum is a time step.
// docs/cloth.md has the equations and the proof of the energy bound, with the same names as here.
//
// Positions, velocities and forces are vectors of 3 numbers per vertex: x0 y0 z0 x1 y1 z1 ...

inline constexpr double kStandardGravity = 9.81;  // m/s^2, for weights as units of force

/// A spring along an edge. At length l its force is stiffness * (l - length), but not less than
/// -buckling_load * l: a shorter spring buckles. smooth_force() rounds this corner off.
struct Spring {
  std::array<std::uint32_t, 2> vertices;
  double length = 0;  // at rest, m
};

/// A spring of rest length 0 across an edge, between a point of the edge and a point of the segment
/// between the opposite corners; at rest these points coincide. w, the vector between them, is the
/// sum of weight * vertex; the weights sum to 0. Energy: stiffness / 2 * |w|^2.
struct Hinge {
  std::array<std::uint32_t, 4> vertices;
  std::array<double, 4> weights;
  double stiffness = 0;  // N/m
};

struct Model {
  ClothSettings settings;
  std::uint32_t cells = 0;  // along a side; `m` in comments
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<double> area;  // per vertex, m^2: a third of its triangles
  std::vector<double> mass;  // per vertex, kg
  double crimp = 0;          // of smooth_force(), for all springs and contacts, J
  std::vector<Spring> springs;
  std::vector<Hinge> hinges;
  Eigen::VectorXd rest;  // the initial positions, m
};

/// Throws Error naming "cloth" if a setting is out of range.
Model make_model(const ClothSettings& settings);

struct Energies {
  double kinetic = 0;
  double elastic = 0;
  double bending = 0;
  double gravitational = 0;
  double contact = 0;
};
/// The energies of a state, J. Contact is with the sphere itself, not with its planes as in a step.
Energies energies(const Model& model, const Eigen::VectorXd& x, const Eigen::VectorXd& velocity);

/// One step from x0 with velocity v0: minimize
///   sum m/(2 h^2) |x - x0 - h v0|^2 + drag area/(2 h) |x - x0|^2      inertia, air
///   + sum S(k + T, l - l*) - T d0.d                                   springs; l* = k L/(k + T)
///   + bending(x) + sum m g z
///   + sum S(c, R - n.x) + mu N H(|P (x - x0)|)                        contact, friction
/// with h = time_step, k = stiffness, T = buckling_load, L = the length at rest, R = radius, mu =
/// friction, S = smooth_energy, d an edge, l = |d|, d0 the same edge at x0, n = x0/|x0|, P = I - n
/// n', c = contact_stiffness, N the contact force at x0, and H Huber's function: s^2/(2 e) for s <=
/// e = h stick_speed, s - e/2 above. Strictly convex.
struct Step {
  const Model& model;
  Eigen::VectorXd x0;
  Eigen::VectorXd v0;
  std::vector<Vec3> normal;      // per vertex; all 0 if there is no sphere
  std::vector<double> friction;  // per vertex: mu N, newtons
  double stretch = 0;            // k + T, N/m
};
/// Precondition: sizes are those of the model. The model must outlive the step.
Step make_step(const Model& model, const Eigen::VectorXd& x0, const Eigen::VectorXd& v0);

/// The gradient of this function at x, N. Resizes `result`.
void gradient(const Step& step, const Eigen::VectorXd& x, Eigen::VectorXd& result);

/// The force (N) of a spring of stiffness c that is stretched by e, with a smooth start: the f > 0
/// with f (f/c - e) = crimp. Nearly c e if e is far above 0, nearly crimp/-e if e is far below 0.
double smooth_force(double c, double crimp, double e);
/// The derivative of smooth_force() by e, and the energy whose derivative smooth_force() is.
double smooth_stiffness(double c, double crimp, double e);
double smooth_energy(double c, double crimp, double e);

/// l*, the length at which the convex spring begins to pull, m.
double slack_length(const Model& model, std::size_t spring);
/// Stiffness of the sphere's surface at a vertex, N/m.
double contact_stiffness(const Model& model, std::size_t vertex);

/// The gradient without the terms in S (springs, contact), but with thrust (T d0.d) and friction.
void soft_gradient(const Step& step, const Eigen::VectorXd& x, Eigen::VectorXd& result);

/// The Hessian has a block for each pair of vertices of a spring or a hinge and for each vertex.
using Block = Eigen::Matrix3d;
/// The blocks that do not depend on x: inertia, air and bending. A pair may come several times, in
/// either order. The block of a vertex with itself is given in full, not only its lower half.
void for_constant_blocks(
    const Model& model, const std::function<void(std::uint32_t, std::uint32_t, const Block&)>& add);
/// The second derivatives of one spring's energy by the position of either end; the mixed ones are
/// the negative of this block. Positive semidefinite.
Block spring_block(const Step& step, std::size_t spring, const Eigen::VectorXd& x);
/// Contributions of contact and of friction to the block of a vertex. Positive semidefinite.
Block contact_block(const Step& step, std::uint32_t vertex, const Eigen::VectorXd& x);
Block friction_block(const Step& step, std::uint32_t vertex, const Eigen::VectorXd& x);

/// A point of the cone t >= |d|, or of its dual, which is the same cone.
struct ConePoint {
  double t = 0;
  Vec3 d = Vec3::Zero();
};
/// t^2 - |d|^2.
double determinant(const ConePoint& u);
/// The largest a with u + a du in the cone; infinite if there is none. Precondition: u is inside.
double reach(const ConePoint& u, const ConePoint& du);

class Interior {
 public:
  /// Starts inside the cones, from the positions x. `complementarity`: the initial product of each
  /// spring's u and its dual z, and of each contact's s and f, J. The step must outlive this
  /// object.
  Interior(const Step& step, const Eigen::VectorXd& x, double complementarity);

  /// Mean of the complementarities, J.
  double complementarity() const;

  /// Sets up the equations of the next direction, which aims at complementarity `target`. Then the
  /// functions below give the blocks and forces that springs and contacts, whose own unknowns are
  /// eliminated, add to the equations of the positions.
  void linearize(const Eigen::VectorXd& x, double target);
  const Block& spring_block(std::size_t spring) const { return springs_[spring].block; }
  const Vec3& spring_force(std::size_t spring) const { return springs_[spring].force; }
  Block contact_block(std::size_t vertex) const;
  Vec3 contact_force(std::size_t vertex) const;

  /// Moves the positions and all other unknowns along the direction, as far as the cones allow.
  /// Returns the fraction that it moved, at most 1. Precondition: linearize() was called at x.
  double move(const Eigen::VectorXd& direction, Eigen::VectorXd& x);

 private:
  struct SpringState {
    double length = 0;  // l*
    ConePoint u;
    ConePoint z;
    ConePoint du;
    ConePoint dz;
    double across = 0;  // scaling of t with t, plus stiffness
    double right = 0;   // right hand side of the equation of t
    Vec3 mixed;         // scaling of t with d
    Block whole;        // scaling of d with d
    Block block;        // added to the matrix; t is eliminated
    Vec3 force;         // added to the force
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
  double residual = 0;       // largest force on a vertex, N; infinite if a force is not finite
  int iterations = 0;        // factorizations
  bool converged = false;    // residual <= tolerance(x)
  std::string reason = {};   // why it did not converge
};

/// Keeps the pattern of the model's matrix between steps, and whether the last step needed interior
/// points. The model must outlive it.
class Solver {
 public:
  explicit Solver(const Model& model);

  /// Minimizes from x0 by Newton's method with a search along each direction; if that gets stuck,
  /// by interior points, then by Newton's method from their result.
  Minimum minimize(const Step& step);

  /// Largest residual at which a step has converged, N: the setting plus the effect of rounding x.
  double tolerance(const Eigen::VectorXd& x) const;

  /// The Hessian at x: the lower triangle.
  const Eigen::SparseMatrix<double>& hessian(const Step& step, const Eigen::VectorXd& x);

 private:
  using Slot = std::array<int, 3>;  // per column of a block: where its first value is stored
  Slot slot(std::uint32_t a, std::uint32_t b) const;
  void assemble(const std::function<Block(std::size_t)>& of_spring,
                const std::function<Block(std::uint32_t)>& of_vertex);
  bool solve(const Eigen::VectorXd& right, Eigen::VectorXd& result);
  bool newton(const Step& step, int iterations, int creeps, Minimum& best);
  void interior(const Step& step, Minimum& best);

  const Model& model_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<double> constant_;    // the part of the values that x does not change
  std::vector<Slot> vertex_slots_;  // per vertex
  std::vector<Slot> spring_slots_;  // per spring: of the block of its two ends
  bool was_stiff_ = false;          // the last step needed interior points
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;  // of matrix_
};

}  // namespace farcull::cloth

namespace farcull {

/// The outcome of a step, and the energies (J) after it.
struct ClothReport {
  long frame = 0;  // number of steps so far, this one included; 0: before the first
  double kinetic = 0;
  double elastic = 0;  // of the springs, stretched or compressed
  double bending = 0;
  double gravitational = 0;  // 0 at the centre of the sphere
  double contact = 0;        // of the sphere's surface; like `elastic`, slightly below 0
                             // if everything is slack (docs/cloth.md, crimp)
  double residual = 0;       // largest force on a vertex that the step left unbalanced, N
  double slack = 0;          // work of the unbalanced forces in the step, J: the most that the
                             // total energy may have gained
  int iterations = 0;        // factorizations
  bool converged = true;     // residual <= its tolerance
  std::string warning = {};  // why it did not converge, and what was kept instead; else empty

  double total() const { return kinetic + elastic + bending + gravitational + contact; }
};

/// The state between two steps, and the report of the last one.
struct ClothState {
  ClothReport report = {};
  Eigen::VectorXd positions, velocities;  // m and m/s, three numbers for each vertex of the cloth
};

class Cloth {
 public:
  /// The cloth at rest above the sphere. Throws Error naming "cloth" if a setting is out of range.
  explicit Cloth(const ClothSettings& settings);
  ~Cloth();
  Cloth(Cloth&&) noexcept;
  Cloth& operator=(Cloth&&) noexcept;

  /// Two objects, "cloth" (self) and "sphere", in this order. The vertices of the cloth come first,
  /// (m + 1)^2 of them row by row. The scene always satisfies validate(). It stays the same object:
  /// step() moves its vertices.
  const Scene& scene() const;

  /// One time step. A step that does not converge leaves every vertex where it was, at speed 0. The
  /// kinetic energy is lost, and none is gained; the report says so.
  ClothReport step();

  /// The energies now. frame, residual, iterations and so on are those of the last step.
  const ClothReport& report() const;

  ClothState state() const;
  /// Takes the state and recomputes the energies of its report. Velocities that are not finite make
  /// the next step fail as described for step(). Throws std::logic_error if there are not three
  /// positions and velocities for each vertex.
  void restore(const ClothState& state);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
