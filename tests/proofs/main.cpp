// Proves bounds with Gappa. Each is a test: proofs.filter.side and so on.
//   farcull_proofs               runs the tests; without gappa they are skipped
//   farcull_proofs script NAME   prints what Gappa reads about a bound
//   farcull_proofs page FILE     makes the tables of docs/proofs.md anew
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>

#include "tests/proofs/gappa.h"
#include "tests/proofs/table.h"

namespace farcull::proofs {
namespace {

std::string read(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

#define FAR_NEEDS_GAPPA \
  if (!has_gappa()) GTEST_SKIP() << "gappa is not installed: no bound is proved here"

// The constant that is compiled is large enough, and the twin's is not proved.
class Proof : public testing::Test {
 public:
  explicit Proof(const Bound& bound) : bound_(bound) {}
  void TestBody() override {
    FAR_NEEDS_GAPPA;
    const Answer ours = ask_gappa(bound_.script(bound_.value));
    EXPECT_TRUE(ours.proved) << bound_.claim << ": " << bound_.constant << " in " << bound_.file
                             << "\n"
                             << ours.said;
    EXPECT_LT(bound_.twin, 1);
    EXPECT_FALSE(ask_gappa(bound_.script(bound_.twin * bound_.value)).proved)
        << "Gappa proves the claim of the twin as well";
  }

 private:
  Bound bound_;
};

// "filter.side" is the test `side` of the suite `filter`.
void register_proofs() {
  for (const Bound& bound : bounds()) {
    const std::size_t dot = bound.name.find('.');
    testing::RegisterTest(bound.name.substr(0, dot).c_str(), bound.name.substr(dot + 1).c_str(),
                          nullptr, nullptr, __FILE__, __LINE__,
                          [bound]() -> Proof* { return new Proof(bound); });
  }
}

// Whoever changes a constant makes the page anew.
TEST(page, HasTheConstantsThatAreCompiled) {
  const std::string page = read(FARCULL_PROOFS_PAGE);
  std::size_t rows = 0;
  for (const Bound& bound : bounds()) {
    const auto cells = cells_of(page, bound);
    ASSERT_EQ(cells.size(), 7u) << bound.name;
    EXPECT_NE(page.find(row(bound, cells[4])), std::string::npos)
        << bound.name << ": run `farcull_proofs page docs/proofs.md`";
    ++rows;
  }
  EXPECT_GE(rows, 25u);
  EXPECT_NE(page.find(rows_by_hand()), std::string::npos);
}

// The column of the least values: these are proved, and a hundredth less is not.
TEST(page, HasTheLeastValuesThatAreProved) {
  FAR_NEEDS_GAPPA;
  const std::string page = read(FARCULL_PROOFS_PAGE);
  for (const Bound& bound : bounds()) {
    const auto cells = cells_of(page, bound);
    ASSERT_EQ(cells.size(), 7u) << bound.name;
    const double least = parsed(bound, cells[4]);
    EXPECT_LE(least, parsed(bound, cells[3])) << bound.name << ": more than ours";
    EXPECT_TRUE(ask_gappa(bound.script(least)).proved) << bound.name;
    if (least > 0) {
      // Subnormal numbers have no hundredths.
      const double less = std::min(0.99 * least, std::nextafter(least, 0));
      EXPECT_FALSE(ask_gappa(bound.script(less)).proved) << bound.name;
    }
  }
}

// A sum that is sorted wrongly is no identity, and Gappa says so.
TEST(gappa, RefusesAStepThatIsNoIdentity) {
  FAR_NEEDS_GAPPA;
  const std::string script = "y = x * (1 + d);\n{ x in [1,2] /\\ |d| <= 1b-10 -> y >= 0 }\ny -> x";
  EXPECT_TRUE(ask_gappa(script + " + x * d;\n").proved);
  EXPECT_THROW(ask_gappa(script + " - x * d;\n"), std::runtime_error);
  EXPECT_THROW(ask_gappa("{ x in [1,2] -> "), std::runtime_error);
}

}  // namespace
}  // namespace farcull::proofs

int main(int count, char** args) {
  using namespace farcull::proofs;
  const std::string what = count == 3 ? args[1] : "";
  try {
    if (what == "script") {
      for (const Bound& bound : bounds()) {
        if (bound.name == args[2]) return std::puts(bound.script(bound.value).c_str()) < 0;
      }
      throw std::runtime_error("no bound has this name");
    }
    if (what == "page") {
      const std::string page = page_with_tables(read(args[2]));
      return !(std::ofstream(args[2]) << page);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "farcull_proofs: %s\n", error.what());
    return 2;
  }
  testing::InitGoogleTest(&count, args);
  register_proofs();
  return RUN_ALL_TESTS();
}
