// Orders views by running Quick-CULLIDE on a sample of the triangles, each drawn as one point. The
// pixels are so large that the points of a surface leave few pixels of the surface empty.
#include "core/cull/view_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/cull/pass.h"

namespace farcull {
namespace {

constexpr std::size_t kMostSamples = 4096;
constexpr std::size_t kSamplesPerPixel = 8;

struct Sample {
  std::uint32_t owner;
  Vec3 centre;
};

// Returns a sample of the triangles of the regions, sorted by owner.
std::vector<Sample> sample(const Scene& scene, const Regions& regions,
                           std::span<const std::uint32_t> owner) {
  const std::size_t step = (regions.triangles.size() + kMostSamples - 1) / kMostSamples;
  std::vector<Sample> out;
  for (std::size_t i = 0; i < regions.triangles.size(); i += step) {
    const std::uint32_t t = regions.triangles[i];
    const std::array<Vec3, 3> corners = scene.corners(t);
    out.push_back({owner[t], corners[0] / 3 + corners[1] / 3 + corners[2] / 3});
  }
  std::ranges::stable_sort(out, {}, &Sample::owner);
  return out;
}

// Runs both passes of a view and sets bits. Returns the number of samples that now have both bits.
std::ptrdiff_t draw(const Window& window, std::span<const Sample> samples,
                    std::vector<std::uint8_t>& bits) {
  const std::size_t n = samples.size();
  std::vector<std::size_t> pixel(n);
  std::vector<double> depth(n);
  const auto inside = [](double at, int size) {
    return static_cast<std::size_t>(
        std::isfinite(at) ? std::clamp(std::floor(at) + size / 2, 0.0, size - 1.0) : 0.0);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = to_pixel(window, samples[i].centre).p;
    pixel[i] = inside(p[1], window.height) * static_cast<std::size_t>(window.width) +
               inside(p[0], window.width);
    depth[i] = p[2];
  }
  for (const Bit bit : {kF, kL}) {
    std::vector<double> nearest(static_cast<std::size_t>(window.width) * window.height,
                                std::numeric_limits<double>::infinity());
    const auto at = [&](std::size_t k) { return bit == kF ? k : n - 1 - k; };
    for (std::size_t from = 0, to = 0; from < n; from = to) {
      for (; to < n && samples[at(to)].owner == samples[at(from)].owner; ++to)
        if (depth[at(to)] < nearest[pixel[at(to)]]) bits[at(to)] |= bit;
      for (std::size_t k = from; k < to; ++k)
        if (!(bits[at(k)] & (kCulled ^ bit)))
          nearest[pixel[at(k)]] = std::min(nearest[pixel[at(k)]], depth[at(k)]);
    }
  }
  return std::ranges::count(bits, kCulled);
}

}  // namespace

std::vector<View> order_views(const Scene& scene, const Regions& regions,
                              std::span<const std::uint32_t> owner, std::vector<View> views) {
  if (views.size() < 2 || regions.places.empty()) return views;
  const std::vector<Sample> samples = sample(scene, regions, owner);
  const double side = std::sqrt(static_cast<double>(samples.size()) / kSamplesPerPixel);
  std::vector<std::uint8_t> bits(samples.size());
  for (auto first = views.begin(); first != views.end(); ++first) {
    auto best = first;
    std::ptrdiff_t most = -1;
    std::vector<std::uint8_t> best_bits;
    for (auto view = first; view != views.end(); ++view) {
      std::vector<std::uint8_t> drawn = bits;
      const auto window = fit_window(*view, regions.places, std::max(1, static_cast<int>(side)));
      const std::ptrdiff_t culled = window ? draw(*window, samples, drawn) : 0;
      if (culled <= most) continue;
      most = culled;
      best = view;
      best_bits = std::move(drawn);
    }
    std::rotate(first, best, best + 1);
    bits = std::move(best_bits);
  }
  return views;
}

}  // namespace farcull
