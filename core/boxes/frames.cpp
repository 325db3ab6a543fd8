// Finds the pairs of overlapping blocks in a frame, from the results of the previous frame.
#include "core/boxes/frames.h"

#include <algorithm>
#include <iterator>

#include "core/base/parallel.h"

namespace farcull {
namespace {

// Returns the overlapping pairs of blocks with at least one moved block, each pair once. moved: per
// block, 1 if the block moved, else 0. moved_blocks: the moved blocks, ascending.
BlockPairs pairs_of_moved(const BlockTrees& trees, const std::vector<ObjectOverlap>& meetings,
                          const TriangleBlocks& blocks, std::span<const std::uint8_t> moved,
                          const std::vector<std::uint32_t>& moved_blocks, unsigned threads) {
  struct Question {
    std::uint32_t block, of, with;  // compare this block of object `of` with object `with`
    bool second;                    // `of` is the second object of its meeting
  };
  std::vector<Question> questions;
  const auto ask = [&](std::uint32_t of, std::uint32_t with, bool second) {
    for (auto k = std::ranges::lower_bound(moved_blocks, blocks.first[of]);
         k != moved_blocks.end() && *k < blocks.first[of + 1]; ++k)
      questions.push_back({*k, of, with, second});
  };
  for (const ObjectOverlap& meeting : meetings) {
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
        // A pair of two moved blocks is found twice, once for each block. Keeps one of the two.
        if (of == with) {
          if (!moved[b] || a <= b) found[chunk].inside.push_back({std::min(a, b), std::max(a, b)});
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

// Returns the decision for a frame in which some blocks moved. Recomputes the boxes, trees and
// pairs of the moved blocks. Returns empty if decide_by_meetings() returns a decision, or if many
// more pairs of blocks overlap than when the blocks were made.
std::optional<BlockDecision> decision_of_moved(const Scene& scene, unsigned threads,
                                               FrameMemory& memory) {
  constexpr std::size_t kMostGrowth = 2;
  if (memory.blocks.use_count() > 1)  // another plan still uses these blocks
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
  const ObjectOverlaps meetings = find_meetings(scene, blocks, memory.ignored);
  if (decide_by_meetings(blocks, meetings)) return std::nullopt;
  if (origin == blocks.origin) {
    memory.trees->update(blocks, moved_blocks);
  } else {
    memory.trees.emplace(blocks, blocks.objects);
  }
  BlockDecision out{.blocks = {}, .pairs = meetings.pairs, .self = meetings.self};
  out.blocks.of = memory.blocks;
  out.blocks.normals = memory.normals;
  out.blocks.meetings = meetings.all.size();
  out.blocks.pairs =
      pairs_of_moved(*memory.trees, meetings.all, blocks, moved, moved_blocks, threads);
  const auto renew = [&](std::vector<BlockPair>& all, const std::vector<BlockPair>& anew) {
    std::erase_if(all, [&](const BlockPair& pair) { return moved[pair.a] || moved[pair.b]; });
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

BlockDecision decide_next_frame(const Scene& scene, unsigned threads, FrameMemory& memory) {
  if (!memory.moved.any()) {
    BlockDecision out = memory.counts;
    out.blocks.kept = memory.pairs;
    return out;
  }
  if (memory.blocks) {
    if (auto decision = decision_of_moved(scene, threads, memory)) return *std::move(decision);
  }
  const double clearance = memory.clearance;
  memory.blocks = std::make_shared<TriangleBlocks>(make_ordered_blocks(scene, clearance, threads));
  const TriangleBlocks& blocks = *memory.blocks;
  const ObjectOverlaps meetings = find_meetings(scene, blocks, memory.ignored);
  auto decision = decide_by_meetings(blocks, meetings);
  if (!decision) {
    decision = decide_by_pairs(scene, meetings, boxes_of_meetings(blocks, meetings.all), clearance,
                               threads, memory.blocks);
  }
  if (decision->tree == Reason::none && !decision->blocks.oriented) {
    memory.trees.emplace(blocks, blocks.objects);
    memory.block_of.resize(scene.triangles.size());
    for (std::uint32_t k = 0; k < blocks.ranges.size(); ++k) {
      const auto& [first, count] = blocks.ranges[k];
      for (std::uint32_t i = 0; i < count; ++i) memory.block_of[blocks.triangle(first + i)] = k;
    }
    memory.overlapping = decision->blocks.pairs;
    memory.normals = decision->blocks.normals;
    memory.usual = memory.overlapping.size();
  } else {
    memory.blocks.reset();
  }
  return *std::move(decision);
}

}  // namespace farcull
