// Distances by CGAL: the triangles of one object against the AABB_tree of another. The tree's own
// functions measure from a point alone, so its traversal is given a triangle and the least distance
// so far, and leaves out the nodes whose boxes are farther away.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/squared_distance_3.h>
#include <CGAL/version.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/base/stopwatch.h"
#include "experiments/peers/distance_peers.h"
#include "experiments/peers/distance_tasks.h"
#include "experiments/peers/parts.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = Kernel::Triangle_3;
using Triangles = std::vector<Triangle>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;

double squared_gap(const CGAL::Bbox_3& a, const CGAL::Bbox_3& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({a.min(axis) - b.max(axis), b.min(axis) - a.max(axis), 0.0});
    sum += gap * gap;
  }
  return sum;
}

/// What AABB_tree::traversal() asks: where to descend, and what to do at a triangle.
class NearerTriangle {
 public:
  NearerTriangle(const Triangle& triangle, double& least)
      : triangle_(triangle), box_(triangle.bbox()), least_(least) {}

  bool go_further() const { return least_ > 0; }
  void intersection(const Triangle&, const Primitive& primitive) {
    const Triangle& other = *primitive.id();
    if (squared_gap(box_, other.bbox()) >= least_) return;
    const double found = CGAL::squared_distance(triangle_, other);
    if (found < least_) least_ = found;
  }
  template <class Node>
  bool do_intersect(const Triangle&, const Node& node) const {
    return squared_gap(box_, node.bbox()) < least_;
  }

 private:
  const Triangle& triangle_;
  CGAL::Bbox_3 box_;
  double& least_;
};

struct TreeOfObject {
  std::uint32_t number = 0;  // of the object
  Triangles triangles;
  CGAL::Bbox_3 box;
  Tree tree;
};

/// The square of the distance where it is below `most`; else `most`.
double squared_distance_of(const TreeOfObject& a, const TreeOfObject& b, double most) {
  if (squared_gap(a.box, b.box) >= most) return most;
  const TreeOfObject& asked = a.triangles.size() < b.triangles.size() ? a : b;
  const TreeOfObject& tree = &asked == &a ? b : a;
  double least = most;
  // A first bound: from one corner, by the tree's own function.
  const double first = tree.tree.squared_distance(asked.triangles.front()[0]);
  if (first < least) least = std::nextafter(first, HUGE_VAL);
  for (const Triangle& triangle : asked.triangles) {
    if (squared_gap(triangle.bbox(), tree.box) >= least) continue;
    NearerTriangle nearer(triangle, least);
    tree.tree.traversal(triangle, nearer);
    if (least <= 0) break;
  }
  return least;
}

std::vector<std::unique_ptr<TreeOfObject>> trees_of(const Scene& scene, unsigned threads) {
  std::vector<std::unique_ptr<TreeOfObject>> out;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    if (scene.objects[o].triangle_count == 0) continue;
    out.push_back(std::make_unique<TreeOfObject>());
    out.back()->number = o;
  }
  for_each_taken(out.size(), 1, threads, [&](std::size_t i) {
    TreeOfObject& object = *out[i];
    const Object& of = scene.objects[object.number];
    object.triangles.reserve(of.triangle_count);
    for (std::uint32_t t = 0; t < of.triangle_count; ++t) {
      const auto corners = scene.corners(of.first_triangle + t);
      const auto point = [&corners](int k) {
        return Kernel::Point_3(corners[k][0], corners[k][1], corners[k][2]);
      };
      object.triangles.emplace_back(point(0), point(1), point(2));
      object.box += object.triangles.back().bbox();
    }
    object.tree.rebuild(object.triangles.begin(), object.triangles.end());
    object.tree.build();
    object.tree.accelerate_distance_queries();
  });
  return out;
}

double root_within(double squared, double within) {
  const double root = std::sqrt(squared);
  return root <= within ? root : std::numeric_limits<double>::infinity();
}

PeerDistances ask(const Scene& scene, const PeerQuestion& question, unsigned threads) {
  const Stopwatch building;
  const auto trees = trees_of(scene, threads);
  PeerDistances answer{.build_ms = building.ms()};
  const Stopwatch asking;
  std::vector<std::uint32_t> numbers;
  for (const auto& tree : trees) numbers.push_back(tree->number);
  answer.distances = distances_of_trees(
      numbers, question.task, std::nextafter(question.within * question.within, HUGE_VAL), threads,
      [&](std::size_t i, std::size_t k) { return squared_gap(trees[i]->box, trees[k]->box); },
      [&](std::size_t i, std::size_t k, double least) {
        return squared_distance_of(*trees[i], *trees[k], least);
      },
      [&](double squared) { return root_within(squared, question.within); });
  answer.query_ms = asking.ms();
  return answer;
}

}  // namespace

std::vector<DistancePeer> cgal_distance_peers() {
  return {{.name = "cgal-aabb",
           .library = "CGAL " CGAL_VERSION_STR,
           .run = ask,
           .refuses = [](const Scene& scene) {
             return degenerate_triangles(scene) == 0
                        ? std::string()
                        : std::string("its tree and distances take no degenerate triangle");
           }}};
}

}  // namespace farcull
