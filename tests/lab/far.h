// Scenes that aim at trouble, in families. Each has triangles of its family's kind and, at exact
// corners of the pixels of the window that the run uses, contacts in one point at angles about 45
// degrees: a radius that is two hundredths too small loses them.
#pragma once

#include <rapidcheck.h>
#include "core/boxes/join.h"
#include "core/cull/cull.h"
#include "experiments/scenes/scene_file.h"
#include "offsets/offsets.h"
#include "tests/lab/scenes.h"
#include "verify/accounting.h"

namespace farcull::lab {

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

/// Of two triangles that touch in the corner of a pixel: where the two other corners of each are,
/// from there, in pixel space.
using Legs = std::array<std::array<Vec3, 2>, 2>;

inline void scale_by(std::array<Vec3, 2>& legs, double factor) {
  for (Vec3& leg : legs) leg *= factor;
}

/// What a family does to the base triangle of a spec, and to the legs of a contact (null: nothing).
/// Every family can lose a pair at 0.98 of the radius. Whatever the coordinates are, a pixel of the
/// window is at least 2^-45 of them (core/view/view.cpp), so a corner of a pixel has a double
/// within 2^-9 px along each axis of the image.
struct Family {
  const char* name;
  void (*place)(const Spec&, std::array<Vec3, 3>&);
  void (*bend)(const Spec&, Legs&) = nullptr;
};

inline const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"grid", [](const Spec&, std::array<Vec3, 3>&) {}},
      {"one-ulp", [](const Spec& s, std::array<Vec3, 3>& t) { ulps(t, s); }},
      {"needles",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         t[2] = s.kind % 2 ? t[1] : Vec3(0.5 * (t[0] + t[1]));
         t[2][s.kind % 3] += std::ldexp(s.nudge[0], -10 * (1 + s.kind % 4));
       },
       [](const Spec& s, Legs& legs) {
         legs[0][1] = -legs[0][0];
         legs[1][1] = 0.5 * legs[1][0];
         legs[1][1][0] += std::ldexp(s.nudge[0], -10 * (1 + s.kind % 4));
       }},
      {"slivers-12",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         t[2] = t[0] + 0.25 * (t[1] - t[0]);
         t[2][s.kind % 3] += s.nudge[0] * 1e-12;
       },
       [](const Spec& s, Legs& legs) {
         for (auto& of : legs) of[1] = 0.25 * of[0] + Vec3(s.nudge[0] * 1e-12, 0, 0);
       }},
      {"coplanar",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         for (Vec3& c : t) c[s.at[0] & 1 ? 2 : 1] = 0.25 * (s.kind % 2);
       }},
      {"one-plane",
       [](const Spec&, std::array<Vec3, 3>& t) {
         for (Vec3& c : t) c[2] = c[0] + c[1];
       },
       [](const Spec&, Legs& legs) {
         for (auto& of : legs)
           for (Vec3& leg : of) leg[2] = leg[0] + leg[1];
       }},
      {"tiny-1e-30", [](const Spec&, std::array<Vec3, 3>& t) { scale_by(t, 1e-30); }},
      {"huge-1e30",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         ulps(t, s);
         scale_by(t, 1e30);
       }},
      // Extents below 2^-960 are one pixel (view.cpp), and nothing in it is culled. So the
      // triangles are larger, and contacts at zero are decided by denormals.
      {"denormals",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         scale_by(t, 0x1p-950);
         nudge_by(t, s, 0x1p-1074);
       }},
      {"largest", [](const Spec&, std::array<Vec3, 3>& t) { scale_by(t, 0x1p1022); }},
      {"mixed-magnitudes",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         for (int i = 0; i < 3; ++i) t[i] *= std::ldexp(1.0, 30 * s.nudge[i]);
       },
       [](const Spec& s, Legs& legs) {
         for (int i = 0; i < 4; ++i)
           legs[i / 2][i % 2] *= std::ldexp(1.0, 30 * std::min(0, s.nudge[i]));
       }},
      {"far-1e9",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         for (Vec3& c : t) c += Vec3(2e9, -1e9, 3e9);
         ulps(t, s);
       }},
      // A pixel is at least 2^-45 of the coordinates, 57 here: the scene has to be larger than
      // that.
      {"far-1e15",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         scale_by(t, 4096);
         for (Vec3& c : t) c += Vec3(1e15, 2e15, -1e15);
         ulps(t, s);
       }},
      {"huge-beside-tiny",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         if (s.object == 0) scale_by(t, std::ldexp(1.0, 5 * s.kind));
       },
       [](const Spec& s, Legs& legs) {
         scale_by(legs[1], std::ldexp(1.0, -5 * s.kind));
       }},
      // Each is scaled about a corner of its own, so that the larger ones can touch it.
      {"zoom-million",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         const Vec3 at = t[0];
         const double size = s.object == 0 ? 1 : s.object == 1 ? 1e-6 : 1e-12;
         for (Vec3& c : t) c = at + size * (c - at);
       },
       [](const Spec& s, Legs& legs) {
         scale_by(legs[1], s.kind % 2 ? 1e-6 : 1e-12);
       }},
      {"end-on-needles",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         if (s.object != 0) return;
         const Vec3 along = Vec3(1, 1, 1) * std::ldexp(1.0, 12 + 8 * s.kind);
         t[0] -= along;
         t[1] += along;
       },
       [](const Spec& s, Legs& legs) {
         for (auto& of : legs) of[1] = Vec3(0, 0, std::ldexp(1.0, s.kind - 2));
       }},
      {"pixel-scale",  // sizes about a pixel of the resolutions below
       [](const Spec& s, std::array<Vec3, 3>& t) {
         const Vec3 at = t[0];
         for (Vec3& c : t) c = at + (c - at) * std::ldexp(1.0, -s.kind);
       },
       [](const Spec& s, Legs& legs) {
         for (auto& of : legs)
           for (Vec3& leg : of) leg *= std::ldexp(1.0, -s.kind) / leg.norm();
       }},
      {"identical",
       [](const Spec& s, std::array<Vec3, 3>& t) {
         for (Vec3& c : t) c[0] = std::abs(c[0]);
         t[0] = Vec3(s.at[0] % 2, s.at[1] % 2, 0);
       },
       [](const Spec&, Legs& legs) {
         scale_by(legs[0], 0x1p-9 / legs[0][0].norm());
         legs[1] = legs[0];
       }},
  };
  return all;
}

/// What `at` says of a contact: where in the box of the scene (0, 1 in the image, 2 the depth), the
/// angles of its legs, 45 +- 1 degrees to the axes (3 .. 6), and their length, 2^-10.5 to 2^1.5 px.
inline Legs legs_of(const Spec& s) {
  const double length = std::exp2(-4.5 + 0.75 * s.at[7]);
  Legs legs;
  for (int i = 0; i < 4; ++i) {
    const double degrees = 45 + (i < 2 ? 0 : 90) + (i % 2) * 180 + s.at[3 + i] * 0.125;
    const double angle = degrees * std::numbers::pi / 180;
    legs[i / 2][i % 2] = length * Vec3(std::cos(angle), std::sin(angle), 0);
  }
  return legs;
}

using TwoTriangles = std::array<std::array<Vec3, 3>, 2>;

/// Two bent segments that cross in the corner of a pixel of the window, which they share bit for
/// bit. None where they would leave the box or doubles cannot place them within 2^-8 px.
inline std::optional<TwoTriangles> contact(const Spec& s, const Family& family,
                                           const Window& window, const Box& box) {
  const Box image = pixel_box(window, box);
  const Eigen::Matrix3d back = window.pixel_size * window.view.rows.transpose();
  const auto part = [&s](int i) { return (s.at[i] + 8) / 16.0; };
  Vec3 corner(0, 0, 0);
  for (int k = 0; k < 2; ++k)
    corner[k] = std::round(image.lo[k] + part(k) * (image.hi[k] - image.lo[k]));
  // The part of its line of sight in the box.
  const Vec3 base = window.origin + back * corner, along = back.col(2);
  double from = -HUGE_VAL, to = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    if (along[k] == 0) continue;
    const double a = (box.lo[k] - base[k]) / along[k], b = (box.hi[k] - base[k]) / along[k];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (!(from <= to)) return {};
  corner[2] = from + part(2) * part(2) * (to - from);  // mostly in front, where little hides it

  Legs legs = legs_of(s);
  if (family.bend != nullptr) family.bend(s, legs);
  bool placed = true;
  const auto world = [&](const Vec3& p) {
    const Vec3 x = (window.origin + back * p).cwiseMax(box.lo).cwiseMin(box.hi);
    placed = placed && ((to_pixel(window, x).p - p).head<2>().array().abs() <= 0x1p-8).all();
    return x;
  };
  TwoTriangles out;
  for (int k = 0; k < 2; ++k) {
    out[k] = {world(corner + legs[k][0]), world(corner), world(corner + legs[k][1])};
    const Vec3 shared = out[k][1];
    ulps(out[k], s);
    out[k][1] = shared;
    for (Vec3& x : out[k]) x = x.cwiseMax(box.lo).cwiseMin(box.hi);
  }
  if (!placed) return {};
  return out;
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

struct Given {
  std::vector<Spec> specs, contacts;
  std::string views;
  int resolution;
};

/// `most_px`: of the resolution, for a canvas on which a pixel takes long.
inline rc::Gen<Given> given(int most_px = 128) {
  const auto specs = rc::gen::container<std::vector<Spec>>(spec());
  return rc::gen::map(
      rc::gen::tuple(specs, rc::gen::scale(0.25, specs), rc::gen::elementOf(property_views()),
                     rc::gen::elementOf(property_resolutions())),
      [most_px](const std::tuple<std::vector<Spec>, std::vector<Spec>, std::string, int>& t) {
        return Given{std::get<0>(t), std::get<1>(t), std::get<2>(t),
                     std::min(most_px, std::get<3>(t))};
      });
}

/// Three objects. Where there are contacts, points at the corners of the box of the scene give all
/// objects that box, so that the window is known before the contacts are placed in it.
inline Scene scene_of(const Given& given, const Family& family) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects(3);
  Box box = Box::empty();
  for (const Spec& s : given.specs) {
    std::array<Vec3, 3> t = base_triangle(s);
    family.place(s, t);
    for (const Vec3& x : t) box.add(x);
    objects[s.object].push_back(t);
  }
  if (given.contacts.empty() || given.specs.empty()) return scene_of(objects);
  for (auto& object : objects)
    for (const Vec3& x : {box.lo, box.hi}) object.push_back({x, x, x});
  const std::vector<View> views = parse_views(given.views);
  for (std::size_t i = 0; i < given.contacts.size(); ++i) {
    const Spec& s = given.contacts[i];
    const auto window = fit_window(views[i % views.size()], {&box, 1}, given.resolution);
    if (!window) continue;
    const auto two = contact(s, family, *window, box);
    if (!two) continue;
    objects[s.object == 2 ? 1 : 0].push_back((*two)[0]);
    objects[s.object == 0 ? 1 : 2].push_back((*two)[1]);
  }
  return scene_of(objects);
}

// FAR on scenes that aim at trouble, as a rapidcheck property of any canvas. A counter-example
// shrinks to few triangles and is written to a file; in tests/cases the suite replays it ever
// after.

inline CullResult far_culled(Canvas& canvas, const Scene& scene, const Fattener& fattener,
                             const std::string& views, int resolution, double factor = 1) {
  const CullSettings settings{.views = parse_views(views),
                              .resolution = resolution,
                              .fattener = fattener,
                              .radius = {.published = false, .factor = factor},
                              .quick = true};
  return cull(scene, find_regions(scene), settings, canvas);
}

struct Outcome {
  Accounting accounting;
  std::vector<std::uint32_t> live;
};

/// The same, and the accounting of what it leaves.
inline Outcome far_on(Canvas& canvas, const Scene& scene, const Fattener& fattener,
                      const std::string& views, int resolution, double factor = 1) {
  const CullResult result = far_culled(canvas, scene, fattener, views, resolution, factor);
  return {account(scene, box_join(triangle_boxes(scene), owners(scene), result.live)), result.live};
}

inline std::uint64_t family_seed(const Family& family, const Fattener& fattener) {
  return std::hash<std::string>()(std::string(family.name) + fattener.name) ^ 20041110;
}

inline std::filesystem::path cases_folder() {
  return std::filesystem::path(FARCULL_TEST_DIR) / "cases";
}

/// Fractions of the budget's radius at which a run is repeated.
constexpr std::array<double, 3> kSmaller = {0.98, 0.9, 0};

/// Per fraction: the pairs at risk, which collide and are lost with that radius in the same scene,
/// view and resolution. A test without pairs at risk could not see that its radius is too small.
using AtRisk = std::array<std::uint64_t, kSmaller.size()>;

/// Of the pairs that collide, those of which a triangle is culled.
inline std::uint64_t lost_pairs(const std::vector<TrianglePair>& colliding,
                                const std::vector<std::uint32_t>& live) {
  const auto culled = [&live](std::uint32_t t) { return !std::ranges::binary_search(live, t); };
  return static_cast<std::uint64_t>(std::ranges::count_if(
      colliding, [&](const TrianglePair& p) { return culled(p.a) || culled(p.b); }));
}

inline std::string text_of(const AtRisk& at_risk) {
  std::string out;
  for (std::size_t i = 0; i < kSmaller.size(); ++i) {
    char text[64];
    std::snprintf(text, sizeof text, "%s%llu at %g", i == 0 ? "" : ", ",
                  static_cast<unsigned long long>(at_risk[i]), kSmaller[i]);
    out += text;
  }
  return out;
}

/// On which canvas, with how many scenes of each family and offset.
struct FarTrials {
  std::string canvas;  // for prints and files
  int scenes = 0;      // at least; as many again until some pair was at risk at each fraction
  int most_px = 128;   // as given()
};

/// The property for one family and offset: no colliding pair is culled. Scenes of up to ~60
/// triangles; they are drawn with each smaller radius too, until it loses a pair.
inline void expect_far_misses_nothing(Canvas& canvas, const Fattener& fattener,
                                      const Family& family, const FarTrials& trials) {
  std::string smallest;
  std::uint64_t triangles = 0, culled = 0;
  AtRisk at_risk = {}, seen_at = {};  // the pairs; how many scenes it took to see one
  int scenes = 0;
  const auto check = [&] {
    const Given given = *lab::given(trials.most_px);
    const Scene scene = scene_of(given, family);
    const Outcome out = far_on(canvas, scene, fattener, given.views, given.resolution);
    if (out.accounting.false_negatives > 0)
      smallest = write_case(
          std::string("far-") + family.name + "-" + fattener.name + "-" + trials.canvas, scene,
          "views " + given.views + " resolution " + std::to_string(given.resolution));
    RC_ASSERT(out.accounting.false_negatives == 0u);
    ++scenes;
    triangles += scene.triangles.size();
    culled += scene.triangles.size() - out.live.size();
    if (std::ranges::min(at_risk) > 0) return;
    const auto colliding = all_colliding_pairs(scene, {.threads = 1}).pairs;
    for (std::size_t i = 0; i < kSmaller.size() && !colliding.empty(); ++i) {
      if (at_risk[i] > 0) continue;
      at_risk[i] = lost_pairs(
          colliding,
          far_culled(canvas, scene, fattener, given.views, given.resolution, kSmaller[i]).live);
      seen_at[i] = static_cast<std::uint64_t>(scenes);
    }
  };
  for (std::uint64_t n = 0; more_cases(n, 1, std::ranges::min(at_risk) > 0, 200); ++n) {
    rc::detail::TestParams params;
    params.seed = test_seed(family_seed(family, fattener)) + n;
    params.maxSuccess = trials.scenes;
    params.maxSize = 40;
    const auto result = rc::detail::checkTestable(check, rc::detail::TestMetadata{}, params);
    if (result.template is<rc::detail::SuccessResult>()) continue;
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    FAIL() << text.str() << "\nthe smallest scene is " << smallest << " (move it to tests/cases)";
  }
  std::printf("%s, %-5s %-16s %4d scenes, %5llu triangles, %4llu culled; at risk since scene %s\n",
              trials.canvas.c_str(), fattener.name.c_str(), family.name, scenes,
              static_cast<unsigned long long>(triangles), static_cast<unsigned long long>(culled),
              text_of(seen_at).c_str());
}

/// Every family on a canvas for each offset: nothing is missed, and each has pairs at risk.
inline void expect_far_survives_all_families(const MakeCanvas& make, const FarTrials& trials) {
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    const std::unique_ptr<Canvas> canvas = make(fattener);
    for (const Family& family : families()) {
      SCOPED_TRACE(std::string(family.name) + ", " + fattener.name + ", " + trials.canvas);
      expect_far_misses_nothing(*canvas, fattener, family, trials);
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
