// A tree of boxes is asked about one item after the other, some side by side: the pairs of an item
// a are those with b > a, so that pairs in the order of a are in order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/boxes/join.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/base/parallel.h"
#include "core/boxes/join.h"
#include "core/boxes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

std::uint64_t find_leaves_here(const BoxTree<double>& tree, const WideBoxes<double>* blocks,
                               const Box& box, std::vector<std::uint32_t>& leaves) {
  return boxes::for_overlapping_leaves(tree, blocks, boxes::OneBox<double>(box), 0,
                                       [&](std::uint32_t leaf) { leaves.push_back(leaf); });
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

HWY_EXPORT(find_leaves_here);

namespace {

std::uint64_t find_leaves(const BoxTree<double>& tree, const WideBoxes<double>* blocks,
                          const Box& box, std::vector<std::uint32_t>& leaves) {
  return HWY_DYNAMIC_DISPATCH(find_leaves_here)(tree, blocks, box, leaves);
}

// Below so many items a second thread costs more than it saves.
constexpr std::size_t kLeast = 4096;

}  // namespace

std::vector<TrianglePair> box_join(std::span<const Box> boxes,
                                   std::span<const std::uint32_t> owners,
                                   std::span<const std::uint32_t> items, std::size_t most) {
  std::vector<TrianglePair> pairs, some;
  OrderedPairs join(boxes, owners, items, chunks_for(items.size(), kLeast) > 1 ? 0 : 1);
  while (!join.at_end() && pairs.size() <= most) {
    join.next(std::max<std::size_t>(most, 1), some);
    pairs.insert(pairs.end(), some.begin(), some.end());
  }
  if (pairs.size() > most) pairs.resize(most + 1);
  return pairs;
}

std::vector<std::uint32_t> join_owners(const Scene& scene) {
  std::vector<std::uint32_t> out = owners(scene);
  const auto objects = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    if (scene.objects[out[t]].self) out[t] = objects + t;
  }
  return out;
}

OrderedPairs::OrderedPairs(const Scene& scene, double clearance,
                           std::span<const ObjectPair> ignored, unsigned threads)
    : ignored_(IgnoredObjects(scene, ignored)),
      threads_(threads),
      owner_(join_owners(scene)),
      items_(scene.triangles.size()),
      boxes_(scene.triangles.size()) {
  std::iota(items_.begin(), items_.end(), 0u);
  for (std::uint32_t t = 0; t < boxes_.size(); ++t) boxes_[t] = grown_box(scene, t, clearance);
  plant();
}

OrderedPairs::OrderedPairs(std::span<const Box> boxes, std::span<const std::uint32_t> owners,
                           std::span<const std::uint32_t> items, unsigned threads)
    : threads_(threads), items_(items.begin(), items.end()) {
  std::erase_if(items_, [&](std::uint32_t item) { return boxes[item].is_empty(); });
  std::ranges::sort(items_);
  for (const std::uint32_t item : items_) {
    boxes_.push_back(boxes[item]);
    owner_.push_back(owners[item]);
  }
  plant();
}

void OrderedPairs::plant() {
  order_.resize(boxes_.size());
  spatial_order(boxes_, order_);
  std::vector<Box> leaves(boxes_.size());
  for (std::size_t k = 0; k < leaves.size(); ++k) leaves[k] = boxes_[order_[k]];
  blocks_.resize(blocks_of_tree(leaves.size()));
  tree_ = make_tree<double>(leaves, blocks_, 0);
}

namespace {

// Sorts numbers below 64 * marks.size(), each of which is there once. Many of them are sorted by
// marks, one bit for each number, which are left empty.
void sort_marked(std::vector<std::uint32_t>& numbers, std::vector<std::uint64_t>& marks) {
  if (numbers.size() < marks.size() / 8) {
    std::ranges::sort(numbers);
    return;
  }
  for (const std::uint32_t number : numbers) marks[number / 64] |= std::uint64_t{1} << number % 64;
  std::size_t next = 0;
  for (std::uint32_t word = 0; word < marks.size(); ++word) {
    for (; marks[word] != 0; marks[word] &= marks[word] - 1)
      numbers[next++] = 64 * word + static_cast<std::uint32_t>(std::countr_zero(marks[word]));
  }
}

}  // namespace

// Returns how many blocks were compared.
std::uint64_t OrderedPairs::append(std::uint32_t a, std::vector<std::uint32_t>& found,
                                   std::vector<std::uint64_t>& marks,
                                   std::vector<TrianglePair>& out) const {
  found.clear();
  const std::uint64_t compared = find_leaves(tree_, blocks_.data(), boxes_[a], found);
  for (std::uint32_t& leaf : found) leaf = order_[leaf];
  std::erase_if(found, [&](std::uint32_t b) { return b <= a || owner_[a] == owner_[b]; });
  sort_marked(found, marks);
  for (const std::uint32_t b : found) {
    const TrianglePair pair{items_[a], items_[b]};
    if (!ignored_ || !(*ignored_)(pair)) out.push_back(pair);
  }
  return compared;
}

void OrderedPairs::next(std::size_t most, std::vector<TrianglePair>& out) {
  out.clear();
  if (at_end()) return;
  const auto left = static_cast<std::uint32_t>(boxes_.size()) - next_;
  const std::uint32_t asked = std::min(asked_, left);
  struct Part {
    std::vector<TrianglePair> pairs;
    std::uint32_t done = 0;  // triangles whose pairs these are
    std::uint64_t compared = 0;
    bool complete = false;
  };
  std::vector<Part> parts(chunks_for(asked, 16, threads_));
  const std::size_t most_of_part = std::max<std::size_t>(most / parts.size(), 1);
  for_chunks(asked, parts.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Part& part = parts[chunk];
    std::vector<std::uint32_t> found;
    std::vector<std::uint64_t> marks(items_.size() / 64 + 1, 0);
    for (std::size_t k = begin; k < end && part.pairs.size() < most_of_part; ++k, ++part.done)
      part.compared += append(next_ + static_cast<std::uint32_t>(k), found, marks, part.pairs);
    part.complete = part.done == end - begin;
  });
  // A part that is not complete would leave a gap before the next one, which is asked again.
  bool full = false;
  for (const Part& part : parts) {
    out.insert(out.end(), part.pairs.begin(), part.pairs.end());
    next_ += part.done;
    compared_ += part.compared;
    full = !part.complete;
    if (full) break;
  }
  if (full) {
    asked_ = std::max<std::uint32_t>(asked_ / 2, 1);
  } else if (out.size() < most / 4) {
    asked_ = std::min<std::uint32_t>(asked_ * 2, 1 << 16);
  }
}

}  // namespace farcull
#endif
