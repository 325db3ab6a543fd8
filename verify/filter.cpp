// The filters with the proved bounds.
#include "verify/filter.h"

#include "verify/filter_of_distance.h"
#include "verify/filter_of_planes.h"

namespace farcull {

Triage filter_planes(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  return filters::filter_planes<FilterBounds>(a, b, clearance);
}

Triage filter_beyond_vertex(const Vec3& v, const Vec3& a1, const Vec3& a2, const Vec3& b1,
                            const Vec3& b2) {
  return filters::filter_beyond_vertex<FilterBounds>(v, a1, a2, b1, b2);
}

Triage filter_beyond_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  return filters::filter_beyond_edge<FilterBounds>(p, q, r, s);
}

Triage filter_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  return filters::filter_within<FilterBounds>(a, b, clearance);
}

}  // namespace farcull
