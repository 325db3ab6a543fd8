// The filter of planes on lanes answers as the scalar text does, on every instruction set, and
// decide() answers as the predicates on two triangles do.
#include "verify/filter.h"

#include "tests/lab/hard_pairs.h"
#include "tests/lab/lanes.h"
#include "verify/exact.h"
#include "verify/filter_scalars.h"

namespace farcull {
namespace {

using hard_pairs::Sharing, reference::Triangle;

constexpr std::array kSharings = {Sharing::none, Sharing::vertex, Sharing::edge};

/// Pairs, each of two triangles of its own, and a scene of them.
struct PairsOfScene {
  Scene scene;
  std::vector<TrianglePair> pairs;

  void add(const Triangle& a, const Triangle& b) {
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    for (const Triangle* t : {&a, &b}) {
      const auto v = static_cast<std::uint32_t>(scene.vertices.size());
      scene.vertices.insert(scene.vertices.end(), t->begin(), t->end());
      scene.triangles.push_back({v, v + 1, v + 2});
    }
    pairs.push_back({first, first + 1});
  }
};

/// Pairs of a generator, in all rotations of their corners, as they are and times powers of two at
/// which products underflow and overflow.
PairsOfScene made(const hard_pairs::Make& make, Sharing sharing, int count) {
  PairsOfScene out;
  RandomDraws random(7);
  for (int n = 0; n < count; ++n) {
    auto [a, b] = make(random);
    hard_pairs::share(sharing, a, b);
    std::rotate(a.begin(), a.begin() + n / 8 % 3, a.end());
    std::rotate(b.begin(), b.begin() + n / 24 % 3, b.end());
    constexpr std::array<int, 8> kExponents = {0, 0, 0, 0, -1070, -350, 340, 1020};
    const int exponent = kExponents[n % 8];
    const auto scaled =
        hard_pairs::mapped({a, b}, [=](double x) { return std::ldexp(x, exponent); });
    if (hard_pairs::finite(scaled)) out.add(scaled.a, scaled.b);
  }
  return out;
}

std::vector<Triage> on_lanes(const PairsOfScene& of, double clearance) {
  std::vector<Triage> answers(of.pairs.size());
  filter_pairs(of.scene, of.pairs, clearance, answers);
  return answers;
}

template <class Bounds>
std::vector<Triage> on_scalars(const PairsOfScene& of, double clearance) {
  std::vector<Triage> answers;
  for (const TrianglePair& p : of.pairs) {
    answers.push_back(
        filters::filter_planes<Bounds>(of.scene.corners(p.a), of.scene.corners(p.b), clearance));
  }
  return answers;
}

std::int64_t differences(const std::vector<Triage>& a, const std::vector<Triage>& b) {
  EXPECT_EQ(a.size(), b.size());
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

TEST(FilterLanes, AnswerAsTheScalarTextOnEveryTarget) {
  std::array<std::int64_t, 3> answers{};
  for (const auto& [name, make] : hard_pairs::generators()) {
    for (const Sharing sharing : kSharings) {
      const PairsOfScene of = made(make, sharing, 24000);
      for (const double clearance : {0.0, 1e-3, 1.0, 1e300}) {
        const std::vector<Triage> scalar = on_scalars<FilterBounds>(of, clearance);
        for (const Triage t : scalar) ++answers[static_cast<int>(t)];
        for (const std::string& target : lane_targets()) {
          const UseLanes use(target);
          EXPECT_EQ(differences(on_lanes(of, clearance), scalar), 0)
              << name << " " << static_cast<int>(sharing) << " " << clearance << " " << target;
        }
      }
    }
  }
  for (const std::int64_t count : answers) EXPECT_GT(count, 20000);
}

// A vector that is not full, and pairs that are not in the order of the scene.
TEST(FilterLanes, AnswerForAnyNumberOfPairsInAnyOrder) {
  PairsOfScene of = made(hard_pairs::generators().front().second, Sharing::none, 300);
  std::ranges::reverse(of.pairs);
  const std::vector<Triage> all = on_scalars<FilterBounds>(of, 0);
  for (const std::string& target : lane_targets()) {
    const UseLanes use(target);
    for (std::size_t count = 0; count <= 200; ++count) {
      std::vector<Triage> answers(count);
      filter_pairs(of.scene, std::span(of.pairs).first(count), 0, answers);
      EXPECT_TRUE(std::equal(answers.begin(), answers.end(), all.begin()))
          << target << " " << count;
    }
  }
}

// So decide() looks for common corners only where the filter does not answer.
TEST(FilterLanes, KnowNothingOfTrianglesThatShareACorner) {
  for (const auto& [name, make] : hard_pairs::generators()) {
    for (const Sharing sharing : {Sharing::vertex, Sharing::edge}) {
      const PairsOfScene of = made(make, sharing, 8000);
      for (const double clearance : {0.0, 1e-3, 1.0}) {
        const std::vector<Triage> answers = on_lanes(of, clearance);
        EXPECT_EQ(std::ranges::count(answers, Triage::unknown), answers.size())
            << name << " " << static_cast<int>(sharing) << " " << clearance;
      }
    }
  }
}

// ---- twins that must fail ----

// The pairs are close enough to the bounds that another one shows.
TEST(FilterLanesTwin, WithASmallerBoundTheAnswersDiffer) {
  const PairsOfScene close = made(hard_pairs::nearly_coplanar, Sharing::none, 8000);
  const PairsOfScene tiny = made(hard_pairs::extreme, Sharing::none, 8000);
  for (const std::string& target : lane_targets()) {
    const UseLanes use(target);
    EXPECT_GT(differences(on_lanes(close, 0), on_scalars<hard_pairs::NoSide>(close, 0)), 0)
        << target;
    EXPECT_GT(differences(on_lanes(tiny, 0), on_scalars<hard_pairs::NoAbsolute>(tiny, 0)), 0)
        << target;
  }
}

TEST(FilterLanesTwin, WithTheLanesExchangedTheAnswersDiffer) {
  std::int64_t different = 0;
  for (const auto& [name, make] : hard_pairs::generators()) {
    const PairsOfScene of = made(make, Sharing::none, 8000);
    std::vector<Triage> answers = on_lanes(of, 0);
    for (std::size_t i = 1; i < answers.size(); i += 2) std::swap(answers[i - 1], answers[i]);
    different += differences(answers, on_scalars<FilterBounds>(of, 0));
  }
  EXPECT_GT(different, 1000);
}

TEST(FilterLanesTwin, WithoutTheBoundOfSidesSharedCornersAreDecided) {
  const PairsOfScene of = made(hard_pairs::nearly_coplanar, Sharing::vertex, 8000);
  const std::vector<Triage> answers = on_scalars<hard_pairs::NoSide>(of, 0);
  EXPECT_LT(std::ranges::count(answers, Triage::unknown), answers.size());
}

// ---- decide() ----

/// A rough sheet whose triangles share vertices, some of them only positions, a second object
/// through it, and neighbours in one plane.
Scene crossing_sheets() {
  constexpr int kSide = 12;
  RandomDraws random(3);
  Scene scene;
  for (int object = 0; object < 2; ++object) {
    const auto base = static_cast<std::uint32_t>(scene.vertices.size());
    for (int i = 0; i <= kSide; ++i) {
      for (int j = 0; j <= kSide; ++j) {
        const double rough = i < 4 ? 0 : random.between(-0.6, 0.6);
        scene.vertices.push_back(object == 0 ? Vec3(i, j, rough) : Vec3(0.9 * i, rough, j - 6.5));
      }
    }
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    const auto at = [&](int i, int j) {
      auto v = static_cast<std::uint32_t>(base + i * (kSide + 1) + j);
      if (!random.chance(6)) return v;
      scene.vertices.push_back(scene.vertices[v]);  // the position again
      if (scene.vertices.back().z() == 0) scene.vertices.back().z() = -0.0;
      return static_cast<std::uint32_t>(scene.vertices.size() - 1);
    };
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        scene.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        scene.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
    const auto count = static_cast<std::uint32_t>(scene.triangles.size()) - first;
    scene.objects.push_back(
        {.name = "sheet", .first_triangle = first, .triangle_count = count, .self = true});
  }
  return scene;
}

PairAnswer answer_alone(const Scene& scene, const TrianglePair& pair, const ExactQuestion& how) {
  const Triangle a = scene.corners(pair.a), b = scene.corners(pair.b);
  const std::uint32_t second = scene.objects[1].first_triangle;
  if ((pair.a < second) == (pair.b < second) && share_position(a, b)) {
    if (!how.neighbours) return PairAnswer::neighbours_unasked;
    return intersects_beyond_shared(a, b) ? PairAnswer::neighbours_colliding
                                          : PairAnswer::neighbours_apart;
  }
  return within(a, b, how.clearance) ? PairAnswer::colliding : PairAnswer::apart;
}

void expect_answers_alone(const Scene& scene, const std::vector<TrianglePair>& pairs,
                          const ExactQuestion& how) {
  std::vector<PairAnswer> answers;
  for (const TrianglePair& pair : pairs) answers.push_back(answer_alone(scene, pair, how));
  const Collisions expected = count_answers(pairs, answers);
  EXPECT_GT(expected.pairs.size(), 0u);
  EXPECT_GT(expected.neighbours, 0u);
  for (const std::string& target : lane_targets()) {
    const UseLanes use(target);
    const Collisions found = decide(scene, pairs, how);
    EXPECT_EQ(found.pairs, expected.pairs) << target;
    EXPECT_EQ(found.neighbour_pairs, expected.neighbour_pairs) << target;
    EXPECT_EQ(found.neighbours, expected.neighbours) << target;
    EXPECT_EQ(found.apart, expected.apart) << target;
    EXPECT_EQ(found.neighbours_apart, expected.neighbours_apart) << target;
  }
}

// Few neighbours in a block, or many, which are set aside first.
TEST(FilterLanes, DecideAnswersAsThePredicatesOnTwoTriangles) {
  const Scene scene = crossing_sheets();
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  std::vector<TrianglePair> all, near;
  for (std::uint32_t a = 0; a < count; ++a)
    for (std::uint32_t b = a + 1; b < count; ++b) all.push_back({a, b});
  const std::vector<Box> boxes = triangle_boxes(scene);
  std::copy_if(all.begin(), all.end(), std::back_inserter(near),
               [&](const TrianglePair& p) { return overlap(boxes[p.a], boxes[p.b]); });
  ASSERT_GT(near.size(), 2048u);  // more than two blocks
  for (const bool neighbours : {false, true}) {
    for (const double clearance : {0.0, 0.1}) {
      for (const unsigned threads : {1u, 2u}) {
        const ExactQuestion how{clearance, threads, neighbours};
        expect_answers_alone(scene, near, how);
        if (clearance == 0) expect_answers_alone(scene, all, how);
      }
    }
  }
}

}  // namespace
}  // namespace farcull
