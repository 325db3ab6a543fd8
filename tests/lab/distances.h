// The truth about distances, by comparing all triangles with all in rational numbers, by the
// formulas of near_lab.h, which share no code with farcull.
#pragma once

#include "experiments/method/distances.h"
#include "tests/lab/closest.h"
#include "tests/lab/grid_distance.h"

namespace farcull::distance_lab {

using rational::Q;
using Z = mpz_class;
using Corners = near_lab::Corners<Z>;

using near_lab::exact, near_lab::scale_of;
inline Q squared_distance(const auto& a, const auto& b) {
  return near_lab::squared_distance_of(a, b);
}

struct Answer {
  ObjectPair objects;
  TrianglePair pair;
  Q squared;
  bool operator==(const Answer&) const = default;
};

class Truth {
 public:
  explicit Truth(const Scene& scene) : scene_(scene), scale_(scale_of(scene.vertices)) {
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
      corners_.push_back(exact(scene.corners(t), scale_));
  }

  /// All pairs of a and b that are no neighbours and for which keep(box gap) holds.
  template <class Keep, class Visit>
  void each(std::uint32_t a, std::uint32_t b, const Keep& keep, const Visit& visit) const {
    const Object &x = scene_.objects[a], &y = scene_.objects[b];
    for (std::uint32_t i = x.first_triangle; i < x.first_triangle + x.triangle_count; ++i) {
      const std::uint32_t first = a == b ? i + 1 : y.first_triangle;
      for (std::uint32_t j = first; j < y.first_triangle + y.triangle_count; ++j) {
        const Corners &s = corners_[i], &t = corners_[j];
        if (!keep(near_lab::square_of_gap(s, t))) continue;
        if (a == b && near_lab::share_position(s, t)) continue;
        visit(TrianglePair{i, j}, s, t);
      }
    }
  }

  /// The first of the nearest pairs; the square times that of the scale.
  std::optional<Answer> nearest(std::uint32_t a, std::uint32_t b) const {
    std::optional<Answer> out;
    // First what has the nearest boxes, which lets the boxes of most others be too far apart.
    std::optional<Z> least_gap;
    TrianglePair start;
    each(
        a, b, [&](const Z& gap) { return !least_gap || gap < *least_gap; },
        [&](const TrianglePair& pair, const Corners& s, const Corners& t) {
          least_gap = near_lab::square_of_gap(s, t);
          start = pair;
        });
    if (!least_gap) return out;
    Q most = squared_distance(corners_[start.a], corners_[start.b]);
    each(
        a, b, [&](const Z& gap) { return gap <= most; },
        [&](const TrianglePair& pair, const Corners& s, const Corners& t) {
          const Q squared = squared_distance(s, t);
          if (squared > most || (out && squared == most)) return;
          most = squared;
          out = Answer{{a, b}, pair, squared};
        });
    return out;
  }

  std::vector<Answer> answers(const DistanceOptions& options) const {
    const bool finite = std::isfinite(options.within);
    const Q within = finite ? Q(Q(options.within) * scale_) : Q(0), most = within * within;
    std::vector<Answer> out;
    const auto count = static_cast<std::uint32_t>(scene_.objects.size());
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = a; b < count; ++b) {
        if (a == b && (!scene_.objects[a].self || options.pairs == DistancePairs::nearest))
          continue;
        if (options.pairs != DistancePairs::all) {
          const auto found = nearest(a, b);
          if (found && (!finite || found->squared <= most)) out.push_back(*found);
          continue;
        }
        each(
            a, b, [&](const Z& gap) { return gap <= most; },
            [&](const TrianglePair& pair, const Corners& s, const Corners& t) {
              const Q squared = squared_distance(s, t);
              if (squared <= most) out.push_back({{a, b}, pair, squared});
            });
      }
    }
    if (options.pairs == DistancePairs::nearest) keep_nearest(options.k, out);
    for (Answer& answer : out) answer.squared /= scale_ * scale_;
    return out;
  }

 private:
  static void keep_nearest(std::size_t k, std::vector<Answer>& answers) {
    // Kept: fewer than k others come before it, for one of its objects.
    const auto before = [&](const Answer& x, std::uint32_t object) {
      const auto key = [&](const Answer& y) {
        return std::tuple(y.squared, y.objects.a == object ? y.objects.b : y.objects.a);
      };
      return static_cast<std::size_t>(std::ranges::count_if(answers, [&](const Answer& y) {
        return (y.objects.a == object || y.objects.b == object) && key(y) < key(x);
      }));
    };
    std::vector<Answer> out;
    for (const Answer& x : answers)
      if (before(x, x.objects.a) < k || before(x, x.objects.b) < k) out.push_back(x);
    answers = out;
  }

  const Scene& scene_;
  Z scale_;  // of all coordinates: they are integers
  std::vector<Corners> corners_;
};

/// The distances of a record, each with the double that is proved to be its rounded root.
inline std::vector<Answer> answers_of(const DistanceRecord& record) {
  std::vector<Answer> out;
  for (const Distance& d : record.distances) {
    Q squared(d.closest.squared.text());
    if (!closest_reference::is_rounded_root(d.closest.distance, squared)) squared = -1;
    out.push_back({d.objects, d.triangles, squared});
  }
  return out;
}

/// Objects of triangles on a grid, some of them tested against themselves.
inline Scene random_scene(rational::Draws& random, int objects, int most) {
  near_lab::GridScene grid;
  for (int o = 0; o < objects; ++o) {
    near_lab::Triple<near_lab::Integer> middle;
    for (auto& x : middle) x = random.below(41) - 20;
    const int count = random.below(8) == 0 ? 0 : 1 + random.below(most);
    near_lab::add_object(grid, near_lab::random_triangles(random, count, 8, middle));
    grid.scene.objects.back().name = "o" + std::to_string(o);
    grid.scene.objects.back().self = random.below(3) == 0;
  }
  const auto [unit, offset] = near_lab::random_unit_and_offset(random);
  near_lab::finish(grid, unit, offset, [&] { return random.coin(); });
  return grid.scene;
}

/// Moves the vertices of these objects of the scene, each once.
inline void move_objects(Scene& scene, std::span<const Object> objects, const Vec3& by) {
  std::vector<bool> moved(scene.vertices.size());
  for (const Object& object : objects) {
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      for (const std::uint32_t v : scene.triangles[object.first_triangle + t]) {
        if (!moved[v]) scene.vertices[v] += by;
        moved[v] = true;
      }
    }
  }
}

/// The second half of the objects moved away by so many diagonals of the scene.
inline Scene moved_apart(Scene scene, double diagonals) {
  Box box = Box::empty();
  for (const Vec3& p : scene.vertices) box.add(p);
  const Vec3 by = Vec3(1, 0.7, 0.3).normalized() * ((box.hi - box.lo).norm() * diagonals);
  move_objects(scene, std::span(scene.objects).subspan(scene.objects.size() / 2), by);
  return scene;
}

}  // namespace farcull::distance_lab
