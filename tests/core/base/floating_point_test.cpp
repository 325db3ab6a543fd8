// The floating-point environment of a thread: found, set, verified and restored; and that every
// thread of core/parallel has the one that the proofs are about.
#include "core/base/floating_point.h"

#include "core/base/parallel.h"
#include "tests/lab/floating_point.h"

namespace farcull {
namespace {

using lab::Disturbed, lab::Environment, lab::environments;

TEST(FloatingPoint, ArithmeticShowsEveryEnvironment) {
  EXPECT_EQ(floating_point(), kProved);
  for (const Environment& environment : environments()) {
    FloatingPoint found;
    {
      const Disturbed disturbed(environment);
      found = floating_point();
    }
    EXPECT_EQ(found, environment.found) << environment.name << ": " << to_string(found);
  }
}

TEST(FloatingPoint, GuardSetsAndRestoresAlsoWhereSomethingIsThrown) {
  for (const Environment& environment : environments()) {
    FloatingPoint inside, inner, after_inner, after, thrown_through;
    {
      const Disturbed disturbed(environment);
      {
        const FloatingPointGuard guard;
        inside = floating_point();
        {
          const Disturbed again(environment);  // code of others, perhaps a library that is loaded
          const FloatingPointGuard nested;
          inner = floating_point();
        }
        after_inner = floating_point();
      }
      after = floating_point();
      try {
        const FloatingPointGuard guard;
        throw std::runtime_error("anything");
      } catch (const std::runtime_error&) {
        thrown_through = floating_point();
      }
    }
    EXPECT_EQ(inside, kProved) << environment.name;
    EXPECT_EQ(inner, kProved) << environment.name;
    EXPECT_EQ(after_inner, kProved) << environment.name;
    EXPECT_EQ(after, environment.found) << environment.name;
    EXPECT_EQ(thrown_through, environment.found) << environment.name;
  }
  EXPECT_EQ(floating_point(), kProved);
}

TEST(FloatingPoint, TheCallersIsWhatTheOutermostGuardFound) {
  const Environment downward = environments()[1];
  FloatingPoint without, within, nested, after;
  {
    const Disturbed disturbed(downward);
    without = callers_floating_point();
    {
      const FloatingPointGuard guard;
      within = callers_floating_point();
      {
        const FloatingPointGuard again;
        nested = callers_floating_point();
      }
      after = callers_floating_point();
    }
  }
  for (const FloatingPoint& found : {without, within, nested, after})
    EXPECT_EQ(found, downward.found);
  EXPECT_EQ(callers_floating_point(), kProved);
}

// The twin is a thread that nobody guards: it starts with the environment of the one that made it.
TEST(FloatingPoint, EveryThreadOfAChunkHasItAndAnotherThreadHasNot) {
  for (const Environment& environment : environments()) {
    constexpr std::size_t kThreads = 4;
    std::vector<FloatingPoint> found(kThreads);
    FloatingPoint unguarded, after;
    {
      const Disturbed disturbed(environment);
      for_chunks(kThreads, kThreads, [&](std::size_t chunk, std::size_t, std::size_t) {
        found[chunk] = floating_point();
      });
      after = floating_point();
      std::jthread([&] { unguarded = floating_point(); }).join();
    }
    for (const FloatingPoint& f : found) EXPECT_EQ(f, kProved) << environment.name;
    EXPECT_EQ(unguarded, environment.found) << environment.name;
    EXPECT_EQ(after, environment.found) << environment.name;
  }
}

TEST(FloatingPoint, ThreadsThatOthersDisturbAreSetAgain) {
  std::vector<FloatingPoint> found(2);
  const Environment upward = environments()[0];
  const FloatingPointGuard guard;
  const Disturbed disturbed(upward);  // after our guard
  for_chunks(2, 2,
             [&](std::size_t chunk, std::size_t, std::size_t) { found[chunk] = floating_point(); });
  EXPECT_EQ(found[0], kProved);
  EXPECT_EQ(found[1], kProved);
}

#ifdef __GLIBC__
// A caller that lets divisions by zero trap would be ended by SIGFPE in the midst of a call.
TEST(FloatingPoint, TrapsAndRaisedExceptionsAreTheCallersAgain) {
  std::fenv_t before;
  std::fegetenv(&before);
  std::feclearexcept(FE_ALL_EXCEPT);
  std::feraiseexcept(FE_OVERFLOW);
  ::feenableexcept(FE_DIVBYZERO | FE_INVALID);
  double quotient = 0;
  {
    const FloatingPointGuard guard;
    const volatile double zero = 0, one = 1;
    quotient = one / zero;
  }
  const int traps = ::fegetexcept(), raised = std::fetestexcept(FE_ALL_EXCEPT);
  std::fesetenv(&before);
  EXPECT_EQ(quotient, std::numeric_limits<double>::infinity());
  EXPECT_EQ(traps, FE_DIVBYZERO | FE_INVALID);
  EXPECT_EQ(raised, FE_OVERFLOW);
}
#endif

}  // namespace
}  // namespace farcull
