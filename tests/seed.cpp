// The seed of the day, how many random cases are tried, and where failures are written. A listener
// prints the seed once at the start of a test program and beside each failure.
#include "tests/lab/test.h"

#include <ctime>

namespace farcull {
namespace {

std::uint64_t make_seed() {
  if (const char* given = std::getenv("FARCULL_SEED"); given != nullptr && *given != 0) {
    char* end = nullptr;
    const std::uint64_t seed = std::strtoull(given, &end, 10);
    if (*end != 0)
      throw std::runtime_error("FARCULL_SEED: '" + std::string(given) + "' is no number");
    return seed;
  }
  const std::time_t now = std::time(nullptr);
  std::tm day{};
  ::gmtime_r(&now, &day);
  return static_cast<std::uint64_t>(day.tm_year + 1900) * 10000 + (day.tm_mon + 1) * 100 +
         day.tm_mday;
}

class SaysTheSeed : public ::testing::EmptyTestEventListener {
  void OnTestProgramStart(const ::testing::UnitTest&) override { say("seed of the day"); }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    if (test.result()->Failed()) say("a test failed; seed of the day");
  }
  static void say(const char* what) {
    const auto seed = static_cast<unsigned long long>(seed_of_day());
    std::printf("[ %s %llu; FARCULL_SEED=%llu replays it ]\n", what, seed, seed);
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
  ::setenv("RC_PARAMS", ("seed=" + std::to_string(seed_of_day()) + most).c_str(), 0);
  ::testing::UnitTest::GetInstance()->listeners().Append(new SaysTheSeed);  // which owns it
  return true;
}();

}  // namespace

std::uint64_t seed_of_day() {
  static const std::uint64_t seed = make_seed();
  return seed;
}

std::uint64_t seed_of_day(std::uint64_t fixed) {
  // The finalizer of splitmix64 (Steele, Lea, Flood 2014), so that near seeds give far ones.
  std::uint64_t x = fixed + 0x9e3779b97f4a7c15 * seed_of_day();
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
