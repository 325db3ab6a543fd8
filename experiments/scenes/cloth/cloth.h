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
#include <optional>
#include <string>

#include "core/scene/scene.h"
#include "experiments/scenes/cloth/settings.h"

namespace farcull {

/// The outcome of a step, and the energies (J) after it.
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

/// All that the steps to come depend on, and the report of the last one.
struct ClothState {
  ClothReport report = {};
  Eigen::VectorXd positions, velocities;  // m and m/s, three numbers for each vertex of the cloth
  bool was_stiff = false;                 // the last step needed interior points
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

  /// After restore(state()) of a cloth with the same settings, the steps to come give the same bits
  /// as those of that cloth.
  ClothState state() const;
  /// The energies of the report are computed anew. Velocities that are not finite make the next
  /// step fail as said above. Throws std::logic_error if there are not three positions and
  /// velocities for each vertex.
  void restore(const ClothState& state);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The folder named by the environment variable FARCULL_CLOTH; empty where it is not set.
std::string cloth_folder();

/// The states of one cloth, one file a frame: its doubles as they are in memory, under a heading
/// that says which settings and which arithmetic they are of, with a checksum. A file appears whole
/// or not at all.
class KeptCloth {
 public:
  /// Makes FOLDER and in it the folder of these settings. Throws Error where they cannot be made.
  KeptCloth(const std::string& folder, const ClothSettings& settings);

  /// The file of a frame.
  std::string path(long frame) const;

  /// The largest frame from 1 to `frame` that has a file; 0 where none has: the start is not kept.
  long last(long frame) const;

  /// The state in the file of a frame, bit for bit as write() got it. Throws Error naming the file
  /// and the remedy where it cannot be read, is truncated or damaged, is of another frame, of other
  /// settings or of other arithmetic.
  ClothState read(long frame) const;

  /// Throws Error naming the file where the system refuses it.
  void write(const ClothState& state) const;

 private:
  std::string folder_;
  std::string heading_;  // of each file: settings and arithmetic
};

}  // namespace farcull
