// Numbers from text, the hash of fingerprints, and Base64.
#include "core/base/text.h"

#include <atomic>

#include "core/base/bytes.h"
#include "core/base/parallel.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

TEST(Text, ParsesAllOfTheTextOrNothing) {
  EXPECT_EQ(parse_number<int>("-12"), -12);
  EXPECT_EQ(parse_number<double>("1e3"), 1000);
  EXPECT_EQ(parse_number<std::uint64_t>("18446744073709551615"), ~std::uint64_t{0});
  for (const char* text : {"", " 1", "1 ", "+1", "1x", "x", "99999999999"})
    EXPECT_FALSE(parse_number<int>(text)) << text;
  EXPECT_FALSE(parse_number<unsigned>("-1"));
}

TEST(Text, TakesANumberFromTheFront) {
  std::string_view text = "640x480";
  EXPECT_EQ(take_number<int>(text), 640);
  EXPECT_EQ(text, "x480");
  EXPECT_FALSE(take_number<int>(text));
  EXPECT_EQ(text, "x480");
}

// The published test vectors.
TEST(Fnv1a, IsTheHashOfThatName) {
  Fnv1a none, a, foobar, word;
  a.add("a");
  foobar.add("foobar");
  word.add(std::uint64_t{'a'});
  EXPECT_EQ(none.hex(), "cbf29ce484222325");
  EXPECT_EQ(a.hex(), "af63dc4c8601ec8c");
  EXPECT_EQ(foobar.hex(), "85944171f73967e8");
  EXPECT_NE(word.hex(), a.hex()) << "a word is eight bytes";
}

std::vector<std::uint8_t> bytes(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Base64, IsThatOfRfc4648) {
  for (const auto& [plain, encoded] :
       std::vector<std::pair<std::string, std::string>>{{"", ""},
                                                        {"f", "Zg=="},
                                                        {"fo", "Zm8="},
                                                        {"foo", "Zm9v"},
                                                        {"foobar", "Zm9vYmFy"},
                                                        {std::string("\xff\x00\xfe", 3), "/wD+"}}) {
    EXPECT_EQ(to_base64(bytes(plain)), encoded);
    EXPECT_EQ(from_base64(encoded), bytes(plain));
  }
}

TEST(Base64, RefusesWhatIsNoEncoding) {
  for (const char* text : {"Z", "Zg", "Zg=", "Zh==", "Zm9=", "Zg==Zg==", "Zm9\n", "====", "Z==="})
    EXPECT_FALSE(from_base64(text)) << text;
}

// ---- Work in chunks on threads that are kept: each chunk once, whatever else happens at that
// time.

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
