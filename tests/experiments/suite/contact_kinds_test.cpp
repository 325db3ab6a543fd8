// The kinds of contact of verify/contact_kind, by cutting one triangle with the other's bounds,
// against the labels of the suite, which other programs decide by enumerating points.
#include <gtest/gtest.h>

#include "experiments/suite/reader.h"
#include "experiments/suite/writer.h"
#include "verify/contact.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

constexpr std::uint64_t kEach = 120;  // pairs of a family

TEST(SuiteContactKinds, AreTheLabelsInEveryFamily) {
  std::array<int, kContactKinds.size()> of_kind{};
  int degenerate = 0;
  for (const PairFamily& family : pair_families()) {
    for (std::uint64_t id = 0; id < kEach; ++id) {
      const SuitePair pair = make_suite_pair(family, 11, id);
      const ContactKind kind = contact_kind(pair.a, pair.b);
      ASSERT_EQ(name_of(kind), to_string(decide_kind(pair.a, pair.b, family.name)))
          << family.name << " " << id;
      ASSERT_EQ(contact_shape(pair.b, pair.a).kind, kind) << family.name << " " << id;
      ++of_kind[static_cast<std::size_t>(kind)];
      degenerate += shape(pair.a) != Shape::triangle || shape(pair.b) != Shape::triangle;
    }
  }
  for (const ContactKind kind : kContactKinds)
    EXPECT_GT(of_kind[static_cast<std::size_t>(kind)], 0) << name_of(kind);
  EXPECT_GT(degenerate, 0);
}

// The twin: corners that are rounded to float before the kind is decided.
TEST(SuiteContactKinds, OfRoundedCornersAreCaught) {
  const auto rounded = [](Corners t) {
    for (Vec3& p : t) p = p.cast<float>().cast<double>();
    return t;
  };
  int caught = 0;
  for (const PairFamily& family : pair_families()) {
    for (std::uint64_t id = 0; id < 20; ++id) {
      const SuitePair pair = make_suite_pair(family, 11, id);
      const Corners a = rounded(pair.a), b = rounded(pair.b);
      if (!a[0].allFinite() || !a[1].allFinite() || !a[2].allFinite()) continue;
      if (!b[0].allFinite() || !b[1].allFinite() || !b[2].allFinite()) continue;
      caught += name_of(contact_kind(a, b)) != to_string(decide_kind(pair.a, pair.b, family.name));
    }
  }
  EXPECT_GT(caught, 20);
}

}  // namespace
}  // namespace farcull
