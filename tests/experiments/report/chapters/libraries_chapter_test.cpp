// The chapter of libraries on rows that were made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "experiments/peers/runner.h"
#include "experiments/peers/score.h"
#include "experiments/report/chapters/chapters.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/gnuplot.h"
#include "experiments/report/report.h"
#include "experiments/report/style.h"
#include "experiments/suite/writer.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

// Of 1,000 crossing pairs it refuses 500 and answers 500.
Json counts(bool ours, std::uint64_t missed) {
  const Score score{.kind = "crossing",
                    .asked = 1000,
                    .answered = 500,
                    .missed = missed,
                    .own_asked = 500,
                    .own_missed = missed,
                    .refused = ours ? 0u : 500u};
  return {{"asked", 1000},
          {"answered", 500},
          {"timed", 500},
          {"missed", missed},
          {"wrong", 0},
          {"own_asked", 500},
          {"own_missed", missed},
          {"own_wrong", 0},
          {"refused", ours ? 0 : 500},
          {"promises", ours},
          {"library", "x 1"},
          {"means", "closed"},
          {"scores", scores_text({score})}};
}

// Of 100 colliding pairs of a mesh it misses 10, and it reports 30 pairs that are apart. Its
// documentation speaks of 50 of the colliding pairs, of 5 of the missed and of 20 of those apart.
Json counts_of_mesh(bool ours) {
  return {{"asked", 100},
          {"answered", 100},
          {"missed", ours ? 0 : 10},
          {"wrong", ours ? 0 : 30},
          {"own_asked", 50},
          {"own_missed", ours ? 0 : 5},
          {"own_wrong", ours ? 0 : 20},
          {"promises", ours},
          {"library", ours ? "farcull" : "x 1"},
          {"means", "crossing"},
          {"scores", scores_text({{.kind = "mesh", .asked = 100}})}};
}

void add(StoredStudy& stored, const std::string& contestant, Json of,
         const std::string& scene = "small/pairs/random") {
  Row row;
  row.position = stored.rows.size();
  row.point.scene = scene;
  row.point.method = contestant;
  row.measurement.counts = std::move(of);
  row.measurement.times = {{"total", 1.0}};
  stored.declaration.study = "libraries";
  stored.declaration.points.push_back(row.point);
  stored.rows.push_back(row);
}

bool finds(const Chapter& chapter, const std::string& text) {
  return std::any_of(chapter.findings.begin(), chapter.findings.end(), [&](const Finding& finding) {
    return printed(finding).find(text) != std::string::npos;
  });
}
std::string all_findings(const Chapter& chapter) {
  std::string out;
  for (const Finding& finding : chapter.findings) out += printed(finding) + "\n";
  return out;
}

bool finds_broken(const Chapter& chapter) {
  return std::any_of(chapter.findings.begin(), chapter.findings.end(),
                     [](const Finding& finding) { return is_broken(finding); });
}

const DataTable& table(const Chapter& chapter, const std::string& name) {
  const auto at = std::find_if(chapter.tables.begin(), chapter.tables.end(),
                               [&](const DataTable& of) { return of.name == name; });
  if (at == chapter.tables.end()) throw std::logic_error("no table " + name);
  return *at;
}

std::string cell(const DataTable& of, std::size_t row, const std::string& column) {
  for (std::size_t c = 0; c < of.columns.size(); ++c) {
    if (of.columns[c].name == column) return of.rows.at(row).at(c);
  }
  return "no column " + column;
}

std::string example() {
  SuitePair pair;
  pair.kind = SuiteKind::crossing;
  pair.a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  pair.b = {Vec3(.25, .25, -1), Vec3(.25, .25, 1), Vec3(1e300, 2, 1)};
  return pair_line(pair);
}

TEST(LibrariesChapter, CountsRatesOfWhatWasAnswered) {
  StoredStudy stored;
  add(stored, "theirs", counts(false, 5));
  const Chapter chapter = libraries_chapter(stored);
  const DataTable& all = table(chapter, "libraries");
  EXPECT_EQ(cell(all, 0, "missed"), "10,000");  // of a million: 5 of 500, and not of 1,000
  EXPECT_EQ(cell(all, 0, "refused"), "500");
  EXPECT_EQ(cell(table(chapter, "libraries-kinds"), 0, "crossing"), "10,000");
  EXPECT_FALSE(finds_broken(chapter));
}

TEST(LibrariesChapter, AMissOrASilenceOfOursIsBroken) {
  StoredStudy right;
  Json answered = counts(true, 0);
  add(right, "far", answered);
  EXPECT_FALSE(finds_broken(libraries_chapter(right)));
  EXPECT_FALSE(breaks_promise(right.rows[0].measurement));
  StoredStudy missed;
  add(missed, "far", counts(true, 1));
  EXPECT_TRUE(finds_broken(libraries_chapter(missed)));
  for (const char* silence : {"refused", "unanswered", "crashed", "hung", "no_memory"}) {
    StoredStudy silent;
    answered = counts(true, 0);
    answered[silence] = 1;
    add(silent, "far", answered);
    EXPECT_TRUE(finds_broken(libraries_chapter(silent))) << silence;
    EXPECT_TRUE(breaks_promise(silent.rows[0].measurement)) << silence;
  }
}

TEST(LibrariesChapter, ExamplesAreATableAFigureAndAFileOfTheSuite) {
  StoredStudy stored;
  Json of = counts(false, 5);
  of["example_missed"] = example();
  add(stored, "theirs", of);
  add(stored, "others", counts(false, 0));
  const Chapter chapter = libraries_chapter(stored);
  const DataTable& examples = table(chapter, "libraries-examples");
  ASSERT_EQ(examples.rows.size(), 1u);
  EXPECT_EQ(cell(examples, 0, "kind"), "crossing");
  EXPECT_NE(cell(examples, 0, "coordinates").find("(0.25, 0.25, -1)"), std::string::npos);
  const auto drawn =
      std::find_if(chapter.figures.begin(), chapter.figures.end(),
                   [](const Figure& figure) { return figure.name == "libraries-examples-missed"; });
  ASSERT_NE(drawn, chapter.figures.end());
  const Panel& panel = drawn->panels.front();
  EXPECT_TRUE(panel.drawing) << "its axes would have no meaning";
  ASSERT_EQ(panel.series.size(), 2u);
  EXPECT_NE(panel.series[0].style, panel.series[1].style) << "in grey they would look the same";
  for (const Series& series : drawn->panels.front().series) {
    for (const double x : series.x) EXPECT_LT(std::abs(x), 2) << "it is drawn in a cube of size 1";
  }
  ASSERT_EQ(chapter.files.size(), 1u);
  const SuitePairs read = parse_pairs(chapter.files[0].text, chapter.files[0].name);
  ASSERT_EQ(read.pairs.size(), 1u);
  EXPECT_EQ(pair_line(read.pairs[0]), example());
  // The twin: what is no line of a pair is refused.
  of["example_missed"] = "0 0 - crossing 1 2 3";
  add(stored, "liars", of);
  EXPECT_THROW((void)libraries_chapter(stored), Error);
}

TEST(LibrariesChapter, FalseAlarmsOfMeshesAreAPartOfWhatWasReported) {
  StoredStudy stored;
  add(stored, "theirs", counts_of_mesh(false), "small/meshes/shells");
  const Chapter chapter = libraries_chapter(stored);
  const DataTable& meshes = table(chapter, "libraries-meshes");
  EXPECT_EQ(cell(meshes, 0, "colliding"), "100");
  EXPECT_EQ(cell(meshes, 0, "reported"), "120");  // 100 - 10 + 30
  EXPECT_EQ(cell(meshes, 0, "missed"), "100,000");
  EXPECT_EQ(cell(meshes, 0, "false"), "250,000");        // 30 of 120, and not of 100
  EXPECT_EQ(cell(meshes, 0, "missed, own"), "100,000");  // 5 of 50
  EXPECT_EQ(cell(meshes, 0, "false, own"), "307,692");   // 20 of 65
  EXPECT_TRUE(finds(chapter, "theirs (5 of 50, 20 of 65)")) << all_findings(chapter);
  // More false alarms than colliding pairs are still a part of what was reported.
  StoredStudy many;
  Json of = counts_of_mesh(false);
  of["own_wrong"] = 1000;
  add(many, "theirs", of, "small/meshes/shells");
  EXPECT_TRUE(finds(libraries_chapter(many), "theirs (5 of 50, 1,000 of 1,045)"));
}

// Without one colliding pair of which it promises the answer, it may still err.
TEST(LibrariesChapter, FalseAlarmsOfMeshesWithoutACollisionAreNotForgotten) {
  StoredStudy stored;
  Json of = counts_of_mesh(false);
  of["own_asked"] = of["own_missed"] = 0;
  add(stored, "theirs", of, "small/meshes/shells");
  EXPECT_TRUE(finds(libraries_chapter(stored), "theirs (0 of 0, 20 of 20)"));
}

TEST(LibrariesChapter, PairsAndPairsOfMeshesAreNotAdded) {
  StoredStudy stored;
  add(stored, "far", counts(true, 0));
  add(stored, "far", counts_of_mesh(true), "small/meshes/shells");
  add(stored, "far", counts_of_mesh(true), "small/meshes/folds");
  const Chapter chapter = libraries_chapter(stored);
  EXPECT_TRUE(finds(chapter,
                    "far missed none and reported none wrongly of 500 pairs, and of the 200 "
                    "colliding pairs of 2 meshes."))
      << all_findings(chapter);
  EXPECT_FALSE(finds(chapter, "700"));
  // The twin: what is broken names the one or the other too.
  Json of = counts_of_mesh(true);
  of["missed"] = 3;
  of["wrong"] = 4;
  add(stored, "far", of, "small/meshes/fans");
  const Chapter broken = libraries_chapter(stored);
  for (const char* part :
       {"BROKEN: far: 3 of the 300 colliding pairs of 3 meshes missed, and it promises none.",
        "BROKEN: far: 4 of the 301 pairs reported of 3 meshes are apart"})
    EXPECT_TRUE(finds(broken, part)) << all_findings(broken);
  EXPECT_FALSE(finds(broken, "missed none"));
}

TEST(LibrariesChapter, RowsOfTwoVersionsAreSaid) {
  StoredStudy stored;
  add(stored, "theirs", counts(false, 0));
  EXPECT_FALSE(finds(libraries_chapter(stored), "version"));
  Json newer = counts(false, 0);
  newer["library"] = "x 2";
  add(stored, "theirs", newer);
  EXPECT_TRUE(finds(libraries_chapter(stored),
                    "The rows of theirs are of more than one version: x 1 and x 2."));
}

// One key stands below all panels, so a look that two contestants share would name both.
TEST(LibrariesChapter, EveryContestantHasItsOwnColourAndPoint) {
  StoredStudy stored;
  const std::vector<std::string> libraries = {"FCL 1", "CGAL 1", "x 1"};  // a panel each
  for (const KnownContestant& contestant : known_contestants()) {
    Json of = counts(false, stored.rows.size() + 1);
    of["library"] = contestant.ours ? "farcull" : libraries[stored.rows.size() % libraries.size()];
    add(stored, contestant.name, of);
  }
  const Chapter chapter = libraries_chapter(stored);
  const auto figure = std::find_if(chapter.figures.begin(), chapter.figures.end(),
                                   [](const Figure& of) { return of.name == "libraries-time"; });
  ASSERT_NE(figure, chapter.figures.end());
  EXPECT_EQ(figure->panels.size(), 4u);
  const std::vector<std::string> names = series_names(*figure);
  EXPECT_EQ(names.size(), known_contestants().size());
  std::set<std::pair<std::string, int>> looks;
  for (const SeriesStyle& style : styles_of(names)) looks.emplace(style.colour, style.point);
  EXPECT_EQ(looks.size(), names.size());
}

std::string text_of_file(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path).rdbuf();
  return out.str();
}

// As StudiesCommand writes them.
Provenance run_with(const std::string& suite, const std::string& contestants,
                    const std::string& device) {
  Provenance out;
  out.started = "2026-01-01T00:00:00Z";
  out.commit = "c0ffee";
  out.options = Json{
      {"experiment", "libraries"},
      {"suite", suite},
      {"contestants", contestants},
      {"device",
       device}}.dump();
  return out;
}

TEST(LibrariesReport, NamesTheCommandThatWasRun) {
  StoredStudy stored;
  add(stored, "far", counts(true, 0));
  stored.declaration.choice.quick = true;
  stored.rows[0].run = 2;
  const Provenance all = run_with("", "", ""), given = run_with("my suite", "far,exact", "native");
  EXPECT_EQ(command_of(stored, {{1, all}, {2, given}, {3, all}}),
            "farcull experiment libraries --quick --suite 'my suite' --contestants far,exact "
            "--device native");
  // The twin: the run that measured had none of them, and the others are not its own.
  EXPECT_EQ(command_of(stored, {{1, given}, {2, all}, {3, given}}),
            "farcull experiment libraries --quick");
  // Options of another program are none.
  Provenance foreign = all;
  for (const char* options : {"", "[]", "{\"suite\": 3}", "no JSON"}) {
    foreign.options = options;
    EXPECT_EQ(command_of(stored, {{2, foreign}}), "farcull experiment libraries --quick");
  }
}

TEST(LibrariesReport, RepeatsTheOptionsOnItsPages) {
  try {
    require_gnuplot();
  } catch (const Error&) {
    GTEST_SKIP() << "gnuplot is not installed";
  }
  StoredStudy made;
  add(made, "far", counts(true, 0));
  const ScratchFolder folder;
  {
    Store store(store_path(folder.folder()), Store::Access::write);
    store.declare(made.declaration);
    const std::int64_t run = store.begin_run(run_with("", "far", "native"));
    store.add("libraries", run, 0, made.rows[0].measurement);
  }
  write_report({.folder = folder.folder(), .draw_picture = {}});
  const std::string command = "farcull experiment libraries --contestants far --device native";
  for (const char* page : {"results.md", "index.html", "report.tex"}) {
    std::string text = text_of_file(folder.path("report/") + page);
    // LaTeX has its own way to write a hyphen that stays one.
    const std::size_t at = text.find("farcull experiment libraries");
    ASSERT_NE(at, std::string::npos) << page;
    if (std::string(page) != "report.tex")
      EXPECT_EQ(text.substr(at, command.size()), command) << page;
    else
      EXPECT_NE(text.find("contestants far", at), std::string::npos);
  }
}

}  // namespace
}  // namespace farcull
