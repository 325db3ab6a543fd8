// Pseudorandom numbers that are the same on every platform.
#pragma once

#include <cstdint>
#include <random>

namespace farcull {

/// The finalizer of splitmix64: every bit of the result depends on every bit of x (Steele, Lea,
/// Flood: Fast splittable pseudorandom number generators, 2014).
constexpr std::uint64_t scrambled(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
/// 2^64 divided by the golden ratio: an odd constant for mixing bits.
constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;

/// Random numbers from std::mt19937_64, whose output the C++ standard specifies. The distributions
/// of <random> differ between standard libraries, so this class has its own mappings.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : words_(seed) {}

  std::uint64_t word() { return words_(); }
  /// Returns a number in [0, 1): the 53 high bits of a word, divided by 2^53.
  double unit() { return static_cast<double>(word() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  /// Returns -1 or 1.
  double sign() { return (word() & 1) != 0 ? 1 : -1; }
  /// Returns a word modulo n; the distribution is not exactly uniform. Precondition: n >= 1.
  template <class Integer>
  Integer below(Integer n) {
    return static_cast<Integer>(word() % static_cast<std::uint64_t>(n));
  }

 private:
  std::mt19937_64 words_;
};

}  // namespace farcull
