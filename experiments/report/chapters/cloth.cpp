// The chapter of the study "cloth": what the simulation did in each frame at each stiffness, and
// which pairs were found and missed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "core/view/view.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// The frames at one stiffness, those of a method by number.
struct Course {
  std::string stiffness;  // N/m, as in the name of the scene
  std::map<long, const Row*> pairs, far;
  long wanted = 0;  // frames of the grid

  std::string name() const { return stiffness + " N/m"; }
};

std::string stiffness_of(const PointKey& point) {
  const std::vector<std::string> words = split_list(point.scene, ':');
  return words.size() > 2 ? words[2] : "";
}

std::vector<Course> courses_of(const StoredStudy& stored) {
  std::map<std::string, Course> by_stiffness;
  for (const PointKey& point : stored.declaration.points)
    by_stiffness[stiffness_of(point)].wanted += point.method == "far-pairs";
  for (const Row* row : measured(stored)) {
    Course& course = by_stiffness[stiffness_of(row->point)];
    (row->point.method == "far" ? course.far : course.pairs)[row->point.frame] = row;
  }
  std::vector<Course> out;
  for (auto& [stiffness, course] : by_stiffness) {
    course.stiffness = stiffness;
    if (!course.pairs.empty()) out.push_back(std::move(course));
  }
  return out;
}

Rows rows_of(const std::map<long, const Row*>& frames) {
  Rows out;
  for (const auto& [frame, row] : frames) out.push_back(row);
  return out;
}

// Joules by which the total energy of a frame exceeds that of the frame before and the work of the
// forces that its step left unbalanced, for each frame whose frame before is there.
std::vector<double> gains(const Course& course) {
  std::vector<double> out;
  const Row* before = nullptr;
  for (const auto& [frame, row] : course.pairs) {
    if (before != nullptr && before->point.frame == frame - 1) {
      out.push_back(count_or_none(*row, "total") - count_or_none(*before, "total") -
                    count_or_none(*row, "slack"));
    }
    before = row;
  }
  return out;
}

std::size_t count_if_not(const Rows& rows, const char* flag) {
  return static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [&](const Row* row) { return !flag_of(*row, flag); }));
}

// By nearest rank.
double percentile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

std::vector<double> values_of(const Rows& rows, const char* count) {
  std::vector<double> out;
  for (const Row* row : rows) out.push_back(count_or_none(*row, count));
  return out;
}

Series over_frames(const std::string& name, const std::map<long, const Row*>& frames,
                   const std::function<double(const Row&)>& value) {
  Series out{.name = name, .style = Series::Style::lines};
  for (const auto& [frame, row] : frames) {
    out.x.push_back(static_cast<double>(frame));
    out.y.push_back(value(*row));
  }
  return out;
}

Figure energy_figure(const std::vector<Course>& courses) {
  Figure out{.name = "cloth-energy",
             .title = "Energy of the cloth, frame by frame",
             .caption =
                 "Left: kinetic energy and all potentials, where 0 is a cloth at rest at the "
                 "height of the middle of the sphere. Right: iterations of the solver. One "
                 "simulation of each stiffness."};
  Panel energy{.title = "total energy", .x = {.label = "frame"}, .y = {.label = "J"}};
  Panel work{.title = "work of a step",
             .x = {.label = "frame"},
             .y = {.label = "factorizations", .from = 0}};
  for (const Course& course : courses) {
    for (const auto& [panel, count] :
         {std::pair(&energy, "total"), std::pair(&work, "iterations")}) {
      panel->series.push_back(
          over_frames(course.name(), course.pairs,
                      [name = count](const Row& row) { return count_or_none(row, name); }));
    }
  }
  out.panels = {std::move(energy), std::move(work)};
  return out;
}

Figure pairs_figure(const std::vector<Course>& courses) {
  Figure out{.name = "cloth-pairs",
             .title = "Pairs of triangles of the cloth and the sphere, frame by frame",
             .caption =
                 "Pairs that collide, neighbours that do among them, and the candidates that "
                 "culling leaves to exact predicates. Most candidates are neighbours, which both "
                 "methods hand to the predicates: a triangle of the grid shares a vertex with "
                 "twelve others."};
  for (const Course& course : courses) {
    const auto count = [](const char* name) {
      return [name](const Row& row) { return count_or_none(row, name); };
    };
    Panel panel{.title = course.name(),
                .x = {.label = "frame"},
                .y = logarithmic("pairs", true),
                .series = {over_frames("FAR pairs", course.pairs, count("candidates")),
                           over_frames("FAR (OBB)", course.far, count("candidates")),
                           over_frames("colliding", course.pairs, count("colliding"))}};
    panel.series[1].style = Series::Style::points;
    panel.series[0].emphasis = true;
    out.panels.push_back(std::move(panel));
  }
  return out;
}

DataTable table_of(const std::vector<Course>& courses) {
  DataTable out{
      .name = "cloth",
      .caption =
          "Each stiffness: frames that were simulated and accounted for, steps that did not "
          "converge, factorizations of a step, the largest force that a step left "
          "unbalanced, the total energy of the first frame and of the last, frames in which "
          "triangles collide, the most pairs in one, and all pairs that were accounted for",
      .columns =
          columns({"stiffness (N/m)"},
                  {"frames", "of", "failed", "median", "p95", "most", "residual (N)", "first (J)",
                   "last (J)", "frames that collide", "most pairs", "accounted", "missed"})};
  for (const Course& course : courses) {
    const Rows rows = rows_of(course.pairs), far = rows_of(course.far);
    const std::vector<double> iterations = values_of(rows, "iterations");
    const auto collide = std::count_if(
        rows.begin(), rows.end(), [](const Row* row) { return number_of(*row, "colliding") > 0; });
    out.rows.push_back(
        {course.stiffness, grouped(rows.size()), grouped(static_cast<std::uint64_t>(course.wanted)),
         grouped(count_if_not(rows, "converged")), rounded(median(iterations)),
         rounded(percentile(iterations, 0.95)), rounded(percentile(iterations, 1)),
         fmt::format("{:.2g}", largest(rows, "residual", 0)),
         rounded(count_or_none(*rows.front(), "total")),
         rounded(count_or_none(*rows.back(), "total")),
         grouped(static_cast<std::uint64_t>(collide)), rounded(largest(rows, "colliding", 0), 6),
         grouped(total(rows, "accounted") + total(far, "accounted")),
         grouped(total(rows, "missed") + total(far, "missed"))});
  }
  return out;
}

void add_energy(const Course& course, Chapter& chapter) {
  const std::vector<double> of = gains(course);
  const auto bad = std::count_if(of.begin(), of.end(), [](double gain) { return !(gain <= 0); });
  if (of.empty()) return;
  if (bad == 0) {
    chapter.find(fmt::format(
        "At {} the total energy never grew by more than the work of the forces that a step left "
        "unbalanced ({} steps).",
        course.name(), grouped(of.size())));
  } else {
    chapter.find_broken(fmt::format(
        "At {} the total energy grew by more than the unbalanced forces can do in {} of {} steps, "
        "by up to {:.3g} J.",
        course.name(), bad, grouped(of.size()), *std::max_element(of.begin(), of.end())));
  }
}

// Both methods look at every tenth frame, and have to find the same pairs.
void add_agreement(const std::vector<Course>& courses, Chapter& chapter) {
  std::size_t both = 0, differ = 0;
  for (const Course& course : courses) {
    for (const auto& [frame, row] : course.far) {
      const auto at = course.pairs.find(frame);
      if (at == course.pairs.end()) continue;
      ++both;
      differ += number_of(*row, "colliding") != number_of(*at->second, "colliding") ||
                count_or_none(*row, "total") != count_or_none(*at->second, "total");
    }
  }
  if (differ > 0) {
    chapter.find_broken(fmt::format(
        "FAR and FAR pairs found different numbers of pairs, or saw different cloths, in {} of {} "
        "frames.",
        differ, both));
  } else if (both > 0) {
    chapter.find(
        fmt::format("FAR and FAR pairs found the same number of colliding pairs in each of "
                    "the {} frames that both looked at.",
                    grouped(both)));
  }
}

}  // namespace

Chapter cloth_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const std::vector<Course> courses = courses_of(stored);
  add_promises(stored, out);
  for (const Course& course : courses) {
    const std::size_t failed = count_if_not(rows_of(course.pairs), "converged");
    if (failed > 0) {
      out.find_broken(fmt::format("At {} {} of {} steps did not converge.", course.name(), failed,
                                  grouped(course.pairs.size())));
    }
    add_energy(course, out);
  }
  add_agreement(courses, out);
  for (const Course& course : courses) {
    if (static_cast<long>(course.pairs.size()) == course.wanted) continue;
    out.find(fmt::format("At {} {} of {} frames have been run.", course.name(),
                         grouped(course.pairs.size()), course.wanted));
  }
  out.limits = {
      "One cloth, one fall: the settings are those of docs/cloth.md, and only the stiffness of the "
      "springs differs.",
      "The cloth does not resist itself, so that its folds pass through each other.",
      "The study is not among `farcull experiment all`, since it takes hours on one core."};
  add_gaps(stored, out);
  if (courses.empty()) return out;
  out.figures = {energy_figure(courses), pairs_figure(courses)};
  out.tables = {table_of(courses)};
  return out;
}

}  // namespace farcull
