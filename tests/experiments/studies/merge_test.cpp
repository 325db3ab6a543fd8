#include "experiments/studies/run_studies.h"

#include <rapidcheck.h>
#include <sys/stat.h>

#include "tests/lab/process.h"
#include "tests/lab/store.h"

namespace farcull {
namespace {

std::vector<Study> two_studies() { return {counting_study(23), counting_study(6, {}, "second")}; }

// Measures shard K/N of both studies into the folder.
std::string measure_shard(const std::string& folder, int index, int of,
                          const Provenance& provenance = lab_provenance()) {
  StudiesRequest request = lab_request(folder, two_studies());
  request.shard = {index, of};
  request.provenance = provenance;
  return run_studies(request).store;
}

TEST(Merge, ShardsMakeTheUndividedResult) {
  const ScratchFolder whole, parts;
  run_studies(lab_request(whole.folder(), two_studies()));
  for (int shard = 1; shard <= 4; ++shard) measure_shard(parts.folder(), shard, 4);
  const MergeSummary summary =
      merge_stores(shard_files(parts.folder()), store_path(parts.folder()));
  EXPECT_EQ(summary.files, 4u);
  EXPECT_EQ(summary.studies, 2u);
  EXPECT_EQ(summary.rows, 29u);
  EXPECT_EQ(difference(store_path(whole.folder()), store_path(parts.folder())), "");
}

TEST(Merge, RefusesAHoleADuplicateAndAMissingShard) {
  const ScratchFolder folder;
  std::vector<std::string> files;
  for (int shard = 1; shard <= 3; ++shard)
    files.push_back(measure_shard(folder.folder(), shard, 3));
  const std::string out = folder.path("out.sqlite");
  EXPECT_TRUE(refuses("shard 2/3", [&] { merge_stores({files[0], files[2]}, out); }));
  EXPECT_TRUE(refuses("is shard 2/3 of counting, and so is", [&] {
    merge_stores({files[0], files[1], files[1]}, out);
  }));

  // A shard that was not finished.
  const ScratchFolder other;
  StudiesRequest request = lab_request(other.folder(), two_studies());
  request.shard = {2, 3};
  request.studies[0].measure = [right = request.studies[0].measure](const Point& p,
                                                                    MeasurementContext& lab) {
    if (number_of(p) == 5) throw Error("device", "is lost", "try again");
    return right(p, lab);
  };
  const std::string unfinished = run_studies(request).store;
  const std::string message = message_of([&] {
    merge_stores({files[0], unfinished, files[2]}, out);
  });
  EXPECT_TRUE(has_text(message, unfinished + ": has no row of counting"));
  EXPECT_FALSE(std::filesystem::exists(out));
  for (const auto& entry : std::filesystem::directory_iterator(folder.folder()))
    EXPECT_FALSE(has_text(entry.path().string(), ".part-"));
  EXPECT_NO_THROW(merge_stores(files, out));
  EXPECT_TRUE(refuses("is there already", [&] { merge_stores(files, out); }));
}

// A file whose shard number was made another one by hand: the rows tell.
TEST(Merge, RefusesAPointThatTwoFilesHold) {
  const ScratchFolder folder;
  std::vector<std::string> files;
  for (int shard = 1; shard <= 2; ++shard)
    files.push_back(measure_shard(folder.folder(), shard, 2));
  {
    Store store(files[1], Store::Access::write);
    store.add("counting", store.runs().front().first, 0, {});
  }
  EXPECT_TRUE(refuses("holds a point of", [&] { merge_stores(files, folder.path("out")); }));
}

TEST(Merge, DoesNotPutAFileBesideAJournalThatIsNotItsOwn) {
  const ScratchFolder folder;
  const std::string file = measure_shard(folder.folder(), 1, 1);
  for (const char* beside : {"out-journal", "out-wal"}) {
    const std::string journal = folder.write(beside, "of another file");
    EXPECT_TRUE(refuses(beside, [&] { merge_stores({file}, folder.path("out")); }));
    EXPECT_FALSE(std::filesystem::exists(folder.path("out")));
    std::filesystem::remove(journal);
  }
  EXPECT_NO_THROW(merge_stores({file}, folder.path("out")));
}

TEST(Merge, CountsTheMachinesThatDiffer) {
  const ScratchFolder folder;
  Provenance other = lab_provenance();
  other.cpu_features = "a b c";
  const std::vector<std::string> files = {measure_shard(folder.folder(), 1, 2),
                                          measure_shard(folder.folder(), 2, 2, other)};
  EXPECT_EQ(merge_stores(files, folder.path("out")).machines, 2u);
  EXPECT_EQ(merge_stores({measure_shard(folder.folder(), 1, 1)}, folder.path("one")).machines, 1u);
}

TEST(Merge, RefusesWhatWasMeasuredOtherwise) {
  const ScratchFolder folder, second, third;
  const std::string first = measure_shard(folder.folder(), 1, 2);
  const std::string other_commit = measure_shard(second.folder(), 2, 2, lab_provenance("decade"));
  EXPECT_TRUE(refuses("of another commit (decade)", [&] {
    merge_stores({first, other_commit}, folder.path("out"));
  }));
  StudiesRequest seeded = lab_request(third.folder(), two_studies());
  seeded.shard = {2, 2};
  seeded.choice.seed = 2;
  const std::string other_seed = run_studies(seeded).store;
  EXPECT_TRUE(refuses("another grid or seed", [&] {
    merge_stores({first, other_seed}, folder.path("out"));
  }));
}

TEST(Shards, CoverEveryPointOnce) {
  rc::check("every position is in one shard", [] {
    const int of = *rc::gen::inRange(1, 50);
    const auto position = *rc::gen::inRange<std::size_t>(0, 100000);
    int held = 0;
    for (int index = 1; index <= of; ++index) held += Shard{index, of}.holds(position);
    RC_ASSERT(held == 1);
  });
}

TEST(Shards, AreReadAsGiven) {
  const Shard shard = parse_shard("2/4");
  EXPECT_EQ(shard.index, 2);
  EXPECT_EQ(shard.of, 4);
  for (const char* bad : {"", "2", "2/", "/4", "0/4", "5/4", "-1/4", "1/0", "1/4/2", "1.0/4", "a/b",
                          "1/100001", " 1/4", "99999999999999999999/4"})
    EXPECT_TRUE(refuses("--shard", [&] { parse_shard(bad); })) << bad;
}

// ---- A library that is upgraded between two runs, or between two shards.

constexpr int kPoints = 12;

// Its points are those of two contestants, "lemma" and "lemma-worst". `version` is what is
// installed of both; empty: they are missing. From point `fails_from` on (counted from 1) measuring
// fails.
Study asking(const std::string& version, int fails_from = kPoints + 1) {
  Study out = counting_study(kPoints);
  out.library = [=](const Point&) { return version; };
  out.measure = [=](const Point& point, MeasurementContext&) {
    if (number_of(point) >= fails_from) throw Error("device", "is lost", "try again");
    if (version.empty()) return PointResult{.device = "none", .left_out = "it is not there"};
    return PointResult{.counts = LibraryCounts{{{"library", version}}}, .device = "process"};
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

TEST(Versions, RowsOfAMissingProgramAreKept) {
  const ScratchFolder folder;
  const std::string path = measure(folder.folder(), asking("lib 1.0", 7)).store;
  EXPECT_EQ(measure(folder.folder(), asking("")).studies.front().left_out, 6u);
  // It is there again: what was left out is measured. The twin: another version is not taken.
  EXPECT_TRUE(refuses("lib 2 is here", [&] { measure(folder.folder(), asking("lib 2")); }));
  EXPECT_EQ(measure(folder.folder(), asking("lib 1.0")).studies.front().measured, 6u);
  EXPECT_EQ(libraries_in(path), std::set<std::string>{"lib 1.0"});
}

std::string measure_shard(const std::string& folder, int index, const std::string& version) {
  StudiesRequest request = lab_request(folder, {asking(version)});
  request.shard = {index, 3};
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
  EXPECT_TRUE(has_text(refused.remedy, "another folder"));
  EXPECT_FALSE(std::filesystem::exists(out));
  // The twin.
  EXPECT_EQ(merge_stores({first, second, third}, out).rows, static_cast<std::size_t>(kPoints));
  EXPECT_EQ(libraries_in(out), std::set<std::string>{"lib 1.0"});
}

// The study itself asks the programs of contestants for their versions.
TEST(Versions, OfTheStudyAreThoseThatItsProgramsSay) {
  const Study study = study_named("libraries");
  const Point point = LibraryPoint{.contestant = "gts"};
  const auto said = [&](const std::string& folder) {
    const SetVariable set("FARCULL_CONTESTANTS", folder);
    return study.library(point);
  };
  for (const char* version : {"GTS 0.7.5", "GTS 0.7.6"}) {
    const ScratchFolder folder;
    const std::string program = folder.write(
        "farcull_contestant_gts",
        std::string("#!/bin/sh\nread -r number question\nprintf '%s\\tcard\\t%s\\t%s\\n' $number "
                    "name gts $number library '") +
            version + "' $number answers pair\nprintf '%s\\tdone\\n' $number\n");
    ASSERT_EQ(::chmod(program.c_str(), 0700), 0);
    EXPECT_EQ(said(folder.folder()), version);
  }
  const ScratchFolder empty;
  EXPECT_EQ(said(empty.folder()), "");
}

}  // namespace
}  // namespace farcull
