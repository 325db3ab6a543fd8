// Triangles are clipped to the window and fattened in parallel; their drawables are joined in
// order.
#include "core/canvas/fatten.h"

#include <cmath>

#include "core/base/parallel.h"

namespace farcull {
namespace {

Drawables fatten_part(const Scene& scene, std::span<const std::uint32_t> triangles,
                      std::uint32_t first_item, const Window& window, const Fattener& fattener,
                      double radius, FattenCounts& counts) {
  Drawables out;
  out.mode = fattener.mode;
  out.first.reserve(triangles.size() + 1);
  if (out.mode == DepthMode::fragment) out.proxies.reserve(triangles.size());
  const ProxyBounds bounds = proxy_bounds(window);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Patch patch = clip_to_region(window, scene.corners(triangles[i]));
    if (!patch.drawable()) {
      out.undrawable.push_back(first_item + static_cast<std::uint32_t>(i));
      ++counts.undrawable;
    } else if (patch.count == 0) {
      ++counts.outside;
    } else {
      if (patch.cuts > 0) ++counts.clipped;
      fattener.fatten(patch, radius, bounds, out);
    }
    out.first.push_back(static_cast<std::uint32_t>(out.elements()));
  }
  return out;
}

void append(Drawables& to, const Drawables& from) {
  const auto base = static_cast<std::uint32_t>(to.elements());
  for (std::size_t i = 1; i < from.first.size(); ++i) to.first.push_back(base + from.first[i]);
  to.proxies.insert(to.proxies.end(), from.proxies.begin(), from.proxies.end());
  to.triangles.insert(to.triangles.end(), from.triangles.begin(), from.triangles.end());
  to.undrawable.insert(to.undrawable.end(), from.undrawable.begin(), from.undrawable.end());
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
  return {"raw", DepthMode::fixed, {}, draw, true};
}

std::array<float, 8> proxy_rectangle(std::span<const Vec3> points, double radius,
                                     const ProxyBounds& bounds) {
  // Along the longest image of an edge: the tight direction for slivers, and a fair one for all
  // else.
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double longest = 1e-100;  // below it the squares underflow and the quotient is no unit vector
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d edge = (points[(i + 1) % points.size()] - points[i]).head<2>();
    const double length = edge.norm();
    if (length > longest) {
      longest = length;
      along = edge / length;
    }
  }
  const auto rectangle = [&](const Eigen::Vector2d& u, std::array<double, 8>& corners) {
    const Eigen::Vector2d v(-u[1], u[0]);
    double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
    for (const Vec3& p : points) {
      const double s[2] = {u.dot(p.head<2>()), v.dot(p.head<2>())};
      for (int i = 0; i < 2; ++i) {
        lo[i] = std::min(lo[i], s[i] - radius);
        hi[i] = std::max(hi[i], s[i] + radius);
      }
    }
    const double at[4][2] = {{lo[0], lo[1]}, {hi[0], lo[1]}, {hi[0], hi[1]}, {lo[0], hi[1]}};
    for (int i = 0; i < 4; ++i) {
      corners[2 * i] = at[i][0] * u[0] + at[i][1] * v[0];
      corners[2 * i + 1] = at[i][0] * u[1] + at[i][1] * v[1];
    }
  };
  std::array<double, 8> corners;
  rectangle(along, corners);
  bool fits = true;
  for (int i = 0; i < 4; ++i) {
    fits = fits && std::abs(corners[2 * i]) <= bounds.x && std::abs(corners[2 * i + 1]) <= bounds.y;
  }
  if (!fits) {
    rectangle(Eigen::Vector2d::UnitX(), corners);
    for (int i = 0; i < 4; ++i) {
      corners[2 * i] = std::clamp(corners[2 * i], -bounds.x, bounds.x);
      corners[2 * i + 1] = std::clamp(corners[2 * i + 1], -bounds.y, bounds.y);
    }
  }
  std::array<float, 8> out;
  for (int i = 0; i < 8; ++i) out[i] = static_cast<float>(corners[i]);
  return out;
}

Drawables fatten(const Scene& scene, std::span<const std::uint32_t> triangles, const Window& window,
                 const Fattener& fattener, double radius, FattenCounts& counts) {
  const std::size_t chunks = chunks_for(triangles.size(), 4096);
  std::vector<Drawables> parts(chunks);
  std::vector<FattenCounts> part_counts(chunks);
  for_chunks(triangles.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    parts[chunk] =
        fatten_part(scene, triangles.subspan(begin, end - begin), static_cast<std::uint32_t>(begin),
                    window, fattener, radius, part_counts[chunk]);
  });
  for (std::size_t i = 1; i < chunks; ++i) append(parts[0], parts[i]);
  for (const FattenCounts& part : part_counts) {
    counts.outside += part.outside;
    counts.clipped += part.clipped;
    counts.undrawable += part.undrawable;
  }
  return std::move(parts[0]);
}

}  // namespace farcull
