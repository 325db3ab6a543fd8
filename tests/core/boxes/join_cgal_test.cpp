// The join of boxes that the method `exact` takes, against CGAL's (Zomorodian, Edelsbrunner: Fast
// software for box intersections, 2002), which shares no code with it.
#include <CGAL/box_intersection_d.h>
#include <gtest/gtest.h>

#include <mutex>

#include "core/boxes/join.h"
#include "tests/lab/boxes.h"
#include "tests/lab/rational.h"
#include "tests/lab/scenes.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using lab::Boxes;
using lab::Indices;
using lab::Pairs;
using rational::Random;

struct CgalBox {
  using NT = double;
  using ID = std::uint32_t;
  Box box;
  std::uint32_t index;

  static int dimension() { return 3; }
  double min_coord(int axis) const { return box.lo[axis]; }
  double max_coord(int axis) const { return box.hi[axis]; }
  ID id() const { return index; }
};

// open: boxes without their upper sides.
Pairs by_cgal(const Boxes& boxes, const Indices& owners, std::ptrdiff_t cutoff, bool open = false) {
  std::vector<CgalBox> all;
  for (std::uint32_t k = 0; k < boxes.size(); ++k) all.push_back({boxes[k], k});
  std::vector<const CgalBox*> handles;
  for (const CgalBox& box : all) handles.push_back(&box);
  Pairs out;
  CGAL::box_self_intersection_d(
      handles.begin(), handles.end(),
      [&](const CgalBox* a, const CgalBox* b) {
        if (owners[a->index] != owners[b->index])
          out.push_back({std::min(a->index, b->index), std::max(a->index, b->index)});
      },
      cutoff, open ? CGAL::Box_intersection_d::HALF_OPEN : CGAL::Box_intersection_d::CLOSED);
  std::ranges::sort(out);
  return out;
}

// As `exact` does: of triangles, whose pairs come some at a time from several threads.
Pairs of_triangles(const Boxes& boxes, const Indices& owners, unsigned threads) {
  Scene scene;
  for (std::uint32_t k = 0; k < boxes.size(); ++k) {
    add_triangle(scene, {boxes[k].lo, boxes[k].hi, boxes[k].lo});
    if (k == 0 || owners[k] != owners[k - 1]) scene.objects.push_back({"", k, 0, false});
    ++scene.objects.back().triangle_count;
  }
  Pairs out;
  std::mutex mutex;
  OrderedPairs(scene, 0, {}, true, threads).give([&](Pairs& some) {
    const std::scoped_lock lock(mutex);
    out.insert(out.end(), some.begin(), some.end());
  });
  std::ranges::sort(out);
  return out;
}

// Boxes without their upper sides: comparisons that are strict where they should not be.
Boxes below(Boxes boxes) {
  for (Box& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      const double less = std::nextafter(box.hi[axis], -HUGE_VAL);
      if (less >= box.lo[axis]) box.hi[axis] = less;
    }
  }
  return boxes;
}

enum class Kind { apart, grid, copies, flat, points, endless, decades };

Boxes boxes_of(Kind kind, Random& random, int count) {
  constexpr double kMax = DBL_MAX;
  Boxes out;
  for (int k = 0; k < count; ++k) {
    const Vec3 cell(random.below(12), random.below(12), random.below(6));
    const int axis = random.below(3);
    Box box{cell, cell + Vec3(random.below(2) + 1, random.below(2) + 1, random.below(2) + 1)};
    switch (kind) {
      case Kind::apart: {
        const Vec3 at = random.cube(5);
        box = {at, at + Vec3(random.cube(1).cwiseAbs())};
        break;
      }
      case Kind::copies:
        if (k > 5) box = out[static_cast<std::size_t>(random.below(k))];
        break;
      case Kind::flat:
        box.hi[axis] = box.lo[axis];
        break;
      case Kind::points:
        if (k % 2 == 0) box.hi = box.lo;
        break;
      case Kind::endless:
        if (k % 3 == 0) box.hi[axis] = kMax;
        if (k % 5 == 0) box.lo[axis] = -kMax;
        if (k % 50 == 0) box = {Vec3::Constant(-kMax), Vec3::Constant(kMax)};
        break;
      case Kind::decades: {
        const Vec3 at = random.scaled3(-40, 4);
        box = {at, at + Vec3(random.scaled3(-60, 4).cwiseAbs())};
        break;
      }
      case Kind::grid:
        break;
    }
    out.push_back(box);
  }
  return out;
}

TEST(BoxJoins, OursAndThatOfCgalFindTheSamePairs) {
  Random random(1303);
  for (const Kind kind : {Kind::apart, Kind::grid, Kind::copies, Kind::flat, Kind::points,
                          Kind::endless, Kind::decades}) {
    // Few objects, whose leaves stand one after the other; many; each box alone, as in a mesh that
    // is tested against itself.
    for (const std::uint32_t objects : {2u, 50u, 700u}) {
      const int count = 700;
      const Boxes boxes = boxes_of(kind, random, count);
      Indices owners;
      for (std::uint32_t k = 0; k < boxes.size(); ++k) owners.push_back(k * objects / count);
      const Pairs expected = by_cgal(boxes, owners, 10);
      const auto at = [&] {
        return "kind " + std::to_string(static_cast<int>(kind)) + ", " + std::to_string(objects);
      };
      ASSERT_GT(expected.size(), 100u) << at();
      ASSERT_EQ(by_cgal(boxes, owners, 2000), expected) << at();
      Indices items(boxes.size());
      std::iota(items.begin(), items.end(), 0u);
      ASSERT_EQ(box_join(boxes, owners, items), expected) << at();
      for (const unsigned threads : {1u, 3u})
        ASSERT_EQ(of_triangles(boxes, owners, threads), expected) << at();
      // The twins: a join that is strict at one side loses pairs that touch.
      if (kind == Kind::apart || kind == Kind::copies || kind == Kind::decades) continue;
      EXPECT_LT(by_cgal(boxes, owners, 10, true).size(), expected.size()) << at();
      EXPECT_LT(of_triangles(below(boxes), owners, 1).size(), expected.size()) << at();
    }
  }
}

}  // namespace
}  // namespace farcull
