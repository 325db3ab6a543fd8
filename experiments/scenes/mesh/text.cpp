// Reads files and tokens. Compressed data are decompressed piece by piece, so that memory grows
// with the real contents, not with a length that the data claim.
#include "experiments/scenes/mesh/text.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

#include "core/base/error.h"

namespace farcull {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Returns the length of the UTF-8 sequence at `at`. Returns 0 if the bytes are not valid UTF-8, for
// example overlong forms and surrogates.
std::size_t utf8_length(std::string_view bytes, std::size_t at) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0u;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf5 ? 0 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || length == 0) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  const unsigned second = byte(1);
  if (first == 0xe0 && second < 0xa0) return 0;
  if (first == 0xed && second > 0x9f) return 0;
  if (first == 0xf0 && second < 0x90) return 0;
  if (first == 0xf4 && second > 0x8f) return 0;
  return length;
}

// True if a decimal number is too small for a double, false if the number is too large.
// Precondition: one of the two is true. So the sign of the number's decimal exponent decides.
bool underflows(std::string_view digits) {
  constexpr long kFar = 1'000'000'000;
  long exponent = 0;
  const std::size_t e = digits.find_first_of("eE");
  if (e != std::string_view::npos) {
    std::string_view text = digits.substr(e + 1);
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    for (const char c : text) exponent = std::min(exponent * 10 + (c - '0'), kFar);
    if (negative) exponent = -exponent;
    digits = digits.substr(0, e);
  }
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::size_t first = digits.find_first_of("123456789");
  const long leading = static_cast<long>(point) - static_cast<long>(first);
  return leading + exponent < 0;
}

constexpr const char* kNameAFile = "name a file that exists and that you may read";

Error too_large(const std::string& path, std::uint64_t max_bytes) {
  return Error(path, fmt::format("holds more than {} bytes", max_bytes), "split it");
}

void read_all(std::FILE* file, const std::string& path, std::uint64_t max_bytes,
              std::string& bytes) {
  std::array<char, 4096> chunk;  // small, since a stack may have only 64 KiB
  while (const std::size_t n = std::fread(chunk.data(), 1, chunk.size(), file)) {
    bytes.append(chunk.data(), n);
    if (bytes.size() > max_bytes) throw too_large(path, max_bytes);
  }
  if (std::ferror(file))
    throw Error(path, std::string("cannot be read: ") + std::strerror(errno), kNameAFile);
}

constexpr const char* kWhole = "get the whole file, or compress the mesh again with gzip";

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
                "if it is a mesh all the same, write its contents to another file, gzip -dc FILE "
                ">OTHER, and name that");
  }
}

}  // namespace

std::string read_file(const std::string& path, std::uint64_t max_bytes) {
  const std::string remedy = kNameAFile;
  if (path.find('\0') != std::string::npos)
    throw Error(clean_name(path), "the path contains a NUL byte", remedy);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw Error(path, "the file does not exist", remedy);
  if (error) throw Error(path, "cannot be opened: " + error.message(), remedy);
  if (std::filesystem::is_directory(status)) throw Error(path, "is a directory", remedy);
  // Refuses pipes and devices, since reading a pipe may never end.
  if (!std::filesystem::is_regular_file(status))
    throw Error(path, "is not a regular file", "copy its contents to a file and name that");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) throw Error(path, std::string("cannot be opened: ") + std::strerror(errno), remedy);
  const std::uintmax_t claimed = std::filesystem::file_size(path, error);
  if (!error && claimed > max_bytes) throw too_large(path, max_bytes);

  // The size is only a hint: a file may change while it is read, and files in /proc have size 0.
  std::string bytes;
  if (!error) bytes.reserve(claimed);
  read_all(file.get(), path, max_bytes, bytes);
  return bytes;
}

std::string read_standard_input(std::uint64_t max_bytes) {
  std::string bytes;
  read_all(stdin, "standard input", max_bytes, bytes);
  return bytes;
}

std::string quote_token(std::string_view token) {
  std::string text = "'";
  for (const char c : token.substr(0, 40)) {
    if (c >= ' ' && c <= '~') {
      text += c;
    } else {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return text + (token.size() > 40 ? "...'" : "'");
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

std::string clean_name(std::string_view bytes) {
  std::string name;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t length = utf8_length(bytes, at);
    const std::string_view one = bytes.substr(at, length);
    const bool control =
        one.size() == 1 ? one[0] < ' ' || one[0] == '\x7f' : one >= "\xc2\x80" && one <= "\xc2\x9f";
    if (length == 0 || control) {
      name += '?';
      at += std::max<std::size_t>(length, 1);
    } else {
      name += bytes.substr(at, length);
      at += length;
    }
  }
  return name;
}

Number parse_number(std::string_view token, double& value) {
  // std::from_chars does not accept '+', so a '+' is removed first. "+-1" is malformed.
  if (token.starts_with('+')) {
    token.remove_prefix(1);
    if (token.starts_with('-')) return Number::kMalformed;
  }
  double parsed = 0;
  const char* const end = token.data() + token.size();
  const auto [stop, status] = std::from_chars(token.data(), end, parsed);
  if (status == std::errc::invalid_argument || stop != end) return Number::kMalformed;
  if (status == std::errc::result_out_of_range) {
    const bool negative = token.starts_with('-');
    if (!underflows(token.substr(negative ? 1 : 0))) return Number::kNotFinite;
    parsed = negative ? -0.0 : 0.0;
  }
  if (!std::isfinite(parsed)) return Number::kNotFinite;
  value = parsed;
  return Number::kOk;
}

TextReader::TextReader(std::string_view text, std::string_view name, Rules rules)
    : text_(text), name_(name), rules_(rules) {
  if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
  if (text_.find('\n') == std::string_view::npos && text_.find('\r') != std::string_view::npos)
    end_ = '\r';
}

bool TextReader::at_continuation(std::size_t at) const {
  if (!rules_.continuation || text_[at] != '\\') return false;
  const std::string_view after = text_.substr(at + 1, 2);
  return after.starts_with(end_) || after.starts_with("\r\n");
}

void TextReader::skip_blanks() {
  while (at_ < text_.size()) {
    if (text_[at_] != end_ && is_blank(text_[at_])) {
      ++at_;
    } else if (at_continuation(at_)) {
      at_ = text_.find(end_, at_) + 1;
      ++line_;
    } else {
      return;
    }
  }
}

bool TextReader::next_line() {
  // Skips the remaining tokens of this line, which may continue on the next lines of the text.
  if (started_ && rules_.continuation) {
    while (!token().empty()) {
    }
  }
  bool inside = started_;
  started_ = true;
  while (at_ < text_.size()) {
    if (!inside) {
      skip_blanks();
      if (at_ == text_.size()) return false;
      const bool comment = rules_.comment != '\0' && text_[at_] == rules_.comment;
      if (text_[at_] != end_ && !comment) return true;
    }
    const std::size_t end = text_.find(end_, at_);
    if (end == std::string_view::npos) {
      at_ = text_.size();
    } else {
      at_ = end + 1;
      ++line_;
    }
    inside = false;
  }
  return false;
}

bool TextReader::seek() {
  skip_blanks();
  const bool comment = at_ < text_.size() && rules_.comment != '\0' && text_[at_] == rules_.comment;
  if (started_ && at_ < text_.size() && text_[at_] != end_ && !comment) return true;
  return next_line();
}

std::string_view TextReader::token() {
  skip_blanks();
  const std::size_t start = at_;
  if (start < text_.size() && rules_.comment != '\0' && text_[start] == rules_.comment) return {};
  while (at_ < text_.size() && text_[at_] != end_ && !is_blank(text_[at_]) &&
         !at_continuation(at_)) {
    ++at_;
  }
  return text_.substr(start, at_ - start);
}

std::string TextReader::rest() {
  std::string joined;
  for (std::string_view part = token(); !part.empty(); part = token()) {
    if (!joined.empty()) joined += ' ';
    joined += part;
  }
  return joined;
}

double TextReader::coordinate(std::string_view what) {
  const std::string_view text = token();
  if (text.empty()) fail(fmt::format("{} is missing", what), "complete the line");
  double value = std::numeric_limits<double>::quiet_NaN();
  if (parse_number(text, value) == Number::kMalformed)
    fail(fmt::format("{} is {}, not a number", what, quote_token(text)), "write a decimal number");
  return value;
}

std::int64_t TextReader::integer(std::string_view what) {
  const std::string_view text = token();
  if (text.empty()) fail(fmt::format("{} is missing", what), "complete the line");
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const char* const begin =
      text.data() + (text.starts_with('+') && text.size() > 1 && is_digit(text[1]));
  const auto [stop, status] = std::from_chars(begin, end, value);
  if (status == std::errc::result_out_of_range)
    fail(fmt::format("{} is {}, beyond any index", what, quote_token(text)), "correct the number");
  if (status != std::errc() || stop != end)
    fail(fmt::format("{} is {}, not an integer", what, quote_token(text)), "write an integer");
  return value;
}

Vec3 TextReader::point() {
  Vec3 p;
  p.x() = coordinate("x");
  p.y() = coordinate("y");
  p.z() = coordinate("z");
  return p;
}

void TextReader::fail(const std::string& reason, const std::string& remedy) const {
  throw Error(std::string(name_), reason, remedy, line_);
}

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b\x08"); }

std::string gunzip(std::string_view bytes, const std::string& name, const GzipLimits& limits) {
  Inflater inflater;
  z_stream& stream = inflater.stream;
  std::string text;
  std::array<char, 1 << 14> piece;
  std::string_view rest = bytes;
  while (is_gzip(rest)) {
    for (int code = Z_OK; code != Z_STREAM_END;) {
      // zlib takes lengths of 32 bits, so each call gets at most 1 GiB.
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
      // zlib has used all input, but the gzip member has not ended.
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
  while (code == Z_OK) {
    if (stream.avail_in == 0 && !bytes.empty()) {  // zlib counts the bytes in 32 bits
      const std::size_t length = std::min<std::size_t>(bytes.size(), 1u << 30);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
      stream.avail_in = static_cast<uInt>(length);
      bytes.remove_prefix(length);
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = piece.size();
    code = deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
    out.append(piece.data(), piece.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw std::logic_error("gzip: zlib does not end");
  return out;
}

}  // namespace farcull
