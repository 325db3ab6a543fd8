// Finds which objects of a scene clash. The record has one row for each pair of objects that meet,
// contain each other or are near. One run of the method `boxes` over all objects finds the pairs of
// triangles that meet; exact tests decide the rest.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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
/// unknown: perhaps `contained`; the outer object is open, or neither the winding number nor rays
///   decide what is inside it (overlap_at() in verify/overlap.h).
/// touch: they meet, and it is proved that their insides do not.
/// near: they do not meet, and are at most the clearance apart.
/// clear: none of these.
/// With a tolerance, two objects also `touch` if their depth (verify/penetration.h) is proved to be
/// at most the tolerance, or if they are at most the tolerance apart.
enum class ClashVerdict : std::uint8_t { clash, contained, unknown, touch, near, clear };
inline constexpr std::array kClashVerdicts = {ClashVerdict::clash,   ClashVerdict::contained,
                                              ClashVerdict::unknown, ClashVerdict::touch,
                                              ClashVerdict::near,    ClashVerdict::clear};
std::string to_string(ClashVerdict verdict);

struct ClashOptions {
  double clearance = 0;                  // world units, finite, >= 0
  std::vector<ObjectPair> ignored = {};  // sorted by in_order(); they are examined, but are
                                         // listed apart
  std::optional<std::vector<ObjectPair>> only = {};  // asks only for these pairs; sorted likewise
  double tolerance = 0;  // world units, finite, >= 0: a depth or gap up to this is a touch
  bool depth = false;    // bounds the depth of clashes; with many triangles this takes
                         // longer than all the rest
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
};

struct ClashRow {
  ObjectPair objects;
  ClashVerdict verdict = ClashVerdict::clear;
  ClashVerdict exact = ClashVerdict::clear;  // the verdict with a tolerance of 0
  bool ignored = false;
  bool proved = true;    // false: a touch was not proved to be one, so it counts as a clash
  bool shallow = false;  // true: the tolerance lies between the bounds of the depth, and no deeper
                         // point was found, as when a part fits tightly in a slot
  std::uint64_t pairs = 0;                                     // of triangles that meet
  std::array<std::uint64_t, kContactKinds.size()> kinds = {};  // how many of these, by kind
  std::optional<std::uint32_t> inner = {};      // contained, unknown: the object inside the other
  std::optional<SquaredDistance> squared = {};  // of the surfaces, if they do not meet and are at
                                                // most the clearance or the tolerance apart
  double distance = 0;                          // root of `squared`, rounded once
  Box box = Box::empty();  // box of the common points, the inner object or the two nearest points
  /// A common point twice, a corner of the inner object twice, or two nearest points; rounded.
  std::array<Vec3, 2> witness = {Vec3::Zero(), Vec3::Zero()};
  double curve = 0;  // length of the curve in which the surfaces cross
  std::vector<std::array<Vec3, 2>> segments = {};  // of that curve, each once; ends rounded
  std::optional<Penetration> depth = {};   // of two closed objects that clash or contain; set if
                                           // asked for, if within the tolerance, or if shallow
  std::optional<std::uint32_t> open = {};  // an object that is not closed, so there is no depth;
                                           // set if a depth is asked for or a tolerance is given
  bool within_tolerance() const { return verdict != exact; }
};

struct ClashRecord {
  ClashOptions options;
  std::uint64_t asked = 0;         // pairs of objects that are not ignored
  std::uint64_t examined = 0;      // of these, pairs whose objects have triangles
  std::uint64_t ignored = 0;       // pairs that are ignored
  std::uint64_t ignored_meet = 0;  // of these, pairs that clash, touch or may contain each other
  std::array<std::uint64_t, kClashVerdicts.size()> verdicts = {};  // pairs not ignored, by verdict
  std::uint64_t within_tolerance = 0;  // of these, pairs that touch only because of the tolerance
  std::vector<std::uint32_t> empty;    // objects without triangles
  /// At most 100 pairs that may be one part twice: they have equally many triangles, and the same
  /// box but for rounding to floats.
  std::vector<ObjectPair> copies;
  /// The smallest and the largest object, if their sizes differ by a factor of 100 or more.
  std::optional<ObjectPair> sizes;
  /// The rows of all verdicts but `clear` (for ignored pairs also without `near`): the most serious
  /// first, ignored pairs last.
  std::vector<ClashRow> rows;
  std::uint64_t triangle_pairs = 0;  // that meet
  std::vector<Stage> trace;
  double ms = 0;

  std::uint64_t count(ClashVerdict verdict) const {
    return verdicts[static_cast<std::size_t>(verdict)];
  }
};

/// Examines every two objects of the scene, or options.only. Precondition: no object is tested
/// against itself, and Scene::ignored is empty. Throws Error if the scene has fewer than two
/// objects, or if the clearance or the tolerance is no distance.
ClashRecord clashes(const Scene& scene, const ClashOptions& options, const Progress& progress = {});

/// The diagonal of an object's box.
double size_of(const Scene& scene, std::uint32_t object);

}  // namespace farcull
