// Questions of a suite beyond pairs: made, written, read back, and found wrong where a label is
// flipped.
#include "experiments/suite/questions.h"

#include "tests/lab/suite.h"

namespace farcull {
namespace {

/// Two cubes with sides of length 1, the second one moved by `by` along each axis.
SuiteMesh two_cubes(double by) {
  SuiteMesh out;
  out.name = "cubes-1";
  out.family = "cubes";
  for (std::uint32_t o = 0; o < 2; ++o) {
    out.scene.objects.push_back(
        {.name = std::to_string(o), .first_triangle = 12 * o, .triangle_count = 12});
    for (int i = 0; i < 8; ++i)
      out.scene.vertices.push_back(Vec3(i % 2, i / 2 % 2, i / 4) + Vec3::Constant(o * by));
    for (const char* face :
         {"021", "123", "456", "576", "014", "154", "263", "367", "042", "246", "135", "375"}) {
      std::array<std::uint32_t, 3> corners{};
      for (int k = 0; k < 3; ++k) corners[k] = 8 * o + static_cast<std::uint32_t>(face[k] - '0');
      out.scene.triangles.push_back(corners);
      out.scene.source_face.push_back(0);
    }
  }
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

// The pairs and questions at which libraries err (tests/cases).
TEST(SuiteQuestions, OfCasesHaveTheLabelsThatBothOraclesFind) {
  const std::string folder = std::string(FARCULL_TEST_DIR) + "/cases/";
  const SuitePairs pairs = read_pairs(folder + "libraries.txt");
  EXPECT_GE(pairs.pairs.size(), 15u);
  for (const SuitePair& pair : pairs.pairs)
    EXPECT_EQ(to_string(decide(pair, "an example")), to_string(pair.kind)) << "line " << pair.line;
  SuiteQuestions questions = read_questions(folder + "questions.txt");
  EXPECT_EQ(questions.questions.size(), 4u);
  check_questions(questions, folder, "questions.txt");
  // The twin: no label may be another one.
  for (SuiteQuestion& question : questions.questions) {
    const std::string right = question.label;
    question.label = right == "yes" ? "no" : "0x0p+0,0x0p+0";
    EXPECT_THROW(check_questions(questions, folder, "questions.txt"), Error) << question.id;
    question.label = right;
  }
}

TEST(SuiteQuestions, ADistanceIsBetweenTwoNeighbours) {
  const SuitePairs pairs = parse_pairs(lab::good_pairs(), "few");
  const SuiteQuestions made = questions_of(pairs);
  ASSERT_EQ(made.questions.size(), 2u);  // the third pair is of neighbours
  EXPECT_EQ(made.questions[0].label, "0x0p+0,0x0p+0");
  EXPECT_EQ(made.questions[1].label, "0x1p-52,0x1p-52");
  // The distance from a corner to the plane x + y + z = 1 is the root of 4/3.
  const std::array<Vec3, 3> plane = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  EXPECT_EQ(decide_distance(plane, {Vec3(1, 1, 1), Vec3(2, 2, 2), Vec3(2, 2, 3)}, "test"),
            "0x1.279a74590331cp+0,0x1.279a74590331dp+0");
}

/// Writes the suite of two cubes, a question with another label, and expects its name in an error.
TEST(SuiteQuestions, AFlippedLabelIsFound) {
  const SuiteMesh mesh = two_cubes(0.5);
  const ScratchFolder folder;
  for (const SuiteText& file : mesh_texts(mesh))
    folder.write("meshes/cubes-1/" + file.name, file.text);
  SuiteQuestions all = questions_of(mesh, 1);
  const SuiteQuestions distances = questions_of(parse_pairs(lab::good_pairs(), "few"));
  for (const SuiteQuestion& question : distances.questions) {
    all.questions.push_back(question);
    all.questions.back().id = all.questions.size() - 1;
  }
  folder.write("questions.txt", questions_text(all));
  const SuiteQuestions read = read_questions(folder.path("questions.txt"));
  EXPECT_EQ(questions_text(read), questions_text(all));
  const auto error = [&](const SuiteQuestions& questions) {
    return message_of([&] { check_questions(questions, folder.folder(), "questions.txt"); });
  };
  EXPECT_EQ(error(read), "");
  for (const SuiteQuestion& question : read.questions) {
    SuiteQuestions wrong = read;
    std::string& label = wrong.questions[question.id].label;
    label = label == "yes" ? "no" : label == "no" ? "yes" : "0x1p-52,0x1.0000000000001p-52";
    EXPECT_TRUE(has_text(error(wrong), "question " + std::to_string(question.id) + " has"));
    label = "?";
    EXPECT_EQ(error(wrong), "");
  }
}

TEST(SuiteQuestions, AMalformedLineIsNamed) {
  const ScratchFolder folder;
  const auto error = [&](const std::string& line) {
    folder.write("questions.txt", "farcull-questions 1 few\n" + line + "\n");
    return message_of([&] { (void)read_questions(folder.path("questions.txt")); });
  };
  EXPECT_EQ(error("0 1.5 self yes a.obj"), "");
  for (const char* bad :
       {"1 0 self yes a.obj", "0 0 selves yes a.obj", "0 0 self yes", "0 0 self yes a.obj 0x1p+0",
        "0 0 inside yes a.obj 1 2 3", "0 0 clash yes a.obj", "0 x self yes a.obj",
        "0 0 distance 0x0p+0,0x0p+0 0x0p+0"})
    EXPECT_TRUE(has_text(error(bad), "questions.txt")) << bad;
}

}  // namespace
}  // namespace farcull
