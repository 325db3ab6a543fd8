// Functions for all readers of meshes and scenes: reading a file into memory, decompressing gzip
// (RFC 1952), splitting text into tokens with line numbers, and rounding each number to double.
#pragma once

#include <cstddef>
#include <string_view>

#include "core/scene/scene.h"

namespace farcull {

/// Returns all bytes of a regular file. Throws Error naming the path if the file is missing, is a
/// directory or a device, cannot be read, or holds more than max_bytes.
std::string read_file(const std::string& path, std::uint64_t max_bytes);

/// Returns all bytes of standard input. Throws Error if the input cannot be read or holds more than
/// max_bytes.
std::string read_standard_input(std::uint64_t max_bytes);

/// Returns a token for a message: in quotes, as printable ASCII, cut after 40 characters.
std::string quote_token(std::string_view token);

std::string lower_case(std::string_view text);

/// Returns the bytes as UTF-8 without control characters, so that a name can go into JSON. Replaces
/// control characters and bytes that are not UTF-8 by '?'.
std::string clean_name(std::string_view bytes);

enum class Number { kOk, kMalformed, kNotFinite };

/// Reads a whole token as a decimal number, correctly rounded; a leading '+' is accepted. A number
/// that underflows becomes the nearest double, perhaps 0. Returns kNotFinite for NaN, infinity
/// and overflow. Sets `value` only if the result is kOk.
Number parse_number(std::string_view token, double& value);

/// A cursor over the lines and tokens of a text. The text and the name must outlive the reader.
/// Blanks (space, tab, CR, VT, FF) separate tokens. Lines end with LF, or with CR in a text without
/// LF. Lines without a token, and a byte order mark at the start, are skipped.
class TextReader {
 public:
  struct Rules {
    char comment = '\0';        // begins a comment where a token may begin; '\0': no comments
    bool continuation = false;  // a backslash at the end of a line joins it with the next line
  };

  TextReader(std::string_view text, std::string_view name, Rules rules);

  /// Moves to the next line that holds a token. Returns false at the end of the text.
  bool next_line();
  /// Moves to the next token, on this line or a later line. Returns false at the end of the text.
  bool seek();
  /// Returns the next token of the current line, or an empty token at the end of the line.
  std::string_view token();
  /// Returns the remaining tokens of the line, joined by single spaces.
  std::string rest();
  /// Reads the next token of the line as an integer. what: name of the number in a thrown Error.
  std::int64_t integer(std::string_view what);
  /// Reads the next token of the line as a double; NaN if no finite double can hold the number.
  /// what: name of the number in a thrown Error.
  double coordinate(std::string_view what);
  /// Reads three coordinates with coordinate().
  Vec3 point();

  /// Returns the line of the token that was read last, from 1.
  long line() const { return line_; }
  /// Returns the offset of the first byte that is not read yet.
  std::size_t offset() const { return at_; }
  std::size_t bytes_left() const { return text_.size() - at_; }
  /// Throws Error naming the current line.
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const;

 private:
  bool at_continuation(std::size_t at) const;
  void skip_blanks();

  std::string_view text_;
  std::string_view name_;
  Rules rules_;
  std::size_t at_ = 0;
  long line_ = 1;
  bool started_ = false;
  char end_ = '\n';  // the character that ends a line
};

/// True if the bytes begin with the header of gzip data that use the method "deflate".
bool is_gzip(std::string_view bytes);

/// Limits for the decompressed contents, since a small gzip file can fill the memory. Contents of
/// more than `free_bytes` are refused if they are at least `most_ratio` times as large as the
/// compressed data.
struct GzipLimits {
  std::uint64_t max_bytes = std::uint64_t{4} << 30;
  std::uint64_t free_bytes = std::uint64_t{256} << 20;
  std::uint64_t most_ratio = 100;
};

/// Returns the contents of gzip data. The data may have several members in a row, as pigz writes
/// them. Zeros after the last member are skipped. Throws Error naming `name` if the data are
/// truncated, damaged, followed by other bytes, or beyond the limits. Throws std::bad_alloc.
/// Precondition: is_gzip(bytes).
std::string gunzip(std::string_view bytes, const std::string& name, const GzipLimits& limits = {});

/// Returns the bytes as gzip data of one member, without a time or a name. With the same zlib, the
/// same bytes give the same data. Throws std::bad_alloc. Precondition: less than 2^32 bytes.
std::string gzip(std::string_view bytes);

}  // namespace farcull
