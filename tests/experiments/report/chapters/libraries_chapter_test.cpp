// The chapter of libraries on rows that were made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/contestants/score.h"
#include "experiments/report/chapters/chapters.h"
#include "experiments/suite/writer.h"

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

void add(StoredStudy& stored, const std::string& contestant, Json of) {
  Row row;
  row.position = stored.rows.size();
  row.point.scene = "small/pairs/random";
  row.point.method = contestant;
  row.measurement.counts = std::move(of);
  row.measurement.times = {{"total", 1.0}};
  stored.declaration.study = "libraries";
  stored.declaration.points.push_back(row.point);
  stored.rows.push_back(row);
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

}  // namespace
}  // namespace farcull
