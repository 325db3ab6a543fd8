// Opens the scenes of points, runs methods and libraries on them, and compares each run with the
// truth.
#include "experiments/studies/run_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/scene/scene.h"
#include "core/view/regions.h"
#include "experiments/measure/harness.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/cloth/cloth.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/studies/point.h"
#include "verify/contact.h"

namespace farcull {
namespace {

// Two objects of segments. Each segment crosses a segment of the other object at 45 degrees, within
// 2^-10 px of a corner of a pixel in the view z at this resolution. The objects' boxes are as many
// units wide as the window has pixels, so that a unit is a pixel and corners of pixels are whole
// numbers (core/view/view.h, fit_window).
constexpr const char* kCorners = "pixel-corners";
constexpr int kCornersResolution = 96;

Scene pixel_corners() {
  using shapes::Corners;
  constexpr int kHalf = kCornersResolution / 2;
  constexpr double kReach = 0x1p-12;
  shapes::Random random(16);
  std::vector<Corners> one, other;
  for (int y = 3 - kHalf; y <= kHalf - 3; y += 3) {
    for (int x = 3 - kHalf; x <= kHalf - 3; x += 3) {
      const auto near = [&random] {
        return (static_cast<double>(random.below(33)) - 16) * 0x1p-14;
      };
      const double dx = near(), dy = near();
      const Vec3 q(x + dx, y + dy, static_cast<double>(random.below(64)));
      const Vec3 up(kReach, kReach, 0), down(kReach, -kReach, 0);
      one.push_back({q - up, q + up, q + up});
      other.push_back({q - down, q + down, q + down});
    }
  }
  for (const double at : {-1.0, 1.0}) {  // points that extend the boxes to this size, and touch
    const Vec3 p(at * kHalf, at * kHalf, 64);
    for (auto* list : {&one, &other}) list->push_back({p, p, p});
  }
  SceneBuilder scene(kCorners, kCorners);
  scene.add(shapes::soup(one), "rising");
  scene.add(shapes::soup(other), "falling");
  return scene.finish();
}

// Two hundred objects of one to four triangles in a cube of side 1: ten clusters of twenty objects,
// each in a cube of side 1 / ratio at a random place. Two objects of one triangle lie in opposite
// corners of the large cube, so that a grid covers all of it.
Scene clusters(const ClusteredScene& wanted) {
  using shapes::Corners;
  constexpr int kClusters = 10, kObjects = 20;
  shapes::Random random(wanted.seed);
  const double side = 1.0 / wanted.ratio;
  const auto drawn = [&random](double from, double to) -> Vec3 {
    return Vec3::Constant((from + to) / 2) + random.in_cube((to - from) / 2);
  };
  SceneBuilder scene("clusters", "clusters");
  int objects = 0;
  const auto add = [&](const std::vector<Corners>& triangles) {
    scene.add(shapes::soup(triangles), fmt::format("object{}", objects++));
  };
  for (int cluster = 0; cluster < kClusters; ++cluster) {
    const Vec3 corner = drawn(0, 1 - side);
    for (int object = 0; object < kObjects; ++object) {
      // An object fills only a part of the cluster, so that most objects do not meet.
      const Vec3 at = corner + drawn(0, 0.9 * side);
      std::vector<Corners> triangles(1 + random.below(4));
      for (Corners& triangle : triangles) {
        for (Vec3& p : triangle) p = at + drawn(0, 0.1 * side);
      }
      add(triangles);
    }
  }
  for (const double at : {0.0, 1.0}) {
    const double inside = at == 0 ? 0x1p-20 : 1 - 0x1p-20;
    add({{Vec3::Constant(at), Vec3(inside, at, at), Vec3(at, inside, at)}});
  }
  return scene.finish();
}

Scene cloth_apart(const ClothApart& wanted) {
  const SceneRequest request = parse_scene_name(wanted.name);
  ClothSettings settings;
  settings.triangles = request.parameters.size;
  settings.stiffness = request.parameters.second;
  Cloth cloth(settings);
  for (long i = 0; i < wanted.frame; ++i) cloth.step();
  Scene scene = cloth.scene();
  for (Object& object : scene.objects) object.self = false;
  return scene;
}

void fill(AnswerCounts& counts, const Scene& scene, const TruePairs& truth, const Errors& errors,
          std::uint64_t candidates) {
  counts.colliding = truth.pairs.size();
  counts.missed = errors.missed;
  counts.missed_triangles = errors.missed_triangles;
  counts.candidates = candidates;
  counts.triangles = scene.triangles.size();
  counts.objects = scene.objects.size();
}

// The number of missed pairs that penetrate.
std::uint64_t missed_penetrating(const Scene& scene, const TruePairs& truth,
                                 const std::vector<TrianglePair>& pairs) {
  std::vector<TrianglePair> missed;
  std::set_difference(truth.pairs.begin(), truth.pairs.end(), pairs.begin(), pairs.end(),
                      std::back_inserter(missed));
  return count_contacts(scene, missed).penetrating;
}

std::uint64_t hash_of(const std::vector<TrianglePair>& pairs) {
  Fnv1a hash;
  for (const TrianglePair& pair : pairs) hash.add(std::uint64_t{pair.a} << 32 | pair.b);
  return hash.value();
}

PointResult result_of(const Scene& scene, const TruePairs& truth, const Record& record) {
  const std::vector<TrianglePair> pairs = record.collisions.all();
  PointResult out{.answer = hash_of(pairs), .device = answered(record)};
  RunCounts counts;
  fill(counts, scene, truth, errors_of(truth, pairs), record.found.count);
  counts.missed_penetrating = missed_penetrating(scene, truth, pairs);
  counts.colliding_triangles = truth.triangles;
  counts.kept_triangles = record.found.triangle_count;
  counts.kept_objects = record.found.object_count;
  std::tie(counts.left_by_boxes, counts.views_used) = mechanism_of(scene, record);
  counts.promises = guaranteed(record.options);
  if (counts.promises && !record.promise.holds) counts.revoked = true;
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

Peer peer_named(const std::string& name) {
  for (const std::vector<Peer>& peers : {all_peers(), narrow_peers()}) {
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

const Scene& open_scene(const PointScene& scene, MeasurementContext& lab) {
  if (const auto* of = std::get_if<NamedScene>(&scene)) return lab.scene(of->name);
  if (const auto* of = std::get_if<MotionFrame>(&scene))
    return lab.scene(of->name, of->frame, of->frames);
  const PointKey key = key_of(RunPoint{.scene = scene});
  if (const auto* of = std::get_if<ContactCells>(&scene))
    return lab.scene(key.scene, [&] { return contact_cells(*of); });
  if (const auto* of = std::get_if<ClothApart>(&scene)) {
    return lab.scene(fmt::format("{} frame {}", key.scene, key.frame),
                     [&] { return cloth_apart(*of); });
  }
  if (const auto* of = std::get_if<ClusteredScene>(&scene))
    return lab.scene(key.scene, [&] { return clusters(*of); });
  return lab.scene(key.scene, pixel_corners);
}

void require_same(const PointKey& point, const PointResult& first, const PointResult& other) {
  std::string different;
  const auto add = [&different](const std::string& text) {
    different += (different.empty() ? "" : ", ") + text;
  };
  if (first.device != other.device) add("device " + first.device + " and " + other.device);
  // By name of a count: its two values, "none" if it is missing.
  std::map<std::string, std::pair<std::string, std::string>> values;
  const auto at = [&](const std::string& name) -> auto& {
    return values.try_emplace(name, "none", "none").first->second;
  };
  for (const auto& [name, value] : to_columns(first.counts)) at(name).first = text_of(value);
  for (const auto& [name, value] : to_columns(other.counts)) at(name).second = text_of(value);
  for (const auto& [name, both] : values) {
    if (both.first != both.second) add(name + " " + both.first + " and " + both.second);
  }
  if (first.answer != other.answer) add("the pairs themselves");
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
  return used.gl ? used.gl->renderer : used.cpu ? "native" : "cpu";
}

std::pair<std::uint64_t, std::uint64_t> mechanism_of(const Scene& scene, const Record& record) {
  std::uint64_t left = scene.triangles.size();
  for (const Stage& stage : record.trace) {
    if (stage.kind == StageKind::boxes && stage.ran && stage.unit == Unit::triangles)
      left = stage.out;
  }
  return {left, std::ranges::count_if(record.found.views(), &ViewReport::drawn)};
}

RunOptions options_of(const RunPoint& point, const MeasurementContext& lab) {
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

PointResult measure_run(const RunPoint& point, MeasurementContext& lab, Record* kept) {
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
  const TruePairs& truth = lab.truth();
  if (!moving) lab.session().sweep().forget();
  Record record = run(scene, options, lab.session(), lab.progress());
  PointResult out = result_of(scene, truth, record);
  std::get<RunCounts>(out.counts).size = size;
  out.times = {.cull = record.ms.cull,
               .exact = record.ms.exact,
               .total = compared_ms(record),
               .setup = record.ms.setup};
  if (kept != nullptr) *kept = std::move(record);
  return out;
}

std::pair<std::uint64_t, std::uint64_t> pairs_at_risk(const RunPoint& point,
                                                      MeasurementContext& lab) {
  const auto missed_at = [&](double factor) {
    RunPoint smaller = repeated(point, 1);
    smaller.radius = RadiusRule{.factor = factor};
    return std::get<RunCounts>(measure_run(smaller, lab).counts).missed;
  };
  const std::uint64_t smaller = missed_at(0.9);
  return {smaller, missed_at(0)};
}

PointResult measure_with_risk(const RunPoint& point, MeasurementContext& lab, Record* record) {
  PointResult out = measure_run(point, lab, record);
  auto* counts = std::get_if<RunCounts>(&out.counts);
  if (point.method == Method::far && counts != nullptr && counts->promises)
    std::tie(counts->at_risk, counts->at_risk_bare) = pairs_at_risk(point, lab);
  return out;
}

std::string library_of_peer(const Point& point) {
  const auto* asked = std::get_if<PeerPoint>(&point);
  if (asked == nullptr) return "";
  const Peer peer = peer_named(asked->peer);
  return peer.missing.empty() ? peer.library : "";
}

PointResult measure_peer(const PeerPoint& point, MeasurementContext& lab, unsigned threads,
                         std::vector<TrianglePair>* pairs) {
  const Scene& scene = open_scene(point.scene, lab);
  const Peer peer = peer_named(point.peer);
  PointResult out{.device = "cpu"};
  out.left_out = !peer.missing.empty() ? peer.missing : peer.refuses ? peer.refuses(scene) : "";
  if (!out.left_out.empty()) return out;
  const TruePairs truth = without_neighbours(scene, lab.truth());
  const BenchRun run = peer.set_up(threads);
  if (lab.progress()) lab.progress()(peer.name);
  const Stopwatch watch;
  const BenchAnswer answer = run(scene);
  const double total = watch.ms();
  const Errors errors = errors_of(truth, answer.pairs);
  PeerCounts counts;
  fill(counts, scene, truth, errors, answer.candidate_pairs);
  counts.wrong = errors.wrong;
  counts.colliding_triangles = truth.triangles;
  counts.library = peer.library;
  out.counts = std::move(counts);
  out.times = {.build = answer.build_ms,
               .cull = answer.candidates_ms,
               .exact = answer.exact_ms,
               .total = total};
  out.answer = hash_of(answer.pairs);
  if (pairs != nullptr) *pairs = answer.pairs;
  return out;
}

}  // namespace farcull
