#include "tests/fuzz/allocations.h"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace farcull {
namespace {

struct Count {
  bool counting = false;
  std::size_t most_at_once = 0;
  std::ptrdiff_t most_alive = 0;
  std::ptrdiff_t alive = 0;  // may fall below 0: what is freed may be older than the meter
  std::ptrdiff_t peak = 0;
  std::size_t largest = 0;
  std::size_t refused = 0;        // bytes of the first allocation that was refused; 0 for none
  std::ptrdiff_t alive_then = 0;  // bytes that were alive before it
};

constinit thread_local Count count;

void* allocate(std::size_t size) {
  if (count.counting) {
    const std::ptrdiff_t alive = count.alive + static_cast<std::ptrdiff_t>(size);
    if (size > count.most_at_once || alive > count.most_alive) {
      if (count.refused == 0) {
        count.refused = size;
        count.alive_then = count.alive;
      }
      throw std::bad_alloc();
    }
    count.largest = std::max(count.largest, size);
  }
  void* const block = std::malloc(std::max<std::size_t>(size, 1));
  if (block == nullptr) throw std::bad_alloc();
  if (count.counting) {
    count.alive += static_cast<std::ptrdiff_t>(malloc_usable_size(block));
    count.peak = std::max(count.peak, count.alive);
  }
  return block;
}

void release(void* block) {
  if (count.counting && block != nullptr)
    count.alive -= static_cast<std::ptrdiff_t>(malloc_usable_size(block));
  std::free(block);
}

}  // namespace

AllocationMeter::AllocationMeter(const AllocationLimits& limits, std::size_t input_bytes)
    : input_bytes_(input_bytes) {
  count = {.counting = true,
           .most_at_once = limits.once_per_byte * input_bytes + limits.constant,
           .most_alive =
               static_cast<std::ptrdiff_t>(limits.all_per_byte * input_bytes + limits.constant)};
}

AllocationMeter::~AllocationMeter() { count.counting = false; }

std::string AllocationMeter::excess() const {
  if (count.refused == 0) return "";
  return "an allocation of " + std::to_string(count.refused) + " bytes, beside " +
         std::to_string(count.alive_then) + " alive, for an input of " +
         std::to_string(input_bytes_);
}

std::size_t AllocationMeter::largest() const { return count.largest; }
std::size_t AllocationMeter::peak() const { return static_cast<std::size_t>(count.peak); }

}  // namespace farcull

// All forms that the sanitizers' runtime would otherwise provide, so that none of its allocations
// ends here.
void* operator new(std::size_t size) { return farcull::allocate(size); }
void* operator new[](std::size_t size) { return farcull::allocate(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return farcull::allocate(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept {
  return operator new(size, tag);
}
void operator delete(void* block) noexcept { farcull::release(block); }
void operator delete[](void* block) noexcept { farcull::release(block); }
void operator delete(void* block, std::size_t) noexcept { farcull::release(block); }
void operator delete[](void* block, std::size_t) noexcept { farcull::release(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { farcull::release(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { farcull::release(block); }
