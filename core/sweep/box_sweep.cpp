// Insertion sort moves the ends of the last call into their new order and reports which ends
// changed places.
#include "core/sweep/box_sweep.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "core/scene/box_join.h"
#include "core/sweep/insertion_sort.h"

namespace farcull {

using sweep::insertion_sort;
using sweep::meet;

namespace {

void sort_each_once(std::vector<TrianglePair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace

/// By value; at equal values lower ends come first, since touching boxes overlap.
bool BoxSweep::before(const End& e, const End& f) {
  return e.value < f.value || (e.value == f.value && (e.box_and_side & 1) < (f.box_and_side & 1));
}

// The state of the pairs is right after an update. Along one axis two boxes that are not empty
// overlap iff each lower end stands before the upper end of the other one, equal coordinates
// included, since there lower ends come first. Insertion sort exchanges two ends iff their order
// changed. So a pair that came to overlap was apart along some axis, where a lower end of one
// passed an upper end of the other; a pair that came apart did so along some axis, where an upper
// end passed a lower one. Whether it overlapped before and does now is asked of the boxes
// themselves.
const std::vector<TrianglePair>& BoxSweep::update(std::span<const Box> boxes) {
  swaps_ = 0;
  std::vector<std::uint32_t> present;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].is_empty()) present.push_back(i);
  }
  from_scratch_ = present != present_ || boxes.size() != boxes_.size();
  present_ = std::move(present);
  appeared_.clear();
  vanished_.clear();
  for (int axis = 0; axis < 3 && !from_scratch_; ++axis) from_scratch_ = !sort_axis(axis, boxes);
  if (from_scratch_) {
    start(boxes);
  } else {
    sort_each_once(appeared_);
    sort_each_once(vanished_);
    std::vector<TrianglePair> stay, all;
    std::set_difference(pairs_.begin(), pairs_.end(), vanished_.begin(), vanished_.end(),
                        std::back_inserter(stay));
    std::set_union(stay.begin(), stay.end(), appeared_.begin(), appeared_.end(),
                   std::back_inserter(all));
    pairs_ = std::move(all);
  }
  boxes_.assign(boxes.begin(), boxes.end());
  return pairs_;
}

void BoxSweep::start(std::span<const Box> boxes) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<End>& ends = ends_[axis];
    ends.clear();
    for (const std::uint32_t i : present_) {
      ends.push_back({boxes[i].lo[axis], 2 * i});
      ends.push_back({boxes[i].hi[axis], 2 * i + 1});
    }
    std::sort(ends.begin(), ends.end(), [](const End& e, const End& f) { return before(e, f); });
  }
  std::vector<std::uint32_t> each(boxes.size());
  std::iota(each.begin(), each.end(), 0u);
  pairs_ = box_join(boxes, each, present_);
}

bool BoxSweep::sort_axis(int axis, std::span<const Box> boxes) {
  for (End& end : ends_[axis]) {
    const Box& box = boxes[end.box_and_side / 2];
    end.value = end.box_and_side & 1 ? box.hi[axis] : box.lo[axis];
  }
  const auto less = [](const End& e, const End& f) { return before(e, f); };
  return insertion_sort(std::span(ends_[axis]), swaps_, less, [&](const End& e, const End& f) {
    if (((e.box_and_side ^ f.box_and_side) & 1) == 0) return;  // both lower or both upper ends
    const std::uint32_t i = e.box_and_side / 2, j = f.box_and_side / 2;
    if (i == j) return;
    const TrianglePair pair{std::min(i, j), std::max(i, j)};
    if ((e.box_and_side & 1) != 0) {
      if (meet(boxes_[i], boxes_[j])) vanished_.push_back(pair);
    } else if (meet(boxes[i], boxes[j])) {
      appeared_.push_back(pair);
    }
  });
}

void BoxSweep::forget() {
  present_.clear();
  boxes_.clear();
  pairs_.clear();
  for (auto& ends : ends_) ends.clear();
}

}  // namespace farcull
