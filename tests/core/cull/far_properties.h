// FAR on scenes that aim at trouble, as a rapidcheck property of any canvas. A counter-example
// shrinks to few triangles and is written to tests/cases, where the suite replays it ever after.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/cull/cull.h"
#include "core/scene/box_join.h"
#include "core/view/regions.h"
#include "experiments/scenes/mesh/mesh.h"
#include "experiments/scenes/scene_file.h"
#include "offsets/minkowski.h"
#include "offsets/obb.h"
#include "tests/core/canvas/lab.h"
#include "tests/core/scene/scenes.h"
#include "verify/accounting.h"
#include "verify/exact.h"

namespace farcull::lab {

/// FAR with a canvas of the caller's: plan, cull, join, account.
struct Outcome {
  Accounting accounting;
  std::size_t live = 0;
  std::size_t undrawable_stages = 0;  // how often something was beyond the budget
};

inline Outcome far_on(Canvas& canvas, const Scene& scene, const Fattener& fattener,
                      const std::string& views, int resolution, double factor = 1) {
  const Regions plan = find_regions(scene);
  const CullSettings settings{.views = parse_views(views),
                              .resolution = resolution,
                              .fattener = fattener,
                              .radius = {.published = false, .factor = factor},
                              .quick = true};
  const CullResult result = cull(scene, plan, settings, canvas);
  Outcome out{account(scene, box_join(plan.triangle_boxes, owners(scene), result.live)),
              result.live.size()};
  for (const Stage& stage : result.stages) {
    out.undrawable_stages += reason_of(stage).find("beyond the budget") != std::string::npos ||
                             reason_of(stage).find("cannot resolve") != std::string::npos;
  }
  return out;
}

/// A triangle as small numbers; what they mean is up to the family. Small numbers make exact
/// contacts, coplanar overlaps and degenerate triangles common, and shrink well.
struct Spec {
  int object;                // 0 .. 2
  std::array<int, 9> at;     // -8 .. 8
  std::array<int, 9> nudge;  // -1 .. 1
  int kind;                  // 0 .. 7
};

inline rc::Gen<Spec> spec() {
  return rc::gen::map(
      rc::gen::tuple(
          rc::gen::inRange(0, 3), rc::gen::container<std::array<int, 9>>(rc::gen::inRange(-8, 9)),
          rc::gen::container<std::array<int, 9>>(rc::gen::inRange(-1, 2)), rc::gen::inRange(0, 8)),
      [](const std::tuple<int, std::array<int, 9>, std::array<int, 9>, int>& t) {
        return Spec{std::get<0>(t), std::get<1>(t), std::get<2>(t), std::get<3>(t)};
      });
}

inline std::array<Vec3, 3> base_triangle(const Spec& s) {
  std::array<Vec3, 3> t;
  for (int i = 0; i < 9; ++i) t[i / 3][i % 3] = s.at[i] * 0.125;
  if (s.kind == 1) t[2] = t[1];
  if (s.kind == 2) t[2] = t[1] = t[0];
  return t;
}

inline void nudge_by(std::array<Vec3, 3>& t, const Spec& s, double step) {
  for (int i = 0; i < 9; ++i) t[i / 3][i % 3] += s.nudge[i] * step;
}

inline void ulps(std::array<Vec3, 3>& t, const Spec& s) {
  for (int i = 0; i < 9; ++i) {
    double& x = t[i / 3][i % 3];
    if (s.nudge[i] != 0) x = std::nextafter(x, s.nudge[i] * HUGE_VAL);
  }
}

inline void scale_by(std::array<Vec3, 3>& t, double factor) {
  for (Vec3& c : t) c *= factor;
}

/// What a family does to the base triangle of a spec, and the fraction of the budget's radius at
/// which its scenes lose a pair. A contact that is a point is lost where it is farther than the
/// radius from the centre of its pixel. That is so at 2 % of the places in a pixel for 0.9 of the
/// radius, at 13 % for 0.75, at 60 % for 0.5. Families whose contacts are mostly long, or whose
/// boxes are wide, so that another pixel sees them, need 0.5; the others name 0.75, or 0.9 where
/// most of their contacts are points in one pixel.
struct Family {
  const char* name;
  double loses_at;
  void (*place)(const Spec&, std::array<Vec3, 3>&);
};

inline const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"grid", 0.5, [](const Spec&, std::array<Vec3, 3>&) {}},
      {"one-ulp", 0.75, [](const Spec& s, std::array<Vec3, 3>& t) { ulps(t, s); }},
      {"needles", 0.5,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         t[2] = s.kind % 2 ? t[1] : Vec3(0.5 * (t[0] + t[1]));
         t[2][s.kind % 3] += std::ldexp(s.nudge[0], -10 * (1 + s.kind % 4));
       }},
      {"slivers-12", 0.5,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         t[2] = t[0] + 0.25 * (t[1] - t[0]);
         t[2][s.kind % 3] += s.nudge[0] * 1e-12;
       }},
      {"coplanar", 0.75,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         for (Vec3& c : t) c[s.at[0] & 1 ? 2 : 1] = 0.25 * (s.kind % 2);
       }},
      {"one-plane", 0.5,
       [](const Spec&, std::array<Vec3, 3>& t) {
         for (Vec3& c : t) c[2] = c[0] + c[1];
       }},
      {"tiny-1e-30", 0.5, [](const Spec&, std::array<Vec3, 3>& t) { scale_by(t, 1e-30); }},
      {"huge-1e30", 0.5,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         ulps(t, s);
         scale_by(t, 1e30);
       }},
      // Extents below 2^-960 are one pixel (view.cpp), and nothing in it is culled. So the
      // triangles are larger, and contacts at zero are decided by denormals.
      {"denormals", 0.5,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         scale_by(t, 0x1p-950);
         nudge_by(t, s, 0x1p-1074);
       }},
      {"largest", 0.5, [](const Spec&, std::array<Vec3, 3>& t) { scale_by(t, 0x1p1022); }},
      {"mixed-magnitudes", 0.9,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         for (int i = 0; i < 3; ++i) t[i] *= std::ldexp(1.0, 30 * s.nudge[i]);
       }},
      {"far-1e9", 0.5,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         for (Vec3& c : t) c += Vec3(2e9, -1e9, 3e9);
         ulps(t, s);
       }},
      // A pixel is at least 2^-45 of the coordinates, 57 here: the scene has to be larger than
      // that.
      {"far-1e15", 0.75,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         scale_by(t, 4096);
         for (Vec3& c : t) c += Vec3(1e15, 2e15, -1e15);
         ulps(t, s);
       }},
      {"huge-beside-tiny", 0.5,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         if (s.object == 0) scale_by(t, std::ldexp(1.0, 5 * s.kind));
       }},
      // Each is scaled about a corner of its own, so that the larger ones can touch it.
      {"zoom-million", 0.75,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         const Vec3 at = t[0];
         const double size = s.object == 0 ? 1 : s.object == 1 ? 1e-6 : 1e-12;
         for (Vec3& c : t) c = at + size * (c - at);
       }},
      {"end-on-needles", 0.5,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         if (s.object != 0) return;
         const Vec3 along = Vec3(1, 1, 1) * std::ldexp(1.0, 12 + 8 * s.kind);
         t[0] -= along;
         t[1] += along;
       }},
      {"pixel-scale", 0.5,  // sizes about a pixel of the resolutions below
       [](const Spec& s, std::array<Vec3, 3>& t) {
         const Vec3 at = t[0];
         for (Vec3& c : t) c = at + (c - at) * std::ldexp(1.0, -s.kind);
       }},
      {"identical", 0.5,
       [](const Spec& s, std::array<Vec3, 3>& t) {
         for (Vec3& c : t) c[0] = std::abs(c[0]);
         t[0] = Vec3(s.at[0] % 2, s.at[1] % 2, 0);
       }},
  };
  return all;
}

inline std::uint64_t family_seed(const Family& family, const Fattener& fattener) {
  return std::hash<std::string>()(std::string(family.name) + fattener.name) ^ 20041110;
}

inline Scene scene_of(const std::vector<Spec>& specs, const Family& family) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects(3);
  for (const Spec& s : specs) {
    std::array<Vec3, 3> t = base_triangle(s);
    family.place(s, t);
    objects[s.object].push_back(t);
  }
  return scene_of(objects);
}

inline std::filesystem::path cases_folder() {
  return std::filesystem::path(FARCULL_TEST_DIR) / "cases";
}

/// The scene as OBJ (17 digits give every double back), with the settings it failed at in its first
/// line.
inline void write_case(const std::string& name, const Scene& scene, const std::string& settings) {
  std::ofstream out(cases_folder() / (name + ".obj"));
  out << "# " << settings << "\n";
  char line[128];
  for (const Object& object : scene.objects) {
    if (object.triangle_count == 0) continue;
    out << "o " << object.name << "\n";
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count;
         ++t) {
      for (const Vec3& p : scene.corners(t)) {
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
        out << line;
      }
      out << "f -3 -2 -1\n";
    }
  }
}

inline const std::vector<std::string>& property_views() {
  static const std::vector<std::string> all = {"x,y,z", "z",         "x,-x",
                                               "1:1:1", "1:2:0.5,y", "-1:0.1:0.1"};
  return all;
}
inline const std::vector<int>& property_resolutions() {
  static const std::vector<int> all = {1, 2, 3, 8, 17, 64, 128};
  return all;
}

/// What the property saw of a family.
struct FamilyCount {
  std::uint64_t triangles = 0, colliding = 0, culled = 0;
};

/// The property for one family and offset: no colliding pair is culled. `tests` scenes of up to ~40
/// triangles.
inline FamilyCount expect_far_misses_nothing(Canvas& canvas, const Fattener& fattener,
                                             const Family& family, int tests,
                                             const std::string& canvas_name) {
  rc::detail::TestParams params;
  params.seed = family_seed(family, fattener);
  params.maxSuccess = tests;
  params.maxSize = 40;
  FamilyCount count;
  const auto result = rc::detail::checkTestable(
      [&] {
        const auto specs = *rc::gen::container<std::vector<Spec>>(spec());
        const auto views = *rc::gen::elementOf(property_views());
        const auto resolution = *rc::gen::elementOf(property_resolutions());
        const Scene scene = scene_of(specs, family);
        const Outcome out = far_on(canvas, scene, fattener, views, resolution);
        count.triangles += scene.triangles.size();
        count.colliding += all_colliding_pairs(scene, {.threads = 1}).pairs.size();
        count.culled += scene.triangles.size() - out.live;
        if (out.accounting.false_negatives > 0) {
          write_case(std::string("far-") + family.name + "-" + fattener.name + "-" + canvas_name,
                     scene, "views " + views + " resolution " + std::to_string(resolution));
        }
        RC_ASSERT(out.accounting.false_negatives == 0u);
      },
      rc::detail::TestMetadata{}, params);
  if (!result.template is<rc::detail::SuccessResult>()) {
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    ADD_FAILURE() << text.str() << "\nseed " << params.seed
                  << "; the smallest scene is in tests/cases";
  }
  return count;
}

/// Every family on a canvas for each offset: nothing is missed, and each has pairs to miss and
/// triangles that are culled.
inline void expect_far_survives_all_families(const MakeCanvas& make, int tests,
                                             const std::string& canvas_name) {
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    const std::unique_ptr<Canvas> canvas = make(fattener);
    for (const Family& family : families()) {
      SCOPED_TRACE(std::string(family.name) + ", " + fattener.name + ", " + canvas_name);
      const FamilyCount count =
          expect_far_misses_nothing(*canvas, fattener, family, tests, canvas_name);
      std::printf("%s, %-5s %-16s %5llu triangles, %4llu culled at the budget; %5llu pairs\n",
                  canvas_name.c_str(), fattener.name.c_str(), family.name,
                  static_cast<unsigned long long>(count.triangles),
                  static_cast<unsigned long long>(count.culled),
                  static_cast<unsigned long long>(count.colliding));
      EXPECT_GT(count.colliding, 0u) << "there is no pair to miss";
      EXPECT_GT(count.culled, 0u) << "a method that keeps everything would pass";
    }
  }
}

/// The twin: each family loses a pair, with each offset, at the fraction of the radius that it
/// names and without any radius.
inline void expect_every_family_loses_pairs(const MakeCanvas& make,
                                            const std::string& canvas_name) {
  constexpr int kScenes = 60;
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    const std::unique_ptr<Canvas> canvas = make(fattener);
    for (const Family& family : families()) {
      for (const double factor : {family.loses_at, 0.0}) {
        rc::Random random(family_seed(family, fattener));
        std::uint64_t lost = 0;
        int scenes = 0;
        for (; scenes < kScenes && lost == 0; ++scenes) {
          const auto draw = [&random](const auto& gen) { return gen(random.split(), 40).value(); };
          const auto specs = draw(rc::gen::container<std::vector<Spec>>(spec()));
          const auto views = draw(rc::gen::elementOf(property_views()));
          const auto resolution = draw(rc::gen::elementOf(property_resolutions()));
          lost = far_on(*canvas, scene_of(specs, family), fattener, views, resolution, factor)
                     .accounting.false_negatives;
        }
        std::printf("%s, %-5s %-16s at %4g of the radius: %llu pairs lost in scene %d\n",
                    canvas_name.c_str(), fattener.name.c_str(), family.name, factor,
                    static_cast<unsigned long long>(lost), scenes);
        EXPECT_GT(lost, 0u) << family.name << ", " << fattener.name << ", " << canvas_name << " at "
                            << factor;
      }
    }
  }
}

/// Replays every scene of tests/cases at the settings of its first line and at others, with both
/// offsets.
inline int replay_cases(const MakeCanvas& make) {
  int replayed = 0;
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    const std::unique_ptr<Canvas> canvas = make(fattener);
    for (const auto& entry : std::filesystem::directory_iterator(cases_folder())) {
      if (entry.path().extension() != ".obj") continue;
      SCOPED_TRACE(entry.path().filename().string() + ", " + fattener.name);
      const std::string text = "{\"objects\": [{\"mesh\": \"" + entry.path().filename().string() +
                               "\", \"split\": \"groups\"}]}";
      const Scene scene = parse_scene_file(text, (cases_folder() / "case.json").string());
      std::ifstream file(entry.path());
      std::string word, views = "x,y,z";
      int resolution = 64;
      file >> word;
      while (file >> word && word != "o" && word != "v") {
        if (word == "views") file >> views;
        if (word == "resolution") file >> resolution;
      }
      EXPECT_EQ(far_on(*canvas, scene, fattener, views, resolution).accounting.false_negatives, 0u);
      for (const int other : {1, 7, 64}) {
        EXPECT_EQ(far_on(*canvas, scene, fattener, "x,y,z,1:1:1", other).accounting.false_negatives,
                  0u)
            << other;
      }
      ++replayed;
    }
  }
  return replayed;
}

}  // namespace farcull::lab
