// Numbers from text, and the hash of fingerprints.
#include "core/base/text.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "core/base/bytes.h"

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

}  // namespace
}  // namespace farcull
