// Random worlds and schedules for the model and core/cull (model_lab.h).
#pragma once

#include "tests/core/cull/model_lab.h"

namespace farcull::model {

/// How each triangle takes part in a random case: by its object; by itself in some objects; by
/// patches of some objects.
enum class Owners { objects, selves, patches };

inline Set random_set(lab::Random& random, int n, double share) {
  Set out = 0;
  for (int t = 0; t < n; ++t) {
    if (random.unit() < share) out |= only(t);
  }
  return out;
}

inline View random_view(lab::Random& random, const World& world, int n) {
  static constexpr double kShares[] = {0.03, 0.1, 0.2, 0.4, 0.8};
  View view;
  view.drawn = random.below(12) > 0;
  const double odd = random.below(2) * 0.15;
  view.undrawable = random_set(random, n, odd);
  view.shown = ~random_set(random, n, odd) & ~view.undrawable & (only(n) - 1);
  const double share = kShares[random.below(5)];
  for (const Set owner : world.owners) {
    for (int t = 0; t < n; ++t) {
      view.elements[t] = 1 + random.below(3);
      if ((owner & view.shown & only(t)) != 0)
        view.behind[t] = random_set(random, n, share) & view.shown & ~owner;
    }
  }
  return view;
}

/// A triangle for each place: a point of the diagonal.
inline void add_points(const std::vector<int>& places, Scene& scene) {
  for (const int place : places) {
    const auto v = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.push_back(Vec3::Constant(place));
    scene.triangles.push_back({v, v, v});
    scene.source_face.push_back(v);
  }
}

/// Objects of points at different places of a diagonal, in any order.
inline void add_scene(lab::Random& random, int n, bool marks, Case& c) {
  std::vector<int> place(n);
  std::iota(place.begin(), place.end(), 1);
  for (int i = n - 1; i > 0; --i) std::swap(place[i], place[random.below(i + 1)]);
  const int objects = 1 + random.below(5);
  std::vector<int> first(objects + 1, n);
  first[0] = 0;
  for (int o = 1; o < objects; ++o) first[o] = random.below(n + 1);
  std::sort(first.begin(), first.end());
  for (int o = 0; o < objects; ++o) {
    c.scene.objects.push_back({"o", static_cast<std::uint32_t>(first[o]),
                               static_cast<std::uint32_t>(first[o + 1] - first[o]),
                               marks && random.below(2) == 0});
  }
  add_points(place, c.scene);
}

/// The owners of the world, and of the patches.
inline void add_owners(lab::Random& random, Owners kind, Case& c) {
  for (const Object& object : c.scene.objects) {
    const bool marked = object.self && kind != Owners::objects;
    const std::size_t first = c.world.owners.size();
    const int parts = !marked                   ? 1
                      : kind == Owners::patches ? 1 + random.below(4)
                                                : static_cast<int>(object.triangle_count);
    c.world.owners.resize(first + static_cast<std::size_t>(parts));
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
      const std::uint32_t t = object.first_triangle + i;
      const std::size_t part = !marked ? 0
                               : kind == Owners::patches
                                   ? static_cast<std::size_t>(random.below(parts))
                                   : i;
      c.world.owners[first + part] |= only(static_cast<int>(t));
      if (kind == Owners::patches) c.patches.push_back(static_cast<std::uint32_t>(first + part));
    }
  }
}

/// Each owner's live triangles in the order of their places, cut into clusters of `size`.
inline Level clusters(const Case& c, std::uint32_t size) {
  Level out;
  for (const Set owner : c.world.owners) {
    std::vector<int> members;
    for (Set rest = owner & c.world.region & ~c.start.culled(); rest != 0; rest &= rest - 1)
      members.push_back(first_of(rest));
    std::sort(members.begin(), members.end(),
              [&](int a, int b) { return c.scene.vertices[a][0] < c.scene.vertices[b][0]; });
    out.emplace_back();
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (i % size == 0) out.back().push_back(0);
      out.back().back() |= only(members[i]);
    }
  }
  return out;
}

inline void add_levels(lab::Random& random, Owners kind, Case& c) {
  Schedule& s = c.schedule;
  const bool marked = std::any_of(c.scene.objects.begin(), c.scene.objects.end(),
                                  [](const Object& object) { return object.self; });
  const bool alone = kind == Owners::selves && marked;  // some triangle is its own owner
  int taking_part = 0;
  for (const Set owner : c.world.owners) taking_part += (owner & c.world.region) != 0;
  c.least_objects = random.below(3) == 0 ? random.below(5) : 0;
  s.alone = c.patches.empty() && !alone && random.below(8) == 0;
  if (c.patches.empty() && !alone && (s.alone || taking_part >= c.least_objects)) {
    s.coarse.push_back(wholes(c.world.owners));
    c.levels.emplace_back("objects");
  }
  const int sizes = random.below(3);
  for (int i = 0; i < sizes; ++i) {
    c.clusters.push_back(static_cast<std::uint32_t>(2 + random.below(3)));
    if (alone || s.alone) continue;
    s.coarse.push_back(clusters(c, c.clusters.back()));
    c.levels.push_back("clusters of " + std::to_string(c.clusters.back()));
  }
  s.triangles = singles(c.world.owners);
  c.levels.emplace_back("triangles");
}

/// A case of at most `most` triangles.
inline Case random_case(std::uint64_t seed, int most) {
  lab::Random random(seed);
  Case c;
  const int n = 1 + random.below(most);
  const Owners kind{random.below(3)};
  add_scene(random, n, kind != Owners::objects, c);
  add_owners(random, kind, c);
  c.self = kind == Owners::selves;
  c.world.region = only(random.below(n)) | random_set(random, n, random.below(4) == 0 ? 0.7 : 1);
  c.places = random.below(40) > 0;
  c.touching = random.below(2) == 0;
  if (random.below(4) == 0) c.start = {random_set(random, n, 0.3), random_set(random, n, 0.3)};
  const int views = random.below(40) == 0 ? 0 : 1 + random.below(4);
  for (int v = 0; v < views; ++v) {
    c.world.views.push_back(random_view(random, c.world, n));
    c.world.views.back().drawn &= c.places;
  }
  Schedule& s = c.schedule;
  s.quick = random.below(3) > 0;
  s.rounds = random.below(4);
  s.all_views = random.below(5) == 0;
  s.full = random.below(4) == 0;
  s.enough = random.below(3) == 0 ? random.below(6) : 0;
  s.worth = random.below(3) == 0 ? random.below(6) : 0;
  add_levels(random, kind, c);
  return c;
}

/// A world of the model, with each of its owners as an object. schedule.coarse: empty, or the
/// owners as wholes.
inline Case case_of(const World& world, const Schedule& schedule, const Bits& start) {
  Case c;
  c.world = world;
  c.schedule = schedule;
  c.start = start;
  for (const Set owner : world.owners) {
    c.scene.objects.push_back({"o", static_cast<std::uint32_t>(first_of(owner)),
                               static_cast<std::uint32_t>(std::popcount(owner))});
  }
  const Object& last = c.scene.objects.back();
  std::vector<int> place(last.first_triangle + last.triangle_count);
  std::iota(place.begin(), place.end(), 1);
  add_points(place, c.scene);
  if (schedule.coarse.empty())
    c.least_objects = kMost;
  else
    c.levels.emplace_back("objects");
  c.levels.emplace_back("triangles");
  return c;
}

}  // namespace farcull::model
