// Boxes of objects are joined, then those of the runs of objects that meet.
#include "core/pairs/regions.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/uninitialized.h"
#include "core/pairs/box_check.h"
#include "core/scene/box_join.h"
#include "core/scene/pair_sort.h"

namespace farcull {
namespace {

// Two objects whose boxes overlap, or one that collides with itself (a == b). a has fewer runs.
struct Meeting {
  std::uint32_t a, b;
  Box common;
};

std::vector<Meeting> meetings_of(const Runs& runs) {
  std::vector<std::uint32_t> objects(runs.objects.size());
  std::iota(objects.begin(), objects.end(), 0u);
  std::vector<Meeting> out;
  for (const auto& [a, b] : box_join(runs.objects, objects, objects)) {
    const bool ordered = runs.count(a) <= runs.count(b);
    out.push_back(
        {ordered ? a : b, ordered ? b : a, intersection(runs.objects[a], runs.objects[b])});
  }
  return out;
}

bool collides_with_itself(const Object& object) { return object.self && object.triangle_count > 1; }

void append_triangles(const Runs& runs, std::uint32_t object, const Box& box,
                      std::vector<std::uint32_t>& out) {
  for (std::uint32_t k = runs.first[object]; k < runs.first[object + 1]; ++k) {
    const Box& own = runs.boxes[k];
    if ((own.lo.array() > box.hi.array()).any() || (box.lo.array() > own.hi.array()).any())
      continue;
    for (std::uint32_t t = 0; t < runs.runs[k].count; ++t) {
      out.push_back(runs.triangle(runs.runs[k].first + t));
    }
  }
}

// Where these meetings are.
PairRegions regions_of(const Runs& runs, const std::vector<Meeting>& meetings) {
  PairRegions out;
  out.objects.assign(runs.objects.size(), Box::empty());
  for (const Meeting& meeting : meetings) {
    out.objects[meeting.a].add(meeting.common);
    out.objects[meeting.b].add(meeting.common);
    (meeting.a == meeting.b ? out.self : out.pairs) += 1;
  }
  for (std::uint32_t o = 0; o < out.objects.size(); ++o) {
    if (out.objects[o].is_empty()) continue;
    out.reach.add(runs.objects[o]);
    append_triangles(runs, o, out.objects[o], out.triangles);
  }
  if (!runs.order.empty()) std::sort(out.triangles.begin(), out.triangles.end());
  return out;
}

std::vector<Meeting> all_meetings(const Scene& scene, const Runs& runs) {
  std::vector<Meeting> out = meetings_of(runs);
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    if (collides_with_itself(scene.objects[o])) out.push_back({o, o, runs.objects[o]});
  }
  return out;
}

// A part of a meeting: some runs of the object a, and what they meet.
struct Part {
  std::uint32_t meeting;
  std::uint32_t from, to;
  std::vector<RunPair> pairs = {};
};
constexpr std::uint32_t kRunsOfPart = 256;

std::vector<Part> parts_of(const Runs& runs, const std::vector<Meeting>& meetings) {
  std::vector<Part> parts;
  for (std::uint32_t k = 0; k < meetings.size(); ++k) {
    const std::uint32_t end = runs.first[meetings[k].a + 1];
    for (std::uint32_t from = runs.first[meetings[k].a]; from < end; from += kRunsOfPart) {
      parts.push_back({.meeting = k, .from = from, .to = std::min(from + kRunsOfPart, end)});
    }
  }
  return parts;
}

// Counts different runs.
class RunCounter {
 public:
  explicit RunCounter(std::size_t runs) : seen_(runs, 0) {}
  void start() { ++round_, count_ = 0; }
  void add(std::uint32_t run) {
    count_ += seen_[run] != round_;
    seen_[run] = round_;
  }
  std::size_t count() const { return count_; }

 private:
  std::vector<std::uint32_t> seen_;
  std::uint32_t round_ = 0;
  std::size_t count_ = 0;
};

// Meetings that are left to views, and some of their pairs.
struct LeftMeetings {
  std::vector<Meeting> meetings;
  std::vector<RunPair> between, inside;
};
constexpr std::size_t kSampled = 64;  // pairs of runs

// Appends at most `count` of the pairs, evenly.
void draw(const std::vector<RunPair>& from, std::size_t count, std::vector<RunPair>& to) {
  count = std::min(count, from.size());
  for (std::size_t k = 0; k < count; ++k) to.push_back(from[from.size() * k / count]);
}

// Puts the pairs of each meeting where they belong, or leaves the meeting to views.
LeftMeetings sort_in(const std::vector<Meeting>& all, std::span<Part> parts, std::size_t most,
                     RunMeetings& out) {
  LeftMeetings left;
  RunCounter counter(out.runs.size());
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end) {
    const Meeting& meeting = all[parts[begin].meeting];
    std::size_t pairs = 0;
    bool complete = true;
    counter.start();
    for (; end < parts.size() && parts[end].meeting == parts[begin].meeting; ++end) {
      complete &= parts[end].pairs.size() <= most;
      pairs += parts[end].pairs.size();
      for (const RunPair& pair : parts[end].pairs) counter.add(pair.a), counter.add(pair.b);
    }
    const bool inside = meeting.a == meeting.b;
    if (!complete || (most != SIZE_MAX && pairs > kPairsPerRun * counter.count())) {
      left.meetings.push_back(meeting);
      const std::size_t parts_here = end - begin;
      for (std::size_t k = begin; k < end; ++k) {
        draw(parts[k].pairs, (kSampled + parts_here - 1) / parts_here,
             inside ? left.inside : left.between);
      }
      continue;
    }
    std::vector<RunPair>& to = inside ? out.inside : out.between;
    for (std::size_t k = begin; k < end; ++k) {
      to.insert(to.end(), parts[k].pairs.begin(), parts[k].pairs.end());
    }
    ++out.meetings;
  }
  counter.start();
  for (const RunPair& pair : out.between) counter.add(pair.a), counter.add(pair.b);
  for (const RunPair& pair : out.inside) counter.add(pair.a), counter.add(pair.b);
  out.triangles = kRun * counter.count();
  return left;
}

// The blocks of the runs in some pairs, and the pairs of blocks.
struct Blocks {
  UninitializedVector<RunBlock> blocks;
  UninitializedVector<VertexBlock> vertices;
  std::vector<BlockPair> pairs;
};

Blocks blocks_of(const Scene& scene, const RunMeetings& meetings, std::span<const RunPair> between,
                 std::span<const RunPair> inside, double clearance, bool neighbours,
                 unsigned threads) {
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> place(meetings.runs.size(), kNone);
  for (const RunPair& pair : between) place[pair.a] = place[pair.b] = 0;
  for (const RunPair& pair : inside) place[pair.a] = place[pair.b] = 0;
  std::vector<std::uint32_t> used;
  for (std::uint32_t run = 0; run < place.size(); ++run) {
    if (place[run] == kNone) continue;
    place[run] = static_cast<std::uint32_t>(used.size());
    used.push_back(run);
  }
  Blocks out;
  out.blocks.resize(used.size());
  const bool drops = !neighbours && !inside.empty();
  if (drops) out.vertices.resize(used.size());
  for_chunks(used.size(), chunks_for(used.size(), 128, threads),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               std::array<std::uint32_t, kRun> triangles;
               for (std::size_t k = begin; k < end; ++k) {
                 const Run& run = meetings.runs[used[k]];
                 for (std::uint32_t i = 0; i < run.count; ++i) {
                   const std::uint32_t at = run.first + i;
                   triangles[i] = meetings.order.empty() ? at : meetings.order[at];
                   prefetch(scene, triangles[i]);
                 }
                 fill_block(scene, std::span(triangles).first(run.count), meetings.origin,
                            clearance, out.blocks[k], drops ? &out.vertices[k] : nullptr);
               }
             });
  out.pairs.reserve(between.size() + inside.size());
  for (const RunPair& pair : between) {
    out.pairs.push_back({place[pair.a], place[pair.b], false});
  }
  for (const RunPair& pair : inside) {
    out.pairs.push_back({place[pair.a], place[pair.b], !neighbours});
  }
  return out;
}

// Looks for the pairs of runs of each part, but no more than about `most`.
void find_runs(const RunTrees& trees, const std::vector<Meeting>& all, std::size_t most,
               unsigned threads, std::vector<Part>& parts) {
  const std::size_t chunks = chunks_for(parts.size(), 1, threads);
  std::atomic<std::size_t> next = 0;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    for (std::size_t k = next++; k < parts.size(); k = next++) {
      const Meeting& meeting = all[parts[k].meeting];
      pair_runs(trees, meeting.a, meeting.b, parts[k].from, parts[k].to, most, parts[k].pairs);
    }
  });
}

// The pairs of triangles that some pairs of runs give.
std::vector<TrianglePair> pairs_of_some(const Scene& scene, const RunMeetings& meetings,
                                        std::span<const RunPair> between,
                                        std::span<const RunPair> inside, double clearance,
                                        bool neighbours, unsigned threads) {
  const Blocks blocks = blocks_of(scene, meetings, between, inside, clearance, neighbours, threads);
  const std::size_t chunks = chunks_for(blocks.pairs.size(), 64, threads);
  std::vector<std::vector<TrianglePair>> found(chunks);
  for_chunks(blocks.pairs.size(), chunks,
             [&](std::size_t chunk, std::size_t begin, std::size_t end) {
               RunFindings findings;
               compare_blocks(blocks.blocks, blocks.vertices,
                              std::span(blocks.pairs).subspan(begin, end - begin), findings);
               found[chunk] = std::move(findings.certain);
               for (const TrianglePair& pair : findings.perhaps) {
                 if (boxes_meet(scene, pair, half_of(clearance))) found[chunk].push_back(pair);
               }
             });
  return sorted_unique(found, threads);
}

// Whether boxes of triangles overlap so often that views are worth while, by a sample of the pairs,
// which is returned in `left` then.
bool overlaps_often(const Scene& scene, const RunMeetings& meetings, double clearance,
                    LeftMeetings& left) {
  const std::size_t all = meetings.between.size() + meetings.inside.size();
  if (all == 0) return false;
  std::vector<RunPair> between, inside;
  draw(meetings.between, (kSampled * meetings.between.size() + all - 1) / all, between);
  draw(meetings.inside, (kSampled * meetings.inside.size() + all - 1) / all, inside);
  const std::size_t found =
      pairs_of_some(scene, meetings, between, inside, clearance, false, 1).size();
  const double each =
      static_cast<double>(found) / static_cast<double>(between.size() + inside.size());
  if (each * static_cast<double>(all) <=
      static_cast<double>(kOverlapsPerTriangle * meetings.triangles)) {
    return false;
  }
  left.between = std::move(between);
  left.inside = std::move(inside);
  return true;
}

// Some pairs of the meetings that are left to views; none where pairs of runs give fewer than one
// each, since then there are many more pairs of runs than pairs of triangles.
std::vector<TrianglePair> sample_of_left(const Scene& scene, const RunMeetings& meetings,
                                         const LeftMeetings& left, double clearance) {
  std::vector<RunPair> between, inside;
  draw(left.between, 2 * kSampled, between);
  draw(left.inside, 2 * kSampled, inside);
  const std::size_t least = between.size() + inside.size();
  std::vector<TrianglePair> sample =
      pairs_of_some(scene, meetings, between, inside, clearance, false, 1);
  if (sample.size() < least) sample.clear();
  return sample;
}

}  // namespace

PairRegions pair_regions(const Scene& scene, double clearance, bool full, unsigned threads) {
  const Runs runs = make_runs(scene, clearance, threads);
  const std::vector<Meeting> meetings = all_meetings(scene, runs);
  if (!full) return regions_of(runs, meetings);
  std::vector<Meeting> each;
  for (std::uint32_t o = 0; o < runs.objects.size(); ++o) {
    if (runs.count(o) > 0) each.push_back({o, o, runs.objects[o]});
  }
  PairRegions out = regions_of(runs, each);
  const PairRegions counts = regions_of(runs, meetings);
  out.pairs = counts.pairs;
  out.self = counts.self;
  return out;
}

PairParts split_meetings(const Scene& scene, double clearance, unsigned threads, bool all) {
  Runs runs = make_runs(scene, clearance, threads);
  const std::vector<Meeting> meetings = all_meetings(scene, runs);
  PairParts out;
  if (meetings.empty()) {
    out.rest = regions_of(runs, meetings);
    return out;
  }
  std::vector<Box> regions(runs.objects.size(), Box::empty());
  for (const Meeting& meeting : meetings) {
    regions[meeting.a].add(meeting.common);
    regions[meeting.b].add(meeting.common);
  }
  gather_scattered(scene, clearance, regions, threads, runs);
  const RunTrees trees(runs, regions);
  std::vector<Part> parts = parts_of(runs, meetings);
  // A meeting with more pairs is left to views in any case.
  const std::size_t most = all ? SIZE_MAX : 2 * kPairsPerRun * kRunsOfPart;
  find_runs(trees, meetings, most, threads, parts);
  out.runs.origin = trees.origin();
  out.runs.runs = runs.runs;
  out.runs.order = runs.order;
  LeftMeetings left = sort_in(meetings, parts, most, out.runs);
  if (!all && !out.runs.empty() && overlaps_often(scene, out.runs, clearance, left)) {
    left.meetings = meetings;
  }
  if (!left.meetings.empty()) out.sample = sample_of_left(scene, out.runs, left, clearance);
  out.rest = regions_of(runs, left.meetings);
  out.rest.self = static_cast<std::uint64_t>(
      std::ranges::count_if(meetings, [](const Meeting& m) { return m.a == m.b; }));
  out.rest.pairs = meetings.size() - out.rest.self;
  if (left.meetings.size() == meetings.size()) out.runs = {};
  return out;
}

std::vector<TrianglePair> pairs_of_runs(const Scene& scene, const RunMeetings& meetings,
                                        double clearance, bool neighbours, unsigned threads) {
  return pairs_of_some(scene, meetings, meetings.between, meetings.inside, clearance, neighbours,
                       threads);
}

}  // namespace farcull
