// The cloth as springs, hinges and masses, and the convex function whose minimum is a time step.
// docs/cloth.md has the equations and the proof of the energy bound; the names here are its names.
//
// Positions, velocities and forces are vectors of 3 numbers per vertex: x0 y0 z0 x1 y1 z1 ...
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/scenes/cloth/settings.h"

namespace farcull::cloth {

inline constexpr double kStandardGravity = 9.81;  // m/s^2, of a weight as a unit of force

/// A spring along an edge. But for the smooth start below, its force is stiffness * (l - length)
/// while that is at least -buckling_load * l, and -buckling_load * l where it is shorter: it
/// buckles.
struct Spring {
  std::array<std::uint32_t, 2> vertices;
  double length = 0;  // at rest, m
};

/// A spring without length across an edge, between a point of the edge and one of the segment
/// between the opposite corners; at rest these coincide. Energy: stiffness / 2 * |w|^2, with w the
/// sum of weight * vertex; the weights sum to 0.
struct Hinge {
  std::array<std::uint32_t, 4> vertices;
  std::array<double, 4> weights;
  double stiffness = 0;  // N/m
};

struct Model {
  ClothSettings settings;
  std::uint32_t cells = 0;  // m, along a side
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<double> area;  // per vertex, m^2: a third of its triangles
  std::vector<double> mass;  // per vertex, kg
  double crimp = 0;          // of all smooth springs, J
  std::vector<Spring> springs;
  std::vector<Hinge> hinges;
  Eigen::VectorXd rest;  // where it starts, m
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
/// The energies of a state, J. The contact is with the sphere itself, not with planes.
Energies energies(const Model& model, const Eigen::VectorXd& x, const Eigen::VectorXd& velocity);

/// One step from x0 with velocity v0: minimize
///   sum m/(2 h^2) |x - x0 - h v0|^2 + drag area/(2 h) |x - x0|^2      inertia, air
///   + sum S(k + T, l - l*) - T d0.d                                   springs; l* = k L/(k + T)
///   + bending(x) + sum m g z
///   + sum S(c, R - n.x) + mu N H(|P (x - x0)|)                        contact, friction
/// with S = smooth_energy, d an edge and l = |d|, d0 the same at x0, n = x0/|x0|, P = I - n n', c =
/// contact_stiffness, N the contact force at x0 and H Huber's function: s^2/(2 e) for s <= e = h
/// stick_speed, s - e/2 above. Strictly convex.
struct Step {
  const Model& model;
  Eigen::VectorXd x0;
  Eigen::VectorXd v0;
  std::vector<Vec3> normal;      // per vertex; 0 where there is no contact at all
  std::vector<double> friction;  // per vertex: mu N, newtons
  double stretch = 0;            // k + T, N/m
};
/// Precondition: sizes are those of the model. The model must outlive the step.
Step make_step(const Model& model, const Eigen::VectorXd& x0, const Eigen::VectorXd& v0);

/// N. `result` gets the size of x.
void gradient(const Step& step, const Eigen::VectorXd& x, Eigen::VectorXd& result);

/// A spring of stiffness c on a length e, with a smooth start: the force f > 0 with
/// f (f/c - e) = crimp, which is c e far above 0 and crimp/-e far below. Newtons.
double smooth_force(double c, double crimp, double e);
/// Its derivative by e, and the energy whose derivative it is.
double smooth_stiffness(double c, double crimp, double e);
double smooth_energy(double c, double crimp, double e);

/// l*, where the convex spring begins, m.
double slack_length(const Model& model, std::size_t spring);
/// Stiffness of the sphere's surface at a vertex, N/m.
double contact_stiffness(const Model& model, std::size_t vertex);

/// The part of the gradient that is not of springs or contact, thrust and friction included.
void soft_gradient(const Step& step, const Eigen::VectorXd& x, Eigen::VectorXd& result);

/// The Hessian has a block for each pair of vertices of a spring or a hinge and for each vertex.
using Block = Eigen::Matrix3d;
/// The blocks that do not depend on x: inertia, air and bending. A pair may come several times, in
/// either order; the blocks of a vertex with itself are whole.
void for_constant_blocks(
    const Model& model, const std::function<void(std::uint32_t, std::uint32_t, const Block&)>& add);
/// The Hessian of one spring with respect to either end; of the mixed derivatives it is the
/// negative. Positive semidefinite.
Block spring_block(const Step& step, std::size_t spring, const Eigen::VectorXd& x);
/// Contributions of contact and of friction to the block of a vertex. Positive semidefinite.
Block contact_block(const Step& step, std::uint32_t vertex, const Eigen::VectorXd& x);
Block friction_block(const Step& step, std::uint32_t vertex, const Eigen::VectorXd& x);

}  // namespace farcull::cloth
