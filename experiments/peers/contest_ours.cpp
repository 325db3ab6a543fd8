// farcull's own methods as contestants. The environment variable FARCULL_CONTEST_DEVICE names the
// device; without the variable, the cores of the CPU are used. Methods run as by `farcull run`,
// except that `boxes` runs by Collider::find() of the library.
#include <algorithm>
#include <map>

#include "experiments/library/farcull.h"
#include "experiments/method/clash.h"
#include "experiments/method/run.h"
#include "experiments/peers/contestant.h"
#include "verify/closest.h"
#include "verify/exact.h"
#include "verify/inside.h"

namespace farcull {
namespace {

std::string device() {
  const char* const named = std::getenv("FARCULL_CONTEST_DEVICE");
  return named != nullptr && *named != '\0' ? named : "native";
}

/// Returns the pairs of triangles of one object that share a vertex position, but no vertex index;
/// sorted. For farcull these triangles are neighbours, for which touching does not count. A suite
/// defines neighbours by vertex indices. So a suite expects these pairs as touching triangles.
std::vector<TrianglePair> touching_strangers(const Scene& scene) {
  std::map<std::array<double, 3>, std::vector<std::uint32_t>> at;
  for (const Object& object : scene.objects) {
    if (!object.self) continue;
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
      const std::uint32_t t = object.first_triangle + i;
      for (const Vec3& p : scene.corners(t)) {
        std::vector<std::uint32_t>& of = at[{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}];
        if (of.empty() || of.back() != t) of.push_back(t);
      }
    }
  }
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<TrianglePair> out;
  for (const auto& [position, of] : at) {
    for (std::size_t i = 0; i < of.size(); ++i) {
      for (std::size_t j = i + 1; j < of.size(); ++j) {
        if (owner[of[i]] == owner[of[j]] &&
            !share_index(scene.triangles[of[i]], scene.triangles[of[j]]))
          out.push_back({of[i], of[j]});
      }
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Returns the pairs that a method reports, plus touching_strangers(), which a suite expects.
std::vector<TrianglePair> pairs_by(RunOptions options, const Scene& scene) {
  static Session session(device(), 1, {});
  if (draws(options.method)) options.device = device();
  options.verify = false;
  // The first run on a software renderer probes the device, which takes long. A suite allows only
  // the first answer to take long. So the first call always draws two triangles.
  [[maybe_unused]] static const Record probed =
      run(scene_of({.shared = {},
                    .a = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)},
                    .b = {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(2, 2, 1)}}),
          options, session);
  const Record record = run(scene, options, session);
  std::vector<TrianglePair> out = record.collisions.all();
  const std::vector<std::uint32_t>& kept = record.found.triangles;
  for (const TrianglePair& pair : touching_strangers(scene)) {
    const auto is_kept = [&](std::uint32_t t) {
      return std::binary_search(kept.begin(), kept.end(), t);
    };
    // For a method that draws, a pair counts only if both triangles remain after culling.
    if (!draws(options.method) || (is_kept(pair.a) && is_kept(pair.b))) out.push_back(pair);
  }
  return out;
}

std::vector<TrianglePair> pairs_by_library(const Scene& scene) {
  static Collider collider({.threads = 1});
  static Collider of_self({.threads = 1, .self = true});
  const bool self = !scene.objects.empty() && scene.objects.front().self;
  std::vector<std::uint32_t> triangles, starts;
  for (const auto& triangle : scene.triangles)
    triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  for (const Object& object : scene.objects) starts.push_back(object.first_triangle);
  const Input input{.vertices = {scene.vertices.front().data(), 3 * scene.vertices.size()},
                    .triangles = triangles,
                    .object_starts = starts};
  const Result result = (self ? of_self : collider).find(input);
  std::vector<TrianglePair> out = touching_strangers(scene);
  for (const auto* some : {&result.pairs, &result.neighbour_pairs}) {
    for (const Pair& pair : *some) out.push_back({pair.a, pair.b});
  }
  return out;
}

Contestant contestant(ContestantCard card,
                      const std::function<std::vector<TrianglePair>(const Scene&)>& find) {
  card.library = "farcull";
  card.source = "docs/methods.md and docs/reliability.md";
  return {.card = std::move(card),
          .pair = [=](const SuitePair& pair) { return !find(scene_of(pair)).empty(); },
          .mesh = find};
}

Contestant of_method(Method method, const std::string& says, const std::string& use,
                     const RadiusRule& radius = {}) {
  const RunOptions options{.method = method, .radius = radius};
  return contestant({.name = to_string(method),
                     .neighbours = tests_self(method),
                     .guaranteed = !culls(method) || guaranteed(options),
                     .call = "farcull run --method " + to_string(method) + " --device " + device(),
                     .says = says,
                     .use = use},
                    [options](const Scene& scene) { return pairs_by(options, scene); });
}

/// Returns a control contestant: far with a smaller radius, which must miss pairs. Otherwise the
/// result that far misses no pair would show nothing.
Contestant far_at(const std::string& radius) {
  Contestant out =
      of_method(Method::far, "a control, which has to miss pairs", "nothing", parse_radius(radius));
  out.card.name = "far-at-" + radius;
  out.card.call += " --radius " + radius;
  return out;
}

/// True if the insides of two objects overlap, as decided by `farcull clash`.
bool clash_of(const Scene& scene) {
  const ClashRecord record = clashes(scene, {.threads = 1});
  if (record.rows.empty()) return false;
  const ClashRow& row = record.rows.front();
  if (row.verdict == ClashVerdict::unknown || !row.proved)
    throw Refusal("it is not proved whether the insides overlap");
  return row.verdict == ClashVerdict::clash || row.verdict == ClashVerdict::contained;
}

/// Returns a contestant: the method `exact`, with exact tests of distances and of clashes.
Contestant exact() {
  Contestant out = of_method(Method::exact, "every pair whose boxes meet is decided exactly",
                             "the answer to compare with");
  out.distance = [](const SuitePair& pair) {
    const Closest found = closest_points(pair.a, pair.b);
    return ContestDistance{found.distance, found.points};
  };
  out.self = [mesh = out.mesh](const Scene& scene) { return !mesh(scene).empty(); };
  out.inside = [](const Scene& scene, const Vec3& point) {
    const Inside where = inside(scene, 0, point);
    if (where == Inside::not_closed) throw Refusal("the mesh is not closed");
    return where != Inside::no;
  };
  out.clash = clash_of;
  return out;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  ::setenv("LP_NUM_THREADS", "0", 0);  // as in the program farcull (docs/drivers.md)
  const char* const reliable = "misses no pair; exact tests decide what is left";
  const Contestant boxes = contestant({.name = "boxes",
                                       .neighbours = true,
                                       .guaranteed = true,
                                       .call = "farcull::Collider::find()",
                                       .says = reliable,
                                       .use = "where no pair may be missed"},
                                      pairs_by_library);
  return contest(
      argc, argv,
      {boxes, exact(),
       of_method(Method::far, reliable, "FAR (2004), with the radius of the error budget"),
       of_method(Method::i_collide, reliable, "few objects that move little"), far_at("0.9")});
}
