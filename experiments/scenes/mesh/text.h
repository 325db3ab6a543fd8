// Files as bytes and as text, for all readers: reads a file into one buffer, decompresses gzip (RFC
// 1952), splits text into tokens with line numbers, and rounds numbers once, to double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/scene/scene.h"

namespace farcull {

/// All bytes of a regular file. Throws Error naming the path if it is missing, is a directory or a
/// device, cannot be read, or holds more than max_bytes.
std::string read_file(const std::string& path, std::uint64_t max_bytes);

/// All bytes of standard input. Throws Error if it cannot be read or holds more than max_bytes.
std::string read_standard_input(std::uint64_t max_bytes);

/// A token for a message: in quotes, printable ASCII, cut after 40 characters.
std::string quote_token(std::string_view token);

/// The text with A to Z in lower case.
std::string lower_case(std::string_view text);

/// The bytes as UTF-8 without control characters: each offending byte is replaced by '?'. So a name
/// can go into JSON.
std::string clean_name(std::string_view bytes);

enum class Number { kOk, kMalformed, kNotFinite };

/// Reads a whole token as a decimal number, correctly rounded; a leading '+' is accepted. A number
/// that underflows becomes the nearest double (0 included). NaN, infinity and overflow are
/// kNotFinite. value is set only with kOk.
Number parse_number(std::string_view token, double& value);

/// A cursor over the lines and tokens of a text. The text and the name must outlive it. Tokens are
/// separated by blanks (space, tab, CR, VT, FF). Lines end with LF; in a text that has CR and no
/// LF, with CR. Lines without a token are passed over but counted. A byte order mark at the start
/// is passed over.
class TextReader {
 public:
  struct Rules {
    char comment = '\0';        // a token that begins with it ends the line; none for '\0'
    bool continuation = false;  // a backslash before the end of a line joins the next line to it
  };

  TextReader(std::string_view text, std::string_view name, Rules rules);

  /// Moves to the next line that holds a token; false at the end of the text.
  bool next_line();
  /// Moves to the next token, on this line or a later one; false at the end of the text.
  bool seek();
  /// The next token of the current line; empty at its end.
  std::string_view token();
  /// The tokens that are left on the line, joined by single spaces.
  std::string rest();
  /// The next token of the line as a finite double. Throws Error calling it `what`.
  double number(std::string_view what);
  /// The next token of the line as an integer. Throws Error calling it `what`.
  std::int64_t integer(std::string_view what);
  /// number() for a coordinate, which may be infinite or a NaN.
  double coordinate(std::string_view what);
  /// The next three tokens of the line as a point, whose coordinates may be infinite or NaNs.
  /// Throws Error.
  Vec3 point();

  /// 1-based line of the token read last.
  long line() const { return line_; }
  /// Offset of the first byte that is not read yet.
  std::size_t offset() const { return at_; }
  std::size_t bytes_left() const { return text_.size() - at_; }
  /// Throws Error with the current line.
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const;

 private:
  bool at_continuation(std::size_t at) const;
  double read_number(std::string_view what, bool finite);
  void skip_blanks();

  std::string_view text_;
  std::string_view name_;
  Rules rules_;
  std::size_t at_ = 0;
  long line_ = 1;
  bool started_ = false;
  char end_ = '\n';  // of a line
};

/// Whether the bytes begin as gzip data do: 1f 8b, and 8 for the method "deflate".
bool is_gzip(std::string_view bytes);

/// Guards against small files that fill the memory: gzip can make text a thousand times smaller.
/// Beyond `free_bytes`, contents of more than `most_ratio` times the compressed size are refused.
struct GzipLimits {
  std::uint64_t max_bytes = std::uint64_t{4} << 30;
  std::uint64_t free_bytes = std::uint64_t{256} << 20;
  std::uint64_t most_ratio = 100;
};

/// The contents of gzip data with one member, or with several in a row, as `cat a.gz b.gz` and pigz
/// write them. Zeros after the last member are skipped. Checksums and lengths are checked. Throws
/// Error naming `name` if the data are cut, damaged, followed by something else, or beyond the
/// limits; std::bad_alloc. Precondition: is_gzip(bytes).
std::string gunzip(std::string_view bytes, const std::string& name, const GzipLimits& limits = {});

/// The bytes as gzip data of one member, without a time or a name: with the same zlib, the same
/// bytes give the same data. Throws std::bad_alloc.
std::string gzip(std::string_view bytes);

}  // namespace farcull
