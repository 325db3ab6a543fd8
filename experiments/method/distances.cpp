// Distances between objects. Trees of boxes (core/proximity) find candidate pairs of triangles.
// Exact arithmetic finds the nearest of these pairs.
#include "experiments/method/distances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "verify/exact.h"
#include "verify/filter.h"
#include "verify/inside.h"

namespace farcull {

// A *part* of an object is a connected component of its triangles. Triangles are connected if they
// share a vertex position. Suppose that a part does not meet a closed mesh. Then a path between two
// points of the part never crosses the mesh. The winding number and the parity change only at a
// crossing. So all points of the part lie inside, or no point does, and one vertex decides.

std::vector<Vec3> point_of_each_part(const Scene& scene, const Object& object) {
  struct Corner {
    std::array<double, 3> place;
    std::uint32_t triangle;
  };
  std::vector<Corner> corners;
  corners.reserve(3 * std::size_t{object.triangle_count});
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    for (const Vec3& p : scene.corners(object.first_triangle + t))
      corners.push_back({{p.x(), p.y(), p.z()}, t});  // -0.0 equals 0.0
  }
  std::ranges::sort(corners, {}, &Corner::place);
  std::vector<std::uint32_t> leader(object.triangle_count);  // union-find; root: lowest triangle
  std::iota(leader.begin(), leader.end(), 0u);
  const auto leader_of = [&](std::uint32_t t) {
    while (leader[t] != t) t = leader[t] = leader[leader[t]];
    return t;
  };
  for (std::size_t k = 1; k < corners.size(); ++k) {
    if (corners[k].place != corners[k - 1].place) continue;
    const std::uint32_t s = leader_of(corners[k].triangle);
    const std::uint32_t t = leader_of(corners[k - 1].triangle);
    leader[std::max(s, t)] = std::min(s, t);
  }
  std::vector<Vec3> out;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    if (leader[t] == t) out.push_back(scene.corners(object.first_triangle + t)[0]);
  }
  return out;
}

struct Insides::OfObject {
  Box box;
  std::once_flag closed_found, parts_found;
  Surface surface = Surface::open;
  std::vector<Vec3> parts;
};

Insides::Insides(const Scene& scene) : scene_(scene), objects_(new OfObject[scene.objects.size()]) {
  const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
  for (std::size_t o = 0; o < boxes.size(); ++o) objects_[o].box = boxes[o];
}
Insides::~Insides() = default;

// True if all of `inner` lies inside `outer`. Sets not_closed if the boxes are nested but `outer`
// is not closed, so that it has no inside.
bool Insides::contains(std::uint32_t outer, std::uint32_t inner, bool& not_closed) const {
  OfObject& in = objects_[inner];
  OfObject& out = objects_[outer];
  if (!lies_within(in.box, out.box)) return false;
  std::call_once(out.closed_found, [&] { out.surface = surface_of(scene_, outer); });
  if (out.surface == Surface::open) {
    not_closed = true;
    return false;
  }
  std::call_once(in.parts_found,
                 [&] { in.parts = point_of_each_part(scene_, scene_.objects[inner]); });
  return std::ranges::all_of(in.parts, [&](const Vec3& point) {
    const Inside answer = inside(scene_, outer, point, out.surface);
    if (answer == Inside::on) throw std::logic_error("which_inside: the objects meet");
    return answer == Inside::yes;
  });
}

WhichInside Insides::which(std::uint32_t a, std::uint32_t b) const {
  bool not_closed = false;
  if (contains(b, a, not_closed)) return WhichInside::a;
  if (contains(a, b, not_closed)) return WhichInside::b;
  return not_closed ? WhichInside::not_closed : WhichInside::none;
}

namespace {

// The number of pairs of triangles that a thread decides at a time.
constexpr std::size_t kTogether = 256;

std::vector<ObjectPair> every_two_objects(const Scene& scene) {
  std::vector<ObjectPair> out;
  const auto count = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t a = 0; a < count; ++a) {
    if (scene.objects[a].triangle_count == 0) continue;
    if (scene.objects[a].self) out.push_back({a, a});
    for (std::uint32_t b = a + 1; b < count; ++b) {
      if (scene.objects[b].triangle_count > 0) out.push_back({a, b});
    }
  }
  return out;
}

std::uint64_t count_of_questions(const Scene& scene) {
  std::uint64_t objects = 0, themselves = 0;
  for (const Object& object : scene.objects) {
    objects += object.triangle_count > 0;
    themselves += object.triangle_count > 0 && object.self;
  }
  return objects * (objects > 0 ? objects - 1 : 0) / 2 + themselves;
}

std::vector<std::optional<TrianglePair>> hints_for(std::span<const ObjectPair> questions,
                                                   std::span<const NearHint> hints) {
  if (hints.empty()) return {};
  std::vector<std::optional<TrianglePair>> out(questions.size());
  for (std::size_t k = 0; k < questions.size(); ++k) {
    const auto found = std::ranges::lower_bound(hints, questions[k], {}, &NearHint::objects);
    if (found != hints.end() && found->objects == questions[k]) out[k] = found->triangles;
  }
  return out;
}

// Returns the nearest triangles of each pair of objects, except pairs farther apart than
// options.within.
std::vector<Distance> nearest_of(const Scene& scene, std::span<const NearPairs> near,
                                 const DistanceOptions& options) {
  struct Part {
    std::size_t question;
    std::span<const TrianglePair> pairs;
  };
  std::vector<Part> parts;
  for (std::size_t q = 0; q < near.size(); ++q) {
    std::span<const TrianglePair> left = near[q].pairs;
    while (!left.empty()) {
      const std::size_t count = std::min(left.size(), kTogether);
      parts.push_back({q, left.first(count)});
      left = left.subspan(count);
    }
  }
  std::vector<std::optional<NearestPair>> of_part(parts.size());
  for_each_shared(parts.size(), options.threads,
                  [&](std::size_t k) { of_part[k] = nearest_pair(scene, parts[k].pairs); });
  std::vector<Distance> out;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const ObjectPair& objects = near[parts[k].question].objects;
    Distance found{.objects = objects,
                   .triangles = of_part[k]->pair,
                   .closest = std::move(of_part[k]->closest)};
    if (k == 0 || parts[k - 1].question != parts[k].question) {
      out.push_back(std::move(found));
    } else if (found.closest.squared < out.back().closest.squared) {
      out.back() = std::move(found);
    }
  }
  if (std::isfinite(options.within)) {
    std::erase_if(out, [&](const Distance& d) {
      return !within(scene.corners(d.triangles.a), scene.corners(d.triangles.b), options.within);
    });
  }
  return out;
}

// Keeps each distance that is among the k smallest of at least one of its two objects.
void keep_nearest(const Scene& scene, std::size_t k, std::vector<Distance>& distances) {
  std::vector<bool> wanted(distances.size());
  for (const NearestOfObject& of : nearest_of_objects(scene, distances, k)) {
    for (const std::size_t d : of.distances) wanted[d] = true;
  }
  std::erase_if(distances, [&, first = distances.data()](const Distance& d) {
    return !wanted[static_cast<std::size_t>(&d - first)];
  });
}

// Finds the nearest pair exactly. ProximityTrees then drops the other pairs of equal distance.
SettledPair settled(const Scene& scene, std::span<const TrianglePair> pairs) {
  const NearestPair nearest = *nearest_pair(scene, pairs);
  SettledPair out;
  out.pair = nearest.pair;
  if (nearest.closest.squared.is_zero()) return out;
  out.distance = std::nextafter(nearest.closest.distance, std::numeric_limits<double>::infinity());
  const PlanesBetween planes(scene.corners(out.pair.a), scene.corners(out.pair.b));
  out.reach = [&scene, planes](std::uint32_t t) { return planes.reach(scene.corners(t)); };
  out.start = [&scene, planes](std::uint32_t t) { return planes.start(scene.corners(t)); };
  return out;
}

ProximityTrees trees_of(const Scene& scene, unsigned threads) {
  return ProximityTrees(scene, threads, [&scene](std::span<const TrianglePair> pairs) {
    return settled(scene, pairs);
  });
}

// questions: number of pairs of objects. left: number of pairs of triangles that remain.
void add_near_stage(std::size_t questions, std::uint64_t left, double ms, DistanceRecord& record) {
  record.trace.push_back({.kind = StageKind::near,
                          .ran = true,
                          .reason = Reason::near_boxes,
                          .n = questions,
                          .m = record.counts.box_pairs,
                          .ms = ms,
                          .in = record.counts.triangle_pairs,
                          .out = left,
                          .unit = Unit::pairs});
}

void add_closest_stage(std::uint64_t left, double ms, DistanceRecord& record) {
  record.trace.push_back({.kind = StageKind::closest,
                          .ran = true,
                          .ms = ms,
                          .in = left,
                          .out = record.distances.size(),
                          .unit = Unit::pairs});
}

void between_objects(const Scene& scene, const Progress& progress, std::span<const NearHint> hints,
                     DistanceRecord& record) {
  const DistanceOptions& options = record.options;
  Stopwatch watch;
  if (progress) progress(StageKind::boxes);
  const ProximityTrees trees = trees_of(scene, options.threads);
  std::vector<NearPairs> near;
  if (options.pairs == DistancePairs::nearest) {
    near = trees.nearest_objects(options.k, options.within, hints, progress);
  } else {
    std::vector<ObjectPair> questions =
        std::isfinite(options.within) ? trees.objects_within(options.within, 4 * options.most_pairs)
                                      : every_two_objects(scene);
    std::erase_if(questions, [&](const ObjectPair& pair) {
      return std::ranges::binary_search(scene.ignored, pair);
    });
    near = trees.near_pairs(questions, options.within, hints_for(questions, hints), progress);
  }
  record.counts = trees.counts();
  std::uint64_t left = 0;
  for (const NearPairs& of : near) left += of.pairs.size();
  add_near_stage(near.size(), left, watch.ms(), record);
  watch = Stopwatch();
  if (progress) progress(StageKind::closest);
  record.distances = nearest_of(scene, near, options);
  if (options.pairs == DistancePairs::nearest) keep_nearest(scene, options.k, record.distances);
  add_closest_stage(left, watch.ms(), record);
}

void find_insides(const Scene& scene, const Progress& progress, DistanceRecord& record) {
  Stage stage{.kind = StageKind::inside, .unit = Unit::pairs};
  if (!record.options.inside) {
    stage.reason = Reason::inside_not_asked;
    record.trace.push_back(stage);
    return;
  }
  if (progress) progress(StageKind::inside);
  const Stopwatch watch;
  const Insides insides(scene);
  for_each_shared(record.distances.size(), record.options.threads, [&](std::size_t k) {
    Distance& d = record.distances[k];
    if (d.objects.a != d.objects.b && !d.closest.squared.is_zero())
      d.inside = insides.which(d.objects.a, d.objects.b);
  });
  stage.ran = true;
  stage.ms = watch.ms();
  stage.in = record.distances.size();
  for (const Distance& d : record.distances)
    stage.out += d.inside == WhichInside::a || d.inside == WhichInside::b;
  record.trace.push_back(stage);
}

// Finds all pairs of triangles, except neighbours, at a distance of at most options.within.
void between_triangles(const Scene& scene, const Progress& progress, DistanceRecord& record) {
  const DistanceOptions& options = record.options;
  Stopwatch watch;
  if (progress) progress(StageKind::boxes);
  const ProximityTrees trees(scene, options.threads);
  // Allows a quarter more candidates than most_pairs, since exact arithmetic removes some of them.
  const std::vector<TrianglePair> near =
      trees.pairs_within(options.within, options.most_pairs, progress, options.most_pairs / 4);
  record.counts = trees.counts();
  add_near_stage(count_of_questions(scene), near.size(), watch.ms(), record);
  watch = Stopwatch();
  if (progress) progress(StageKind::exact);
  const unsigned threads =
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  std::vector<TrianglePair> pairs =
      decide(scene, near, {.clearance = options.within, .threads = threads, .neighbours = false})
          .pairs;
  remove_ignored(scene, scene.ignored, pairs);
  record.trace.push_back({.kind = StageKind::exact,
                          .ran = true,
                          .reason = Reason::predicates,
                          .ms = watch.ms(),
                          .in = near.size(),
                          .out = pairs.size(),
                          .unit = Unit::pairs});
  if (pairs.size() > options.most_pairs) throw too_many_within(options.most_pairs, "triangles");
  watch = Stopwatch();
  if (progress) progress(StageKind::closest);
  const std::vector<std::uint32_t> owner = owners(scene);
  record.distances.resize(pairs.size());
  const std::size_t parts = (pairs.size() + kTogether - 1) / kTogether;
  for_each_shared(parts, options.threads, [&](std::size_t part) {
    const std::size_t end = std::min(pairs.size(), (part + 1) * kTogether);
    for (std::size_t k = part * kTogether; k < end; ++k) {
      const TrianglePair& pair = pairs[k];
      record.distances[k] = {
          .objects = {owner[pair.a], owner[pair.b]},
          .triangles = pair,
          .closest = closest_points(scene.corners(pair.a), scene.corners(pair.b))};
    }
  });
  std::ranges::sort(record.distances, {},
                    [](const Distance& d) { return std::pair(d.objects, d.triangles); });
  add_closest_stage(pairs.size(), watch.ms(), record);
}

void verify(const Scene& scene, const Progress& progress, DistanceRecord& record) {
  if (!record.options.verify) return;
  if (progress) progress(StageKind::verify);
  const DistanceOptions& options = record.options;
  record.verification = account_distances(scene, claims_of(record),
                                          {.kind = options.pairs,
                                           .k = options.k,
                                           .within = options.within,
                                           .inside = options.inside,
                                           .threads = options.threads});
  record.trace.push_back({.kind = StageKind::verify,
                          .ran = true,
                          .reason = Reason::every_pair,
                          .ms = record.verification->ms,
                          .in = record.verification->pairs_total,
                          .out = record.verification->nearer,
                          .unit = Unit::pairs});
}

}  // namespace

std::vector<Distance> nearest_triangles(const Scene& scene, std::span<const ObjectPair> objects,
                                        double within, unsigned threads, const Progress& progress) {
  const FloatingPointGuard guard;
  const std::vector<NearPairs> near =
      trees_of(scene, threads).near_pairs(objects, within, {}, progress);
  return nearest_of(scene, near, {.within = within, .threads = threads});
}

std::string nothing_asked(const Scene& scene, const DistanceOptions& options) {
  std::size_t with_triangles = 0;
  for (const Object& object : scene.objects) {
    with_triangles += object.triangle_count > 0;
    const bool itself = object.self && options.pairs != DistancePairs::nearest;
    if (itself && object.triangle_count > 1) return "";
  }
  if (with_triangles > 1) return "";
  if (scene.triangles.size() < 2) return "there are fewer than two triangles";
  return "only one object has triangles, and it is not tested against itself";
}

std::vector<ClaimedDistance> claims_of(const DistanceRecord& record) {
  std::vector<ClaimedDistance> out;
  out.reserve(record.distances.size());
  for (const Distance& d : record.distances) {
    out.push_back({.a = d.objects.a,
                   .b = d.objects.b,
                   .pair = d.triangles,
                   .distance = d.closest.distance,
                   .squared = d.closest.squared.text(),
                   .points = d.closest.points,
                   .features = {number_of(d.closest.features[0]), number_of(d.closest.features[1])},
                   .inside = d.inside});
  }
  return out;
}

std::vector<NearestOfObject> nearest_of_objects(const Scene& scene,
                                                std::span<const Distance> distances,
                                                std::size_t k) {
  std::vector<std::vector<std::size_t>> naming(scene.objects.size());
  for (std::size_t d = 0; d < distances.size(); ++d) {
    const auto [a, b] = distances[d].objects;
    naming[a].push_back(d);
    if (a != b) naming[b].push_back(d);
  }
  std::vector<NearestOfObject> out;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    if (scene.objects[o].triangle_count == 0) continue;
    std::vector<std::size_t>& of = naming[o];
    // The sort is stable, so equal distances stay in the order of the other object.
    std::ranges::stable_sort(of, [&](std::size_t x, std::size_t y) {
      return distances[x].closest.squared < distances[y].closest.squared;
    });
    of.resize(std::min(of.size(), k));
    out.push_back({.object = o, .distances = std::move(of)});
  }
  return out;
}

DistanceRecord distances(const Scene& scene, const DistanceOptions& options,
                         const Progress& progress, DistanceMemory* memory) {
  if (!(options.within >= 0))
    throw Error("within", "is no distance", "give a number of world units, 0 or more");
  if (options.pairs == DistancePairs::all && !std::isfinite(options.within))
    throw Error("within", "is not finite, which pairs of all triangles need",
                "give a finite number of world units");
  if (options.pairs == DistancePairs::nearest && options.k == 0)
    throw Error("k", "is 0", "give the number of neighbours of each object, 1 or more");
  if (const std::string reason = nothing_asked(scene, options); !reason.empty())
    throw Error("scene", reason, "give two objects or more, or distances inside one");
  // Refuses too many pairs of objects before the search, since each pair takes memory.
  if (options.pairs == DistancePairs::objects && !std::isfinite(options.within)) {
    const std::uint64_t questions = count_of_questions(scene);
    if (questions > options.most_pairs) {
      throw Error("scene",
                  "has " + std::to_string(questions) + " pairs of objects, and at most " +
                      std::to_string(options.most_pairs) + " are answered",
                  "ask for the nearest objects of each ({pairs} nearest), or for the triangles "
                  "within a distance ({pairs} all {within} D)");
    }
  }
  if (options.pairs == DistancePairs::nearest)
    require_nothing_ignored(scene, "the search for nearest objects");
  if (options.verify) require_nothing_ignored(scene, "the accounting of distances");
  const FloatingPointGuard guard;
  const Stopwatch watch;
  DistanceRecord out;
  out.options = options;
  if (options.pairs == DistancePairs::all) {
    between_triangles(scene, progress, out);
  } else {
    between_objects(scene, progress, memory ? *memory : std::span<const NearHint>(), out);
    find_insides(scene, progress, out);
  }
  if (memory != nullptr) {
    DistanceMemory kept;  // an exception here leaves `memory` unchanged
    if (options.pairs != DistancePairs::all) {
      for (const Distance& d : out.distances) kept.push_back({d.objects, d.triangles});
    }
    *memory = std::move(kept);
  }
  out.ms = watch.ms();
  out.scene_hash = scene_hash(scene);
  out.degenerate_triangles = degenerate_triangles(scene);
  verify(scene, progress, out);
  return out;
}

// Sorts the candidates into the order of the answer. Then threads test blocks of kTogether
// candidates.
std::vector<std::vector<TriangleContact>> contacts_within(const Scene& scene, double within,
                                                          unsigned threads, std::size_t most,
                                                          const Progress& progress) {
  const FloatingPointGuard guard;
  if (progress) progress(StageKind::boxes);
  const ProximityTrees trees(scene, threads);
  // Allows a quarter more candidates than `most`, since exact arithmetic removes some of them.
  std::vector<TrianglePair> near = trees.pairs_within(within, most, progress, most / 4);
  remove_ignored(scene, scene.ignored, near);
  const std::vector<std::uint32_t> owner = owners(scene);
  const auto in_order = [&](const TrianglePair& pair) {
    return std::pair(ObjectPair{owner[pair.a], owner[pair.b]}, pair);
  };
  if (!std::ranges::is_sorted(near, {}, in_order)) std::ranges::sort(near, {}, in_order);
  if (progress) progress(StageKind::closest);
  constexpr std::size_t kTogether = 1024;  // number of pairs that a thread decides at a time
  std::vector<std::vector<TriangleContact>> out((near.size() + kTogether - 1) / kTogether);
  for_each_shared(out.size(), threads, [&](std::size_t part) {
    const std::span<const TrianglePair> pairs = std::span(near).subspan(
        part * kTogether, std::min(kTogether, near.size() - part * kTogether));
    std::array<Triage, kTogether> planes;
    filter_pairs(scene, pairs, within, {planes.data(), pairs.size()});
    out[part].reserve(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto& [a, b] = pairs[k];
      if (const auto contact =
              contact_within(scene.corners(a), scene.corners(b), within, planes[k])) {
        out[part].push_back({{owner[a], owner[b]}, pairs[k], *contact});
      }
    }
  });
  std::size_t count = 0;
  for (const auto& part : out) count += part.size();
  if (count > most) throw too_many_within(most, "triangles");
  return out;
}

}  // namespace farcull
