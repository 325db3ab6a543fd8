// Seeds of random tests, how many cases they try, and where failures are written. A listener prints
// FARCULL_SEED at the start of a test program and beside each failure.
#include "tests/lab/test.h"

namespace farcull {
namespace {

// 0: that of an ordinary run.
std::uint64_t given_seed() {
  const char* const given = std::getenv("FARCULL_SEED");
  if (given == nullptr) return 0;
  char* end = nullptr;
  const std::uint64_t seed = std::strtoull(given, &end, 10);
  if (*end != 0)
    throw std::runtime_error("FARCULL_SEED: '" + std::string(given) + "' is no number");
  return seed;
}

class SaysTheSeed : public ::testing::EmptyTestEventListener {
  void OnTestProgramStart(const ::testing::UnitTest&) override { say("random tests"); }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    if (test.result()->Failed()) say("a test failed");
  }
  static void say(const char* what) {
    if (const auto seed = static_cast<unsigned long long>(given_seed()); seed != 0)
      std::printf("[ %s; FARCULL_SEED=%llu repeats it ]\n", what, seed);
  }
};

bool all_trials() {
  const char* const wish = std::getenv("FARCULL_TRIALS");
  if (wish == nullptr) return false;
  if (wish != std::string("all"))
    throw std::runtime_error("FARCULL_TRIALS: '" + std::string(wish) + "' is not \"all\"");
  return true;
}

[[maybe_unused]] const bool kListens = [] {
  const char* const most = all_trials() ? " max_success=100" : " max_success=25";
  ::setenv("RC_PARAMS", ("seed=" + std::to_string(given_seed()) + most).c_str(), 0);
  ::testing::UnitTest::GetInstance()->listeners().Append(new SaysTheSeed);  // which owns it
  return true;
}();

}  // namespace

std::uint64_t test_seed(std::uint64_t own) {
  static const std::uint64_t given = given_seed();
  // tests/seeds.sh finds the tests that read it by this.
  ::testing::Test::RecordProperty("reads_the_seed", 1);
  if (given == 0) return own;
  // The finalizer of splitmix64 (Steele, Lea, Flood 2014), so that near seeds give far ones.
  std::uint64_t x = own + 0x9e3779b97f4a7c15 * given;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

int trials(int n, int least) {
#ifdef __SANITIZE_ADDRESS__
  constexpr int kPart = 8;
#else
  constexpr int kPart = 4;
#endif
  return all_trials() ? n : std::max(n / kPart, least);
}

std::filesystem::path failure_file(const std::string& name) {
  const std::filesystem::path folder = FARCULL_TEST_FAILURES;
  std::filesystem::create_directories(folder);
  return folder / name;
}

}  // namespace farcull
