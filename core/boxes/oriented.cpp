// Computes the axes of a block from the second moments of its corners. For each block, searches a
// tree of oriented boxes for overlapping blocks. Compares floats only, as compare.cpp does.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/boxes/oriented.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <Eigen/Dense>
#include <algorithm>
#include <iterator>
#include <numeric>

#include "core/base/parallel.h"
#include "core/boxes/lanes-inl.h"
#include "core/boxes/oriented.h"
#include "core/scene/pair_sort.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Numbers = boxes::Tag<float>;
using Vector = boxes::Vector<float>;
using OneBox = boxes::OneBox<float>;
constexpr std::size_t kLanes = boxes::kLanes<float>;
constexpr Numbers kNumbers;

using Columns = std::array<std::array<float, kWide>, 3>;

HWY_INLINE Vector at(const Columns& columns, std::size_t k, std::size_t from) {
  return hn::Load(kNumbers, &columns[k][from]);
}
HWY_INLINE Vector all(float value) { return hn::Set(kNumbers, value); }
HWY_INLINE Vector dot(const std::array<float, 3>& d, Vector x, Vector y, Vector z) {
  return hn::Add(hn::Add(hn::Mul(all(d[0]), x), hn::Mul(all(d[1]), y)), hn::Mul(all(d[2]), z));
}

// Sets the bit of each box of the block that may overlap `one`. Tests the 15 separating axes of
// Gottschalk, Lin and Manocha (SIGGRAPH 1996), in the coordinates of `one`.
HWY_INLINE std::uint32_t oriented_bits(const WideOriented& block, const OrientedBox& one,
                                       float margin) {
  std::uint32_t out = 0;
  for (std::size_t from = 0; from < kWide; from += kLanes) {
    Vector turned[3][3], size[3][3], apart[3];  // turned[i][k]: one.frame[i] dot block.frame[k]
    const auto dx = hn::Sub(at(block.middle, 0, from), all(one.middle[0]));
    const auto dy = hn::Sub(at(block.middle, 1, from), all(one.middle[1]));
    const auto dz = hn::Sub(at(block.middle, 2, from), all(one.middle[2]));
    const Vector half[3] = {at(block.half, 0, from), at(block.half, 1, from),
                            at(block.half, 2, from)};
    const auto outside = [&](Vector distance, Vector reach) {
      return hn::Gt(hn::Abs(distance), hn::Add(reach, all(margin)));
    };
    auto separated = hn::Gt(dx, dx);  // false in all lanes
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        turned[i][k] = dot(one.frame[i], at(block.frame[k], 0, from), at(block.frame[k], 1, from),
                           at(block.frame[k], 2, from));
        size[i][k] = hn::Abs(turned[i][k]);
      }
      apart[i] = dot(one.frame[i], dx, dy, dz);
      const auto reach =
          hn::Add(hn::Add(hn::Mul(half[0], size[i][0]), hn::Mul(half[1], size[i][1])),
                  hn::Mul(half[2], size[i][2]));
      separated = hn::Or(separated, outside(apart[i], hn::Add(reach, all(one.half[i]))));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto distance = hn::Add(hn::Add(hn::Mul(at(block.frame[k], 0, from), dx),
                                            hn::Mul(at(block.frame[k], 1, from), dy)),
                                    hn::Mul(at(block.frame[k], 2, from), dz));
      const std::array<float, 3> own = one.half;
      const auto reach = dot(own, size[0][k], size[1][k], size[2][k]);
      separated = hn::Or(separated, outside(distance, hn::Add(reach, half[k])));
    }
    if (!hn::AllTrue(kNumbers, separated)) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t p = (i + 1) % 3, q = (i + 2) % 3;
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t r = (k + 1) % 3, s = (k + 2) % 3;
          const auto distance =
              hn::Sub(hn::Mul(apart[q], turned[p][k]), hn::Mul(apart[p], turned[q][k]));
          const auto own =
              hn::Add(hn::Mul(all(one.half[p]), size[q][k]), hn::Mul(all(one.half[q]), size[p][k]));
          const auto other = hn::Add(hn::Mul(half[r], size[i][s]), hn::Mul(half[s], size[i][r]));
          separated = hn::Or(separated, outside(distance, hn::Add(own, other)));
        }
      }
    }
    out |= boxes::bits_of(kNumbers, hn::Not(separated)) << from;
  }
  return out;
}

// Computes the boxes of a block's triangles along the axes of another block.
HWY_INLINE void turn(const OrientedLanes& block, const Frame& frame, WideBoxes<float>& out) {
  for (std::size_t from = 0; from < kWide; from += kLanes) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto along = [&](std::size_t c) {
        return dot(frame[k], at(block.corner[c], 0, from), at(block.corner[c], 1, from),
                   at(block.corner[c], 2, from));
      };
      const auto a = along(0), b = along(1), c = along(2);
      hn::Store(hn::Min(hn::Min(a, b), c), kNumbers, &out.column[k][from]);
      hn::Store(hn::Max(hn::Max(a, b), c), kNumbers, &out.column[k + 3][from]);
    }
  }
}

}  // namespace

void pair_oriented_here(const OrientedBlocks& blocks, std::uint32_t a, std::uint32_t b,
                        std::uint32_t from, std::uint32_t to, std::size_t most,
                        std::vector<BlockPair>& out) {
  const std::uint32_t first_a = blocks.blocks.first[a], first_b = blocks.blocks.first[b];
  for (std::uint32_t block = from; block < to && out.size() <= most; ++block) {
    const std::uint32_t own = block - first_a;
    const OrientedBox& one = blocks.boxes[blocks.blocks.gathered[a].first + own];
    boxes::for_leaves(
        blocks.trees[b], a == b ? own : 0,
        [&](std::size_t node) { return oriented_bits(blocks.nodes[node], one, blocks.margin); },
        [&](std::uint32_t other) {
          out.push_back({block, first_b + other});
        });
  }
}

void compare_oriented_here(const OrientedBlocks& blocks, std::uint32_t a, std::uint32_t b,
                           BlockFindings& out) {
  const BlockLanes &one = blocks.blocks.lanes[a], &other = blocks.blocks.lanes[b];
  const OrientedLanes &turned_one = blocks.lanes[a], &turned_other = blocks.lanes[b];
  WideBoxes<float> one_along_other, other_along_one;
  turn(turned_one, turned_other.frame, one_along_other);
  std::uint32_t rows = boxes::overlapping_bits(one.boxes, OneBox(other.bound)) &
                       boxes::overlapping_bits(one_along_other, OneBox(turned_other.bound));
  if (rows == 0) return;
  turn(turned_other, turned_one.frame, other_along_one);
  const std::uint32_t columns = boxes::overlapping_bits(other.boxes, OneBox(one.bound)) &
                                boxes::overlapping_bits(other_along_one, OneBox(turned_one.bound));
  if (columns == 0) return;
  while (rows != 0) {
    const std::uint32_t row = boxes::next_bit(rows);
    std::uint32_t met =
        columns & boxes::overlapping_bits(turned_other.boxes, OneBox(one_along_other, row));
    if (a == b) met &= 0xfffeu << row;
    if (met == 0) continue;
    met &= boxes::overlapping_bits(other_along_one, OneBox(turned_one.boxes, row));
    if (met == 0) continue;
    const OneBox box(one.boxes, row);
    met &= boxes::overlapping_bits(other.boxes, box);
    std::uint32_t inside = 0;
    for (std::size_t from = 0; from < kWide; from += kLanes)
      inside |= boxes::bits_of(kNumbers, boxes::overlapping_inside(other.boxes, from, box)) << from;
    const auto put = [&](std::uint32_t bits, std::vector<TrianglePair>& to) {
      while (bits != 0) {
        const std::uint32_t s = one.triangles[row], t = other.triangles[boxes::next_bit(bits)];
        to.push_back({std::min(s, t), std::max(s, t)});
      }
    };
    put(met & inside, out.pairs);
    put(met & ~inside, out.perhaps);
  }
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

HWY_EXPORT(pair_oriented_here);
HWY_EXPORT(compare_oriented_here);

void pair_oriented(const OrientedBlocks& blocks, std::uint32_t a, std::uint32_t b,
                   std::uint32_t from, std::uint32_t to, std::size_t most,
                   std::vector<BlockPair>& out) {
  HWY_DYNAMIC_DISPATCH(pair_oriented_here)(blocks, a, b, from, to, most, out);
}

namespace {

// Margins, relative to the distance of the farthest corner from the origin. kBoxMargin bounds the
// rounding error of comparing two oriented boxes. kTriangleMargin bounds the rounding error of
// comparing two triangles (docs/reliability.md, "Oriented boxes").
constexpr double kBoxMargin = 0x1p-16, kTriangleMargin = 0x1p-20;

// Sums over points: the number of points, the coordinates, and the products of two coordinates.
struct Moments {
  double count = 0;
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  void add(const Vec3& point) {
    count += 1;
    sum += point;
    products += point * point.transpose();
  }
  void add(const Moments& other) {
    count += other.count;
    sum += other.sum;
    products += other.products;
  }
};

// Returns the principal directions of the points. Any frame of perpendicular unit vectors, up to
// rounding to floats, would be correct.
Frame frame_of(const Moments& moments) {
  const Vec3 mean = moments.sum / moments.count;
  const Eigen::Matrix3d covariance = moments.products / moments.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  Vec3 x = solver.eigenvectors().col(2).normalized(), y = solver.eigenvectors().col(0);
  y = (y - y.dot(x) * x).normalized();
  Eigen::Matrix3d rows;
  rows << x.transpose(), y.transpose(), x.cross(y).transpose();
  const double error =
      (rows * rows.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error < 0x1p-40)) rows.setIdentity();
  Frame frame;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k)
      frame[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] =
          static_cast<float>(rows(i, k));
  }
  return frame;
}

float along(const std::array<float, 3>& d, float x, float y, float z) {
  return d[0] * x + d[1] * y + d[2] * z;
}

// Returns the box along the axes `frame` around all triangle corners of the blocks.
OrientedBox box_along(const Frame& frame, std::span<const OrientedLanes> blocks) {
  OrientedBox out{.frame = frame, .middle = {}, .half = {}};
  std::array<float, 3> middle;
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<float, kWide> lo, hi;
    lo.fill(kInfinite);
    hi.fill(-kInfinite);
    for (const OrientedLanes& block : blocks) {
      for (const auto& corner : block.corner) {
        for (std::size_t lane = 0; lane < kWide; ++lane) {
          const float at = along(frame[k], corner[0][lane], corner[1][lane], corner[2][lane]);
          lo[lane] = std::min(lo[lane], at);
          hi[lane] = std::max(hi[lane], at);
        }
      }
    }
    const float least = *std::ranges::min_element(lo), most = *std::ranges::max_element(hi);
    middle[k] = 0.5f * (least + most);
    out.half[k] = 0.5f * (most - least);
  }
  for (std::size_t i = 0; i < 3; ++i)
    out.middle[i] = frame[0][i] * middle[0] + frame[1][i] * middle[1] + frame[2][i] * middle[2];
  return out;
}

// Sets the corners, frame and boxes of a block. Returns the moments of its corners.
Moments fill_oriented(const Scene& scene, std::span<const std::uint32_t> triangles,
                      const Vec3& origin, float margin, OrientedLanes& out) {
  Moments moments;
  for (std::size_t lane = 0; lane < kWide; ++lane) {
    // An unused lane repeats the last triangle. The box of an unused lane in BlockLanes is empty.
    const std::uint32_t t = triangles[std::min(lane, triangles.size() - 1)];
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 corner = scene.vertices[scene.triangles[t][c]] - origin;
      moments.add(corner);
      for (std::size_t k = 0; k < 3; ++k)
        out.corner[c][k][lane] = static_cast<float>(corner[static_cast<Eigen::Index>(k)]);
    }
  }
  out.frame = frame_of(moments);
  out.bound = kNowhere;
  for (std::size_t lane = 0; lane < kWide; ++lane) {
    FloatBox box = kNowhere;
    for (std::size_t k = 0; k < 3; ++k) {
      for (const auto& corner : out.corner) {
        const float at = along(out.frame[k], corner[0][lane], corner[1][lane], corner[2][lane]);
        box.lo[k] = std::min(box.lo[k], at);
        box.hi[k] = std::max(box.hi[k], at);
      }
      box.lo[k] -= margin;
      box.hi[k] += margin;
    }
    out.boxes.set(lane, box);
    out.bound.add(box);
  }
  return moments;
}

// Orders the triangles of an object. First come the triangles whose boxes overlap the region, in
// the order of spatial_order(). Returns their number, and adds their boxes to `all`.
std::uint32_t order_in(const Scene& scene, const Object& object, double clearance,
                       const Box& region, std::span<std::uint32_t> order, Box& all) {
  std::vector<Box> boxes;
  std::vector<std::uint32_t> inside, outside;
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const std::uint32_t t = object.first_triangle + k;
    prefetch(scene,
             object.first_triangle + std::min(k + kTrianglesAhead, object.triangle_count - 1));
    const Box box = grown_box(scene, t, clearance);
    if (!overlap(box, region)) {
      outside.push_back(t);
      continue;
    }
    inside.push_back(t);
    boxes.push_back(box);
    all.add(box);
  }
  std::vector<std::uint32_t> sorted(inside.size());
  spatial_order(boxes, sorted);
  for (std::size_t k = 0; k < sorted.size(); ++k) order[k] = inside[sorted[k]];
  std::ranges::copy(outside, order.begin() + static_cast<std::ptrdiff_t>(inside.size()));
  return static_cast<std::uint32_t>(inside.size());
}

// Builds the tree over the blocks of an object. Stores its nodes in `nodes`, from index `at` on.
BoxTree<float> plant(std::span<const OrientedBox> leaves, std::span<const OrientedLanes> lanes,
                     std::vector<Moments> moments, std::span<WideOriented> nodes, std::size_t at) {
  BoxTree<float> out;
  out.leaves = leaves.size();
  std::vector<OrientedBox> boxes(leaves.begin(), leaves.end());
  std::size_t wide = 1;  // number of leaves below each box
  while (!boxes.empty() && (boxes.size() > 1 || out.levels == 0)) {
    const std::size_t n = (boxes.size() + kWide - 1) / kWide;
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      WideOriented& node = nodes[at + k / kWide];
      for (std::size_t i = 0; i < 3; ++i) {
        node.middle[i][k % kWide] = boxes[k].middle[i];
        node.half[i][k % kWide] = boxes[k].half[i];
        for (std::size_t j = 0; j < 3; ++j) node.frame[i][j][k % kWide] = boxes[k].frame[i][j];
      }
    }
    out.first[static_cast<std::size_t>(out.levels++)] = at;
    at += n;
    wide *= kWide;
    for (std::size_t node = 0; n > 1 && node < n; ++node) {
      Moments all;
      const std::size_t end = std::min(boxes.size(), kWide * (node + 1));
      for (std::size_t k = kWide * node; k < end; ++k) all.add(moments[k]);
      moments[node] = all;
      boxes[node] = box_along(
          frame_of(all), lanes.subspan(wide * node, std::min(wide, lanes.size() - wide * node)));
    }
    boxes.resize(n);
  }
  return out;
}

}  // namespace

std::shared_ptr<const OrientedBlocks> make_oriented(const Scene& scene, double clearance,
                                                    std::span<const Box> regions,
                                                    unsigned threads) {
  const auto out = std::make_shared<OrientedBlocks>();
  TriangleBlocks& blocks = out->blocks;
  const std::size_t objects = scene.objects.size();
  divide(scene, blocks);
  blocks.gathered.resize(objects);
  blocks.order.resize(scene.triangles.size());
  std::iota(blocks.order.begin(), blocks.order.end(), 0u);
  blocks.boxes.resize(blocks.ranges.size());
  std::vector<std::uint32_t> inside(objects, 0);
  blocks.objects.assign(objects, Box::empty());
  for_each_shared(objects, threads, [&](std::size_t o) {
    const Object& object = scene.objects[o];
    if (regions[o].is_empty()) return;
    inside[o] =
        order_in(scene, object, clearance, regions[o],
                 std::span(blocks.order).subspan(object.first_triangle, object.triangle_count),
                 blocks.objects[o]);
  });
  Box all = Box::empty();
  for (const Box& box : blocks.objects) {
    if (!box.is_empty()) all.add(box);
  }
  blocks.origin = 0.5 * all.lo + 0.5 * all.hi;
  const Vec3 size =
      (all.lo - blocks.origin).cwiseAbs().cwiseMax((all.hi - blocks.origin).cwiseAbs());
  // No corner is farther than `reach` from the origin. If `reach` is below 2^-60, underflow could
  // exceed the margins. If `reach` is above 2^60, products could overflow.
  const double reach = 1.001 * size.norm(), gap = 1.001 * clearance;
  if (!(reach >= 0x1p-60 && reach + gap <= 0x1p60)) return nullptr;
  out->margin = static_cast<float>(kBoxMargin * reach + gap);
  const auto margin = static_cast<float>(kTriangleMargin * reach + gap);
  std::uint32_t lanes = 0;
  std::size_t nodes = 0;
  std::vector<std::size_t> first_node(objects);
  for (std::size_t o = 0; o < objects; ++o) {
    const std::uint32_t count = (inside[o] + kWide - 1) / kWide;
    blocks.gathered[o] = {.first = lanes, .count = count, .any = true};
    lanes += count;
    first_node[o] = nodes;
    nodes += blocks_of_tree(count);
  }
  blocks.lanes.resize(lanes);
  out->lanes.resize(lanes);
  out->boxes.resize(lanes);
  out->nodes.resize(nodes);
  out->trees.resize(objects);
  for_each_shared(objects, threads, [&](std::size_t o) {
    const TriangleBlocks::Gathered& gathered = blocks.gathered[o];
    const auto order = std::span<const std::uint32_t>(blocks.order)
                           .subspan(scene.objects[o].first_triangle, inside[o]);
    std::vector<Moments> moments(gathered.count);
    for (std::uint32_t k = 0; k < gathered.count; ++k) {
      const std::uint32_t at = gathered.first + k;
      for (std::uint32_t ahead = kWide * (k + 1); ahead < std::min(kWide * (k + 2), inside[o]);
           ++ahead)
        prefetch(scene, order[ahead]);
      const auto own =
          order.subspan(k * kWide, std::min<std::size_t>(kWide, inside[o] - k * kWide));
      fill_lanes(scene, own, half_of(clearance), blocks.origin, blocks.lanes[at]);
      moments[k] = fill_oriented(scene, own, blocks.origin, margin, out->lanes[at]);
      out->boxes[at] =
          box_along(out->lanes[at].frame, std::span<const OrientedLanes>(&out->lanes[at], 1));
    }
    out->trees[o] =
        plant(std::span<const OrientedBox>(out->boxes).subspan(gathered.first, gathered.count),
              std::span<const OrientedLanes>(out->lanes).subspan(gathered.first, gathered.count),
              std::move(moments), out->nodes, first_node[o]);
  });
  return out;
}

std::uint64_t give_pairs_of_oriented(const Scene& scene, const OrientedBlocks& blocks,
                                     const BlockPairs& pairs, double clearance, bool neighbours,
                                     unsigned threads, const TakePairs& take) {
  const std::vector<std::uint32_t> place = blocks.blocks.lane_places();
  // Erases pairs with a common vertex, from index `from` on. Pairs before `from` may be pairs of
  // different objects, which are kept even if they share a vertex.
  const auto erase_from = [&](std::size_t from, std::vector<TrianglePair>& some) {
    const auto shared = [&](const TrianglePair& pair) {
      return share_index(scene.triangles[pair.a], scene.triangles[pair.b]);
    };
    const auto first = some.begin() + static_cast<std::ptrdiff_t>(from);
    some.erase(std::remove_if(first, some.end(), shared), some.end());
  };
  return give_findings(
      scene, pairs.size(), clearance, threads,
      [&](std::size_t begin, std::size_t end, BlockFindings& out) {
        for (std::size_t k = begin; k < end; ++k) {
          const bool same = k >= pairs.between.size();
          const BlockPair& pair = same ? pairs.inside[k - pairs.between.size()] : pairs.between[k];
          const std::size_t before = out.pairs.size(), perhaps_before = out.perhaps.size();
          HWY_DYNAMIC_DISPATCH(compare_oriented_here)(blocks, place[pair.a], place[pair.b], out);
          if (!same || neighbours) continue;
          erase_from(before, out.pairs);
          erase_from(perhaps_before, out.perhaps);
        }
      },
      take);
}

std::uint64_t give_pairs_of_blocks(const Scene& scene, const BlockMeetings& meetings,
                                   const BlockPairs& some, double clearance, bool neighbours,
                                   unsigned threads, const TakePairs& take) {
  return meetings.oriented ? give_pairs_of_oriented(scene, *meetings.oriented, some, clearance,
                                                    neighbours, threads, take)
                           : give_pairs_of_some(scene, *meetings.of, some, meetings.normals,
                                                clearance, neighbours, threads, take);
}

std::vector<TrianglePair> pairs_of_blocks(const Scene& scene, const BlockMeetings& meetings,
                                          double clearance, bool neighbours, unsigned threads) {
  if (meetings.pairs.size() == 0) return meetings.kept;
  std::vector<TrianglePair> found = sorted_pairs(threads, [&](const TakePairs& take) {
    return give_pairs_of_blocks(scene, meetings, meetings.pairs, clearance, neighbours, threads,
                                take);
  });
  if (meetings.kept.empty()) return found;
  std::vector<TrianglePair> out;
  out.reserve(found.size() + meetings.kept.size());
  std::ranges::merge(found, meetings.kept, std::back_inserter(out));
  return out;
}

}  // namespace farcull
#endif
