// A *part* of an object is what triangles that share positions of vertices hold together. It is
// connected, so where it does not meet a closed mesh, either all of its points lie inside or none:
// a path from one to another crosses the mesh nowhere, and parity changes only where it does. One
// vertex of each part decides. What lies inside a closed mesh lies in its box, so boxes settle most
// pairs.
#include "experiments/method/which_inside.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "verify/inside.h"

namespace farcull {
namespace {

Box box_of(const Scene& scene, const Object& object) {
  Box box = Box::empty();
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    for (const Vec3& p : scene.corners(object.first_triangle + k)) box.add(p);
  }
  return box;
}

bool within(const Box& inner, const Box& outer) {
  return (inner.lo.array() >= outer.lo.array()).all() &&
         (inner.hi.array() <= outer.hi.array()).all();
}

// Of each part of the object the first corner of its first triangle.
std::vector<Vec3> point_of_each_part(const Scene& scene, const Object& object) {
  struct Corner {
    std::array<double, 3> place;
    std::uint32_t triangle;
  };
  std::vector<Corner> corners;
  corners.reserve(3 * std::size_t{object.triangle_count});
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    for (const Vec3& p : scene.corners(object.first_triangle + t))
      corners.push_back({{p.x(), p.y(), p.z()}, t});  // -0.0 compares as 0.0
  }
  std::ranges::sort(corners, {}, &Corner::place);
  std::vector<std::uint32_t> leader(object.triangle_count);  // the lowest triangle of the part
  std::iota(leader.begin(), leader.end(), 0u);
  const auto leader_of = [&](std::uint32_t t) {
    while (leader[t] != t) t = leader[t] = leader[leader[t]];
    return t;
  };
  for (std::size_t k = 1; k < corners.size(); ++k) {
    if (corners[k].place != corners[k - 1].place) continue;
    const std::uint32_t s = leader_of(corners[k].triangle);
    const std::uint32_t t = leader_of(corners[k - 1].triangle);
    leader[std::max(s, t)] = std::min(s, t);
  }
  std::vector<Vec3> out;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    if (leader[t] == t) out.push_back(scene.corners(object.first_triangle + t)[0]);
  }
  return out;
}

}  // namespace

const char* to_string(WhichInside inside) {
  switch (inside) {
    case WhichInside::unknown:
      return "unknown";
    case WhichInside::none:
      return "none";
    case WhichInside::a:
      return "a";
    case WhichInside::b:
      return "b";
    case WhichInside::not_closed:
      return "not closed";
  }
  return "";
}

InsideClaim claim_of(WhichInside inside) {
  switch (inside) {
    case WhichInside::unknown:
      return InsideClaim::unknown;
    case WhichInside::none:
      return InsideClaim::none;
    case WhichInside::a:
      return InsideClaim::a;
    case WhichInside::b:
      return InsideClaim::b;
    case WhichInside::not_closed:
      return InsideClaim::not_closed;
  }
  throw std::logic_error("claim_of: no such answer");
}

struct Insides::OfObject {
  Box box;
  std::once_flag closed_found, parts_found;
  bool closed = false;
  std::vector<Vec3> parts;
};

Insides::Insides(const Scene& scene) : scene_(scene), objects_(new OfObject[scene.objects.size()]) {
  for (std::size_t o = 0; o < scene.objects.size(); ++o)
    objects_[o].box = box_of(scene, scene.objects[o]);
}
Insides::~Insides() = default;

// Whether all of `inner` lies inside `outer`. Sets not_closed where that has no answer.
bool Insides::contains(std::uint32_t outer, std::uint32_t inner, bool& not_closed) const {
  OfObject& in = objects_[inner];
  OfObject& out = objects_[outer];
  if (!within(in.box, out.box)) return false;
  std::call_once(out.closed_found, [&] { out.closed = is_closed(scene_, outer); });
  if (!out.closed) {
    not_closed = true;
    return false;
  }
  std::call_once(in.parts_found,
                 [&] { in.parts = point_of_each_part(scene_, scene_.objects[inner]); });
  return std::ranges::all_of(in.parts, [&](const Vec3& point) {
    const Inside answer = inside(scene_, outer, point, true);
    if (answer == Inside::on) throw std::logic_error("which_inside: the objects meet");
    return answer == Inside::yes;
  });
}

WhichInside Insides::which(std::uint32_t a, std::uint32_t b) const {
  bool not_closed = false;
  if (contains(b, a, not_closed)) return WhichInside::a;
  if (contains(a, b, not_closed)) return WhichInside::b;
  return not_closed ? WhichInside::not_closed : WhichInside::none;
}

}  // namespace farcull
