// Two hierarchies searched at once for leaves whose volumes meet, on all threads: what the peers do
// whose library has trees, but a traversal of one thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "experiments/peers/parts.h"

namespace farcull {

/// A node of each of two trees, whose leaves are to be compared.
///
/// A Tree has, for nodes that are numbered by int with the root 0: is_leaf(node), left(node),
/// right(node), triangle(leaf), size(node) of which only the order matters, and
/// meets(node, other, node of other), which is true wherever triangles of the two could meet.
template <class Tree>
struct TreeTask {
  const Tree* first;
  const Tree* second;
  int a = 0;
  int b = 0;
  bool inner = false;  // the leaves below a with each other; then first is second and a is b
};

/// Where a task goes on: with the larger node divided, or at leaves (found) and disjoint volumes
/// nowhere.
template <class Tree, class Found, class Next>
void step(const TreeTask<Tree>& task, const Found& found, const Next& next) {
  const Tree& first = *task.first;
  const Tree& second = *task.second;
  const auto with = [&](int left, int right, bool inner = false) {
    next(TreeTask<Tree>{&first, &second, left, right, inner});
  };
  if (task.inner) {
    if (first.is_leaf(task.a)) return;
    const int left = first.left(task.a), right = first.right(task.a);
    with(left, left, true);
    with(right, right, true);
    with(left, right);
    return;
  }
  if (!first.meets(task.a, second, task.b)) return;
  const bool leaf = first.is_leaf(task.a), other_leaf = second.is_leaf(task.b);
  if (leaf && other_leaf) {
    found(first.triangle(task.a), second.triangle(task.b));
  } else if (other_leaf || (!leaf && first.size(task.a) > second.size(task.b))) {
    with(first.left(task.a), task.b);
    with(first.right(task.a), task.b);
  } else {
    with(task.a, second.left(task.b));
    with(task.a, second.right(task.b));
  }
}

template <class Tree, class Found>
void descend(const TreeTask<Tree>& task, const Found& found) {
  step(task, found, [&found](const TreeTask<Tree>& next) { descend(next, found); });
}

/// Gives the candidates of all tasks to `candidates`; of a tree with itself, without neighbours by
/// index. `candidates` is parallel iff threads > 1.
template <class Tree>
void search_trees(const Scene& scene, std::vector<TreeTask<Tree>> tasks, unsigned threads,
                  PeerCandidates& candidates) {
  // Divided until there is enough for all threads.
  const std::size_t enough = threads > 1 ? 64 * threads : 1;
  const auto with = [&](const TreeTask<Tree>& task, PeerCandidates::Part& part) {
    return [&scene, &part, self = task.first == task.second](std::uint32_t a, std::uint32_t b) {
      if (!self || !share_vertex(scene, a, b)) part.add(a, b);
    };
  };
  while (!tasks.empty() && tasks.size() < enough) {
    std::vector<TreeTask<Tree>> finer;
    for (const TreeTask<Tree>& task : tasks) {
      step(task, with(task, candidates.part()),
           [&finer](const TreeTask<Tree>& next) { finer.push_back(next); });
    }
    tasks = std::move(finer);
  }
  for_each_taken(tasks.size(), 1, threads,
                 [&](std::size_t i) { descend(tasks[i], with(tasks[i], candidates.part())); });
}

}  // namespace farcull
