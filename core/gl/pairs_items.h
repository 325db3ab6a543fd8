// The triangles that meet a part of the window, on a GL device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/gl/pairs_run.h"

namespace farcull {

/// Items of a part of the window: whole ones (one interval in all their pixels) are heads alone
/// until they are listed, the others are records (core/gl/shaders/pair_common.glsl).
class PairItems {
 public:
  explicit PairItems(PairRun& run) : run_(run) {}

  /// The items of the part run.common.tile, counted; false: too many.
  bool make(PartMemory& memory);
  /// The same with room for as many as the forecast says, and nothing is read; false: too many.
  bool make(const PairForecast& forecast, PartMemory& memory);
  /// `shown` whole items are listed: they become records. False: too many.
  bool make_records(std::size_t shown, PartMemory& memory);

  bool empty() const { return wholes_ + items_ == 0; }
  std::size_t wholes() const { return wholes_; }
  std::size_t items() const { return items_; }  // that are not whole
  std::size_t large() const { return large_; }  // of those, compared with every triangle
  std::size_t shown() const { return shown_; }  // whole ones that are listed
  std::size_t records() const { return items_ + shown_; }
  std::uint64_t row_items() const { return row_items_; }  // work items of pixel rows

  const GlStore& record_store() const { return records_; }
  const GlStore& record_heads() const { return record_heads_; }
  const GlStore& heads() const { return heads_; }
  const GlStore& listed_flags() const { return listed_flags_; }
  const GlStore& shown_list() const { return shown_list_; }
  /// Work items of the rows of each record.
  const GlStore& rows() const { return rows_; }
  /// Work for each of them. After a forecast the numbers above are upper bounds.
  PairWork all_items() const { return {items_, kTotalItems}; }
  PairWork all_wholes() const { return {wholes_, kTotalWholes}; }
  PairWork all_shown() const { return {shown_, kTotalListed}; }
  PairWork all_rows() const { return {row_items_, kTotalRowItems}; }

 private:
  void launch(std::size_t whole_capacity, std::size_t capacity);
  bool take(PartMemory& memory) const;

  PairRun& run_;
  GlStore rows_, heads_, records_, record_heads_, listed_flags_, shown_list_;
  std::size_t wholes_ = 0, items_ = 0, large_ = 0, shown_ = 0;
  std::uint64_t row_items_ = 0;
};

}  // namespace farcull
