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
#include "experiments/measure/peers/distance_peers.h"
#include "experiments/measure/peers/parts.h"
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
  const double most = std::nextafter(question.within * question.within, HUGE_VAL);
  if (question.task == DistanceTask::objects) {
    std::vector<std::pair<std::size_t, std::size_t>> tasks;
    for (std::size_t i = 0; i < trees.size(); ++i) {
      for (std::size_t k = i + 1; k < trees.size(); ++k) tasks.emplace_back(i, k);
    }
    answer.distances.resize(tasks.size());
    for_each_taken(tasks.size(), 1, threads, [&](std::size_t t) {
      const TreeOfObject &a = *trees[tasks[t].first], &b = *trees[tasks[t].second];
      answer.distances[t] = {a.number, b.number,
                             root_within(squared_distance_of(a, b, most), question.within)};
    });
  } else {
    answer.distances.resize(trees.size());
    for_each_taken(trees.size(), 1, threads, [&](std::size_t i) {
      // By the gaps of boxes, the least one first.
      std::vector<std::pair<double, std::size_t>> others;
      for (std::size_t k = 0; k < trees.size(); ++k) {
        if (k != i) others.emplace_back(squared_gap(trees[i]->box, trees[k]->box), k);
      }
      std::sort(others.begin(), others.end());
      double least = most;
      std::uint32_t nearest = trees[i]->number;
      for (const auto& [gap, k] : others) {
        if (gap >= least) break;
        const double found = squared_distance_of(*trees[i], *trees[k], least);
        if (found < least) {
          least = found;
          nearest = trees[k]->number;
        }
      }
      const double found = nearest == trees[i]->number ? std::numeric_limits<double>::infinity()
                                                       : root_within(least, question.within);
      answer.distances[i] = {trees[i]->number, nearest, found};
    });
  }
  std::erase_if(answer.distances, [](const PeerDistance& d) { return std::isinf(d.distance); });
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
