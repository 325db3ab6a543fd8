// The data of a page as text: numbers and bits, compressed for a reader in JavaScript
// (web/page.js).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Base64 of gzip of the numbers: each as its difference to the one before (the first to 0) modulo
/// 2^32, zigzag (0, -1, 1, -2, ... become 0, 1, 2, 3, ...); then the lowest bytes of all, the next
/// ones, and so on. Neighbours are alike, so most bytes become 0.
std::string packed_numbers(std::span<const std::uint32_t> numbers);

/// Base64 of gzip of the bytes.
std::string packed_bytes(std::string_view bytes);

/// Bits of which those of the numbers are 1, eight in a byte, the lowest first. Precondition: every
/// number is below `count`.
std::string bits_of(std::span<const std::uint32_t> numbers, std::size_t count);

/// The coordinates of all x, then of all y, then of all z, as steps of 1/65535 of the box; those of
/// points outside of it are moved into it. 0 in a direction in which the box has no extent.
std::vector<std::uint32_t> quantized(std::span<const Vec3> points, const Box& box);

}  // namespace farcull
