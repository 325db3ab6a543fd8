// Certificates for a clearance: distances decided in integers, a distance of exactly the clearance
// counts, and one unit in the last place more or less does not go unseen.
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/certificates.h"
#include "tests/lab/hard_pairs.h"
#include "verify/certificate/pair_list.h"

namespace farcull {
namespace {

using reference::text, reference::Triangle;

double below(double x) { return std::nextafter(x, 0); }
double above(double x) { return std::nextafter(x, HUGE_VAL); }

// ---- pairs ----

// Completeness: a direction for every pair that is farther apart, two points for every other one,
// never both, never neither. verify/exact has the distance by rationals.
TEST(IntegerClearance, ADirectionOrTwoPointsForEveryPair) {
  for (const PairGenerator& generator : pair_generators()) {
    RandomDraws random(7);
    int inside = 0, apart = 0;
    for (int n = 0; n < 600; ++n) {
      const auto [a, b] = generator.make(random);
      // The distance of two corners is an upper bound of that of the triangles, often reached.
      double clearance = (a[random.below(3)] - b[random.below(3)]).norm();
      if (random.chance(2)) clearance *= random.unit();
      if (!std::isfinite(clearance)) clearance = 1;
      for (const double d : {clearance, below(clearance), above(clearance)}) {
        IntegerPair pair(a, b, d);
        const bool expected = within(a, b, d);
        ++(expected ? inside : apart);
        ASSERT_EQ(pair.separating_direction().has_value(), !expected)
            << generator.name << ": " << text(a, b) << d;
        ASSERT_EQ(pair.is_within(), expected) << generator.name << ": " << text(a, b) << d;
      }
    }
    EXPECT_GT(inside, 5) << generator.name;
    EXPECT_GT(apart, 5) << generator.name;
  }
}

TEST(IntegerClearance, ADistanceOfExactlyTheClearanceIsWithin) {
  for (const hard_pairs::KnownDistance& f : hard_pairs::known_distances()) {
    SCOPED_TRACE(f.name);
    // A turn by multiples of 3-4-5 and a shift, both exact, so that no coordinate is special.
    const auto turned = [](const Triangle& t) {
      Triangle out;
      for (int i = 0; i < 3; ++i) {
        const Vec3& p = t[i];
        out[i] = Vec3(3 * p.x() - 4 * p.y(), 4 * p.x() + 3 * p.y(), 5 * p.z()) + Vec3(17, -3, 0.25);
      }
      return out;
    };
    for (const auto& [a, b, distance] :
         {std::tuple(f.a, f.b, f.distance), std::tuple(turned(f.a), turned(f.b), 5 * f.distance)}) {
      EXPECT_TRUE(IntegerPair(a, b, distance).is_within());
      EXPECT_FALSE(IntegerPair(a, b, distance).separating_direction());
      EXPECT_TRUE(IntegerPair(a, b, above(distance)).is_within());
      EXPECT_FALSE(IntegerPair(a, b, below(distance)).is_within());
      EXPECT_TRUE(IntegerPair(a, b, below(distance)).separating_direction());
      EXPECT_FALSE(IntegerPair(a, b).is_within());
    }
  }
}

TEST(IntegerClearance, TheWholeRangeOfDoubles) {
  constexpr double kMost = std::numeric_limits<double>::max();
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  const auto point = [](const Vec3& p) { return Triangle{p, p, p}; };
  const Triangle o = point(Vec3(0, 0, 0));
  EXPECT_TRUE(IntegerPair(o, point(Vec3(0, kLeast, 0)), kLeast).is_within());
  EXPECT_FALSE(IntegerPair(o, point(Vec3(kLeast, kLeast, 0)), kLeast).is_within());
  EXPECT_TRUE(IntegerPair(o, point(Vec3(kLeast, kLeast, 0)), kLeast).separating_direction());
  EXPECT_TRUE(IntegerPair(o, point(Vec3(0, 0, kMost)), kMost).is_within());
  EXPECT_FALSE(
      IntegerPair(point(Vec3(0, 0, -kLeast)), point(Vec3(0, 0, kMost)), kMost).is_within());
  EXPECT_TRUE(IntegerPair(point(Vec3(0, 0, -kMost)), point(Vec3(0, 0, kMost)), kMost)
                  .separating_direction());
}

// ---- certificates ----

/// Three objects on a lattice, each against itself as well: neighbours that meet and others.
Scene on_lattice(std::uint32_t seed, std::size_t triangles_each, int extent) {
  std::mt19937 random(seed);
  std::vector<std::vector<Triangle>> objects(3);
  for (auto& triangles : objects) triangles = reference::on_grid(random, triangles_each, extent);
  Scene out = reference::welded(reference::scene_of(objects), true);
  for (Object& object : out.objects) object.self = true;
  return out;
}

/// With distances of exactly 1 and 2.
const Scene& lattice() {
  static const Scene scene = on_lattice(5, 40, 9);
  return scene;
}

const Case& lattice_case() {
  static const Case c(lattice(), 1);
  return c;
}

// Every pair of the scene against distances by integers that share no code with the checker.
TEST(CertificateClearance, ProvesWhatTheReferenceFinds) {
  for (const double clearance : {0.0, 0.5, below(1), 1.0, above(1), std::sqrt(2.0), 2.0}) {
    std::vector<TrianglePair> expected;
    int exactly = 0;
    reference::for_each_pair(lattice(), [&](const TrianglePair& pair, bool) {
      if (!reference::collides(lattice(), pair, clearance)) return;
      expected.push_back(pair);
      exactly += clearance > 0 && !reference::collides(lattice(), pair, below(clearance));
    });
    if (clearance == 1) {
      EXPECT_GT(exactly, 20);
    }
    const Certificate certificate =
        make_certificate(lattice(), expected, expected, some_run(), clearance);
    const CheckResult result =
        check_certificate(parse_certificate(to_text(certificate), "text"), lattice());
    EXPECT_EQ(result.verdict, Verdict::proved) << clearance << ": " << result.reason;
    EXPECT_EQ(result.meeting, expected) << clearance;
    EXPECT_EQ(result.found.box_pairs, box_pairs(lattice(), clearance).size());
  }
}

// The twin: the certificate for another clearance, one unit in the last place away, at which the
// answer about some pair is another.
TEST(CertificateClearance, OneUnitInTheLastPlaceIsRefuted) {
  for (const hard_pairs::KnownDistance& f : hard_pairs::known_distances()) {
    SCOPED_TRACE(f.name);
    const Scene scene = reference::scene_of({{f.a}, {f.b}});
    const auto of = [&](double clearance) { return Case(scene, clearance); };
    const auto check_as = [&](const Case& c, double clearance) {
      Certificate changed = c.certificate;
      changed.clearance = clearance;
      return c.check(changed);
    };
    ASSERT_EQ(of(f.distance).meeting.size(), 1u);
    ASSERT_EQ(of(below(f.distance)).meeting.size(), 0u);
    EXPECT_EQ(check_as(of(f.distance), f.distance).verdict, Verdict::proved);
    EXPECT_EQ(check_as(of(f.distance), above(f.distance)).verdict, Verdict::proved);  // is true
    const CheckResult less = check_as(of(f.distance), below(f.distance));
    EXPECT_NE(less.verdict, Verdict::proved);
    if (!less.found.box_pairs) {  // the boxes are farther apart: the evidence is too long
      EXPECT_EQ(less.verdict, Verdict::not_proved) << less.reason;
    } else {
      EXPECT_EQ(less.verdict, Verdict::refuted) << less.reason;
      EXPECT_EQ(less.pair, (TrianglePair{0, 1}));
    }
    const CheckResult more = check_as(of(below(f.distance)), f.distance);
    EXPECT_NE(more.verdict, Verdict::proved);
    if (box_pairs(scene, below(f.distance)).size() == 1) {
      EXPECT_EQ(more.verdict, Verdict::refuted) << more.reason;
      EXPECT_EQ(more.pair, (TrianglePair{0, 1}));
      EXPECT_EQ(more.culled_meeting + (of(below(f.distance)).is_kept(0) ? 1 : 0), 1u);
    }
  }
}

// Without the squared comparison a direction that separates would do. Here it must not.
TEST(CertificateClearance, ADirectionThatOnlySeparatesIsNoEvidence) {
  const Case& c = lattice_case();
  int changed = 0;
  for (std::size_t i = 0; i < c.pairs.size() && changed < 40; ++i) {
    IntegerPair plain(c.scene.corners(c.pairs[i].a), c.scene.corners(c.pairs[i].b));
    const std::optional<int> direction = plain.separating_direction();
    if (!direction || c.integers(i).separated_by(*direction)) continue;
    ++changed;
    Certificate forged = c.certificate;
    forged.evidence[i] = static_cast<std::uint8_t>(kKept | *direction);
    recount(forged);
    const CheckResult result = c.check(forged);
    EXPECT_EQ(result.verdict, c.meets(i) ? Verdict::refuted : Verdict::not_proved);
    EXPECT_EQ(result.pair, c.pairs[i]);
  }
  EXPECT_EQ(changed, 40);
}

TEST(CertificateClearance, KeptPairsWhoseBoxesAreFartherApartNeedNoEvidence) {
  const Case& c = lattice_case();
  std::vector<TrianglePair> all;
  reference::for_each_pair(c.scene, [&](const TrianglePair& pair, bool) { all.push_back(pair); });
  ASSERT_GT(all.size(), c.pairs.size());
  const Certificate certificate =
      make_certificate(c.scene, all, c.meeting, some_run(), c.certificate.clearance);
  EXPECT_EQ(c.check(certificate).verdict, Verdict::proved);
  EXPECT_EQ(certificate.claims.kept, c.pairs.size());
  // Without a clearance they are no pairs of a run, and of the pairs found none may be so.
  EXPECT_THROW(make_certificate(c.scene, all, {}, some_run()), std::logic_error);
  EXPECT_THROW(make_certificate(c.scene, all, all, some_run(), 1), std::logic_error);
  for (const double wrong : {-1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(make_certificate(c.scene, {}, {}, some_run(), wrong), std::logic_error);
}

TEST(CertificateClearance, TextKeepsEveryBit) {
  Certificate certificate = lattice_case().certificate;
  for (const double clearance :
       {1.0, 0.1, above(0.1), 1e-9, 5e-324, 0x1.fffffffffffffp+1023, 0x1.23456789abcdep-7}) {
    certificate.clearance = clearance;
    const std::string text = to_text(certificate);
    EXPECT_EQ(parse_certificate(text, "text"), certificate) << clearance;
    EXPECT_TRUE(has_text(text, "\"version\": 4,"));
  }
  certificate.clearance = 0;
  EXPECT_TRUE(has_text(to_text(certificate), "\"version\": 3,"));
  EXPECT_FALSE(has_text(to_text(certificate), "clearance"));
}

// ---- lists without a certificate ----

TEST(CertificateOfAList, ProvesTheRightListAlone) {
  for (const double clearance : {0.0, 1.0}) {
    const Case c(lattice(), clearance);
    std::vector<TrianglePair> any(c.meeting.rbegin(), c.meeting.rend());  // any order
    any.push_back(any.front());                                           // twice
    const CheckResult right =
        check_certificate(certificate_of_list(c.scene, any, clearance), c.scene);
    EXPECT_EQ(right.verdict, Verdict::proved) << right.reason;
    EXPECT_EQ(right.meeting, c.meeting);

    std::vector<TrianglePair> fewer = c.meeting;
    const TrianglePair dropped = fewer[fewer.size() / 2];
    std::erase(fewer, dropped);
    const CheckResult less =
        check_certificate(certificate_of_list(c.scene, fewer, clearance), c.scene);
    EXPECT_EQ(less.verdict, Verdict::refuted);
    EXPECT_EQ(less.pair, dropped);

    std::vector<TrianglePair> more = c.meeting;
    const std::size_t i = [&] {
      for (std::size_t k = 0;; ++k)
        if (!c.meets(k)) return k;
    }();
    more.push_back(c.pairs[i]);
    const CheckResult wrong =
        check_certificate(certificate_of_list(c.scene, more, clearance), c.scene);
    EXPECT_EQ(wrong.verdict, Verdict::refuted);
    EXPECT_EQ(wrong.pair, c.pairs[i]);
    EXPECT_EQ(wrong.meeting, c.meeting);  // decided by the checker, whatever the list says
  }
}

// ---- Certificates of scenes whose objects are tested against themselves: neighbours.

const Case& folded() {
  static const Case folded(on_lattice(4, 60, 4));
  return folded;
}

TEST(CertificateSelf, CountsNeighboursApart) {
  const Case& c = folded();
  const CheckResult result = c.check(c.certificate);
  EXPECT_EQ(result.verdict, Verdict::proved) << result.reason;
  EXPECT_EQ(result.found, c.certificate.claims);
  EXPECT_EQ(result.found.neighbours, c.neighbours);
  EXPECT_EQ(result.found.meeting, c.meeting.size());
  EXPECT_EQ(result.found.separated, c.pairs.size() - c.meeting.size() - c.neighbours);
  EXPECT_GT(c.neighbours, 100u);
}

TEST(CertificateSelf, EveryFalseByteOfNeighboursIsCaught) {
  const Case& c = folded();
  int meeting = 0, apart = 0;
  for (std::size_t i = 0; i < c.pairs.size() && meeting + apart < 40; ++i) {
    if (!reference::neighbours(c.scene, c.pairs[i])) continue;
    const bool meets = c.meets(i);
    ++(meets ? meeting : apart);
    for (const int claim : {0, 37, static_cast<int>(kMeets), static_cast<int>(kNeighbours), 40}) {
      if (claim == (meets ? kMeets : kNeighbours)) continue;
      Certificate changed = c.certificate;
      changed.evidence[i] = static_cast<std::uint8_t>(kKept | claim);
      recount(changed);
      const CheckResult result = c.check(changed);
      const bool refuted = meets ? claim != 40 : claim == kMeets;
      EXPECT_EQ(result.verdict, refuted ? Verdict::refuted : Verdict::not_proved) << claim;
      EXPECT_EQ(result.pair, c.pairs[i]);
    }
    if (!meets) continue;
    Certificate culled = c.certificate;  // a culled pair of neighbours that meets
    culled.evidence[i] = kNeighbours;
    recount(culled);
    EXPECT_EQ(c.check(culled).verdict, Verdict::refuted);
    EXPECT_EQ(c.check(culled).culled_meeting, 1u);
  }
  EXPECT_GT(meeting, 2);
  EXPECT_GT(apart, 10);
}

}  // namespace
}  // namespace farcull
