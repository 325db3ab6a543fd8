// Which objects of a scene clash: one row for each pair of objects that meet, lie in one another or
// are near, as one function from a scene to a record. One run of boxes over all objects finds
// the pairs of triangles that meet; exact tests decide the rest.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/base/stage.h"
#include "core/scene/scene.h"
#include "experiments/method/run.h"
#include "verify/closest.h"
#include "verify/contact.h"
#include "verify/penetration.h"

namespace farcull {

/// The relation of two objects, the most serious first.
/// clash: their surfaces pass through each other, or their insides overlap; also if they touch and
///   it is not proved that they only touch (ClashRow::proved).
/// contained: the surfaces do not meet, and all or a part of one object is inside the other.
/// unknown: as `contained`, if the outer object were closed. It is not, so it has no inside.
/// touch: they meet, and it is proved that their insides do not.
/// near: they do not meet, and are at most the clearance apart.
/// clear: none of these.
/// With a tolerance, `touch` is also said of objects whose depth (verify/penetration.h) is proved
/// to be at most the tolerance, and of objects that are at most the tolerance apart.
enum class ClashVerdict : std::uint8_t { clash, contained, unknown, touch, near, clear };
inline constexpr std::array kClashVerdicts = {ClashVerdict::clash,   ClashVerdict::contained,
                                              ClashVerdict::unknown, ClashVerdict::touch,
                                              ClashVerdict::near,    ClashVerdict::clear};
std::string to_string(ClashVerdict verdict);

struct ClashOptions {
  double clearance = 0;                  // world units, finite, >= 0
  std::vector<ObjectPair> ignored = {};  // as in_order() gives them: they are examined, but are
                                         // listed apart
  std::optional<std::vector<ObjectPair>> only = {};  // as above: no other pairs are asked for
  double tolerance = 0;  // world units, finite, >= 0: of an overlap or gap that counts as a touch
  bool depth = false;    // bounds of the depth of clashes; they take longer than all
                         // else for parts with many triangles
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
};

struct ClashRow {
  ObjectPair objects;
  ClashVerdict verdict = ClashVerdict::clear;
  ClashVerdict exact = ClashVerdict::clear;  // the verdict with a tolerance of 0
  bool ignored = false;
  bool proved = true;       // false: a touch was not proved to be one, so it counts as a clash
  std::uint64_t pairs = 0;  // of triangles that meet
  std::array<std::uint64_t, kContactKinds.size()> kinds = {};  // how many of these, by kind
  std::optional<std::uint32_t> inner = {};      // contained, unknown: the object inside the other
  std::optional<SquaredDistance> squared = {};  // of the surfaces, if they are at most the
                                                // clearance or the tolerance apart and do not meet
  double distance = 0;                          // root of `squared`, rounded once
  Box box = Box::empty();  // of the common points; of the inner object; of two nearest points
  std::array<Vec3, 2> witness = {Vec3::Zero(), Vec3::Zero()};  // a common point, twice; a corner of
                                                               // the inner object, twice; or two
                                                               // nearest points. Rounded
  double curve = 0;  // length of the curve in which the surfaces cross
  std::vector<std::array<Vec3, 2>> segments = {};  // of that curve, each once; ends rounded
  std::optional<Penetration> depth = {};   // of a clash or a containment of two closed objects, if
                                           // asked for; if it is within the tolerance
  std::optional<std::uint32_t> open = {};  // why there is no depth, if one or a tolerance is asked
                                           // for: this object is not closed
  bool within_tolerance() const { return verdict != exact; }
};

struct ClashRecord {
  ClashOptions options;
  std::uint64_t asked = 0;         // pairs of objects that are not ignored
  std::uint64_t examined = 0;      // of these, pairs whose objects have triangles
  std::uint64_t ignored = 0;       // pairs that are ignored
  std::uint64_t ignored_meet = 0;  // of these, pairs that clash, touch or may contain each other
  std::array<std::uint64_t, kClashVerdicts.size()> verdicts = {};  // pairs that are not ignored
  std::uint64_t within_tolerance = 0;  // of these, pairs that touch only because of the tolerance
  std::vector<std::uint32_t> empty;    // objects without triangles
  std::vector<ObjectPair> copies;  // objects that may be one part twice: as many triangles, and the
                                   // same box but for rounding to floats. The first 100
  std::optional<ObjectPair> sizes;   // the smallest and the largest object, if the one is 100 times
                                     // the size of the other, or more
  std::vector<ClashRow> rows;        // all but those that are clear, the most serious first; those
                                     // of ignored objects last. Without `near` of ignored ones
  std::uint64_t triangle_pairs = 0;  // that meet
  std::vector<Stage> trace;
  double ms = 0;

  std::uint64_t count(ClashVerdict verdict) const {
    return verdicts[static_cast<std::size_t>(verdict)];
  }
};

/// Examines every two objects of the scene. Precondition: no object is tested against itself, and
/// the scene ignores none. Throws Error if the scene has fewer than two objects, or if the
/// clearance or the tolerance is no distance.
ClashRecord clashes(const Scene& scene, const ClashOptions& options, const Progress& progress = {});

/// The diagonal of an object's box.
double size_of(const Scene& scene, std::uint32_t object);

}  // namespace farcull
