// Pairs of triangles that are hard to decide: generators by name, for tests and for running the
// exact oracles against each other.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// Two triangles with finite coordinates; either may be degenerate.
struct PairOfTriangles {
  std::array<Vec3, 3> a, b;
};

/// Draws that every platform repeats.
class PairRandom {
 public:
  explicit PairRandom(std::uint64_t seed) : words_(seed) {}

  std::uint64_t word() { return words_(); }
  int below(int n) { return static_cast<int>(words_() % static_cast<std::uint64_t>(n)); }
  /// lo .. hi, both included.
  int whole(int lo, int hi) { return lo + below(hi - lo + 1); }
  double unit() { return static_cast<double>(words_() >> 11) * 0x1p-53; }  // [0, 1)
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  bool chance(int of) { return below(of) == 0; }

 private:
  std::mt19937_64 words_;
};

struct PairGenerator {
  std::string name;
  std::string description;  // one line
  PairOfTriangles (*make)(PairRandom&);
};

/// Each makes pairs that meet and pairs that do not; in every one, either is at least one in fifty.
const std::vector<PairGenerator>& pair_generators();

}  // namespace farcull
