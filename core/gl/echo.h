// Numbers that a device says back, so that lost commands are seen (assumption A7): the echo of what
// a program reads, and the sum of what was sent. core/gl/shaders/echo.glsl has the same arithmetic.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>

namespace farcull {

/// Mixes a word with its place: a bijection of the word, after which a change of any bit may change
/// every bit (the finalizer of MurmurHash3). So changes of a few words do not cancel in a sum, as
/// changes of signs or of small numbers would if words were only multiplied.
inline std::uint32_t gl_mixed(std::uint32_t word, std::uint32_t place) {
  std::uint32_t mixed = word ^ place * 0x9e3779b9u;
  mixed = (mixed ^ mixed >> 16) * 0x85ebca6bu;
  mixed = (mixed ^ mixed >> 13) * 0xc2b2ae35u;
  return mixed ^ mixed >> 16;
}

/// The sum of words, each mixed with its place.
struct GlEcho {
  std::uint32_t sum = 0;
  std::uint32_t place = 0;  // of the word that comes next

  template <class Number, std::size_t N>
  void add(const std::array<Number, N>& words) {
    for (const Number word : words) sum += gl_mixed(std::bit_cast<std::uint32_t>(word), place++);
  }
  void add(std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words) sum += gl_mixed(word, place++);
  }
  void add_at(std::uint32_t at, std::uint32_t word) { sum += gl_mixed(word, at); }
};

/// The sum of the words of `data` (a multiple of 4 bytes), each mixed with its place.
inline std::uint32_t gl_sum(std::span<const std::byte> data) {
  std::uint32_t sum = 0;
  const auto count = static_cast<std::uint32_t>(data.size() / sizeof(std::uint32_t));
  for (std::uint32_t w = 0; w < count; ++w) {
    std::uint32_t word = 0;
    std::memcpy(&word, data.data() + w * sizeof word, sizeof word);
    sum += gl_mixed(word, w);
  }
  return sum;
}

}  // namespace farcull
