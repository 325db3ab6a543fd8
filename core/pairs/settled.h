// Pairs of triangles that one thread has settled: reported already, or never to be reported. Long
// lists of triangles that lie on each other share most of their pairs from pixel to pixel; a table
// of bits lets such a pair be passed over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace farcull {

/// A symmetric table of bits, one for each two triangles that have a number. It may forget a pair,
/// which is then reported again; it never holds a pair that was not settled.
class SettledPairs {
 public:
  /// Forgets everything. bytes: the size of the table, about; it always holds 64 triangles.
  void start(std::size_t bytes);

  /// Makes sure that `count` more triangles can have numbers; forgets everything where that takes
  /// it. False: the table never holds so many.
  bool reserve(std::size_t count);
  /// Grows whenever everything is forgotten: numbers of an earlier round are void.
  std::uint32_t round() const { return round_; }
  /// The number of a triangle in this round. Precondition: reserve() said that it fits.
  std::uint32_t number(std::uint32_t triangle);

  /// Words of 64 bits that hold all numbers given up to now.
  std::size_t words() const { return (count_ + 63) / 64; }
  /// Bit b of row a: the pair of the numbers a, b is settled.
  std::span<const std::uint64_t> row(std::uint32_t a) const {
    return {&bits_[a * stride_], words()};
  }
  bool settled(std::uint32_t a, std::uint32_t b) const {
    return (bits_[a * stride_ + b / 64] >> (b % 64) & 1) != 0;
  }
  void settle(std::uint32_t a, std::uint32_t b) {
    bits_[a * stride_ + b / 64] |= std::uint64_t{1} << (b % 64);
    bits_[b * stride_ + a / 64] |= std::uint64_t{1} << (a % 64);
  }

 private:
  struct Slot {
    std::uint32_t triangle, number;
  };
  std::uint32_t round_ = 0;
  std::uint32_t count_ = 0;
  std::uint32_t most_ = 0;  // triangles that can have numbers
  std::size_t stride_ = 0;  // words of a row
  std::vector<std::uint64_t> bits_;
  std::vector<Slot> slots_;  // by a hash of the triangle; a power of two, at most half full
};

}  // namespace farcull
