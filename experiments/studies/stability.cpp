// The study "stability": scenes that go to an extreme, and who still finds what collides in them.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <stdexcept>

#include "experiments/builtin_scenes.h"
#include "experiments/cloth.h"
#include "experiments/peer.h"
#include "experiments/studies/lab.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr const char* kOffset = "@offset-";
constexpr const char* kScale = "@scale-";
constexpr const char* kApart = "@apart";  // of a cloth: not against itself

struct Contestant {
  const char* method;
  const char* offset;
};
constexpr Contestant kBetweenObjects[] = {{"cullide", ""},  {"fcl-float", ""}, {"far", "obb"},
                                          {"far", "exact"}, {"far-pairs", ""}, {"exact", ""}};
constexpr Contestant kAgainstItself[] = {
    {"s-cullide", ""}, {"fcl-float", ""}, {"far-pairs", ""}, {"exact", ""}};

constexpr int kResolution = 512;

bool has_resolution(const std::string& method) {
  return method == "cullide" || method == "s-cullide" || method == "far";
}

void add(std::vector<Point>& out, const std::string& scene, std::span<const Contestant> contestants,
         long frame = -1) {
  for (const Contestant& c : contestants) {
    out.push_back({.scene = scene,
                   .method = c.method,
                   .offset = c.offset,
                   .radius = std::string(c.method) == "far" ? "budget" : "",
                   .depth_format = {},
                   .depth_mode = {},
                   .resolution = has_resolution(c.method) ? kResolution : 0,
                   .views = {},
                   .frame = frame,
                   .seed = 0});
  }
}

std::vector<Point> grid(const GridChoice& choice) {
  const bool quick = choice.quick;
  const auto powers = [quick](int from, int to, int quick_step, int step) {
    std::vector<int> out;
    for (int i = from; i <= to; i += quick ? quick_step : step) out.push_back(i);
    return out;
  };
  std::vector<Point> out;
  const int slivers = quick ? 200 : 400, sheets = quick ? 6 : 8, large = quick ? 40 : 100,
            pairs = quick ? 216 : 512, cloth = quick ? 450 : 800;
  for (const int k : powers(2, 12, 5, 2))
    add(out, fmt::format("slivers:{}:1e{}", slivers, k), kBetweenObjects);
  for (const int k : powers(1, 14, 6, 1))
    add(out, fmt::format("stack:{}:1e-{}", sheets, k), kBetweenObjects);
  for (const int k : powers(0, 12, 6, 2))
    add(out, fmt::format("mixed:{}:1e{}", large, k), kBetweenObjects);
  for (const char* sign : {"-", ""}) {
    for (const int k : powers(0, 12, 6, 3))
      add(out, fmt::format("gap:{}:{}1e{}", pairs, sign, k), kBetweenObjects);
    // A pixel of the widest view is 9e12 ulps.
    add(out, fmt::format("gap:{}:{}1e13", pairs, sign), kBetweenObjects);
  }
  add(out, fmt::format("gap:{}:0", pairs), kBetweenObjects);
  const std::string moved = quick ? "crowd:60" : "crowd:200";
  for (const int k : powers(0, 9, 3, 1))
    add(out, fmt::format("{}{}1e{}", moved, kOffset, k), kBetweenObjects);
  for (const int k : powers(-9, 9, 9, 3))
    add(out, fmt::format("{}{}1e{}", moved, kScale, k), kBetweenObjects);
  const std::vector<long> frames =
      quick ? std::vector<long>{40} : std::vector<long>{10, 25, 40, 60, 80, 100};
  for (const int k : {2, 4, 6, 8}) {
    const std::string name = fmt::format("cloth:{}:1e{}", cloth, k);
    for (const long frame : frames) add(out, name, kAgainstItself, frame);
    for (const long frame : frames) add(out, name + kApart, kBetweenObjects, frame);
  }
  return out;
}

double number_after(const std::string& text, std::size_t at) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data() + at, text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size())
    throw std::logic_error("stability: " + text);
  return value;
}

// The cloth of the name, above its sphere and not against itself.
Scene cloth_apart(const std::string& name, long frame) {
  const SceneRequest request = parse_scene_name(name);
  ClothSettings settings;
  settings.triangles = request.parameters.size;
  settings.stiffness = request.parameters.second;
  Cloth cloth(settings);
  for (long i = 0; i < frame; ++i) cloth.step();
  Scene scene = cloth.scene();
  for (Object& object : scene.objects) object.self = false;
  return scene;
}

constexpr long kFrames = 500;  // of the cloth

void load(const Point& point, Lab& lab) {
  const std::string& name = point.scene;
  if (const auto at = name.find(kApart); at != std::string::npos) {
    lab.scene(fmt::format("{} frame {}", name, point.frame),
              [&] { return cloth_apart(name.substr(0, at), point.frame); });
  } else if (const auto offset = name.find(kOffset); offset != std::string::npos) {
    const double by = number_after(name, offset + std::string(kOffset).size());
    lab.scene(name, [&] {
      return transformed(make_builtin_scene(name.substr(0, offset)), 1, Vec3::Constant(by));
    });
  } else if (const auto scale = name.find(kScale); scale != std::string::npos) {
    const double by = number_after(name, scale + std::string(kScale).size());
    lab.scene(name, [&] {
      return transformed(make_builtin_scene(name.substr(0, scale)), by, Vec3::Zero());
    });
  } else {
    lab.scene(name, point.frame, kFrames);
  }
}

// A library with its own test of two triangles. It leaves neighbours out, so they are no misses of
// its: where an object is tested against itself the truth is that of the other pairs.
Measurement measure_narrow(const Point& point, Lab& lab) {
  Measurement out;
  out.device = "cpu";
  const std::vector<Peer> peers = narrow_peers();
  const auto peer = std::find_if(peers.begin(), peers.end(),
                                 [&](const Peer& p) { return p.name == point.method; });
  if (peer == peers.end()) throw std::logic_error("stability: no peer " + point.method);
  if (!peer->missing.empty()) {
    out.left_out = peer->missing;
    return out;
  }
  const Scene& scene = lab.current();
  Truth apart = lab.truth();
  if (has_self(scene)) apart.pairs = all_colliding_pairs(scene, {}).pairs;
  const BenchAnswer answer = peer->set_up(1)(scene);
  const Errors errors = errors_of(apart, answer.pairs);
  out.counts = {{"colliding", apart.pairs.size()},
                {"missed", errors.missed},
                {"missed_triangles", errors.missed_triangles},
                {"wrong", errors.wrong},
                {"candidates", answer.candidate_pairs},
                {"triangles", scene.triangles.size()},
                {"objects", scene.objects.size()},
                {"promises", false},
                {"scene_hash", scene_hash(scene)}};
  out.times = {{"build", answer.build_ms},
               {"cull", answer.candidates_ms},
               {"exact", answer.exact_ms},
               {"total", answer.build_ms + answer.candidates_ms + answer.exact_ms}};
  return out;
}

Measurement measure(const Point& point, Lab& lab) {
  load(point, lab);
  return point.method.starts_with("fcl-") ? measure_narrow(point, lab) : measure_run(point, lab);
}

}  // namespace

Study stability_study() {
  return {.name = "stability",
          .title = "Scenes that go to an extreme",
          .question =
              "What is missed where cloth is stiff, triangles are slivers, gaps are ulps, "
              "sheets are stacked, sizes differ by far, or the scene is far away, tiny or "
              "huge, and how much does culling then still remove?",
          .grid = grid,
          .measure = measure};
}

}  // namespace farcull
