// A library that is upgraded between two runs, or between two shards.
#include "experiments/studies/merge.h"

#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "tests/lab/store.h"

namespace farcull {
namespace {

constexpr int kPoints = 12;

// Its points are those of two contestants, "lemma" and "lemma-worst". `version` is what is
// installed of both; empty: they are missing. From point `fails_from` on (counted from 1) measuring
// fails.
Study asking(const std::string& version, int fails_from = kPoints + 1) {
  Study out = counting_study(kPoints);
  out.library = [=](const Point&) { return version; };
  out.measure = [=](const Point& point, Lab&) {
    if (number_of(point) >= fails_from) throw Error("device", "is lost", "try again");
    if (version.empty()) return PointResult{.device = "none", .left_out = "it is not there"};
    LibraryCounts counts;
    counts.library = version;
    return PointResult{.counts = counts, .device = "process"};
  };
  return out;
}

StudiesSummary measure(const std::string& folder, const Study& study) {
  return run_studies(lab_request(folder, {study}, true));
}

std::set<std::string> libraries_in(const std::string& path) {
  std::set<std::string> out;
  const StoredStudy stored = Store(path, Store::Access::read).study("counting");
  for (const Row& row : stored.rows) out.insert(row.measurement.counts["library"]);
  return out;
}

TEST(Versions, AResumeAfterAnUpgradeIsRefusedAndAddsNothing) {
  const ScratchFolder folder;
  const std::string path = measure(folder.folder(), asking("lib 1.0", 7)).store;
  const Error refused = error_of([&] { measure(folder.folder(), asking("lib 1.1")); });
  EXPECT_EQ(refused.where, path);
  for (const char* part : {"its rows of lemma are of lib 1.0, and lib 1.1 is here now",
                           "its rows of lemma-worst are of lib 1.0"})
    EXPECT_TRUE(has_text(refused.reason, part));
  EXPECT_TRUE(has_text(refused.remedy, "another folder"));
  EXPECT_EQ(rows_in(Store(path, Store::Access::read), "counting"), 6u);
  // The twin: with the same version it goes on as before.
  EXPECT_EQ(measure(folder.folder(), asking("lib 1.0")).studies.front().measured, 6u);
  EXPECT_EQ(libraries_in(path), std::set<std::string>{"lib 1.0"});
}

TEST(Versions, TheCommandOfTheRemedyDeletesTheOldRowsAndNoOthers) {
  const ScratchFolder folder;
  const std::string path = measure(folder.folder(), asking("lib 1.0", 7)).store;
  const auto upgraded = [] {
    Study study = asking("lib 1.1");
    // One of the two contestants alone.
    study.library = [](const Point& point) {
      return number_of(point) % 2 == 1 ? "lib 1.1" : "lib 1.0";
    };
    return study;
  };
  const std::string remedy = error_of([&] { measure(folder.folder(), upgraded()); }).remedy;
  const std::size_t at = remedy.find("sqlite3 ");
  ASSERT_NE(at, std::string::npos) << remedy;
  if (std::system("sqlite3 --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no sqlite3";
  ASSERT_EQ(std::system(remedy.substr(at).c_str()), 0) << remedy;
  EXPECT_EQ(rows_in(Store(path, Store::Access::read), "counting"), 3u);
  EXPECT_EQ(measure(folder.folder(), upgraded()).studies.front().measured, 9u);
}

TEST(Versions, RowsOfAMissingProgramAreKept) {
  const ScratchFolder folder;
  const std::string path = measure(folder.folder(), asking("lib 1.0", 7)).store;
  EXPECT_EQ(measure(folder.folder(), asking("")).studies.front().left_out, 6u);
  // It is there again: what was left out is measured. The twin: another version is not taken.
  EXPECT_TRUE(refuses("lib 2 is here", [&] { measure(folder.folder(), asking("lib 2")); }));
  EXPECT_EQ(measure(folder.folder(), asking("lib 1.0")).studies.front().measured, 6u);
  EXPECT_EQ(libraries_in(path), std::set<std::string>{"lib 1.0"});
}

TEST(Versions, AnUpgradeOfWhatIsFinishedMixesNothing) {
  const ScratchFolder folder;
  measure(folder.folder(), asking("lib 1.0"));
  EXPECT_EQ(measure(folder.folder(), asking("lib 1.1")).studies.front().measured, 0u);
}

TEST(Versions, AStoreThatHoldsTwoIsNotGoneOnWith) {
  const ScratchFolder folder;
  const std::string path = measure(folder.folder(), asking("lib 1.0", 7)).store;
  {
    Store store(path, Store::Access::write);
    Measurement newer;
    newer.counts = {{"library", "lib 1.1"}};
    store.add("counting", 1, 8, newer);
  }
  EXPECT_TRUE(has_text(error_of([&] { measure(folder.folder(), asking("lib 1.1")); }).reason,
                       "its rows of lemma are of lib 1.1, and others of lib 1.0"));
}

std::string measure_shard(const std::string& folder, int index, const std::string& version) {
  StudiesRequest request = lab_request(folder, {asking(version)});
  request.shard = {index, 3, "test"};
  return run_studies(request).store;
}

TEST(Versions, ShardsOfTwoAreNotMerged) {
  const ScratchFolder folder, other;
  const std::string first = measure_shard(folder.folder(), 1, "lib 1.0"),
                    second = measure_shard(folder.folder(), 2, "lib 1.0"),
                    third = measure_shard(folder.folder(), 3, "lib 1.0"),
                    newer = measure_shard(other.folder(), 3, "lib 1.1");
  const std::string out = folder.path("out.sqlite");
  const Error refused = error_of([&] { merge_stores({first, second, newer}, out); });
  EXPECT_EQ(refused.where, newer);
  EXPECT_TRUE(has_text(refused.reason,
                       "its rows of lemma are of lib 1.1, and those of " + first + " of lib 1.0"));
  EXPECT_TRUE(has_text(refused.remedy, "--resume"));
  EXPECT_FALSE(std::filesystem::exists(out));
  // The twin.
  EXPECT_EQ(merge_stores({first, second, third}, out).rows, static_cast<std::size_t>(kPoints));
  EXPECT_EQ(libraries_in(out), std::set<std::string>{"lib 1.0"});
}

// The study itself asks the programs of contestants for their versions.
TEST(Versions, OfTheStudyAreThoseThatItsProgramsSay) {
  const Study study = study_named("libraries");
  const Point point = LibraryPoint{.contestant = "gts", .family = "random"};
  const auto said = [&](const std::string& folder) {
    ::setenv("FARCULL_CONTESTANTS", folder.c_str(), 1);
    std::string out = study.library(point);
    ::unsetenv("FARCULL_CONTESTANTS");
    return out;
  };
  for (const char* version : {"GTS 0.7.5", "GTS 0.7.6"}) {
    const ScratchFolder folder;
    const std::string program = folder.write(
        "farcull_contestant_gts",
        std::string("#!/bin/sh\nprintf 'name gts\\nlibrary ") + version + "\\npairs yes\\n\\n'\n");
    ASSERT_EQ(::chmod(program.c_str(), 0700), 0);
    EXPECT_EQ(said(folder.folder()), version);
  }
  const ScratchFolder empty;
  EXPECT_EQ(said(empty.folder()), "");
}

}  // namespace
}  // namespace farcull
