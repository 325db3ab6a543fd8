// The draw list of a pass of the GL canvas. The canvas draws elements of its own besides those of
// the caller: the quad for kEverywhere, and control items, by which lost commands are seen.
//
// Control items stand in corner pixels of the render target, outside the window. In pixel 0 the
// store of step k leaves the depth kControlTop - k * kControlGap. The next ask's control item, at
// that depth (or half a gap behind it, where equal depths are not seen), is seen only if that store
// ran. A pass marks pixel 1 or 2 in turn and asks in the other, where the pass before it left its
// mark: kAsked must not be seen, so the buffer has been cleared since.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/canvas/canvas.h"

namespace farcull {

constexpr double kControlTop = 0.95;
constexpr double kControlGap = 0x1p-21;
constexpr float kMark = 0.96f, kAsked = 0.98f;
constexpr float kLeft = 0.5f;  // where no pass has been, every pixel is cleared to this depth

struct GpuDraw {
  std::uint32_t element;
  std::uint32_t slot;
};

/// A batch of draws: consecutive ones of one step that read one element buffer.
struct CanvasRun {
  std::size_t step;
  Verb verb;
  std::size_t chunk;   // element buffer; kExtras for the canvas's own elements
  std::size_t offset;  // of its head in the draw list; its draws follow
  std::size_t count;   // of draws
};
constexpr std::size_t kExtras = static_cast<std::size_t>(-1);

/// All that a pass sends.
struct CanvasPass {
  std::uint32_t serial = 0;   // no other pass of the process has it
  std::vector<GpuDraw> list;  // begins with two entries where the store has its tag; each
                              // batch begins with {serial, word of the report}
  std::vector<float> own;     // the canvas's own elements
  std::vector<CanvasRun> runs;
  std::uint32_t slots = 0;  // of the caller's; with marks, one that must not be seen; controls
  std::span<const std::byte> list_bytes() const {
    return std::as_bytes(std::span(list).subspan(2));
  }
};

/// The sizes that a draw list depends on.
struct CanvasShape {
  DepthMode mode = DepthMode::fragment;
  int width = 0, height = 0;                // of the window, px
  int target_width = 0, target_height = 0;  // of the render target, px
  std::size_t per_chunk = 0;                // elements of an element buffer
  std::size_t grain = 0;                    // entries between two places where a batch may begin
};

/// The draw list of `pass`. With `marks`, it begins with a store and ends with an ask, which have
/// control items alone where the caller's do not; the first of each carries the mark and asks for
/// that of the pass before, in the pixels that `odd` says. Without, it has neither. Throws Error
/// where more steps store than there are depths for control items.
CanvasPass lay_out(const CanvasShape& shape, const Pass& pass, bool marks, bool odd);

}  // namespace farcull
