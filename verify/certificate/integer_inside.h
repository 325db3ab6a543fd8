// Whether one of two objects lies inside the other, decided in integers. For the checker of
// distances and the accounting: it knows neither verify/inside nor experiments/method/distances.
// docs/certificate.md has the proof.
//
// A mesh is *closed* if every edge, by the positions of its ends, belongs to an even number of its
// triangles; triangles with two equal corners do not count. A point off a closed mesh is *inside*
// if a ray from it crosses the mesh an odd number of times.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/scene/scene.h"

namespace farcull {

/// a, b: this object is inside the other, with all of its points. none: neither is. not_closed:
/// neither is, but the box of one is in that of the other, which is not closed. unknown: nothing is
/// said.
enum class InsideClaim : std::uint8_t { unknown, none, a, b, not_closed };

/// Answers for one scene, which must stay as it is and outlive the object. What is found out about
/// an object is kept.
class IntegerInside {
 public:
  explicit IntegerInside(const Scene& scene);
  ~IntegerInside();
  IntegerInside(const IntegerInside&) = delete;
  IntegerInside& operator=(const IntegerInside&) = delete;

  /// Never unknown; nothing where a corner of one object is met on the mesh of the other. The
  /// answer counts only where the objects share no point, which others have to prove. Precondition:
  /// the objects differ and have triangles. May be called by several threads at once. Throws
  /// std::logic_error for objects that the scene does not have.
  std::optional<InsideClaim> which(std::uint32_t a, std::uint32_t b) const;

 private:
  struct OfObject;
  enum class Answer : std::uint8_t { no, yes, not_closed, on };
  Answer contains(std::uint32_t outer, std::uint32_t inner) const;

  const Scene& scene_;
  std::unique_ptr<OfObject[]> objects_;
};

}  // namespace farcull
