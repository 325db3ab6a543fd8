// The bounds that Gappa proves. Each names a constant of the source and takes its value from there,
// so the constant that is proved is the constant that is compiled.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace farcull::proofs {

/// A bound, and the claim that it is large enough.
struct Bound {
  std::string name;      // of the proof
  std::string claim;     // what is proved, in words; u is the rounding unit of the arithmetic
  std::string constant;  // its name in the source
  std::string file;      // where it is defined
  double value;          // as compiled
  std::string unit;      // in which the table shows it: "u" (2^-53), "v" (2^-23), "w" (2^-24) or ""
  /// The script that claims the same with another value of the constant. Smaller values are
  /// stronger claims.
  std::function<std::string(double)> script;
  /// Gappa must not prove the script of this part of the value.
  double twin = 0.5;
};

std::vector<Bound> filter_bounds();    // verify/filter_scalars.h
std::vector<Bound> distance_bounds();  // verify/filter_scalars.h, verify/rounding.h
std::vector<Bound> map_bounds();       // core/view: the map to pixels, clipping, the budget
std::vector<Bound> fit_bounds();       // offsets/fit.inl
std::vector<Bound> slab_bounds();      // offsets/slab.glsl
std::vector<Bound> extent_bounds();    // offsets/minkowski.glsl
std::vector<Bound> bounds();

/// A part of the argument that Gappa cannot express.
struct ByHand {
  std::string statement;
  std::string place;  // page and section
  std::string joins;  // what it takes from the proofs above
};
std::vector<ByHand> proved_by_hand();

}  // namespace farcull::proofs
