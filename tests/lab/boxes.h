// Boxes that move, and their pairs by brute force: what the tests of the sweep share.
#pragma once

#include "core/boxes/join.h"
#include "core/sweep/sweep_prune.h"
#include "tests/lab/rational.h"

namespace farcull::lab {

using Boxes = std::vector<Box>;
using Indices = std::vector<std::uint32_t>;
using Pairs = std::vector<TrianglePair>;

/// Its own comparison, so that overlap() is not what tests itself.
inline bool meet(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i)
    if (!(std::max(a.lo[i], b.lo[i]) <= std::min(a.hi[i], b.hi[i]))) return false;
  return true;
}

template <class Counts>
inline Pairs brute_force(const Boxes& boxes, const Counts& counts) {
  Pairs pairs;
  for (std::uint32_t a = 0; a < boxes.size(); ++a) {
    for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
      if (counts(a, b) && meet(boxes[a], boxes[b])) pairs.push_back({a, b});
  }
  return pairs;
}

inline Pairs brute_force(const Boxes& boxes) {
  return brute_force(boxes, [](std::uint32_t, std::uint32_t) { return true; });
}

inline Box cube(double lo, double hi) { return {Vec3::Constant(lo), Vec3::Constant(hi)}; }
inline Box along_x(double lo, double hi) { return {Vec3(lo, 0, 0), Vec3(hi, 1, 1)}; }

/// One step of boxes that move: small steps, jumps, coordinates of few values, boxes that are
/// points or empty, and the ends of the doubles.
inline void move(Boxes& boxes, rational::Random& random, int kind) {
  for (Box& box : boxes) {
    if (random.below(3) == 0) continue;
    Vec3 by = random.cube(kind == 3 ? 9 : 0.3);
    if (kind % 2 == 0) by = Vec3(random.below(3) - 1, random.below(3) - 1, random.below(3) - 1);
    const bool was_huge = box.hi.cwiseAbs().maxCoeff() > 1e6;
    if (was_huge || box.is_empty()) box = cube(0, random.below(2));
    box = {box.lo + by, box.hi + by};
    const int axis = random.below(3);
    const int change = random.below(40);
    if (change == 0) box.hi[axis] = box.lo[axis];
    if (change == 1) box.lo = box.hi;
    if (change == 2) std::swap(box.lo, box.hi);  // empty, or a point
    if (change == 3) box = cube(-0.0, 0.0);
    if (change == 4) box = cube(-DBL_MAX, DBL_MAX);
    if (change == 5) box.hi[axis] = DBL_MAX;
    if (change == 6) box = boxes[random.below(static_cast<int>(boxes.size()))];
  }
}

inline Boxes some_boxes(rational::Random& random, int count) {
  Boxes boxes;
  for (int i = 0; i < count; ++i) {
    const Vec3 at(random.below(9), random.below(9), random.below(9));
    boxes.push_back({at, at + Vec3(random.below(3), random.below(3), random.below(3))});
  }
  return boxes;
}

}  // namespace farcull::lab
