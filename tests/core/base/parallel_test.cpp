// Work in chunks on threads that are kept: each chunk once, whatever else happens at that time.
#include "core/base/parallel.h"

#include "tests/lab/test.h"

#include <atomic>

namespace farcull {
namespace {

// How often each of `count` items was visited.
std::vector<int> visits(std::size_t count, std::size_t chunks) {
  std::vector<std::atomic<int>> seen(count);
  for_chunks(count, chunks, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) ++seen[k];
  });
  return {seen.begin(), seen.end()};
}

TEST(Parallel, VisitsEachItemOnce) {
  for (const std::size_t chunks : {1u, 2u, 3u, 8u, 40u})
    for (const std::size_t count : {0u, 1u, 7u, 1000u})
      EXPECT_EQ(visits(count, chunks), std::vector<int>(count, 1)) << chunks << " of " << count;
}

TEST(Parallel, ManyCallsOneAfterTheOther) {
  for (int round = 0; round < 5000; ++round)
    ASSERT_EQ(visits(3, 3), std::vector<int>(3, 1)) << round;
}

// Calls inside of chunks end as well, though no thread is free for them.
TEST(Parallel, MayBeNested) {
  std::atomic<int> done = 0;
  for_chunks(6, 6, [&](std::size_t, std::size_t, std::size_t) {
    for_chunks(5, 5, [&](std::size_t, std::size_t, std::size_t) {
      for_chunks(4, 4, [&](std::size_t, std::size_t, std::size_t) { ++done; });
    });
  });
  EXPECT_EQ(done, 6 * 5 * 4);
}

TEST(Parallel, SeveralThreadsMayCall) {
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> callers;
    for (int k = 0; k < 6; ++k) {
      callers.emplace_back([&] {
        for (int round = 0; round < 500; ++round) wrong += visits(11, 4) != std::vector<int>(11, 1);
      });
    }
  }
  EXPECT_EQ(wrong, 0);
}

// The first exception of the lowest chunk arrives, after all chunks have ended; and the threads
// work on.
TEST(Parallel, ThrowsWhatTheLowestChunkThrew) {
  for (int round = 0; round < 200; ++round) {
    std::atomic<int> ended = 0;
    try {
      for_chunks(8, 8, [&](std::size_t chunk, std::size_t, std::size_t) {
        ++ended;
        if (chunk == 3 || chunk == 6) throw std::runtime_error(std::to_string(chunk));
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "3");
    }
    EXPECT_EQ(ended, 8);
  }
  EXPECT_EQ(visits(100, 4), std::vector<int>(100, 1));
}

}  // namespace
}  // namespace farcull
