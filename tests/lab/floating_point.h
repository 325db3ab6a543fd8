// Floating-point environments that the proofs are not about, and scenes whose answers depend on it.
#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "core/base/floating_point.h"
#include "tests/lab/scenes.h"

namespace farcull::lab {

struct Environment {
  std::string name;
  int rounding = FE_TONEAREST;
  unsigned mxcsr = 0;   // bits that are set: 0x8000 flush to zero, 0x0040 denormals are zero
  FloatingPoint found;  // what arithmetic must show
};

inline std::vector<Environment> environments() {
  std::vector<Environment> all = {
      {"upward", FE_UPWARD, 0, {Rounding::upward}},
      {"downward", FE_DOWNWARD, 0, {Rounding::downward}},
      {"toward zero", FE_TOWARDZERO, 0, {Rounding::toward_zero}},
  };
#ifdef __SSE2__
  all.push_back({"results", FE_TONEAREST, 0x8000, {Rounding::to_nearest, true, false}});
  all.push_back({"operands", FE_TONEAREST, 0x0040, {Rounding::to_nearest, false, true}});
  all.push_back({"both", FE_TONEAREST, 0x8040, {Rounding::to_nearest, true, true}});
  all.push_back({"both, upward", FE_UPWARD, 0x8040, {Rounding::upward, true, true}});
#endif
  return all;
}

/// The environment of this thread is another one while this lives.
class Disturbed {
 public:
  explicit Disturbed(const Environment& environment) {
    std::fegetenv(&before_);
    std::fesetround(environment.rounding);
#ifdef __SSE2__
    _mm_setcsr(_mm_getcsr() | environment.mxcsr);
#endif
  }
  ~Disturbed() { std::fesetenv(&before_); }
  Disturbed(const Disturbed&) = delete;
  Disturbed& operator=(const Disturbed&) = delete;

 private:
  std::fenv_t before_;
};

/// Two objects of `copies` equal triangles each.
inline Scene copies_of(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                       std::size_t copies) {
  return scene_of({std::vector(copies, a), std::vector(copies, b)});
}

// Coplanar triangles that overlap. Products of two coordinates are subnormal or 0, so flushing
// makes them disjoint.
inline Scene tiny_scene(std::size_t copies = 1) {
  constexpr double x = 1.90109156629516e-211, y = 3.80218313259032e-211;
  return copies_of({Vec3(-x, -y, 0), Vec3(x, x, 0), Vec3(x, -x, 0)},
                   {Vec3(y, x, 0), Vec3(-x, y, 0), Vec3(y, -x, 0)}, copies);
}

// Coplanar triangles that overlap. Determinants overflow: to infinity when rounded to nearest,
// which proves nothing, but to the largest number when rounded downward or toward zero.
inline Scene huge_scene(std::size_t copies = 1) {
  const auto p = [](double x, double y) { return Vec3(1e150 * x, 1e150 * y, 1e150 * (x + y)); };
  return copies_of({p(0, 0), p(2, -1), p(0, 2)}, {p(-1, 4), p(-1, -3), p(1, -4)}, copies);
}

// Triangles of subnormal coordinates whose boxes overlap but that are disjoint. As zeros they meet.
inline Scene subnormal_scene(std::size_t copies = 1) {
  const auto p = [](int x, int y) { return Vec3(x * 0x1p-1070, y * 0x1p-1070, 0); };
  return copies_of({p(0, 0), p(4, 0), p(0, 4)}, {p(4, 4), p(4, 3), p(3, 4)}, copies);
}

}  // namespace farcull::lab
