#include "core/pairs/runs.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"

namespace farcull {
namespace {

// Triangles whose corners are fetched ahead.
constexpr std::size_t kAhead = 16;

// The box of the triangles at the positions from .. to - 1. Each of the three corners has minima
// and maxima of its own, so that none waits for another.
template <class Triangle>
Box box_of(const Scene& scene, std::size_t from, std::size_t to, const Triangle& triangle) {
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
    void add(const Corner& c) {
      lo_xy = _mm_min_pd(lo_xy, c.lo_xy);
      hi_xy = _mm_max_pd(hi_xy, c.hi_xy);
      lo_z = _mm_min_sd(lo_z, c.lo_z);
      hi_z = _mm_max_sd(hi_z, c.hi_z);
    }
  };
  const __m128d inf = _mm_set1_pd(HUGE_VAL), minus = _mm_set1_pd(-HUGE_VAL);
  Corner a{inf, minus, inf, minus}, b = a, c = a;
  const std::size_t end = scene.triangles.size() - 1;
  for (std::size_t t = from; t < to; ++t) {
    // Their corners may lie anywhere, so they are fetched ahead.
    for (const std::uint32_t v : scene.triangles[triangle(std::min(t + kAhead, end))]) {
      _mm_prefetch(reinterpret_cast<const char*>(scene.vertices[v].data()), _MM_HINT_T0);
    }
    const std::array<std::uint32_t, 3>& v = scene.triangles[triangle(t)];
    a.add(scene.vertices[v[0]].data());
    b.add(scene.vertices[v[1]].data());
    c.add(scene.vertices[v[2]].data());
  }
  a.add(b);
  a.add(c);
  Box box;
  _mm_storeu_pd(box.lo.data(), a.lo_xy);
  _mm_store_sd(box.lo.data() + 2, a.lo_z);
  _mm_storeu_pd(box.hi.data(), a.hi_xy);
  _mm_store_sd(box.hi.data() + 2, a.hi_z);
  return box;
#else
  Box box = Box::empty();
  for (std::size_t t = from; t < to; ++t) {
    for (const std::uint32_t v : scene.triangles[triangle(t)]) box.add(scene.vertices[v]);
  }
  return box;
#endif
}

}  // namespace

double half_of(double clearance) {
  return clearance == 0 ? 0 : std::nextafter(0.5 * clearance, HUGE_VAL);
}

// Never decreasing, and beyond the exact sum.
Box grow(const Box& box, double half) {
  if (half == 0 || box.is_empty()) return box;
  Box out = box;
  for (int axis = 0; axis < 3; ++axis) {
    out.lo[axis] = std::nextafter(box.lo[axis] - half, -HUGE_VAL);
    out.hi[axis] = std::nextafter(box.hi[axis] + half, HUGE_VAL);
  }
  return out;
}

Box grown_box(const Scene& scene, std::uint32_t triangle, double clearance) {
  Box box = Box::empty();
  for (const std::uint32_t v : scene.triangles[triangle]) box.add(scene.vertices[v]);
  return grow(box, half_of(clearance));
}

Runs make_runs(const Scene& scene, double clearance, unsigned threads) {
  Runs out;
  const std::size_t objects = scene.objects.size();
  out.first.resize(objects + 1, 0);
  for (std::size_t o = 0; o < objects; ++o) {
    const Object& object = scene.objects[o];
    for (std::uint32_t t = 0; t < object.triangle_count; t += kRun) {
      out.runs.push_back({object.first_triangle + t, std::min(kRun, object.triangle_count - t)});
    }
    out.first[o + 1] = static_cast<std::uint32_t>(out.runs.size());
  }
  const std::size_t n = out.runs.size();
  const double half = half_of(clearance);
  out.boxes.resize(n);
  const auto in_file = [](std::size_t t) { return t; };
  for_chunks(n, chunks_for(n, 256, threads), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Run& run = out.runs[k];
      out.boxes[k] = grow(box_of(scene, run.first, run.first + run.count, in_file), half);
    }
  });
  out.objects.assign(objects, Box::empty());
  for (std::size_t o = 0; o < objects; ++o) {
    for (std::uint32_t k = out.first[o]; k < out.first[o + 1]; ++k)
      out.objects[o].add(out.boxes[k]);
  }
  return out;
}

namespace {

double length(const Box& box) { return (box.hi - box.lo).sum(); }

// Whether the boxes of an object's runs are much longer than those of compact parts of a surface.
bool is_scattered(const Runs& runs, std::uint32_t object) {
  const std::uint32_t count = runs.count(object);
  double sum = 0;
  for (std::uint32_t k = runs.first[object]; k < runs.first[object + 1]; ++k) {
    sum += length(runs.boxes[k]);
  }
  return sum > kScattered * std::sqrt(count) * length(runs.objects[object]);
}

// The lower 10 bits of x, two zeros before each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  return (x | x << 2) & 0x09249249;
}

struct Coded {
  std::uint32_t code, triangle;
};

// By the codes' lower `bits` bits, those of equal codes in their order before.
void sort_by_code(std::vector<Coded>& all, int bits) {
  constexpr int kDigit = 12;
  std::vector<Coded> other(all.size());
  for (int shift = 0; shift < bits; shift += kDigit) {
    std::array<std::uint32_t, (1 << kDigit) + 1> first{};
    const auto digit = [&](const Coded& c) { return c.code >> shift & ((1 << kDigit) - 1); };
    for (const Coded& c : all) ++first[digit(c) + 1];
    for (std::size_t k = 0; k + 1 < first.size(); ++k) first[k + 1] += first[k];
    for (const Coded& c : all) other[first[digit(c)]++] = c;
    all.swap(other);
  }
}

// The cells of a grid over a box, and their places on a Morton curve.
class MortonGrid {
 public:
  // Cells half as wide as a run of a surface of so many triangles, about.
  MortonGrid(const Box& box, std::uint32_t triangles)
      : bits_(
            std::clamp(static_cast<int>(std::ceil(0.5 * std::log2(triangles / 16.0))) + 1, 4, 10)),
        most_((1 << bits_) - 1),
        lo_(box.lo),
        scale_(std::min(most_ / std::max((0.5 * box.hi - 0.5 * box.lo).maxCoeff(), 0x1p-1000),
                        0x1p1000)) {}
  int bits() const { return 3 * bits_; }
  std::uint32_t code(const Vec3& p) const {
    // By halves, which cannot be infinite.
    const Vec3 at = ((0.5 * p - 0.5 * lo_) * scale_).cwiseMax(0.0).cwiseMin(most_);
    const Eigen::Vector3i cell = at.cast<int>();
    const auto part = [&](int axis) { return spread(static_cast<std::uint32_t>(cell[axis])); };
    return part(0) | part(1) << 1 | part(2) << 2;
  }

 private:
  int bits_;
  double most_;
  Vec3 lo_;
  double scale_;
};

bool meets(const Scene& scene, std::uint32_t triangle, const Box& box) {
  const auto& [i, j, k] = scene.triangles[triangle];
  const Vec3 &p = scene.vertices[i], &q = scene.vertices[j], &r = scene.vertices[k];
  const Vec3 lo = p.cwiseMin(q).cwiseMin(r), hi = p.cwiseMax(q).cwiseMax(r);
  return (lo.array() <= box.hi.array()).all() && (box.lo.array() <= hi.array()).all();
}

// The triangles of an object that meet `region` in Morton order, then the others; returns how many
// meet it.
std::uint32_t order_object(const Scene& scene, const Object& object, const Box& region,
                           unsigned threads, std::span<std::uint32_t> order) {
  const MortonGrid grid(region, object.triangle_count);
  const std::size_t n = object.triangle_count, chunks = chunks_for(n, 8192, threads);
  std::vector<std::vector<Coded>> parts(chunks);
  std::vector<std::vector<std::uint32_t>> outside(chunks);
  for_chunks(n, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::vector<Coded> inside;
    inside.reserve(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t t = object.first_triangle + static_cast<std::uint32_t>(k);
      prefetch(scene,
               object.first_triangle + static_cast<std::uint32_t>(std::min(k + kAhead, end - 1)));
      if (meets(scene, t, region)) {
        inside.push_back({grid.code(scene.vertices[scene.triangles[t][0]]), t});
      } else {
        outside[chunk].push_back(t);
      }
    }
    parts[chunk] = std::move(inside);
  });
  std::vector<Coded> inside = std::move(parts[0]);
  for (std::size_t k = 1; k < chunks; ++k) {
    inside.insert(inside.end(), parts[k].begin(), parts[k].end());
  }
  sort_by_code(inside, grid.bits());
  std::uint32_t* next = order.data();
  for (const Coded& coded : inside) *next++ = coded.triangle;
  for (const auto& part : outside) next = std::copy(part.begin(), part.end(), next);
  return static_cast<std::uint32_t>(inside.size());
}

}  // namespace

void gather_scattered(const Scene& scene, double clearance, std::span<const Box> regions,
                      unsigned threads, Runs& runs) {
  std::vector<std::uint32_t> scattered;
  for (std::uint32_t o = 0; o < regions.size(); ++o) {
    if (!regions[o].is_empty() && is_scattered(runs, o)) scattered.push_back(o);
  }
  if (scattered.empty()) return;
  runs.order.resize(scene.triangles.size());
  std::iota(runs.order.begin(), runs.order.end(), 0u);
  const double half = half_of(clearance);
  std::vector<std::uint32_t> inside(scattered.size());
  // One object after the other in several threads where there are few, else each in one.
  const std::size_t cores = chunks_for(SIZE_MAX, 1, threads);
  const std::size_t chunks = scattered.size() < cores ? 1 : cores;
  std::atomic<std::size_t> next = 0;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    for (std::size_t k = next++; k < scattered.size(); k = next++) {
      const std::uint32_t o = scattered[k];
      const Object& object = scene.objects[o];
      inside[k] =
          order_object(scene, object, grow(regions[o], half), chunks > 1 ? 1 : threads,
                       std::span(runs.order).subspan(object.first_triangle, object.triangle_count));
    }
  });
  const auto ordered = [&](std::size_t position) { return runs.order[position]; };
  for (std::size_t i = 0; i < scattered.size(); ++i) {
    const std::uint32_t o = scattered[i], begin = runs.first[o];
    const std::uint32_t n = (inside[i] + kRun - 1) / kRun;
    std::fill(runs.boxes.begin() + begin + n, runs.boxes.begin() + runs.first[o + 1], Box::empty());
    for_chunks(n, chunks_for(n, 256, threads), [&](std::size_t, std::size_t from, std::size_t to) {
      for (std::size_t k = begin + from; k < begin + to; ++k) {
        const Run& run = runs.runs[k];
        runs.boxes[k] = grow(box_of(scene, run.first, run.first + run.count, ordered), half);
      }
    });
  }
}

}  // namespace farcull
