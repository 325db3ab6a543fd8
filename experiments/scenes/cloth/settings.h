// The numbers that describe a cloth and its simulation.
#pragma once

#include <cstdint>

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

}  // namespace farcull
