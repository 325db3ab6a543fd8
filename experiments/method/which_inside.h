// Whether one of two objects that do not meet lies inside the other.
#pragma once

#include <cstdint>
#include <memory>

#include "core/scene/scene.h"
#include "verify/certificate/integer_inside.h"

namespace farcull {

/// unknown: not asked, or the objects collide. none: neither is inside the other. a, b: this one is
/// inside the other: all of its points are, so that of an object of several parts each part is.
/// not_closed: the box of one object lies in that of the other, which has no inside because it is
/// not closed (verify/inside.h).
enum class WhichInside : std::uint8_t { unknown, none, a, b, not_closed };
/// "unknown", "none", "a", "b" or "not closed".
const char* to_string(WhichInside inside);

/// As certificates and the accounting take it.
InsideClaim claim_of(WhichInside inside);

/// Answers for one scene, which has to stay as it is. What is found out about an object is kept.
class Insides {
 public:
  explicit Insides(const Scene& scene);
  ~Insides();
  Insides(const Insides&) = delete;
  Insides& operator=(const Insides&) = delete;

  /// Precondition: the objects differ, have triangles and share no point. May be called by several
  /// threads at once.
  WhichInside which(std::uint32_t a, std::uint32_t b) const;

 private:
  struct OfObject;
  bool contains(std::uint32_t outer, std::uint32_t inner, bool& not_closed) const;

  const Scene& scene_;
  std::unique_ptr<OfObject[]> objects_;
};

}  // namespace farcull
