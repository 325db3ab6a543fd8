// Runs of methods and libraries at points: each run is compared with the truth and with the first.
#include "experiments/studies/run_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/scene/scene.h"
#include "core/view/regions.h"
#include "experiments/measure/harness.h"
#include "experiments/record/tables.h"
#include "verify/contact.h"

namespace farcull {
namespace {

void fill(AnswerCounts& counts, const Scene& scene, const Truth& truth, const Errors& errors,
          std::uint64_t candidates) {
  counts.colliding = truth.pairs.size();
  counts.missed = errors.missed;
  counts.missed_triangles = errors.missed_triangles;
  counts.candidates = candidates;
  counts.triangles = scene.triangles.size();
  counts.objects = scene.objects.size();
}

// How many of the missed pairs penetrate.
std::uint64_t missed_penetrating(const Scene& scene, const Truth& truth,
                                 const std::vector<TrianglePair>& pairs) {
  std::vector<TrianglePair> missed;
  std::set_difference(truth.pairs.begin(), truth.pairs.end(), pairs.begin(), pairs.end(),
                      std::back_inserter(missed));
  return count_contacts(scene, missed).penetrating;
}

Outcome outcome_of(const Scene& scene, const Truth& truth, const Record& record) {
  Outcome out;
  out.pairs = record.collisions.all();
  out.device = answered(record);
  RunCounts counts;
  fill(counts, scene, truth, errors_of(truth, out.pairs), record.found.count);
  counts.missed_penetrating = missed_penetrating(scene, truth, out.pairs);
  counts.colliding_triangles = truth.triangles;
  counts.kept_triangles = record.found.triangle_count;
  counts.kept_objects = record.found.object_count;
  counts.promises = promises(record.options);
  counts.revoked = counts.promises && !record.promise.holds;
  counts.scene_hash = record.scene_hash;
  const Method method = record.options.method;
  counts.object_triangles = record.found.swept_triangles();
  if (draws(method)) {
    const Stage sum = work_of(record.trace);
    counts.drawn = {sum.queries, sum.draws, sum.queries_saved, sum.draws_saved};
    if (const ViewReport* view = widest_budget(record.found.views()))
      counts.radius = {view->radius_px, view->pixel_size};
  }
  out.counts = std::move(counts);
  return out;
}

// The outcome of the first of `repeat` runs, to which all others have to be equal, and their times.
// `run` gives an outcome and its time.
template <class Run>
std::pair<Outcome, std::vector<double>> repeat_point(const Point& point, int repeat,
                                                     const Run& run) {
  Outcome first;
  std::vector<Timed> timed = measure_in_turns(1, {.counted = repeat}, [&](std::size_t, int round) {
    auto [outcome, ms] = run();
    if (round == 0) {
      first = std::move(outcome);
    } else {
      require_same(key_of(point), first, outcome);
    }
    return ms;
  });
  return {std::move(first), std::move(timed.front().ms)};
}

void add_extremes(PointTimes& times, const std::vector<double>& ms) {
  const auto [least, most] = std::minmax_element(ms.begin(), ms.end());
  times.total_min = *least;
  times.total_max = *most;
  times.totals = ms;
}

Peer peer_named(const std::string& name, unsigned threads) {
  for (const std::vector<Peer>& peers : {all_peers(threads), narrow_peers()}) {
    for (const Peer& peer : peers) {
      if (peer.name == name) return peer;
    }
  }
  throw std::logic_error("measure_peer: no peer " + name);
}

std::string text_of(const CountValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return '"' + *text + '"';
  if (const auto* yes = std::get_if<bool>(&value)) return *yes ? "true" : "false";
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return std::to_string(std::get<std::uint64_t>(value));
}

}  // namespace

void require_same(const PointKey& point, const Outcome& first, const Outcome& other) {
  std::string different;
  const auto add = [&different](const std::string& text) {
    different += (different.empty() ? "" : ", ") + text;
  };
  if (first.device != other.device) add("device " + first.device + " and " + other.device);
  // By name: the values of both, "none" where one lacks the count.
  std::map<std::string, std::pair<std::string, std::string>> values;
  const auto at = [&](const std::string& name) -> auto& {
    return values.try_emplace(name, "none", "none").first->second;
  };
  for (const auto& [name, value] : named(first.counts)) at(name).first = text_of(value);
  for (const auto& [name, value] : named(other.counts)) at(name).second = text_of(value);
  for (const auto& [name, both] : values) {
    if (both.first != both.second) add(name + " " + both.first + " and " + both.second);
  }
  if (first.pairs != other.pairs) {
    add(fmt::format("{} and {} pairs that are in one answer alone",
                    lacking(first.pairs, other.pairs), lacking(other.pairs, first.pairs)));
  }
  if (different.empty()) return;
  throw Error(describe(point), "two runs of the same point differ: " + different,
              "run farcull doctor; the device is not deterministic");
}

SizeCounts size_for(const Scene& scene, double pixels) {
  constexpr int kSample = 256;  // px; areas grow with the square of the resolution
  const Regions regions = find_regions(scene, {.self = has_self(scene)});
  double area = 0;
  std::uint64_t count = 0;
  for (const View& view : parse_views("x,y,z")) {
    const std::optional<Window> window =
        regions.places.empty() ? std::nullopt : fit_window(view, regions.places, kSample);
    if (!window) continue;
    for (const std::uint32_t t : regions.triangles) {
      const auto corners = scene.corners(t);
      const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      area += 0.5 * std::abs(normal.dot(view.rows.row(2).transpose())) / window->pixel_size /
              window->pixel_size;
      ++count;
    }
  }
  const double mean = count == 0 ? 0 : area / static_cast<double>(count);
  if (!(mean > 0)) return {};
  const double side = std::ceil(kSample * std::sqrt(pixels / mean));
  return {.resolution = side < 1e9 ? static_cast<std::uint64_t>(side) : 0,
          .mean_pixels = mean * side * side / kSample / kSample};
}

std::string answered(const Record& record) {
  const UsedDevice& used = record.found.device;
  return used.gl ? used.gl->renderer : used.cpu && draws(record.options.method) ? "native" : "cpu";
}

RunOptions options_of(const RunPoint& point, const Lab& lab) {
  RunOptions options;
  options.method = point.method;
  options.resolution = point.resolution;
  options.radius = point.radius.value_or(RadiusRule{});
  if (!point.offset.empty()) options.offset = point.offset;
  options.depth = point.depth_mode;
  options.depth_format = point.depth_format.value_or(DepthFormat::float32);
  options.views = point.views;
  options.rounds = point.rounds;
  options.clear = point.clear;
  options.objects_alone = point.objects_alone;
  options.conservative = point.conservative;
  options.device = lab.device();
  options.verify = false;
  return options;
}

PointResult measure_run(const RunPoint& point, Lab& lab, Record* kept) {
  const bool moving = std::holds_alternative<MotionFrame>(point.scene);
  if (point.repeat < 1 || (moving && point.repeat > 1))
    throw std::logic_error("measure_run: runs of " + describe(Point(point)));
  const Scene& scene = open_scene(point.scene, lab);
  RunOptions options = options_of(point, lab);
  std::optional<SizeCounts> size;
  if (point.mean_pixels > 0) {
    size = size_for(scene, point.mean_pixels);
    if (size->resolution < 1 || size->resolution > kMostSizedResolution) {
      return {.device = "none",
              .left_out = fmt::format("{} px a triangle take more than {} px", point.mean_pixels,
                                      kMostSizedResolution)};
    }
    options.resolution = static_cast<int>(size->resolution);
  }
  const Truth& truth = lab.truth();
  double setup = 0;
  std::vector<Record> records;
  auto [outcome, ms] = repeat_point(point, point.repeat, [&] {
    if (!moving) lab.session().sweep().forget();
    records.push_back(run(scene, options, lab.session(), lab.progress()));
    setup += records.back().ms.setup;
    return std::pair(outcome_of(scene, truth, records.back()), compared_ms(records.back()));
  });
  Record& record = records[median_run(ms)];
  std::get<RunCounts>(outcome.counts).size = size;
  PointResult out{.counts = std::move(outcome.counts),
                  .times = {.cull = record.ms.cull,
                            .exact = record.ms.exact,
                            .total = compared_ms(record),
                            .setup = setup},
                  .device = std::move(outcome.device)};
  if (point.repeat > 1) add_extremes(out.times, ms);
  if (kept != nullptr) *kept = std::move(record);
  return out;
}

std::string library_of_peer(const Point& point) {
  const auto* asked = std::get_if<PeerPoint>(&point);
  if (asked == nullptr) return "";
  const Peer peer = peer_named(asked->peer, 1);
  return peer.missing.empty() ? peer.library : "";
}

PointResult measure_peer(const PeerPoint& point, Lab& lab, unsigned threads) {
  const Scene& scene = open_scene(point.scene, lab);
  const Peer peer = peer_named(point.peer, threads);
  PointResult out{.device = "cpu"};
  out.left_out = !peer.missing.empty() ? peer.missing : peer.refuses ? peer.refuses(scene) : "";
  if (!out.left_out.empty()) return out;
  const Truth truth = without_neighbours(scene, lab.truth());
  const BenchRun run = peer.set_up(threads);
  std::vector<BenchAnswer> answers;
  auto [outcome, ms] = repeat_point(point, point.repeat, [&] {
    if (lab.progress()) lab.progress()(peer.name);
    const Stopwatch watch;
    BenchAnswer answer = run(scene);
    const double total = watch.ms();
    const Errors errors = errors_of(truth, answer.pairs);
    PeerCounts counts;
    fill(counts, scene, truth, errors, answer.candidate_pairs);
    counts.wrong = errors.wrong;
    counts.colliding_triangles = truth.triangles;
    counts.library = peer.library;
    Outcome one{.pairs = std::exchange(answer.pairs, {}),
                .counts = std::move(counts),
                .device = out.device};
    answers.push_back(std::move(answer));
    return std::pair(std::move(one), total);
  });
  const std::size_t middle = median_run(ms);
  const BenchAnswer& answer = answers[middle];
  out.counts = std::move(outcome.counts);
  out.times = {.build = answer.build_ms,
               .cull = answer.candidates_ms,
               .exact = answer.exact_ms,
               .total = ms[middle]};
  add_extremes(out.times, ms);
  return out;
}

}  // namespace farcull
