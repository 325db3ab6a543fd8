// Parity of crossings along a ray in the direction of the first axis. The ray starts a little
// beside the point, by e along the second axis and by e^2 along the third, with e > 0 smaller than
// any number: so it meets no edge, and no ray has to be tried twice. The sign of a polynomial in e
// is that of its first coefficient that is not 0.
#include "verify/certificate/integer_inside.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "verify/certificate/integers.h"

namespace farcull {
namespace {

using BigVector = integer::Vector<mpz_class>;

/// On which side of the ray the edge from p to q passes, both relative to the point: of the product
/// (p - o) x (q - o) along the first axis, o = (0, e, e^2). 0 only where p and q differ at most
/// along the ray.
int side_of_edge(const BigVector& p, const BigVector& q) {
  const int sign = cmp(mpz_class(p[1] * q[2]), mpz_class(p[2] * q[1]));
  if (sign != 0) return sign;
  const int first = cmp(p[2], q[2]);
  return first != 0 ? first : cmp(q[1], p[1]);
}

mpz_class determinant(const std::array<BigVector, 3>& t) {
  BigVector product;
  mpz_class out;
  integer::cross(product, t[1], t[2]);
  integer::dot(out, t[0], product);
  return out;
}

/// False if the box of the triangle is beside the ray from x or behind x, so that the ray cannot
/// cross it. The comparisons are exact.
bool may_cross(const std::array<Vec3, 3>& t, const Vec3& x) {
  const auto& [p, q, r] = t;
  if (std::max({p.x(), q.x(), r.x()}) < x.x()) return false;
  for (int k = 1; k < 3; ++k) {
    if (std::min({p[k], q[k], r[k]}) > x[k] || std::max({p[k], q[k], r[k]}) < x[k]) return false;
  }
  return true;
}

/// Is the number of crossings odd? Nothing where x lies on a triangle that the ray crosses.
std::optional<bool> is_odd(const Scene& scene, const Object& object, const Vec3& x) {
  bool odd = false;
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const std::array<Vec3, 3> t = scene.corners(object.first_triangle + k);
    if (!may_cross(t, x)) continue;
    const integer::ScaledPair pair = integer::scaled({x, x, x}, t);  // t less x
    const int side = side_of_edge(pair.b[0], pair.b[1]);
    if (side == 0 || side_of_edge(pair.b[1], pair.b[2]) != side ||
        side_of_edge(pair.b[2], pair.b[0]) != side) {
      continue;  // passes by
    }
    // The ray meets the plane at determinant / n_x along it, and n_x has the sign `side`.
    const int ahead = sgn(determinant(pair.b));
    if (ahead == 0) return std::nullopt;
    if (ahead == side) odd = !odd;
  }
  return odd;
}

using Place = std::array<double, 3>;

bool is_closed_mesh(const Scene& scene, const Object& object) {
  std::vector<Place> places;  // each once
  const auto place_of = [](const Vec3& p) {
    return Place{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};  // no -0.0
  };
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    for (const Vec3& p : scene.corners(object.first_triangle + k)) places.push_back(place_of(p));
  }
  std::ranges::sort(places);
  const auto rest = std::ranges::unique(places);
  places.erase(rest.begin(), rest.end());
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    std::array<std::size_t, 3> at{};
    const std::array<Vec3, 3> t = scene.corners(object.first_triangle + k);
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = static_cast<std::size_t>(std::ranges::lower_bound(places, place_of(t[i])) -
                                       places.begin());
    }
    if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(std::minmax(at[i], at[(i + 1) % 3]));
  }
  std::ranges::sort(edges);
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
  }
  return true;
}

/// A corner of each set of triangles that vertices hold together. Such a set is connected.
std::vector<Vec3> corner_of_each_part(const Scene& scene, const Object& object) {
  const auto first = scene.triangles.begin() + object.first_triangle;
  const auto last = first + object.triangle_count;
  std::uint32_t most = 0;
  for (auto t = first; t != last; ++t) most = std::max({most, (*t)[0], (*t)[1], (*t)[2]});
  std::vector<std::uint32_t> leader(std::size_t{most} + 1);
  std::iota(leader.begin(), leader.end(), 0u);
  const auto leader_of = [&](std::uint32_t v) {
    while (leader[v] != v) v = leader[v] = leader[leader[v]];
    return v;
  };
  for (auto t = first; t != last; ++t) {
    leader[leader_of((*t)[1])] = leader_of((*t)[0]);
    leader[leader_of((*t)[2])] = leader_of((*t)[0]);
  }
  std::vector<bool> met(leader.size());
  std::vector<Vec3> out;
  for (auto t = first; t != last; ++t) {
    const std::uint32_t of = leader_of((*t)[0]);
    if (met[of]) continue;
    met[of] = true;
    out.push_back(scene.vertices[of]);
  }
  return out;
}

}  // namespace

struct IntegerInside::OfObject {
  Box box = Box::empty();
  std::once_flag closed_found, corners_found;
  bool closed = false;
  std::vector<Vec3> corners;  // one of each part
};

IntegerInside::IntegerInside(const Scene& scene)
    : scene_(scene), objects_(new OfObject[scene.objects.size()]) {
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      for (const Vec3& p : scene.corners(object.first_triangle + k)) objects_[o].box.add(p);
    }
  }
}
IntegerInside::~IntegerInside() = default;

IntegerInside::Answer IntegerInside::contains(std::uint32_t outer, std::uint32_t inner) const {
  OfObject &in = objects_[inner], &out = objects_[outer];
  // A part that is inside a closed mesh is inside its box.
  const Box &x_box = in.box, &y_box = out.box;
  if ((x_box.lo.array() < y_box.lo.array()).any() || (x_box.hi.array() > y_box.hi.array()).any())
    return Answer::no;
  std::call_once(out.closed_found,
                 [&] { out.closed = is_closed_mesh(scene_, scene_.objects[outer]); });
  if (!out.closed) return Answer::not_closed;
  std::call_once(in.corners_found,
                 [&] { in.corners = corner_of_each_part(scene_, scene_.objects[inner]); });
  for (const Vec3& x : in.corners) {
    const std::optional<bool> odd = is_odd(scene_, scene_.objects[outer], x);
    if (!odd) return Answer::on;
    if (!*odd) return Answer::no;
  }
  return Answer::yes;
}

std::optional<InsideClaim> IntegerInside::which(std::uint32_t a, std::uint32_t b) const {
  if (std::max(a, b) >= scene_.objects.size() || a == b)
    throw std::logic_error("IntegerInside: no two objects of the scene");
  const Answer a_in_b = contains(b, a);
  if (a_in_b == Answer::yes) return InsideClaim::a;
  const Answer b_in_a = contains(a, b);
  if (b_in_a == Answer::yes) return InsideClaim::b;
  if (a_in_b == Answer::on || b_in_a == Answer::on) return std::nullopt;
  const bool open = a_in_b == Answer::not_closed || b_in_a == Answer::not_closed;
  return open ? InsideClaim::not_closed : InsideClaim::none;
}

}  // namespace farcull
