// Implements the canvas on the CPU. begin() finds the pixels that each element may cover. draw()
// divides the window's rows among threads, so that all draw about the same number of elements.
#include "core/native/canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/canvas/fatten.h"

namespace farcull {
namespace {

constexpr int kMostPixels = 16380;    // px per side of the window; the border extends this to 2^14
constexpr std::size_t kLeast = 2048;  // smallest number of draws that are worth a thread

}  // namespace

RasterLimits native_limits(int depth_bits) {
  return {.subpixel_bits = kNativeSubpixelBits,
          .depth_bits = depth_bits,
          .max_resolution = kMostPixels - 5,  // fit_window() adds up to 5 px
          .exact_samples = true};
}

NativeCanvas::NativeCanvas(DepthMode mode, const SolidProgram& solid,
                           const NativeCanvasOptions& options)
    : mode_(mode),
      draw_rows_(mode == DepthMode::fragment ? solid.draw_native : draw_triangles_native),
      options_(options),
      limits_(native_limits(options.depth_bits)) {
  if (draw_rows_ == nullptr)
    throw std::logic_error("NativeCanvas: the solid has no function for lanes");
  if (options.conservative && mode == DepthMode::fragment)
    throw std::logic_error("NativeCanvas: proxies are not drawn conservatively");
  if (options.depth_bits != 24 && options.depth_bits != 32) {
    throw Error("{depth_format}", std::to_string(options.depth_bits) + " bits are not offered",
                "choose 24 or 32");
  }
}

void NativeCanvas::begin(const Window& window, const Drawables& drawables) {
  drawables_ = nullptr;
  if (drawables.mode != mode_) throw std::logic_error("NativeCanvas: drawables of the other mode");
  for (const int side : {window.width, window.height}) {
    if (side < 1 || side > kMostPixels)
      throw std::logic_error("NativeCanvas: a window of " + std::to_string(side) + " px");
  }
  window_ = window;
  const bool proxies = mode_ == DepthMode::fragment, waiting = drawables.fit != nullptr;
  const std::size_t count = drawables.elements(), unknown = waiting ? 0 : count;
  ranges_.resize(proxies ? 0 : count);
  outlines_.resize(proxies ? unknown : 0);
  // reach (px): pixel centres within this distance of a triangle may be covered. Snapping moves a
  // corner by at most 2^-9. A pixel's square extends 0.5 px from the centre.
  const double reach = options_.conservative ? 0x1p-8 + 0.5 : 0x1p-8;
  for_chunks(unknown, chunks_for(unknown, 4 * kLeast, options_.threads),
             [&](std::size_t, std::size_t from, std::size_t to) {
               for (std::size_t i = from; i < to; ++i) {
                 if (proxies) {
                   outlines_[i] = outline_of(drawables.proxies[i], window);
                 } else {
                   ranges_[i] = pixel_range(drawables.triangles[i], 4, reach, window);
                 }
               }
             });
  work_.assign(static_cast<std::size_t>(window.height) + 1, 0);
  const ProxyOutline* const outlines = waiting ? drawables.outlines.data() : outlines_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const PixelRange& range = proxies ? outlines[i].range : ranges_[i];
    if (range.y0 < range.y1) ++work_[(range.y0 + range.y1) / 2 + 1u];
  }
  for (int y = 0; y < window.height; ++y) work_[y + 1u] += work_[y];
  stride_ = window.width + kNativeOverhang;
  drawables_ = &drawables;
}

NativeJob NativeCanvas::job(NativeOutput output, float empty) {
  if (drawables_ == nullptr) throw std::logic_error("NativeCanvas: nothing was begun");
  depth_.assign(static_cast<std::size_t>(window_.height + kNativeOverhang) * stride_, empty);
  return {.width = window_.width,
          .height = window_.height,
          .stride = stride_,
          .y0 = 0,
          .y1 = window_.height,
          .scale = depth_scale(window_),
          .fixed24 = options_.depth_bits == 24,
          .conservative = options_.conservative,
          .drawables = drawables_,
          .outlines = drawables_->fit != nullptr ? drawables_->outlines.data() : outlines_.data(),
          .ranges = ranges_.data(),
          .output = output,
          .touching = true,
          .steps = nullptr,
          .step_count = 0,
          .draws = nullptr,
          .depth = depth_.data(),
          .seen = nullptr};
}

void NativeCanvas::draw(const NativeJob& job, const Pass& pass) {
  const std::size_t bands =
      std::min<std::size_t>(chunks_for(pass.draws.size(), kLeast, options_.threads),
                            static_cast<std::size_t>(job.height));
  // Thread b draws the rows border[b] .. border[b + 1] - 1.
  std::vector<int> border(bands + 1, job.height);
  border[0] = 0;
  for (std::size_t b = 1; b < bands; ++b) {
    const std::uint64_t share = work_.back() * b / bands;
    const auto at = std::upper_bound(work_.begin(), work_.end(), share);
    border[b] = std::clamp(static_cast<int>(at - work_.begin()) - 1, border[b - 1], job.height);
  }
  for_chunks(bands, bands, [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t b = from; b < to; ++b) {
      NativeJob part = job;
      part.y0 = border[b];
      part.y1 = border[b + 1];
      part.touching = pass.touching;
      part.steps = pass.steps.data();
      part.step_count = static_cast<std::uint32_t>(pass.steps.size());
      part.draws = pass.draws.data();
      draw_rows_(part);
    }
  });
}

std::vector<std::uint8_t> NativeCanvas::run(const Pass& pass) {
  NativeJob all = job(NativeOutput::run, options_.depth_bits == 24 ? 0x1p24f - 1 : 1.0f);
  std::vector<std::uint8_t> seen(pass.slots);
  all.seen = seen.data();
  draw(all, pass);
  return seen;
}

std::vector<float> NativeCanvas::gather(NativeOutput output, Verb verb,
                                        const std::vector<Draw>& draws, float empty) {
  const NativeJob all = job(output, empty);
  Pass pass;
  pass.draws = draws;
  pass.steps = {{verb, 0, static_cast<std::uint32_t>(draws.size())}};
  draw(all, pass);
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(window_.width) * window_.height);
  for (int y = 0; y < window_.height; ++y) {
    const float* const row = depth_.data() + static_cast<std::ptrdiff_t>(y) * stride_;
    out.insert(out.end(), row, row + window_.width);
  }
  return out;
}

std::vector<float> NativeCanvas::samples(Verb verb, const std::vector<Draw>& draws) {
  if (mode_ == DepthMode::fixed) throw std::logic_error("NativeCanvas::samples: proxies only");
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> out =
      gather(NativeOutput::values, verb, draws, verb == Verb::store ? kInfinity : -kInfinity);
  for (float& z : out) {
    if (std::isinf(z)) z = std::numeric_limits<float>::quiet_NaN();
  }
  return out;
}

std::vector<float> NativeCanvas::depths(Verb verb, const std::vector<Draw>& draws) {
  const bool fixed24 = options_.depth_bits == 24;
  const float top = fixed24 ? 0x1p24f - 1 : 1.0f;
  std::vector<float> out =
      gather(NativeOutput::depths, verb, draws, verb == Verb::store ? top : 0.0f);
  if (fixed24) {
    for (float& z : out) z /= top;
  }
  return out;
}

}  // namespace farcull
