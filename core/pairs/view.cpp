#include "core/pairs/view.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/scene/box_join.h"

namespace farcull {
namespace {

constexpr double kUnit = 0x1p-53;
constexpr double kLargest = 0x1p20;         // px, of a coordinate that kernels take
constexpr double kSmallest = 0x1p-60;       // px, of one that is not zero
constexpr double kLeastWidening = 0x1p-40;  // px

// Never decreasing, and beyond the exact sum.
Box grow(Box box, double half) {
  if (half == 0 || box.is_empty()) return box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::nextafter(box.lo[axis] - half, -HUGE_VAL);
    box.hi[axis] = std::nextafter(box.hi[axis] + half, HUGE_VAL);
  }
  return box;
}

// The box of the triangles from .. to - 1. Each of the three corners has minima and maxima of its
// own, so that none waits for another.
Box box_of(const Scene& scene, std::size_t from, std::size_t to) {
  Box box = Box::empty();
#ifdef __SSE2__
  struct Corner {
    __m128d lo_xy, hi_xy, lo_z, hi_z;
    void add(const double* p) {
      const __m128d xy = _mm_loadu_pd(p), z = _mm_load_sd(p + 2);
      lo_xy = _mm_min_pd(lo_xy, xy);
      hi_xy = _mm_max_pd(hi_xy, xy);
      lo_z = _mm_min_sd(lo_z, z);
      hi_z = _mm_max_sd(hi_z, z);
    }
  };
  const __m128d inf = _mm_set1_pd(HUGE_VAL), minus = _mm_set1_pd(-HUGE_VAL);
  Corner a{inf, minus, inf, minus}, b = a, c = a;
  for (std::size_t t = from; t < to; ++t) {
    // Their corners may lie anywhere, so they are fetched ahead.
    for (const std::uint32_t v : scene.triangles[std::min(t + 16, to - 1)]) {
      _mm_prefetch(reinterpret_cast<const char*>(scene.vertices[v].data()), _MM_HINT_T0);
    }
    const std::array<std::uint32_t, 3>& v = scene.triangles[t];
    a.add(scene.vertices[v[0]].data());
    b.add(scene.vertices[v[1]].data());
    c.add(scene.vertices[v[2]].data());
  }
  for (const Corner& corner : {a, b, c}) {
    double lo[2], hi[2];
    _mm_storeu_pd(lo, corner.lo_xy);
    _mm_storeu_pd(hi, corner.hi_xy);
    box.add(Box{{lo[0], lo[1], _mm_cvtsd_f64(corner.lo_z)},
                {hi[0], hi[1], _mm_cvtsd_f64(corner.hi_z)}});
  }
#else
  for (std::size_t t = from; t < to; ++t) {
    for (const std::uint32_t v : scene.triangles[t]) box.add(scene.vertices[v]);
  }
#endif
  return box;
}

std::vector<Box> boxes_of_objects(const Scene& scene, unsigned threads) {
  std::vector<Box> boxes(scene.objects.size(), Box::empty());
  const std::vector<Object>& objects = scene.objects;
  // In chunks of triangles, whatever the sizes of the objects.
  const std::size_t chunks = chunks_for(scene.triangles.size(), 4096, threads);
  struct Part {
    std::size_t first = 0;
    std::vector<Box> boxes;
  };
  std::vector<Part> parts(chunks);
  for_chunks(
      scene.triangles.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        if (begin == end) return;
        Part& part = parts[chunk];
        const auto after =
            std::upper_bound(objects.begin(), objects.end(), begin,
                             [](std::size_t t, const Object& o) { return t < o.first_triangle; });
        std::size_t o = static_cast<std::size_t>(after - objects.begin()) - 1;
        part.first = o;
        for (std::size_t t = begin; t < end; ++o) {
          const std::size_t stop = std::min<std::size_t>(
              end, std::size_t{objects[o].first_triangle} + objects[o].triangle_count);
          part.boxes.push_back(box_of(scene, t, stop));
          t = stop;
        }
      });
  for (const Part& part : parts) {
    for (std::size_t k = 0; k < part.boxes.size(); ++k) boxes[part.first + k].add(part.boxes[k]);
  }
  return boxes;
}

// A float that is not below x.
float float_above(double x) {
  const float f = static_cast<float>(x);
  return f < x ? std::nextafter(f, HUGE_VALF) : f;
}
float float_below(double x) { return -float_above(-x); }

PixelVertex pixel_vertex(const Vec3& p) {
  const auto rounded = [](double x) { return static_cast<float>(std::abs(x) < kSmallest ? 0 : x); };
  return {rounded(p.x()), rounded(p.y()), rounded(p.z()), 0};
}

}  // namespace

double half_of(double clearance) {
  return clearance == 0 ? 0 : std::nextafter(0.5 * clearance, HUGE_VAL);
}

Box grown_box(const Scene& scene, std::uint32_t triangle, double clearance) {
  Box box = Box::empty();
  for (const std::uint32_t v : scene.triangles[triangle]) box.add(scene.vertices[v]);
  return grow(box, half_of(clearance));
}

PairRegions pair_regions(const Scene& scene, double clearance, bool full, unsigned threads) {
  PairRegions out;
  std::vector<Box> boxes = boxes_of_objects(scene, threads);
  for (Box& box : boxes) box = grow(box, half_of(clearance));
  out.objects.assign(boxes.size(), Box::empty());
  std::vector<std::uint32_t> objects(boxes.size());
  std::iota(objects.begin(), objects.end(), 0u);
  for (const TrianglePair& pair : box_join(boxes, objects, objects)) {
    const Box common = intersection(boxes[pair.a], boxes[pair.b]);
    out.objects[pair.a].add(common);
    out.objects[pair.b].add(common);
    ++out.pairs;
  }
  std::size_t count = 0;
  for (std::size_t o = 0; o < boxes.size(); ++o) {
    if (scene.objects[o].self && scene.objects[o].triangle_count > 1) {
      out.objects[o] = boxes[o];
      ++out.self;
    }
    if (full) out.objects[o] = boxes[o];
    if (out.objects[o].is_empty()) continue;
    out.reach.add(boxes[o]);
    count += scene.objects[o].triangle_count;
  }
  out.triangles.resize(count);
  std::uint32_t* next = out.triangles.data();
  for (std::size_t o = 0; o < boxes.size(); ++o) {
    if (out.objects[o].is_empty()) continue;
    const Object& object = scene.objects[o];
    std::iota(next, next + object.triangle_count, object.first_triangle);
    next += object.triangle_count;
  }
  return out;
}

std::optional<PairWindow> pair_window(const PairRegions& regions, const View& view, int resolution,
                                      double clearance) {
  std::vector<Box> present;
  for (const Box& box : regions.objects) {
    if (box.is_empty()) continue;
    present.push_back(box);
  }
  const std::optional<Window> window = fit_window(view, present, resolution);
  if (!window) return std::nullopt;
  PairWindow out{.window = *window, .widening = {}};
  // The clearance, and the double arithmetic of the map for a vertex at the limit of drawability.
  for (int axis = 0; axis < 3; ++axis) {
    // Scaled before it is squared: rows of huge scenes are below what a square can hold.
    const double ball = half_of(clearance) * window->map.row(axis).stableNorm();
    const double sum = (ball + kMaxDoubleError + kLeastWidening) * (1 + 0x1p-20);
    if (!(sum <= kLargest)) return std::nullopt;
    out.widening[axis] = float_above(sum);
  }
  return out;
}

void look(const Scene& scene, const PairRegions& regions, std::span<const std::uint32_t> triangles,
          const PairWindow& seen_in, unsigned threads, PairScene& out) {
  const Window* const window = &seen_in.window;
  const std::array<float, 3>& widening = seen_in.widening;
  out.window = *window;

  const Vec3 corner(0.5 * window->width, 0.5 * window->height, 0);
  out.limits.resize(scene.objects.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (regions.objects[o].is_empty()) {
      out.limits[o] = {{1, 1, 1, 0}, {-1, -1, -1, 0}};
      continue;
    }
    Box px = pixel_box(*window, regions.objects[o]);
    px.lo += corner;
    px.hi += corner;
    out.limits[o] = {{float_below(px.lo.x()), float_below(px.lo.y()), float_below(px.lo.z()), 0},
                     {float_above(px.hi.x()), float_above(px.hi.y()), float_above(px.hi.z()), 0}};
  }

  // Where the boxes of the objects already are within the bounds, so is each of their vertices.
  const Box whole = pixel_box(*window, regions.reach);
  const double largest = std::max(whole.lo.cwiseAbs().maxCoeff(), whole.hi.cwiseAbs().maxCoeff());
  const bool all_drawable = largest + corner.maxCoeff() <= kLargest &&
                            pixel_error(*window, regions.reach) <= kMaxDoubleError;
  const std::size_t n = scene.vertices.size();
  out.vertices.resize(n);
  const std::size_t chunks = chunks_for(n, 4096, threads);
  std::atomic<bool> some_undrawable = false;
  for_chunks(n, chunks, [&](std::size_t, std::size_t begin, std::size_t end) {
    if (all_drawable) {
      const Eigen::Matrix3d map = window->map;
      const Vec3 origin = window->origin;
      for (std::size_t v = begin; v < end; ++v) {
        out.vertices[v] = pixel_vertex(map * (scene.vertices[v] - origin) + corner);
      }
      return;
    }
    bool bad = false;
    for (std::size_t v = begin; v < end; ++v) {
      const PixelPoint point = to_pixel(*window, scene.vertices[v]);
      const Vec3 p = point.p + corner;
      const bool drawable = point.error <= kMaxDoubleError && p.cwiseAbs().maxCoeff() <= kLargest;
      bad |= !drawable;
      out.vertices[v] = drawable ? pixel_vertex(p) : PixelVertex{0, 0, 0, 1};
    }
    if (bad) some_undrawable = true;
  });

  out.undrawable.clear();
  out.active.assign(triangles.begin(), triangles.end());
  if (some_undrawable) {
    out.active.clear();
    for (const std::uint32_t t : triangles) {
      const auto& c = scene.triangles[t];
      const bool bad =
          out.vertices[c[0]].w != 0 || out.vertices[c[1]].w != 0 || out.vertices[c[2]].w != 0;
      (bad ? out.undrawable : out.active).push_back(t);
    }
  }
  out.owners = owners(scene);
  out.self.resize(scene.objects.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) out.self[o] = scene.objects[o].self;
  out.task = {.vertices = out.vertices,
              .triangles = scene.triangles,
              .owners = out.owners,
              .self = out.self,
              .limits = out.limits,
              .active = out.active,
              .width = window->width,
              .height = window->height,
              .near_px = float_below(window->lo[2]),
              .far_px = float_above(window->hi[2]),
              .widening = {widening[0], widening[1], widening[2], 0}};
}

}  // namespace farcull
