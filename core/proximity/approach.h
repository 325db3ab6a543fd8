// Objects one after the other, by the distance of their boxes.
#pragma once

#include <cstdint>
#include <queue>

#include "core/proximity/scene_trees.h"

namespace farcull {

inline double square_of_gap(const Box& a, const Box& b) {
  return (a.lo - b.hi).cwiseMax(b.lo - a.hi).cwiseMax(0).squaredNorm();
}

/// Objects in the order of their boxes' gaps from a box; of those with the same gap the lower one
/// first. All is scaled.
class Approach {
 public:
  Approach(const SceneTrees& trees, const Box& box) : trees_(trees), box_(box) {
    const BoxTree& tree = trees.objects();
    if (tree.levels > 0) queue_.push({0, tree.levels, 0});
  }
  /// False where none is left, or the squared gap is above the limit.
  bool next(double square_limit, std::uint32_t& object) {
    while (!queue_.empty() && queue_.top().square <= square_limit) {
      const Node at = queue_.top();
      queue_.pop();
      if (at.height == 0) {
        object = at.k;
        return true;
      }
      const auto below = static_cast<std::size_t>(at.height - 1);
      const WideBoxes& block = trees_.blocks()[trees_.objects().first[below] + at.k];
      for (std::uint32_t lane = 0; lane < kWide; ++lane) {
        const double square = square_of_gap(block.get(lane), box_);
        if (!(square <= square_limit)) continue;
        const std::uint32_t child = kWide * at.k + lane;
        queue_.push({square, at.height - 1, at.height > 1 ? child : trees_.object(child)});
      }
    }
    return false;
  }

 private:
  struct Node {
    double square;
    int height;
    std::uint32_t k;                           // of height 0: the object
    bool operator<(const Node& other) const {  // the nearest one is the top
      if (square != other.square) return square > other.square;
      return height != other.height ? height < other.height : k > other.k;
    }
  };
  const SceneTrees& trees_;
  Box box_;
  std::priority_queue<Node> queue_;
};

}  // namespace farcull
