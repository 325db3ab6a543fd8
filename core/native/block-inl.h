// A block of pixels, one on each lane, and what it takes from its fragments: depths to store, or an
// answer. It is 4 pixels wide where there are 4 lanes or more, since the proxies of culling are
// small.
#if defined(FARCULL_NATIVE_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_NATIVE_BLOCK_INL_H_
#undef FARCULL_NATIVE_BLOCK_INL_H_
#else
#define FARCULL_NATIVE_BLOCK_INL_H_
#endif

#include <algorithm>
#include <atomic>
#include <bit>

#include "core/native/glsl_lanes-inl.h"
#include "core/native/job.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

constexpr int kLanes = static_cast<int>(hn::MaxLanes(LaneTag()));
constexpr int kBlockWidth = kLanes < 4 ? 1 : 4;
constexpr int kBlockHeight = kLanes / kBlockWidth;
static_assert(kLanes == 1 || kLanes % 4 == 0);
static_assert(kBlockWidth <= kNativeOverhang && kBlockHeight <= kNativeOverhang);

/// kBlockHeight rows of kBlockWidth floats, of which the first `rows` are ours: the others belong
/// to another thread and are not touched. Where they are missing the first row is loaded again.
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
    constexpr int kHalf = kCount / 8;  // rows
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

/// Columns and rows of the lanes inside a block.
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
/// Lane i as bit i.
HWY_INLINE std::uint32_t bits_of(Bool c) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(LaneTag(), c.mask, bytes);
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}

/// The depth map (depth_scale() in core/canvas/canvas.h) on lanes.
HWY_INLINE Lane mapped_depth(const NativeJob& job, Lane z) {
  return min(max(Lane(0.5f) + z * Lane(job.scale), Lane(0.25f)), Lane(0.75f));
}
constexpr Plain kSteps24 = 16777215.0f;
/// The value that the depth buffer holds for a mapped depth.
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

/// Takes fragments of depth z (px) where `covered`. True: asked, and seen.
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

/// Draws the nearest quad over the whole window in the rows of the job: stores or asks depth 0.
/// True: asked, and seen.
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

/// Calls visit(element, verb) -> whether it is seen, for the draws of a job in order; a slot that
/// was seen is asked no more.
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

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that Highway toggles
