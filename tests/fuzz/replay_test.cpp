// The fuzz targets on their corpus, and on seeded mutations of every file of it: what fuzzing
// found stays found, and readers change under the eyes of the ordinary tests. A finding names the
// file, the seed and the bytes; `tests/fuzz/run.sh` goes on from there.
#include <fmt/format.h>

#include "tests/fuzz/target.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

// The sanitizers take several times as long, and the fuzzer itself runs under them.
#ifdef __SANITIZE_ADDRESS__
constexpr std::uint32_t kMutations = 100;
#else
constexpr std::uint32_t kMutations = 500;
#endif
constexpr std::size_t kMaxBytes = 4096;  // of a mutated input

struct File {
  std::string name, bytes;
};

std::vector<File> corpus(const std::string& folder) {
  std::vector<File> files;
  const std::filesystem::path root = std::filesystem::path(FARCULL_FUZZ_CORPUS) / folder;
  for (const auto& entry : std::filesystem::directory_iterator(root))
    files.push_back({entry.path().filename().string(), read_text(entry.path().string())});
  std::ranges::sort(files, {}, &File::name);  // the order of a folder is the file system's
  return files;
}

// What random bytes would not come across: limits of integers, special numbers, structure.
const std::vector<std::string> kTokens = [] {
  std::vector<std::string> out = listed(
      "0,-1,3,127,255,65535,2147483648,4294967295,4294967296,9223372036854775807,"
      "18446744073709551615,1e308,-1e309,5e-324,nan,inf,\n, ,\\\n,#,\",{,},[,]");
  out.emplace_back(",");
  return out;
}();

/// One to four random edits: bytes changed, removed, repeated, taken from another file, numbers
/// replaced.
std::string mutated(std::string bytes, const std::vector<File>& files, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto below = [&random](std::size_t n) { return n == 0 ? 0 : random() % n; };
  const auto digit = [](char c) { return (c >= '0' && c <= '9') || c == '-' || c == '.'; };
  for (std::size_t edit = 1 + below(4); edit > 0; --edit) {
    const std::size_t at = below(bytes.size() + 1);
    const std::size_t length = std::min(below(below(4) == 0 ? 64 : 5), bytes.size() - at);
    const std::string& token = kTokens[below(kTokens.size())];
    const std::size_t kind = below(7);
    if (kind == 0 && at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
    if (kind == 1 && at < bytes.size()) bytes[at] = static_cast<char>(random());
    if (kind == 2) bytes.erase(at, length);
    if (kind == 3) bytes.insert(below(bytes.size() + 1), std::string(bytes, at, length));
    if (kind == 4) bytes.insert(at, token);
    if (kind == 5) {  // the number at or after the place
      const auto first =
          std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), digit);
      const auto last = std::find_if_not(first, bytes.end(), digit);
      bytes.replace(first, last, token);
    }
    if (kind == 6) {
      const std::string& other = files[below(files.size())].bytes;
      const std::size_t from = below(other.size() + 1);
      bytes.insert(at, other, from, below(64));
    }
  }
  bytes.resize(std::min(bytes.size(), kMaxBytes));
  return bytes;
}

std::string escaped(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += c >= ' ' && c <= '~' && c != '\\' ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return text;
}

using Target = Answer (*)(const std::uint8_t*, std::size_t);

/// Why the input is a finding; empty where it is none.
std::string finding_of(Target target, const std::string& bytes, Answer& answer) {
  // A copy on the heap of exactly this size, so that a sanitizer sees the first byte read too far.
  const std::vector<std::uint8_t> data(bytes.begin(), bytes.end());
  try {
    answer = target(data.data(), data.size());
    return "";
  } catch (const FuzzFinding& finding) {
    return finding.what;
  } catch (const std::exception& error) {
    return std::string("not an Error of a reader: ") + error.what();
  }
}

/// Replays the folder; how often each answer was given on the files as they are.
std::map<Answer, int> replay(const std::string& folder, Target target) {
  std::map<Answer, int> answers;
  const std::vector<File> files = corpus(folder);
  EXPECT_GE(files.size(), 20u) << FARCULL_FUZZ_CORPUS << " is not the corpus";
  for (const File& file : files) {
    EXPECT_LT(file.bytes.size(), 2048u) << file.name;
    Answer answer = Answer::refused;
    const std::string finding = finding_of(target, file.bytes, answer);
    EXPECT_EQ(finding, "") << folder << "/" << file.name;
    ++answers[answer];
    for (std::uint32_t seed = 0; seed < kMutations; ++seed) {
      const std::string bytes = mutated(file.bytes, files, seed);
      const std::string why = finding_of(target, bytes, answer);
      if (why.empty()) continue;
      ADD_FAILURE() << folder << "/" << file.name << ", seed " << seed << ": " << why << "\n"
                    << escaped(bytes);
      break;
    }
  }
  return answers;
}

// Each answer is reached by the corpus itself, so that none of it goes stale unnoticed.

TEST(FuzzReplay, MeshReadersAnswerEverything) {
  std::map<Answer, int> answers = replay("mesh", fuzz_mesh);
  EXPECT_GE(answers[Answer::accepted], 15);
  EXPECT_GE(answers[Answer::refused], 15);
}

TEST(FuzzReplay, SceneFilesAnswerEverything) {
  std::map<Answer, int> answers = replay("scene", fuzz_scene_file);
  EXPECT_GE(answers[Answer::accepted], 8);
  EXPECT_GE(answers[Answer::refused], 15);
}

TEST(FuzzReplay, CheckAnswersEverythingAndProvesNothingFalse) {
  std::map<Answer, int> answers = replay("check", fuzz_check);
  EXPECT_GE(answers[Answer::proved], 2);
  EXPECT_GE(answers[Answer::refuted], 2);
  EXPECT_GE(answers[Answer::not_proved], 3);
  EXPECT_GE(answers[Answer::refused], 5);
}

// ---- that the harness itself can fail ----

constexpr AllocationLimits kTight = {.once_per_byte = 2, .all_per_byte = 4, .constant = 1024};

TEST(FuzzHarness, FindsAnAllocationThatTheInputDoesNotPayFor) {
  const auto reserve = [](std::size_t bytes) { return std::vector<char>(bytes).size(); };
  EXPECT_EQ(answer_of(kTight, 1000, [&] { return reserve(3000); }), 3000u);
  EXPECT_THROW(answer_of(kTight, 1000, [&] { return reserve(3025); }), FuzzFinding);
  EXPECT_THROW(answer_of(kTight, 1000, [&] { return reserve(std::size_t{1} << 40); }), FuzzFinding);
  // Beyond the limit of all that is alive, though no single one is too large.
  const auto pile = [](std::size_t blocks) {
    std::vector<std::string> all(blocks);
    for (std::string& text : all) text.assign(500, 'x');
    return blocks;
  };
  EXPECT_EQ(answer_of(kTight, 1000, [&] { return pile(8); }), 8u);
  EXPECT_THROW(answer_of(kTight, 1000, [&] { return pile(12); }), FuzzFinding);
  // What was freed does not count.
  const auto churn = [] {
    std::size_t sum = 0;
    for (int i = 0; i < 100; ++i) sum += std::string(1000, 'x').size();
    return sum;
  };
  EXPECT_EQ(answer_of(kTight, 1000, churn), 100000u);
}

TEST(FuzzHarness, FindsOtherExceptions) {
  const std::string bytes;
  Answer answer = Answer::refused;
  EXPECT_EQ(
      finding_of([](const std::uint8_t*, std::size_t) { return Answer::proved; }, bytes, answer),
      "");
  EXPECT_EQ(answer, Answer::proved);
  EXPECT_NE(
      finding_of([](const std::uint8_t*, std::size_t) -> Answer { throw std::length_error(""); },
                 bytes, answer),
      "");
  EXPECT_NE(finding_of([](const std::uint8_t*, std::size_t) -> Answer { throw FuzzFinding{"x"}; },
                       bytes, answer),
            "");
  const auto refuse = []() -> int { throw Error("file", "wrong", "correct it"); };
  EXPECT_EQ(answer_of(kTight, 0, refuse), std::nullopt);
  const auto helpless = []() -> int { throw Error("file", "wrong", ""); };
  EXPECT_THROW(answer_of(kTight, 0, helpless), FuzzFinding);
}

}  // namespace
}  // namespace farcull
