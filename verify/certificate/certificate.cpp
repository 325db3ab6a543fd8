// Making a certificate. Which direction is written is no matter of trust: the checker proves it.
#include "verify/certificate/certificate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "verify/certificate/box_pairs.h"
#include "verify/certificate/integer_pair.h"
#include "verify/certificate/not_asked.h"
#include "verify/certificate/pair_list.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

Vec3 direction_of(const Corners& a, const Corners& b, int direction) {
  const auto edge = [](const Corners& t, int i) -> Vec3 { return t[(i + 1) % 3] - t[i]; };
  const auto cross = [](const Vec3& x, const Vec3& y) -> Vec3 {
    return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  };
  if (direction < 2) {
    const Corners& t = direction == 0 ? a : b;
    return cross(edge(t, 0), edge(t, 1));
  }
  const int family = (direction - 2) / 9;
  const int i = (direction - 2) % 9 / 3;
  const int j = (direction - 2) % 3;
  const Vec3 w = b[j] - a[i];
  if (family == 0) return cross(edge(a, i), edge(b, j));
  if (family == 3) return w;
  const Vec3 e = family == 1 ? edge(a, i) : edge(b, j);
  return w * e.dot(e) - e * w.dot(e);
}

/// A direction whose gap beyond the clearance, in doubles, is clear of rounding, cheap ones first;
/// else the one with the widest in proportion. Only a guess, and NaN where doubles overflow.
int likely_direction(const Corners& a, const Corners& b, double clearance) {
  constexpr double kClear = 1e-6;
  int best = 29;
  double widest = -std::numeric_limits<double>::infinity();
  for (int n = 0; n < kDirections; ++n) {
    const int direction = n < 9 ? 29 + n : n - 9;
    const Vec3 d = direction_of(a, b, direction);
    std::array<double, 3> on_a;
    std::array<double, 3> on_b;
    for (int i = 0; i < 3; ++i) {
      on_a[i] = d.dot(a[i] - a[0]);
      on_b[i] = d.dot(b[i] - a[0]);
    }
    const auto [a_lo, a_hi] = std::minmax({on_a[0], on_a[1], on_a[2]});
    const auto [b_lo, b_hi] = std::minmax({on_b[0], on_b[1], on_b[2]});
    const double extent = std::max(a_hi, b_hi) - std::min(a_lo, b_lo);
    const double needed = clearance == 0 ? 0 : clearance * d.norm();
    const double gap = (std::max(b_lo - a_hi, a_lo - b_hi) - needed) / extent;
    if (gap > kClear) return direction;
    if (gap > widest) {
      widest = gap;
      best = direction;
    }
  }
  return best;
}

std::uint8_t evidence_of(const Scene& scene, const TrianglePair& pair, double clearance,
                         bool one_object, bool kept, bool colliding) {
  if (colliding) return kKept | kMeets;
  const Corners a = scene.corners(pair.a);
  const Corners b = scene.corners(pair.b);
  IntegerPair integers(a, b, clearance);
  const std::uint8_t flag = kept ? kKept : 0;
  if (one_object && integers.shares_position()) {
    return !kept && integers.meets_beyond_shared() ? kMeets : flag | kNeighbours;
  }
  if (const int guess = likely_direction(a, b, clearance); integers.separated_by(guess))
    return flag | guess;
  const std::optional<int> direction = integers.separating_direction();
  if (direction) return flag | *direction;
  return kept ? kKept : kMeets;
}

/// The pairs of a sorted list, found one after the other in a longer one.
class Marked {
 public:
  /// others: pairs that are not in the longer list are passed over.
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
                             double clearance) {
  const FloatingPointGuard guard;
  if (!(clearance >= 0 && std::isfinite(clearance)))
    throw std::logic_error("make_certificate: a clearance must be finite and not negative");
  constexpr std::size_t kBlock = 1 << 16;   // pairs decided at a time
  constexpr std::size_t kPerThread = 1024;  // enough work to pay for a thread
  Certificate out;
  out.scene = {scene.name, scene.objects.size(), scene.triangles.size(), scene_hash(scene)};
  out.clearance = clearance;
  const NotAsked unasked = not_asked(scene);
  out.not_asked = {unasked.objects, unasked.pairs};
  out.run = std::move(run);

  Marked kept_pairs(kept, "kept", clearance > 0);
  Marked colliding_pairs(colliding, "colliding", false);
  BoxPairs enumeration(scene, clearance);
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
  out.list_sha256 = pair_list_hash(scene, colliding);

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
  std::vector<TrianglePair> near;  // of the list
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
