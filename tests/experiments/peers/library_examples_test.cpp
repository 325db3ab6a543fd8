// The pairs at which libraries erred, kept in tests/cases: our own methods answer them as both
// oracles do, and the textbook tests, which are of this repository, still err at theirs.
#include "tests/experiments/peers/library_examples.h"

#include "experiments/suite/reader.h"

namespace farcull {
namespace {

TEST(LibraryExamples, HaveTheKindThatBothOraclesFind) {
  const SuitePairs examples = read_pairs(library_examples_file());
  EXPECT_GE(examples.pairs.size(), 15u);
  for (const SuitePair& pair : examples.pairs)
    EXPECT_EQ(to_string(decide(pair, "an example")), to_string(pair.kind)) << "line " << pair.line;
}

TEST(LibraryExamples, AreAnsweredRightlyByOurMethods) {
  for (const char* method : {"far-pairs", "exact", "far", "i-collide"})
    expect_right_on_examples(method, "native");
}

// The twin: "# CONTESTANT FAULT FAMILY" stands before each pair.
TEST(LibraryExamples, AreAnsweredWronglyByTheTextbookTestsThatTheyAreOf) {
  const SuitePairs examples = read_pairs(library_examples_file());
  std::ifstream file(library_examples_file());
  std::string line, contestant, fault;
  std::size_t id = 0, errs = 0;
  while (std::getline(file, line)) {
    if (std::istringstream words(line.substr(0, 2) == "# " ? line.substr(2) : "");
        words >> contestant >> fault)
      continue;
    if (line.starts_with("farcull-pairs")) continue;
    const SuitePair& pair = examples.pairs.at(id++);
    const bool textbook = contestant.starts_with("moeller-") || contestant.starts_with("guigue-") ||
                          contestant.starts_with("edge-face-");
    if (!textbook) continue;
    ::setenv("FARCULL_CONTESTANTS", FARCULL_CONTESTANTS_FOLDER, 1);
    const Invitation invitation = invite_known(known_contestant(contestant));
    ASSERT_TRUE(invitation.invited) << invitation.missing;
    const PairsAnswer answer = ask_pairs(*invitation.invited, std::span(&pair, 1), {}, 0);
    EXPECT_EQ(to_string(answer.answers[0].outcome), fault == "missed" ? "apart" : "meets")
        << contestant << ", line " << pair.line;
    ++errs;
  }
  EXPECT_EQ(id, examples.pairs.size());
  EXPECT_GE(errs, 4u);
}

}  // namespace
}  // namespace farcull
