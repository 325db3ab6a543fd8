// The chapter of the study "libraries": what each contestant missed, reported wrongly, refused or
// crashed at, on a suite of labelled pairs and meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/peers/score.h"
#include "experiments/report/chapters/library_examples.h"
#include "experiments/report/chapters/library_findings.h"
#include "experiments/report/chapters/library_rows.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr const char* kReference = "far-pairs";  // stands beside all others in figures

// Per million of what was answered; "0" is none at all.
std::string per_million(std::uint64_t count, std::uint64_t of) {
  if (of == 0) return "-";
  if (count == 0) return "0";
  return rounded(1e6 * static_cast<double>(count) / static_cast<double>(of));
}

double ms_in_all(const Rows& rows) {
  double ms = 0;
  for (const Row* row : rows) ms += time_of(*row, "total").value_or(0);
  return ms;
}

std::string ns_per_pair(const Rows& rows) {
  const double ms = ms_in_all(rows);
  const std::uint64_t pairs = total(rows, "timed");
  return pairs == 0 ? "-" : rounded(1e6 * ms / static_cast<double>(pairs));
}

// Missed and wrong by each measure, per million.
std::vector<std::string> rates_of_pairs(const Rows& rows) {
  const std::uint64_t own = total(rows, "own_asked"), all = total(rows, "answered");
  return {per_million(total(rows, "own_missed"), own), per_million(total(rows, "own_wrong"), own),
          per_million(total(rows, "missed"), all), per_million(total(rows, "wrong"), all)};
}
std::vector<std::string> rates_of_meshes(const Rows& rows) {
  std::vector<std::string> out;
  for (const bool own : {true, false}) {
    const MeshAnswers of = mesh_answers(rows, own);
    out.push_back(per_million(of.missed, of.colliding));
    out.push_back(per_million(of.false_alarms, of.reported));
  }
  return out;
}

DataTable overview(const std::string& name, const Rows& rows, bool pairs) {
  const std::string of_pairs =
      "Pairs of triangles: missed (they meet, and it says apart) and false alarms (they are apart, "
      "and it says that they meet), per million of the pairs that were answered";
  const std::string of_meshes =
      "Meshes: the colliding pairs of all meshes that were asked, and the pairs that were "
      "reported; "
      "missed per million of the colliding pairs of those meshes that were answered, false alarms "
      "per million of the reported pairs, since nobody counts the pairs of a mesh that are apart. "
      "Both rates are given";
  std::vector<std::string> numbers = {
      "missed, own", "false, own", "missed",
      "false",       "refused",    "unanswered",
      "deaths",      "differs",    pairs ? "ns a pair" : "ms in all"};
  const std::vector<std::string> counts =
      pairs ? std::vector<std::string>{"asked"} : std::vector<std::string>{"colliding", "reported"};
  numbers.insert(numbers.begin(), counts.begin(), counts.end());
  DataTable out{.name = name,
                .caption = (pairs ? of_pairs : of_meshes) +
                           ", first by what the documentation of each promises, then by closed "
                           "triangles. Counts" +
                           (pairs ? "" : " of meshes") +
                           ": refused; without an answer, or not asked after too "
                           "many deaths; crashed, a hang or a lack of memory among them; answered "
                           "otherwise the second time",
                .columns = columns({"contestant", "library", "measured as"}, numbers)};
  for (const NamedRows& one : rows_by_contestant(rows)) {
    const Rows& of = one.rows;
    std::vector<std::string>& cells = out.rows.emplace_back();
    cells = {of.front()->point.method, text_of(*of.front(), "library"),
             text_of(*of.front(), "means"), grouped(total(of, "asked"))};
    if (!pairs) cells.push_back(grouped(mesh_answers(of, false).reported));
    const std::vector<std::string> rates = pairs ? rates_of_pairs(of) : rates_of_meshes(of);
    cells.insert(cells.end(), rates.begin(), rates.end());
    cells.insert(
        cells.end(),
        {grouped(total(of, "refused")), grouped(total(of, "unanswered") + total(of, "not_asked")),
         grouped(deaths(of)), differing(of), pairs ? ns_per_pair(of) : rounded(ms_in_all(of))});
  }
  return out;
}

// Families against contestants.
DataTable families_table(const Rows& rows) {
  DataTable out{
      .name = "libraries-families",
      .caption =
          "Missed / false alarms per million answers and refused / deaths per million pairs "
          "that were asked, of each family, by closed triangles; of meshes the counts",
      .columns = {text_column("contestant")}};
  std::vector<std::string> families;
  for (const Row* row : rows) {
    const std::string family = family_of(*row);
    if (std::find(families.begin(), families.end(), family) == families.end())
      families.push_back(family);
  }
  for (const std::string& family : families) out.columns.push_back(text_column(family));
  for (const NamedRows& one : rows_by_contestant(rows)) {
    std::vector<std::string>& cells = out.rows.emplace_back();
    cells.push_back(one.rows.front()->point.method);
    for (const std::string& family : families) {
      Rows of;
      for (const Row* row : one.rows) {
        if (family_of(*row) == family) of.push_back(row);
      }
      const bool pairs = family.starts_with("pairs/");
      const std::uint64_t asked = pairs ? total(of, "asked") : 1'000'000,
                          said = pairs ? total(of, "answered") : asked;
      cells.push_back(of.empty() || (pairs && asked == 0)
                          ? "-"
                          : fmt::format("{} / {} / {} / {}", per_million(total(of, "missed"), said),
                                        per_million(total(of, "wrong"), said),
                                        per_million(total(of, "refused"), asked),
                                        per_million(deaths(of), asked)));
    }
  }
  out.in_text = false;
  return out;
}

// Kinds of contact against contestants.
DataTable kinds_table(const Rows& rows) {
  const std::vector<std::string> kinds = {"apart",      "touch-vertex",    "touch-edge",
                                          "touch-face", "crossing",        "coplanar",
                                          "equal",      "neighbours-meet", "neighbours-apart"};
  DataTable out{
      .name = "libraries-kinds",
      .caption =
          "Wrong answers (missed or false alarms) per million answers about pairs of each kind of "
          "contact, degenerate triangles among them; -: none was asked",
      .columns = columns({"contestant"}, kinds)};
  for (const NamedRows& one : rows_by_contestant(rows)) {
    std::map<std::string, Score> sums;
    for (const Row* row : one.rows) {
      for (const Score& score : parse_scores(text_of(*row, "scores"))) add(score, sums[score.kind]);
    }
    std::vector<std::string>& cells = out.rows.emplace_back();
    cells.push_back(one.rows.front()->point.method);
    for (const std::string& kind : kinds) {
      const Score& sum = sums[kind];
      cells.push_back(per_million(sum.missed + sum.wrong, sum.answered));
    }
  }
  return out;
}

DataTable calls_table(const Rows& rows) {
  DataTable out{
      .name = "libraries-calls",
      .caption =
          "How each was called, what its documentation says of exactness and of "
          "touching, where it says that, and where it is right to be used",
      .columns = columns({"contestant", "library", "called", "says", "source", "use"}, {})};
  for (const NamedRows& one : rows_by_contestant(rows)) {
    const Row& row = *one.rows.front();
    out.rows.push_back({row.point.method, text_of(row, "library"), text_of(row, "call"),
                        text_of(row, "says"), text_of(row, "source"), text_of(row, "use")});
  }
  return out;
}

// Of each library's contestant the example with the fewest characters, for each kind of fault.
std::vector<LibraryExample> examples_of(const Rows& rows) {
  std::vector<LibraryExample> out;
  for (const NamedRows& one : rows_by_contestant(rows)) {
    if (is_ours(*one.rows.front())) continue;
    for (const auto& [fault, count] :
         {std::pair{"missed", "missed"}, {"false", "wrong"}, {"death", "death"}}) {
      LibraryExample best;
      for (const Row* row : one.rows) {
        const std::string line = text_of(*row, std::string("example_") + count);
        const LibraryExample next{row->point.method, fault, family_of(*row), line};
        if (line.empty() || (!best.line.empty() && digits_of(next) >= digits_of(best))) continue;
        best = next;
      }
      if (!best.line.empty()) out.push_back(best);
    }
  }
  return out;
}

DataTable all_table(const Rows& rows) {
  DataTable out = table_of_rows(
      "libraries-all",
      "Every contestant on every family and mesh; of a mesh, asked are its colliding pairs", rows,
      {scene_column(),
       {text_column("contestant"), [](const Row& row) { return row.point.method; }},
       count_column("asked", "asked"),
       count_column("missed, own", "own_missed"),
       count_column("false, own", "own_wrong"),
       count_column("missed", "missed"),
       count_column("false", "wrong"),
       count_column("refused", "refused"),
       count_column("unanswered", "unanswered"),
       count_column("crashed", "crashed"),
       count_column("hung", "hung"),
       count_column("no memory", "no_memory"),
       count_column("first missed", "first_missed"),
       count_column("first false", "first_wrong"),
       count_column("first death", "first_death"),
       {text_column("first reason"), [](const Row& row) { return text_of(row, "reason"); }}});
  out.in_text = false;
  return out;
}

// Contestants that stand in one panel, by the first word of their library; the last group takes the
// others.
struct Group {
  const char* title;
  std::vector<std::string> libraries;
};
const std::vector<Group>& groups() {
  static const std::vector<Group> all = {
      {"farcull", {"farcull"}},
      {"libraries for simulation", {"FCL", "Bullet", "ODE", "libccd"}},
      {"libraries for meshes", {"CGAL", "GTS", "VTK", "Open3D", "three-mesh-bvh"}},
      {"tests of papers, others", {}}};
  return all;
}
std::size_t group_of(const NamedRows& one) {
  const std::string library = text_of(*one.rows.front(), "library");
  const std::string word = library.substr(0, library.find(' '));
  for (std::size_t g = 0; g < groups().size(); ++g) {
    const std::vector<std::string>& of = groups()[g].libraries;
    if (of.empty() || std::find(of.begin(), of.end(), word) != of.end()) return g;
  }
  return groups().size() - 1;
}

// The mean time of a pair, and wrong answers: a point. Empty: there is none.
std::optional<Series> time_series(const NamedRows& one) {
  const double ms = ms_in_all(one.rows);
  const auto said = static_cast<double>(total(one.rows, "answered")),
             timed = static_cast<double>(total(one.rows, "timed"));
  if (said == 0 || ms == 0) return std::nullopt;
  const auto errors = static_cast<double>(total(one.rows, "missed") + total(one.rows, "wrong"));
  const Row& row = *one.rows.front();
  return Series{.name = row.point.method,
                .x = {1e6 * ms / timed},
                .y = {1e6 * errors / said},
                .style = Series::Style::points,
                .emphasis = row.point.method == kReference};
}

// A panel for each group; the reference stands in all of them.
Figure time_figure(const Rows& rows) {
  Figure out{.name = "libraries-time",
             .title = "Wrong answers against time",
             .caption = fmt::format(
                 "Wrong answers, missed or false alarms, by closed triangles, over the mean time "
                 "of a question as the contestant's own process measured it. {} stands in every "
                 "panel. Neighbours are asked of those alone that know them.",
                 kReference)};
  for (std::size_t g = 0; g < groups().size(); ++g) {
    Panel panel{.title = groups()[g].title,
                .x = logarithmic("time of a pair (ns)"),
                .y = logarithmic("wrong answers per million", true)};
    panel.x.from = 50;
    panel.x.to = 2e6;
    panel.y.to = 1e6;
    bool any = false;
    for (const NamedRows& one : rows_by_contestant(rows)) {
      const bool here = group_of(one) == g;
      if (!here && one.rows.front()->point.method != kReference) continue;
      std::optional<Series> series = time_series(one);
      any = any || (here && series);
      if (series) panel.series.push_back(std::move(*series));
    }
    if (any) out.panels.push_back(std::move(panel));
  }
  return out;
}

// Errors over the parameter of a family, of the contestants of a group that err there.
Panel parameter_panel(const Rows& rows, std::size_t group, const std::string& family,
                      const std::string& label) {
  Panel out{.title = family + ", " + groups()[group].title,
            .x = logarithmic(label, true),
            .y = logarithmic("wrong answers per million", true)};
  out.y.from = 0;
  out.y.to = 1e6;
  for (const NamedRows& one : rows_by_contestant(rows)) {
    if (group_of(one) != group) continue;
    std::map<double, Score> by_parameter;
    for (const Row* row : one.rows) {
      if (family_of(*row) != "pairs/" + family) continue;
      for (const Score& score : parse_scores(text_of(*row, "scores")))
        add(score, by_parameter[std::abs(score.parameter)]);
    }
    Series series{.name = one.rows.front()->point.method};
    bool errs = false;
    for (const auto& [parameter, sum] : by_parameter) {
      if (sum.answered == 0) continue;
      errs = errs || sum.missed + sum.wrong > 0;
      series.x.push_back(parameter);
      series.y.push_back(1e6 * static_cast<double>(sum.missed + sum.wrong) /
                         static_cast<double>(sum.answered));
    }
    if (errs) out.series.push_back(std::move(series));
  }
  return out;
}

// A figure for each family; a panel for each group of contestants.
void add_parameter_figures(const Rows& rows, Chapter& chapter) {
  for (const auto& [family, label] : std::vector<std::pair<const char*, const char*>>{
           {"slivers", "length over width"},
           {"gap-face", "gap, in sizes"},
           {"far-away", "distance from the origin, in sizes"}}) {
    Figure out{.name = std::string("libraries-") + family,
               .title = fmt::format("Wrong answers against the parameter of {}", family),
               .caption =
                   "Wrong answers, missed or false alarms, per million of those to pairs with that "
                   "parameter, without its sign; contestants without an error in this family are "
                   "left out."};
    for (std::size_t g = 0; g < groups().size(); ++g) {
      Panel panel = parameter_panel(rows, g, family, label);
      if (!panel.series.empty()) out.panels.push_back(std::move(panel));
    }
    if (!out.panels.empty()) chapter.figures.push_back(std::move(out));
  }
}

}  // namespace

Chapter libraries_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const Rows all = measured(stored), pairs = rows_about(all, true), meshes = rows_about(all, false);
  find_in_libraries(all, out);
  out.limits = {
      "The families are made to be hard. A rate here is no rate on the scenes of a user: the table "
      "says which questions a contestant gets wrong, not how often they come.",
      "Where the documentation of a library does not say whether touching counts, it is measured "
      "first by the pairs that cross or are apart. Where it does not take degenerate triangles, "
      "they are left out of that measure.",
      "The time of a pair includes what the call needs, such as the making of a mesh of one "
      "triangle; a library made for meshes looks slow on pairs."};
  add_gaps(stored, out);
  if (all.empty()) return out;
  if (!pairs.empty()) {
    out.tables.push_back(overview("libraries", pairs, true));
    out.tables.push_back(kinds_table(pairs));
    add_examples(examples_of(pairs), out);
    const Figure time = time_figure(pairs);
    if (!time.panels.empty()) out.figures.push_back(time);
    add_parameter_figures(pairs, out);
  }
  if (!meshes.empty()) out.tables.push_back(overview("libraries-meshes", meshes, false));
  out.tables.push_back(calls_table(all));
  out.tables.push_back(families_table(all));
  out.tables.push_back(all_table(all));
  return out;
}

}  // namespace farcull
