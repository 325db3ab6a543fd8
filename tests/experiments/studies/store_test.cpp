#include "experiments/studies/store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sys/wait.h>

#include "tests/lab/process.h"
#include "tests/lab/store.h"

namespace farcull {
namespace {

TEST(Store, GivesBackEveryRowWithAllOfItsPoint) {
  const ScratchFolder folder;
  const PointKey point{.scene = "näme, with 'quotes'\n",
                       .method = "far",
                       .offset = "exact",
                       .radius = RadiusRule{.factor = 0.35},
                       .depth_format = DepthFormat::fixed24,
                       .depth_mode = DepthMode::fixed,
                       .resolution = 4096,
                       .views = "x,1:1:0.5",
                       .frame = 17,
                       .seed = 1'000'000'000'000};
  Measurement measured{.device = "llvmpipe", .left_out = "why"};
  measured.counts = {{"b", 0.1}, {"a", std::uint64_t{1} << 63}, {"text", "\"\\"}};
  measured.times = {{"total", 1e-300}};
  {
    Store store(folder.path("s"), Store::Access::write);
    store.declare({.study = "s",
                   .choice = {.quick = true, .seed = 7},
                   .shard = 2,
                   .of = 3,
                   .points = {{}, point}});
    store.add("s", store.begin_run(lab_provenance()), 1, measured);
  }
  const Store store(folder.path("s"), Store::Access::read);
  EXPECT_EQ(store.studies(), std::vector<std::string>{"s"});
  const StoredStudy stored = store.study("s");
  EXPECT_TRUE(stored.declaration.choice.quick);
  EXPECT_EQ(stored.declaration.choice.seed, 7u);
  EXPECT_EQ(stored.declaration.shard, 2);
  EXPECT_EQ(stored.declaration.of, 3);
  EXPECT_EQ(stored.declaration.points, (std::vector<PointKey>{{}, point}));
  ASSERT_EQ(stored.rows.size(), 1u);
  EXPECT_FALSE(stored.complete());
  const Row& row = stored.rows.front();
  EXPECT_EQ(row.position, 1u);
  EXPECT_EQ(row.point, point);
  // Numbers bit for bit, keys in their order.
  EXPECT_EQ(row.measurement.counts.dump(), measured.counts.dump());
  EXPECT_EQ(row.measurement.times.dump(), measured.times.dump());
  EXPECT_EQ(row.measurement.device, measured.device);
  EXPECT_EQ(row.measurement.left_out, measured.left_out);
  ASSERT_EQ(store.runs().size(), 1u);
  EXPECT_EQ(store.runs().front().first, row.run);
  EXPECT_EQ(store.runs().front().second.cpu_features, "a b");
}

TEST(Store, RefusesAPointTwiceAndOneThatIsNotInTheGrid) {
  const ScratchFolder folder;
  Store store(folder.path("s"), Store::Access::write);
  store.declare({.study = "s", .choice = {}, .points = {{}}});
  const std::int64_t run = store.begin_run(lab_provenance());
  store.add("s", run, 0, {});
  EXPECT_THROW(store.add("s", run, 0, {}), Error);
  EXPECT_THROW(store.add("s", run, 1, {}), Error);
  EXPECT_THROW(store.add("s", run + 1, 0, {}), Error);
  EXPECT_EQ(rows_in(store, "s"), 1u);
}

TEST(Store, RefusesAnotherGridUnderTheSameName) {
  const ScratchFolder folder;
  Store store(folder.path("s"), Store::Access::write);
  const Declaration first{.study = "s", .choice = {.seed = 3}, .points = {{.seed = 3}}};
  store.declare(first);
  EXPECT_NO_THROW(store.declare(first));
  Declaration other = first;
  other.choice.seed = 4;
  EXPECT_TRUE(refuses("seed 3, not", [&] { store.declare(other); }));
  other = first;
  other.choice.quick = true;
  EXPECT_TRUE(refuses("the full grid", [&] { store.declare(other); }));
  other = first;
  other.of = 2;
  EXPECT_TRUE(refuses("shard 1/1, not 1/2", [&] { store.declare(other); }));
  other = first;
  other.points.push_back({});
  EXPECT_TRUE(refuses("other points", [&] { store.declare(other); }));
}

TEST(Store, RefusesWhatIsNoneOfOursAndLeavesItAsItIs) {
  const ScratchFolder folder;
  const std::string path = folder.path("s");
  for (const Store::Access access : {Store::Access::read, Store::Access::write}) {
    write_text(path, "these are my notes, " + std::string(4096, 'x'));
    const std::string before = read_text(path);
    EXPECT_TRUE(refuses("is no store of farcull", [&] { Store(path, access); }));
    EXPECT_EQ(read_text(path), before);
    std::filesystem::remove(path);
  }
  std::filesystem::create_directory(path);
  EXPECT_TRUE(refuses("is no file", [&] { Store(path, Store::Access::write); }));
  EXPECT_TRUE(refuses("measure first", [&] { Store(folder.path("none"), Store::Access::read); }));
  EXPECT_FALSE(std::filesystem::exists(folder.path("none")));
  write_text(folder.path("empty"), "");
  EXPECT_TRUE(refuses("nothing yet", [&] { Store(folder.path("empty"), Store::Access::read); }));
}

// The application id stands at byte 68, the version at byte 60 of the file, big-endian.
std::string store_with_byte(const std::string& path, std::size_t at, char to) {
  { Store store(path, Store::Access::write); }
  std::string text = read_text(path);
  text[at] = to;
  write_text(path, text);
  return message_of([&] { Store(path, Store::Access::write); });
}

TEST(Store, RefusesOtherProgramsDatabasesOtherVersionsAndDamage) {
  const ScratchFolder folder;
  EXPECT_TRUE(has_text(store_with_byte(folder.path("a"), 68, 'X'), "of another program"));
  EXPECT_TRUE(has_text(store_with_byte(folder.path("b"), 63, 9), "store of version 9"));
  // The twin: the byte that is there anyway.
  EXPECT_EQ(store_with_byte(folder.path("c"), 68, 'F'), "");

  // Pages of zeros where rows were.
  const std::string path = folder.path("d");
  run_studies(lab_request(folder.folder(), {counting_study(400)}));
  std::filesystem::rename(store_path(folder.folder()), path);
  std::string text = read_text(path);
  ASSERT_GT(text.size(), 40000u);
  for (std::size_t at = text.size() / 2; at < text.size(); ++at) text[at] = 0;
  write_text(path, text);
  EXPECT_TRUE(refuses("damaged", [&] { Store(path, Store::Access::read); }));
}

// Byte for byte sound, but what it says does not fit together.
TEST(Store, RefusesARowWithoutItsPoint) {
  const ScratchFolder folder;
  run_studies(lab_request(folder.folder(), {counting_study(3)}));
  const std::string path = store_path(folder.folder());
  {
    SQLite::Database database(path, SQLite::OPEN_READWRITE);
    database.exec("UPDATE rows SET position = 1000 WHERE position = 2");
  }
  EXPECT_TRUE(refuses("rows without their point", [&] { Store(path, Store::Access::read); }));
}

TEST(Store, KeepsEveryOtherProgramOut) {
  const ScratchFolder folder;
  const std::string path = folder.path("s");
  {
    Store store(path, Store::Access::write);
    const ::pid_t child = ::fork();
    if (child == 0) {
      const bool out =
          message_of([&] { Store(path, Store::Access::write); }).find("another program") !=
              std::string::npos &&
          message_of([&] { Store(path, Store::Access::read); }).find("another program") !=
              std::string::npos;
      ::_exit(out ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_NO_THROW(Store(path, Store::Access::read));
}

TEST(RunStudies, EndsWithTheSameRowsAfterTenKillsAtRandomMoments) {
  const ScratchFolder undisturbed, killed;
  const Study study = counting_study(150, std::chrono::milliseconds(2));
  run_studies(lab_request(undisturbed.folder(), {study}));
  const std::string path = store_path(killed.folder());
  std::mt19937_64 random(test_seed(1));
  int between = 0;
  for (int kill = 0; more_cases(kill, 10, between > 0, 1000); ++kill) {  // between two rows
    const ::pid_t child = ::fork();
    if (child == 0) {
      run_studies(lab_request(killed.folder(), {study}, true));
      ::_exit(0);
    }
    // A run takes at least 0.3 s; in a tenth of that it does not come to its end.
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 60000));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    if (!std::filesystem::exists(path) || std::filesystem::file_size(path) == 0) continue;
    const Store store(path, Store::Access::write);
    const std::size_t rows = rows_in(store, study.name);
    between += rows > 0 && rows < 150;
  }
  run_studies(lab_request(killed.folder(), {study}, true));
  EXPECT_EQ(difference(store_path(undisturbed.folder()), path), "");
}

// The twin: a row that is not what it was is seen.
TEST(RunStudies, TheComparisonOfStoresSeesARowThatDiffers) {
  const ScratchFolder one, two, three;
  run_studies(lab_request(one.folder(), {counting_study(20)}));
  Study wrong = counting_study(20);
  wrong.measure = [right = wrong.measure](const Point& point, MeasurementContext& lab) {
    PointResult out = right(point, lab);
    if (number_of(point) == 13)
      std::get<LemmaCounts>(out.counts).largest_px = std::nextafter(13 / 3.0, 0.0);
    return out;
  };
  run_studies(lab_request(two.folder(), {wrong}));
  EXPECT_EQ(difference(store_path(one.folder()), store_path(two.folder())), "counting: row 12");
  Study half = counting_study(20);
  half.measure = [right = half.measure](const Point& point, MeasurementContext& lab) {
    if (number_of(point) == 5) throw Error("device", "lost", "try again");
    return right(point, lab);
  };
  run_studies(lab_request(three.folder(), {half}));
  EXPECT_EQ(difference(store_path(one.folder()), store_path(three.folder())),
            "counting: 20 rows and 19");
}

TEST(RunStudies, GoesOnAfterADiskThatWasFull) {
  const ScratchFolder undisturbed, full;
  const Study study = counting_study(600);
  run_studies(lab_request(undisturbed.folder(), {study}));
  const std::string path = store_path(undisturbed.folder());
  const auto size = std::filesystem::file_size(path);
  std::size_t refusals = 0;
  std::set<std::size_t> kept;
  for (const double part : {0.2, 0.6, 0.8, 0.95}) {
    {
      const FileSizeLimit limit(static_cast<rlim_t>(static_cast<double>(size) * part));
      const std::string message =
          message_of([&] { run_studies(lab_request(full.folder(), {study}, true)); });
      EXPECT_TRUE(has_text(message, "--resume"));
      refusals += !message.empty();
    }
    kept.insert(rows_in(Store(store_path(full.folder()), Store::Access::write), study.name));
  }
  EXPECT_EQ(refusals, 4u);
  EXPECT_GT(kept.size(), 1u) << "no run got further than the one before";
  run_studies(lab_request(full.folder(), {study}, true));
  EXPECT_EQ(difference(path, store_path(full.folder())), "");
}

TEST(RunStudies, WantsResumeToGoOnAndTheSameCommit) {
  const ScratchFolder folder;
  const Study study = counting_study(4);
  run_studies(lab_request(folder.folder(), {study}));
  EXPECT_TRUE(refuses("--resume", [&] { run_studies(lab_request(folder.folder(), {study})); }));
  const StudiesSummary again = run_studies(lab_request(folder.folder(), {study}, true));
  EXPECT_EQ(again.studies.front().measured, 0u);
  EXPECT_EQ(again.studies.front().before, 4u);
  StudiesRequest other = lab_request(folder.folder(), {study}, true);
  other.provenance.commit = "decade";
  EXPECT_TRUE(refuses("commit c0ffee, and this is decade", [&] { run_studies(other); }));
  // Another study may stand beside it.
  other.studies = {counting_study(4, {}, "second")};
  EXPECT_NO_THROW(run_studies(other));
}

TEST(RunStudies, GoesOnWithTheSameDeviceAndProcessorOnly) {
  const ScratchFolder folder;
  const Study study = counting_study(4);
  run_studies(lab_request(folder.folder(), {study}));
  StudiesRequest other = lab_request(folder.folder(), {study}, true);
  other.provenance.gl_renderer = "another";
  EXPECT_TRUE(refuses("of the device r (4.5), and this is", [&] { run_studies(other); }));
  other.provenance = lab_provenance();
  other.provenance.cpu_features = "a";
  EXPECT_TRUE(refuses("of the processor", [&] { run_studies(other); }));
  other.provenance = lab_provenance();
  EXPECT_NO_THROW(run_studies(other));
}

TEST(RunStudies, TriesAgainWhatWasLeftOutAndNothingElse) {
  const ScratchFolder folder, undisturbed;
  const Study study = counting_study(10);
  Study lacking = study;
  lacking.measure = [right = study.measure](const Point& point, MeasurementContext& lab) {
    if (number_of(point) == 3) return PointResult{.device = "none", .left_out = "it is not there"};
    return right(point, lab);
  };
  EXPECT_EQ(run_studies(lab_request(folder.folder(), {lacking})).studies.front().left_out, 1u);
  const StudiesSummary again = run_studies(lab_request(folder.folder(), {study}, true));
  EXPECT_EQ(again.studies.front().measured, 1u);
  EXPECT_EQ(again.studies.front().left_out, 0u);
  run_studies(lab_request(undisturbed.folder(), {study}));
  EXPECT_EQ(difference(store_path(folder.folder()), store_path(undisturbed.folder())), "");
}

TEST(RunStudies, NamesARowThatBreaksAPromiseAlsoAfterAResume) {
  const ScratchFolder folder;
  Study study = counting_study(3);
  study.measure = [right = study.measure](const Point& point, MeasurementContext& lab) {
    PointResult out = right(point, lab);
    RunCounts counts;
    counts.promises = number_of(point) != 3;
    counts.missed = number_of(point) == 1 ? 0 : 5;
    out.counts = counts;
    return out;
  };
  EXPECT_EQ(
      run_studies(lab_request(folder.folder(), {study})).broken,
      std::vector<std::string>{"counting: lemma:scene-0:1:256, lemma-worst, obb, 2 px, seed 1"});
  EXPECT_EQ(run_studies(lab_request(folder.folder(), {study}, true)).broken.size(), 1u);
  Measurement lemma;
  lemma.counts = {{"promises", true}, {"violations", 1}};
  EXPECT_TRUE(breaks_promise(lemma));
  lemma.counts["violations"] = 0;
  EXPECT_FALSE(breaks_promise(lemma));
}

TEST(Counts, AreStoredUnderTheirNamesInOrder) {
  RunCounts run;
  run.colliding = 7;
  run.promises = true;
  run.drawn = DrawnCounts{.queries = 1, .draws = 2, .queries_saved = 3, .draws_saved = 4};
  run.fragments = FragmentCounts{.elements = 3, .covered = 4, .fragments = 5};
  run.scene_hash = "h";
  EXPECT_EQ(stored({.counts = run}).counts.dump(),
            R"({"colliding":7,"missed":0,"missed_penetrating":0,"colliding_triangles":0,)"
            R"("missed_triangles":0,"candidates":0,"kept_triangles":0,"kept_objects":0,)"
            R"("triangles":0,"objects":0,"promises":true,"scene_hash":"h","left_by_boxes":0,)"
            R"("views_used":0,"queries":1,"draws":2,)"
            R"("queries_saved":3,"draws_saved":4,"elements":3,"covered":4,"fragments":5})");
  // A revoked verdict of the device is said, and hides no miss.
  run.missed = 1;
  run.revoked = true;
  const Measurement revoked = stored({.counts = run});
  EXPECT_EQ(revoked.counts["revoked"], true);
  EXPECT_TRUE(breaks_promise(revoked));
  run.promises = false;
  EXPECT_FALSE(breaks_promise(stored({.counts = run})));
  EXPECT_TRUE(stored({.left_out = "why"}).counts.empty());
}

}  // namespace
}  // namespace farcull
