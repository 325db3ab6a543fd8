// The triangles of runs stand in blocks of sixteen boxes as floats, which are compared on lanes;
// boxes that touch in floats are compared again in doubles.
#include "core/pairs/run_triangles.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/uninitialized.h"
#include "core/pairs/grown_box.h"
#include "core/scene/pair_sort.h"

namespace farcull {

std::vector<std::uint32_t> runs_of(std::span<const RunPair> between,
                                   std::span<const RunPair> inside, std::size_t runs) {
  std::vector<std::uint8_t> used(runs, 0);
  for (const RunPair& pair : between) used[pair.a] = used[pair.b] = 1;
  for (const RunPair& pair : inside) used[pair.a] = used[pair.b] = 1;
  std::vector<std::uint32_t> out;
  for (std::uint32_t run = 0; run < runs; ++run) {
    if (used[run]) out.push_back(run);
  }
  return out;
}

namespace {

constexpr std::uint32_t kNoBlock = 0xffffffff;

// Per run its block, or kNoBlock.
std::vector<std::uint32_t> blocks_by_run(const Runs& runs) {
  std::vector<std::uint32_t> out(runs.runs.size(), kNoBlock);
  for (std::uint32_t o = 0; o < runs.objects.size(); ++o) {
    if (!runs.is_gathered(o)) continue;
    const auto from = out.begin() + runs.first[o];
    std::iota(from, from + runs.count(o), runs.gathered[o].first);
  }
  return out;
}

// The blocks of the runs in some pairs.
struct Blocks {
  std::vector<std::uint32_t> place;           // per run: of its block, or kNoBlock
  UninitializedVector<RunBlock> more;         // behind those that the meetings have
  UninitializedVector<VertexBlock> vertices;  // of all; only those of the pairs' runs are filled
};

Blocks blocks_of(const Scene& scene, const RunMeetings& meetings, std::span<const RunPair> between,
                 std::span<const RunPair> inside, double clearance, bool neighbours,
                 unsigned threads) {
  const Runs& runs = *meetings.of;
  const std::vector<std::uint32_t> used = runs_of(between, inside, runs.runs.size());
  Blocks out;
  out.place = blocks_by_run(runs);
  std::vector<std::uint32_t>& place = out.place;
  const auto given = static_cast<std::uint32_t>(runs.blocks.size());
  std::uint32_t size = given;
  for (const std::uint32_t run : used) {
    if (place[run] == kNoBlock) place[run] = size++;
  }
  out.more.resize(size - given);
  const bool drops = !neighbours && !inside.empty();
  if (drops) out.vertices.resize(size);
  for_chunks(used.size(), chunks_for(used.size(), 128, threads),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               std::array<std::uint32_t, kRun> triangles;
               for (std::size_t k = begin; k < end; ++k) {
                 const std::uint32_t block = place[used[k]];
                 if (block < given && !drops) continue;
                 const Run& run = runs.runs[used[k]];
                 for (std::uint32_t i = 0; i < run.count; ++i) {
                   triangles[i] = runs.triangle(run.first + i);
                   prefetch(scene, triangles[i]);
                 }
                 const auto own = std::span(triangles).first(run.count);
                 if (block >= given) {
                   fill_block(scene, own, half_of(clearance), runs.origin, out.more[block - given]);
                 }
                 if (drops) fill_vertices(scene, own, out.vertices[block]);
               }
             });
  return out;
}

// Pairs of blocks that are compared at a time.
constexpr std::size_t kBlockPairs = 2048;

// The pairs of triangles that some pairs of runs give, in several parts and unsorted.
std::vector<std::vector<TrianglePair>> unsorted_pairs(
    const Scene& scene, const RunMeetings& meetings, std::span<const RunPair> between,
    std::span<const RunPair> inside, double clearance, bool neighbours, unsigned threads) {
  const Blocks blocks = blocks_of(scene, meetings, between, inside, clearance, neighbours, threads);
  const auto block_pair = [&](std::size_t k) {
    const bool same = k >= between.size();
    const RunPair& pair = same ? inside[k - between.size()] : between[k];
    return BlockPair{blocks.place[pair.a], blocks.place[pair.b], same && !neighbours};
  };
  const std::size_t all = between.size() + inside.size(), chunks = chunks_for(all, 64, threads);
  std::vector<std::vector<TrianglePair>> found(chunks);
  for_chunks(all, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::vector<BlockPair> pairs;
    pairs.reserve(std::min(end - begin, kBlockPairs));
    RunFindings findings;
    for (std::size_t k = begin; k < end; ++k) {
      pairs.push_back(block_pair(k));
      if (pairs.size() < kBlockPairs && k + 1 < end) continue;
      compare_blocks({.first = meetings.of->blocks, .second = blocks.more}, blocks.vertices, pairs,
                     findings);
      pairs.clear();
      for (const TrianglePair& pair : findings.perhaps) {
        if (boxes_meet(scene, pair, half_of(clearance))) findings.certain.push_back(pair);
      }
      findings.perhaps.clear();
    }
    found[chunk] = std::move(findings.certain);
  });
  return found;
}

}  // namespace

std::vector<TrianglePair> pairs_of_some(const Scene& scene, const RunMeetings& meetings,
                                        std::span<const RunPair> between,
                                        std::span<const RunPair> inside, double clearance,
                                        bool neighbours, unsigned threads) {
  return sorted_unique(
      unsorted_pairs(scene, meetings, between, inside, clearance, neighbours, threads), threads);
}

}  // namespace farcull
