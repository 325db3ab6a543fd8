// Tests "no allocation beyond the file's size": what operator new gives to a thread, counted and
// limited. Linking allocations.cpp replaces operator new and delete of the whole program.
#pragma once

#include <cstddef>
#include <string>

namespace farcull {

/// What a reader may allocate for an input of n bytes: no single allocation of more than
/// once_per_byte * n + constant bytes, and never more than all_per_byte * n + constant bytes alive.
/// The factors are derived where a target states them.
struct AllocationLimits {
  std::size_t once_per_byte = 0, all_per_byte = 0, constant = 0;
};

/// Counts what the calling thread allocates from its construction on and frees again. One at a time
/// per thread. An allocation beyond a limit is refused with std::bad_alloc, before the memory is
/// touched. Over-aligned types and malloc (GMP, the C library) are not counted.
class AllocationMeter {
 public:
  AllocationMeter(const AllocationLimits& limits, std::size_t input_bytes);
  ~AllocationMeter();
  AllocationMeter(const AllocationMeter&) = delete;
  AllocationMeter& operator=(const AllocationMeter&) = delete;

  /// What was refused first; empty where nothing was.
  std::string excess() const;
  std::size_t largest() const;  // bytes of the largest single allocation
  std::size_t peak() const;     // most bytes alive at once

 private:
  std::size_t input_bytes_;
};

}  // namespace farcull
