// What the library says of contacts, and what it leaves out when it is told to: ignored objects,
// and pairs beyond a limit. Each is held against the answer without that option.

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/flat.h"
#include "verify/contact.h"

namespace farcull {
namespace {

/// Two crossing triangles, one that stands on the first with a corner, one far away.
const std::vector<double> kPoints = {0, 0, 0, 8, 0, 0, 0, 8, 0, 1,  1, -1, 1,  1, 1, 1,  3, 0,
                                     4, 2, 0, 4, 2, 3, 5, 2, 3, 90, 0, 0,  91, 0, 0, 90, 1, 0};
const std::vector<std::uint32_t> kTriangles = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
const std::vector<std::uint32_t> kStarts = {0, 1, 2, 3};
const Input kFour = {kPoints, kTriangles, kStarts};

/// Four objects of triangles between the points of a grid: many touch, are neighbours, lie in one
/// plane, or are degenerate.
Scene tangled(std::uint64_t seed) {
  RandomNumbers random(seed);
  Scene scene;
  for (int i = 0; i < 64; ++i) scene.vertices.emplace_back(i % 4, i / 4 % 4, i / 16);
  for (std::uint32_t o = 0; o < 4; ++o) scene.objects.push_back({"", 40 * o, 40, true});
  for (int t = 0; t < 160; ++t) {
    const auto corner = [&] { return static_cast<std::uint32_t>(random.below(64)); };
    const std::uint32_t i = corner(), j = corner();
    scene.triangles.push_back({i, j, corner()});
    scene.source_face.push_back(0);
  }
  return scene;
}

TEST(LibraryContacts, AreSaidOfEachPair) {
  const Result silent = Collider().find(kFour);
  EXPECT_TRUE(silent.contacts.empty());
  const Result kinds = Collider({.contacts = Contacts::kinds}).find(kFour);
  ASSERT_EQ(kinds.pairs, (std::vector<Pair>{{0, 1}, {0, 2}}));
  EXPECT_EQ(kinds.pairs, silent.pairs);
  EXPECT_EQ(kinds.contacts[0].kind, Contact::Kind::crossing);
  EXPECT_EQ(kinds.contacts[1].kind, Contact::Kind::touch_vertex);
  EXPECT_EQ(kinds.contacts[0].dimension, -1);
  const Result all = Collider({.contacts = Contacts::segments}).find(kFour);
  EXPECT_EQ(all.contacts[0], (Contact{Contact::Kind::crossing, 1, {{{1, 1, 0}, {1, 3, 0}}}}));
  EXPECT_EQ(all.contacts[1], (Contact{Contact::Kind::touch_vertex, 0, {{{4, 2, 0}, {4, 2, 0}}}}));
}

TEST(LibraryContacts, AreThoseOfTheTrianglesNeighboursToo) {
  const Scene scene = tangled(1);
  const Options options{.self = true, .contacts = Contacts::segments};
  const Result found = Collider(options).find(Flat(scene).input());
  ASSERT_EQ(found.contacts.size(), found.pairs.size());
  ASSERT_EQ(found.neighbour_contacts.size(), found.neighbour_pairs.size());
  EXPECT_FALSE(found.neighbour_pairs.empty());
  const auto expect = [&](const std::vector<Pair>& pairs, const std::vector<Contact>& contacts) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const ContactShape shape =
          contact_shape(scene.corners(pairs[k].a), scene.corners(pairs[k].b));
      EXPECT_EQ(to_string(contacts[k].kind), name_of(shape.kind));
      EXPECT_EQ(contacts[k].dimension, shape.dimension);
      for (int end = 0; end < 2; ++end)
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_EQ(contacts[k].ends[end][axis], shape.ends[end][axis]);
    }
  };
  expect(found.pairs, found.contacts);
  expect(found.neighbour_pairs, found.neighbour_contacts);
}

std::vector<Pair> without(const Scene& scene, std::vector<Pair> pairs,
                          const std::vector<std::array<std::uint32_t, 2>>& ignored) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::erase_if(pairs, [&](const Pair& pair) {
    return std::ranges::any_of(ignored, [&](const auto& two) {
      return std::minmax(owner[pair.a], owner[pair.b]) == std::minmax(two[0], two[1]);
    });
  });
  return pairs;
}

TEST(LibraryIgnore, AnswersAsIfItWereFilteredAfterwards) {
  const Scene scene = tangled(2);
  const Flat flat(scene);
  const Result all = Collider({.self = true}).find(flat.input());
  const std::vector<std::array<std::uint32_t, 2>> ignored = {{3, 1}, {0, 1}, {1, 3}};
  const Result found = Collider({.self = true, .ignore = ignored}).find(flat.input());
  EXPECT_EQ(found.pairs, without(scene, all.pairs, ignored));
  EXPECT_EQ(found.neighbour_pairs, all.neighbour_pairs);  // these are of one object
  EXPECT_LT(found.report.candidates, all.report.candidates);
  // The twin: one pair of objects less is noticed.
  const Result fewer = Collider({.self = true, .ignore = {{0, 1}}}).find(flat.input());
  EXPECT_NE(fewer.pairs, found.pairs);
}

TEST(LibraryIgnore, RefusesObjectsThatThereAreNot) {
  const auto refused = [](const std::vector<std::array<std::uint32_t, 2>>& ignored) {
    Collider collider({.ignore = ignored});
    const auto [where, reason] = refusal([&] { collider.find(kFour); });
    return where + ": " + reason;
  };
  EXPECT_EQ(refused({{0, 1}}), "nothing was thrown: nothing was thrown");
  EXPECT_EQ(refused({{0, 4}}), "ignore: names objects 0 and 4 of 4, numbered from 0");
  EXPECT_EQ(refused({{2, 2}}), "ignore: names objects 2 and 2, which are one");
  // All are ignored, so 0 pairs would say nothing; with `self` there is a question.
  const Options all{.ignore = {{0, 1}, {0, 2}, {3, 0}, {1, 2}, {1, 3}, {2, 3}}};
  EXPECT_EQ(refusal([&] { collide(kFour, all); })[0], "ignore");
  EXPECT_NO_THROW(collide(kFour, {.self = true, .ignore = all.ignore}));
}

}  // namespace
}  // namespace farcull
