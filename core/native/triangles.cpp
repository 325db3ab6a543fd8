// Draws raw triangles (without an offset). Snapped corners and edge functions are integers, which
// doubles hold exactly. So a pixel centre is compared exactly. A pixel's square is compared
// exactly, too: an axis or an edge's normal separates the square from any disjoint triangle.
#include "core/native/canvas.h"

#include <algorithm>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/native/triangles.cpp"
#include <hwy/foreach_target.h>

#include "core/native/proxies-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

static_assert(kWide <= kNativeOverhang);
constexpr double kSubpixels = 1 << kNativeSubpixelBits;

HWY_INLINE Wide columns() {
  HWY_ALIGN static constexpr double kColumns[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  return hn::Mul(hn::Load(WideTag(), kColumns), hn::Set(WideTag(), kSubpixels));
}

/// The corners of a triangle, counterclockwise, in subpixels from the window's lower left corner.
/// place: the mapped depths of the corners.
struct SnappedTriangle {
  double x[3], y[3], place[3];
  double area = 0;  // twice the area, in square subpixels; 0: drawn only if job.conservative

  HWY_INLINE SnappedTriangle(const NativeJob& job, const std::array<float, 12>& t) {
    for (int i = 0; i < 3; ++i) {
      x[i] = std::rint((t[4 * i] + 0.5 * job.width) * kSubpixels);
      y[i] = std::rint((t[4 * i + 1] + 0.5 * job.height) * kSubpixels);
      const float z = t[4 * i + 2] * job.scale;
      place[i] = std::min(std::max(0.5f + z, 0.25f), 0.75f);
    }
    area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
    if (area < 0) {
      std::swap(x[1], x[2]);
      std::swap(y[1], y[2]);
      std::swap(place[1], place[2]);
      area = -area;
    }
  }
};

/// Draws the covered pixels among kWide pixels from `at` on. place: their mapped depths. Returns
/// true if a fragment is seen in a visibility test (Verb::ask in NativeOutput::run).
HWY_INLINE bool take_row(const NativeJob& job, Verb verb, Wide place, hn::Mask<WideTag> covered,
                         float* at) {
  const NarrowTag narrow;
  const bool asked = job.output == NativeOutput::run && verb == Verb::ask;
  auto depth = hn::DemoteTo(narrow, place);
  if (job.fixed24) depth = hn::Round(hn::Mul(depth, hn::Set(narrow, kSteps24)));
  const WideTag wide;
  const auto none = hn::Set(wide, verb == Verb::store ? HUGE_VAL : -1.0);
  depth = hn::DemoteTo(narrow, hn::IfThenElse(covered, hn::PromoteTo(wide, depth), none));
  const auto old = hn::LoadU(narrow, at);
  if (asked) {
    return !hn::AllFalse(narrow, job.touching ? hn::Ge(depth, old) : hn::Gt(depth, old));
  }
  hn::StoreU(verb == Verb::store ? hn::Min(depth, old) : hn::Max(depth, old), narrow, at);
  return false;
}

/// Draws a triangle in the rows of the job. kTouched: draws a fragment in every pixel that the
/// triangle touches. Returns true if a fragment is seen in a visibility test.
template <bool kTouched>
HWY_INLINE bool draw_triangle(const NativeJob& job, std::uint32_t element, Verb verb) {
  const PixelRange& range = job.ranges[element];
  const int y0 = std::max<int>(range.y0, job.y0), y1 = std::min<int>(range.y1, job.y1);
  if (y0 >= y1) return false;
  const SnappedTriangle t(job, job.drawables->triangles[element]);
  if (!kTouched && t.area == 0) return false;
  constexpr double kHalf = kTouched ? kSubpixels / 2 : 0;  // half a pixel's side in subpixels, or 0
  const auto [left, right] = std::minmax({t.x[0], t.x[1], t.x[2]});
  const auto [bottom, top] = std::minmax({t.y[0], t.y[1], t.y[2]});
  const auto [nearest, farthest] = std::minmax({t.place[0], t.place[1], t.place[2]});
  const WideTag wide;
  const Wide over = hn::Set(wide, t.area > 0 ? 1 / t.area : 0);
  for (int y = y0; y < y1; ++y) {
    const double py = (y + 0.5) * kSubpixels;
    if (kTouched && (py + kHalf < bottom || py - kHalf > top)) continue;
    for (int x = range.x0; x < range.x1; x += kWide) {
      const Wide px = hn::Add(hn::Set(wide, (x + 0.5) * kSubpixels), columns());
      auto covered = hn::Lt(px, hn::Set(wide, range.x1 * kSubpixels));
      if (kTouched) {
        covered = hn::And(covered, hn::Ge(px, hn::Set(wide, left - kHalf)));
        covered = hn::And(covered, hn::Le(px, hn::Set(wide, right + kHalf)));
      }
      Wide place = hn::Zero(wide);
      for (int i = 0; i < 3; ++i) {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        const double dx = t.x[b] - t.x[a], dy = t.y[b] - t.y[a];
        const Wide side = hn::Sub(hn::Set(wide, dx * (py - t.y[a])),
                                  hn::Mul(hn::Set(wide, dy), hn::Sub(px, hn::Set(wide, t.x[a]))));
        // Upper bound of the edge function's increase from a pixel's centre to its corners.
        const double reach = (std::abs(dx) + std::abs(dy)) * kHalf;
        const Wide least = hn::Set(wide, -reach);
        const bool owns = dy < 0 || (dy == 0 && dx < 0);  // a left or top edge covers its points
        covered = hn::And(covered, kTouched || owns ? hn::Ge(side, least) : hn::Gt(side, least));
        place = hn::Add(place, hn::Mul(hn::Mul(side, over), hn::Set(wide, t.place[i])));
      }
      if (hn::AllFalse(wide, covered)) continue;
      if (kTouched) {
        place = t.area > 0
                    ? hn::Min(hn::Max(place, hn::Set(wide, nearest)), hn::Set(wide, farthest))
                    : hn::Set(wide, 0.5 * (nearest + farthest));
      }
      if (take_row(job, verb, place, covered,
                   job.depth + static_cast<std::ptrdiff_t>(y) * job.stride + x))
        return true;
    }
  }
  return false;
}

void draw_triangles(const NativeJob& job) {
  for_draws(job, [&job](std::uint32_t element, Verb verb) {
    return job.conservative ? draw_triangle<true>(job, element, verb)
                            : draw_triangle<false>(job, element, verb);
  });
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {
HWY_EXPORT(draw_triangles);

void draw_triangles_native(const NativeJob& job) { HWY_DYNAMIC_DISPATCH(draw_triangles)(job); }

}  // namespace farcull
#endif
