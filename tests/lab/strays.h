// Random scenes in which a few triangles are far away or huge, or sizes spread over many decades,
// and the work that boxes take for them.
#pragma once

#include "core/boxes/search.h"
#include "tests/lab/scenes.h"

namespace farcull::lab {

/// How a scene of strays is made.
struct Strays {
  int outliers = 0;      // 0 to 10: triangles, or corners of triangles
  double decades = 0;    // 0 to 300: of the sizes of the others
  bool spread = false;   // their places spread as their sizes do
  bool surface = false;  // instead of triangles anywhere in a cube: two sheets, in any order
  bool self = false;     // one object with itself, instead of two
  double exponent = -1;  // of the size of outliers, to base 10; negative: each one of 0 to 300
};

inline Strays random_strays(std::uint64_t seed) {
  Random random(seed);
  Strays out;
  out.outliers = random.below(11);
  out.surface = random.below(3) == 0;
  const double most[] = {0, 0, 8, 30, 300};
  out.decades = out.surface ? 0 : random.between(0, most[random.below(5)]);
  out.spread = random.below(2) == 0;
  out.self = random.below(2) == 0;
  return out;
}

inline Scene stray_scene(std::uint64_t seed, int triangles, const Strays& strays) {
  Random random(seed);
  const auto direction = [&] {
    return Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  };
  std::vector<std::vector<std::array<Vec3, 3>>> objects(strays.self ? 1 : 2);
  const int side = std::max(1, static_cast<int>(std::sqrt(0.5 * triangles)));
  for (std::size_t o = 0; o < objects.size(); ++o) {
    auto& object = objects[o];
    for (int t = 0; t < triangles; ++t) {
      if (strays.surface) {
        const double x = (t / 2) % side, y = (t / 2) / side;
        const auto at = [&](double i, double j) {
          return Vec3(i, j, 3 * std::sin(0.21 * i + static_cast<double>(o)) * std::cos(0.17 * j));
        };
        object.push_back(t % 2 ? std::array<Vec3, 3>{at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)}
                               : std::array<Vec3, 3>{at(x, y), at(x + 1, y), at(x, y + 1)});
        continue;
      }
      // The largest is a tenth of the cube, so that most boxes meet few others.
      const double size = std::pow(10, random.between(-strays.decades, 0) - 1);
      const double scale = strays.spread ? 10 * size * std::pow(10, 0.5 * strays.decades) : 1;
      const double part = strays.spread ? 0.05 * scale : size;
      const Vec3 place = scale * direction();
      object.push_back(
          {place + part * direction(), place + part * direction(), place + part * direction()});
    }
    if (strays.surface) {
      for (std::size_t k = object.size(); k > 1; --k)
        std::swap(object[k - 1],
                  object[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
    }
  }
  for (int k = 0; k < strays.outliers; ++k) {
    auto& object =
        objects[static_cast<std::size_t>(random.below(static_cast<int>(objects.size())))];
    auto& one = object[static_cast<std::size_t>(random.below(static_cast<int>(object.size())))];
    const double far =
        std::pow(10, strays.exponent >= 0 ? strays.exponent : random.between(0, 300));
    switch (random.below(3)) {
      case 0:  // huge
        for (Vec3& corner : one) corner = far * direction();
        break;
      case 1:  // a bad corner
        one[0] = far * direction();
        break;
      default: {  // as large as before, far away
        const Vec3 by = far * direction();
        for (Vec3& corner : one) corner += by;
      }
    }
  }
  Scene scene = scene_of(objects);
  scene.objects[0].self = strays.self;
  return scene;
}

/// What a run of boxes compared and listed.
struct BoxesWork {
  double tests = 0;  // boxes compared
  double lists = 0;  // pairs in its longest list
};

inline BoxesWork work_of(const BoxesResult& result) {
  const Stage& stage = result.stage;
  const auto n = static_cast<double>(stage.n), m = static_cast<double>(stage.m);
  const bool blocks = stage.kind == StageKind::blocks;
  return {.tests = blocks ? 256 * n : 16 * m,
          .lists = std::max(blocks ? n : 0, static_cast<double>(result.candidates.size()))};
}

/// What it may take. `exact` looks at each triangle and at each pair of boxes that overlap. A
/// triangle costs it about as much time as 1,024 comparisons of boxes cost blocks, a pair as much
/// as 64: three times that, and a constant for small scenes.
inline BoxesWork most_work(std::size_t triangles, std::size_t box_pairs) {
  const auto n = static_cast<double>(triangles), k = static_cast<double>(box_pairs);
  return {.tests = 3 * (1024 * n + 64 * k) + 0x1p20, .lists = 3 * (24 * n + k) + 1e4};
}

}  // namespace farcull::lab
