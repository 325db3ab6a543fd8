// The text of fit.inl on scalars.
#include "offsets/fit.h"

#include "core/base/glsl_shim.h"
#include "offsets/fit_rounding.h"
#include "offsets/round.h"

namespace farcull {
namespace fit {

struct dvec3 {
  double x, y, z;
};
double min(double a, double b) { return b < a ? b : a; }
double max(double a, double b) { return a < b ? b : a; }
double abs(double a) { return std::fabs(a); }
double sqrt(double a) { return std::sqrt(a); }

#define FAR_NEAREST(x) static_cast<double>(nearest(x))
#include "offsets/fit.inl"
#undef FAR_NEAREST

}  // namespace fit

namespace {

constexpr std::size_t kMostPoints = std::tuple_size_v<decltype(Patch::corners)>;

// The points as the text takes them.
struct Points {
  explicit Points(std::span<const Vec3> from) : count(static_cast<int>(from.size())) {
    if (from.empty() || from.size() > kMostPoints) throw std::logic_error("fit: too many points");
    for (int i = 0; i < count; ++i) p[i] = {from[i][0], from[i][1], from[i][2]};
  }
  int count;
  fit::dvec3 p[kMostPoints];
};

Solid solid_of(const double (&numbers)[20]) {
  Solid solid;
  for (int i = 0; i < 20; ++i) solid[i / 4][i % 4] = nearest(numbers[i]);
  return solid;
}

}  // namespace

std::array<float, 8> proxy_rectangle(std::span<const Vec3> points, double radius,
                                     const ProxyBounds& bounds) {
  const Points given(points);
  double corners[8];
  fit::fit_rectangle(given.p, given.count, radius, bounds.x, bounds.y, corners);
  std::array<float, 8> out;
  for (int i = 0; i < 8; ++i) out[i] = nearest(corners[i]);
  return out;
}

Solid obb_of(std::span<const Vec3> points, double radius) {
  const Points given(points);
  double numbers[20];
  fit::fit_box(given.p, given.count, radius, numbers);
  return solid_of(numbers);
}

Solid minkowski_solid(const Vec3& a, const Vec3& b, const Vec3& c, double radius) {
  const Points given(std::array{a, b, c});
  double numbers[20];
  fit::fit_minkowski(given.p, radius, numbers);
  return solid_of(numbers);
}

}  // namespace farcull
