// The filter may say `unknown`, never anything false; and it must not say `unknown` where pairs are
// easy, or it would be of no use. Each twin lowers one bound to zero and must be caught.
#include "verify/filter.h"

#include "tests/lab/hard_pairs.h"
#include "tests/lab/test.h"
#include "verify/exact.h"
#include "verify/filter_scalars.h"

namespace farcull {
namespace {

using hard_pairs::coplanar_and_long, hard_pairs::extreme, hard_pairs::finite,
    hard_pairs::generators, hard_pairs::Make, hard_pairs::nearly_coplanar, hard_pairs::point,
    hard_pairs::Sharing, hard_pairs::slivers_on_an_edge, reference::Triangle;

struct Tally {
  std::array<int, 3> answers{};  // in the order of Triage
  int contradictions = 0;

  void add(Triage triage, const std::function<bool()>& truth) {
    ++answers[static_cast<int>(triage)];
    if (triage != Triage::unknown && (triage == Triage::yes) != truth()) ++contradictions;
  }
  int decided() const { return answers[0] + answers[1]; }
};

template <class Bounds>
Tally tally(const Make& make, Sharing sharing, int pairs, std::uint64_t seed = 1) {
  RandomDraws random(seed);
  Tally out;
  for (int n = 0; n < pairs; ++n) {
    auto [a, b] = make(random);
    if (!finite({a, b})) continue;
    hard_pairs::share(sharing, a, b);
    const auto beyond = [&] { return reference::intersects_beyond_shared(a, b); };
    int shared = 0;
    for (const Vec3& p : a) shared += std::ranges::find(b, p) != b.end();
    if (sharing == Sharing::none)
      out.add(filters::filter_planes<Bounds>(a, b, 0), [&] { return reference::intersects(a, b); });
    if (sharing == Sharing::vertex && shared == 1)
      out.add(filters::filter_beyond_vertex<Bounds>(a[0], a[1], a[2], b[1], b[2]), beyond);
    if (sharing == Sharing::edge && shared == 2)
      out.add(filters::filter_beyond_edge<Bounds>(a[0], a[1], a[2], b[2]), beyond);
  }
  return out;
}

TEST(Filter, NeverContradictsExactArithmetic) {
  for (const auto& [name, make] : generators()) {
    for (const Sharing sharing : {Sharing::none, Sharing::vertex, Sharing::edge}) {
      const Tally t = tally<FilterBounds>(make, sharing, trials(500), test_seed(1));
      EXPECT_EQ(t.contradictions, 0) << name << " " << static_cast<int>(sharing);
    }
  }
}

// Otherwise every pair would go the slow way in silence.
TEST(Filter, DecidesWhatIsNotClose) {
  const auto random_pair = [](RandomDraws& random) {
    DrawnPair pair;
    for (Triangle* t : {&pair.a, &pair.b})
      for (Vec3& p : *t) p = point(random);
    return pair;
  };
  for (const Sharing sharing : {Sharing::none, Sharing::vertex, Sharing::edge}) {
    const Tally t = tally<FilterBounds>(random_pair, sharing, 2000);
    EXPECT_EQ(t.decided(), 2000) << static_cast<int>(sharing);
    if (sharing == Sharing::edge) continue;  // where a collision takes four points in one plane
    EXPECT_GT(t.answers[0], 200);
    EXPECT_GT(t.answers[1], 200);
  }
}

// With these smaller bounds the filter is wrong about some pairs, and with the proved ones it is
// right about the same pairs.
template <class Bounds>
void expect_needed(Sharing sharing, const Make& make) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    if (tally<Bounds>(make, sharing, 200, seed).contradictions == 0) continue;
    EXPECT_EQ(tally<FilterBounds>(make, sharing, 200, seed).contradictions, 0);
    return;
  }
  FAIL() << "without its bound the filter is right too";
}

TEST(FilterTwin, WithoutTheBoundOfSidesItIsWrong) {
  expect_needed<hard_pairs::NoSide>(Sharing::none, nearly_coplanar);
  expect_needed<hard_pairs::NoSide>(Sharing::vertex, nearly_coplanar);
  expect_needed<hard_pairs::NoSide>(Sharing::edge, coplanar_and_long);
}

struct NoNormals : FilterBounds {
  static constexpr double normals = 0;
};
TEST(FilterTwin, WithoutTheBoundOfNormalsItIsWrong) {
  expect_needed<NoNormals>(Sharing::edge, slivers_on_an_edge);
}

TEST(FilterTwin, WithoutTheBoundOfUnderflowItIsWrong) {
  expect_needed<hard_pairs::NoAbsolute>(Sharing::none, extreme);
}

}  // namespace
}  // namespace farcull
