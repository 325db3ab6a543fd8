// Certificates of right distances are proved, and forged ones are not.
#include "verify/certificate/distance_certificate.h"

#include "tests/lab/certificates.h"

namespace farcull {
namespace {

using distance_case::check;
using distance_case::Distances;
using Pairs = DistanceCertificate::Pairs;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Two to four objects of none to four triangles, perhaps `self`: on a small grid, where distances
/// are equal and triangles degenerate by the dozen, or anywhere, at any scale.
Scene random_scene(std::mt19937_64& random) {
  const auto below = [&](int n) { return static_cast<int>(random() % n); };
  const bool grid = below(2) == 0;
  const double scale = below(4) > 0 ? 1 : std::ldexp(1.0, below(1800) - 1000);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<std::vector<reference::Triangle>> objects(2 + below(3));
  for (auto& object : objects) {
    object.resize(below(5));
    for (reference::Triangle& t : object) {
      Vec3 at(0, 0, 0);
      for (int k = 0; k < 3; ++k) at[k] = grid ? below(6) : 8 * unit();
      for (Vec3& p : t)
        for (int k = 0; k < 3; ++k) p[k] = scale * (at[k] + (grid ? below(3) : unit()));
    }
  }
  Scene scene = reference::scene_of(objects);
  for (Object& object : scene.objects) object.self = below(2) == 0;
  return scene;
}

/// A length among the distances of the scene: 0, one that some pair has exactly, or between.
double some_length(const Distances& d, std::mt19937_64& random) {
  if (d.squares.empty() || random() % 8 == 0) return 0;
  auto it = d.squares.begin();
  std::advance(it, static_cast<std::ptrdiff_t>(random() % d.squares.size()));
  mpz_class over, under;
  const mpz_class& num = it->second.get_num();
  const mpz_class& den = it->second.get_den();
  if (mpz_perfect_square_p(num.get_mpz_t()) != 0 && mpz_perfect_square_p(den.get_mpz_t()) != 0)
    return mpq_class(sqrt(num), sqrt(den)).get_d();
  const mpf_class root(sqrt(mpf_class(it->second, 4096)));
  return root.get_d();
}

struct Question {
  Pairs pairs;
  double within;
  std::uint64_t k = 0;
};

std::vector<Question> questions(const Distances& d, std::mt19937_64& random) {
  const double length = some_length(d, random);
  return {{Pairs::objects, kInfinity},
          {Pairs::objects, length},
          {Pairs::nearest, kInfinity, 1},
          {Pairs::nearest, kInfinity, 2},
          {Pairs::nearest, length, 1 + random() % 3},
          {Pairs::all, length}};
}

TEST(DistanceCertificate, OfRandomScenesIsProved) {
  std::mt19937_64 random(20240701);
  std::uint64_t listed = 0;
  for (int n = 0; n < trials(1200); ++n) {
    const Distances d(random_scene(random));
    for (const Question& q : questions(d, random)) {
      const DistanceCertificate c = d.certificate(q.pairs, q.within, q.k);
      const DistanceCheck result = check(c, d.scene);
      ASSERT_EQ(result.verdict, Verdict::proved) << n << ": " << to_string(q.pairs) << " " << q.k
                                                 << " " << q.within << ": " << result.reason;
      ASSERT_FALSE(result.pair.has_value());
      listed += c.distances.size();
    }
  }
  EXPECT_GT(listed, static_cast<std::uint64_t>(trials(7'000)));
}

// What is proved is what brute force has: of each certificate an entry is left out, or changed in
// one part, and none of these is proved.
TEST(DistanceCertificate, OfAnotherAnswerIsNotProved) {
  std::mt19937_64 random(20240702);
  int changes = 0;
  for (int n = 0; n < trials(400); ++n) {
    const Distances d(random_scene(random));
    for (const Question& q : questions(d, random)) {
      const DistanceCertificate right = d.certificate(q.pairs, q.within, q.k);
      if (right.distances.empty()) continue;
      const std::size_t at = random() % right.distances.size();
      const auto expect = [&](Verdict verdict, const std::function<void(DistanceCertificate&)>& f) {
        DistanceCertificate changed = right;
        f(changed);
        if (changed == right) return;
        ++changes;
        const DistanceCheck result = check(changed, d.scene);
        EXPECT_EQ(result.verdict, verdict) << n << ": " << result.reason;
        EXPECT_NE(result.reason, "");
        EXPECT_TRUE(result.pair.has_value());
        if (!result.pair) return;
        // The exact square of the pair that is named.
        const mpq_class& square = d.squares.at(
            {std::min(result.pair->a, result.pair->b), std::max(result.pair->a, result.pair->b)});
        EXPECT_EQ(result.squared, square.get_num().get_str() + "/" + square.get_den().get_str());
      };
      expect(Verdict::refuted, [&](DistanceCertificate& c) {
        c.distances.erase(c.distances.begin() + static_cast<std::ptrdiff_t>(at));
      });
      expect(Verdict::refuted, [&](DistanceCertificate& c) { c.distances[at].squared = "1/3"; });
      expect(Verdict::not_proved, [&](DistanceCertificate& c) {
        std::uint8_t& feature = c.distances[at].features[random() % 2];
        feature = (feature + 1 + random() % 6) % 7;
      });
    }
  }
  EXPECT_GT(changes, trials(2000));
}

}  // namespace
}  // namespace farcull
