// Pairs that are streamed are those of Collider::find(), in order, whatever the options.
#include "core/base/random.h"
#include "experiments/library/farcull.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/flat.h"

namespace farcull {
namespace {

/// What find() answers, as a stream would give it.
std::vector<ColliderFound> found_by(const ColliderOptions& options, const ColliderInput& input) {
  const ColliderResult result = Collider(options).find(input);
  std::vector<ColliderFound> out;
  const auto append = [&](const auto& pairs, const auto& contacts, bool neighbours) {
    for (std::size_t k = 0; k < pairs.size(); ++k)
      out.push_back({pairs[k], neighbours, contacts.empty() ? ColliderContact() : contacts[k]});
  };
  append(result.pairs, result.contacts, false);
  append(result.neighbour_pairs, result.neighbour_contacts, true);
  std::ranges::sort(out, {}, &ColliderFound::pair);
  return out;
}

struct Streamed {
  std::vector<ColliderFound> pairs;
  std::size_t largest = 0;  // part
  std::uint64_t decided = 0;
  bool complete = false;
};
Streamed streamed(const ColliderOptions& options, const ColliderInput& input) {
  ColliderStream stream(input, options);
  Streamed out;
  for (std::vector<ColliderFound> part; stream.next(part);) {
    out.largest = std::max(out.largest, part.size());
    out.pairs.insert(out.pairs.end(), part.begin(), part.end());
  }
  out.decided = stream.decided();
  out.complete = stream.complete();
  return out;
}

TEST(LibraryStream, GivesThePairsOfFindInOrder) {
  for (const char* name : {"two-spheres", "degenerate", "random-soup", "crowd", "far-apart"}) {
    const Flat flat(make_builtin_scene(name));
    for (const ColliderOptions& options :
         {ColliderOptions{}, ColliderOptions{.threads = 3, .self = true},
          ColliderOptions{.self = true, .neighbours = false},
          ColliderOptions{.clearance = 0.01, .contacts = ColliderContacts::kinds},
          ColliderOptions{.self = true, .ignore = {{0, 1}}}}) {
      const Streamed found = streamed(options, flat.input());
      EXPECT_EQ(found.pairs, found_by(options, flat.input())) << name;
      EXPECT_TRUE(found.complete);
    }
  }
}

TEST(LibraryStream, EndsAtTheLimit) {
  const Flat flat(make_builtin_scene("random-soup"));
  const Streamed all = streamed({}, flat.input());
  ASSERT_GT(all.pairs.size(), 100u);
  for (const std::size_t limit : {std::size_t{1}, std::size_t{50}, all.pairs.size() + 1}) {
    const Streamed some = streamed({.limit = limit}, flat.input());
    const std::size_t count = std::min(limit, all.pairs.size());
    EXPECT_EQ(some.pairs, std::vector<ColliderFound>(all.pairs.begin(),
                                                     all.pairs.begin() + static_cast<long>(count)));
    EXPECT_EQ(some.complete, limit > all.pairs.size());
    if (limit == 1) {
      EXPECT_LT(some.decided, all.decided / 2);
    }
  }
}

/// Many triangles in one place: each collides with every other one.
TEST(LibraryStream, HoldsAPartOfThePairsAtATime) {
  RandomNumbers random(631);
  std::vector<double> points;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t k = 0; k < 3 * 1200; ++k) {
    for (int axis = 0; axis < 3; ++axis)
      points.push_back((axis == static_cast<int>(k % 3) ? 1.0 : -0.5) + 0.1 * random.between(0, 1));
    triangles.push_back(k);
  }
  const ColliderInput input{points, triangles, {}};
  const ColliderOptions options{.threads = 2, .self = true};
  const Streamed found = streamed(options, input);
  EXPECT_EQ(found.pairs, found_by(options, input));
  EXPECT_GT(found.pairs.size(), 300'000u);
  EXPECT_LT(found.largest, 80'000u);
}

TEST(LibraryStream, RefusesWhatTheColliderRefuses) {
  const auto refused = [](const ColliderOptions& options, const ColliderInput& input) {
    return refusal([&] { ColliderStream stream(input, options); })[0];
  };
  const std::vector<double> points = {0, 0, 0};
  const std::vector<std::uint32_t> triangles = {0, 0, 1};
  EXPECT_EQ(refused({}, {points, triangles, {}}), "triangles");
  EXPECT_EQ(refused({.device = ColliderDevice::gl}, {}), "device");
  EXPECT_EQ(refused({.clearance = -1}, {}), "clearance");
  EXPECT_EQ(refused({.ignore = {{0, 1}}}, {}), "ignore");
  EXPECT_EQ(refused({}, {}), "nothing was thrown");
}

}  // namespace
}  // namespace farcull
