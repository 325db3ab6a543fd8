// Finds scattered objects by the length of the boxes of their blocks. Sorts the triangles of these
// objects along a Morton curve, and the triangles of stretched objects by spatial_order().
#include "core/boxes/triangle_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"

namespace farcull {
namespace {

double length(const Box& box) { return (box.hi - box.lo).sum(); }

// True if the boxes of an object's blocks are much longer on average than the boxes of compact
// parts of a surface would be.
bool is_scattered(const TriangleBlocks& blocks, std::uint32_t object) {
  const std::uint32_t first = blocks.first[object], count = blocks.first[object + 1] - first;
  double sum = 0;
  for (std::uint32_t k = 0; k < count; ++k) sum += length(blocks.boxes[first + k]);
  return count > 0 && sum / count * std::sqrt(count) > kScattered * length(blocks.objects[object]);
}

// Objects with fewer triangles than this are not sampled.
constexpr std::uint32_t kLeastSampled = 4096;
// Returns the position of item k of a sample, in [0, 1). Multiples of the golden ratio, modulo 1,
// are evenly distributed, but not periodic. A periodic sample could match a period of the surface.
double sampled_place(std::size_t k) {
  const double at = 0.6180339887498949 * static_cast<double>(k);
  return at - std::floor(at);
}
// Returns how many times longer the box of an object (grown by `half`) is than the box around most
// of its triangles. Returns 0 for an object that is not sampled.
float stretch_of(const Scene& scene, const Object& object, const Box& box, double half) {
  constexpr std::size_t kSample = 64, kEnd = kSample / 8;
  if (object.triangle_count < kLeastSampled) return 0;
  double side = 0, whole = 0;  // sums of half side lengths, because a whole side may overflow
  std::array<double, kSample> at;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < kSample; ++k) {
      const auto t = static_cast<std::uint32_t>(sampled_place(k) * (object.triangle_count - 1));
      at[k] = scene.vertices[scene.triangles[object.first_triangle + t][0]][axis];
    }
    std::ranges::sort(at);
    side += 0.5 * at[kSample - 1 - kEnd] - 0.5 * at[kEnd] + half;
    whole += 0.5 * box.hi[axis] - 0.5 * box.lo[axis];
  }
  constexpr double kLeastSide = std::numeric_limits<double>::denorm_min();
  return static_cast<float>(std::min(whole / std::max(side, kLeastSide), 0x1p100));
}

void mark_stretched(const Scene& scene, double half, TriangleBlocks& blocks) {
  blocks.stretched.clear();
  for (std::size_t o = 0; o < blocks.objects.size(); ++o) {
    const float stretch = stretch_of(scene, scene.objects[o], blocks.objects[o], half);
    if (!(stretch > kStretched)) continue;
    blocks.stretched.resize(blocks.objects.size(), 0);
    blocks.stretched[o] = stretch;
  }
}

// Calls work(k, threads) for k in 0 .. count - 1. If there are fewer calls than threads, makes one
// call after the other, each with all threads. Else makes parallel calls, each with one thread.
template <class Work>
void for_each_of(std::size_t count, unsigned threads, const Work& work) {
  const bool few = count < chunks_for(SIZE_MAX, 1, threads);
  for_each_shared(count, few ? 1 : threads, [&](std::size_t k) { work(k, few ? threads : 1); });
}

// Returns the middle of a box. The middle is finite even if the box is not.
Vec3 middle(const Box& box) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  if (box.is_empty()) return Vec3::Zero();
  return 0.5 * box.lo.cwiseMax(-kLargest) + 0.5 * box.hi.cwiseMin(kLargest);
}

Box block_box(const Scene& scene, const TriangleBlock& range, double half) {
  return grow(box_of(scene, range.first, range.first + range.count), half);
}

// Sets the box of an object to the union of the boxes of its blocks.
void add_boxes(TriangleBlocks& blocks, std::uint32_t object) {
  blocks.objects[object] = Box::empty();
  for (std::uint32_t k = blocks.first[object]; k < blocks.first[object + 1]; ++k)
    blocks.objects[object].add(blocks.boxes[k]);
}

// Four numbers. The compiler turns loops over them into vector instructions.
using Four = std::array<std::uint32_t, 4>;

// Moves bit i of each number to bit 3 i, for i in 0 .. 9. All other bits of the result are 0.
Four spread(Four x) {
  for (std::uint32_t& own : x) own = (own | own << 16) & 0x030000ff;
  for (std::uint32_t& own : x) own = (own | own << 8) & 0x0300f00f;
  for (std::uint32_t& own : x) own = (own | own << 4) & 0x030c30c3;
  for (std::uint32_t& own : x) own = (own | own << 2) & 0x09249249;
  return x;
}

struct Coded {
  std::uint32_t code, triangle;
};

// Sorts by the lower `bits` bits of the codes (radix sort). Equal codes keep their order.
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

// A grid over a box. The Morton code of a cell is the position of the cell on a Morton curve.
class MortonGrid {
 public:
  // Makes cells about half as wide as a block of a smooth surface with this number of triangles.
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
  // Returns the Morton code of the cell with the lower corner of `box`.
  std::uint32_t code(const FloatBox& box) const {
    std::array<float, 4> at;
    // Halves the numbers first, because their difference may overflow.
    for (std::size_t k = 0; k < 4; ++k) at[k] = (0.5f * box.lo[k] - 0.5f * lo_[k]) * scale_;
    for (float& own : at) own = std::min(std::max(own, 0.0f), most_);
    Four cell;
    for (std::size_t k = 0; k < 4; ++k)
      cell[k] = static_cast<std::uint32_t>(static_cast<std::int32_t>(at[k]));
    cell = spread(cell);
    return cell[0] | cell[1] << 1 | cell[2] << 2;
  }

 private:
  int bits_;
  float most_;
  std::array<float, 4> lo_;
  float scale_;
};

float longest_side(const FloatBox& box) {
  return std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
}

// Returns the usual length of a triangle's box: the median, over a sample, of the longest side.
// Returns infinity for an object that is too small for a sample.
float usual_side(const Scene& scene, const Object& object, double half, const Vec3& origin) {
  constexpr std::size_t kSample = 64;
  if (object.triangle_count < kLeastSampled) return kInfinite;
  std::array<float, kSample> sides;
  for (std::size_t k = 0; k < kSample; ++k) {
    const auto t = object.first_triangle +
                   static_cast<std::uint32_t>(sampled_place(k) * (object.triangle_count - 1));
    FloatBox box;
    relative_boxes(scene, t, t + 1, half, origin, &box);
    sides[k] = longest_side(box);
  }
  std::ranges::nth_element(sides, sides.begin() + kSample / 2);
  return sides[kSample / 2];
}

// Orders the triangles of an object. First come the triangles whose boxes overlap the region, by
// size class and then by Morton code. Returns their number. Size classes prevent a large triangle
// from enlarging a block of small triangles. The size class is the number of k in 1 .. 3 for which
// the triangle's box is more than 8^k times as long as usual.
std::uint32_t order_object(const Scene& scene, const Object& object, double half,
                           const Vec3& origin, const FloatBox& region, unsigned threads,
                           std::span<std::uint32_t> order) {
  constexpr std::size_t kAtOnce = 256;
  const std::size_t n = object.triangle_count, chunks = chunks_for(n, 8192, threads);
  const MortonGrid grid(region, static_cast<std::uint32_t>(n));
  constexpr float kLarge = 8;
  const float large = kLarge * usual_side(scene, object, half, origin), huge = kLarge * large;
  std::vector<UninitializedVector<Coded>> inside(chunks);
  std::vector<UninitializedVector<std::uint32_t>> outside(chunks);
  for_chunks(n, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    // Writes each triangle to both lists and advances one list. A branch would be mispredicted.
    UninitializedVector<Coded> in(end - begin);
    UninitializedVector<std::uint32_t> out(end - begin);
    std::size_t ins = 0, outs = 0;
    std::array<FloatBox, kAtOnce> boxes;
    const auto first = object.first_triangle + static_cast<std::uint32_t>(begin);
    for (std::uint32_t from = first; from < first + (end - begin); from += kAtOnce) {
      const auto to = static_cast<std::uint32_t>(std::min(from + kAtOnce, first + (end - begin)));
      relative_boxes(scene, from, to, half, origin, boxes.data());
      for (std::uint32_t triangle = from; triangle < to; ++triangle) {
        const FloatBox& box = boxes[triangle - from];
        const float side = longest_side(box);
        const std::uint32_t size = (side > large) + (side > huge) + (side > kLarge * huge);
        in[ins] = {grid.code(box) | size << grid.bits(), triangle};
        out[outs] = triangle;
        const bool meets = overlap(box, region);
        ins += meets;
        outs += !meets;
      }
    }
    in.resize(ins);
    out.resize(outs);
    inside[chunk] = std::move(in);
    outside[chunk] = std::move(out);
  });
  for (std::size_t k = 1; k < chunks; ++k)
    inside[0].insert(inside[0].end(), inside[k].begin(), inside[k].end());
  const bool sized = std::ranges::any_of(
      inside[0], [&](const Coded& coded) { return (coded.code >> grid.bits()) != 0; });
  sort_by_code(inside[0], grid.bits() + (sized ? 2 : 0));
  std::uint32_t* next = order.data();
  for (const Coded& coded : inside[0]) *next++ = coded.triangle;
  for (const auto& part : outside) next = std::copy(part.begin(), part.end(), next);
  return static_cast<std::uint32_t>(inside[0].size());
}

// Sorts all triangles of a stretched object by spatial_order(). Returns the number of triangles.
std::uint32_t order_stretched(const Scene& scene, const Object& object,
                              std::span<std::uint32_t> order) {
  std::vector<Box> boxes(object.triangle_count);
  for (std::uint32_t t = 0; t < object.triangle_count; ++t)
    boxes[t] = grown_box(scene, object.first_triangle + t, 0);
  spatial_order(boxes, order);
  for (std::uint32_t& t : order) t += object.first_triangle;
  return object.triangle_count;
}

}  // namespace

void divide(const Scene& scene, TriangleBlocks& out) {
  out.first.assign(1, 0);
  for (const Object& object : scene.objects) {
    for (std::uint32_t t = 0; t < object.triangle_count; t += kWide)
      out.ranges.push_back({object.first_triangle + t, std::min(kWide, object.triangle_count - t)});
    out.first.push_back(static_cast<std::uint32_t>(out.ranges.size()));
  }
}

TriangleBlocks make_blocks(const Scene& scene, double clearance, unsigned threads) {
  TriangleBlocks out;
  const auto objects = static_cast<std::uint32_t>(scene.objects.size());
  divide(scene, out);
  const double half = half_of(clearance);
  const std::size_t n = out.ranges.size();
  out.boxes.resize(n);
  for_chunks(n, chunks_for(n, 256, threads), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) out.boxes[k] = block_box(scene, out.ranges[k], half);
  });
  out.objects.resize(objects);
  for (std::uint32_t o = 0; o < objects; ++o) add_boxes(out, o);
  mark_stretched(scene, half, out);
  return out;
}

void gather_scattered(const Scene& scene, double clearance, std::span<const Box> regions,
                      unsigned threads, TriangleBlocks& blocks) {
  const double half = half_of(clearance);
  Box all = Box::empty();
  std::vector<std::uint32_t> scattered;  // all scattered or stretched objects
  for (std::uint32_t o = 0; o < regions.size(); ++o) {
    if (regions[o].is_empty()) continue;
    all.add(blocks.objects[o]);
    if (blocks.stretch(o) > kStretched || is_scattered(blocks, o)) scattered.push_back(o);
  }
  blocks.origin = middle(all);
  if (scattered.empty()) return;
  blocks.order.resize(scene.triangles.size());
  std::iota(blocks.order.begin(), blocks.order.end(), 0u);
  blocks.gathered.resize(scene.objects.size());
  std::vector<std::uint32_t> inside(scattered.size());
  for_each_of(inside.size(), threads, [&](std::size_t k, unsigned own_threads) {
    const std::uint32_t o = scattered[k];
    const Object& object = scene.objects[o];
    const auto order =
        std::span(blocks.order).subspan(object.first_triangle, object.triangle_count);
    inside[k] = blocks.stretch(o) > kStretched
                    ? order_stretched(scene, object, order)
                    : order_object(scene, object, half, blocks.origin,
                                   relative(regions[o], blocks.origin), own_threads, order);
  });
  std::uint32_t lanes = 0;
  for (std::size_t k = 0; k < inside.size(); ++k) {
    const auto count = (inside[k] + kWide - 1) / kWide;
    blocks.gathered[scattered[k]] = {.first = lanes, .count = count, .any = true};
    lanes += count;
  }
  blocks.lanes.resize(lanes);
  for_each_of(inside.size(), threads, [&](std::size_t k, unsigned own_threads) {
    const std::uint32_t o = scattered[k], first = scene.objects[o].first_triangle;
    const auto order = std::span<const std::uint32_t>(blocks.order).subspan(first, inside[k]);
    const std::size_t n = blocks.gathered[o].count;
    for_chunks(
        n, chunks_for(n, 256, own_threads), [&](std::size_t, std::size_t begin, std::size_t end) {
          for (std::size_t block = begin; block < end; ++block) {
            const std::size_t from = block * kWide;
            // Prefetches vertex indices three blocks ahead, and vertices one block ahead.
            for (std::size_t k = from; k < from + kWide; ++k) {
              const std::size_t last = order.size() - 1;
              __builtin_prefetch(&scene.triangles[order[std::min(k + 3 * kWide, last)]]);
              prefetch(scene, order[std::min(k + kWide, last)]);
            }
            fill_lanes(scene,
                       order.subspan(from, std::min<std::size_t>(kWide, order.size() - from)), half,
                       blocks.origin, blocks.lanes[blocks.gathered[o].first + block]);
          }
        });
  });
}

TriangleBlocks make_ordered_blocks(const Scene& scene, double clearance, unsigned threads) {
  TriangleBlocks blocks = make_blocks(scene, clearance, threads);
  const std::vector<Box> regions = blocks.objects;
  gather_scattered(scene, clearance, regions, threads, blocks);
  update_boxes(scene, clearance, std::vector<std::uint8_t>(blocks.ranges.size(), 1), threads,
               blocks);
  return blocks;
}

void update_boxes(const Scene& scene, double clearance, std::span<const std::uint8_t> moved,
                  unsigned threads, TriangleBlocks& blocks) {
  const double half = half_of(clearance);
  const auto objects = static_cast<std::uint32_t>(blocks.objects.size());
  const std::span<const std::uint32_t> order(blocks.order);
  const auto update_block = [&](std::uint32_t object, std::size_t k) {
    const TriangleBlock& range = blocks.ranges[k];
    if (!blocks.is_gathered(object)) {
      blocks.boxes[k] = block_box(scene, range, half);
      return;
    }
    for (std::uint32_t i = 0; i < range.count; ++i)
      prefetch(scene,
               order[std::min<std::size_t>(range.first + kTrianglesAhead + i, order.size() - 1)]);
    BlockLanes& lanes = blocks.lanes[blocks.gathered[object].first + k - blocks.first[object]];
    blocks.boxes[k] =
        grow(fill_lanes(scene, order.subspan(range.first, range.count), half, blocks.origin, lanes),
             half);
  };
  const auto update = [&](std::span<const std::uint8_t> which) {
    for_each_of(objects, threads, [&](std::size_t o, unsigned own_threads) {
      const std::uint32_t first = blocks.first[o], n = blocks.first[o + 1] - first;
      for_chunks(n, chunks_for(n, 256, own_threads),
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (std::size_t k = first + begin; k < first + end; ++k)
                     if (which.empty() || which[k]) update_block(static_cast<std::uint32_t>(o), k);
                 });
    });
  };
  update(moved);
  Box all = Box::empty();
  for (std::uint32_t o = 0; o < objects; ++o) {
    add_boxes(blocks, o);
    all.add(blocks.objects[o]);
  }
  mark_stretched(scene, half, blocks);
  // Keeps the old origin if it is close enough to the new middle, so that floats stay fine enough.
  if ((blocks.origin - middle(all)).cwiseAbs().maxCoeff() <= 4 * (all.hi - all.lo).maxCoeff())
    return;
  blocks.origin = middle(all);
  if (!blocks.lanes.empty()) update({});
}

}  // namespace farcull
