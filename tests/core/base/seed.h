// Seeds of random tests: the fixed one of the test, which stays as regression, and one of the day,
// so that inputs are tried that nobody has tried before.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace farcull {

/// FARCULL_SEED, else today's date in UTC as a number (20261125). Every test program prints it at
/// its start and beside a failure. Rapidcheck's own properties use it too, unless RC_PARAMS is set.
std::uint64_t seed_of_day();

/// A seed of the day for the loop that has this fixed seed; loops with other seeds get others.
std::uint64_t seed_of_day(std::uint64_t fixed);

/// The seeds of a loop. What asserts power (that something is lost, or culled) belongs to the fixed
/// one, whose counts are known; of the day's inputs only the promise is asserted.
inline std::array<std::uint64_t, 2> seeds(std::uint64_t fixed) {
  return {fixed, seed_of_day(fixed)};
}

/// The seed of scene i of n: one half has the fixed seeds 0 .. n / 2 - 1, the other those of the
/// day.
inline std::uint64_t nth_seed(std::uint64_t i, std::uint64_t n) {
  return i < n / 2 ? i : seed_of_day(i);
}

/// A file of the build tree for a minimized input that failed, to be moved to tests/cases. Makes
/// the folder.
std::filesystem::path failure_file(const std::string& name);

}  // namespace farcull
