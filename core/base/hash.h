// FNV-1a, the hash of fingerprints: 64 bits over a sequence of bytes.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace farcull {

class Fnv1a {
 public:
  void add_byte(unsigned char byte) { hash_ = (hash_ ^ byte) * 0x100000001b3u; }
  void add(std::string_view text) {
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
  }
  /// The bytes of the word, the lowest first.
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte, word >>= 8) add_byte(static_cast<unsigned char>(word));
  }
  /// 16 hex digits.
  std::string hex() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace farcull
