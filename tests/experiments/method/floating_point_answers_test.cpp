// Answers in every floating-point environment that a caller may have, from all that decides,
// accounts and checks. The twins call a predicate without a guard, and it is wrong.
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "tests/lab/flat.h"
#include "tests/lab/floating_point.h"
#include "tests/lab/unwrapped.h"

namespace farcull {
namespace {

using lab::Disturbed, lab::Environment, lab::environments;

// Enough pairs that several threads decide.
constexpr std::size_t kCopies = 48;
constexpr std::size_t kPairs = kCopies * kCopies;

struct Sample {
  std::string name;
  Scene scene;
  std::size_t colliding;
};

// test(environment, sample) for each, with what it says about the failure.
template <class Test>
void for_all(const Test& test) {
  for (const Sample& sample : {Sample{"tiny", lab::tiny_scene(kCopies), kPairs},
                               Sample{"huge", lab::huge_scene(kCopies), kPairs},
                               Sample{"subnormal", lab::subnormal_scene(kCopies), 0}}) {
    for (const Environment& environment : environments()) {
      SCOPED_TRACE(sample.name + " in the environment: " + environment.name);
      test(environment, sample);
      EXPECT_EQ(floating_point(), kProved);
    }
  }
}

// Without the guard the calls below are wrong about each scene, in the environments that it is made
// for.
TEST(FloatingPointAnswers, TwinsWithoutAGuardAreWrong) {
  const auto wrong_in = [](const Scene& scene) {
    const auto a = scene.corners(0), b = scene.corners(1);
    const bool truth = intersects(a, b);
    std::vector<std::string> out;
    for (const Environment& environment : environments()) {
      const Disturbed disturbed(environment);
      if (intersects(a, b) != truth) out.push_back(environment.name);
    }
    return out;
  };
  using Names = std::vector<std::string>;
#ifdef __SSE2__
  const Names flushing = {"results", "operands", "both", "both, upward"};
  EXPECT_EQ(wrong_in(lab::tiny_scene()), flushing);
  EXPECT_EQ(wrong_in(lab::subnormal_scene()), flushing);
#endif
  EXPECT_EQ(wrong_in(lab::huge_scene()), (Names{"downward", "toward zero"}));
}

TEST(FloatingPointAnswers, ExactTestsOfAllPairs) {
  for_all([](const Environment& environment, const Sample& sample) {
    ExactResult result;
    FloatingPoint after;
    {
      const Disturbed disturbed(environment);
      result = all_colliding_pairs(sample.scene, {.threads = 3});
      after = floating_point();
    }
    EXPECT_EQ(result.box_pairs, kPairs);
    EXPECT_EQ(result.pairs.size(), sample.colliding);
    EXPECT_EQ(after, environment.found);
  });
}

TEST(FloatingPointAnswers, Accounting) {
  for_all([](const Environment& environment, const Sample& sample) {
    Accounting result;
    {
      const Disturbed disturbed(environment);
      result = account(sample.scene, {});
    }
    EXPECT_TRUE(result.adds_up());
    EXPECT_EQ(result.certified_by_boxes, 0u);
    EXPECT_EQ(result.false_negatives, sample.colliding);
    EXPECT_EQ(result.certified_by_predicates, kPairs - sample.colliding);
  });
}

// A certificate is made and checked; a false one, which says the contrary of each pair, is refuted.
TEST(FloatingPointAnswers, Certificates) {
  Certificate::Run run;
  run.method = "exact";
  for_all([&](const Environment& environment, const Sample& sample) {
    const ExactResult exact = all_colliding_pairs(sample.scene);
    Certificate made, refuted;
    CheckResult right, wrong;
    {
      const Disturbed disturbed(environment);
      made = make_certificate(sample.scene, exact.pairs, exact.pairs, run);
      right = check_certificate(made, sample.scene);
      refuted = made;
      for (std::uint8_t& byte : refuted.evidence) byte = sample.colliding > 0 ? 0 : kKept | kMeets;
      Certificate::Claims& claims = refuted.claims;
      std::swap(claims.kept, claims.culled);
      std::swap(claims.meeting, claims.separated);
      wrong = check_certificate(refuted, sample.scene);
    }
    EXPECT_EQ(made.claims.meeting, sample.colliding);
    EXPECT_EQ(made.claims.box_pairs, kPairs);
    EXPECT_EQ(right.verdict, Verdict::proved) << right.reason;
    EXPECT_EQ(wrong.verdict, Verdict::refuted) << wrong.reason;
  });
}

TEST(FloatingPointAnswers, EveryMethodWithoutGlAndItsRecord) {
  for_all([](const Environment& environment, const Sample& sample) {
    for (const Method method : {Method::exact, Method::boxes, Method::i_collide}) {
      RunOptions options;
      options.method = method;
      Record record;
      {
        const Disturbed disturbed(environment);
        Session session(options.device);
        record = run(sample.scene, options, session);
      }
      EXPECT_EQ(record.collisions.pairs.size(), sample.colliding) << to_string(method);
      EXPECT_EQ(record.verification->false_negatives, 0u) << to_string(method);
      EXPECT_EQ(record.callers, environment.found);
      EXPECT_EQ(record.used, kProved);

      const nlohmann::ordered_json json = to_json(sample.scene, record)["floating_point"];
      EXPECT_EQ(json["callers"]["rounding"], to_string(environment.found.rounding));
      EXPECT_EQ(json["callers"]["flushes_results"], environment.found.flushes_results);
      EXPECT_EQ(json["callers"]["flushes_operands"], environment.found.flushes_operands);
      EXPECT_EQ(json["used"]["rounding"], "to nearest");
      EXPECT_EQ(json["used"]["flushes_results"], false);
      EXPECT_EQ(json["used"]["flushes_operands"], false);
      const std::string table = lab::unwrapped(run_table(sample.scene, record));
      EXPECT_TRUE(has_text(table, "floats     rounds to nearest, keeps subnormals; the caller " +
                                      to_string(environment.found)));
    }
  });
}

// A collider's, and the caller's environment afterwards, also where the call throws.
TEST(FloatingPointAnswers, Collider) {
  for_all([](const Environment& environment, const Sample& sample) {
    const Flat flat(sample.scene);
    Result found;
    FloatingPoint after_making, after, after_throwing;
    bool threw = false;
    {
      const Disturbed disturbed(environment);
      farcull::Collider collider({.threads = 3});
      after_making = floating_point();
      found = collider.find(flat.input());
      after = floating_point();
      try {
        collider.find({flat.vertices, flat.triangles, std::vector<std::uint32_t>{1}});
      } catch (const Error&) {
        threw = true;
        after_throwing = floating_point();
      }
    }
    EXPECT_EQ(found.pairs.size(), sample.colliding);
    EXPECT_EQ(found.report.callers_arithmetic, to_string(environment.found));
    EXPECT_TRUE(threw);
    for (const FloatingPoint& f : {after_making, after, after_throwing})
      EXPECT_EQ(f, environment.found);
  });
}

}  // namespace
}  // namespace farcull
