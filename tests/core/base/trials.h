// How many random cases a test tries.
#pragma once

namespace farcull {

/// n, or an eighth of it (at least `least`) where the address sanitizer makes every case several
/// times slower: it looks for faults of memory, which a few cases of each kind show, and all n
/// cases are tried without it.
constexpr int trials(int n, [[maybe_unused]] int least = 1) {
#ifdef __SANITIZE_ADDRESS__
  return n / 8 > least ? n / 8 : least;
#else
  return n;
#endif
}

}  // namespace farcull
