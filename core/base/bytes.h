// Encodes and decodes Base64. Computes two hashes of bytes: FNV-1a and SHA-256.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace farcull {

/// Returns the bytes as Base64 (RFC 4648), padded, without line breaks.
std::string to_base64(std::span<const std::uint8_t> bytes);
/// Decodes the output of to_base64(). Returns empty for any other text.
std::optional<std::vector<std::uint8_t>> from_base64(const std::string& text);

/// FNV-1a: a fast, non-cryptographic 64-bit hash of a sequence of bytes.
class Fnv1a {
 public:
  void add_byte(unsigned char byte) { hash_ = (hash_ ^ byte) * 0x100000001b3u; }
  void add(std::string_view text) {
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
  }
  /// Adds the 8 bytes of the word, the least significant byte first.
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte, word >>= 8) add_byte(static_cast<unsigned char>(word));
  }
  std::uint64_t value() const { return hash_; }
  /// Returns the hash as 16 hexadecimal digits.
  std::string hex() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// SHA-256 (FIPS 180-4), a cryptographic hash of a sequence of bytes.
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// Returns the hash as 64 lower-case hexadecimal digits. Do not use the object afterwards.
  std::string digest();

 private:
  void take_block();

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::size_t filled_ = 0;   // number of bytes of block_ in use
  std::uint64_t bytes_ = 0;  // number of bytes added so far
};

std::string sha256(std::string_view text);

}  // namespace farcull
