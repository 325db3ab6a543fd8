// The entries of one pixel or part of a pixel as columns, and the pairs of them that meet, found on
// lanes (Google Highway): one entry is compared with as many others at once as a vector holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Entries as columns. Each column has room for kSweepPadding more, which a vector may read.
class SweepColumns {
 public:
  /// One entry.
  struct Row {
    float x0, y0, near, x1, y1, far;  // px
    std::uint32_t id;                 // names the entry in the answer; different for each entry
    std::uint32_t group;              // entries of one group make no pair
    std::uint32_t begun;  // bits; entries with a common bit make no pair: another pixel reports it
    std::uint32_t owner;  // entries of one owner that share a vertex make no pair, if so asked
    std::uint32_t v0, v1, v2;
  };

  /// Forgets all entries, and makes room for `count` of them.
  void start(std::size_t count);
  void add(const Row& row) {
    float* const number = &numbers_[count_];
    std::uint32_t* const word = &words_[count_];
    number[0] = row.x0;
    number[stride_] = row.y0;
    number[2 * stride_] = row.near;
    number[3 * stride_] = row.x1;
    number[4 * stride_] = row.y1;
    number[5 * stride_] = row.far;
    word[0] = row.id;
    word[stride_] = row.group;
    word[2 * stride_] = row.begun;
    word[3 * stride_] = row.owner;
    word[4 * stride_] = row.v0;
    word[5 * stride_] = row.v1;
    word[6 * stride_] = row.v2;
    ++count_;
  }
  /// Ends with entries that meet nothing, as far as vectors read.
  void finish();

  std::size_t size() const { return count_; }
  const float* numbers(std::size_t column) const { return &numbers_[column * stride_]; }
  const std::uint32_t* words(std::size_t column) const { return &words_[column * stride_]; }

 private:
  std::size_t count_ = 0, stride_ = 0;
  std::vector<float> numbers_;        // x0, y0, near, x1, y1, far
  std::vector<std::uint32_t> words_;  // id, group, begun, owner, v0, v1, v2
};

/// The longest vector, in entries.
constexpr std::size_t kSweepPadding = 16;

/// The state of a sweep.
struct Sweep {
  const SweepColumns* columns;
  bool sorted;              // ascending by near: partners end where one begins behind the entry
  bool drops_neighbours;    // leaves out pairs of one owner that share a vertex
  std::size_t next = 0;     // the entry that is compared next with those behind it
  std::uint64_t tests = 0;  // entries compared
};

/// Writes pairs of ids (the smaller one first) of entries that meet into `out`, and returns how
/// many. Goes on from entry sweep.next as long as `out` has room for all pairs that the next entry
/// can have; sweep.next is the number of entries when all are done. Two entries meet where their
/// closed bounds overlap in x, y and depth. The result is the same on every instruction set.
/// Precondition: out holds columns.size() + kSweepPadding pairs.
std::size_t sweep_on(Sweep& sweep, std::span<TrianglePair> out);

}  // namespace farcull
