// A square table of bits over numbers that triangles get in the order of their first long list, and
// a hash table with linear probing from triangles to numbers.
#include "core/pairs/settled.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace farcull {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;  // number of an empty slot
constexpr std::uint32_t kLeast = 64, kMost = 1 << 16;

}  // namespace

void SettledPairs::start(std::size_t bytes) {
  const double side = std::sqrt(8.0 * static_cast<double>(bytes));
  most_ = std::clamp(static_cast<std::uint32_t>(std::min<double>(side, kMost)) / 64 * 64, kLeast,
                     kMost);
  stride_ = most_ / 64;
  count_ = 0;
  ++round_;
  bits_.clear();
  slots_.clear();
}

bool SettledPairs::reserve(std::size_t count) {
  if (count > most_) return false;
  if (count_ + count > most_) {
    count_ = 0;
    ++round_;
    bits_.clear();
    slots_.clear();
  }
  if (slots_.empty()) slots_.assign(2 * std::bit_ceil(most_), {0, kNone});
  bits_.resize(std::max(bits_.size(), (count_ + count) * stride_), 0);
  return true;
}

std::uint32_t SettledPairs::number(std::uint32_t triangle) {
  const std::size_t mask = slots_.size() - 1;
  // Fibonacci hashing: the upper bits of the product depend on all bits of the index.
  for (std::size_t k = (triangle * 0x9e3779b97f4a7c15u) >> 40;; ++k) {
    Slot& slot = slots_[k & mask];
    if (slot.number == kNone) slot = {triangle, count_++};
    if (slot.triangle == triangle) return slot.number;
  }
}

}  // namespace farcull
