// Aligned tables for people to read.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/count.h"

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

}  // namespace farcull
