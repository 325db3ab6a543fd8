// Finds which objects of a scene clash. The record has one row for each pair of objects that meet,
// that are near, or of which one may contain the other. The method `boxes` finds the pairs of
// triangles that meet. Exact tests decide the relations of the objects.
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
/// clash: the surfaces cross, or the insides overlap, or the surfaces meet and there is no proof
///   that the objects only touch (ClashRow::proved).
/// contained: the surfaces do not meet, and a part of one object is inside the other object.
/// unknown: maybe `contained`, but exact tests did not decide (overlap_at() in verify/overlap.h).
/// touch: the surfaces meet, and it is proved that the insides do not overlap.
/// near: the objects do not meet, and their distance is at most the clearance.
/// clear: none of these.
/// With a tolerance, two objects `touch` in two more cases: their depth (verify/penetration.h) is
/// proved to be at most the tolerance, or their distance is at most the tolerance.
enum class ClashVerdict : std::uint8_t { clash, contained, unknown, touch, near, clear };
inline constexpr std::array kClashVerdicts = {ClashVerdict::clash,   ClashVerdict::contained,
                                              ClashVerdict::unknown, ClashVerdict::touch,
                                              ClashVerdict::near,    ClashVerdict::clear};
std::string to_string(ClashVerdict verdict);

struct ClashOptions {
  double clearance = 0;                  // world units, finite, >= 0
  std::vector<ObjectPair> ignored = {};  // examined, but listed separately; sorted by in_order()
  std::optional<std::vector<ObjectPair>> only = {};  // examines only these; sorted by in_order()
  double tolerance = 0;  // world units, finite, >= 0; a depth or gap <= this is a touch
  bool depth = false;    // bounds the depth of clashes, which is slow with many triangles
  unsigned threads = 0;  // 0: one per core; any number gives the same answer
};

struct ClashRow {
  ObjectPair objects;
  ClashVerdict verdict = ClashVerdict::clear;
  ClashVerdict exact = ClashVerdict::clear;  // the verdict with a tolerance of 0
  bool ignored = false;
  bool proved = true;    // false: counts as a clash, but the objects may only touch
  bool shallow = false;  // true: the tolerance lies between the bounds of the depth, and no point
                         // deeper than the tolerance was found
  std::uint64_t pairs = 0;                                     // pairs of triangles that meet
  std::array<std::uint64_t, kContactKinds.size()> kinds = {};  // `pairs` counted by kind
  std::optional<std::uint32_t> inner = {};      // for contained and unknown: the inner object
  std::optional<SquaredDistance> squared = {};  // squared distance of the surfaces; set only if 0 <
                                                // distance <= max(clearance, tolerance)
  double distance = 0;                          // square root of `squared`, rounded once
  Box box = Box::empty();  // box of the common points, the inner object or the two nearest points
  /// A common point twice, a corner of the inner object twice, or the two nearest points.
  /// Coordinates are rounded.
  std::array<Vec3, 2> witness = {Vec3::Zero(), Vec3::Zero()};
  double curve = 0;  // length of the curve in which the surfaces cross
  std::vector<std::array<Vec3, 2>> segments =
      {};                                  // distinct segments of the curve; ends are rounded
  std::optional<Penetration> depth = {};   // null: not computed
  std::optional<std::uint32_t> open = {};  // an object that is not closed; `depth` is then null
  bool within_tolerance() const { return verdict != exact; }
};

struct ClashRecord {
  ClashOptions options;
  std::uint64_t asked = 0;         // pairs of objects to examine, without ignored pairs
  std::uint64_t examined = 0;      // pairs in `asked` whose two objects have triangles
  std::uint64_t ignored = 0;       // ignored pairs
  std::uint64_t ignored_meet = 0;  // ignored pairs with a row that is not `near`
  std::array<std::uint64_t, kClashVerdicts.size()> verdicts = {};  // examined pairs, by verdict
  std::uint64_t within_tolerance = 0;  // pairs that touch only because of the tolerance
  std::vector<std::uint32_t> empty;    // objects without triangles
  /// At most 100 pairs of objects that may be copies of one part. They have the same number of
  /// triangles, and the same box up to rounding to floats.
  std::vector<ObjectPair> copies;
  /// The smallest and the largest object, if their sizes differ by a factor of 100 or more.
  std::optional<ObjectPair> sizes;
  /// The rows of all verdicts except `clear`. Ignored pairs that are `near` have no row. The most
  /// serious row is first. Ignored pairs are last.
  std::vector<ClashRow> rows;
  std::uint64_t triangle_pairs = 0;  // pairs of triangles that meet
  std::vector<Stage> trace;
  double ms = 0;

  std::uint64_t count(ClashVerdict verdict) const {
    return verdicts[static_cast<std::size_t>(verdict)];
  }
};

/// Examines every two objects of the scene, or the pairs in options.only. Precondition: no object
/// is tested against itself, and Scene::ignored is empty. Throws Error if the scene has fewer than
/// two objects, or if the clearance or the tolerance is negative or not finite.
ClashRecord clashes(const Scene& scene, const ClashOptions& options, const Progress& progress = {});

/// Returns the length of the diagonal of the object's box.
double size_of(const Scene& scene, std::uint32_t object);

}  // namespace farcull
