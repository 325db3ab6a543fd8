// The tests of FAR pairs share this: the truth by exact tests of all pairs, and backends that are
// misled.
#pragma once

#include "core/pairs/backend.h"
#include "core/pairs/pairs.h"
#include "tests/lab/scenes.h"
#include "verify/exact.h"

namespace farcull::lab {

inline Scene with_self(Scene scene) {
  for (Object& object : scene.objects) object.self = true;
  return scene;
}

// Every pair that counts and collides, neighbours included, by the definition: all pairs of
// triangles, exact tests.
inline std::vector<TrianglePair> truth_of(const Scene& scene, double clearance = 0) {
  const ExactResult exact = all_colliding_pairs(scene, {.clearance = clearance});
  std::vector<TrianglePair> pairs = exact.pairs;
  pairs.insert(pairs.end(), exact.neighbour_pairs.begin(), exact.neighbour_pairs.end());
  std::ranges::sort(pairs);
  return pairs;
}

inline std::size_t missed(const std::vector<TrianglePair>& truth,
                          const std::vector<TrianglePair>& candidates) {
  return static_cast<std::size_t>(std::ranges::count_if(truth, [&](const TrianglePair& pair) {
    return !std::ranges::binary_search(candidates, pair);
  }));
}

inline std::size_t missed(const Scene& scene, const PairSettings& settings, PairBackend& backend) {
  const PairResult result = find_pairs(scene, settings, backend);
  EXPECT_TRUE(std::ranges::is_sorted(result.candidates));
  EXPECT_EQ(std::ranges::adjacent_find(result.candidates), result.candidates.end());
  return missed(truth_of(scene, settings.clearance), result.candidates);
}

// A backend whose task is changed on the way in.
class Changed : public PairBackend {
 public:
  using Change = void (*)(PairTask&);
  explicit Changed(Change change) : change_(change), inner_(cpu_pair_backend(2)) {}
  std::string name() const override { return "changed"; }
  std::vector<TrianglePair> raw_pairs(const PairTask& task, PairCounts& counts) override {
    PairTask other = task;
    change_(other);
    return inner_->raw_pairs(other, counts);
  }

 private:
  Change change_;
  std::unique_ptr<PairBackend> inner_;
};

// Scenes for FAR pairs with everything that takes programs of its own on a GL device.

// Every so-and-so-manyth object is tested against itself.
inline Scene with_self(Scene scene, int every) {
  for (std::size_t o = 0; o < scene.objects.size(); o += every) scene.objects[o].self = true;
  return scene;
}

inline PairSettings settings_of(std::uint64_t k) {
  static const int resolutions[] = {0, 32, 1, 7, 100, 256, 1024};
  static const char* views[] = {"", "z", "x,y,z", "1:1:0.5"};
  static const double clearances[] = {0, 0, 0, 0x1p-10, 0.1};
  PairSettings out{.resolution = resolutions[k % 7], .clearance = clearances[k % 5]};
  if (*views[k % 4] != '\0') out.views = parse_views(views[k % 4]);
  return out;
}

// Needles and crumbs in one corner of a pixel of a coarse view, deep enough for three cuts.
inline Scene crowded_scene(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<std::vector<std::array<Vec3, 3>>> objects(3);
  for (auto& object : objects) {
    object.push_back({Vec3(-1, -1, -1), Vec3(-1, -1, -1), Vec3(-1, -1, -1)});
    object.push_back({Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)});
    for (int i = 0; i < count; ++i) {
      const double spread = std::exp2(-2 - 3 * random.below(4));
      const Vec3 at = Vec3(0.3, 0.3, 0.1) + spread * Vec3(random.unit(), random.unit(), 0) +
                      Vec3(0, 0, random.between(0, 0.5));
      const double size = std::exp2(-4 - random.below(9));
      const auto corner = [&] {
        return Vec3(
            at + size * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)));
      };
      object.push_back({corner(), corner(), corner()});
      if (i % 4 == 0) object.back()[2] = object.back()[1] + Vec3(1e-6, 0, 0);
    }
  }
  return scene_of(objects);
}

// A bit of everything that takes programs of its own: rows, crowds, large triangles, self.
inline Scene mixed_scene() {
  Scene scene = crowded_scene(5, 600);
  add_triangle(scene, {Vec3(-1, -1, 0.2), Vec3(1, -1, 0.1), Vec3(0, 1, 0.3)});
  add_triangle(scene, {Vec3(-1, 0.9, 0), Vec3(0.9, -1, 0.5), Vec3(0.95, -1, 0.4)});
  scene.objects.back().triangle_count += 2;
  validate(scene, "test");
  return scene;
}

// Scenes whose pairs are found in many pixels, for both back ends of FAR pairs.

using Triangles = std::vector<std::array<Vec3, 3>>;

/// `count` triangles an object that lie on each other, up to `apart`.
inline Scene coincident(int count, double apart, std::uint64_t seed) {
  Random random(seed);
  const auto near = [&](double x) { return x + apart * random.between(-1, 1); };
  std::vector<Triangles> objects(2);
  for (Triangles& object : objects) {
    for (int k = 0; k < count; ++k) {
      object.push_back({Vec3(near(0), near(0), near(0)), Vec3(near(1), near(0.1), near(0.3)),
                        Vec3(near(0.2), near(1), near(0.2))});
    }
  }
  return scene_of(objects);
}

/// Long thin triangles, which cross, through a small box.
inline Scene needles(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Triangles> objects(2);
  for (Triangles& object : objects) {
    for (int k = 0; k < count; ++k) {
      const auto point = [&] {
        return Vec3(random.between(-1, 1), random.between(-1, 1), 0.1 * random.between(-1, 1));
      };
      const Vec3 a = point(), b = point();
      object.push_back({a, b, b + Vec3(1e-3, 1e-3, 0)});
    }
  }
  return scene_of(objects);
}

/// Small ones in a heap on two large ones.
inline Scene heap(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Triangles> objects(2);
  for (Triangles& object : objects) {
    const double z = 0.01 * random.unit();
    object.push_back({Vec3(-1, -1, z), Vec3(3, -1, z), Vec3(-1, 3, 0)});
    for (int k = 0; k < count; ++k) {
      const auto near = [&](double x) { return x + 0.03 * random.between(-1, 1); };
      object.push_back({Vec3(near(0.3), near(0.3), near(0)), Vec3(near(0.3), near(0.3), near(0)),
                        Vec3(near(0.3), near(0.3), near(0))});
    }
  }
  return scene_of(objects);
}

struct RepeatedCase {
  std::string name;
  Scene scene;
  std::vector<int> resolutions;
};
inline std::vector<RepeatedCase> repeated_cases() {
  std::vector<RepeatedCase> out;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    out.push_back({"random", random_scene(seed), {3, 30, 200}});
  for (const double apart : {0.0, 1e-9, 1e-3, 0.05}) {
    out.push_back({"coincident", coincident(150, apart, 3), {2, 9, 31}});
    out.push_back({"coincident with itself", with_self(coincident(90, apart, 4)), {9}});
  }
  out.push_back({"crowded", coincident(700, 0.02, 5), {1, 6}});
  for (const std::uint64_t seed : {6u, 7u}) {
    out.push_back({"needles", needles(250, seed), {4, 25}});
    out.push_back({"needles with themselves", with_self(needles(120, seed)), {4, 25}});
    out.push_back({"heap", heap(300, seed), {2, 20, 90}});
  }
  out.push_back({"crowded heap", heap(900, 8), {2, 20}});
  return out;
}

/// Calls visit(task, name) for each case in each of its resolutions.
template <class Visit>
void for_each_task(const Visit& visit) {
  for (const RepeatedCase& c : repeated_cases()) {
    const PairRegions regions = pair_regions(c.scene, 0, false, 1);
    if (regions.triangles.empty()) continue;
    for (const int resolution : c.resolutions) {
      PairScene seen;
      const std::optional<PairWindow> window = pair_window(regions, parse_view("z"), resolution, 0);
      ASSERT_TRUE(window);
      look(c.scene, regions, regions.triangles, *window, 1, seen);
      visit(seen.task, c.name + " at " + std::to_string(resolution));
    }
  }
}

}  // namespace farcull::lab
