// The study "error-time": what is wrong with an answer against the time that it takes, ours and the
// libraries' that one would take instead.
#include <algorithm>
#include <string>

#include "core/stopwatch.h"
#include "experiments/bench_machine.h"
#include "experiments/peer.h"
#include "experiments/studies/lab.h"
#include "experiments/studies/points.h"
#include "verify/exact.h"

namespace farcull {
namespace {

struct TimedScene {
  const char* name;
  bool self = false;  // see accuracy.cpp
};

std::vector<TimedScene> scenes_of(bool quick) {
  if (quick) return {{"two-spheres"}, {"needles:60"}};
  return {{"two-tori"}, {"needles:100"}, {"two-bunnies"}, {"mannequin-devil", true}};
}

// Of other libraries: with exact decisions after their broad phase, and FCL as it is.
constexpr const char* kPeers[] = {"cgal-boxes", "cgal-aabb", "embree-low", "fcl-double",
                                  "fcl-float"};

int repeat_of(const std::string& scene) {
  for (const TimedScene& quick : scenes_of(true)) {
    if (scene == quick.name) return 3;
  }
  return 5;
}

std::vector<Point> grid(const GridChoice& choice) {
  const std::vector<int> resolutions =
      choice.quick ? std::vector{64, 256, 1024} : std::vector{64, 128, 256, 512, 1024, 2048};
  std::vector<Point> out;
  for (const TimedScene& scene : scenes_of(choice.quick)) {
    for (const int resolution : resolutions) {
      if (scene.self) {
        // A step a triangle: at 2048 px it would take as long as all others together.
        if (resolution <= 1024) out.push_back(cullide_point(scene.name, "s-cullide", resolution));
      } else {
        out.push_back(cullide_point(scene.name, "cullide", resolution));
        out.push_back(cullide_point(scene.name, "quick-cullide", resolution));
        out.push_back(far_point(scene.name, "obb", "budget", resolution));
        out.push_back(far_point(scene.name, "exact", "budget", resolution));
      }
      out.push_back(plain_point(scene.name, "far-pairs", resolution));
    }
    out.push_back(plain_point(scene.name, "far-pairs"));
    out.push_back(plain_point(scene.name, "i-collide"));
    out.push_back(plain_point(scene.name, "exact"));
    for (const char* peer : kPeers) out.push_back(plain_point(scene.name, peer));
  }
  return out;
}

// Empty where no library has that name.
std::vector<Peer> peer_named(const std::string& name, unsigned threads) {
  for (const std::vector<Peer>& peers : {all_peers(threads), narrow_peers()}) {
    for (const Peer& peer : peers) {
      if (peer.name == name) return {peer};
    }
  }
  return {};
}

// Peers leave neighbours out, so the truth does as well.
Truth without_neighbours(const Scene& scene, const Truth& truth) {
  if (!has_self(scene)) return truth;
  Truth out;
  out.ms = truth.ms;
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<std::uint32_t> triangles;
  for (const TrianglePair& pair : truth.pairs) {
    if (owner[pair.a] == owner[pair.b] &&
        share_position(scene.corners(pair.a), scene.corners(pair.b))) {
      continue;
    }
    out.pairs.push_back(pair);
    triangles.insert(triangles.end(), {pair.a, pair.b});
  }
  std::sort(triangles.begin(), triangles.end());
  out.triangles = static_cast<std::uint64_t>(std::unique(triangles.begin(), triangles.end()) -
                                             triangles.begin());
  return out;
}

Measurement measure_peer(const Point& point, const Peer& peer, Lab& lab, unsigned threads,
                         int repeat) {
  Measurement out;
  out.device = "cpu";
  const Scene& scene = lab.current();
  out.left_out = !peer.missing.empty() ? peer.missing : peer.refuses ? peer.refuses(scene) : "";
  if (!out.left_out.empty()) return out;
  const Truth truth = without_neighbours(scene, lab.truth());
  const BenchRun run = peer.set_up(threads);
  struct Times {
    double total, build;
  };
  std::vector<Times> times;
  Outcome first;
  for (int i = 0; i < repeat; ++i) {
    if (lab.progress()) lab.progress()(peer.name);
    const Stopwatch watch;
    BenchAnswer answer = run(scene);
    times.push_back({watch.ms(), answer.build_ms});
    const Errors errors = errors_of(truth, answer.pairs);
    Outcome outcome{.pairs = std::move(answer.pairs),
                    .counts = {{"colliding", truth.pairs.size()},
                               {"missed", errors.missed},
                               {"wrong", errors.wrong},
                               {"colliding_triangles", truth.triangles},
                               {"missed_triangles", errors.missed_triangles},
                               {"candidates", answer.candidate_pairs},
                               {"triangles", scene.triangles.size()},
                               {"objects", scene.objects.size()},
                               {"library", peer.library}},
                    .device = out.device};
    if (i == 0) {
      first = std::move(outcome);
    } else {
      require_same(point, first, outcome);
    }
  }
  std::sort(times.begin(), times.end(),
            [](const Times& a, const Times& b) { return a.total < b.total; });
  const Times& middle = times[(times.size() - 1) / 2];
  out.counts = std::move(first.counts);
  out.times = {{"build", middle.build},
               {"total", middle.total},
               {"total_min", times.front().total},
               {"total_max", times.back().total}};
  return out;
}

Measurement measure(const Point& point, Lab& lab) {
  lab.scene(point.scene);
  const unsigned threads = usable_cores();
  const std::vector<Peer> peer = peer_named(point.method, threads);
  const int repeat = repeat_of(point.scene);
  return peer.empty() ? measure_run(point, lab, repeat)
                      : measure_peer(point, peer.front(), lab, threads, repeat);
}

}  // namespace

Study error_time_study() {
  return {.name = "error-time",
          .title = "Error against run time",
          .question =
              "What does each method get wrong, and how long does it take, against each other and "
              "against the libraries that one would take instead?",
          .grid = grid,
          .measure = measure};
}

}  // namespace farcull
