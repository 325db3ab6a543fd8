// Finds objects whose boxes overlap, and then the overlapping boxes of the blocks of these objects.
#include "core/boxes/meetings.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/boxes/oriented.h"

namespace farcull {
namespace {

bool collides_with_itself(const Object& object) { return object.self && object.triangle_count > 1; }

constexpr std::size_t kMeetingsPerBlock = 8;

// A part of a meeting: the blocks from .. to - 1 of object a, and their overlapping pairs.
struct MeetingPart {
  std::uint32_t meeting;
  std::uint32_t from, to;
  std::vector<BlockPair> pairs = {};
};
constexpr std::uint32_t kBlocksOfPart = 256;

// Returns the limit for the pairs of blocks of a meeting: kPairsPerBlock for each block of the two
// objects, including blocks in no pair.
std::size_t most_pairs(const TriangleBlocks& blocks, const ObjectOverlap& meeting) {
  const std::size_t b = meeting.a == meeting.b ? 0 : blocks.count(meeting.b);
  return kPairsPerBlock * (blocks.count(meeting.a) + b);
}

std::vector<MeetingPart> parts_of(const TriangleBlocks& blocks,
                                  const std::vector<ObjectOverlap>& meetings) {
  std::vector<MeetingPart> parts;
  for (std::uint32_t k = 0; k < meetings.size(); ++k) {
    const std::uint32_t a = meetings[k].a, end = blocks.first[a] + blocks.count(a);
    for (std::uint32_t from = blocks.first[a]; from < end; from += kBlocksOfPart)
      parts.push_back({.meeting = k, .from = from, .to = std::min(from + kBlocksOfPart, end)});
  }
  return parts;
}

// Moves the pairs of all parts to `out`. Returns false if a meeting exceeds kPairsPerBlock.
bool sort_in(const std::vector<ObjectOverlap>& all, std::span<MeetingPart> parts,
             BlockMeetings& out) {
  std::vector<std::uint32_t> seen(out.of->ranges.size(), 0);  // per block: 1 + its last meeting
  std::size_t between = 0, inside = 0;
  for (const MeetingPart& part : parts)
    (all[part.meeting].a == all[part.meeting].b ? inside : between) += part.pairs.size();
  out.pairs.between.reserve(between);
  out.pairs.inside.reserve(inside);
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end) {
    const std::uint32_t own = parts[begin].meeting;
    const ObjectOverlap& meeting = all[own];
    std::size_t pairs = 0, blocks = 0;
    for (; end < parts.size() && parts[end].meeting == own; ++end) {
      pairs += parts[end].pairs.size();
      for (const BlockPair& pair : parts[end].pairs)
        for (const std::uint32_t block : {pair.a, pair.b})
          blocks += std::exchange(seen[block], own + 1) != own + 1;
    }
    if (pairs > kPairsPerBlock * blocks) return false;
    std::vector<BlockPair>& to = meeting.a == meeting.b ? out.pairs.inside : out.pairs.between;
    for (std::size_t k = begin; k < end; ++k) {
      to.insert(to.end(), parts[k].pairs.begin(), parts[k].pairs.end());
      std::vector<BlockPair>().swap(parts[k].pairs);  // frees memory, which `= {}` would not
    }
    ++out.meetings;
  }
  out.triangles = triangles_in(out.pairs, *out.of);
  out.overlaps = out.pairs.size();
  return true;
}

// Returns the limit for the pairs of blocks of the whole scene.
std::size_t most_pairs(const TriangleBlocks& blocks) {
  return kMostPairsPerBlock * blocks.ranges.size();
}

enum class Found : std::uint8_t { all, too_many_of_a_meeting, too_many };

// Finds the pairs of blocks of each part. Gives up a meeting that has more pairs than its limit.
// Gives up all meetings if the scene has more pairs than its limit. In the sum for the scene, a
// meeting counts as at most limit + 1 pairs. So the result does not depend on the threads.
// find(meeting, part, most) appends pairs to the part as pair_blocks() does.
template <class Find>
Found find_blocks(const TriangleBlocks& blocks, const std::vector<ObjectOverlap>& meetings,
                  unsigned threads, std::vector<MeetingPart>& parts, const Find& find) {
  std::vector<std::atomic<std::size_t>> found(meetings.size());
  std::atomic<std::size_t> sum = 0;
  const std::size_t most_of_all = most_pairs(blocks);
  const std::size_t chunks = chunks_for(parts.size(), 1, threads);
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> given_up = false;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    MeetingPart scratch;  // copying pairs from here leaves no unused memory in a part
    for (std::size_t k = next++; k < parts.size(); k = next++) {
      MeetingPart& part = parts[k];
      const ObjectOverlap& meeting = meetings[part.meeting];
      std::atomic<std::size_t>& of_meeting = found[part.meeting];
      const std::size_t most = std::min(most_pairs(blocks, meeting), most_of_all);
      if (sum > most_of_all) return;
      if (of_meeting > most) continue;
      scratch.from = part.from;
      scratch.to = part.to;
      scratch.pairs.clear();
      find(meeting, scratch, most);
      const std::size_t pairs = scratch.pairs.size(), before = of_meeting.fetch_add(pairs);
      sum += std::min(before + pairs, most + 1) - std::min(before, most + 1);
      if (before + pairs <= most) {
        part.pairs = scratch.pairs;
      } else {
        given_up = true;
      }
    }
  });
  if (sum > most_of_all) return Found::too_many;
  return given_up ? Found::too_many_of_a_meeting : Found::all;
}

// Oriented boxes are used if they leave at most this many pairs per triangle in a sample.
constexpr double kOrientedPerTriangle = 64;
// Normals are compared if three conditions hold in a sample. Axis-aligned boxes leave more than
// kFewOverlaps pairs per triangle. Normals leave at most kMostLeft pairs per triangle. Normals
// leave at most 1 / kLeastDrop of the pairs that boxes leave. Per triangle, normals cost about as
// much as two exact tests of pairs, and oriented boxes cost about as much as ten.
constexpr double kFewOverlaps = 2, kLeastDrop = 4, kMostLeft = 8;

// Finds the pairs of blocks whose oriented boxes overlap. Returns empty if there are too many.
std::optional<BlockMeetings> oriented_meetings(const Scene& scene,
                                               const std::vector<ObjectOverlap>& meetings,
                                               std::span<const Box> regions, double clearance,
                                               unsigned threads) {
  BlockMeetings out;
  out.oriented = make_oriented(scene, clearance, regions, threads);
  if (!out.oriented) return std::nullopt;
  out.of = {out.oriented, &out.oriented->blocks};
  std::vector<MeetingPart> parts = parts_of(*out.of, meetings);
  const Found found = find_blocks(
      *out.of, meetings, threads, parts,
      [&](const ObjectOverlap& meeting, MeetingPart& part, std::size_t most) {
        pair_oriented(*out.oriented, meeting.a, meeting.b, part.from, part.to, most, part.pairs);
      });
  if (found != Found::all || !sort_in(meetings, parts, out) ||
      overlaps_by_sample(scene, out, clearance) > kOrientedPerTriangle) {
    return std::nullopt;
  }
  return out;
}

}  // namespace

ObjectOverlaps find_meetings(const Scene& scene, const TriangleBlocks& blocks,
                             std::span<const ObjectPair> ignored) {
  std::vector<std::uint32_t> objects(blocks.objects.size());
  std::iota(objects.begin(), objects.end(), 0u);
  const std::size_t most = kMeetingsPerBlock * blocks.ranges.size();
  ObjectOverlaps out;
  out.self = static_cast<std::uint64_t>(std::ranges::count_if(scene.objects, collides_with_itself));
  const std::vector<TrianglePair> pairs = box_join(blocks.objects, objects, objects, most);
  out.crowded = pairs.size() > most;
  if (out.crowded) return out;
  for (const auto& [a, b] : pairs) {
    if (std::ranges::binary_search(ignored, ObjectPair{std::min(a, b), std::max(a, b)})) continue;
    const bool ordered = blocks.count(a) <= blocks.count(b);
    out.all.push_back({ordered ? a : b, ordered ? b : a});
  }
  out.pairs = out.all.size();
  for (const std::uint32_t o : objects) {
    if (collides_with_itself(scene.objects[o])) out.all.push_back({o, o});
  }
  return out;
}

std::vector<Box> boxes_of_meetings(const TriangleBlocks& blocks,
                                   std::span<const ObjectOverlap> meetings) {
  std::vector<Box> out(blocks.objects.size(), Box::empty());
  for (const ObjectOverlap& meeting : meetings) {
    const Box common = intersection(blocks.objects[meeting.a], blocks.objects[meeting.b]);
    out[meeting.a].add(common);
    out[meeting.b].add(common);
  }
  return out;
}

std::uint64_t triangles_in(const BlockPairs& pairs, const TriangleBlocks& blocks) {
  std::uint64_t out = 0;
  for (const std::uint32_t block : blocks_in(pairs, blocks.ranges.size()))
    out += blocks.ranges[block].count;
  return out;
}

double overlaps_by_sample(const Scene& scene, const BlockMeetings& meetings, double clearance) {
  constexpr std::size_t kSampled = 64;  // number of sampled pairs of blocks, evenly spaced
  const std::size_t all = meetings.pairs.size();
  if (all == 0) return 0;
  BlockPairs some;
  for (const auto list : {&BlockPairs::between, &BlockPairs::inside}) {
    const std::vector<BlockPair>& pairs = meetings.pairs.*list;
    const std::size_t count = std::min((kSampled * pairs.size() + all - 1) / all, pairs.size());
    for (std::size_t k = 0; k < count; ++k) (some.*list).push_back(pairs[pairs.size() * k / count]);
  }
  const std::uint64_t found =
      give_pairs_of_blocks(scene, meetings, some, clearance, false, 1, [](const auto&) {});
  const double each = static_cast<double>(found) / static_cast<double>(some.size());
  return each * static_cast<double>(all) / static_cast<double>(meetings.triangles);
}

std::optional<BlockDecision> decide_by_meetings(const TriangleBlocks& blocks,
                                                const ObjectOverlaps& meetings) {
  // True if floats may be too coarse for the blocks of an object in a meeting.
  const bool uneven =
      !blocks.stretched.empty() &&
      (meetings.crowded || std::ranges::any_of(meetings.all, [&](const ObjectOverlap& meeting) {
         return std::max(blocks.stretch(meeting.a), blocks.stretch(meeting.b)) > kUneven;
       }));
  if (!uneven && !meetings.crowded) return std::nullopt;
  return BlockDecision{.blocks = {},
                       .tree = uneven ? Reason::join_uneven : Reason::join_crowded,
                       .pairs = meetings.pairs,
                       .self = meetings.self};
}

BlockDecision decide_by_pairs(const Scene& scene, const ObjectOverlaps& meetings,
                              const std::vector<Box>& regions, double clearance, unsigned threads,
                              std::shared_ptr<const TriangleBlocks> of, bool along_axes) {
  const TriangleBlocks& blocks = *of;
  BlockDecision out{.blocks = {}, .pairs = meetings.pairs, .self = meetings.self};
  out.blocks.of = std::move(of);
  const BlockTrees trees(blocks, regions);
  std::vector<MeetingPart> parts = parts_of(blocks, meetings.all);
  const Found found =
      find_blocks(blocks, meetings.all, threads, parts,
                  [&](const ObjectOverlap& meeting, MeetingPart& part, std::size_t most) {
                    pair_blocks(trees, meeting.a, meeting.b, part.from, part.to, most, part.pairs);
                  });
  if (found == Found::all && sort_in(meetings.all, parts, out.blocks)) {
    const double axes = overlaps_by_sample(scene, out.blocks, clearance);
    out.blocks.normals = !along_axes && axes > kFewOverlaps;
    if (out.blocks.normals) {
      const double left = overlaps_by_sample(scene, out.blocks, clearance);
      out.blocks.normals = left <= kMostLeft && kLeastDrop * left <= axes;
    }
    if (out.blocks.normals || axes <= kOverlapsPerTriangle) return out;
  }
  out.blocks = {};
  out.tree = Reason::join_often;
  if (found == Found::too_many) {
    out.tree = Reason::join_many_blocks;
    out.tree_n = most_pairs(blocks);
  } else if (!along_axes) {
    if (auto oriented = oriented_meetings(scene, meetings.all, regions, clearance, threads)) {
      out.blocks = *std::move(oriented);
      out.tree = Reason::none;
    }
  }
  return out;
}

BlockDecision decide_by_blocks(const Scene& scene, double clearance, unsigned threads,
                               std::span<const ObjectPair> ignored, bool along_axes) {
  const auto blocks = std::make_shared<TriangleBlocks>(make_blocks(scene, clearance, threads));
  const ObjectOverlaps meetings = find_meetings(scene, *blocks, ignored);
  if (auto decision = decide_by_meetings(*blocks, meetings)) return *std::move(decision);
  const std::vector<Box> regions = boxes_of_meetings(*blocks, meetings.all);
  gather_scattered(scene, clearance, regions, threads, *blocks);
  return decide_by_pairs(scene, meetings, regions, clearance, threads, blocks, along_axes);
}

std::optional<std::vector<TrianglePair>> pairs_of_boxes(const Scene& scene,
                                                        std::span<const ObjectPair> ignored,
                                                        bool neighbours, unsigned threads) {
  const BlockDecision decision = decide_by_blocks(scene, 0, threads, ignored, true);
  if (decision.tree != Reason::none) return std::nullopt;
  return pairs_of_blocks(scene, decision.blocks, 0, neighbours, threads);
}

std::vector<TrianglePair> pairs_of_some(const Scene& scene, std::span<const std::uint32_t> items,
                                        unsigned threads) {
  if (items.size() > UINT32_MAX / 3)  // each gets three vertices below
    throw Error(scene.name, "1.4e9 triangles or more are left to join", "split it into scenes");
  Scene some;  // has these triangles alone, in the same objects
  some.vertices.resize(3 * items.size());
  some.triangles.resize(items.size());
  for_chunks(items.size(), chunks_for(items.size(), 4096, threads),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) {
                 const auto v = static_cast<std::uint32_t>(3 * k);
                 some.triangles[k] = {v, v + 1, v + 2};
                 std::ranges::copy(scene.corners(items[k]), some.vertices.begin() + v);
               }
             });
  std::size_t next = 0;
  for (const Object& object : scene.objects) {
    const auto first = static_cast<std::uint32_t>(next);
    const std::uint32_t behind = object.first_triangle + object.triangle_count;
    next = static_cast<std::size_t>(std::ranges::lower_bound(items, behind) - items.begin());
    some.objects.push_back({.name = {},
                            .first_triangle = first,
                            .triangle_count = static_cast<std::uint32_t>(next) - first,
                            .self = object.self});
  }
  std::optional<std::vector<TrianglePair>> pairs = pairs_of_boxes(some, {}, true, threads);
  if (!pairs) pairs = OrderedPairs(some, 0, {}, true, threads).all();
  for (TrianglePair& pair : *pairs) pair = {items[pair.a], items[pair.b]};
  return *std::move(pairs);
}

}  // namespace farcull
