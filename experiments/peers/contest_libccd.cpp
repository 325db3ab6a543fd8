// libccd's tests of convex bodies, GJK and MPR. A triangle is passed as the convex hull of its
// corners.
#include <ccd/ccd.h>

#include <algorithm>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

const Corners& triangle(const void* object) { return *static_cast<const Corners*>(object); }

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const auto along = [&](const Vec3& p) {
    return p[0] * direction->v[0] + p[1] * direction->v[1] + p[2] * direction->v[2];
  };
  const Vec3& best = *std::ranges::max_element(triangle(object), {}, along);
  ccdVec3Set(out, best[0], best[1], best[2]);
}

void centre(const void* object, ccd_vec3_t* out) {
  const Corners& t = triangle(object);
  ccdVec3Set(out, (t[0][0] + t[1][0] + t[2][0]) / 3, (t[0][1] + t[1][1] + t[2][1]) / 3,
             (t[0][2] + t[1][2] + t[2][2]) / 3);
}

ccd_t settings() {
  ccd_t out;
  CCD_INIT(&out);
  out.support1 = support;
  out.support2 = support;
  out.center1 = centre;
  out.center2 = centre;
  out.max_iterations = 100;
  return out;
}

template <int (*intersect)(const void*, const void*, const ccd_t*)>
bool pair(const SuitePair& asked) {
  const ccd_t ccd = settings();
  return intersect(&asked.a, &asked.b, &ccd) != 0;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  constexpr const char* kLibrary = "libccd " FARCULL_CCD_VERSION;
  return contest(argc, argv,
                 {{.card = crossing_card("libccd-gjk", kLibrary), .pair = pair<ccdGJKIntersect>},
                  {.card = crossing_card("libccd-mpr", kLibrary), .pair = pair<ccdMPRIntersect>}});
}
