// Questions of a suite beyond pairs, and their labels.
#include "experiments/suite/label.h"

#include "tests/lab/parts.h"

namespace farcull {
namespace {

/// Two cubes with sides of length 1, the second one moved by `by` along each axis.
SuiteMesh two_cubes(double by) {
  lab::Parts cubes;
  for (const int o : {0, 1})
    cubes.add_box(std::to_string(o), Vec3::Constant(o * by), Vec3::Constant(o * by + 1));
  SuiteMesh out;
  out.name = "cubes-1";
  out.family = "cubes";
  out.scene = cubes.scene;
  return out;
}

std::map<std::string, int> labels_of(const SuiteQuestions& questions, SuiteQuestionKind kind) {
  std::map<std::string, int> out;
  for (const SuiteQuestion& question : questions.questions)
    out[question.label] += question.kind == kind;
  return out;
}

TEST(SuiteQuestions, AreMadeOfAMeshWithBothLabels) {
  const SuiteQuestions made = questions_of(two_cubes(0.5), 1);
  using enum SuiteQuestionKind;
  EXPECT_EQ(labels_of(made, self)["no"], 2);
  EXPECT_GT(labels_of(made, inside)["yes"], 8);
  EXPECT_GT(labels_of(made, inside)["no"], 2);
  EXPECT_EQ(labels_of(made, clash)["yes"], 1);
  // Cubes that share a corner touch.
  EXPECT_EQ(labels_of(questions_of(two_cubes(1), 1), clash)["no"], 1);
}

TEST(SuiteQuestions, ADistanceIsBetweenTwoNeighbours) {
  const std::array<Vec3, 3> flat = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const auto pair = [&](double z) {
    return SuitePair{.shared = {}, .a = flat, .b = {Vec3(1, 1, z), Vec3(1, 1, 1), Vec3(3, 3, 1)}};
  };
  SuitePairs pairs{.family = "few", .pairs = {pair(-1), pair(0x1p-52), pair(0)}};
  pairs.pairs[2].shared = {{0, 0}};
  const SuiteQuestions made = questions_of(pairs);
  ASSERT_EQ(made.questions.size(), 2u);  // the third pair is of neighbours
  EXPECT_TRUE(questions_text(made).starts_with(
      "farcull-questions 1 few\n0 0 distance 0x0p+0,0x0p+0 0x0p+0 0x0p+0 0x0p+0 0x1p+2 "));
  EXPECT_EQ(made.questions[0].label, "0x0p+0,0x0p+0");
  EXPECT_EQ(made.questions[1].label, "0x1p-52,0x1p-52");
  // The distance from a corner to the plane x + y + z = 1 is the root of 4/3.
  const std::array<Vec3, 3> plane = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  EXPECT_EQ(decide_distance(plane, {Vec3(1, 1, 1), Vec3(2, 2, 2), Vec3(2, 2, 3)}, "test"),
            "0x1.279a74590331cp+0,0x1.279a74590331dp+0");
}

}  // namespace
}  // namespace farcull
