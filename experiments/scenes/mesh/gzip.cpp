// Feeds zlib with pieces and appends what comes out. Nothing is allocated because of a length that
// the data claim.
#include "experiments/scenes/mesh/gzip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr const char* kWhole = "get the whole file, or compress the mesh again with gzip";

// A stream of zlib that reads gzip alone, freed with the object.
class Inflater {
 public:
  Inflater() {
    constexpr int kGzipAlone = 16 + MAX_WBITS;
    const int code = inflateInit2(&stream, kGzipAlone);
    if (code == Z_MEM_ERROR) throw std::bad_alloc();
    if (code != Z_OK) throw std::logic_error("gunzip: zlib does not start");
  }
  ~Inflater() { inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream stream = {};
};

void check_size(std::uint64_t size, std::uint64_t compressed, const std::string& name,
                const GzipLimits& limits) {
  if (size > limits.max_bytes) {
    throw Error(name, fmt::format("decompresses to more than {} bytes", limits.max_bytes),
                "split the mesh");
  }
  if (size > limits.free_bytes && size / limits.most_ratio >= compressed) {
    throw Error(name,
                fmt::format("decompresses to more than {} times its {} bytes", limits.most_ratio,
                            compressed),
                "if it is a mesh all the same, decompress it with gzip -d and name the result");
  }
}

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b\x08"); }

std::string gunzip(std::string_view bytes, const std::string& name, const GzipLimits& limits) {
  Inflater inflater;
  z_stream& stream = inflater.stream;
  std::string text;
  std::array<char, 1 << 14> piece;
  std::string_view rest = bytes;
  while (is_gzip(rest)) {
    for (int code = Z_OK; code != Z_STREAM_END;) {
      // zlib's lengths are of 32 bits.
      const std::string_view input = rest.substr(0, std::size_t{1} << 30);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(input.data()));
      stream.avail_in = static_cast<uInt>(input.size());
      stream.next_out = reinterpret_cast<Bytef*>(piece.data());
      stream.avail_out = static_cast<uInt>(piece.size());
      code = inflate(&stream, Z_NO_FLUSH);
      if (code == Z_MEM_ERROR) throw std::bad_alloc();
      const std::size_t made = piece.size() - stream.avail_out;
      rest.remove_prefix(input.size() - stream.avail_in);
      check_size(text.size() + made, bytes.size(), name, limits);
      text.append(piece.data(), made);
      // Nothing could be read or written: all has been read, and the member has not ended.
      if (code == Z_BUF_ERROR) {
        throw Error(
            name,
            fmt::format("its gzip data end too early, after {} bytes of the mesh", text.size()),
            kWhole);
      }
      if (code != Z_OK && code != Z_STREAM_END) {
        throw Error(name,
                    fmt::format("its gzip data are damaged after {} bytes of the mesh: {}",
                                text.size(), stream.msg != nullptr ? stream.msg : "zlib refuses"),
                    kWhole);
      }
    }
    inflateReset(&stream);
  }
  if (rest.find_first_not_of('\0') != std::string_view::npos) {
    throw Error(name, fmt::format("{} bytes that are not gzip follow its gzip data", rest.size()),
                kWhole);
  }
  return text;
}

std::string gzip(std::string_view bytes) {
  constexpr int kGzip = 16 + MAX_WBITS, kUsualMemory = 8;
  z_stream stream = {};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, kUsualMemory,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  std::string out;
  std::array<char, 1 << 14> piece;
  int code = Z_OK;
  std::string_view rest = bytes;
  while (code == Z_OK) {
    if (stream.avail_in == 0 && !rest.empty()) {
      // zlib's lengths are of 32 bits.
      const std::size_t length = std::min<std::size_t>(rest.size(), 1u << 30);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest.data()));
      stream.avail_in = static_cast<uInt>(length);
      rest.remove_prefix(length);
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = piece.size();
    code = deflate(&stream, rest.empty() ? Z_FINISH : Z_NO_FLUSH);
    out.append(piece.data(), piece.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw std::logic_error("gzip: zlib does not end");
  return out;
}

}  // namespace farcull
