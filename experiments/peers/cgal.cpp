// CGAL as a broad phase and for distances.
// - Broad phases: box_intersection_d (Zomorodian, Edelsbrunner: Fast software for box
//   intersections, 2002) and AABB_tree. CGAL only compares boxes and gives candidates.
// - Distances, by AABB_tree.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/squared_distance_3.h>
#include <CGAL/version.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/peers/peer.h"

namespace farcull {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = Kernel::Triangle_3;
using Triangles = std::vector<Triangle>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;

constexpr const char* kLibrary = "CGAL " CGAL_VERSION_STR;

Triangle triangle(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  return {{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}, {c.x(), c.y(), c.z()}};
}

constexpr std::ptrdiff_t kUntuned = 10;  // CGAL's default cutoff
constexpr std::ptrdiff_t kTuned = 2000;

/// A box with the interface that box_intersection_d expects.
struct PeerBox {
  using NT = double;
  using ID = std::uint32_t;
  Box box;
  std::uint32_t index;  // index of a triangle or an object

  static int dimension() { return 3; }
  double min_coord(int axis) const { return box.lo[axis]; }
  double max_coord(int axis) const { return box.hi[axis]; }
  ID id() const { return index; }
};
using Handles = std::vector<const PeerBox*>;

Handles handles(const std::vector<PeerBox>& boxes) {
  Handles all;
  all.reserve(boxes.size());
  for (const PeerBox& box : boxes) all.push_back(&box);
  return all;
}

/// Finds all overlapping boxes in one call of box_intersection_d, as in CGAL's manual.
template <std::ptrdiff_t cutoff>
BenchAnswer join_boxes(const Scene& raw, unsigned threads) {
  PeerCandidates candidates(raw, threads, false);
  const PeerScene scene(raw);
  if (!scene.has_pairs()) return candidates.finish();
  std::vector<PeerBox> boxes;
  boxes.reserve(scene.boxes.size());
  for (const Box& box : scene.boxes)
    boxes.push_back({box, static_cast<std::uint32_t>(boxes.size())});
  Handles all = handles(boxes);
  PeerCandidates::Part& part = candidates.part();
  if (scene.two_sides) {
    const auto second = all.begin() + scene.second;
    CGAL::box_intersection_d(
        all.begin(), second, second, all.end(),
        [&part](const PeerBox* a, const PeerBox* b) { part.add(a->index, b->index); }, cutoff);
  } else {
    CGAL::box_self_intersection_d(
        all.begin(), all.end(),
        [&part, &scene](const PeerBox* a, const PeerBox* b) {
          if (scene.counts(a->index, b->index)) part.add(a->index, b->index);
        },
        cutoff);
  }
  return candidates.finish();
}

std::vector<PeerBox> clipped(const PeerScene& scene, const Object& object, const Box& region) {
  std::vector<PeerBox> inside;
  for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
    const std::uint32_t t = object.first_triangle + i;
    if (overlap(scene.boxes[t], region)) inside.push_back({scene.boxes[t], t});
  }
  return inside;
}

/// Finds overlapping triangle boxes for each pair of objects, and within each `self` object. Only
/// boxes that overlap the intersection of the two objects' boxes are compared.
BenchAnswer join_object_pairs(const Scene& raw, unsigned threads) {
  // With one pair of objects, only the exact decisions can be divided over threads.
  const bool parallel = threads > 1 && raw.objects.size() > 2;
  PeerCandidates candidates(raw, threads, parallel);
  const PeerScene scene(raw);
  const std::vector<Box> regions = object_boxes(raw, scene.boxes);
  std::vector<TrianglePair> meeting;  // pairs of objects, and (o, o) for each `self` object o
  for (std::uint32_t o = 0; o < raw.objects.size(); ++o) {
    if (raw.objects[o].self) meeting.push_back({o, o});
  }
  std::vector<PeerBox> boxes;
  for (std::uint32_t o = 0; o < regions.size(); ++o) {
    if (!regions[o].is_empty()) boxes.push_back({regions[o], o});
  }
  Handles all = handles(boxes);
  CGAL::box_self_intersection_d(
      all.begin(), all.end(),
      [&](const PeerBox* a, const PeerBox* b) {
        meeting.push_back({a->index, b->index});
      },
      kTuned);
  const auto join = [&](std::size_t i) {
    const auto [o, p] = meeting[i];
    const Box region = intersection(regions[o], regions[p]);
    PeerCandidates::Part& part = candidates.part();
    const auto add = [&part](const PeerBox* a, const PeerBox* b) { part.add(a->index, b->index); };
    const std::vector<PeerBox> first = clipped(scene, raw.objects[o], region);
    Handles of_first = handles(first);
    if (o == p) {
      CGAL::box_self_intersection_d(
          of_first.begin(), of_first.end(),
          [&](const PeerBox* a, const PeerBox* b) {
            if (scene.counts(a->index, b->index)) add(a, b);
          },
          kTuned);
      return;
    }
    const std::vector<PeerBox> second = clipped(scene, raw.objects[p], region);
    Handles of_second = handles(second);
    CGAL::box_intersection_d(of_first.begin(), of_first.end(), of_second.begin(), of_second.end(),
                             add, kTuned);
  };
  for_each_shared(meeting.size(), parallel ? threads : 1, join);
  return candidates.finish();
}

/// Collects the triangles whose boxes overlap the query box.
template <class Found>
struct Walk {
  Found found;

  bool go_further() const { return true; }
  bool do_intersect(const CGAL::Bbox_3& box, const CGAL::AABB_node<Traits>& node) const {
    return CGAL::do_overlap(box, node.bbox());
  }
  void intersection(const CGAL::Bbox_3& box, const Primitive& primitive) {
    if (CGAL::do_overlap(box, primitive.datum().bbox())) found(primitive.id());
  }
};

/// Searches a tree for the boxes that overlap each triangle's box. If only two objects are tested
/// against each other (PeerScene::two_sides), the tree has the smaller object's triangles, and the
/// queries are the larger object's triangles. Else all triangles are in the tree, and are queries.
BenchAnswer search_tree(const Scene& raw, unsigned threads) {
  const Stopwatch building;
  const PeerScene scene(raw);
  const std::size_t count = raw.triangles.size();
  std::size_t begin = 0, end = count;  // range of the triangles in the tree
  if (scene.two_sides) (scene.second < count - scene.second ? end : begin) = scene.second;
  Triangles triangles;
  triangles.reserve(end - begin);
  for (std::size_t t = begin; t < end; ++t) triangles.push_back(triangle(raw.corners(t)));
  std::optional<Tree> tree;
  if (scene.has_pairs()) {
    tree.emplace(triangles.cbegin(), triangles.cend());
    tree->build();
  }
  const double build_ms = building.ms();

  PeerCandidates candidates(raw, threads, threads > 1);
  const auto search = [&](std::size_t i) {
    const auto t = static_cast<std::uint32_t>(i);
    if (scene.two_sides && t >= begin && t < end) return;
    PeerCandidates::Part& part = candidates.part();
    const auto found = [&](Triangles::const_iterator at) {
      const auto other = static_cast<std::uint32_t>(begin + (at - triangles.cbegin()));
      if (scene.two_sides || (other > t && scene.counts(t, other))) part.add(t, other);
    };
    const CGAL::Bbox_3 box = (scene.two_sides ? triangle(raw.corners(t)) : triangles[i]).bbox();
    Walk<decltype(found)> walk{found};
    tree->traversal(box, walk);
  };
  constexpr std::size_t kBlock = 256;  // number of triangles that a thread takes at a time
  if (tree) {
    for_each_shared((count + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
      for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
        search(i);
    });
  }
  return candidates.finish(build_ms);
}

// Distances between the triangles of one object and the AABB_tree of another object. CGAL's
// distance functions of a tree accept only points. So the code below calls the tree's traversal
// with a triangle and the least distance so far. Nodes whose boxes are farther away are skipped.

double squared_gap(const CGAL::Bbox_3& a, const CGAL::Bbox_3& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({a.min(axis) - b.max(axis), b.min(axis) - a.max(axis), 0.0});
    sum += gap * gap;
  }
  return sum;
}

/// Controls AABB_tree::traversal(): decides where to descend, and measures the distance to a
/// triangle.
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
  std::uint32_t number = 0;  // the object's number
  Triangles triangles;
  CGAL::Bbox_3 box;
  Tree tree;
};

/// Returns the squared distance of a and b, or `most` if the squared distance is larger.
double squared_distance_of(const TreeOfObject& a, const TreeOfObject& b, double most) {
  if (squared_gap(a.box, b.box) >= most) return most;
  const TreeOfObject& asked = a.triangles.size() < b.triangles.size() ? a : b;
  const TreeOfObject& tree = &asked == &a ? b : a;
  double least = most;
  // The distance of one corner from the tree is the first upper bound.
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
  for (const std::uint32_t o : objects_with_triangles(scene)) {
    out.push_back(std::make_unique<TreeOfObject>());
    out.back()->number = o;
  }
  for_each_shared(out.size(), threads, [&](std::size_t i) {
    TreeOfObject& object = *out[i];
    const Object& of = scene.objects[object.number];
    object.triangles.reserve(of.triangle_count);
    for (std::uint32_t t = 0; t < of.triangle_count; ++t) {
      object.triangles.push_back(triangle(scene.corners(of.first_triangle + t)));
      object.box += object.triangles.back().bbox();
    }
    object.tree.rebuild(object.triangles.begin(), object.triangles.end());
    object.tree.build();
    object.tree.accelerate_distance_queries();
  });
  return out;
}

/// For each tree, returns the nearest other tree. Only squared distances below `most` count.
std::vector<PeerDistance> nearest(const std::vector<std::unique_ptr<TreeOfObject>>& trees,
                                  double most, unsigned threads) {
  std::vector<PeerDistance> out(trees.size());
  for_each_shared(trees.size(), threads, [&](std::size_t i) {
    std::vector<std::pair<double, std::size_t>> others;  // squared gap of the boxes, index
    for (std::size_t k = 0; k < trees.size(); ++k) {
      if (k != i) others.emplace_back(squared_gap(trees[i]->box, trees[k]->box), k);
    }
    std::sort(others.begin(), others.end());
    out[i] = {trees[i]->number, trees[i]->number, most};
    for (const auto& [gap, k] : others) {
      if (gap >= out[i].distance) break;
      const double found = squared_distance_of(*trees[i], *trees[k], out[i].distance);
      if (found < out[i].distance) out[i] = {trees[i]->number, trees[k]->number, found};
    }
  });
  std::erase_if(out, [](const PeerDistance& d) { return d.a == d.b; });
  for (PeerDistance& d : out) d.distance = std::sqrt(d.distance);
  return out;
}

PeerDistances distances(const Scene& scene, const PeerQuestion& question, unsigned threads) {
  const Stopwatch building;
  const auto trees = trees_of(scene, threads);
  PeerDistances answer{.build_ms = building.ms()};
  const Stopwatch asking;
  const double most = std::nextafter(question.within * question.within, HUGE_VAL);
  if (question.task == DistanceTask::nearest) {
    answer.distances = nearest(trees, most, threads);
  } else {
    answer.distances = distances_of_pairs(
        objects_with_triangles(scene), threads, [&](std::size_t i, std::size_t k) {
          return std::sqrt(squared_distance_of(*trees[i], *trees[k], most));
        });
  }
  std::erase_if(answer.distances,
                [&](const PeerDistance& d) { return d.distance > question.within; });
  answer.query_ms = asking.ms();
  return answer;
}

}  // namespace

LibraryPeers cgal_library() {
  const auto refuses = [](const Scene& scene) {
    return refuse_degenerate(scene, "its tree and distances take no degenerate triangle");
  };
  return {.broad = {plain_peer("cgal-boxes", kLibrary, join_boxes<kUntuned>),
                    plain_peer("cgal-boxes-2000", kLibrary, join_boxes<kTuned>),
                    plain_peer("cgal-object-pairs", kLibrary, join_object_pairs),
                    plain_peer("cgal-aabb", kLibrary, search_tree)},
          .distances = {
              {.name = "cgal-aabb", .library = kLibrary, .run = distances, .refuses = refuses}}};
}

}  // namespace farcull
