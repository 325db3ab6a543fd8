// Aligned tables and numbers for people to read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace farcull {

/// Rows of cells; each column is as wide as its widest cell.
class Table {
 public:
  /// One letter a column: 'l' to the left, 'r' to the right.
  explicit Table(std::string_view alignment) : alignment_(alignment) {}
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Two blanks between columns, none at the ends of lines.
  std::string text() const;

 private:
  std::string alignment_;
  std::vector<std::vector<std::string>> rows_;
};

/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t n);
/// A number and its noun: "1 pair", "1,234 pairs".
std::string counted(std::uint64_t n, const std::string& one, const std::string& many);

}  // namespace farcull
