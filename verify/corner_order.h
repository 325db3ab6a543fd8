// The order in which two triangles whose planes cross are compared along the line of the planes.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace farcull {

/// Corners of a and of b, by number. Where the planes cross, each triangle covers a segment of
/// their line, from the edge to one of the other corners to the edge to the other. Seen from the
/// corner that is alone, with the other two in the order that puts the other triangle's corner on
/// the positive side, the ends are in a known order along the line, and two determinants compare
/// them (Guigue, Devillers: Fast and robust triangle-triangle overlap test using orientation
/// predicates, 2003).
struct CornerOrder {
  std::array<std::uint8_t, 3> a, b;  // the corner that is alone comes first
};

/// a_above: bit i is set if corner i of a is on the positive side of the plane of b; b_above
/// likewise. Precondition: one or two bits of each are set.
constexpr CornerOrder corner_order(unsigned a_above, unsigned b_above) {
  // Indexed by the bits of the corners above: the corner that is alone on its side.
  constexpr std::array<std::uint8_t, 8> kAlone = {0, 0, 1, 2, 2, 1, 0, 0};
  const auto from = [](std::uint8_t alone) {
    return std::array<std::uint8_t, 3>{alone, static_cast<std::uint8_t>((alone + 1) % 3),
                                       static_cast<std::uint8_t>((alone + 2) % 3)};
  };
  CornerOrder order{from(kAlone[a_above]), from(kAlone[b_above])};
  if ((a_above >> order.a[0] & 1) == 0) std::swap(order.b[1], order.b[2]);
  if ((b_above >> order.b[0] & 1) == 0) std::swap(order.a[1], order.a[2]);
  return order;
}

/// corner_order() for lookup: a_above in bits 0 to 2, b_above in bits 3 to 5.
inline constexpr std::array<CornerOrder, 64> kCornerOrders = [] {
  std::array<CornerOrder, 64> orders{};
  for (unsigned bits = 0; bits < 64; ++bits) orders[bits] = corner_order(bits & 7, bits >> 3);
  return orders;
}();

}  // namespace farcull
