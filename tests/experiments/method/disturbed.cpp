// Loaded into the program before main (LD_PRELOAD), as a library that was built with -ffast-math
// is: its constructor changes the floating-point environment. FARCULL_DISTURB names the change;
// FARCULL_DISTURB_STAYS makes fesetenv do nothing, as if the environment could not be set.
#include <dlfcn.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <cfenv>
#include <cstdlib>
#include <string>

namespace {

__attribute__((constructor)) void disturb() {
  const char* given = std::getenv("FARCULL_DISTURB");
  const std::string name = given == nullptr ? "" : given;
  if (name == "upward") std::fesetround(FE_UPWARD);
  if (name == "downward") std::fesetround(FE_DOWNWARD);
  if (name == "toward zero") std::fesetround(FE_TOWARDZERO);
#ifdef __SSE2__
  if (name == "flush") _mm_setcsr(_mm_getcsr() | 0x8040);  // FTZ and DAZ, as crtfastmath.o does
#endif
}

}  // namespace

extern "C" int fesetenv(const std::fenv_t* environment) noexcept {
  if (std::getenv("FARCULL_DISTURB_STAYS") != nullptr) return 0;
  using Set = int (*)(const std::fenv_t*);
  static const Set set = reinterpret_cast<Set>(::dlsym(RTLD_NEXT, "fesetenv"));
  return set(environment);
}
