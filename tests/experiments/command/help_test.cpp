// `farcull help` explains what the tables print: every stage, column, line and method.
#include "experiments/command/command.h"

#include <regex>

#include "experiments/measure/bench.h"
#include "experiments/measure/frames.h"
#include "experiments/record/stage_words.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

std::string text_of(const std::string& name) {
  for (const HelpTopic& topic : help_topics())
    if (name == topic.name) return topic.text;
  ADD_FAILURE() << "no topic " << name;
  return "";
}

// Terms stand at the beginning of a line, after two blanks. There may be several, by commas. They
// end before two blanks, or at the end of the line.
std::vector<std::string> terms_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  ") || line.starts_with("   ")) continue;
    std::string names = line.substr(2);
    names.resize(std::min(names.size(), names.find("  ")));
    while (names.ends_with(' ')) names.pop_back();
    std::istringstream parts(names);
    for (std::string part; std::getline(parts, part, ',');)
      out.push_back(part.substr(part.find_first_not_of(' ')));
  }
  return out;
}

bool explains(const std::string& text, const std::string& word) {
  const std::vector<std::string> terms = terms_of(text);
  return std::ranges::find(terms, word) != terms.end();
}

// The cells of a line of a table: two blanks or more lie between them.
std::vector<std::string> cells_of(const std::string& line) {
  static const std::regex gap(" {2,}");
  std::vector<std::string> out;
  for (std::sregex_token_iterator at(line.begin(), line.end(), gap, -1), end; at != end; ++at)
    if (at->length() > 0) out.push_back(*at);
  return out;
}

// The line of the text that begins so, blanks aside.
std::string line_with(const std::string& text, const std::string& begin) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line.find_first_not_of(' ') == line.find(begin)) return line;
  ADD_FAILURE() << "no line begins with " << begin << " in\n" << text;
  return "";
}

void expect_explained(const std::vector<std::string>& words) {
  EXPECT_GT(words.size(), 2u);
  const std::string terms = text_of("terms");
  for (const std::string& word : words) EXPECT_TRUE(explains(terms, word)) << word;
}

Record record_of(const Scene& scene, Method method) {
  RunOptions options;
  options.method = method;
  options.device = draws(method) ? "native" : "";
  options.resolution = draws(method) ? 64 : 0;
  options.method_is_default = true;
  Session session(options.device);
  return run(scene, options, session);
}

TEST(Help, ExplainsNothingThatIsNotThere) {
  const std::string terms = text_of("terms");
  EXPECT_TRUE(explains(terms, "owner"));
  EXPECT_TRUE(explains(terms, "occlusion"));  // the second of two
  EXPECT_FALSE(explains(terms, "flubber"));
  EXPECT_FALSE(explains(terms, "depths"));  // in an explanation alone
  std::string without = terms;
  without.erase(without.find("  owner"), 7);
  EXPECT_FALSE(explains(without, "owner"));
}

TEST(Help, ExplainsEveryStage) {
  std::vector<std::string> names;
  for (int kind = 0; kind <= static_cast<int>(StageKind::verify); ++kind)
    names.push_back(name_of({.kind = static_cast<StageKind>(kind)}));
  for (const char* word : {"round", "flags", "level", "element", "patch", "block"})
    names.emplace_back(word);
  expect_explained(names);
}

TEST(Help, ExplainsEveryLineAndColumnOfATable) {
  Scene scene = load_scene({"two-spheres"});
  Record far = record_of(scene, Method::far);
  far.risk = PairsAtRisk{.at_risk = 1, .at_risk_bare = 2};
  const std::string table = run_table(scene, far, verdict_text(*far.verification) + "\n");
  std::vector<std::string> lines;
  for (const char* line :
       {"scene", "device", "method", "default", "hint", "not asked", "views", "radius", "kept",
        "colliding", "drawn", "accounted", "at risk", "time"}) {
    EXPECT_EQ(cells_of(line_with(table, line)).at(0).find(line), 0u) << line;
    lines.emplace_back(line);
  }
  expect_explained(lines);
  expect_explained(cells_of(line_with(table, "stage ")));
  EXPECT_TRUE(has_text(table,
                       "\nverified: no colliding pair was culled, 26,214,400 pairs accounted for\n"
                       "accounted  26,214,400 pairs = "));

  for (Object& object : scene.objects) object.self = true;
  const Record pairs = record_of(scene, Method::boxes), exact = record_of(scene, Method::exact);
  const std::string comparison = comparison_table(scene, {{far}, {pairs}, {exact}});
  const std::string heading = line_with(comparison, "method ");
  std::vector<std::string> columns = cells_of(heading);
  EXPECT_EQ(columns.size(), 9u);
  far.options.radius.published = true;
  far.options.offset = "exact";
  const std::string radii = comparison_table(scene, {{far}});
  for (const char* word : {"offset", "radius"}) {
    EXPECT_FALSE(has_text(heading, word)) << word;  // of all rows the same, so not shown
    EXPECT_TRUE(has_text(line_with(radii, "method "), word)) << word;
    columns.emplace_back(word);
  }
  expect_explained(columns);
}

TEST(Help, ExplainsEveryColumnOfFramesAndBench) {
  FramesQuestion question{.options = {.method = Method::far, .resolution = 64, .device = "native"},
                          .range = {0, 1},
                          .self = true};
  const FramesResult frames = run_frames({"two-spheres"}, question);
  expect_explained(cells_of(line_with(frames.table, "frame ")));

  BenchResult result;
  BenchRow ours, peer;
  ours.name = "boxes";
  peer.name = "a peer";
  peer.peer = true;
  result.rows = {ours, peer};
  result.fastest_peer = 1;
  const std::string table = bench_table(load_scene({"two-spheres"}), {}, result);
  expect_explained(cells_of(line_with(table, "device ")));
}

TEST(Help, NamesEveryMethodAndTheDefault) {
  const std::string methods = text_of("methods");
  for (const Method method : all_methods()) EXPECT_TRUE(explains(methods, to_string(method)));
  EXPECT_TRUE(has_text(line_with(methods, to_string(kDefaultMethod)), "The default."));
  EXPECT_FALSE(has_text(line_with(methods, "far "), "The default."));
}

}  // namespace
}  // namespace farcull
