// Finds pairs of objects with BoxSweep. Puts triangles that may be in a candidate pair into columns
// parallel to the sweep axis, in the order of the last call. Then sorts and sweeps each column.
#include "core/sweep/sweep_prune.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/boxes/join.h"
#include "core/scene/pair_sort.h"

namespace farcull {
namespace {

// An insertion sort makes at most this many moves per element of its list. With more moves, a full
// sort is cheaper.
constexpr std::uint64_t kMoves = 8;

// Sorts a list that is almost sorted. Calls exchanged(e, f) when an element e moves from after an
// element f to before f. Returns false, and leaves the list unsorted, if this takes more than
// kMoves moves per element.
template <class Element, class Exchanged>
bool insertion_sort(std::span<Element> list, std::uint64_t& moves, const Exchanged& exchanged) {
  const std::uint64_t most = kMoves * list.size();
  std::uint64_t moved = 0;
  for (std::size_t i = 1; i < list.size() && moved <= most; ++i) {
    const Element element = list[i];
    std::size_t to = i;
    for (; to > 0 && element < list[to - 1]; --to) {
      exchanged(element, list[to - 1]);
      list[to] = list[to - 1];
    }
    list[to] = element;
    moved += i - to;
  }
  moves += moved;
  return moved <= most;
}

// True if the boxes overlap. Precondition: neither box is empty.
bool meet(const Box& a, const Box& b) {
  return a.lo.x() <= b.hi.x() && b.lo.x() <= a.hi.x() && a.lo.y() <= b.hi.y() &&
         b.lo.y() <= a.hi.y() && a.lo.z() <= b.hi.z() && b.lo.z() <= a.hi.z();
}

enum Mark : std::uint8_t { kDropped, kSurvives, kInOrder, kLive };

/// A triangle of a `self` object forms a group of its own, which this bit marks.
constexpr std::uint32_t kAlone = 1u << 31;

constexpr int kMostBits = 10;  // along an axis there are at most 2^10 columns

/// The lower end of a box along the axis of the sweep. index: of an item or a triangle.
struct Key {
  double lo;
  std::uint32_t index;
  bool operator<(const Key& other) const { return lo < other.lo; }
};

}  // namespace

// This is why update() is correct. Along an axis, two non-empty boxes overlap iff each lower end
// comes before the other box's upper end. At equal coordinates, lower ends come first. Insertion
// sort exchanges two ends iff their order changed. If two boxes begin to overlap, they were apart
// along some axis, so a lower end of one box passes an upper end of the other. If they cease to
// overlap, an upper end passes a lower end. At each such exchange the boxes of the two frames are
// compared.
const std::vector<TrianglePair>& BoxSweep::update(std::span<const Box> boxes) {
  swaps_ = 0;
  std::vector<std::uint32_t> present;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].is_empty()) present.push_back(i);
  }
  // If the last update() threw, the stored ends and the stored pairs may be inconsistent.
  const bool is_whole = std::exchange(is_whole_, false);
  from_scratch_ = !is_whole || present != present_ || boxes.size() != boxes_.size();
  present_ = std::move(present);
  appeared_.clear();
  vanished_.clear();
  for (int axis = 0; axis < 3 && !from_scratch_; ++axis) from_scratch_ = !sort_axis(axis, boxes);
  if (from_scratch_) {
    start(boxes);
  } else {
    appeared_ = sorted_unique({&appeared_, 1}, 1);
    vanished_ = sorted_unique({&vanished_, 1}, 1);
    std::vector<TrianglePair> stay, all;
    std::set_difference(pairs_.begin(), pairs_.end(), vanished_.begin(), vanished_.end(),
                        std::back_inserter(stay));
    std::set_union(stay.begin(), stay.end(), appeared_.begin(), appeared_.end(),
                   std::back_inserter(all));
    pairs_ = std::move(all);
  }
  boxes_.assign(boxes.begin(), boxes.end());
  is_whole_ = true;
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
    std::sort(ends.begin(), ends.end());
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
  return insertion_sort(std::span(ends_[axis]), swaps_, [&](const End& e, const End& f) {
    if (((e.box_and_side ^ f.box_and_side) & 1) == 0) return;  // two lower or two upper ends
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

SweepPruneResult SweepPrune::find(const Scene& scene) { return find(scene, triangle_boxes(scene)); }

SweepPruneResult SweepPrune::find(const Scene& scene, std::span<const Box> boxes) {
  if (boxes.size() != scene.triangles.size())
    throw std::logic_error("SweepPrune::find: not as many boxes as triangles");
  SweepPruneResult result;
  SweepPruneCounts& counts = result.counts;
  const std::vector<Box> of_objects = object_boxes(scene, boxes);
  result.object_pairs = objects_.update(of_objects);
  counts.object_pairs = result.object_pairs.size();
  counts.swaps = objects_.swaps();
  counts.sorts = objects_.sorted_from_scratch() ? 3 : 0;

  counts.objects = find_survivors(scene, boxes, of_objects, result.object_pairs);
  renew_order(boxes.size());
  choose_columns(boxes);
  fill_columns(boxes);
  const std::uint64_t swaps = counts.swaps;
  const std::vector<TrianglePair> found = sweep_columns(counts);
  // A column is filled in the order of order_. Many moves show that order_ is outdated.
  if (counts.swaps - swaps > items_.size()) {
    sort_order();
    ++counts.sorts;
  }
  result.candidates = sorted_unique({&found, 1}, 1);
  counts.triangle_pairs = result.candidates.size();

  for (const TrianglePair& pair : found) marks_[pair.a] = marks_[pair.b] = kLive;
  for (const std::uint32_t t : survivors_) {
    if (marks_[t] == kLive) result.triangles.push_back(t);
  }
  counts.triangles = result.triangles.size();
  return result;
}

void SweepPrune::forget() {
  objects_.forget();
  order_.clear();
}

/// Finds the triangles that may be in a candidate pair. The partners of a triangle are the objects
/// whose boxes meet the box of its object. A triangle survives in three cases:
/// - its box meets the box of a partner,
/// - kTries partners were compared, and none meets the box,
/// - its object is `self`.
std::uint64_t SweepPrune::find_survivors(const Scene& scene, std::span<const Box> boxes,
                                         std::span<const Box> object_boxes,
                                         std::span<const TrianglePair> object_pairs) {
  constexpr int kTries = 32;  // these tries cost about as much as sweeping one triangle
  survivors_.clear();
  marks_.assign(boxes.size(), kDropped);
  groups_.resize(boxes.size());
  // The boxes of the partners of each object, one object after the other. They are sorted below by
  // their lower ends along the axis of the sweep, so that the loop over partners may end early.
  std::vector<std::size_t> starts(scene.objects.size() + 1, 0);
  for (const TrianglePair& pair : object_pairs) ++starts[pair.a + 1], ++starts[pair.b + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Box> partners(starts.back());
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  for (const TrianglePair& pair : object_pairs) {
    partners[next[pair.a]++] = object_boxes[pair.b];
    partners[next[pair.b]++] = object_boxes[pair.a];
  }
  const int axis = axes_[0];
  std::uint64_t objects = 0;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    const bool self = object.self && object.triangle_count > 1;
    const auto begin = partners.begin() + static_cast<std::ptrdiff_t>(starts[o]);
    const auto end = partners.begin() + static_cast<std::ptrdiff_t>(starts[o + 1]);
    if (begin == end && !self) continue;
    ++objects;
    std::sort(begin, end, [axis](const Box& a, const Box& b) { return a.lo[axis] < b.lo[axis]; });
    auto last = begin;  // the partner whose box was met last
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
      const std::uint32_t t = object.first_triangle + i;
      const Box& box = boxes[t];
      if (box.is_empty()) continue;
      bool survives = self || meet(box, *last);
      int tries = 0;
      for (auto p = begin; !survives && p != end && p->lo[axis] <= box.hi[axis]; ++p) {
        const bool met = meet(box, *p);
        if (met) last = p;
        survives = met || ++tries == kTries;
      }
      if (!survives) continue;
      groups_[t] = self ? kAlone | t : o;
      marks_[t] = kSurvives;
      survivors_.push_back(t);
    }
  }
  return objects;
}

/// Chooses the axis along which boxes are shortest relative to the extent of all boxes. The axis
/// changes only if another is clearly better, since a change loses the sorted order.
void SweepPrune::choose_columns(std::span<const Box> boxes) {
  constexpr double kBetter = 2;
  Box all = Box::empty();
  Vec3 lengths = Vec3::Zero();
  const double n = static_cast<double>(survivors_.size());
  for (const std::uint32_t t : survivors_) {
    all.add(boxes[t]);
    lengths += (boxes[t].hi - boxes[t].lo) / n;
  }
  const Vec3 extent = all.hi - all.lo;
  std::array<double, 3> ratio;
  for (int axis = 0; axis < 3; ++axis) {
    const double r = lengths[axis] / extent[axis];
    ratio[axis] = std::isfinite(r) ? r : 1;  // 1 if the extent is 0 or infinite
  }
  const int before = axes_[0];
  const auto best = static_cast<int>(std::min_element(ratio.begin(), ratio.end()) - ratio.begin());
  const int sweep = ratio[best] * kBetter < ratio[before] ? best : before;
  axes_ = {sweep, (sweep + 1) % 3, (sweep + 2) % 3};
  // A column is about four times as wide as a box, so that most boxes are in one or two columns
  // along an axis. There are at most twice as many columns as boxes.
  for (int k = 0; k < 2; ++k) {
    const int axis = axes_[k + 1];
    const double columns = std::clamp(0.25 / ratio[axis], 1.0, std::exp2(kMostBits));
    const double scale = std::exp2(kMostBits) / extent[axis];
    const bool of_use = std::isfinite(scale) && scale > 0;
    from_[k] = all.lo[axis];
    scale_[k] = of_use ? scale : 0;
    bits_[k] = of_use ? std::ilogb(columns) : 0;
  }
  const int most = std::bit_width(survivors_.size());
  while (bits_[0] + bits_[1] > most) --bits_[bits_[0] < bits_[1] ? 1 : 0];
}

/// Makes order_ the list of survivors. Triangles that were in order_ before keep their order.
void SweepPrune::renew_order(std::size_t triangles) {
  std::size_t kept = 0;
  for (const std::uint32_t t : order_) {
    if (t >= triangles || marks_[t] != kSurvives) continue;
    marks_[t] = kInOrder;
    order_[kept++] = t;
  }
  order_.resize(kept);
  for (const std::uint32_t t : survivors_) {
    if (marks_[t] == kSurvives) order_.push_back(t);
  }
}

/// Puts the triangles into their columns, in the order of order_. Long boxes are in many columns.
/// Doubles the width of the columns until the mean entries per triangle are at most kEntries.
void SweepPrune::fill_columns(std::span<const Box> boxes) {
  constexpr std::uint64_t kEntries = 4;
  const auto [sweep, u, v] = axes_;
  // column() is monotone in x. So if two boxes overlap, both are in the column that contains the
  // larger of their lower ends.
  const auto column = [this](double x, int k) {
    const double at = scale_[k] > 0 ? (x - from_[k]) * scale_[k] : 0;
    const auto index = static_cast<unsigned>(std::clamp(at, 0.0, std::exp2(kMostBits) - 1));
    return static_cast<std::uint16_t>(index >> (kMostBits - bits_[k]));
  };
  items_.resize(order_.size());
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const std::uint32_t t = order_[i];
    const Box& box = boxes[t];
    items_[i] = {
        {box.lo[sweep], box.lo[u], box.lo[v]},
        {box.hi[sweep], box.hi[u], box.hi[v]},
        t,
        groups_[t],
        {column(box.lo[u], 0), column(box.hi[u], 0), column(box.lo[v], 1), column(box.hi[v], 1)}};
    total += items_[i].range.columns();
  }
  while (total > kEntries * items_.size()) {
    const int k = bits_[0] < bits_[1] ? 1 : 0;
    --bits_[k];
    total = 0;
    for (Item& item : items_) {
      Range& r = item.range;
      if (k == 0) {
        r.u0 /= 2, r.u1 /= 2;
      } else {
        r.v0 /= 2, r.v1 /= 2;
      }
      total += r.columns();
    }
  }
  starts_.assign((std::size_t{1} << (bits_[0] + bits_[1])) + 1, 0);
  const auto for_columns = [this](const Range& range, const auto& visit) {
    for (std::size_t y = range.v0; y <= range.v1; ++y) {
      for (std::size_t x = range.u0; x <= range.u1; ++x) visit(x + (y << bits_[0]));
    }
  };
  for (const Item& item : items_) for_columns(item.range, [this](std::size_t c) { ++starts_[c]; });
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  entries_.resize(total);
  // Goes backwards: lowers each starts_[c] from the end of column c to its start.
  for (std::size_t i = items_.size(); i-- > 0;) {
    for_columns(items_[i].range, [&](std::size_t c) { entries_[--starts_[c]] = items_[i]; });
  }
}

std::vector<TrianglePair> SweepPrune::sweep_columns(SweepPruneCounts& counts) {
  std::vector<TrianglePair> pairs;
  std::vector<Key> keys;  // keys are small, so sorting moves little memory
  for (std::size_t c = 0; c + 1 < starts_.size(); ++c) {
    const std::span column(entries_.data() + starts_[c], entries_.data() + starts_[c + 1]);
    keys.clear();
    for (std::uint32_t i = 0; i < column.size(); ++i) keys.push_back({column[i].lo[0], i});
    if (!insertion_sort(std::span(keys), counts.swaps, [](const Key&, const Key&) {})) {
      std::sort(keys.begin(), keys.end());
      ++counts.sorts;
    }
    const std::size_t u = c & ((std::size_t{1} << bits_[0]) - 1), v = c >> bits_[0];
    for (auto i = keys.begin(); i != keys.end(); ++i) {
      const Item& e = column[i->index];
      for (auto j = i + 1; j != keys.end() && j->lo <= e.hi[0]; ++j) {
        const Item& f = column[j->index];
        if (e.group == f.group || e.lo[1] > f.hi[1] || f.lo[1] > e.hi[1] || e.lo[2] > f.hi[2] ||
            f.lo[2] > e.hi[2]) {
          continue;
        }
        // Each pair is reported only in the column that contains the larger lower ends.
        if (std::max(e.range.u0, f.range.u0) != u || std::max(e.range.v0, f.range.v0) != v)
          continue;
        pairs.push_back({std::min(e.triangle, f.triangle), std::max(e.triangle, f.triangle)});
      }
    }
  }
  return pairs;
}

void SweepPrune::sort_order() {
  std::vector<Key> keys;
  keys.reserve(items_.size());
  for (const Item& item : items_) keys.push_back({item.lo[0], item.triangle});
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size(); ++i) order_[i] = keys[i].index;
}

}  // namespace farcull
