// Times frames in which the first object turns a little. A new call of the library, a Collider and
// the peers run in turn. In each frame, all pairs are compared with the pairs of the new call.
#include "experiments/measure/bench.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <ctime>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/boxes/block.h"
#include "experiments/library/farcull.h"
#include "experiments/record/output.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr double kTurn = 0.01;  // radians per frame

// Returns a rotation about the middle of the box by the angle frame * kTurn.
RigidMotion turned(const Box& box, int frame) {
  const Eigen::Matrix3d by =
      Eigen::AngleAxisd(frame * kTurn, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 middle = 0.5 * box.lo + 0.5 * box.hi, t = middle - by * middle;
  RigidMotion out{.t = {t[0], t[1], t[2]}};
  for (Eigen::Index k = 0; k < 9; ++k) out.r[static_cast<std::size_t>(k)] = by(k / 3, k % 3);
  return out;
}

// A scene as input of the library. Objects without triangles are left out.
struct Arrays {
  std::vector<std::uint32_t> objects, starts;  // objects: numbers of the objects in the scene
  Input input;

  explicit Arrays(const Scene& scene) : objects(objects_with_triangles(scene)) {
    for (const std::uint32_t o : objects) starts.push_back(scene.objects[o].first_triangle);
    input = {.vertices = {scene.vertices[0].data(), 3 * scene.vertices.size()},
             .triangles = {scene.triangles[0].data(), 3 * scene.triangles.size()},
             .object_starts = starts};
  }
  std::vector<Pose> poses(std::span<const RigidMotion> motions) const {
    std::vector<Pose> out;
    for (const std::uint32_t o : objects) out.push_back({motions[o].r, motions[o].t});
    return out;
  }
};

std::vector<TrianglePair> pairs_of(const Result& result) {
  std::vector<TrianglePair> out;
  out.reserve(result.pairs.size());
  for (const auto& [a, b] : result.pairs) out.push_back({a, b});
  return out;
}

std::optional<double> cpu_ratio(const PoseBenchResult& result, const PoseBenchRow& row) {
  if (!result.fastest_peer) return std::nullopt;
  return row.cpu_ms / result.rows[*result.fastest_peer].cpu_ms;
}

// A row of the result, and the function that is timed for the row.
struct Contestant {
  PoseBenchRow row;
  PoseRun run;
  std::vector<double> cpu_ms = {};
};

// A function that returns the motions of all objects in a frame.
using Frames = std::function<std::span<const RigidMotion>(int frame)>;

std::vector<Contestant> ours(const Scene& scene, const PoseBenchOptions& options,
                             const Frames& frames) {
  const auto arrays = std::make_shared<const Arrays>(scene);
  const Options of_library{.threads = options.threads, .neighbours = false};
  std::vector<Contestant> out;
  const auto add = [&](const char* name, double build_ms, PoseRun run) {
    Contestant& one = out.emplace_back();
    one.row.name = name;
    one.row.build_ms = build_ms;
    one.run = std::move(run);
  };
  add("boxes, new call", 0, [=](std::span<const RigidMotion> motions) {
    const std::vector<Pose> poses = arrays->poses(motions);
    Input input = arrays->input;
    input.poses = poses;
    return pairs_of(collide(input, of_library));
  });
  const Stopwatch watch;
  const auto collider = std::make_shared<Collider>(of_library);
  collider->find(arrays->input);
  const PoseRun kept = [=](std::span<const RigidMotion> motions) {
    const std::vector<Pose> poses = arrays->poses(motions);
    return pairs_of(collider->find({.poses = poses}));
  };
  kept(frames(-2));
  kept(frames(-1));  // the Collider makes its trees in this call
  add("boxes", watch.ms(), kept);
  return out;
}

}  // namespace

PoseBenchResult bench_poses(const Scene& scene, const PoseBenchOptions& options,
                            const Progress& progress) {
  if (options.repeat < 1) throw Error("--repeat", "is below 1", "give 1 or more");
  const std::vector<PosePeer> peers = chosen_peers(options.peers, pose_peers());
  const std::vector<std::uint32_t> objects = objects_with_triangles(scene);
  if (objects.size() < 2)
    throw Error(scene.name, "has no two objects, of which one could move", "add a mesh");
  const Object& first = scene.objects[objects[0]];
  const Box box = box_of(scene, first.first_triangle, first.first_triangle + first.triangle_count);
  std::vector<RigidMotion> motions(scene.objects.size());
  const Frames frames = [&](int frame) {
    motions[objects[0]] = turned(box, frame);
    return std::span<const RigidMotion>(motions);
  };
  if (progress) progress("setting up");
  std::vector<Contestant> all = ours(scene, options, frames);
  PoseBenchResult result;
  for (const PosePeer& peer : peers) {
    if (const std::string reason = why_left_out(peer, scene); !reason.empty()) {
      if (options.peers != "all") throw Error("--peers", peer.name + ": " + reason, "leave it out");
      result.left_out.emplace_back(peer.name, reason);
      continue;
    }
    const Stopwatch watch;
    PoseRun run = peer.set_up(scene, options.threads);
    all.push_back(
        {{{.name = peer.name, .library = peer.library, .peer = true, .build_ms = watch.ms()}},
         std::move(run)});
  }

  const Rounds rounds{.warm_up = 1, .counted = options.repeat, .limit_ms = 1000 * options.limit_s};
  std::vector<std::vector<TrianglePair>> exact(static_cast<std::size_t>(options.repeat) + 1);
  const std::vector<Timed> timed =
      measure_in_turns(all.size(), rounds, [&](std::size_t i, int round) {
        Contestant& one = all[i];
        show_round(progress, one.row.name, round, options.repeat);
        const std::span<const RigidMotion> now = frames(round + 1);
        const std::clock_t before = std::clock();
        const Stopwatch watch;
        const std::vector<TrianglePair> pairs = one.run(now);
        const double ms = watch.ms();
        if (round >= 0 || ms > rounds.limit_ms)
          one.cpu_ms.push_back(1000.0 * static_cast<double>(std::clock() - before) /
                               CLOCKS_PER_SEC);
        std::vector<TrianglePair>& truth = exact[static_cast<std::size_t>(round + 1)];
        if (i == 0) truth = pairs;
        one.row.pairs += pairs.size();
        one.row.lacking += lacking(truth, pairs);
        one.row.beyond += lacking(pairs, truth);
        return ms;
      });
  for (std::size_t i = 0; i < all.size(); ++i) {
    result.rows.push_back(all[i].row);
    set_times(timed[i], rounds, i, true, result);
    result.rows[i].cpu_ms = middle(all[i].cpu_ms);
  }
  return result;
}

std::string disagreement_of(const PoseBenchResult& result) {
  for (const PoseBenchRow& row : result.rows) {
    if (!row.peer && row.lacking + row.beyond > 0)
      return fmt::format("{} lacks {} pairs of {}, and has {} others", row.name, row.lacking,
                         result.rows[0].name, row.beyond);
  }
  return "";
}

nlohmann::ordered_json to_json(const Scene& scene, const PoseBenchOptions& options,
                               const PoseBenchResult& result) {
  using Json = nlohmann::ordered_json;
  const auto row_json = [&](const PoseBenchRow& row) {
    Json one = FARCULL_JSON(row, name, library, peer, total_ms, cpu_ms, build_ms, cold_ms, repeats,
                            pairs, lacking, beyond);
    one["ratio_to_fastest_peer"] = json_of(ratio_to_fastest(result, row));
    one["cpu_ratio_to_fastest_peer"] = json_of(cpu_ratio(result, row));
    return one;
  };
  Json json = {{"scene", scene.name},
               {"poses", true},
               {"threads", options.threads},
               {"rows", json_list(result.rows, row_json)}};
  json.update(bench_facts(scene, result.left_out, FARCULL_JSON(options, peers, repeat, limit_s)));
  return json;
}

std::string pose_bench_table(const Scene& scene, const PoseBenchOptions& options,
                             const PoseBenchResult& result) {
  std::string out = bench_title(scene, options.threads);
  const bool peer = result.fastest_peer.has_value();
  Table table("lrrrrrrrrrrrr");
  table.add({"", "ms", "low", "high", "n", "cold", "cpu", "build", "pairs", "lacking", "beyond",
             peer ? "x fastest" : "", peer ? "x cpu" : ""});
  for (const PoseBenchRow& row : result.rows) {
    std::vector<std::string> cells = time_cells(row);
    cells.insert(cells.end(),
                 {ms_text(row.cpu_ms), ms_text(row.build_ms), grouped(row.pairs),
                  grouped(row.lacking), grouped(row.beyond),
                  ratio_text(ratio_to_fastest(result, row)), ratio_text(cpu_ratio(result, row))});
    table.add(cells);
  }
  out += table.text() + left_out_lines(result.left_out);
  out += fmt::format(
      "\nms: of a frame, in which {} turns by {} radians, median of n; low, high: its interval by "
      "the\nbootstrap; cold: the first frame; cpu: the same in time of the processor; build: what "
      "is kept\nfrom frame to frame, once. pairs: of all frames; lacking, beyond: against a new "
      "call, which is\nexact.\n",
      scene.objects[objects_with_triangles(scene)[0]].name, kTurn);
  if (peer)
    out += fmt::format("x fastest, x cpu: of the fastest peer, {}, in this run.\n",
                       result.rows[*result.fastest_peer].name);
  return out;
}

}  // namespace farcull
