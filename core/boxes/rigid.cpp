// Descends the trees of all objects whose boxes overlap, from the roots to the blocks, one height
// at a time. Moves only the boxes of nodes that are in a pair. Compares the children of two nodes
// in floats, by the function that compares the triangles of two blocks (core/boxes/compare.h).
#include "core/boxes/rigid.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/uninitialized.h"

namespace farcull {
namespace {

void list_vertices(const Scene& scene, RigidBlocks& out) {
  out.first_vertex.assign(1, 0);
  for (const TriangleBlock& range : out.of->ranges) {
    const auto begin = static_cast<std::ptrdiff_t>(out.vertices.size());
    for (std::uint32_t k = 0; k < range.count; ++k) {
      const auto& corners = scene.triangles[out.of->triangle(range.first + k)];
      out.vertices.insert(out.vertices.end(), corners.begin(), corners.end());
    }
    std::sort(out.vertices.begin() + begin, out.vertices.end());
    out.vertices.erase(std::unique(out.vertices.begin() + begin, out.vertices.end()),
                       out.vertices.end());
    out.first_vertex.push_back(static_cast<std::uint32_t>(out.vertices.size()));
  }
}

// Descends the trees. The nodes of one height are numbered: node k of object o has the number
// first[o] + k, where first[o] is the first block of o. So the number of a leaf is the index of its
// block.
class Walk {
 public:
  Walk(const RigidBlocks& rigid, std::span<const RigidMotion> motions, double half,
       unsigned threads)
      : rigid_(rigid),
        blocks_(*rigid.of),
        motions_(motions),
        half_(half),
        threads_(threads),
        place_(blocks_.ranges.size()) {}

  // Returns all pairs of blocks whose moved boxes, grown by half the clearance, overlap. Also
  // returns pairs that touch in floats only. Returns empty if some height has too many pairs.
  std::optional<std::vector<BlockPair>> pairs(std::span<const ObjectOverlap> meetings) {
    BlockPairs out;
    int levels = 0;
    for (const auto& [a, b] : meetings) {
      out.between.push_back({blocks_.first[std::min(a, b)], blocks_.first[std::max(a, b)]});
      levels = std::max({levels, rigid_.trees[a].levels, rigid_.trees[b].levels});
    }
    for (int below = levels - 1; below >= 0; --below) {
      const std::vector<std::uint32_t> nodes = blocks_in(out, blocks_.ranges.size());
      // Sets the lanes of each node to the node's children, which have the height `below`.
      lanes_.resize(nodes.size());
      for_chunks(nodes.size(), chunks_for(nodes.size(), 64, threads_),
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (std::size_t k = begin; k < end; ++k) {
                     place_[nodes[k]] = static_cast<std::uint32_t>(k);
                     move_children_of(nodes[k], below, lanes_[k]);
                   }
                 });
      const std::size_t most = kPairsPerBlock * kWide * nodes.size();
      out.between = overlapping_children(out.between, most);
      if (out.between.size() > most) return std::nullopt;
    }
    return std::move(out.between);
  }

 private:
  // Sets `out` to the moved children of a node. A root of height `below` or less is its own child.
  void move_children_of(std::uint32_t node, int below, BlockLanes& out) const {
    const std::uint32_t object = rigid_.object_of[node], first = blocks_.first[object];
    const BoxTree<double>& tree = rigid_.trees[object];
    out.boxes.clear();
    out.triangles = {};
    out.bound = kNowhere;
    const auto set = [&](std::size_t lane, const Box& box, std::uint32_t number) {
      if (box.is_empty()) return;
      const FloatBox own = relative(grow(moved(motions_[object], box), half_), blocks_.origin);
      out.boxes.set(lane, own);
      out.bound.add(own);
      out.triangles[lane] = first + number;
    };
    if (below >= tree.levels) return set(0, tree.box, 0);
    const std::uint32_t number = node - first;
    const WideBoxes<double>& children =
        rigid_.nodes[tree.first[static_cast<std::size_t>(below)] + number];
    for (std::uint32_t k = 0; k < kWide; ++k) set(k, children.get(k), kWide * number + k);
  }

  // Returns the pairs of children whose boxes overlap, in an order that does not depend on threads.
  // If there are more than `most` pairs, may stop early, with more than `most` pairs in any order.
  std::vector<BlockPair> overlapping_children(std::span<const BlockPair> pairs,
                                              std::size_t most) const {
    constexpr std::size_t kAtOnce = 256;
    const std::size_t portions = (pairs.size() + kAtOnce - 1) / kAtOnce;
    const std::size_t chunks = chunks_for(portions, 1, threads_);
    std::vector<std::vector<BlockPair>> found(chunks);
    std::atomic<std::size_t> sum = 0;
    for_chunks(portions, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      for (std::size_t portion = begin; portion < end && sum <= most; ++portion) {
        std::vector<LanePair> some;
        for (const auto& [a, b] : pairs.subspan(kAtOnce * portion)
                                      .first(std::min(kAtOnce, pairs.size() - kAtOnce * portion)))
          some.push_back({place_[a], place_[b], false});
        BlockFindings own;
        compare_blocks({.first = lanes_, .second = {}}, {}, {}, some, own);
        sum += own.pairs.size() + own.perhaps.size();
        for (const auto list : {&BlockFindings::pairs, &BlockFindings::perhaps})
          for (const auto& [a, b] : own.*list) found[chunk].push_back({a, b});
      }
    });
    if (chunks == 1) return std::move(found[0]);
    std::vector<BlockPair> out;
    for (const std::vector<BlockPair>& some : found)
      out.insert(out.end(), some.begin(), some.end());
    return out;
  }

  const RigidBlocks& rigid_;
  const TriangleBlocks& blocks_;
  std::span<const RigidMotion> motions_;
  double half_;
  unsigned threads_;
  std::vector<std::uint32_t> place_;       // per node in a pair: its index in lanes_
  UninitializedVector<BlockLanes> lanes_;  // per node in a pair: its children
};

constexpr double kMost = std::numeric_limits<double>::max() / 4;

// True if all numbers computed to move a point of the box are at most kMost in magnitude.
bool keeps_finite(const RigidMotion& motion, const Box& box) {
  if (box.is_empty()) return true;
  const Vec3 most = box.lo.cwiseAbs().cwiseMax(box.hi.cwiseAbs());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = std::abs(motion.t[axis]);
    for (std::size_t k = 0; k < 3; ++k)
      sum += std::abs(motion.r[3 * axis + k]) * most[static_cast<Eigen::Index>(k)];
    if (!(sum <= kMost)) return false;
  }
  return true;
}

}  // namespace

Box moved(const RigidMotion& motion, const Box& box) {
  Box out;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double* const row = motion.r.data() + 3 * axis;
    const double t = motion.t[static_cast<std::size_t>(axis)];
    const auto low = [&](Eigen::Index k) { return row[k] < 0 ? box.hi[k] : box.lo[k]; };
    const auto high = [&](Eigen::Index k) { return row[k] < 0 ? box.lo[k] : box.hi[k]; };
    out.lo[axis] = moved_coordinate(row, low(0), low(1), low(2), t);
    out.hi[axis] = moved_coordinate(row, high(0), high(1), high(2), t);
  }
  return out;
}

RigidBlocks make_rigid_blocks(const Scene& scene, unsigned threads) {
  RigidBlocks out;
  out.of = std::make_shared<TriangleBlocks>(make_blocks(scene, 0, threads));
  TriangleBlocks& blocks = *out.of;
  blocks.boxes = {};
  blocks.stretched = {};
  blocks.order.resize(scene.triangles.size());
  out.object_of.resize(blocks.ranges.size());
  const std::size_t objects = scene.objects.size();
  out.trees.resize(objects);
  std::vector<std::size_t> at(objects + 1, 0);
  for (std::size_t o = 0; o < objects; ++o)
    at[o + 1] = at[o] + blocks_of_tree(blocks.first[o + 1] - blocks.first[o]);
  out.nodes.resize(at.back());
  for_each_shared(objects, threads, [&](std::size_t o) {
    const std::uint32_t first = scene.objects[o].first_triangle,
                        count = scene.objects[o].triangle_count;
    std::vector<Box> boxes(count);
    for (std::uint32_t k = 0; k < count; ++k) boxes[k] = grown_box(scene, first + k, 0);
    const auto order = std::span(blocks.order).subspan(first, count);
    spatial_order(boxes, order);
    std::vector<Box> leaves(blocks.first[o + 1] - blocks.first[o], Box::empty());
    for (std::uint32_t k = 0; k < count; ++k) {
      leaves[k / kWide].add(boxes[order[k]]);
      order[k] += first;
    }
    std::fill_n(out.object_of.begin() + blocks.first[o], leaves.size(),
                static_cast<std::uint32_t>(o));
    out.trees[o] = make_tree<double>(leaves, out.nodes, at[o]);
  });
  list_vertices(scene, out);
  return out;
}

std::optional<BlockDecision> decide_by_motions(const Scene& scene,
                                               std::span<const RigidMotion> motions,
                                               double clearance,
                                               std::span<const ObjectPair> ignored,
                                               unsigned threads, RigidBlocks& rigid) {
  const double half = half_of(clearance);
  if (has_self(scene) || half > kMost) return std::nullopt;
  if (rigid.of.use_count() > 1)  // another decision still uses these blocks
    rigid.of = std::make_shared<TriangleBlocks>(*rigid.of);
  TriangleBlocks& blocks = *rigid.of;
  for (std::size_t o = 0; o < motions.size(); ++o) {
    const Box& box = rigid.trees[o].box;
    if (!keeps_finite(motions[o], box)) return std::nullopt;
    blocks.objects[o] = box.is_empty() ? box : grow(moved(motions[o], box), half);
  }
  const ObjectOverlaps meetings = find_meetings(scene, blocks, ignored);
  if (meetings.crowded) return std::nullopt;
  // Floats are finest near the origin, so the origin is the middle of all overlaps of object boxes.
  Box all = Box::empty();
  for (const auto& [a, b] : meetings.all)
    all.add(intersection(blocks.objects[a], blocks.objects[b]));
  blocks.origin = Vec3::Zero();
  if (!all.is_empty()) blocks.origin = 0.5 * all.lo + 0.5 * all.hi;
  auto pairs = Walk(rigid, motions, half, threads).pairs(meetings.all);
  if (!pairs) return std::nullopt;
  BlockDecision out{.blocks = {}, .pairs = meetings.pairs, .self = meetings.self};
  out.blocks.of = rigid.of;
  out.blocks.moved = true;
  out.blocks.pairs.between = *std::move(pairs);
  out.blocks.overlaps = out.blocks.pairs.size();
  out.blocks.meetings = meetings.all.size();
  out.blocks.triangles = triangles_in(out.blocks.pairs, blocks);
  // Above this limit, the caller must use oriented boxes or a tree.
  if (kWide * out.blocks.overlaps > kPairsPerBlock * (out.blocks.triangles + kWide * kWide))
    return std::nullopt;
  return out;
}

void move_vertices(std::span<const Vec3> resting, std::span<const RigidMotion> motions,
                   const RigidBlocks& blocks, const BlockPairs& pairs, unsigned threads,
                   Scene& scene) {
  const std::vector<std::uint32_t> some = blocks_in(pairs, blocks.of->ranges.size());
  for_chunks(
      some.size(), chunks_for(some.size(), 128, threads),
      [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const RigidMotion& motion = motions[blocks.object_of[some[k]]];
          const std::uint32_t next = some[std::min(k + 1, end - 1)];
          for (const std::uint32_t v : blocks.vertices_of(next)) {
            __builtin_prefetch(resting[v].data());
            __builtin_prefetch(scene.vertices[v].data(), 1);
          }
          for (const std::uint32_t v : blocks.vertices_of(some[k])) {
            const Vec3 to = moved(motion, resting[v]);
            // Another thread may write the same numbers to this vertex, for another block.
            for (Eigen::Index axis = 0; axis < 3; ++axis)
              std::atomic_ref(scene.vertices[v][axis]).store(to[axis], std::memory_order_relaxed);
          }
        }
      });
}

}  // namespace farcull
