// Times of studies: rounds, turns, load, and one process at a time.
#include <sys/wait.h>

#include <csignal>

#include "tests/lab/store.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Row> rows_of(const std::string& folder, const std::string& study = "timed") {
  return Store(store_path(folder), Store::Access::read).study(study).rows;
}

std::vector<std::vector<double>> times_of(const Row& row) {
  std::vector<std::vector<double>> out;
  for (const Json& round : row.measurement.times["rounds"]) out.push_back(round["ms"]);
  return out;
}

TEST(Times, OfAllPointsComeInRoundsAndOfASceneInTurn) {
  const ScratchFolder folder;
  std::vector<std::string> runs;
  run_studies(lab_request(folder.folder(), {timed_study({"a", "b"}, runs)}));
  std::vector<std::string> in_turn;
  for (int round = 0; round < 3; ++round)
    for (const std::string scene : {"a", "a", "b", "b"})
      in_turn.insert(in_turn.end(), {scene + " boxes", scene + " exact"});
  EXPECT_EQ(runs, in_turn);
  const std::vector<Row> rows = rows_of(folder.folder());
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(times_of(rows[0]), (std::vector<std::vector<double>>{{1, 3}, {9, 11}, {17, 19}}));
  EXPECT_EQ(rows[0].measurement.times["total"], 10);
  for (const Row& row : rows) EXPECT_TRUE(is_whole(row.measurement));
}

TEST(Times, GoOnWithTheNextRoundWhereTheyWereEnded) {
  const ScratchFolder folder, parts;
  std::vector<std::string> runs;
  Study study = timed_study({"a"}, runs), ends = study;
  bool lost = false;
  ends.measure = [&, right = study.measure](const Point& point, MeasurementContext& lab) {
    if (runs.size() == 6 && !std::exchange(lost, true)) throw Error("device", "is lost", "again");
    return right(point, lab);
  };
  // In the second turn of the second round boxes fails; the other point goes on.
  const StudiesSummary first = run_studies(lab_request(folder.folder(), {ends}));
  EXPECT_EQ(first.failed.size(), 1u);
  EXPECT_EQ(first.studies.front().measured, 1u);
  std::vector<Row> rows = rows_of(folder.folder());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rounds_in(rows[0].measurement), 1);
  EXPECT_FALSE(is_whole(rows[0].measurement));
  EXPECT_FALSE(Store(store_path(folder.folder()), Store::Access::read).study("timed").complete());
  EXPECT_TRUE(refuses("has no row of timed",
                      [&] { merge_stores({store_path(folder.folder())}, folder.path("merged")); }));
  const StudiesSummary again = run_studies(lab_request(folder.folder(), {study}, true));
  EXPECT_EQ(again.studies.front().measured, 1u);
  rows = rows_of(folder.folder());
  for (const Row& row : rows) EXPECT_EQ(rounds_in(row.measurement), kRounds);
  EXPECT_EQ(times_of(rows[0]).front(), (std::vector<double>{1, 3})) << "the first round is kept";
  EXPECT_NO_THROW(merge_stores({store_path(folder.folder())}, folder.path("merged")));
}

TEST(Times, OfAPointThatTwoStudiesHaveAreMeasuredOnce) {
  const ScratchFolder together, apart;
  std::vector<std::string> runs;
  const Study one = timed_study({"a", "b"}, runs), two = timed_study({"b", "c"}, runs, "second");
  run_studies(lab_request(together.folder(), {one, two}));
  EXPECT_EQ(std::ranges::count(runs, "b exact"), 2 * kRounds);
  EXPECT_EQ(runs.size(), 6u * 2 * kRounds);
  EXPECT_EQ(times_of(rows_of(together.folder())[3]),
            times_of(rows_of(together.folder(), "second")[1]));
  // One command after the other, and counts that only the second study has: one run for them.
  run_studies(lab_request(apart.folder(), {one}));
  runs.clear();
  Study more = two;
  more.plain = false;
  run_studies(lab_request(apart.folder(), {more}));
  EXPECT_EQ(std::ranges::count(runs, "b exact"), 1);
  EXPECT_EQ(times_of(rows_of(apart.folder())[3]), times_of(rows_of(apart.folder(), "second")[1]));
  // The twin: rows of another commit are none of this program.
  runs.clear();
  const ScratchFolder other;
  run_studies(lab_request(other.folder(), {one}));
  runs.clear();
  StudiesRequest newer = lab_request(other.folder(), {two});
  newer.provenance.commit = "decade";
  run_studies(newer);
  EXPECT_EQ(std::ranges::count(runs, "b exact"), 2 * kRounds);
}

TEST(Times, OfShardsAgreeBetweenStudiesOnceTheyAreMerged) {
  const ScratchFolder folder;
  std::vector<std::string> runs;
  const Study even = timed_study({"a", "b"}, runs);
  // b exact is measured by shard 1 for one study, and by shard 2 for the other.
  const Study odd{.name = "third",
                  .title = "t",
                  .question = "?",
                  .grid =
                      [grid = even.grid](const GridChoice& choice) {
                        std::vector<Point> out = grid(choice);
                        out.erase(out.begin());
                        return out;
                      },
                  .measure = even.measure};
  for (int shard = 1; shard <= 2; ++shard) {
    StudiesRequest request = lab_request(folder.folder(), {even, odd});
    request.shard = {shard, 2};
    run_studies(request);
  }
  EXPECT_EQ(std::ranges::count(runs, "b exact"), 2 * 2 * kRounds) << "else there is nothing to do";
  merge_stores(shard_files(folder.folder()), store_path(folder.folder()));
  EXPECT_EQ(times_of(rows_of(folder.folder())[3]), times_of(rows_of(folder.folder(), "third")[2]));
}

TEST(Times, RefuseAnAnswerThatChangesFromRoundToRound) {
  const ScratchFolder folder;
  std::vector<std::string> runs;
  Study moody = timed_study({"a"}, runs);
  moody.measure = [&runs, right = moody.measure](const Point& point, MeasurementContext& lab) {
    PointResult out = right(point, lab);
    out.answer = runs.size() == 9;
    return out;
  };
  const StudiesSummary summary = run_studies(lab_request(folder.folder(), {moody}));
  ASSERT_EQ(summary.failed.size(), 1u);
  EXPECT_TRUE(has_text(summary.failed.front(), "two runs of the same point differ"));
}

// With a limit below 0 no machine is idle enough.
TEST(Times, AreMeasuredAgainAndThenVoidIfOtherProgramsTakeTheProcessors) {
  if (!LoadMeter().now()) GTEST_SKIP() << "this system does not say what other programs take";
  const ScratchFolder folder;
  std::vector<std::string> runs;
  const Study study = timed_study({"a"}, runs);
  StudiesRequest request = lab_request(folder.folder(), {study});
  request.most_load = -10;  // a share less its error is more
  EXPECT_EQ(run_studies(request).studies.front().void_rounds, 2u * kRounds);
  EXPECT_EQ(runs.size(), 3u * 2 * 2 * kRounds) << "each round is tried three times";
  for (const Row& row : rows_of(folder.folder())) {
    EXPECT_TRUE(is_whole(row.measurement));
    EXPECT_FALSE(row.measurement.times.contains("total"));
    for (const Json& round : row.measurement.times["rounds"]) {
      EXPECT_TRUE(round["void"].get<bool>());
      EXPECT_TRUE(round["load"].is_number());
    }
  }
  // --resume measures them again, and what is not void stays.
  runs.clear();
  const StudiesSummary again = run_studies(lab_request(folder.folder(), {study}, true));
  EXPECT_EQ(again.studies.front().void_rounds, 0u);
  EXPECT_EQ(runs.size(), 2u * 2 * kRounds);
  request.resume = true;
  EXPECT_EQ(run_studies(request).studies.front().measured, 0u);
}

TEST(Times, AreNotMeasuredBesideAnotherProcess) {
  const ScratchFolder folder;
  std::vector<std::string> runs;
  const Study study = timed_study({"a"}, runs);
  StudiesRequest request = lab_request(folder.folder(), {study});
  {
    const TimingLock held(request.lock);
    const std::string message = message_of([&] { run_studies(request); });
    EXPECT_TRUE(has_text(message, "process " + std::to_string(::getpid()) + " measures times"));
    EXPECT_TRUE(has_text(message, "--no-times"));
    EXPECT_TRUE(runs.empty());
    // Counts alone need no lock.
    EXPECT_NO_THROW(run_studies(lab_request(folder.folder(), {counting_study(3)})));
    request.times = false;
    EXPECT_NO_THROW(run_studies(request));
    EXPECT_EQ(runs.size(), 2u) << "a run for the counts of each point";
  }
  for (const Row& row : rows_of(folder.folder())) {
    EXPECT_TRUE(is_whole(row.measurement) && !row.measurement.times.contains("total"));
    EXPECT_TRUE(row.measurement.times["no_times"].get<bool>());
  }
  // The twin: the lock is free again, and --resume measures the times that are missing.
  runs.clear();
  run_studies(lab_request(folder.folder(), {study}, true));
  EXPECT_EQ(runs.size(), 2u * 2 * kRounds);
  EXPECT_EQ(rounds_in(rows_of(folder.folder()).front().measurement), kRounds);
}

// A thread that computes is this process's own work; a child that still runs is another's.
TEST(LoadMeter, CountsWhatOtherProcessesTakeAndNotItsOwn) {
  const auto load_with = [](bool other) -> std::optional<double> {
    const ::pid_t child = other ? ::fork() : -1;
    const auto busy = [](std::chrono::milliseconds time) {
      volatile double x = 1;
      for (const auto end = std::chrono::steady_clock::now() + time;
           std::chrono::steady_clock::now() < end;)
        x = x * 1.0000001;
    };
    if (child == 0) {
      busy(std::chrono::seconds(5));
      ::_exit(0);
    }
    const LoadMeter meter;
    busy(std::chrono::milliseconds(400));
    const std::optional<Load> load = meter.now();
    if (other) {
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
    }
    return load ? std::optional(load->share) : std::nullopt;
  };
  const std::optional<double> alone = load_with(false), beside = load_with(true);
  if (!alone || !beside) GTEST_SKIP() << "this system does not say what other programs take";
  // On a busy machine the others fill what is left, so that only bounds from below hold everywhere.
  EXPECT_LE(*alone, 1.0);
  EXPECT_GT(*beside, 0.5 / std::max(2u, std::thread::hardware_concurrency()));
  EXPECT_TRUE((Load{.share = 0.3, .error = 0.1}.beyond(0.1)));
  EXPECT_FALSE((Load{.share = 0.15, .error = 0.1}.beyond(0.1))) << "it may be the clock's ticks";
}

}  // namespace
}  // namespace farcull
