// Makes and opens the scenes of points, runs methods and libraries on them, and compares each run
// with the exact answer.
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

using shapes::Corners;

// A scene of two objects, made of segments. Each segment crosses a segment of the other object
// within 2^-10 px of a corner of a pixel, in the view z at kCornersResolution. The segments are at
// 45 degrees to the pixels. The objects' boxes are as many units wide as the window has pixels. So
// a unit is a pixel, and corners of pixels are at whole numbers (core/view/view.h, fit_window).
constexpr const char* kCorners = "pixel-corners";
constexpr int kCornersResolution = 96;

Scene pixel_corners() {
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
  for (const double at : {-1.0, 1.0}) {  // makes both boxes as large as the window
    const Vec3 p(at * kHalf, at * kHalf, 64);
    for (auto* list : {&one, &other}) list->push_back({p, p, p});
  }
  SceneBuilder scene(kCorners, kCorners);
  scene.add(shapes::soup(one), "rising");
  scene.add(shapes::soup(other), "falling");
  return scene.finish();
}

// A cube of side 1 with ten clusters of twenty objects. A cluster is a cube of side 1 / ratio at a
// random place, and an object has one to four triangles. Two more objects of one triangle lie in
// opposite corners of the large cube, so that a grid covers the cube.
Scene clusters(const ClusteredScene& wanted) {
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
      // An object has a tenth of the cluster's side, so that most objects do not meet.
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

// The scene of ContactCells: contacts that depend on a number, which may be harmless or extreme.
// Cell (i, j) lies at (i, j, i + j modulo side), so that no two cells share a pixel in the views x,
// y and z. A unit is a pixel, and corners of pixels are at whole numbers in all three views. Every
// six consecutive cells are
// - one cell whose contact is at risk and does not depend on the number. In the view along one
// axis, the images of its triangles are segments at 45 degrees that cross at the corner of a pixel.
// Every pixel centre is at least 0.707 px, half a pixel's diagonal, from one of the two segments.
// So only a ball of at least 0.707 px finds such a contact. The budget radius is 0.709 px;
// - two cells whose contact depends on the number. The contact lies at most 15/64 px from the
// centre of a pixel along each axis, so that much smaller balls find this contact at every value;
// - three cells whose triangles are far apart, so that methods have triangles to cull.

constexpr double kCell = 20;      // px, side of a cell
constexpr double kUlp = 0x1p-45;  // px, a unit in the last place from 128 to 256

// Returns the triangles of a contact at risk, at the origin. Their images in the view z are
// segments. slope: scales the change of depth along these segments.
std::vector<Corners> at_risk(double slope) {
  const Vec3 up(3, 3, 3 * slope), down(3, -3, -1.5 * slope), depth(0, 0, 2.5);
  return {{-up - depth, up - depth, depth}, {depth - down, depth + down, -depth}};
}

// Returns one triangle for each object. The triangles make a contact near the origin that depends
// on the number. With harmless values each triangle is about 11 px long. The triangles cross along
// a line. In each view, there is room for a pixel centre on both sides of this line.
std::vector<Corners> varying(const std::string& family, double value) {
  const auto sheet = [](const Vec3& along, const Vec3& across, double aspect) {
    const Vec3 u = 2.25 * along, v = 2.5 / aspect * across;
    return Corners{-u - v, u - v, 2 * v};
  };
  const auto crossing = [&](double aspect) {
    return std::vector<Corners>{sheet(Vec3(1, -2, 1), Vec3(1, 0, -1), aspect),
                                sheet(Vec3(2, -1, 1), Vec3(0, -1, -1), aspect)};
  };
  // Returns a triangle with this tip. Its other corners are above the plane of crossing(1)[0].
  const auto wedge = [](const Vec3& tip) { return Corners{tip, {7.5, -1.5, 6}, {-1.5, 7.5, 6}}; };
  std::vector<Corners> out = crossing(family == "slivers" ? value : 1);
  if (family == "mixed") {
    for (Vec3& p : out[1]) p /= value;
  } else if (family == "edge-on") {
    for (Vec3& p : out[1]) p -= (1 - 1 / value) / 2 * (p[0] + p[1]) * Vec3(1, 1, 0);
  } else if (family == "overlap" || family == "gap") {
    const double depth = std::nearbyint(value / kUlp) * (family == "gap" ? -kUlp : kUlp);
    out[1] = wedge(-depth * Vec3(1, 1, 2));
  } else if (family == "stack") {
    const double distance = stack_gap(value);
    out = {wedge(-distance * Vec3(2, 2, 3)), out[0]};
    for (const double at : {-distance, distance})
      out.push_back(shapes::shifted(out[1], Vec3::Constant(at)));
  } else if (family != "slivers" && family != "offset" && family != "scale") {
    throw std::logic_error("contact_cells: no family " + family);
  }
  return out;
}

// Moves two triangles so far apart that their oriented boxes are disjoint in one of the views.
std::vector<Corners> apart(std::vector<Corners> triangles) {
  triangles.resize(2);
  for (const int o : {0, 1}) {
    for (Vec3& p : triangles[o]) p = p / 2 + Vec3::Constant(4 * o - 2);
  }
  return triangles;
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

AnswerCounts answer_counts(const Scene& scene, const TruePairs& truth, const Errors& errors,
                           std::uint64_t candidates) {
  return {.colliding = truth.pairs.size(),
          .missed = errors.missed,
          .missed_triangles = errors.missed_triangles,
          .candidates = candidates,
          .triangles = scene.triangles.size(),
          .objects = scene.objects.size()};
}

std::uint64_t hash_of(const std::vector<TrianglePair>& pairs) {
  Fnv1a hash;
  for (const TrianglePair& pair : pairs) hash.add(std::uint64_t{pair.a} << 32 | pair.b);
  return hash.value();
}

PointResult result_of(const Scene& scene, const TruePairs& truth, const Record& record) {
  const std::vector<TrianglePair> pairs = record.collisions.all();
  PointResult out{.answer = hash_of(pairs), .device = answered(record)};
  std::vector<TrianglePair> missed;
  std::ranges::set_difference(truth.pairs, pairs, std::back_inserter(missed));
  RunCounts counts{answer_counts(scene, truth, errors_of(truth, pairs), record.found.count)};
  counts.missed_penetrating = count_contacts(scene, missed).penetrating;
  counts.colliding_triangles = truth.triangles;
  counts.kept_triangles = record.found.triangle_count;
  counts.kept_objects = record.found.object_count;
  std::tie(counts.left_by_boxes, counts.views_used) = mechanism_of(scene, record);
  counts.promises = guaranteed(record.options);
  if (counts.promises && !record.promise.holds) counts.revoked = true;
  counts.scene_hash = record.scene_hash;
  counts.object_triangles = record.found.swept_triangles();
  if (draws(record.options.method)) {
    const Stage sum = work_of(record.trace);
    counts.drawn = {sum.queries, sum.draws, sum.queries_saved, sum.draws_saved};
    if (const ViewReport* view = widest_budget(record.found.views()))
      counts.radius = {view->radius_px, view->pixel_size};
  }
  out.counts = std::move(counts);
  return out;
}

// A point is left out if RunPoint::mean_pixels requires a higher resolution.
constexpr int kMostSizedResolution = 8192;  // px

// Returns the lowest resolution at which triangles that may collide cover `pixels` pixels on
// average, over the triangles and the views x, y, z. The number of pixels is taken as the area of
// the triangle's image. Returns resolution 0 if the triangles have no area.
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
  const double mean = area / static_cast<double>(count);
  if (!(mean > 0)) return {};  // the mean is NaN without triangles
  const double side = std::ceil(kSample * std::sqrt(pixels / mean));
  return {.resolution = side < 1e9 ? static_cast<std::uint64_t>(side) : 0,
          .mean_pixels = mean * side * side / kSample / kSample};
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

bool varies(const TrianglePair& pair, const ContactCells& cells) {
  return pair.a < static_cast<std::uint32_t>(cells.side * cells.side) && pair.a % 2 == 0 &&
         pair.a % 6 != 0;
}

Scene contact_cells(const ContactCells& wanted) {
  const double value = std::strtod(wanted.value.c_str(), nullptr);
  shapes::Random random(17);
  const auto near = [&random] { return (static_cast<double>(random.below(16)) - 7.5) / 32; };
  const std::vector<Corners> contact = varying(wanted.family, value);
  std::vector<std::vector<Corners>> objects(contact.size());
  for (int cell = 0; cell < wanted.side * wanted.side; ++cell) {
    const int i = cell / wanted.side, j = cell % wanted.side, axis = cell / 6 % 3, kind = cell % 6;
    Vec3 middle =
        kCell * (Vec3(i, j, (i + j) % wanted.side) - Vec3::Constant((wanted.side - 1) / 2.0));
    for (const int k : {0, 1, 2}) middle[k] += kind == 0 ? 0 : 0.5 + near();
    const std::vector<Corners> triangles = kind == 0       ? at_risk((cell % 5 - 2) / 8.0)
                                           : kind % 2 == 0 ? contact
                                                           : apart(contact);
    for (std::size_t o = 0; o < triangles.size(); ++o) {
      Corners& placed = objects[o].emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& p = triangles[o][c];
        placed[c] = middle + Vec3(p[(5 - axis) % 3], p[(6 - axis) % 3], p[(7 - axis) % 3]);
      }
    }
  }
  // Small triangles at two corners give all objects the same box, which has the window's size.
  for (std::size_t o = 0; o < objects.size(); ++o) {
    for (const double at : {-kCellsResolution / 2.0, kCellsResolution / 2.0}) {
      Corners& corner = objects[o].emplace_back();
      corner.fill(Vec3::Constant(at));
      for (const std::size_t k : {1, 2})
        corner[k][static_cast<Eigen::Index>((o + k) % 3)] -= std::copysign(0x1p-6, at);
    }
  }
  SceneBuilder scene("contacts", "contacts");
  for (std::size_t o = 0; o < objects.size(); ++o)
    scene.add(shapes::soup(objects[o]), "object" + std::to_string(o));
  return transformed(scene.finish(), wanted.family == "scale" ? value : 1,
                     Vec3::Constant(wanted.family == "offset" ? value : 0));
}

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
  // Maps the name of a count to its values in the two runs; "none" if a run lacks the count.
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
  RunOptions options{.method = point.method,
                     .resolution = point.resolution,
                     .radius = point.radius.value_or(RadiusRule{}),
                     .depth = point.depth_mode,
                     .depth_format = point.depth_format.value_or(DepthFormat::float32),
                     .rounds = point.form.rounds,
                     .clear = point.form.clear,
                     .objects_alone = point.form.objects_alone,
                     .conservative = point.form.conservative,
                     .views = point.form.views,
                     .device = lab.device(),
                     .verify = false};
  if (!point.offset.empty()) options.offset = point.offset;
  // A point without times counts misses. So FAR draws all views, as runs with a smaller ball do.
  options.no_shortcuts = point.repeat == 1 && fattens(point.method) &&
                         !std::holds_alternative<MotionFrame>(point.scene);
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
  PointResult out{.device = "cpu", .left_out = why_left_out(peer, scene)};
  if (!out.left_out.empty()) return out;
  const TruePairs truth = without_neighbours(scene, lab.truth());
  const BenchRun run = peer.set_up(threads);
  if (lab.progress()) lab.progress()(peer.name);
  const Stopwatch watch;
  const BenchAnswer answer = run(scene);
  const double total = watch.ms();
  const Errors errors = errors_of(truth, answer.pairs);
  PeerCounts counts{answer_counts(scene, truth, errors, answer.candidate_pairs)};
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
