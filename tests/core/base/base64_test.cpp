// The vectors of RFC 4648, and texts that are no encoding.
#include "core/base/bytes.h"

#include <gtest/gtest.h>

#include <utility>

namespace farcull {
namespace {

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
