// Boxes of objects are joined, then those of the runs of objects that meet.
#include "core/pairs/regions.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>

#include "core/base/parallel.h"
#include "core/pairs/run_triangles.h"
#include "core/scene/box_join.h"

namespace farcull {
namespace {

// Two objects whose boxes overlap, or one that collides with itself (a == b). a has no more runs
// than b.
struct Meeting {
  std::uint32_t a, b;
};

// What the boxes of both have in common.
Box common_of(const Runs& runs, const Meeting& meeting) {
  return intersection(runs.objects[meeting.a], runs.objects[meeting.b]);
}

bool collides_with_itself(const Object& object) { return object.self && object.triangle_count > 1; }

// All meetings of a scene; or, where those of two objects would be more than kMeetingsPerRun for
// each run, none but `crowded`, since to list them would take more memory than the scene, and time
// that grows with the square of the objects.
struct Meetings {
  std::vector<Meeting> all;
  bool crowded = false;
};
constexpr std::size_t kMeetingsPerRun = 8;

Meetings meetings_of(const Scene& scene, const Runs& runs, std::span<const ObjectPair> ignored) {
  std::vector<std::uint32_t> objects(runs.objects.size());
  std::iota(objects.begin(), objects.end(), 0u);
  const std::size_t most = kMeetingsPerRun * runs.runs.size();
  Meetings out;
  const std::vector<TrianglePair> pairs = box_join(runs.objects, objects, objects, most);
  if (pairs.size() > most) return {.all = {}, .crowded = true};
  for (const auto& [a, b] : pairs) {
    if (std::ranges::binary_search(ignored, ObjectPair{std::min(a, b), std::max(a, b)})) continue;
    const bool ordered = runs.count(a) <= runs.count(b);
    out.all.push_back({ordered ? a : b, ordered ? b : a});
  }
  for (const std::uint32_t o : objects) {
    if (collides_with_itself(scene.objects[o])) out.all.push_back({o, o});
  }
  return out;
}

// Whether a stretched object can meet another one or itself.
bool is_uneven(const Runs& runs, const Meetings& meetings) {
  if (runs.stretched.empty()) return false;
  return meetings.crowded || std::ranges::any_of(meetings.all, [&](const Meeting& meeting) {
           return runs.stretched[meeting.a] || runs.stretched[meeting.b];
         });
}

void append_triangles(const Runs& runs, std::uint32_t object, const Box& box,
                      std::vector<std::uint32_t>& out) {
  if (runs.is_gathered(object)) {
    const FloatBox region = relative(box, runs.origin);
    for (std::uint32_t k = 0; k < runs.count(object); ++k) {
      const RunBlock& block = runs.blocks[runs.gathered[object].first + k];
      for (std::uint32_t t = 0; t < runs.runs[runs.first[object] + k].count; ++t) {
        if (overlap(block.boxes.get(t), region)) out.push_back(block.triangles[t]);
      }
    }
    return;
  }
  for (std::uint32_t k = runs.first[object]; k < runs.first[object + 1]; ++k) {
    const Box& own = runs.boxes[k];
    if ((own.lo.array() > box.hi.array()).any() || (box.lo.array() > own.hi.array()).any())
      continue;
    for (std::uint32_t t = 0; t < runs.runs[k].count; ++t) {
      out.push_back(runs.triangle(runs.runs[k].first + t));
    }
  }
}

// Per object where it can meet another one or itself; empty where it cannot.
std::vector<Box> boxes_of_meetings(const Runs& runs, std::span<const Meeting> meetings) {
  std::vector<Box> out(runs.objects.size(), Box::empty());
  for (const Meeting& meeting : meetings) {
    const Box common = common_of(runs, meeting);
    out[meeting.a].add(common);
    out[meeting.b].add(common);
  }
  return out;
}

// Of meetings in these boxes.
PairRegions regions_in(const Runs& runs, std::vector<Box> boxes) {
  PairRegions out;
  out.objects = std::move(boxes);
  for (std::uint32_t o = 0; o < out.objects.size(); ++o) {
    if (out.objects[o].is_empty()) continue;
    out.reach.add(runs.objects[o]);
    append_triangles(runs, o, out.objects[o], out.triangles);
  }
  if (!runs.order.empty()) std::sort(out.triangles.begin(), out.triangles.end());
  return out;
}

void count_meetings(const Scene& scene, const Meetings& meetings, PairRegions& out) {
  out.self = static_cast<std::uint64_t>(std::ranges::count_if(scene.objects, collides_with_itself));
  out.crowded = meetings.crowded;
  out.pairs = meetings.crowded ? 0 : meetings.all.size() - out.self;
}

// A part of a meeting: some runs of the object a, and what they meet.
struct Part {
  std::uint32_t meeting;
  std::uint32_t from, to;
  std::vector<RunPair> pairs = {};
};
constexpr std::uint32_t kRunsOfPart = 256;

// More pairs of runs than this of a meeting are more than kPairsPerRun for each run that overlaps
// any.
std::size_t most_pairs(const Runs& runs, const Meeting& meeting) {
  const std::size_t b = meeting.a == meeting.b ? 0 : runs.count(meeting.b);
  return kPairsPerRun * (runs.count(meeting.a) + b);
}

std::vector<Part> parts_of(const Runs& runs, const std::vector<Meeting>& meetings) {
  std::vector<Part> parts;
  for (std::uint32_t k = 0; k < meetings.size(); ++k) {
    const std::uint32_t a = meetings[k].a, end = runs.first[a] + runs.count(a);
    for (std::uint32_t from = runs.first[a]; from < end; from += kRunsOfPart) {
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

constexpr std::size_t kSampled = 64;  // pairs of runs, or runs

// Appends at most `count` of the pairs, evenly.
void append_evenly(const std::vector<RunPair>& from, std::size_t count, std::vector<RunPair>& to) {
  count = std::min(count, from.size());
  for (std::size_t k = 0; k < count; ++k) to.push_back(from[from.size() * k / count]);
}

// Puts the pairs of each meeting where they belong; returns those that are left to views.
std::vector<Meeting> sort_in(const std::vector<Meeting>& all, std::span<Part> parts,
                             const std::vector<std::uint8_t>& complete, bool none_left,
                             RunMeetings& out) {
  std::vector<Meeting> left;
  RunCounter counter(out.of->runs.size());
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end) {
    const std::uint32_t own = parts[begin].meeting;
    const Meeting& meeting = all[own];
    std::size_t pairs = 0;
    counter.start();
    for (; end < parts.size() && parts[end].meeting == own; ++end) {
      pairs += parts[end].pairs.size();
      for (const RunPair& pair : parts[end].pairs) counter.add(pair.a), counter.add(pair.b);
    }
    if (!complete[own] || (!none_left && pairs > kPairsPerRun * counter.count())) {
      left.push_back(meeting);
      continue;
    }
    std::vector<RunPair>& to = meeting.a == meeting.b ? out.inside : out.between;
    for (std::size_t k = begin; k < end; ++k) {
      to.insert(to.end(), parts[k].pairs.begin(), parts[k].pairs.end());
      std::vector<RunPair>().swap(parts[k].pairs);  // to make room, which `= {}` would keep
    }
    ++out.meetings;
  }
  for (const std::uint32_t run : runs_of(out.between, out.inside, out.of->runs.size())) {
    out.triangles += out.of->runs[run].count;
  }
  out.overlaps = out.between.size() + out.inside.size();
  return left;
}

// Some pairs of runs of some meetings: of runs that are evenly chosen.
struct RunSample {
  std::vector<RunPair> between, inside;
};
RunSample sample_of(const Runs& runs, const RunTrees& trees, std::span<const Meeting> meetings) {
  RunSample out;
  const std::size_t from = std::min(kSampled, meetings.size());
  for (std::size_t m = 0; m < from; ++m) {
    const Meeting& meeting = meetings[meetings.size() * m / from];
    const std::uint32_t first = runs.first[meeting.a], count = runs.count(meeting.a);
    const std::size_t chosen = std::min<std::size_t>(count, (kSampled + from - 1) / from);
    for (std::size_t k = 0; k < chosen; ++k) {
      const auto run = first + static_cast<std::uint32_t>(std::uint64_t{count} * k / chosen);
      std::vector<RunPair> found;
      pair_runs(trees, meeting.a, meeting.b, run, run + 1, SIZE_MAX, found);
      append_evenly(found, (2 * kSampled + chosen * from - 1) / (chosen * from),
                    meeting.a == meeting.b ? out.inside : out.between);
    }
  }
  return out;
}

// Pairs of runs of a whole scene, of which no more are listed.
std::size_t most_pairs(const Runs& runs) { return kMostPairsPerRun * runs.runs.size(); }

// Looks for the pairs of runs of each part. Of a meeting with more than most_pairs() it gives up,
// unless `all`; returns per meeting whether it did not; nothing where there are more pairs of the
// whole scene. Meetings that are given up count as one pair more than they may have, so that the
// answer does not depend on threads.
std::vector<std::uint8_t> find_runs(const Runs& runs, const RunTrees& trees,
                                    const std::vector<Meeting>& meetings, bool all,
                                    unsigned threads, std::vector<Part>& parts) {
  std::vector<std::atomic<std::size_t>> found(meetings.size());
  std::atomic<std::size_t> sum = 0;
  const std::size_t most_of_all = most_pairs(runs);
  const std::size_t chunks = chunks_for(parts.size(), 1, threads);
  std::atomic<std::size_t> next = 0;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    for (std::size_t k = next++; k < parts.size(); k = next++) {
      Part& part = parts[k];
      const Meeting& meeting = meetings[part.meeting];
      std::atomic<std::size_t>& of_meeting = found[part.meeting];
      const std::size_t most = all ? most_of_all : std::min(most_pairs(runs, meeting), most_of_all);
      if (sum > most_of_all) return;
      if (of_meeting > most) continue;
      pair_runs(trees, meeting.a, meeting.b, part.from, part.to, most, part.pairs);
      const std::size_t pairs = part.pairs.size(), before = of_meeting.fetch_add(pairs);
      sum += std::min(before + pairs, most + 1) - std::min(before, most + 1);
      if (before + pairs > most) part.pairs = {};
    }
  });
  if (sum > most_of_all) return {};
  std::vector<std::uint8_t> complete(meetings.size());
  for (std::size_t k = 0; k < meetings.size(); ++k) {
    complete[k] = all || found[k] <= most_pairs(runs, meetings[k]);
  }
  return complete;
}

// Whether boxes of triangles overlap so often that views are worth while, by a sample of the pairs,
// which is returned in `sample` then.
bool overlaps_often(const Scene& scene, const RunMeetings& meetings, double clearance,
                    RunSample& sample) {
  const std::size_t all = meetings.between.size() + meetings.inside.size();
  if (all == 0) return false;
  RunSample some;
  append_evenly(meetings.between, (kSampled * meetings.between.size() + all - 1) / all,
                some.between);
  append_evenly(meetings.inside, (kSampled * meetings.inside.size() + all - 1) / all, some.inside);
  const std::size_t found =
      pairs_of_some(scene, meetings, some.between, some.inside, clearance, false, 1).size();
  const double each =
      static_cast<double>(found) / static_cast<double>(some.between.size() + some.inside.size());
  if (each * static_cast<double>(all) <=
      static_cast<double>(kOverlapsPerTriangle * meetings.triangles)) {
    return false;
  }
  sample = std::move(some);
  return true;
}

// The pairs of triangles of a sample; none where pairs of runs give fewer than one each, since then
// there are many more pairs of runs than pairs of triangles.
std::vector<TrianglePair> pairs_of_sample(const Scene& scene, const RunMeetings& meetings,
                                          const RunSample& from, double clearance) {
  RunSample some;
  append_evenly(from.between, 2 * kSampled, some.between);
  append_evenly(from.inside, 2 * kSampled, some.inside);
  std::vector<TrianglePair> pairs =
      pairs_of_some(scene, meetings, some.between, some.inside, clearance, false, 1);
  if (pairs.size() < some.between.size() + some.inside.size()) pairs.clear();
  return pairs;
}

}  // namespace

PairRegions pair_regions(const Scene& scene, double clearance, bool full, unsigned threads,
                         std::span<const ObjectPair> ignored) {
  const Runs runs = make_runs(scene, clearance, threads);
  const Meetings meetings = meetings_of(scene, runs, ignored);
  PairRegions out = regions_in(
      runs, full || meetings.crowded ? runs.objects : boxes_of_meetings(runs, meetings.all));
  count_meetings(scene, meetings, out);
  return out;
}

namespace {

// Nothing is left to runs and views.
PairParts joined(const Scene& scene, const Runs& runs, const Meetings& meetings, Reason reason,
                 std::uint64_t n) {
  PairParts out;
  out.join = reason;
  out.join_n = n;
  out.rest.objects = runs.objects;
  for (const Box& box : runs.objects) {
    if (!box.is_empty()) out.rest.reach.add(box);
  }
  out.rest.triangles.resize(scene.triangles.size());
  std::iota(out.rest.triangles.begin(), out.rest.triangles.end(), 0u);
  count_meetings(scene, meetings, out.rest);
  return out;
}

// The meetings of a scene whose runs have their boxes or blocks. regions: where its objects meet.
PairParts split(const Scene& scene, const Meetings& meetings, const std::vector<Box>& regions,
                double clearance, unsigned threads, bool all, std::shared_ptr<const Runs> of) {
  const Runs& runs = *of;
  PairParts out;
  out.runs.of = std::move(of);
  const RunTrees trees(runs, regions);
  std::vector<Part> parts = parts_of(runs, meetings.all);
  const std::vector<std::uint8_t> complete =
      find_runs(runs, trees, meetings.all, all, threads, parts);
  if (complete.size() < meetings.all.size()) {
    return joined(scene, runs, meetings, Reason::join_many_runs, most_pairs(runs));
  }
  std::vector<Meeting> left = sort_in(meetings.all, parts, complete, all, out.runs);
  RunSample sample;
  if (!all && !out.runs.empty() && overlaps_often(scene, out.runs, clearance, sample)) {
    left = meetings.all;
  } else if (!left.empty()) {
    sample = sample_of(runs, trees, left);
  }
  if (!left.empty()) out.sample = pairs_of_sample(scene, out.runs, sample, clearance);
  out.rest = regions_in(runs, boxes_of_meetings(runs, left));
  count_meetings(scene, meetings, out.rest);
  if (left.size() == meetings.all.size()) out.runs = {};
  return out;
}

// Leaves out pairs of runs of which neither moved, and keeps the pairs that they gave before.
void keep_unmoved(const Scene& scene, std::span<const std::uint8_t> moved,
                  const std::vector<TrianglePair>& before, RunMeetings& out) {
  const auto rests = [&](const RunPair& pair) { return !moved[pair.a] && !moved[pair.b]; };
  std::erase_if(out.between, rests);
  std::erase_if(out.inside, rests);
  std::vector<std::uint8_t> of_moved(scene.triangles.size(), 0);
  for (std::size_t k = 0; k < moved.size(); ++k) {
    if (!moved[k]) continue;
    const Run& run = out.of->runs[k];
    for (std::uint32_t i = 0; i < run.count; ++i) of_moved[out.of->triangle(run.first + i)] = 1;
  }
  std::ranges::copy_if(before, std::back_inserter(out.kept), [&](const TrianglePair& pair) {
    return !of_moved[pair.a] && !of_moved[pair.b];
  });
}

}  // namespace

PairParts split_meetings(const Scene& scene, double clearance, unsigned threads, bool all,
                         std::span<const ObjectPair> ignored) {
  ScatteredBoxes scattered;
  const auto runs = std::make_shared<Runs>(make_runs(scene, clearance, threads, &scattered));
  const Meetings meetings = meetings_of(scene, *runs, ignored);
  if (is_uneven(*runs, meetings)) return joined(scene, *runs, meetings, Reason::join_uneven, 0);
  if (meetings.crowded)
    return {.runs = {}, .rest = pair_regions(scene, clearance, false, threads, ignored)};
  const std::vector<Box> regions = boxes_of_meetings(*runs, meetings.all);
  gather_scattered(scene, clearance, regions, threads, scattered, *runs);
  scattered = {};  // to make room
  return split(scene, meetings, regions, clearance, threads, all, runs);
}

namespace {

// Of a frame in which nothing moved: everything is as before.
PairParts unmoved_parts(const Scene& scene, const PairMemory& memory) {
  PairParts out;
  out.rest.objects.assign(scene.objects.size(), Box::empty());
  out.rest.pairs = memory.object_pairs;
  out.rest.self = memory.self;
  out.runs.kept = memory.pairs;
  out.runs.overlaps = memory.overlaps;
  out.runs.meetings = memory.meetings;
  out.runs.triangles = memory.triangles;
  return out;
}

}  // namespace

PairParts split_next_frame(const Scene& scene, unsigned threads, bool all, PairMemory& memory) {
  const double clearance = memory.clearance;
  if (!memory.moved.any()) return unmoved_parts(scene, memory);
  const bool ordered = memory.runs != nullptr;
  if (!ordered) {
    memory.runs = std::make_shared<Runs>(make_ordered_runs(scene, clearance, threads));
  } else if (memory.runs.use_count() > 1) {  // somebody has the last frame's plan
    memory.runs = std::make_shared<Runs>(*memory.runs);
  }
  Runs& runs = *memory.runs;
  const std::size_t n = runs.runs.size();
  std::vector<std::uint8_t> moved(n, 0);
  for_chunks(n, chunks_for(n, 256, threads), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Run& run = runs.runs[k];
      std::uint8_t any = 0;
      for (std::uint32_t i = 0; i < run.count; ++i) {
        any |= memory.moved.triangle(scene, runs.triangle(run.first + i));
      }
      moved[k] = any;
    }
  });
  if (ordered) update_boxes(scene, clearance, moved, threads, runs);
  const Meetings meetings = meetings_of(scene, runs, memory.ignored);
  if (is_uneven(runs, meetings)) return joined(scene, runs, meetings, Reason::join_uneven, 0);
  if (meetings.crowded)
    return {.runs = {}, .rest = pair_regions(scene, clearance, false, threads, memory.ignored)};
  PairParts out = split(scene, meetings, boxes_of_meetings(runs, meetings.all), clearance, threads,
                        all, memory.runs);
  if (out.rest.triangles.empty() && !out.runs.empty()) {
    keep_unmoved(scene, moved, memory.pairs, out.runs);
  }
  return out;
}

std::vector<TrianglePair> pairs_of_runs(const Scene& scene, const RunMeetings& meetings,
                                        double clearance, bool neighbours, unsigned threads) {
  if (meetings.between.empty() && meetings.inside.empty()) return meetings.kept;
  std::vector<TrianglePair> found = pairs_of_some(scene, meetings, meetings.between,
                                                  meetings.inside, clearance, neighbours, threads);
  if (meetings.kept.empty()) return found;
  std::vector<TrianglePair> out;
  out.reserve(found.size() + meetings.kept.size());
  std::ranges::merge(found, meetings.kept, std::back_inserter(out));
  return out;
}

}  // namespace farcull
