// Runs methods and contestants at points of the study "proximity". The exact answers of the last
// scene are kept, since many points share a scene.
#include "experiments/studies/proximity_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/view/view.h"
#include "experiments/measure/harness.h"
#include "experiments/method/distances.h"
#include "experiments/studies/run_point.h"

namespace farcull {
namespace {

constexpr unsigned kThreads = 1;

// A scene without objects that are asked about themselves, and what is exact about it.
struct Exact {
  Scene scene;
  std::string hash;
  DistanceTask task = DistanceTask::nearest;
  std::vector<PeerDistance> distances;  // of that task
  std::uint64_t accounted = 0;          // pairs of triangles
  std::vector<NearestObjects> nearest;  // of the task `nearest`
};

void require_proved(const std::string& where, const DistanceRecord& record) {
  const DistanceAccounting& all = *record.verification;
  if (all.holds()) return;
  throw Error(where,
              fmt::format("the exact answers are wrong: {} pairs are nearer, {} distances are off",
                          all.nearer, all.wrong),
              "this is a fault of farcull: please report it with the scene");
}

// Where several objects are as near, the record names one of them and `nearest` all.
void require_alike(const std::string& where, const Exact& exact) {
  for (const PeerDistance& one : exact.distances) {
    const std::vector<std::uint32_t>& all = exact.nearest[one.a].objects;
    if (std::find(all.begin(), all.end(), one.b) != all.end()) continue;
    throw Error(where, fmt::format("two searches name different nearest objects of {}", one.a),
                "this is a fault of farcull: please report it with the scene");
  }
}

const Exact& exact_of(const PointScene& wanted, DistanceTask task, const std::string& where,
                      Lab& lab) {
  static Exact last;
  Scene scene = open_scene(wanted, lab);
  for (Object& object : scene.objects) object.self = false;
  std::string hash = scene_hash(scene);
  if (last.hash == hash && last.task == task) return last;
  last = {};
  Exact now{.scene = std::move(scene), .hash = {}, .task = task, .distances = {}, .nearest = {}};
  const bool nearest = task == DistanceTask::nearest;
  const DistanceRecord record =
      distances(now.scene,
                {.pairs = nearest ? DistancePairs::nearest : DistancePairs::objects,
                 .inside = false,
                 .verify = true},
                lab.progress());
  require_proved(where, record);
  now.distances = as_peer(record);
  now.accounted = record.verification->pairs_total;
  if (nearest) {
    now.nearest = nearest_objects(now.scene, lab.progress());
    require_alike(where, now);
  }
  now.hash = std::move(hash);
  last = std::move(now);
  return last;
}

// The counts of the first run, which those of all others have to equal, and the times of all.
template <class Run>
PointResult repeated_runs(const Point& point, int repeat, const Run& run) {
  Outcome first;
  const std::vector<Timed> timed =
      measure_in_turns(1, {.counted = repeat}, [&](std::size_t, int round) {
        auto [counts, ms] = run();
        Outcome one{.pairs = {}, .counts = std::move(counts), .device = "cpu"};
        if (round == 0) {
          first = std::move(one);
        } else {
          require_same(key_of(point), first, one);
        }
        return ms;
      });
  PointResult out{.counts = std::move(first.counts), .device = "cpu"};
  const std::vector<double>& ms = timed.front().ms;
  out.times.total = ms[median_run(ms)];
  if (repeat > 1) {
    const auto [least, most] = std::minmax_element(ms.begin(), ms.end());
    out.times.total_min = *least;
    out.times.total_max = *most;
    out.times.totals = ms;
  }
  return out;
}

}  // namespace

PointResult measure_neighbours(const NeighbourPoint& point, Lab& lab) {
  const Exact& exact = exact_of(point.scene, DistanceTask::nearest, describe(Point(point)), lab);
  std::string left_out;
  PointResult out = repeated_runs(point, point.repeat, [&] {
    const Stopwatch watch;
    const NeighbourSets sets = neighbour_sets(exact.scene,
                                              {.method = point.method,
                                               .resolution = point.resolution,
                                               .widening = point.widening,
                                               .threads = kThreads},
                                              lab.progress());
    const double ms = watch.ms();
    SetCounts counts;
    if (sets.left_out.empty()) {
      counts.sizes = sizes_of(exact.scene, sets, exact.nearest);
    } else {
      left_out = sets.left_out;
    }
    counts.triangles = exact.scene.triangles.size();
    counts.all_objects = exact.scene.objects.size();
    counts.accounted = exact.accounted;
    counts.promises = point.method != NeighbourMethod::voronoi && point.widening >= 1;
    counts.scene_hash = exact.hash;
    return std::pair(Counts(counts), ms);
  });
  if (!left_out.empty()) return {.device = "none", .left_out = std::move(left_out)};
  return out;
}

PointResult measure_distances(const DistancePoint& point, const DistancePeer& contestant,
                              Lab& lab) {
  PointResult none{.device = "none", .left_out = contestant.missing};
  if (!none.left_out.empty()) return none;
  const Exact& exact = exact_of(point.scene, point.task, describe(Point(point)), lab);
  if (contestant.refuses) none.left_out = contestant.refuses(exact.scene);
  if (!none.left_out.empty()) return none;
  const PeerQuestion question{.task = point.task};
  return repeated_runs(point, point.repeat, [&] {
    if (lab.progress()) lab.progress()(contestant.name);
    const Stopwatch watch;
    const PeerDistances answer = contestant.run(exact.scene, question, kThreads);
    const double ms = watch.ms();
    DistanceCounts counts{.errors = errors_of(point.task, answer.distances, exact.distances),
                          .asked = exact.distances.size(),
                          .triangles = exact.scene.triangles.size(),
                          .objects = exact.scene.objects.size(),
                          .accounted = exact.accounted,
                          .promises = contestant.name == farcull_distances().name,
                          .library = contestant.library,
                          .scene_hash = exact.hash};
    return std::pair(Counts(std::move(counts)), ms);
  });
}

std::vector<DistancePeer> distance_contestants() {
  std::vector<DistancePeer> out = {farcull_distances()};
  for (DistancePeer& peer : distance_peers()) out.push_back(std::move(peer));
  return out;
}

PointResult measure_distances(const DistancePoint& point, Lab& lab) {
  for (const DistancePeer& contestant : distance_contestants()) {
    if (contestant.name == point.contestant) return measure_distances(point, contestant, lab);
  }
  throw std::logic_error("measure_distances: no contestant " + point.contestant);
}

std::string library_of_distances(const Point& point) {
  const auto* asked = std::get_if<DistancePoint>(&point);
  if (asked == nullptr) return "";
  for (const DistancePeer& contestant : distance_contestants()) {
    if (contestant.name == asked->contestant)
      return contestant.missing.empty() ? contestant.library : "";
  }
  return "";
}

}  // namespace farcull
