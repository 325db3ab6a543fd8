// Differences of numbers by byte, compressed by zlib and written as Base64.
#include "experiments/picture/page_blocks.h"

#include <algorithm>
#include <cmath>

#include "core/base/base64.h"
#include "experiments/scenes/mesh/gzip.h"

namespace farcull {

std::string packed_bytes(std::string_view bytes) {
  const std::string small = gzip(bytes);
  return to_base64({reinterpret_cast<const std::uint8_t*>(small.data()), small.size()});
}

std::string packed_numbers(std::span<const std::uint32_t> numbers) {
  const std::size_t n = numbers.size();
  std::string planes(4 * n, '\0');
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t difference = numbers[i] - before;
    before = numbers[i];
    const std::uint32_t sign = difference >> 31 != 0 ? ~std::uint32_t{0} : 0;
    const std::uint32_t zigzag = difference << 1 ^ sign;
    for (std::size_t byte = 0; byte < 4; ++byte)
      planes[byte * n + i] = static_cast<char>(zigzag >> 8 * byte & 255);
  }
  return packed_bytes(planes);
}

std::string bits_of(std::span<const std::uint32_t> numbers, std::size_t count) {
  std::string out((count + 7) / 8, '\0');
  for (const std::uint32_t number : numbers)
    out[number / 8] = static_cast<char>(out[number / 8] | 1 << number % 8);
  return out;
}

std::vector<std::uint32_t> quantized(std::span<const Vec3> points, const Box& box) {
  constexpr double kSteps = 65535;
  std::vector<std::uint32_t> out;
  out.reserve(3 * points.size());
  for (int axis = 0; axis < 3; ++axis) {
    // Halves, since the extent of a box of doubles may be beyond them.
    const double lo = 0.5 * box.lo[axis], extent = 0.5 * box.hi[axis] - lo;
    for (const Vec3& p : points) {
      const double part = extent > 0 ? std::clamp((0.5 * p[axis] - lo) / extent, 0.0, 1.0) : 0;
      out.push_back(static_cast<std::uint32_t>(std::lround(kSteps * part)));
    }
  }
  return out;
}

}  // namespace farcull
