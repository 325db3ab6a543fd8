// Numbers from text, the hash of fingerprints, and Base64.
#include "core/base/text.h"

#include "core/base/base64.h"
#include "core/base/hash.h"
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

}  // namespace
}  // namespace farcull
