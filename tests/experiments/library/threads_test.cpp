// Objects of the library called by two threads at once, and objects that were moved from. A call
// gives the right answer or an error that says so.
#include <barrier>

#include "core/base/stopwatch.h"
#include "experiments/library/distance.h"
#include "experiments/library/input.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/flat.h"

namespace farcull {
namespace {

constexpr const char* kBusy = "is in use by another thread or call";
constexpr const char* kMoved = "was moved from";

std::array<std::string, 2> busy(const char* object) { return {object, kBusy}; }
std::array<std::string, 2> moved(const char* object) { return {object, kMoved}; }

// One call waits in the middle, so that the other one surely comes during it.
TEST(LibraryThreads, ACallDuringAnotherIsRefusedAndChangesNothing) {
  struct State {
    int calls = 0;
    std::atomic_flag used;
  };
  const auto state = std::make_unique<State>();
  std::promise<void> begun, go_on;
  std::thread first([&] {
    exclusive(state, "object", [&](State& s) {
      begun.set_value();
      go_on.get_future().wait();
      return ++s.calls;
    });
  });
  begun.get_future().wait();
  const auto call = [&] { return exclusive(state, "object", [](State& s) { return ++s.calls; }); };
  EXPECT_EQ(refusal(call), busy("object"));
  EXPECT_EQ(refusal(call), busy("object"));
  go_on.set_value();
  first.join();
  EXPECT_EQ(state->calls, 1);
  EXPECT_EQ(call(), 2);
  // A call that throws leaves the object free, and a call from within a call is refused.
  EXPECT_THROW(exclusive(state, "object", [](State&) -> int { throw std::bad_alloc(); }),
               std::bad_alloc);
  EXPECT_EQ(exclusive(state, "object", [&](State&) { return refusal(call); }), busy("object"));
  EXPECT_EQ(call(), 3);
}

// Two threads begin a call at the same time, again and again until both an answer and a refusal
// have been seen. `call` returns whether it answered rightly.
void race(const char* object, const std::function<bool()>& call) {
  constexpr double kMostMs = 30'000;
  const Stopwatch time;
  std::atomic<int> right = 0, wrong = 0, refused = 0;
  std::atomic<bool> late = false;
  std::barrier start(2, [&]() noexcept { late = time.ms() > kMostMs; });
  const auto work = [&] {
    while (true) {
      start.arrive_and_wait();
      const bool seen = right > 0 && refused > 0, last = seen || wrong > 0 || late;
      start.arrive_and_wait();  // both have read the same
      if (last) return;
      try {
        ++(call() ? right : wrong);
      } catch (const Error& error) {
        ++(error.where == object && error.reason == kBusy ? refused : wrong);
      }
    }
  };
  std::thread other(work);
  work();
  other.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(right, 0);
  EXPECT_GT(refused, 0) << "no two calls met";
  EXPECT_TRUE(call());  // and the object answers as ever
}

TEST(LibraryThreads, ColliderFromTwoThreadsAnswersRightlyOrRefuses) {
  const Flat flat(make_builtin_scene("two-spheres"));
  const Options options{.threads = 2, .clearance = 0.05, .contacts = Contacts::segments};
  const std::vector<Pair> expected = Collider(options).find(flat.input()).pairs;
  ASSERT_FALSE(expected.empty());
  Collider collider(options);
  race("Collider", [&] { return collider.find(flat.input()).pairs == expected; });
}

TEST(LibraryThreads, AnObjectThatWasMovedFromSaysSo) {
  const Flat flat(make_builtin_scene("two-spheres"));
  Collider collider;
  Collider its = std::move(collider);
  // NOLINTBEGIN(bugprone-use-after-move): that is what is tested.
  EXPECT_EQ(refusal([&] { collider.find(flat.input()); }), moved("Collider"));
  EXPECT_FALSE(its.find(flat.input()).pairs.empty());
  collider = std::move(its);
  EXPECT_FALSE(collider.find(flat.input()).pairs.empty());
  EXPECT_EQ(refusal([&] { its.find(flat.input()); }), moved("Collider"));

  DistanceFinder finder;
  const DistanceFinder other = std::move(finder);
  EXPECT_EQ(refusal([&] { finder.find(flat.input()); }), moved("DistanceFinder"));

  // NOLINTEND(bugprone-use-after-move)
}

}  // namespace
}  // namespace farcull
