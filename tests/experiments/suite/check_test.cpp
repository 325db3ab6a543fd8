// What is refused in a suite: every corruption with its file, its line and its reason.
#include "experiments/suite/reader.h"
#include "tests/lab/suite.h"

namespace farcull {
namespace {

/// A change to one file, and what the error has to say about it.
struct Corruption {
  const char* file;
  const char* old;
  const char* by;
  long line;
  const char* reason;
  const char* named = nullptr;  // the file that the error names, where it is another one
};

/// Corrupts a suite that is right, with sums that fit where `sums`, and checks the error.
void expect_refused(const Corruption& corruption, bool sums) {
  const ScratchFolder folder;
  lab::write_few(folder);
  folder.replace(corruption.file, corruption.old, corruption.by);
  if (sums) lab::write_index(folder);
  const Error error = error_of([&] { check_suite(folder.folder()); });
  EXPECT_EQ(error.where,
            folder.path(corruption.named != nullptr ? corruption.named : corruption.file));
  EXPECT_EQ(error.line, corruption.line) << error.what();
  EXPECT_TRUE(has_text(error.reason, corruption.reason)) << error.what();
}

TEST(SuiteCheck, TakesWhatIsRight) {
  const ScratchFolder folder;
  lab::write_few(folder);
  const SuiteSummary summary = check_suite(folder.folder());
  ASSERT_EQ(summary.families.size(), 1u);
  EXPECT_EQ(summary.families[0].name, "few");
  EXPECT_EQ(summary.families[0].pairs, 3u);
  EXPECT_EQ(summary.families[0].colliding, 1u);
  ASSERT_EQ(summary.meshes.size(), 1u);
  EXPECT_EQ(summary.meshes[0].colliding, 1u);
  EXPECT_EQ(summary.meshes[0].neighbours, 1u);
}

TEST(SuiteCheck, RefusesWrongLabels) {
  const char* const pairs = "pairs/few.txt";
  expect_refused({pairs, "crossing", "apart", 3, "pair 0 is called apart, and it is crossing"},
                 true);
  expect_refused({pairs, "apart", "touch-vertex", 4, "and it is apart"}, true);
  expect_refused({pairs, "crossing", "touch-face", 3, "and it is crossing"}, true);
  expect_refused({pairs, "neighbours-apart", "neighbours-meet", 5, "and it is neighbours-apart"},
                 true);
  expect_refused({pairs, "0-0,1-1 neighbours", "0-0 neighbours", 5, "are not called shared"}, true);
  // One digit: the corner goes below the plane.
  expect_refused({pairs, "0x1p-52", "-0x1p-52", 4, "and it is crossing"}, true);
}

TEST(SuiteCheck, RefusesWrongListsOfPairs) {
  const char* const list = "meshes/two-1/pairs.csv";
  expect_refused({list, "0,0,0,1,2\n", "0,0,0,1,1\n", 2, "share 2 vertices, not 1"}, true);
  expect_refused({list, "0,0,0,1,2\n", "0,0,0,2,2\n", 2, "object 0 has no triangle 2"}, true);
  expect_refused({list, "0,0,0,1,2\n", "0,1,0,0,2\n", 2, "is not before"}, true);
  expect_refused({list, "0,0,0,1,2\n", "0,0,0,1,2\n0,0,0,1,2\n", 3, "do not ascend"}, true);
  expect_refused({list, "0,0,0,1,2\n", "0,0,0,1\n", 2, "five whole numbers"}, true);
  expect_refused({list, "shared\n", "share\n", 1, "the first line"}, true);
  // Turned over, the second triangle meets the first one in their edge alone.
  expect_refused({"meshes/two-1/0.obj", "v 1 1 0", "v 1 -1 0", 2, "0,0,0,1 does not collide", list},
                 true);
  expect_refused({"meshes/two-1/0.obj", "f 1 2 4", "f 1 2 4 3", 0, "face 1 is no triangle"}, true);
  expect_refused({"meshes/two-1/mesh.txt", "self yes", "self maybe", 1, "neither yes nor no"},
                 true);
}

TEST(SuiteCheck, NamesAPairThatIsMissing) {
  const ScratchFolder folder;
  lab::write_few(folder);
  folder.replace("meshes/two-1/pairs.csv", "0,0,0,1,2\n", "");
  lab::write_index(folder, 1);
  Error error = error_of([&] { check_suite(folder.folder()); });
  EXPECT_TRUE(has_text(error.reason, "has 0 items; suite.txt says 1")) << error.what();
  lab::write_index(folder, 0);
  error = error_of([&] { check_suite(folder.folder()); });
  EXPECT_EQ(error.where, folder.path("meshes/two-1/pairs.csv"));
  EXPECT_EQ(error.reason, "the pair 0,0,0,1 collides and is missing");
}

TEST(SuiteCheck, RefusesTwoVerticesAtOnePosition) {
  expect_refused({"meshes/two-1/0.obj", "v 1 1 0\nf 1 2 3\nf 1 2 4", "v 0 0 0\nf 1 2 3\nf 4 2 1", 0,
                  "two vertices at (0, 0, 0)", "meshes/two-1"},
                 true);
}

TEST(SuiteCheck, RefusesChangedFilesByTheirSums) {
  expect_refused({"pairs/few.txt", "0x1p-40", "0x1p-41", 0, "SHA-256"}, false);
  expect_refused({"pairs/few.txt", "# a comment\n", "", 0, "bytes; suite.txt says"}, false);
  expect_refused({"suite.txt", "seed 1", "seed 2", 9, "the sum is not that"}, false);
  expect_refused({"suite.txt", "small", "smell", 9, "the sum is not that"}, false);
}

TEST(SuiteCheck, RefusesCutAndForeignFiles) {
  const ScratchFolder folder;
  lab::write_few(folder);
  const std::string whole = folder.read("suite.txt");
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    folder.write("suite.txt", whole.substr(0, length));
    EXPECT_NE(message_of([&] { read_suite(folder.folder()); }), "") << length;
  }
  folder.write("suite.txt", whole);
  EXPECT_EQ(message_of([&] { read_suite(folder.folder()); }), "");
  folder.write("pairs/other.txt", "farcull-pairs 1 other\n");
  const Error error = error_of([&] { check_suite(folder.folder()); });
  EXPECT_EQ(error.where, folder.path("pairs/other.txt"));
}

/// The error for a file of pairs in which `old` is replaced.
Error pairs_error(const std::string& old, const std::string& by) {
  std::string text = lab::good_pairs();
  const std::size_t place = text.find(old);
  EXPECT_NE(place, std::string::npos) << old;
  return error_of([&] { parse_pairs(text.replace(place, old.size(), by), "few.txt"); });
}

TEST(SuiteReader, NamesTheLineOfAMalformedPair) {
  const auto expect = [](const char* old, const char* by, long line, const char* reason) {
    const Error error = pairs_error(old, by);
    EXPECT_EQ(error.line, line) << error.what();
    EXPECT_EQ(error.where, "few.txt");
    EXPECT_TRUE(has_text(error.reason, reason)) << error.what();
  };
  expect("farcull-pairs 1", "farcull-pairs 2", 1, "the first line");
  expect("few\n", "few and more\n", 1, "the first line");
  expect("\n1 1e-9", "\n7 1e-9", 4, "is called 7 and should be 1");
  expect("1e-9", "nan", 4, "no number for the parameter");
  expect("crossing", "crosses", 3, "no kind of contact");
  expect("0-0,1-1", "0-0,1-3", 5, "names no shared corners");
  expect("0-0,1-1", "1-1,0-0", 5, "do not ascend");
  expect("0-0,1-1", "0-0,1-2", 5, "their coordinates differ");
  expect("neighbours-apart", "apart", 5, "for triangles without shared corners");
  expect("0x1.8p+1", "0x1.8g+1", 3, "no finite hexadecimal number");
  expect("0x1.8p+1", "3", 3, "no finite hexadecimal number");
  expect("0x1.8p+1", "0x1p+2000", 3, "no finite hexadecimal number");
  expect(" 0x1p-40", "", 5, "18 numbers");
  expect("0x1p-40", "0x1p-40 0x0p+0", 5, "18 numbers");
}

TEST(SuiteReader, RefusesAFileThatIsCut) {
  const std::string whole = lab::good_pairs();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string text = whole.substr(0, length);
    // A cut between two lines shows only in the sum of the file.
    const bool between_lines = text.ends_with("\n");
    EXPECT_EQ(message_of([&] { parse_pairs(text, "cut"); }) == "", between_lines) << length;
  }
}

TEST(SuiteReader, ReadsHexadecimalNumbersAsTheyWereWritten) {
  for (const double x : {0.0, -0.0, 1.5, -0.1, 0x1p-1074, -0x1.fffffffffffffp+1023, 1e-310}) {
    std::string text;
    append_hexadecimal(text, x);
    std::array<char, 64> buffer;
    std::snprintf(buffer.data(), buffer.size(), "%a", x);
    EXPECT_EQ(text, buffer.data());
    const std::optional<double> back = parse_hexadecimal(text);
    ASSERT_TRUE(back) << text;
    EXPECT_EQ(*back, x);
    EXPECT_EQ(std::signbit(*back), std::signbit(x));
  }
  for (const char* bad : {"", "0x", "-", "1", "0x1p", "0xinf", "0x-1p+0", "--0x1p+0", "0x1p+0 "})
    EXPECT_FALSE(parse_hexadecimal(bad)) << bad;
}

TEST(SuiteReader, ReadsUnlabelledPairsAndMeshes) {
  const ScratchFolder folder;
  lab::write_few(folder);
  folder.replace("pairs/few.txt", "crossing", "?");
  EXPECT_EQ(read_pairs(folder.path("pairs/few.txt")).pairs[0].kind, SuiteKind::unlabelled);
  std::filesystem::remove(folder.path("meshes/two-1/pairs.csv"));
  const SuiteMesh mesh = read_mesh(folder.path("meshes/two-1"));
  EXPECT_FALSE(mesh.labelled);
  EXPECT_EQ(mesh.name, "two-1");
  EXPECT_EQ(mesh.scene.triangles.size(), 2u);
  EXPECT_TRUE(mesh.scene.objects[0].self);
}

}  // namespace
}  // namespace farcull
