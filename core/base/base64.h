// Base64 (RFC 4648), padded, without line breaks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace farcull {

std::string to_base64(std::span<const std::uint8_t> bytes);

/// Empty if to_base64() gives this text for no bytes; so the bits that padding leaves over have to
/// be 0.
std::optional<std::vector<std::uint8_t>> from_base64(const std::string& text);

}  // namespace farcull
