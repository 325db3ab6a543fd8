// The chapter of the study "error-time": errors and false positives against time, the Pareto front
// of each scene, and CULLIDE in the time that FAR takes.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// A contestant at a resolution, on a scene or on several drawn alike with different seeds.
struct Entry {
  const Row* row = nullptr;   // of the first seed
  std::vector<double> times;  // ms: of each run, or of several seeds the median of each
  Estimate median_ms;         // of them
  std::uint64_t missed = 0, wrong = 0, colliding = 0, candidates = 0;  // of all seeds
  bool has_candidates = true;

  double ms() const { return median_ms.value; }
  // Pairs that the answer lacks plus pairs in it that do not collide.
  double error() const { return static_cast<double>(missed + wrong); }
};
using Entries = std::vector<Entry>;

struct TimedGroup {
  std::string name;
  std::size_t seeds = 0;
  Entries entries;
};

Entry entry_of(const Rows& rows) {
  Entry out;
  out.row = rows.front();
  for (const Row* row : rows) {
    out.times.push_back(*time_of(*row, "total"));
    out.missed += number_of(*row, "missed");
    out.wrong += number_of(*row, "wrong");
    out.colliding += number_of(*row, "colliding");
    out.candidates += number_of(*row, "candidates");
    out.has_candidates = out.has_candidates && count_of(*row, "candidates");
  }
  if (rows.size() == 1 && !runs_of(*rows.front()).empty()) out.times = runs_of(*rows.front());
  out.median_ms = median_estimate(out.times);
  return out;
}

// By scene without seeds; of each what was measured with all of them.
std::vector<TimedGroup> groups_of(const std::vector<NamedRows>& scenes) {
  struct Gathered {
    std::string name;
    std::size_t seeds = 0;
    std::vector<std::pair<std::pair<std::string, int>, Rows>> rows;
  };
  std::vector<Gathered> gathered;
  for (const NamedRows& scene : scenes) {
    const std::string name = scene_base(scene.name);
    auto at = std::find_if(gathered.begin(), gathered.end(),
                           [&](const auto& one) { return one.name == name; });
    if (at == gathered.end()) at = gathered.insert(at, {name, 0, {}});
    ++at->seeds;
    for (const Row* row : scene.rows) {
      if (!time_of(*row, "total")) continue;
      const std::pair key(contestant(row->point), row->point.resolution);
      auto of = std::find_if(at->rows.begin(), at->rows.end(),
                             [&](const auto& one) { return one.first == key; });
      if (of == at->rows.end()) of = at->rows.insert(of, {key, {}});
      of->second.push_back(row);
    }
  }
  std::vector<TimedGroup> out;
  for (const Gathered& one : gathered) {
    TimedGroup group{.name = one.name, .seeds = one.seeds, .entries = {}};
    for (const auto& [key, rows] : one.rows) {
      if (rows.size() == one.seeds) group.entries.push_back(entry_of(rows));
    }
    out.push_back(std::move(group));
  }
  return out;
}

std::string seeds_text(const TimedGroup& group) {
  return group.seeds > 1 ? fmt::format(" ({} seeds)", group.seeds) : "";
}

// Entries that no other beats: none is as fast with as little error, and better in one of them.
// Fastest first; of equals the first.
Entries front_of(const TimedGroup& group) {
  Entries sorted = group.entries;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.ms(), a.error()) < std::pair(b.ms(), b.error());
  });
  Entries front;
  for (const Entry& entry : sorted) {
    if (front.empty() || entry.error() < front.back().error()) front.push_back(entry);
  }
  return front;
}

// The ratio of the medians of two entries of the same study, with its interval.
std::string times_as_long(const Entry& entry, const Entry& other) {
  return estimate_text(ratio_estimate(entry.times, other.times));
}

// "n = 57 points, each the median of 5 runs; of drawn scenes 5 seeds".
std::string sample_of(const std::vector<TimedGroup>& groups) {
  Rows rows;
  std::set<std::size_t> seeds;
  for (const TimedGroup& group : groups) {
    for (const Entry& entry : group.entries) rows.push_back(entry.row);
    if (group.seeds > 1) seeds.insert(group.seeds);
  }
  std::vector<std::string> numbers;
  for (const std::size_t n : seeds) numbers.push_back(std::to_string(n));
  return sample_text(rows) +
         (numbers.empty() ? "" : fmt::format("; of drawn scenes {} seeds", listed(numbers)));
}

// The peer that times are given against: CGAL's box join, which every build has.
const Entry* yardstick(const TimedGroup& group) {
  for (const Entry& entry : group.entries) {
    if (entry.row->point.method == "cgal-boxes") return &entry;
  }
  return nullptr;
}

std::string in_words(const Entry& entry) {
  std::string out = contestant(entry.row->point);
  if (entry.row->point.resolution > 0) out += fmt::format(" at {} px", entry.row->point.resolution);
  return out;
}

double kept_for_nothing(const Entry& entry) {
  if (!entry.has_candidates || entry.colliding == 0) return kNone;
  const auto found = static_cast<double>(entry.colliding - entry.missed);
  return (static_cast<double>(entry.candidates) - found) / static_cast<double>(entry.colliding);
}

Panel panel_of(const TimedGroup& group, const std::string& label, double (*value)(const Entry&)) {
  Panel panel{.title = group.name + seeds_text(group),
              .x = logarithmic("time (ms)"),
              .y = logarithmic(label, true)};
  for (const Entry& entry : group.entries) {
    const std::string name = contestant(entry.row->point);
    if (name.find("all views") != std::string::npos) continue;  // so that the key stays short
    auto at = std::find_if(panel.series.begin(), panel.series.end(),
                           [&](const Series& series) { return series.name == name; });
    if (at == panel.series.end()) {
      at = panel.series.insert(at, {.name = name, .style = Series::Style::points});
      at->emphasis = name == "FAR (OBB)" || name == "FAR pairs";
    } else if (entry.row->point.resolution > 0) {
      at->style = Series::Style::lines_points;  // lines follow the resolution
    }
    // What chooses its resolution is no point of the line.
    const bool chosen = entry.row->point.resolution <= 0;
    const auto add_gap = [&] {
      for (auto* values : {&at->x, &at->x_low, &at->x_high, &at->y}) values->push_back(kNone);
    };
    if (chosen && !at->x.empty()) add_gap();
    const bool bar = entry.median_ms.n > 1;
    at->x.push_back(entry.ms());
    at->x_low.push_back(bar ? entry.median_ms.low : kNone);
    at->x_high.push_back(bar ? entry.median_ms.high : kNone);
    at->y.push_back(value(entry));
    if (chosen) add_gap();
  }
  return panel;
}

// The front as a staircase from its fastest entry to the slowest of the panel.
Series front_series(const TimedGroup& group) {
  Series out{.name = "Pareto front", .style = Series::Style::lines};
  double last = 0;
  for (const Entry& entry : group.entries) last = std::max(last, entry.ms());
  for (const Entry& entry : front_of(group)) {
    if (!out.y.empty()) {
      out.x.push_back(entry.ms());
      out.y.push_back(out.y.back());
    }
    out.x.push_back(entry.ms());
    out.y.push_back(entry.error());
  }
  if (!out.x.empty()) {
    out.x.push_back(last);
    out.y.push_back(out.y.back());
  }
  return out;
}

std::vector<Figure> figures_of(const std::vector<TimedGroup>& groups) {
  Figure error{
      .name = "error-time",
      .title = "Wrong answers against run time",
      .caption =
          "Pairs that are missed plus pairs that are reported and do not collide, over "
          "the median time from triangles to pairs, with its 95 % interval as a bar. Lines follow "
          "the resolution. Of scenes that are drawn with several seeds, the sum of the errors and "
          "the median of the times. The Pareto front joins what nothing beats in both. Forms in "
          "which "
          "all views have to clear are in the table. " +
          sample_of(groups) + "."};
  Figure kept{
      .name = "error-time-false-positives",
      .title = "Candidates that do not collide against run time",
      .caption =
          "Candidates that are handed to exact tests and do not collide, over colliding "
          "pairs. FCL and ODE use their own tests of triangles instead of exact tests, so "
          "what they hand on is their answer. Bars are the 95 % intervals of median times; " +
          sample_of(groups) + "."};
  for (const TimedGroup& group : groups) {
    error.panels.push_back(
        panel_of(group, "missed + wrong pairs", [](const Entry& entry) { return entry.error(); }));
    error.panels.back().series.push_back(front_series(group));
    kept.panels.push_back(panel_of(group, "false positives / colliding", kept_for_nothing));
  }
  return {std::move(error), std::move(kept)};
}

DataTable front_table(const std::vector<TimedGroup>& groups) {
  DataTable out{.name = "error-time-front",
                .caption =
                    "The Pareto fronts: nothing is as fast with as few errors. Times are ratios of "
                    "medians with their 95 % intervals. " +
                    sample_of(groups),
                .columns = columns({"scene", "method"}, {"time over that of cgal-boxes", "missed",
                                                         "wrong", "colliding"})};
  for (const TimedGroup& group : groups) {
    const Entry* const peer = yardstick(group);
    for (const Entry& entry : front_of(group)) {
      out.rows.push_back({group.name, in_words(entry),
                          peer != nullptr ? times_as_long(entry, *peer) : "-",
                          grouped(entry.missed), grouped(entry.wrong), grouped(entry.colliding)});
    }
  }
  return out;
}

// ---- equal time ----

// FAR at a resolution, and of the runs of CULLIDE, in any form and at any resolution, that took no
// longer, the one with the fewest errors. Null where none was as fast.
struct EqualTime {
  const Entry* far = nullptr;
  const Entry* cullide = nullptr;
};

std::vector<EqualTime> equal_times(const TimedGroup& group) {
  std::vector<EqualTime> out;
  for (const Entry& far : group.entries) {
    if (contestant(far.row->point) != "FAR (OBB)") continue;
    EqualTime one{.far = &far};
    for (const Entry& entry : group.entries) {
      if (entry.row->point.method.find("cullide") == std::string::npos || entry.ms() > far.ms())
        continue;
      if (one.cullide == nullptr || entry.error() < one.cullide->error()) one.cullide = &entry;
    }
    out.push_back(one);
  }
  return out;
}

DataTable equal_table(const std::vector<TimedGroup>& groups) {
  DataTable out{
      .name = "error-time-equal",
      .caption =
          "CULLIDE in the time that FAR takes: of all its forms and resolutions whose "
          "median time is no longer, the one with the fewest errors. Candidates are what each "
          "leaves to exact tests: a form that leaves as "
          "many as boxes alone has culled nothing",
      .columns = columns({"scene"}, {"FAR (OBB) at (px)", "ms", "its candidates"},
                         {"CULLIDE within it"}, {"its ms", "its candidates", "missed by CULLIDE"})};
  for (const TimedGroup& group : groups) {
    for (const EqualTime& one : equal_times(group)) {
      out.rows.push_back(
          {group.name, std::to_string(one.far->row->point.resolution), rounded(one.far->ms()),
           grouped(one.far->candidates),
           one.cullide != nullptr ? in_words(*one.cullide) : "none is as fast",
           one.cullide != nullptr ? rounded(one.cullide->ms()) : "-",
           one.cullide != nullptr ? grouped(one.cullide->candidates) : "-",
           one.cullide != nullptr ? of_all(one.cullide->missed, one.cullide->colliding) : "-"});
    }
  }
  return out;
}

// Adds, for each scene, the fastest FAR and the best CULLIDE of the same time.
void add_equal_times(const std::vector<TimedGroup>& groups, Chapter& chapter) {
  std::size_t cases = 0, missing = 0, slower = 0;
  for (const TimedGroup& group : groups) {
    for (const EqualTime& one : equal_times(group)) {
      ++cases;
      slower += one.cullide == nullptr;
      missing += one.cullide != nullptr && one.cullide->missed > 0;
    }
  }
  if (cases == 0) return;
  chapter.find(fmt::format(
      "In the time that FAR (OBB) takes, the best CULLIDE (of all forms and resolutions that were "
      "measured) misses pairs in {} cases of scene and resolution of FAR{}.",
      of_all(missing, cases),
      slower > 0 ? fmt::format(", and no CULLIDE is as fast in {}", grouped(slower)) : ""));
  for (const TimedGroup& group : groups) {
    const std::vector<EqualTime> all = equal_times(group);
    const auto fastest = std::min_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
      return a.far->ms() < b.far->ms();
    });
    if (fastest == all.end() || fastest->cullide == nullptr) continue;
    chapter.find(fmt::format(
        "{}: FAR (OBB) is fastest at {} px ({} ms, {} missed); within that time "
        "{} misses the fewest, {} ({} ms).",
        group.name, fastest->far->row->point.resolution, rounded(fastest->far->ms()),
        of_all(fastest->far->missed, fastest->far->colliding), in_words(*fastest->cullide),
        of_all(fastest->cullide->missed, fastest->cullide->colliding),
        rounded(fastest->cullide->ms())));
  }
}

DataTable all_table(const Rows& rows) {
  const RowColumn wrong = {{"wrong"},
                           [](const Row& row) { return grouped(number_of(row, "wrong")); }};
  const RowColumn false_ones = {{"false positives"},
                                [](const Row& row) { return rounded(false_positives(row)); }};
  return table_of_rows("error-time-all",
                       "All points; times are medians with the fastest and slowest run", rows,
                       {scene_column(), contestant_column(), resolution_column("resolution", "-"),
                        time_column("ms", "total"), time_column("fastest", "total_min"),
                        time_column("slowest", "total_max"), count_column("missed", "missed"),
                        wrong, count_column("candidates", "candidates"),
                        count_column("colliding", "colliding"), false_ones});
}

// Adds the fastest method without an error, the next one, and what is faster with errors.
void add_front_finding(const TimedGroup& group, Chapter& chapter) {
  const Entries front = front_of(group);
  if (front.empty()) return;
  Entries right = group.entries;
  std::erase_if(right, [](const Entry& entry) { return entry.error() > 0; });
  if (right.empty()) {
    chapter.find("No method is without an error on " + group.name + ".");
    return;
  }
  const auto fastest = [](const Entries& entries) {
    return std::min_element(entries.begin(), entries.end(),
                            [](const Entry& a, const Entry& b) { return a.ms() < b.ms(); });
  };
  const Entry best = *fastest(right);
  std::erase_if(right, [&](const Entry& entry) {
    return contestant(entry.row->point) == contestant(best.row->point);
  });
  const auto next = fastest(right);
  chapter.find(fmt::format("Fastest method without an error on {}{}: {}, {} ms{}.", group.name,
                           seeds_text(group), in_words(best), rounded(best.ms()),
                           next != right.end()
                               ? fmt::format("; the next method, {}, takes {} times as long",
                                             in_words(*next), times_as_long(*next, best))
                               : ""));
  std::vector<std::string> faster;
  for (const Entry& entry : front) {
    if (entry.error() == 0) continue;
    faster.push_back(fmt::format("{} ({} wrong, {} ms)", in_words(entry),
                                 of_all(static_cast<std::uint64_t>(entry.error()), entry.colliding),
                                 rounded(entry.ms())));
  }
  if (faster.empty()) return;
  chapter.find(fmt::format("Faster on {}, with errors: {}.", group.name, listed(faster)));
}

// Adds the errors of libraries with a test of triangles of their own.
void add_narrow_findings(const Rows& rows, Chapter& chapter) {
  for (const char* name : {"fcl-float", "fcl-double", "ode-trimesh"}) {
    Rows of = rows;
    std::erase_if(of, [&](const Row* row) { return row->point.method != name; });
    if (of.empty()) continue;
    chapter.find(fmt::format(
        "{} misses {} colliding pairs and reports {} that do not collide, in {} scenes.",
        method_label(of.front()->point), of_all(of, "missed", "colliding"),
        grouped(total(of, "wrong")), grouped(of.size())));
  }
}

}  // namespace

Chapter error_time_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const Rows rows = measured(stored);
  const std::vector<NamedRows> scenes = rows_by_scene(stored);
  add_promises(stored, out);
  const std::vector<TimedGroup> groups = groups_of(scenes);
  add_equal_times(groups, out);
  for (const TimedGroup& group : groups) add_front_finding(group, out);
  add_narrow_findings(rows, out);
  out.limits = {
      "Times are one machine's. On a software device those of methods that draw say nothing about "
      "graphics hardware, and the front is another there.",
      "Every method may use all cores; FCL's traversal of two objects has one thread, and so has "
      "ODE.",
      "Embree and CGAL give candidates; they are right because exact tests follow, whose time is "
      "in theirs. What FCL and ODE take includes their own test of triangles.",
      "At equal time the form and the resolution of CULLIDE were chosen by the same runs that are "
      "shown, which favours CULLIDE.",
      "Contexts, shaders and Embree's device are made before; hierarchies and boxes belong to the "
      "run.",
      "On a scene tested against itself libraries leave pairs that share a vertex out, ours count "
      "those that collide beyond it. So on such a scene our times include the exact tests of all "
      "neighbours, which those of libraries do not. farcull bench leaves neighbours out for all."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = figures_of(groups);
  out.tables = {front_table(groups), equal_table(groups), all_table(rows)};
  if (out.tables[1].rows.empty()) out.tables.erase(out.tables.begin() + 1);
  return out;
}

}  // namespace farcull
