// A square cloth that falls on a fixed sphere: springs along the edges, bending across them,
// contact with friction; no contact of the cloth with itself, so that folds pass through each other
// and a scene that moves has triangles of one object that intersect. docs/cloth.md derives it.
//
// A step is implicit Euler, as the minimum of a convex function of the new positions (Gast et al.
// 2015, "Optimization integrator for large time steps", made convex as in Eyre 1998). So it has one
// solution at every stiffness, and the total energy of a report exceeds that of the report before
// it by no more than `slack`, but for rounding. The same settings give the same bits on the same
// machine.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>

#include "core/scene.h"

namespace farcull {

/// All numbers finite and in SI units.
struct ClothSettings {
  std::uint64_t triangles = 20000;  // of the cloth, 8 to 200,000: 2 m^2 for the nearest m
  double stiffness = 1e4;           // of the spring along an edge, N/m; > 0
  double side = 1;                  // of the square at rest, m; > 0
  double density = 0.2;             // kg/m^2; > 0
  double buckling_load = 1;         // an edge of length l gives way at a thrust of this times l,
                                    // N/m; >= 0
  double bending_rigidity = 2e-5;   // N m; >= 0
  double gravity = 9.81;            // along -z, m/s^2; >= 0
  double drag = 0.1;                // of the air, per area and speed, N s/m^3; >= 0
  double radius = 0.15;             // of the sphere about the origin, m; 0: there is no contact,
                                    // and the object "sphere" has no triangles
  double contact_modulus = 1e6;     // pressure per depth of the sphere's surface, N/m^3; > 0
  double friction = 0.3;            // Coulomb's coefficient between cloth and sphere; >= 0
  double stick_speed = 0.01;        // below it friction falls linearly to 0, m/s; > 0
  double height = 0.02;             // of the cloth above the sphere at the start, m; >= 0
  double time_step = 0.01;          // s; > 0
  double tolerance = 1e-3;          // of the residual, as a part of the weight of the largest
                                    // vertex mass (at 9.81 m/s^2); > 0
  int max_iterations = 400;         // factorizations in a step, at most; >= 0
  std::uint64_t seed = 1;           // of the unevenness that breaks the symmetry at the start
};

/// What a step did, and the energies (J) after it.
struct ClothReport {
  long frame = 0;  // number of steps so far, this one included; 0: before the first
  double kinetic = 0;
  double elastic = 0;  // of the springs, stretched or compressed
  double bending = 0;
  double gravitational = 0;  // 0 at the centre of the sphere
  double contact = 0;        // of the sphere's surface; like `elastic`, a trifle below 0
                             // where all is slack (docs/cloth.md, crimp)
  double residual = 0;       // largest force on a vertex that the step left unbalanced, N
  double slack = 0;          // work of the unbalanced forces in the step, J: what the total energy
                             // may have gained
  int iterations = 0;        // factorizations
  bool converged = true;     // residual <= its tolerance
  std::string warning = {};  // why not, and what was kept instead; empty where it converged

  double total() const { return kinetic + elastic + bending + gravitational + contact; }
};

class Cloth {
 public:
  /// The cloth at rest above the sphere. Throws Error naming "cloth" if a setting is out of range.
  explicit Cloth(const ClothSettings& settings);
  ~Cloth();
  Cloth(Cloth&&) noexcept;
  Cloth& operator=(Cloth&&) noexcept;

  /// Two objects, "cloth" (self) and "sphere", in this order; the vertices of the cloth come first,
  /// (m + 1)^2 of them row by row. It always satisfies validate(). The same object throughout:
  /// step() moves its vertices.
  const Scene& scene() const;

  /// One time step. A step that does not converge leaves every vertex where it was, at speed 0,
  /// which loses the kinetic energy and gains none; the report says so.
  ClothReport step();

  /// The energies now. frame, residual, iterations and so on are those of the last step.
  const ClothReport& report() const;

  /// m/s, three numbers for each vertex of the cloth.
  const Eigen::VectorXd& velocity() const;
  /// Replaces the velocities. Numbers that are not finite make the next step fail as said above.
  /// Throws std::logic_error if there are not three for each vertex of the cloth.
  void set_velocity(const Eigen::VectorXd& velocity);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
