// Compression by gzip (RFC 1952), by zlib: meshes are read, the data of pages are written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace farcull {

/// Whether the bytes begin as gzip data do: 1f 8b, and 8 for the method "deflate".
bool is_gzip(std::string_view bytes);

/// A little text can be compressed a thousand times, so a small file could fill the memory. Beyond
/// `free_bytes`, contents of more than `most_ratio` times the compressed size are refused.
struct GzipLimits {
  std::uint64_t max_bytes = std::uint64_t{4} << 30;
  std::uint64_t free_bytes = std::uint64_t{256} << 20;
  std::uint64_t most_ratio = 100;
};

/// The contents of gzip data: of one member, or of several one after the other, as `cat a.gz b.gz`
/// and pigz write them; zeros after the last one are passed over. Checksums and lengths are
/// compared. Throws Error naming `name` where the data are cut, damaged, followed by something
/// else, or beyond the limits; std::bad_alloc. Precondition: is_gzip(bytes).
std::string gunzip(std::string_view bytes, const std::string& name, const GzipLimits& limits = {});

/// The bytes as gzip data of one member. The same bytes give the same data with the same zlib: no
/// time and no name are in them. Throws std::bad_alloc.
std::string gzip(std::string_view bytes);

}  // namespace farcull
