// Pairs of triangles that are hard to decide: generators by name, for tests and for running the
// exact oracles against each other.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/scene/scene.h"

namespace farcull {

/// Two triangles with finite coordinates; either may be degenerate.
struct PairOfTriangles {
  std::array<Vec3, 3> a, b;
};

/// Draws of whole numbers and of chances.
class PairRandom : public RandomNumbers {
 public:
  using RandomNumbers::RandomNumbers;

  /// lo .. hi, both included.
  int whole(int lo, int hi) { return lo + below(hi - lo + 1); }
  bool chance(int of) { return below(of) == 0; }
};

struct PairGenerator {
  std::string name;
  std::string description;  // one line
  PairOfTriangles (*make)(PairRandom&);
};

/// Each makes pairs that meet and pairs that do not; in every one, either is at least one in fifty.
const std::vector<PairGenerator>& pair_generators();

}  // namespace farcull
