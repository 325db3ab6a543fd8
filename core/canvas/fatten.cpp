// Clips triangles to the view's region and fattens the clipped triangles, in parallel.
#include "core/canvas/fatten.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace farcull {
namespace {

constexpr std::size_t kBatch = 256;

// Fattens a consecutive part of the triangles in one thread. `out` holds the drawables.
class Part {
 public:
  Part(const Fattener& fattener, const Drawables& waiting)
      : fattener_(fattener), batch_(waiting.batch) {
    out.mode = waiting.mode;
    out.fit = waiting.fit;
  }

  void add(std::span<const std::uint32_t> triangles, std::uint32_t first_item) {
    out.first.reserve(triangles.size() + 1);
    if (out.fit != nullptr) {
      out.sources.reserve(triangles.size());
      out.outlines.reserve(triangles.size());
    } else if (out.mode == DepthMode::fragment) {
      out.proxies.reserve(triangles.size());
    }
    if (fattener_.fatten_inside == nullptr) {
      for (std::size_t i = 0; i < triangles.size(); ++i)
        add_one(triangles[i], first_item + static_cast<std::uint32_t>(i));
      return;
    }
    UninitializedVector<Proxy> proxies(kBatch);
    UninitializedVector<ProxyOutline> outlines(kBatch);
    std::vector<std::uint8_t> done(kBatch);
    FattenBatch batch = batch_;
    batch.done = done.data();
    if (out.fit != nullptr) {
      batch.outlines = outlines.data();
    } else {
      batch.out = proxies.data();
    }
    for (std::size_t from = 0; from < triangles.size(); from += kBatch) {
      const std::size_t count = std::min(kBatch, triangles.size() - from);
      batch.items = &triangles[from];
      batch.count = count;
      fattener_.fatten_inside(batch);
      for (std::size_t i = 0; i < count; ++i) {
        if (done[i]) {
          if (out.fit != nullptr) {
            out.sources.push_back(triangles[from + i]);
            out.outlines.push_back(outlines[i]);
          } else {
            out.proxies.push_back(proxies[i]);
          }
          out.first.push_back(static_cast<std::uint32_t>(out.elements()));
        } else {
          add_one(triangles[from + i], first_item + static_cast<std::uint32_t>(from + i));
        }
      }
    }
  }

  Drawables out;
  FattenCounts counts;

 private:
  void add_one(std::uint32_t triangle, std::uint32_t item) {
    const Patch patch = clip_to_region(*batch_.window, batch_.scene->corners(triangle));
    if (!patch.drawable()) {
      out.undrawable.push_back(item);
      ++counts.undrawable;
    } else if (patch.count == 0) {
      ++counts.outside;
    } else {
      if (patch.cuts > 0) ++counts.clipped;
      fattener_.fatten(patch, batch_.radius, batch_.bounds, out);
    }
    if (out.fit != nullptr) {
      for (std::size_t k = fitted_; k < out.proxies.size(); ++k) {
        out.sources.push_back(kFitted | static_cast<std::uint32_t>(k));
        out.outlines.push_back(outline_of(out.proxies[k], *batch_.window));
      }
      fitted_ = out.proxies.size();
    }
    out.first.push_back(static_cast<std::uint32_t>(out.elements()));
  }

  const Fattener& fattener_;
  const FattenBatch& batch_;
  std::size_t fitted_ = 0;  // number of elements of out.proxies that have a source
};

// Concatenates the drawables of all parts in `out`. Reuses the memory of `out`.
void join(const std::vector<Part>& parts, std::size_t items, Drawables& out) {
  const std::size_t count = parts.size();
  std::vector<std::size_t> element(count + 1), item(count + 1), fitted(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    element[i + 1] = element[i] + parts[i].out.elements();
    fitted[i + 1] = fitted[i] + parts[i].out.proxies.size();
    item[i + 1] = item[i] + parts[i].out.items();
  }
  out.undrawable.clear();
  for (const Part& part : parts) {
    const auto& more = part.out.undrawable;
    out.undrawable.insert(out.undrawable.end(), more.begin(), more.end());
  }
  out.first.resize(items + 1);
  out.first[0] = 0;
  const bool waiting = out.fit != nullptr;
  const std::size_t triangles = out.mode == DepthMode::fixed ? element[count] : 0;
  out.proxies.resize(fitted[count]);
  out.triangles.resize(triangles);
  out.sources.resize(waiting ? element[count] : 0);
  out.outlines.resize(waiting ? element[count] : 0);
  for_chunks(count, count, [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const Drawables& part = parts[i].out;
      for (std::size_t k = 1; k < part.first.size(); ++k)
        out.first[item[i] + k] = static_cast<std::uint32_t>(element[i]) + part.first[k];
      std::copy_n(part.proxies.begin(), part.proxies.size(), out.proxies.begin() + fitted[i]);
      std::copy_n(part.triangles.begin(), part.triangles.size(),
                  out.triangles.begin() + (triangles > 0 ? element[i] : 0));
      std::copy_n(part.outlines.begin(), part.outlines.size(),
                  out.outlines.begin() + (waiting ? element[i] : 0));
      for (std::size_t k = 0; k < part.sources.size(); ++k) {
        const std::uint32_t source = part.sources[k];
        out.sources[element[i] + k] =
            source + (source & kFitted ? static_cast<std::uint32_t>(fitted[i]) : 0);
      }
    }
  });
}

void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, Drawables& out) {
  std::array<float, 12> t{};
  for (int i = 0; i < 3; ++i) {
    t[i] = static_cast<float>(a[i]);
    t[4 + i] = static_cast<float>(b[i]);
    t[8 + i] = static_cast<float>(c[i]);
  }
  out.triangles.push_back(t);
}

}  // namespace

ProxyBounds proxy_bounds(const Window& window) {
  return {0.5 * viewport_side(window.width) - 1, 0.5 * viewport_side(window.height) - 1};
}

PixelRange pixel_range(std::span<const float> points, std::size_t step, double margin,
                       const Window& window) {
  float lo[2] = {HUGE_VALF, HUGE_VALF}, hi[2] = {-HUGE_VALF, -HUGE_VALF};
  for (std::size_t i = 0; i < points.size(); i += step) {
    for (int k = 0; k < 2; ++k) {
      lo[k] = std::min(lo[k], points[i + k]);
      hi[k] = std::max(hi[k], points[i + k]);
    }
  }
  const auto first = [&](int k, int size) {
    return static_cast<std::uint16_t>(
        std::clamp<double>(std::ceil(lo[k] - margin + 0.5 * size - 0.5), 0, size));
  };
  const auto end = [&](int k, int size) {
    return static_cast<std::uint16_t>(
        std::clamp<double>(std::floor(hi[k] + margin + 0.5 * size - 0.5) + 1, 0, size));
  };
  PixelRange range{first(0, window.width), end(0, window.width), first(1, window.height),
                   end(1, window.height)};
  if (range.x0 >= range.x1) range.y1 = range.y0;
  return range;
}

ProxyOutline outline_of(const Proxy& proxy, const Window& window) {
  return {.range = pixel_range(proxy.corners, 2, 0, window),
          .nearest = -HUGE_VALF,
          .farthest = HUGE_VALF,
          .x = kNoPixel,
          .y = 0,
          .depth = 0};
}

Fattener raw_triangles() {
  const auto draw = [](const Patch& patch, double, const ProxyBounds&, Drawables& out) {
    for (int i = 2; i < patch.count; ++i)
      add_triangle(patch.corners[0], patch.corners[i - 1], patch.corners[i], out);
  };
  return {"raw", DepthMode::fixed, {}, draw, nullptr, true};
}

Drawables fatten(const Scene& scene, std::span<const std::uint32_t> triangles, const Window& window,
                 const Fattener& fattener, double radius, FattenCounts& counts, Drawables used,
                 std::optional<double> reach) {
  used.mode = fattener.mode;
  used.fit = reach && scene.triangles.size() < kFitted ? fattener.fatten_inside : nullptr;
  used.batch = {.scene = &scene,
                .window = &window,
                .radius = radius,
                .reach = reach.value_or(0),
                .bounds = proxy_bounds(window)};
  const std::size_t chunks = chunks_for(triangles.size(), 4096);
  std::vector<Part> parts(chunks, Part(fattener, used));
  for_chunks(triangles.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    parts[chunk].add(triangles.subspan(begin, end - begin), static_cast<std::uint32_t>(begin));
  });
  join(parts, triangles.size(), used);
  for (const Part& part : parts) {
    counts.outside += part.counts.outside;
    counts.clipped += part.counts.clipped;
    counts.undrawable += part.counts.undrawable;
  }
  return used;
}

}  // namespace farcull
