// Draws proxies with a solid's kernel, block by block. A kernel is a type with
//   interval(c, s0, .., s4, entry, exit): its solid_interval on lanes;
//   nearest(solid), farthest(solid): depths (px) that no entry comes before and no exit behind.
#if defined(FARCULL_NATIVE_PROXIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_NATIVE_PROXIES_INL_H_
#undef FARCULL_NATIVE_PROXIES_INL_H_
#else
#define FARCULL_NATIVE_PROXIES_INL_H_
#endif

#include "core/native/block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

/// The edges of a proxy, each with its inner side: a centre c is covered where no edge says no. The
/// floats round; docs/budget.md, "The canvas on the CPU", bounds by how much.
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
  /// Which of kLanes blocks in a row, the first with its lower left pixel centre at cx, cy, may
  /// have a covered pixel. The blocks are taken a pixel larger on each side, far more than the
  /// floats round, so none is lost.
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

/// Draws an element in the rows of the job. True: asked, and seen.
template <class Kernel>
HWY_INLINE bool draw_proxy(const NativeJob& job, std::uint32_t element, Verb verb) {
  const PixelRange& range = job.ranges[element];
  const int y0 = std::max<int>(range.y0, job.y0), y1 = std::min<int>(range.y1, job.y1);
  if (y0 >= y1) return false;
  const Proxy& proxy = job.proxies[element];
  const Solid& s = proxy.solid;
  const ProxyEdges edges(proxy.corners);
  const bool passes = job.output == NativeOutput::run;
  // Where not even the nearest or farthest depth of the solid changes a block, its lines need not
  // be followed: the depth map is monotone, so none of theirs would.
  const Lane bound = held_depth(
      job, mapped_depth(job, verb == Verb::store ? Kernel::nearest(s) : Kernel::farthest(s)));
  const vec4 s0 = uniform(s[0]), s1 = uniform(s[1]), s2 = uniform(s[2]), s3 = uniform(s[3]),
             s4 = uniform(s[4]);
  const Plain half_width = 0.5f * static_cast<Plain>(job.width);
  const Plain half_height = 0.5f * static_cast<Plain>(job.height);
  const Lane last_x(static_cast<Plain>(range.x1) - 0.5f - half_width);
  const Lane last_y(static_cast<Plain>(y1) - 0.5f - half_height);
  // One block; true: asked, and seen.
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
    Lane entry, exit;
    covered = covered && Kernel::interval({cx, cy}, s0, s1, s2, s3, s4, entry, exit);
    return take_fragments(job, verb, covered, verb == Verb::store ? entry : exit, at, y1 - y);
  };
  // Blocks in a row are asked together where they are many.
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

template <class Kernel>
HWY_INLINE void draw_proxies(const NativeJob& job) {
  for_draws(job, [&job](std::uint32_t element, Verb verb) {
    return draw_proxy<Kernel>(job, element, verb);
  });
}

/// The kernel's answers for single lines.
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
