// Triangles are clipped to the window and fattened in parallel; their drawables are joined in
// order.
#include "core/canvas/fatten.h"

#include <cmath>

#include "core/base/parallel.h"

namespace farcull {
namespace {

constexpr std::size_t kBatch = 256;

// The triangles that one thread fattens. It has its own drawables until all parts are joined.
class Part {
 public:
  Part(const Scene& scene, const Window& window, const Fattener& fattener, double radius)
      : scene_(scene),
        window_(window),
        fattener_(fattener),
        radius_(radius),
        bounds_(proxy_bounds(window)) {
    out.mode = fattener.mode;
  }

  void add(std::span<const std::uint32_t> triangles, std::uint32_t first_item) {
    out.first.reserve(triangles.size() + 1);
    if (out.mode == DepthMode::fragment) out.proxies.reserve(triangles.size());
    if (fattener_.fatten_inside == nullptr) {
      for (std::size_t i = 0; i < triangles.size(); ++i)
        add_one(triangles[i], first_item + static_cast<std::uint32_t>(i));
      return;
    }
    std::vector<Proxy> proxies(kBatch);
    std::vector<std::uint8_t> done(kBatch);
    for (std::size_t from = 0; from < triangles.size(); from += kBatch) {
      const std::size_t count = std::min(kBatch, triangles.size() - from);
      fattener_.fatten_inside({.scene = &scene_,
                               .items = &triangles[from],
                               .count = count,
                               .window = &window_,
                               .radius = radius_,
                               .bounds = bounds_,
                               .out = proxies.data(),
                               .done = done.data()});
      for (std::size_t i = 0; i < count; ++i) {
        if (done[i]) {
          out.proxies.push_back(proxies[i]);
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
    const Patch patch = clip_to_region(window_, scene_.corners(triangle));
    if (!patch.drawable()) {
      out.undrawable.push_back(item);
      ++counts.undrawable;
    } else if (patch.count == 0) {
      ++counts.outside;
    } else {
      if (patch.cuts > 0) ++counts.clipped;
      fattener_.fatten(patch, radius_, bounds_, out);
    }
    out.first.push_back(static_cast<std::uint32_t>(out.elements()));
  }

  const Scene& scene_;
  const Window& window_;
  const Fattener& fattener_;
  double radius_;
  ProxyBounds bounds_;
};

// Writes the drawables of all parts to `out`, in order; uses the memory of `out` again.
void join(const std::vector<Part>& parts, std::size_t items, Drawables& out) {
  const std::size_t count = parts.size();
  std::vector<std::size_t> element(count + 1), item(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    element[i + 1] = element[i] + parts[i].out.elements();
    item[i + 1] = item[i] + parts[i].out.items();
  }
  out.mode = parts.front().out.mode;
  out.undrawable.clear();
  for (const Part& part : parts) {
    const auto& more = part.out.undrawable;
    out.undrawable.insert(out.undrawable.end(), more.begin(), more.end());
  }
  out.first.resize(items + 1);
  out.first[0] = 0;
  const bool proxies = out.mode == DepthMode::fragment;
  out.proxies.resize(proxies ? element[count] : 0);
  out.triangles.resize(proxies ? 0 : element[count]);
  for_chunks(count, count, [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const Drawables& part = parts[i].out;
      for (std::size_t k = 1; k < part.first.size(); ++k)
        out.first[item[i] + k] = static_cast<std::uint32_t>(element[i]) + part.first[k];
      std::copy(part.proxies.begin(), part.proxies.end(),
                out.proxies.begin() + static_cast<std::ptrdiff_t>(proxies ? element[i] : 0));
      std::copy(part.triangles.begin(), part.triangles.end(),
                out.triangles.begin() + static_cast<std::ptrdiff_t>(proxies ? 0 : element[i]));
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

Fattener raw_triangles() {
  const auto draw = [](const Patch& patch, double, const ProxyBounds&, Drawables& out) {
    for (int i = 2; i < patch.count; ++i)
      add_triangle(patch.corners[0], patch.corners[i - 1], patch.corners[i], out);
  };
  return {"raw", DepthMode::fixed, {}, draw, nullptr, true};
}

Drawables fatten(const Scene& scene, std::span<const std::uint32_t> triangles, const Window& window,
                 const Fattener& fattener, double radius, FattenCounts& counts, Drawables used) {
  const std::size_t chunks = chunks_for(triangles.size(), 4096);
  std::vector<Part> parts(chunks, Part(scene, window, fattener, radius));
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
