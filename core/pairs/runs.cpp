#include "core/pairs/runs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"
#include "core/pairs/box_tree.h"
#include "core/pairs/grown_box.h"

namespace farcull {
namespace {

// Triangles whose corners are fetched ahead.
constexpr std::size_t kAhead = 16;

double length(const Box& box) { return (box.hi - box.lo).sum(); }

// Whether boxes of runs are much longer than those of compact parts of a surface would be. mean: of
// their lengths.
bool are_scattered(double mean, std::uint32_t runs, const Box& object) {
  return mean * std::sqrt(runs) > kScattered * length(object);
}

bool is_scattered(const Runs& runs, std::uint32_t object) {
  const std::uint32_t count = runs.first[object + 1] - runs.first[object];
  double sum = 0;
  for (std::uint32_t k = 0; k < count; ++k) sum += length(runs.boxes[runs.first[object] + k]);
  return are_scattered(sum / count, count, runs.objects[object]);
}

// Runs of a sample. An object with four times as many is judged by one.
constexpr std::uint32_t kSampledRuns = 64;

// The mean length of some runs of an object, where it has many and that says that they are
// scattered; else 0. `box` becomes that of the sample.
double sampled_length(const Scene& scene, const Runs& runs, std::uint32_t object, Box& box) {
  const std::uint32_t count = runs.first[object + 1] - runs.first[object];
  if (count < 4 * kSampledRuns) return 0;
  double sum = 0;
  for (std::uint32_t k = 0; k < kSampledRuns; ++k) {
    // Multiples of the golden ratio: as even as a grid, without its period, since surfaces often
    // have one.
    const double at = 0.6180339887498949 * k;
    const auto position = static_cast<std::uint32_t>((at - std::floor(at)) * count);
    const Run& run = runs.runs[runs.first[object] + std::min(position, count - 1)];
    const Box own = box_of(scene, run.first, run.first + run.count);
    sum += length(own);
    box.add(own);
  }
  const double mean = sum / kSampledRuns;
  return are_scattered(mean, count, box) ? mean : 0;
}

// Whether most triangles of an object lie in a small part of its box, which is grown by `half`.
bool is_stretched(const Scene& scene, const Object& object, const Box& box, double half) {
  constexpr std::size_t kSample = 64, kEnd = kSample / 8;
  if (object.triangle_count < 4 * kSampledRuns * kRun)
    return false;              // a sample would cost too much
  double side = 0, whole = 0;  // sums of half sides: whole ones may be infinite
  std::array<double, kSample> at;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < kSample; ++k) {
      const double place = 0.6180339887498949 * static_cast<double>(k);  // as in sampled_length()
      const auto t =
          static_cast<std::uint32_t>((place - std::floor(place)) * (object.triangle_count - 1));
      at[k] = scene.vertices[scene.triangles[object.first_triangle + t][0]][axis];
    }
    std::ranges::sort(at);
    side += 0.5 * at[kSample - 1 - kEnd] - 0.5 * at[kEnd] + half;
    whole += 0.5 * box.hi[axis] - 0.5 * box.lo[axis];
  }
  return whole > kStretched * side;
}

// Which objects are; empty: none.
std::vector<std::uint8_t> stretched_objects(const Scene& scene, std::span<const Box> boxes,
                                            double half) {
  std::vector<std::uint8_t> out;
  for (std::size_t o = 0; o < boxes.size(); ++o) {
    if (!is_stretched(scene, scene.objects[o], boxes[o], half)) continue;
    out.resize(boxes.size(), 0);
    out[o] = 1;
  }
  return out;
}

// The boxes of an object's triangles, grown, relative to the origin; returns the box of all, not
// grown.
Box fill_boxes(const Scene& scene, const Object& object, double half, const Vec3& origin,
               unsigned threads, FloatBox* out) {
  const std::size_t n = object.triangle_count, chunks = chunks_for(n, 4096, threads);
  std::vector<Box> parts(chunks, Box::empty());
  for_chunks(n, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    const std::uint32_t first = object.first_triangle;
    parts[chunk] =
        relative_boxes(scene, first + static_cast<std::uint32_t>(begin),
                       first + static_cast<std::uint32_t>(end), half, origin, out + begin);
  });
  Box all = Box::empty();
  for (const Box& part : parts) all.add(part);
  return all;
}

// Calls work(k, threads) for k in 0 .. count - 1: one after the other in all threads where there
// are few, else each in one.
template <class Work>
void for_each_of(std::size_t count, unsigned threads, const Work& work) {
  const std::size_t cores = chunks_for(SIZE_MAX, 1, threads);
  const std::size_t chunks = count < cores ? 1 : cores;
  std::atomic<std::size_t> next = 0;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    for (std::size_t k = next++; k < count; k = next++) work(k, chunks > 1 ? 1 : threads);
  });
}

// Of the boxes' middle; finite even where they are not.
Vec3 middle(const Box& box) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  if (box.is_empty()) return Vec3::Zero();
  return 0.5 * box.lo.cwiseMax(-kLargest) + 0.5 * box.hi.cwiseMin(kLargest);
}

// The boxes of the runs of an object.
void fill_run_boxes(const Scene& scene, std::uint32_t object, double half, unsigned threads,
                    Runs& runs) {
  const std::uint32_t first = runs.first[object], n = runs.first[object + 1] - first;
  for_chunks(n, chunks_for(n, 256, threads), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = first + begin; k < first + end; ++k) {
      const Run& run = runs.runs[k];
      runs.boxes[k] = grow(box_of(scene, run.first, run.first + run.count), half);
    }
  });
}

// Drops those objects for which `keeps` is false.
template <class Keeps>
void keep_objects(ScatteredBoxes& scattered, const Keeps& keeps) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < scattered.objects.size(); ++k) {
    if (!keeps(scattered.objects[k])) continue;
    scattered.objects[kept] = scattered.objects[k];
    scattered.first[kept++] = scattered.first[k];
  }
  scattered.objects.resize(kept);
  scattered.first.resize(kept);
}

// The boxes of the triangles of all its objects. Those of the objects are written to `objects`.
void fill_scattered(const Scene& scene, double half, unsigned threads, ScatteredBoxes& scattered,
                    std::span<Box> objects) {
  std::size_t size = 0;
  scattered.first.clear();
  for (const std::uint32_t o : scattered.objects) {
    scattered.first.push_back(size);
    size += scene.objects[o].triangle_count;
  }
  scattered.boxes.resize(size);
  for_each_of(scattered.objects.size(), threads, [&](std::size_t k, unsigned own_threads) {
    const std::uint32_t o = scattered.objects[k];
    objects[o] = grow(fill_boxes(scene, scene.objects[o], half, scattered.origin, own_threads,
                                 &scattered.boxes[scattered.first[k]]),
                      half);
  });
}

}  // namespace

Runs make_runs(const Scene& scene, double clearance, unsigned threads, ScatteredBoxes* scattered) {
  Runs out;
  const auto objects = static_cast<std::uint32_t>(scene.objects.size());
  out.first.resize(objects + 1, 0);
  for (std::size_t o = 0; o < objects; ++o) {
    const Object& object = scene.objects[o];
    for (std::uint32_t t = 0; t < object.triangle_count; t += kRun) {
      out.runs.push_back({object.first_triangle + t, std::min(kRun, object.triangle_count - t)});
    }
    out.first[o + 1] = static_cast<std::uint32_t>(out.runs.size());
  }
  out.objects.assign(objects, Box::empty());
  const double half = half_of(clearance);
  std::vector<double> seems(objects, 0);  // the mean length of its runs, where it seems scattered
  if (scattered) {
    Box sampled = Box::empty();
    for (std::uint32_t o = 0; o < objects; ++o) {
      Box box = Box::empty();
      seems[o] = sampled_length(scene, out, o, box);
      if (seems[o] > 0) sampled.add(box);
    }
    scattered->origin = middle(sampled);
  }
  const std::size_t n = out.runs.size();
  out.boxes.resize(n);
  for_chunks(n, chunks_for(n, 256, threads), [&](std::size_t, std::size_t begin, std::size_t end) {
    std::size_t o = 0;
    for (std::size_t k = begin; k < end; ++k) {
      while (out.first[o + 1] <= k) ++o;
      if (seems[o] > 0) {
        k = std::min<std::size_t>(out.first[o + 1], end) - 1;
        continue;
      }
      const Run& run = out.runs[k];
      out.boxes[k] = grow(box_of(scene, run.first, run.first + run.count), half);
    }
  });
  for (std::uint32_t o = 0; o < objects; ++o) {
    if (seems[o] > 0) continue;
    for (std::uint32_t k = out.first[o]; k < out.first[o + 1]; ++k) {
      out.objects[o].add(out.boxes[k]);
    }
  }
  if (!scattered) return out;
  for (std::uint32_t o = 0; o < objects; ++o) {
    if (seems[o] > 0 || (out.first[o] < out.first[o + 1] && is_scattered(out, o))) {
      scattered->objects.push_back(o);
    }
  }
  fill_scattered(scene, half, threads, *scattered, out.objects);
  // A sample sees less than the whole box.
  keep_objects(*scattered, [&](std::uint32_t o) {
    const std::uint32_t count = out.first[o + 1] - out.first[o];
    if (seems[o] == 0 || are_scattered(seems[o], count, out.objects[o])) return true;
    fill_run_boxes(scene, o, half, threads, out);
    return false;
  });
  out.stretched = stretched_objects(scene, out.objects, half);
  return out;
}

namespace {

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
void sort_by_code(UninitializedVector<Coded>& all, int bits) {
  constexpr int kDigit = 12;
  UninitializedVector<Coded> other(all.size());
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
  MortonGrid(const FloatBox& box, std::uint32_t triangles)
      : bits_(
            std::clamp(static_cast<int>(std::ceil(0.5 * std::log2(triangles / 16.0))) + 1, 4, 10)),
        most_(static_cast<float>((1 << bits_) - 1)),
        lo_(box.lo) {
    float size = 0x1p-100f;
    for (std::size_t k = 0; k < 3; ++k) size = std::max(size, 0.5f * box.hi[k] - 0.5f * box.lo[k]);
    scale_ = most_ / size;
  }
  int bits() const { return 3 * bits_; }
  // Of the box's lower corner.
  std::uint32_t code(const FloatBox& box) const {
    const auto cell = [&](std::size_t axis) {
      // By halves, which cannot be infinite.
      const float at = (0.5f * box.lo[axis] - 0.5f * lo_[axis]) * scale_;
      return spread(static_cast<std::uint32_t>(std::min(std::max(at, 0.0f), most_)));
    };
    return cell(0) | cell(1) << 1 | cell(2) << 2;
  }

 private:
  int bits_;
  float most_;
  std::array<float, 4> lo_;
  float scale_;
};

// Puts the triangles of an object that meet the region in Morton order, then the others; returns
// how many meet it.
std::uint32_t order_object(std::span<const FloatBox> boxes, const FloatBox& region,
                           std::uint32_t first_triangle, unsigned threads,
                           std::span<std::uint32_t> order) {
  const std::size_t n = boxes.size(), chunks = chunks_for(n, 8192, threads);
  const MortonGrid grid(region, static_cast<std::uint32_t>(n));
  std::vector<UninitializedVector<Coded>> inside(chunks);
  std::vector<UninitializedVector<std::uint32_t>> outside(chunks);
  for_chunks(n, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    // Both are written, and one of them grows: which one would often be foretold wrongly.
    UninitializedVector<Coded> in(end - begin);
    UninitializedVector<std::uint32_t> out(end - begin);
    std::size_t ins = 0, outs = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t triangle = first_triangle + static_cast<std::uint32_t>(k);
      in[ins] = {grid.code(boxes[k]), triangle};
      out[outs] = triangle;
      const bool meets = overlap(boxes[k], region);
      ins += meets;
      outs += !meets;
    }
    in.resize(ins);
    out.resize(outs);
    inside[chunk] = std::move(in);
    outside[chunk] = std::move(out);
  });
  for (std::size_t k = 1; k < chunks; ++k) {
    inside[0].insert(inside[0].end(), inside[k].begin(), inside[k].end());
  }
  sort_by_code(inside[0], grid.bits());
  std::uint32_t* next = order.data();
  for (const Coded& coded : inside[0]) *next++ = coded.triangle;
  for (const auto& part : outside) next = std::copy(part.begin(), part.end(), next);
  return static_cast<std::uint32_t>(inside[0].size());
}

// The same for all triangles of a stretched object.
std::uint32_t order_stretched(const Scene& scene, const Object& object,
                              std::span<std::uint32_t> order) {
  std::vector<Box> boxes(object.triangle_count);
  for (std::uint32_t t = 0; t < object.triangle_count; ++t)
    boxes[t] = grown_box(scene, object.first_triangle + t, 0);
  spatial_order(boxes, order);
  for (std::uint32_t& t : order) t += object.first_triangle;
  return object.triangle_count;
}

// Whether floats relative to `from` are nearly as fine as those relative to the middle of a box.
bool is_near(const Vec3& from, const Box& box) {
  return (from - middle(box)).cwiseAbs().maxCoeff() <= 4 * (box.hi - box.lo).maxCoeff();
}

}  // namespace

void gather_scattered(const Scene& scene, double clearance, std::span<const Box> regions,
                      unsigned threads, ScatteredBoxes& scattered, Runs& runs) {
  Box all = Box::empty();
  for (std::size_t o = 0; o < regions.size(); ++o) {
    if (!regions[o].is_empty()) all.add(runs.objects[o]);
  }
  keep_objects(scattered, [&](std::uint32_t o) { return !regions[o].is_empty(); });
  runs.origin = middle(all);
  if (scattered.objects.empty()) return;
  if (is_near(scattered.origin, all)) {
    runs.origin = scattered.origin;
  } else {
    scattered.origin = runs.origin;
    fill_scattered(scene, half_of(clearance), threads, scattered, runs.objects);
  }
  runs.order.resize(scene.triangles.size());
  std::iota(runs.order.begin(), runs.order.end(), 0u);
  runs.gathered.resize(scene.objects.size());
  std::vector<std::uint32_t> inside(scattered.objects.size());
  const auto boxes_of = [&](std::size_t k) {
    return std::span<const FloatBox>(scattered.boxes)
        .subspan(scattered.first[k], scene.objects[scattered.objects[k]].triangle_count);
  };
  for_each_of(inside.size(), threads, [&](std::size_t k, unsigned own_threads) {
    const std::uint32_t o = scattered.objects[k];
    const Object& object = scene.objects[o];
    const auto order = std::span(runs.order).subspan(object.first_triangle, object.triangle_count);
    inside[k] = !runs.stretched.empty() && runs.stretched[o]
                    ? order_stretched(scene, object, order)
                    : order_object(boxes_of(k), relative(regions[o], runs.origin),
                                   object.first_triangle, own_threads, order);
  });
  std::uint32_t blocks = 0;
  for (std::size_t k = 0; k < inside.size(); ++k) {
    const auto count = (inside[k] + kRun - 1) / kRun;
    runs.gathered[scattered.objects[k]] = {.first = blocks, .count = count, .any = true};
    blocks += count;
  }
  runs.blocks.resize(blocks);
  for_each_of(inside.size(), threads, [&](std::size_t k, unsigned own_threads) {
    const std::uint32_t o = scattered.objects[k], first = scene.objects[o].first_triangle;
    const std::span<const FloatBox> boxes = boxes_of(k);
    const auto order = std::span<const std::uint32_t>(runs.order).subspan(first, inside[k]);
    const std::size_t n = runs.gathered[o].count;
    for_chunks(
        n, chunks_for(n, 256, own_threads), [&](std::size_t, std::size_t begin, std::size_t end) {
          for (std::size_t run = begin; run < end; ++run) {
            const std::size_t from = run * kRun;
            const auto own = order.subspan(from, std::min<std::size_t>(kRun, order.size() - from));
            fill_block(own, boxes.data(), first, runs.blocks[runs.gathered[o].first + run]);
          }
        });
  });
}

Runs make_ordered_runs(const Scene& scene, double clearance, unsigned threads) {
  ScatteredBoxes scattered;
  Runs runs = make_runs(scene, clearance, threads, &scattered);
  if (!runs.stretched.empty()) {
    std::vector<std::uint32_t> stretched;
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
      if (runs.stretched[o]) stretched.push_back(o);
    }
    std::vector<std::uint32_t> both;
    std::ranges::set_union(scattered.objects, stretched, std::back_inserter(both));
    scattered.objects = std::move(both);
    fill_scattered(scene, half_of(clearance), threads, scattered, runs.objects);
  }
  const std::vector<Box> regions = runs.objects;
  gather_scattered(scene, clearance, regions, threads, scattered, runs);
  update_boxes(scene, clearance, std::vector<std::uint8_t>(runs.runs.size(), 1), threads, runs);
  return runs;
}

namespace {

void update_some(const Scene& scene, double half, std::span<const std::uint8_t> moved,
                 std::uint32_t object, unsigned threads, Runs& runs) {
  const std::uint32_t first = runs.first[object], n = runs.first[object + 1] - first;
  const bool gathered = runs.is_gathered(object);
  for_chunks(n, chunks_for(n, 256, threads), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = first + begin; k < first + end; ++k) {
      if (!moved.empty() && !moved[k]) continue;
      const Run& run = runs.runs[k];
      if (!gathered) {
        runs.boxes[k] = grow(box_of(scene, run.first, run.first + run.count), half);
        continue;
      }
      RunBlock& block = runs.blocks[runs.gathered[object].first + k - first];
      const std::span<const std::uint32_t> order(runs.order);
      for (std::uint32_t i = 0; i < run.count; ++i) {
        prefetch(scene, order[std::min<std::size_t>(run.first + kAhead + i, order.size() - 1)]);
      }
      runs.boxes[k] = grow(
          fill_block(scene, order.subspan(run.first, run.count), half, runs.origin, block), half);
    }
  });
}

}  // namespace

void update_boxes(const Scene& scene, double clearance, std::span<const std::uint8_t> moved,
                  unsigned threads, Runs& runs) {
  const double half = half_of(clearance);
  const auto objects = static_cast<std::uint32_t>(runs.objects.size());
  const auto update = [&](std::span<const std::uint8_t> which) {
    for_each_of(objects, threads, [&](std::size_t o, unsigned own_threads) {
      update_some(scene, half, which, static_cast<std::uint32_t>(o), own_threads, runs);
    });
  };
  update(moved);
  Box all = Box::empty();
  for (std::uint32_t o = 0; o < objects; ++o) {
    runs.objects[o] = Box::empty();
    for (std::uint32_t k = runs.first[o]; k < runs.first[o + 1]; ++k) {
      runs.objects[o].add(runs.boxes[k]);
    }
    all.add(runs.objects[o]);
  }
  runs.stretched = stretched_objects(scene, runs.objects, half);
  if (is_near(runs.origin, all)) return;
  runs.origin = middle(all);
  if (!runs.blocks.empty()) update({});
}

}  // namespace farcull
