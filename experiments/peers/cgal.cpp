// CGAL's broad phases: box_intersection_d (Zomorodian, Edelsbrunner: Fast software for box
// intersections, 2002) and AABB_tree. Only their boxes are CGAL's here; what they find is decided
// as everyone's candidates are.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/version.h>

#include <memory>
#include <optional>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#endif

#include "experiments/peers/parts.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr const char* kLibrary = "CGAL " CGAL_VERSION_STR;
constexpr std::ptrdiff_t kUntuned = 10;  // CGAL's default cutoff
constexpr std::ptrdiff_t kTuned = 2000;

/// A box with the interface that box_intersection_d expects.
struct PeerBox {
  using NT = double;
  using ID = std::uint32_t;
  Box box;
  std::uint32_t index;  // of a triangle or an object

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

std::vector<PeerBox> numbered(const std::vector<Box>& boxes) {
  std::vector<PeerBox> all;
  all.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) all.push_back({boxes[i], i});
  return all;
}

/// All boxes at once, as the manual calls it.
template <class Tag>
BenchAnswer join_boxes(const Scene& raw, std::ptrdiff_t cutoff, unsigned threads) {
  constexpr bool kParallel = !std::is_same_v<Tag, CGAL::Sequential_tag>;
  PeerCandidates candidates(raw, threads, kParallel);
  const PeerScene scene(raw);
  if (!scene.has_pairs()) return candidates.finish();
  const std::vector<PeerBox> boxes = numbered(scene.boxes);
  Handles all = handles(boxes);
  PeerCandidates::Part* const only = kParallel ? nullptr : &candidates.part();
  const auto add = [&candidates, only](std::uint32_t a, std::uint32_t b) {
    (kParallel ? candidates.part() : *only).add(a, b);
  };
  if (scene.two_sides) {
    const auto second = all.begin() + scene.second;
    CGAL::box_intersection_d<Tag>(
        all.begin(), second, second, all.end(),
        [add](const PeerBox* a, const PeerBox* b) { add(a->index, b->index); }, cutoff);
  } else {
    CGAL::box_self_intersection_d<Tag>(
        all.begin(), all.end(),
        [add, &scene](const PeerBox* a, const PeerBox* b) {
          if (scene.counts(a->index, b->index)) add(a->index, b->index);
        },
        cutoff);
  }
  return candidates.finish();
}

/// The boxes of an object that meet a region.
std::vector<PeerBox> clipped(const PeerScene& scene, const Object& object, const Box& region) {
  std::vector<PeerBox> inside;
  for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
    const std::uint32_t t = object.first_triangle + i;
    if (overlap(scene.boxes[t], region)) inside.push_back({scene.boxes[t], t});
  }
  return inside;
}

/// The boxes of two objects after another, or of one with itself, clipped to the common part of the
/// objects' boxes.
BenchAnswer join_object_pairs(const Scene& raw, unsigned threads) {
  // With one pair of objects there is nothing to divide but the decisions.
  const bool parallel = threads > 1 && raw.objects.size() > 2;
  PeerCandidates candidates(raw, threads, parallel);
  const PeerScene scene(raw);
  const std::vector<Box> regions = object_boxes(raw, scene.boxes);
  std::vector<TrianglePair> meeting;  // of objects; one with itself where it is self
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
            if (!share_vertex(raw, a->index, b->index)) add(a, b);
          },
          kTuned);
      return;
    }
    const std::vector<PeerBox> second = clipped(scene, raw.objects[p], region);
    Handles of_second = handles(second);
    CGAL::box_intersection_d(of_first.begin(), of_first.end(), of_second.begin(), of_second.end(),
                             add, kTuned);
  };
  for_each_taken(meeting.size(), 1, parallel ? threads : 1, join);
  return candidates.finish();
}

using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;

Kernel::Triangle_3 triangle(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  return {{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}, {c.x(), c.y(), c.z()}};
}

/// Asks the tree for the triangles whose boxes meet the box of a query, on the way down by its box
/// or by the query itself.
template <class Query, class Found>
struct Walk {
  CGAL::Bbox_3 box;
  Found found;

  bool go_further() const { return true; }
  bool do_intersect(const Query& query, const CGAL::AABB_node<Traits>& node) const {
    if constexpr (std::is_same_v<Query, CGAL::Bbox_3>) {
      return CGAL::do_overlap(query, node.bbox());
    } else {
      return CGAL::do_overlap(box, node.bbox()) && CGAL::do_intersect(query, node.bbox());
    }
  }
  void intersection(const Query&, const Primitive& primitive) {
    if (CGAL::do_overlap(box, primitive.datum().bbox())) found(primitive.id());
  }
};

/// A tree of the smaller side, asked with the triangles of the other one; or of all, asked with
/// all.
template <bool by_triangle>
BenchAnswer search_tree(const Scene& raw, unsigned threads) {
  const Stopwatch building;
  const PeerScene scene(raw);
  const auto count = static_cast<std::uint32_t>(raw.triangles.size());
  std::uint32_t begin = 0, end = count;  // of the tree
  if (scene.two_sides) {
    if (scene.second < count - scene.second) {
      end = scene.second;
    } else {
      begin = scene.second;
    }
  }
  Triangles triangles;
  triangles.reserve(end - begin);
  for (std::uint32_t t = begin; t < end; ++t) triangles.push_back(triangle(raw.corners(t)));
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
      const auto other = begin + static_cast<std::uint32_t>(at - triangles.cbegin());
      if (scene.two_sides || (other > t && scene.counts(t, other))) part.add(t, other);
    };
    const Kernel::Triangle_3 query = scene.two_sides ? triangle(raw.corners(t)) : triangles[i];
    const CGAL::Bbox_3 box = query.bbox();
    // The test of a triangle against a box takes no degenerate ones.
    if (by_triangle && shape(raw.corners(t)) == Shape::triangle) {
      Walk<Kernel::Triangle_3, decltype(found)> walk{box, found};
      tree->traversal(query, walk);
    } else {
      Walk<CGAL::Bbox_3, decltype(found)> walk{box, found};
      tree->traversal(box, walk);
    }
  };
  if (tree) for_each_taken(count, 256, threads, search);
  BenchAnswer answer = candidates.finish();
  answer.build_ms = build_ms;
  return answer;
}

template <class Tag>
std::function<BenchRun(unsigned)> boxes(std::ptrdiff_t cutoff) {
  return [cutoff](unsigned threads) -> BenchRun {
    return [=](const Scene& scene) { return join_boxes<Tag>(scene, cutoff, threads); };
  };
}

#ifdef CGAL_LINKED_WITH_TBB
// TBB's threads start with the first run, the cold one, which counts for nothing else.
std::function<BenchRun(unsigned)> parallel_boxes(std::ptrdiff_t cutoff) {
  return [cutoff](unsigned threads) -> BenchRun {
    const auto limit = std::make_shared<tbb::global_control>(
        tbb::global_control::max_allowed_parallelism, threads);
    return [=](const Scene& scene) {
      (void)limit;
      return join_boxes<CGAL::Parallel_tag>(scene, cutoff, threads);
    };
  };
}
#endif

}  // namespace

bool cgal_do_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return CGAL::do_intersect(triangle(a), triangle(b));
}

std::vector<Peer> cgal_peers(unsigned threads) {
  const auto by = [](BenchAnswer (*run)(const Scene&, unsigned)) {
    return [run](unsigned n) -> BenchRun {
      return [run, n](const Scene& scene) { return run(scene, n); };
    };
  };
  std::vector<Peer> peers = {
      {"cgal-boxes", kLibrary, "", boxes<CGAL::Sequential_tag>(kUntuned)},
      {"cgal-boxes-2000", kLibrary, "", boxes<CGAL::Sequential_tag>(kTuned)},
      {"cgal-boxes-parallel", kLibrary, ""},
      {"cgal-boxes-2000-parallel", kLibrary, ""},
      {"cgal-object-pairs", kLibrary, "", by(join_object_pairs)},
      {"cgal-aabb", kLibrary, "", by(search_tree<false>)},
      {"cgal-aabb-triangles", kLibrary, "", by(search_tree<true>)},
  };
#ifdef CGAL_LINKED_WITH_TBB
  peers[2].set_up = parallel_boxes(kUntuned);
  peers[3].set_up = parallel_boxes(kTuned);
  const char* const missing = threads > 1 ? "" : "the same as without -parallel on one thread";
#else
  const char* const missing = "built without TBB (Debian: libtbb-dev)";
  (void)threads;
#endif
  peers[2].missing = peers[3].missing = missing;
  return peers;
}

}  // namespace farcull
