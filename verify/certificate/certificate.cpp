// Makes certificates. The directions need not be trusted, since the checker verifies them.
#include "verify/certificate/certificate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "verify/certificate/box_pairs.h"
#include "verify/certificate/integer_pair.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

// Consecutive objects that are not `self` form one range.

NotAsked not_asked(const Scene& scene) {
  NotAsked out;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.self) continue;
    ++out.objects;
    const std::uint64_t n = object.triangle_count;
    if (n > 0) out.pairs += n * (n - 1) / 2;
    if (out.ranges.empty() || out.ranges.back()[1] + 1 != o) out.ranges.push_back({o, o});
    out.ranges.back()[1] = o;
  }
  return out;
}

Certificate::SceneKey key_of(const Scene& scene) {
  return {scene.name, scene.objects.size(), scene.triangles.size(), scene_hash(scene)};
}

Certificate::Unasked unasked_of(const Scene& scene) {
  const NotAsked unasked = not_asked(scene);
  return {unasked.objects, unasked.pairs};
}

namespace {

using Corners = std::array<Vec3, 3>;

std::uint8_t evidence_of(const Scene& scene, const TrianglePair& pair, double clearance,
                         bool one_object, bool kept, bool colliding) {
  if (colliding) return kKept | kMeets;
  const Corners a = scene.corners(pair.a);
  const Corners b = scene.corners(pair.b);
  IntegerPair integers(a, b, clearance);
  const std::uint8_t flag = kept ? kKept : 0;
  if (one_object && integers.shares_position())
    return !kept && integers.meets_beyond_shared() ? kMeets : flag | kNeighbours;
  if (const int guess = likely_direction(a, b, clearance); integers.separated_by(guess))
    return flag | guess;
  if (const std::optional<int> direction = integers.separating_direction())
    return flag | *direction;
  return kept ? kKept : kMeets;
}

/// Tells which pairs of a sorted enumeration are in a given sorted list. The caller passes each
/// enumerated pair, in order, to contains().
class Marked {
 public:
  /// pairs: the given list. others: true if the list may have pairs that are not enumerated; if
  /// false, such a pair is an error.
  Marked(std::span<const TrianglePair> pairs, const char* name, bool others)
      : pairs_(pairs), name_(name), others_(others) {
    for (std::size_t i = 1; i < pairs.size(); ++i) {
      if (!(pairs[i - 1] < pairs[i])) fail("unsorted or repeated");
    }
  }
  bool contains(const TrianglePair& pair) {
    while (others_ && at_ < pairs_.size() && pairs_[at_] < pair) ++at_;
    if (at_ == pairs_.size() || pair < pairs_[at_]) return false;
    if (pair != pairs_[at_]) fail("not among those whose boxes overlap");
    ++at_;
    return true;
  }
  void finish() const {
    if (!others_ && at_ != pairs_.size()) fail("not among those whose boxes overlap");
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw std::logic_error(std::string("make_certificate: ") + name_ + " pairs " + what);
  }

  std::span<const TrianglePair> pairs_;
  const char* name_;
  bool others_;
  std::size_t at_ = 0;
};

}  // namespace

Certificate make_certificate(const Scene& scene, std::span<const TrianglePair> kept,
                             std::span<const TrianglePair> colliding, Certificate::Run run,
                             double clearance, const WholeScene* whole) {
  const FloatingPointGuard guard;
  if (!(clearance >= 0 && std::isfinite(clearance)))
    throw std::logic_error("make_certificate: a clearance must be finite and not negative");
  constexpr std::size_t kBlock = 1 << 16;   // approximate number of pairs per block
  constexpr std::size_t kPerThread = 1024;  // fewer pairs do not justify a thread
  Certificate out;
  out.scene = whole ? whole->key : key_of(scene);
  out.clearance = clearance;
  if (whole) out.tile = whole->tile;
  out.not_asked = whole ? whole->not_asked : unasked_of(scene);
  out.run = std::move(run);

  Marked kept_pairs(kept, "kept", clearance > 0);
  Marked colliding_pairs(colliding, "colliding", false);
  BoxPairs enumeration(scene, clearance, whole ? whole->tile : Tile());
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<TrianglePair> pairs;
  std::vector<std::array<bool, 2>> marks;
  while (enumeration.next(pairs, kBlock)) {
    marks.clear();
    for (const TrianglePair& pair : pairs) {
      marks.push_back({kept_pairs.contains(pair), colliding_pairs.contains(pair)});
      if (marks.back()[1] && !marks.back()[0])
        throw std::logic_error("make_certificate: a colliding pair that was not kept");
    }
    const std::size_t done = out.evidence.size();
    out.evidence.resize(done + pairs.size());
    for_chunks(pairs.size(), chunks_for(pairs.size(), kPerThread),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   const bool one_object = owner[pairs[i].a] == owner[pairs[i].b];
                   out.evidence[done + i] = evidence_of(scene, pairs[i], clearance, one_object,
                                                        marks[i][0], marks[i][1]);
                 }
               });
  }
  kept_pairs.finish();
  colliding_pairs.finish();
  out.list_sha256 = pair_list_hash(scene, colliding, whole ? whole->numbers : nullptr);

  out.claims.box_pairs = out.evidence.size();
  for (const std::uint8_t byte : out.evidence) {
    ++((byte & kKept) != 0 ? out.claims.kept : out.claims.culled);
    const int claim = byte & ~kKept;
    ++(claim == kMeets        ? out.claims.meeting
       : claim == kNeighbours ? out.claims.neighbours
                              : out.claims.separated);
  }
  return out;
}

Certificate certificate_of_list(const Scene& scene, std::vector<TrianglePair> listed,
                                double clearance) {
  const FloatingPointGuard guard;
  std::sort(listed.begin(), listed.end());
  listed.erase(std::unique(listed.begin(), listed.end()), listed.end());
  constexpr std::size_t kBlock = 1 << 16;
  BoxPairs enumeration(scene, clearance);
  std::vector<TrianglePair> pairs;
  std::vector<TrianglePair> near;  // pairs of the list whose boxes overlap
  while (enumeration.next(pairs, kBlock)) {
    std::set_intersection(pairs.begin(), pairs.end(),
                          std::lower_bound(listed.begin(), listed.end(), pairs.front()),
                          listed.end(), std::back_inserter(near));
  }
  Certificate::Run run;
  run.method = "none: a list was given";
  return make_certificate(scene, near, near, std::move(run), clearance);
}

}  // namespace farcull
