// Boxes of objects are joined, then those of the blocks of objects that meet.
#include "core/pairs/regions.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <optional>

#include "core/base/parallel.h"
#include "core/boxes/join.h"
#include "core/boxes/oriented.h"

namespace farcull {
namespace {

// Two objects whose boxes overlap, or one that collides with itself (a == b). a has no more blocks
// than b.
struct Meeting {
  std::uint32_t a, b;
};

// The common part of the boxes of both.
Box common_of(const TriangleBlocks& blocks, const Meeting& meeting) {
  return intersection(blocks.objects[meeting.a], blocks.objects[meeting.b]);
}

bool collides_with_itself(const Object& object) { return object.self && object.triangle_count > 1; }

// All meetings of a scene. If those of two objects are more than kMeetingsPerBlock for each block,
// the list is empty and `crowded` is set, since to list them would take more memory than the scene,
// and time that grows with the square of the objects.
struct Meetings {
  std::vector<Meeting> all;
  bool crowded = false;
};
constexpr std::size_t kMeetingsPerBlock = 8;

Meetings meetings_of(const Scene& scene, const TriangleBlocks& blocks,
                     std::span<const ObjectPair> ignored) {
  std::vector<std::uint32_t> objects(blocks.objects.size());
  std::iota(objects.begin(), objects.end(), 0u);
  const std::size_t most = kMeetingsPerBlock * blocks.ranges.size();
  Meetings out;
  const std::vector<TrianglePair> pairs = box_join(blocks.objects, objects, objects, most);
  if (pairs.size() > most) return {.all = {}, .crowded = true};
  for (const auto& [a, b] : pairs) {
    if (std::ranges::binary_search(ignored, ObjectPair{std::min(a, b), std::max(a, b)})) continue;
    const bool ordered = blocks.count(a) <= blocks.count(b);
    out.all.push_back({ordered ? a : b, ordered ? b : a});
  }
  for (const std::uint32_t o : objects) {
    if (collides_with_itself(scene.objects[o])) out.all.push_back({o, o});
  }
  return out;
}

// Whether a stretched object can meet another one or itself.
bool is_uneven(const TriangleBlocks& blocks, const Meetings& meetings) {
  if (blocks.stretched.empty()) return false;
  return meetings.crowded || std::ranges::any_of(meetings.all, [&](const Meeting& meeting) {
           return blocks.is_stretched(meeting.a) || blocks.is_stretched(meeting.b);
         });
}

void append_triangles(const TriangleBlocks& blocks, std::uint32_t object, const Box& box,
                      std::vector<std::uint32_t>& out) {
  if (blocks.is_gathered(object)) {
    const FloatBox region = relative(box, blocks.origin);
    for (std::uint32_t k = 0; k < blocks.count(object); ++k) {
      const BlockLanes& block = blocks.lanes[blocks.gathered[object].first + k];
      for (std::uint32_t t = 0; t < blocks.ranges[blocks.first[object] + k].count; ++t) {
        if (overlap(block.boxes.get(t), region)) out.push_back(block.triangles[t]);
      }
    }
    return;
  }
  for (std::uint32_t k = blocks.first[object]; k < blocks.first[object + 1]; ++k) {
    if (!overlap(blocks.boxes[k], box)) continue;
    for (std::uint32_t t = 0; t < blocks.ranges[k].count; ++t) {
      out.push_back(blocks.triangle(blocks.ranges[k].first + t));
    }
  }
}

// Per object the box in which it can meet another one or itself; empty if it cannot.
std::vector<Box> boxes_of_meetings(const TriangleBlocks& blocks,
                                   std::span<const Meeting> meetings) {
  std::vector<Box> out(blocks.objects.size(), Box::empty());
  for (const Meeting& meeting : meetings) {
    const Box common = common_of(blocks, meeting);
    out[meeting.a].add(common);
    out[meeting.b].add(common);
  }
  return out;
}

// The regions of meetings in these boxes.
PairRegions regions_in(const TriangleBlocks& blocks, std::vector<Box> boxes) {
  PairRegions out;
  out.objects = std::move(boxes);
  for (std::uint32_t o = 0; o < out.objects.size(); ++o) {
    if (out.objects[o].is_empty()) continue;
    out.reach.add(blocks.objects[o]);
    append_triangles(blocks, o, out.objects[o], out.triangles);
  }
  if (!blocks.order.empty()) std::sort(out.triangles.begin(), out.triangles.end());
  return out;
}

void count_meetings(const Scene& scene, const Meetings& meetings, PairRegions& out) {
  out.self = static_cast<std::uint64_t>(std::ranges::count_if(scene.objects, collides_with_itself));
  out.crowded = meetings.crowded;
  out.pairs = meetings.crowded ? 0 : meetings.all.size() - out.self;
}

// A part of a meeting: some blocks of the object a, and what they meet.
struct MeetingPart {
  std::uint32_t meeting;
  std::uint32_t from, to;
  std::vector<BlockPair> pairs = {};
};
constexpr std::uint32_t kBlocksOfPart = 256;

// The most pairs of blocks of a meeting: kPairsPerBlock for each block, whether or not it overlaps
// any.
std::size_t most_pairs(const TriangleBlocks& blocks, const Meeting& meeting) {
  const std::size_t b = meeting.a == meeting.b ? 0 : blocks.count(meeting.b);
  return kPairsPerBlock * (blocks.count(meeting.a) + b);
}

std::vector<MeetingPart> parts_of(const TriangleBlocks& blocks,
                                  const std::vector<Meeting>& meetings) {
  std::vector<MeetingPart> parts;
  for (std::uint32_t k = 0; k < meetings.size(); ++k) {
    const std::uint32_t a = meetings[k].a, end = blocks.first[a] + blocks.count(a);
    for (std::uint32_t from = blocks.first[a]; from < end; from += kBlocksOfPart) {
      parts.push_back({.meeting = k, .from = from, .to = std::min(from + kBlocksOfPart, end)});
    }
  }
  return parts;
}

// Counts different blocks.
class BlockCounter {
 public:
  explicit BlockCounter(std::size_t blocks) : seen_(blocks, 0) {}
  void start() { ++round_, count_ = 0; }
  void add(std::uint32_t block) {
    count_ += seen_[block] != round_;
    seen_[block] = round_;
  }
  std::size_t count() const { return count_; }

 private:
  std::vector<std::uint32_t> seen_;
  std::uint32_t round_ = 0;
  std::size_t count_ = 0;
};

constexpr std::size_t kSampled = 64;  // pairs of blocks, or blocks

// Appends at most `count` of the pairs, evenly.
void append_evenly(const std::vector<BlockPair>& from, std::size_t count,
                   std::vector<BlockPair>& to) {
  count = std::min(count, from.size());
  for (std::size_t k = 0; k < count; ++k) to.push_back(from[from.size() * k / count]);
}

// Triangles in all blocks of some pairs.
std::uint64_t triangles_in(const BlockPairs& pairs, const TriangleBlocks& blocks) {
  std::uint64_t out = 0;
  for (const std::uint32_t block : blocks_in(pairs, blocks.ranges.size()))
    out += blocks.ranges[block].count;
  return out;
}

// Puts the pairs of each meeting where they belong; returns those that are left to views.
std::vector<Meeting> sort_in(const std::vector<Meeting>& all, std::span<MeetingPart> parts,
                             const std::vector<std::uint8_t>& complete, bool none_left,
                             BlockMeetings& out) {
  std::vector<Meeting> left;
  BlockCounter counter(out.of->ranges.size());
  std::size_t between = 0, inside = 0;
  for (const MeetingPart& part : parts)
    (all[part.meeting].a == all[part.meeting].b ? inside : between) += part.pairs.size();
  out.pairs.between.reserve(between);
  out.pairs.inside.reserve(inside);
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end) {
    const std::uint32_t own = parts[begin].meeting;
    const Meeting& meeting = all[own];
    std::size_t pairs = 0;
    counter.start();
    for (; end < parts.size() && parts[end].meeting == own; ++end) {
      pairs += parts[end].pairs.size();
      for (const BlockPair& pair : parts[end].pairs) counter.add(pair.a), counter.add(pair.b);
    }
    if (!complete[own] || (!none_left && pairs > kPairsPerBlock * counter.count())) {
      left.push_back(meeting);
      continue;
    }
    std::vector<BlockPair>& to = meeting.a == meeting.b ? out.pairs.inside : out.pairs.between;
    for (std::size_t k = begin; k < end; ++k) {
      to.insert(to.end(), parts[k].pairs.begin(), parts[k].pairs.end());
      std::vector<BlockPair>().swap(parts[k].pairs);  // to make room, which `= {}` would keep
    }
    ++out.meetings;
  }
  out.triangles = triangles_in(out.pairs, *out.of);
  out.overlaps = out.pairs.size();
  return left;
}

// Some pairs of blocks of some meetings; the blocks are evenly chosen.
BlockPairs sample_of(const TriangleBlocks& blocks, const BlockTrees& trees,
                     std::span<const Meeting> meetings) {
  BlockPairs out;
  const std::size_t from = std::min(kSampled, meetings.size());
  for (std::size_t m = 0; m < from; ++m) {
    const Meeting& meeting = meetings[meetings.size() * m / from];
    const std::uint32_t first = blocks.first[meeting.a], count = blocks.count(meeting.a);
    const std::size_t chosen = std::min<std::size_t>(count, (kSampled + from - 1) / from);
    for (std::size_t k = 0; k < chosen; ++k) {
      const auto block = first + static_cast<std::uint32_t>(std::uint64_t{count} * k / chosen);
      std::vector<BlockPair> found;
      pair_blocks(trees, meeting.a, meeting.b, block, block + 1, SIZE_MAX, found);
      append_evenly(found, (2 * kSampled + chosen * from - 1) / (chosen * from),
                    meeting.a == meeting.b ? out.inside : out.between);
    }
  }
  return out;
}

// No more pairs of blocks of a whole scene are listed.
std::size_t most_pairs(const TriangleBlocks& blocks) {
  return kMostPairsPerBlock * blocks.ranges.size();
}

// Looks for the pairs of blocks of each part, and gives a meeting with more than most_pairs() up
// unless `all`. Returns per meeting whether it was not given up; nothing if there are more pairs of
// the whole scene. Meetings that are given up count as one pair more than they may have, so that
// the answer does not depend on threads.
// find(meeting, part, most): appends pairs to the part, as pair_blocks().
template <class Find>
std::vector<std::uint8_t> find_blocks(const TriangleBlocks& blocks,
                                      const std::vector<Meeting>& meetings, bool all,
                                      unsigned threads, std::vector<MeetingPart>& parts,
                                      const Find& find) {
  std::vector<std::atomic<std::size_t>> found(meetings.size());
  std::atomic<std::size_t> sum = 0;
  const std::size_t most_of_all = most_pairs(blocks);
  const std::size_t chunks = chunks_for(parts.size(), 1, threads);
  std::atomic<std::size_t> next = 0;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    MeetingPart scratch;  // so that a part has room for its own pairs only
    for (std::size_t k = next++; k < parts.size(); k = next++) {
      MeetingPart& part = parts[k];
      const Meeting& meeting = meetings[part.meeting];
      std::atomic<std::size_t>& of_meeting = found[part.meeting];
      const std::size_t most =
          all ? most_of_all : std::min(most_pairs(blocks, meeting), most_of_all);
      if (sum > most_of_all) return;
      if (of_meeting > most) continue;
      scratch.from = part.from;
      scratch.to = part.to;
      scratch.pairs.clear();
      find(meeting, scratch, most);
      const std::size_t pairs = scratch.pairs.size(), before = of_meeting.fetch_add(pairs);
      sum += std::min(before + pairs, most + 1) - std::min(before, most + 1);
      if (before + pairs <= most) part.pairs = scratch.pairs;
    }
  });
  if (sum > most_of_all) return {};
  std::vector<std::uint8_t> complete(meetings.size());
  for (std::size_t k = 0; k < meetings.size(); ++k) {
    complete[k] = all || found[k] <= most_pairs(blocks, meetings[k]);
  }
  return complete;
}

// Some of the pairs, at most about `count`, evenly.
BlockPairs some_of(const BlockPairs& pairs, std::size_t count) {
  const std::size_t all = pairs.size();
  BlockPairs out;
  append_evenly(pairs.between, (count * pairs.between.size() + all - 1) / all, out.between);
  append_evenly(pairs.inside, (count * pairs.inside.size() + all - 1) / all, out.inside);
  return out;
}

// Oriented boxes decide if, in a sample, they leave at most so many pairs for each triangle: exact
// tests of these take about as long as a view of slivers.
constexpr std::size_t kOrientedPerTriangle = 64;

// Whether more than `often` pairs of boxes of triangles overlap for each triangle, so that views
// are worth while, by a sample of the pairs, which is then returned in `sample`.
bool overlaps_often(const Scene& scene, const BlockMeetings& meetings, double clearance,
                    std::size_t often, BlockPairs& sample) {
  const std::size_t all = meetings.pairs.size();
  if (all == 0) return false;
  BlockPairs some = some_of(meetings.pairs, kSampled);
  const std::uint64_t found =
      give_pairs_of_blocks(scene, meetings, some, clearance, false, 1, [](const auto&) {});
  const double each = static_cast<double>(found) / static_cast<double>(some.size());
  if (each * static_cast<double>(all) <= static_cast<double>(often * meetings.triangles)) {
    return false;
  }
  sample = std::move(some);
  return true;
}

// The pairs of triangles of a sample; empty if pairs of blocks give fewer than one each, since then
// there are many more pairs of blocks than pairs of triangles.
std::vector<TrianglePair> pairs_of_sample(const Scene& scene, const TriangleBlocks& blocks,
                                          const BlockPairs& from, double clearance) {
  BlockPairs some;
  append_evenly(from.between, 2 * kSampled, some.between);
  append_evenly(from.inside, 2 * kSampled, some.inside);
  std::vector<TrianglePair> pairs = sorted_pairs(1, [&](const TakePairs& take) {
    return give_pairs_of_some(scene, blocks, some, clearance, false, 1, take);
  });
  if (pairs.size() < some.size()) pairs.clear();
  return pairs;
}

}  // namespace

PairRegions pair_regions(const Scene& scene, double clearance, bool full, unsigned threads,
                         std::span<const ObjectPair> ignored) {
  const TriangleBlocks blocks = make_blocks(scene, clearance, threads);
  const Meetings meetings = meetings_of(scene, blocks, ignored);
  PairRegions out = regions_in(
      blocks, full || meetings.crowded ? blocks.objects : boxes_of_meetings(blocks, meetings.all));
  count_meetings(scene, meetings, out);
  return out;
}

namespace {

// Nothing is left to blocks and views.
PairParts joined(const Scene& scene, const TriangleBlocks& blocks, const Meetings& meetings,
                 Reason reason, std::uint64_t n) {
  PairParts out;
  out.join = reason;
  out.join_n = n;
  out.rest.objects = blocks.objects;
  for (const Box& box : blocks.objects) {
    if (!box.is_empty()) out.rest.reach.add(box);
  }
  out.rest.triangles.resize(scene.triangles.size());
  std::iota(out.rest.triangles.begin(), out.rest.triangles.end(), 0u);
  count_meetings(scene, meetings, out.rest);
  return out;
}

// All meetings, decided by oriented boxes of blocks; nothing if these overlap too often as well.
std::optional<BlockMeetings> oriented_meetings(const Scene& scene,
                                               const std::vector<Meeting>& meetings,
                                               std::span<const Box> regions, double clearance,
                                               unsigned threads) {
  BlockMeetings out;
  out.oriented = make_oriented(scene, clearance, regions, threads);
  if (!out.oriented) return std::nullopt;
  out.of = {out.oriented, &out.oriented->blocks};
  std::vector<MeetingPart> parts = parts_of(*out.of, meetings);
  const std::vector<std::uint8_t> complete = find_blocks(
      *out.of, meetings, false, threads, parts,
      [&](const Meeting& meeting, MeetingPart& part, std::size_t most) {
        pair_oriented(*out.oriented, meeting.a, meeting.b, part.from, part.to, most, part.pairs);
      });
  BlockPairs sample;
  if (complete.size() < meetings.size() ||
      !sort_in(meetings, parts, complete, false, out).empty() ||
      overlaps_often(scene, out, clearance, kOrientedPerTriangle, sample)) {
    return std::nullopt;
  }
  return out;
}

// The meetings of a scene whose blocks have their boxes or lanes. regions: where its objects meet.
PairParts split(const Scene& scene, const Meetings& meetings, const std::vector<Box>& regions,
                double clearance, unsigned threads, bool all,
                std::shared_ptr<const TriangleBlocks> of) {
  const TriangleBlocks& blocks = *of;
  PairParts out;
  out.blocks.of = std::move(of);
  const BlockTrees trees(blocks, regions);
  std::vector<MeetingPart> parts = parts_of(blocks, meetings.all);
  const std::vector<std::uint8_t> complete =
      find_blocks(blocks, meetings.all, all, threads, parts,
                  [&](const Meeting& meeting, MeetingPart& part, std::size_t most) {
                    pair_blocks(trees, meeting.a, meeting.b, part.from, part.to, most, part.pairs);
                  });
  if (complete.size() < meetings.all.size()) {
    return joined(scene, blocks, meetings, Reason::join_many_blocks, most_pairs(blocks));
  }
  std::vector<Meeting> left = sort_in(meetings.all, parts, complete, all, out.blocks);
  BlockPairs sample;
  if (!all && !out.blocks.empty() &&
      overlaps_often(scene, out.blocks, clearance, kOverlapsPerTriangle, sample)) {
    left = meetings.all;
  } else if (!left.empty()) {
    sample = sample_of(blocks, trees, left);
  }
  if (!left.empty()) {
    if (auto oriented = oriented_meetings(scene, meetings.all, regions, clearance, threads)) {
      out.blocks = *std::move(oriented);
      left.clear();
    }
  }
  if (!left.empty()) out.sample = pairs_of_sample(scene, blocks, sample, clearance);
  out.rest = regions_in(blocks, boxes_of_meetings(blocks, left));
  count_meetings(scene, meetings, out.rest);
  if (left.size() == meetings.all.size()) out.blocks = {};
  return out;
}

// Per triangle the block that it is in.
std::vector<std::uint32_t> blocks_by_triangle(const TriangleBlocks& blocks, std::size_t triangles) {
  std::vector<std::uint32_t> out(triangles);
  for (std::uint32_t k = 0; k < blocks.ranges.size(); ++k) {
    const TriangleBlock& range = blocks.ranges[k];
    for (std::uint32_t i = 0; i < range.count; ++i) out[blocks.triangle(range.first + i)] = k;
  }
  return out;
}

// Pairs of blocks that overlap and of which one moved, each once. moved: per block; moved_blocks:
// the blocks that did, ascending.
BlockPairs pairs_of_moved(const BlockTrees& trees, const std::vector<Meeting>& meetings,
                          const TriangleBlocks& blocks, std::span<const std::uint8_t> moved,
                          const std::vector<std::uint32_t>& moved_blocks, unsigned threads) {
  struct Question {
    std::uint32_t block, of, with;  // block of object `of`, and the other object
    bool second;                    // `of` is the second object of its meeting
  };
  std::vector<Question> questions;
  const auto ask = [&](std::uint32_t of, std::uint32_t with, bool second) {
    for (auto k = std::ranges::lower_bound(moved_blocks, blocks.first[of]);
         k != moved_blocks.end() && *k < blocks.first[of + 1]; ++k)
      questions.push_back({*k, of, with, second});
  };
  for (const Meeting& meeting : meetings) {
    ask(meeting.a, meeting.b, false);
    if (meeting.a != meeting.b) ask(meeting.b, meeting.a, true);
  }
  const std::size_t chunks = chunks_for(questions.size(), 64, threads);
  std::vector<BlockPairs> found(chunks);
  for_chunks(questions.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::vector<BlockPair> own;
    for (std::size_t q = begin; q < end; ++q) {
      const auto& [block, of, with, second] = questions[q];
      own.clear();
      pair_blocks(trees, of, with, block, block + 1, SIZE_MAX, own, true);
      for (const auto& [a, b] : own) {
        // Of two that moved, each finds the other.
        if (of == with) {
          if (!moved[b] || a <= b) {
            found[chunk].inside.push_back({std::min(a, b), std::max(a, b)});
          }
        } else if (!second) {
          found[chunk].between.push_back({a, b});
        } else if (!moved[b]) {
          found[chunk].between.push_back({b, a});
        }
      }
    }
  });
  BlockPairs out;
  for (const BlockPairs& some : found) {
    out.between.insert(out.between.end(), some.between.begin(), some.between.end());
    out.inside.insert(out.inside.end(), some.inside.begin(), some.inside.end());
  }
  return out;
}

// The parts of a scene in which every object is left to the tree of all boxes, or to views; empty:
// blocks decide.
std::optional<PairParts> parts_without_blocks(const Scene& scene, const TriangleBlocks& blocks,
                                              const Meetings& meetings, double clearance,
                                              unsigned threads,
                                              std::span<const ObjectPair> ignored) {
  if (is_uneven(blocks, meetings)) return joined(scene, blocks, meetings, Reason::join_uneven, 0);
  if (!meetings.crowded) return std::nullopt;
  return PairParts{.blocks = {}, .rest = pair_regions(scene, clearance, false, threads, ignored)};
}

// The parts of a frame in which nothing moved: everything is as before.
PairParts unmoved_parts(const Scene& scene, const PairMemory& memory) {
  PairParts out;
  out.rest.objects.assign(scene.objects.size(), Box::empty());
  out.rest.pairs = memory.object_pairs;
  out.rest.self = memory.self;
  out.blocks.kept = memory.pairs;
  out.blocks.overlaps = memory.overlaps;
  out.blocks.meetings = memory.meetings;
  out.blocks.triangles = memory.triangles;
  return out;
}

}  // namespace

PairParts split_meetings(const Scene& scene, double clearance, unsigned threads, bool all,
                         std::span<const ObjectPair> ignored) {
  const auto blocks = std::make_shared<TriangleBlocks>(make_blocks(scene, clearance, threads));
  const Meetings meetings = meetings_of(scene, *blocks, ignored);
  if (auto parts = parts_without_blocks(scene, *blocks, meetings, clearance, threads, ignored))
    return *std::move(parts);
  const std::vector<Box> regions = boxes_of_meetings(*blocks, meetings.all);
  gather_scattered(scene, clearance, regions, threads, *blocks);
  return split(scene, meetings, regions, clearance, threads, all, blocks);
}

namespace {

// The parts of a frame in which some blocks moved: the boxes, trees and pairs of these are made
// anew. Nothing if many more pairs of blocks overlap than when the blocks were made, or if blocks
// do not decide.
std::optional<PairParts> parts_of_moved(const Scene& scene, unsigned threads, PairMemory& memory) {
  constexpr std::size_t kMostGrowth = 2;
  if (memory.blocks.use_count() > 1)  // somebody has the last frame's plan
    memory.blocks = std::make_shared<TriangleBlocks>(*memory.blocks);
  TriangleBlocks& blocks = *memory.blocks;
  std::vector<std::uint8_t> moved(blocks.ranges.size(), 0);
  for (const std::uint32_t t : memory.moved.triangles()) moved[memory.block_of[t]] = 1;
  std::vector<std::uint32_t> moved_blocks;
  for (std::uint32_t k = 0; k < moved.size(); ++k) {
    if (moved[k]) moved_blocks.push_back(k);
  }
  const Vec3 origin = blocks.origin;
  update_boxes(scene, memory.clearance, moved, threads, blocks);
  const Meetings meetings = meetings_of(scene, blocks, memory.ignored);
  if (meetings.crowded || is_uneven(blocks, meetings)) return std::nullopt;
  if (origin == blocks.origin) {
    memory.trees->update(blocks, moved_blocks);
  } else {
    memory.trees.emplace(blocks, blocks.objects);
  }
  PairParts out;
  out.rest.objects.assign(scene.objects.size(), Box::empty());
  count_meetings(scene, meetings, out.rest);
  out.blocks.of = memory.blocks;
  out.blocks.meetings = meetings.all.size();
  out.blocks.pairs =
      pairs_of_moved(*memory.trees, meetings.all, blocks, moved, moved_blocks, threads);
  const auto has_moved = [&](const BlockPair& pair) { return moved[pair.a] || moved[pair.b]; };
  const auto renew = [&](std::vector<BlockPair>& all, const std::vector<BlockPair>& anew) {
    std::erase_if(all, has_moved);
    all.insert(all.end(), anew.begin(), anew.end());
  };
  renew(memory.overlapping.between, out.blocks.pairs.between);
  renew(memory.overlapping.inside, out.blocks.pairs.inside);
  out.blocks.overlaps = memory.overlapping.size();
  if (out.blocks.overlaps > kMostGrowth * memory.usual + blocks.ranges.size()) return std::nullopt;
  out.blocks.triangles = triangles_in(memory.overlapping, blocks);
  std::ranges::copy_if(memory.pairs, std::back_inserter(out.blocks.kept),
                       [&](const TrianglePair& pair) {
                         return !moved[memory.block_of[pair.a]] && !moved[memory.block_of[pair.b]];
                       });
  return out;
}

}  // namespace

PairParts split_next_frame(const Scene& scene, unsigned threads, bool all, PairMemory& memory) {
  if (!memory.moved.any()) return unmoved_parts(scene, memory);
  if (memory.blocks) {
    if (auto parts = parts_of_moved(scene, threads, memory)) return *std::move(parts);
  }
  const double clearance = memory.clearance;
  memory.blocks = std::make_shared<TriangleBlocks>(make_ordered_blocks(scene, clearance, threads));
  const TriangleBlocks& blocks = *memory.blocks;
  const Meetings meetings = meetings_of(scene, blocks, memory.ignored);
  auto parts = parts_without_blocks(scene, blocks, meetings, clearance, threads, memory.ignored);
  if (!parts) {
    parts = split(scene, meetings, boxes_of_meetings(blocks, meetings.all), clearance, threads, all,
                  memory.blocks);
  }
  if (!meetings.crowded && parts->join == Reason::none && parts->rest.triangles.empty() &&
      !parts->blocks.oriented) {
    memory.trees.emplace(blocks, blocks.objects);
    memory.block_of = blocks_by_triangle(blocks, scene.triangles.size());
    memory.overlapping = parts->blocks.pairs;
    memory.usual = memory.overlapping.size();
  } else {
    memory.blocks.reset();
  }
  return *std::move(parts);
}

}  // namespace farcull
