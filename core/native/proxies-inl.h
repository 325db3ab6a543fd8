// Draws elements in blocks of pixels, one pixel on each lane. A fragment's depth is stored, or
// compared with the buffer to test visibility (Verb::ask). With 4 lanes or more, a block is 4
// pixels wide, since most proxies are small. Kernel, a template parameter, computes a solid on
// lanes:
//   interval(c, s0, .., s4, entry, exit): the solid's solid_interval;
//   nearest(solid), farthest(solid): bounds of all entries and of all exits (px).
#if defined(FARCULL_NATIVE_PROXIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_NATIVE_PROXIES_INL_H_
#undef FARCULL_NATIVE_PROXIES_INL_H_
#else
#define FARCULL_NATIVE_PROXIES_INL_H_
#endif

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/native/canvas.h"
#include "core/native/fatten-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

constexpr int kLanes = static_cast<int>(hn::MaxLanes(LaneTag()));
constexpr int kBlockWidth = kLanes < 4 ? 1 : 4;
constexpr int kBlockHeight = kLanes / kBlockWidth;
static_assert(kLanes == 1 || kLanes % 4 == 0);
static_assert(kBlockWidth <= kNativeOverhang && kBlockHeight <= kNativeOverhang);

/// load_rows() and store_rows() access a block of kBlockWidth columns. Only its first `rows` rows
/// belong to this thread. The other rows are not stored; one of the first rows is loaded for them.
#if HWY_TARGET == HWY_SCALAR
template <int kCount>
HWY_INLINE LaneVector load_rows(const float* at, int, int) {
  return hn::LoadU(LaneTag(), at);
}
template <int kCount>
HWY_INLINE void store_rows(LaneVector v, float* at, int, int rows) {
  if (rows > 0) hn::StoreU(v, LaneTag(), at);
}
#else
template <int kCount>
HWY_INLINE hn::Vec<hn::CappedTag<float, kCount> > load_rows(const float* at, int stride, int rows) {
  const hn::CappedTag<float, kCount> tag;
  if constexpr (kCount <= 4) {
    return hn::LoadU(tag, at);
  } else {
    constexpr int kHalf = kCount / 8;  // number of rows in each half
    const float* const upper = rows > kHalf ? at + kHalf * stride : at;
    return hn::Combine(tag, load_rows<kCount / 2>(upper, stride, rows - kHalf),
                       load_rows<kCount / 2>(at, stride, rows));
  }
}
template <int kCount>
HWY_INLINE void store_rows(hn::Vec<hn::CappedTag<float, kCount> > v, float* at, int stride,
                           int rows) {
  const hn::CappedTag<float, kCount> tag;
  if constexpr (kCount <= 4) {
    if (rows > 0) hn::StoreU(v, tag, at);
  } else {
    const hn::CappedTag<float, kCount / 2> half;
    store_rows<kCount / 2>(hn::LowerHalf(half, v), at, stride, rows);
    store_rows<kCount / 2>(hn::UpperHalf(half, v), at + kCount / 8 * stride, stride,
                           rows - kCount / 8);
  }
}
#endif

/// Return the column and the row of each lane's pixel inside a block.
HWY_INLINE Lane lane_columns() {
  HWY_ALIGN static constexpr float kColumns[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  return Lane(hn::Load(LaneTag(), kColumns));
}
HWY_INLINE Lane lane_rows() {
  HWY_ALIGN static constexpr float kRows[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  return Lane(hn::Load(LaneTag(), kRows));
}

HWY_INLINE Lane lane_numbers() {
  HWY_ALIGN static constexpr float kNumbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                   8, 9, 10, 11, 12, 13, 14, 15};
  return Lane(hn::Load(LaneTag(), kNumbers));
}
/// Returns an integer whose bit i is the truth value of lane i.
HWY_INLINE std::uint32_t bits_of(Bool c) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(LaneTag(), c.mask, bytes);
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}

/// Applies the depth map (depth_scale() in core/canvas/canvas.h) on lanes.
HWY_INLINE Lane mapped_depth(const NativeJob& job, Lane z) {
  return min(max(Lane(0.5f) + z * Lane(job.scale), Lane(0.25f)), Lane(0.75f));
}
constexpr Plain kSteps24 = 16777215.0f;
/// Returns the value that the depth buffer holds for a mapped depth.
HWY_INLINE Lane held_depth(const NativeJob& job, Lane mapped) {
  return job.fixed24 ? Lane(hn::Round((mapped * Lane(kSteps24)).v)) : mapped;
}
HWY_INLINE Plain clear_depth(const NativeJob& job) { return job.fixed24 ? kSteps24 : 1.0f; }

HWY_INLINE bool any(Bool c) { return !hn::AllFalse(LaneTag(), c.mask); }

HWY_INLINE void mark_seen(std::uint8_t* seen, std::uint32_t slot) {
  std::atomic_ref<std::uint8_t>(seen[slot]).store(1, std::memory_order_relaxed);
}
HWY_INLINE bool already_seen(std::uint8_t* seen, std::uint32_t slot) {
  return std::atomic_ref<std::uint8_t>(seen[slot]).load(std::memory_order_relaxed) != 0;
}

/// Draws the covered fragments at depth z (px). Returns true if this is a visibility test
/// (Verb::ask in NativeOutput::run) and a fragment is seen.
HWY_INLINE bool take_fragments(const NativeJob& job, Verb verb, Bool covered, Lane z, float* at,
                               int rows) {
  const Lane old = Lane(load_rows<kLanes>(at, job.stride, rows));
  if (job.output == NativeOutput::run && verb == Verb::ask) {
    const Lane depth = held_depth(job, mapped_depth(job, z));
    return any(covered && (job.touching ? depth >= old : depth > old));
  }
  const Lane kept = job.output == NativeOutput::values ? z : held_depth(job, mapped_depth(job, z));
  const Lane next = verb == Verb::store ? min(old, kept) : max(old, kept);
  store_rows<kLanes>(select(covered, next, old).v, at, job.stride, rows);
  return false;
}

/// Draws the quad kEverywhere at depth 0, the nearest, in the job's rows. Returns true if Verb::ask
/// (in NativeOutput::run) finds a stored depth before the quad, or at it if touching counts.
inline bool take_everywhere(const NativeJob& job, Verb verb) {
  bool seen = false;
  for (int y = job.y0; y < job.y1; ++y) {
    float* const row = job.depth + static_cast<std::ptrdiff_t>(y) * job.stride;
    for (int x = 0; x < job.width; ++x) {
      if (job.output == NativeOutput::run && verb == Verb::ask) {
        seen = seen || (job.touching ? row[x] <= 0 : row[x] < 0);
      } else if (verb == Verb::store) {
        row[x] = std::min(row[x], 0.0f);
      } else {
        row[x] = std::max(row[x], 0.0f);
      }
    }
  }
  return seen;
}

/// Calls visit(element, verb) for the draws of a job in order. visit returns true if the element is
/// seen. Skips visibility tests (Verb::ask) of a slot that has been seen.
template <class Visit>
HWY_INLINE void for_draws(const NativeJob& job, const Visit& visit) {
  for (std::uint32_t s = 0; s < job.step_count; ++s) {
    const Step& step = job.steps[s];
    const bool asked = step.verb == Verb::ask && job.output == NativeOutput::run;
    const Draw* const end = job.draws + step.first + step.count;
    for (const Draw* draw = job.draws + step.first; draw != end; ++draw) {
      if (asked && already_seen(job.seen, draw->slot)) continue;
      const bool seen = draw->element == kEverywhere ? take_everywhere(job, step.verb)
                                                     : visit(draw->element, step.verb);
      if (asked && seen) mark_seen(job.seen, draw->slot);
    }
  }
}

/// The edges of a proxy, directed counterclockwise. A pixel centre is covered if it lies on or left
/// of all edges. docs/budget.md, "The canvas on the CPU", bounds the rounding errors.
struct ProxyEdges {
  Plain x[4], y[4], dx[4], dy[4];

  HWY_INLINE explicit ProxyEdges(const std::array<Plain, 8>& corners) {
    for (int i = 0; i < 4; ++i) {
      x[i] = corners[2 * i];
      y[i] = corners[2 * i + 1];
    }
    const Plain turn =
        (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]) < 0 ? -1.0f : 1.0f;
    for (int i = 0; i < 4; ++i) {
      dx[i] = turn * (x[(i + 1) % 4] - x[i]);
      dy[i] = turn * (y[(i + 1) % 4] - y[i]);
    }
  }
  /// Tests kLanes blocks side by side, one per lane. True: the block may have a covered pixel. cx,
  /// cy: lower left pixel centre of the first block. Each block is enlarged by a pixel on each
  /// side. Rounding errors are far smaller, so no block with a covered pixel is rejected.
  HWY_INLINE Bool may_cover_blocks(Plain cx, Plain cy) const {
    const Lane left = Lane(cx - 1) + Lane(static_cast<Plain>(kBlockWidth)) * lane_numbers();
    const Lane right = left + Lane(static_cast<Plain>(kBlockWidth + 1));
    const Plain below = cy - 1, above = cy + static_cast<Plain>(kBlockHeight);
    Bool may(true);
    for (int i = 0; i < 4; ++i) {
      const Plain far_y = dx[i] > 0 ? above : below;
      may = may &&
            Lane(dx[i] * (far_y - y[i])) >= Lane(dy[i]) * ((dy[i] > 0 ? left : right) - Lane(x[i]));
    }
    return may;
  }
  HWY_INLINE Bool cover(Lane cx, Lane cy) const {
    Bool inside(true);
    for (int i = 0; i < 4; ++i)
      inside = inside && Lane(dx[i]) * (cy - Lane(y[i])) >= Lane(dy[i]) * (cx - Lane(x[i]));
    return inside;
  }
};

HWY_INLINE vec4 uniform(const std::array<Plain, 4>& s) { return {s[0], s[1], s[2], s[3]}; }

/// Draws a proxy in the rows of the job. Returns true if this is a visibility test (Verb::ask in
/// NativeOutput::run) and a fragment is seen.
template <class Kernel>
HWY_INLINE bool draw_proxy(const NativeJob& job, const Proxy& proxy, const PixelRange& range,
                           Verb verb) {
  const int y0 = std::max<int>(range.y0, job.y0), y1 = std::min<int>(range.y1, job.y1);
  const Solid& s = proxy.solid;
  const ProxyEdges edges(proxy.corners);
  const bool passes = job.output == NativeOutput::run;
  // Buffer value of the solid's nearest entry (store) or farthest exit (ask). If this value has no
  // effect in a pixel, no fragment of the proxy has an effect there: the depth map is monotone.
  const Lane bound = held_depth(
      job, mapped_depth(job, verb == Verb::store ? Kernel::nearest(s) : Kernel::farthest(s)));
  const Plain half_width = 0.5f * static_cast<Plain>(job.width);
  const Plain half_height = 0.5f * static_cast<Plain>(job.height);
  const Lane last_x(static_cast<Plain>(range.x1) - 0.5f - half_width);
  const Lane last_y(static_cast<Plain>(y1) - 0.5f - half_height);
  const auto draw_block = [&](int x, int y) HWY_ATTR {
    float* const at = job.depth + static_cast<std::ptrdiff_t>(y) * job.stride + x;
    const Lane cx = Lane(static_cast<Plain>(x) + 0.5f - half_width) + lane_columns();
    const Lane cy = Lane(static_cast<Plain>(y) + 0.5f - half_height) + lane_rows();
    Bool covered = cx <= last_x && cy <= last_y && edges.cover(cx, cy);
    if (passes) {
      const Lane old = Lane(load_rows<kLanes>(at, job.stride, y1 - y));
      covered = covered && (verb == Verb::store ? bound < old : bound >= old);
    }
    if (!any(covered)) return false;
    // Loads the solid only here, because its twenty vectors occupy many registers. For most
    // blocks, draw_block() has returned before.
    Lane entry, exit;
    covered = covered && Kernel::interval({cx, cy}, uniform(s[0]), uniform(s[1]), uniform(s[2]),
                                          uniform(s[3]), uniform(s[4]), entry, exit);
    return take_fragments(job, verb, covered, verb == Verb::store ? entry : exit, at, y1 - y);
  };
  const bool many = kLanes > 1 && range.x1 - range.x0 > 2 * kBlockWidth;
  for (int y = y0; y < y1; y += kBlockHeight) {
    if (!many) {
      for (int x = range.x0; x < range.x1; x += kBlockWidth)
        if (draw_block(x, y)) return true;
      continue;
    }
    for (int x = range.x0; x < range.x1; x += kLanes * kBlockWidth) {
      const Bool may = edges.may_cover_blocks(static_cast<Plain>(x) + 0.5f - half_width,
                                              static_cast<Plain>(y) + 0.5f - half_height);
      for (std::uint32_t left = bits_of(may); left != 0; left &= left - 1) {
        const int at = x + std::countr_zero(left) * kBlockWidth;
        if (at >= range.x1) break;
        if (draw_block(at, y)) return true;
      }
    }
  }
  return false;
}

// Most outlines show that a proxy is seen or has no effect. Other proxies are drawn in groups.

/// Returns true if the outline's pixel (x, y) shows that the proxy is seen.
HWY_INLINE bool seen_for_sure(const NativeJob& job, const ProxyOutline& outline) {
  if (outline.x == kNoPixel || outline.y < job.y0 || outline.y >= job.y1) return false;
  Plain depth = std::min(std::max(0.5f + outline.depth * job.scale, 0.25f), 0.75f);
  if (job.fixed24) depth = std::rint(depth * kSteps24);
  const Plain old = job.depth[static_cast<std::ptrdiff_t>(outline.y) * job.stride + outline.x];
  return job.touching ? depth >= old : depth > old;
}

/// Calls visit(at, rows, columns) for the blocks of `range` in the job's rows. Stops and returns
/// true when a call returns true. at: index of the block's first pixel in job.depth. rows, columns:
/// number of rows and columns from this pixel to the end of the range.
template <class Visit>
HWY_INLINE bool any_block(const NativeJob& job, const PixelRange& range, const Visit& visit) {
  const int y0 = std::max<int>(range.y0, job.y0), y1 = std::min<int>(range.y1, job.y1);
  for (int y = y0; y < y1; y += kBlockHeight) {
    for (int x = range.x0; x < range.x1; x += kBlockWidth) {
      if (visit(static_cast<std::ptrdiff_t>(y) * job.stride + x, y1 - y, range.x1 - x)) return true;
    }
  }
  return false;
}
HWY_INLINE Bool inside_block(int rows, int columns) {
  return lane_rows() < Lane(static_cast<Plain>(rows)) &&
         lane_columns() < Lane(static_cast<Plain>(columns));
}
/// Returns true if the proxy is so small that may_change() examines the blocks of its range.
HWY_INLINE bool is_small(const PixelRange& range) {
  constexpr int kMostBlocks = 4;  // largest number of blocks in a row and in a column
  return range.x1 - range.x0 <= kMostBlocks * kBlockWidth &&
         range.y1 - range.y0 <= kMostBlocks * kBlockHeight;
}

/// Returns false only if drawing the proxy has no effect. store: even the proxy's nearest depth
/// changes no pixel of its range. ask: even its farthest depth is seen in no pixel of its range.
/// Returns true for large proxies.
HWY_INLINE bool may_change(const NativeJob& job, const ProxyOutline& outline, Verb verb) {
  if (!is_small(outline.range)) return true;
  const Lane bound = held_depth(
      job, mapped_depth(job, Lane(verb == Verb::store ? outline.nearest : outline.farthest)));
  return any_block(job, outline.range, [&](std::ptrdiff_t at, int rows, int columns) HWY_ATTR {
    const Lane old = Lane(load_rows<kLanes>(job.depth + at, job.stride, rows));
    const Bool changes = verb == Verb::store ? bound < old : bound >= old;
    return any(changes && inside_block(rows, columns));
  });
}

/// Collects the proxies of one step that need drawing, and draws them in groups of kMost.
template <class Kernel>
class WaitingProxies {
 public:
  WaitingProxies(const NativeJob& job, Verb verb)
      : job_(job), verb_(verb), asked_(verb == Verb::ask && job.output == NativeOutput::run) {}

  HWY_INLINE void add(const Draw& draw) {
    const Drawables& from = *job_.drawables;
    if (from.fit != nullptr && !(from.sources[draw.element] & kFitted))
      prefetch_corners(*from.batch.scene, from.sources[draw.element]);
    draws_[count_++] = draw;
    if (count_ == kMost) draw_all();
  }
  HWY_INLINE void draw_all() {
    const Drawables& from = *job_.drawables;
    std::uint32_t items[kMost];
    std::uint8_t done[kMost];
    Proxy fitted[kMost];
    const Proxy* proxies[kMost];
    FattenBatch batch = from.batch;
    for (int i = 0; i < count_; ++i) {
      const std::uint32_t element = draws_[i].element;
      if (from.fit == nullptr) {
        proxies[i] = &from.proxies[element];
      } else if (from.sources[element] & kFitted) {
        proxies[i] = &from.proxies[from.sources[element] - kFitted];
      } else {
        proxies[i] = &fitted[batch.count];
        items[batch.count++] = from.sources[element];
      }
    }
    if (batch.count > 0) {
      batch.items = items;
      batch.out = fitted;
      batch.done = done;
      from.fit(batch);
    }
    for (int i = 0; i < count_; ++i) {
      const auto [element, slot] = draws_[i];
      if (asked_ && already_seen(job_.seen, slot)) continue;
      const bool seen = draw_proxy<Kernel>(job_, *proxies[i], job_.outlines[element].range, verb_);
      if (asked_ && seen) mark_seen(job_.seen, slot);
    }
    count_ = 0;
  }

 private:
  static constexpr int kMost = 16;
  const NativeJob& job_;
  const Verb verb_;
  const bool asked_;
  Draw draws_[kMost];
  int count_ = 0;
};

/// A run: consecutive draws, usually of neighbouring triangles of a mesh. first: index of a draw.
struct DrawRun {
  std::uint32_t first, count;
};
/// Prefetches data of the next three runs, which are scattered in memory. A run's draws are
/// prefetched first, its outlines at the next call, and its triangles at the call after that.
HWY_INLINE void prefetch_runs(const NativeJob& job, const std::vector<DrawRun>& runs,
                              std::size_t now) {
  const Drawables& from = *job.drawables;
  const auto for_elements = [&](std::size_t run, const auto& prefetch) HWY_ATTR {
    if (run >= runs.size()) return;
    for (std::uint32_t d = runs[run].first; d < runs[run].first + runs[run].count; d += 2)
      if (job.draws[d].element != kEverywhere) prefetch(job.draws[d].element);
  };
  if (now + 3 < runs.size()) {
    hwy::Prefetch(&job.draws[runs[now + 3].first]);
    hwy::Prefetch(&job.draws[runs[now + 3].first + runs[now + 3].count / 2]);
  }
  for_elements(now + 2, [&](std::uint32_t element) HWY_ATTR {
    hwy::Prefetch(&job.outlines[element]);
    if (from.fit != nullptr) hwy::Prefetch(&from.sources[element]);
  });
  for_elements(now + 1, [&](std::uint32_t element) HWY_ATTR {
    if (from.fit != nullptr && !(from.sources[element] & kFitted))
      hwy::Prefetch(&from.batch.scene->triangles[from.sources[element]]);
  });
}
/// Divides the draws of a step into runs and sorts the runs, the nearest first. Any order leaves
/// the same depths, but in this order most hidden draws have no effect and are skipped. Leaves out
/// runs without a pixel in the job's rows.
inline void front_to_back(const NativeJob& job, const Step& step, std::vector<DrawRun>& out) {
  constexpr std::uint32_t kRun = 16, kBuckets = 512;
  const std::uint32_t runs = (step.count + kRun - 1) / kRun;
  std::vector<std::uint16_t> bucket(runs);
  std::uint32_t end[kBuckets + 1] = {};
  for (std::uint32_t k = 0; k < runs; ++k) {
    const std::uint32_t first = step.first + k * kRun;
    Plain nearest = HUGE_VALF;
    bool here = false;
    for (std::uint32_t d = first; d < std::min(first + kRun, step.first + step.count); ++d) {
      if (job.draws[d].element == kEverywhere) {
        nearest = -HUGE_VALF, here = true;
        continue;
      }
      const ProxyOutline& outline = job.outlines[job.draws[d].element];
      here = here || (outline.range.y0 < job.y1 && outline.range.y1 > job.y0);
      nearest = std::min(nearest, outline.nearest);
    }
    const Plain depth = std::min(std::max(nearest * job.scale, -0.25f), 0.25f);
    bucket[k] = here ? static_cast<std::uint16_t>((depth + 0.25f) * (2 * (kBuckets - 1)))
                     : static_cast<std::uint16_t>(kBuckets);
    ++end[bucket[k]];
  }
  out.resize(runs - end[kBuckets]);
  std::uint32_t before = 0;
  for (std::uint32_t& count : end) before += std::exchange(count, before);
  for (std::uint32_t k = 0; k < runs; ++k) {
    if (bucket[k] < kBuckets)
      out[end[bucket[k]]++] = {step.first + k * kRun, std::min(kRun, step.count - k * kRun)};
  }
}

template <class Kernel>
HWY_INLINE void draw_proxies(const NativeJob& job) {
  const bool run = job.output == NativeOutput::run;
  constexpr std::uint32_t kLeastSorted = 64;
  std::vector<DrawRun> runs;
  for (std::uint32_t s = 0; s < job.step_count; ++s) {
    const Step& step = job.steps[s];
    const bool asked = step.verb == Verb::ask && run;
    if (asked || step.count < kLeastSorted) {
      runs.assign(1, {step.first, step.count});
    } else {
      front_to_back(job, step, runs);
    }
    WaitingProxies<Kernel> waiting(job, step.verb);
    for (const DrawRun& some : runs) {
      if (runs.size() > 1) prefetch_runs(job, runs, static_cast<std::size_t>(&some - runs.data()));
      for (std::uint32_t d = some.first; d < some.first + some.count; ++d) {
        const Draw& draw = job.draws[d];
        if (asked && already_seen(job.seen, draw.slot)) continue;
        if (draw.element == kEverywhere) {
          if (take_everywhere(job, step.verb) && asked) mark_seen(job.seen, draw.slot);
          continue;
        }
        const ProxyOutline& outline = job.outlines[draw.element];
        if (outline.range.y0 >= job.y1 || outline.range.y1 <= job.y0 ||
            outline.range.y0 >= outline.range.y1)
          continue;
        if (asked && seen_for_sure(job, outline)) {
          mark_seen(job.seen, draw.slot);
        } else if (!run || may_change(job, outline, step.verb)) {
          waiting.add(draw);
        }
      }
    }
    waiting.draw_all();
  }
}

template <class Kernel>
HWY_INLINE void follow_lines(const NativeLines& lines) {
  const Solid& s = *lines.solid;
  const LaneTag tag;
  HWY_ALIGN Plain x[kLanes] = {}, y[kLanes] = {}, entry[kLanes], exit[kLanes], hit[kLanes];
  for (std::uint32_t from = 0; from < lines.count; from += kLanes) {
    const auto count = std::min<std::uint32_t>(kLanes, lines.count - from);
    for (std::uint32_t i = 0; i < count; ++i) {
      x[i] = lines.cx[from + i];
      y[i] = lines.cy[from + i];
    }
    Lane first, last;
    const Bool met =
        Kernel::interval({Lane(hn::Load(tag, x)), Lane(hn::Load(tag, y))}, uniform(s[0]),
                         uniform(s[1]), uniform(s[2]), uniform(s[3]), uniform(s[4]), first, last);
    hn::Store(first.v, tag, entry);
    hn::Store(last.v, tag, exit);
    hn::Store(select(met, 1.0f, 0.0f).v, tag, hit);
    for (std::uint32_t i = 0; i < count; ++i) {
      lines.entry[from + i] = entry[i];
      lines.exit[from + i] = exit[i];
      lines.hit[from + i] = hit[i] != 0;
    }
  }
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
