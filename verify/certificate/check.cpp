// The checker of certificates. A verdict can be trusted if this file and the files of verify/ that
// it includes are correct.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "verify/certificate/box_pairs.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/integer_pair.h"
#include "verify/certificate/pair_list.h"

namespace farcull {
namespace {

enum class EvidenceFault : std::uint8_t {
  as_claimed,
  // These faults leave the certificate unproved:
  wrong_direction,  // the pair is disjoint, but the direction does not separate it
  not_neighbours,   // neighbours meet only in their shared part, but the byte has another meaning
  no_evidence,      // the byte has no meaning
  // These faults refute the certificate:
  culled_meets,
  meets,       // a kept pair meets, but is claimed to be disjoint
  separated,   // the pair is disjoint, but is claimed to meet
  neighbours,  // neighbours meet only in their shared part, but are claimed to meet
};

enum class Kind : std::uint8_t { separated, neighbours, meeting };

struct Decision {
  Kind kind = Kind::separated;
  EvidenceFault finding = EvidenceFault::as_claimed;
};

[[noreturn]] void contradiction() {
  throw std::logic_error(
      "check_certificate: neither a separating direction nor a common point of a pair, nor two "
      "points within the clearance");
}

/// Decides the pair without trusting the byte. The pair is disjoint if a direction separates it.
/// The pair meets if a point lies in both triangles, or if two points, one of each triangle, are
/// within the clearance. For neighbours, meets_beyond_shared() decides.
Decision decide(const Scene& scene, const TrianglePair& pair, double clearance, bool one_object,
                std::uint8_t byte) {
  IntegerPair integers(scene.corners(pair.a), scene.corners(pair.b), clearance);
  const bool kept = (byte & kKept) != 0;
  const int claim = byte & ~kKept;
  const auto meeting = [&](EvidenceFault if_kept) {
    return Decision{Kind::meeting, kept ? if_kept : EvidenceFault::culled_meets};
  };
  if (one_object && integers.shares_position()) {
    if (integers.meets_beyond_shared()) {
      return meeting(claim == kMeets                               ? EvidenceFault::as_claimed
                     : claim < kDirections || claim == kNeighbours ? EvidenceFault::meets
                                                                   : EvidenceFault::no_evidence);
    }
    return {Kind::neighbours, claim == kNeighbours ? EvidenceFault::as_claimed
                              : claim == kMeets    ? EvidenceFault::neighbours
                                                   : EvidenceFault::not_neighbours};
  }
  if (claim == kMeets) {
    if (integers.is_within()) return meeting(EvidenceFault::as_claimed);
    if (!integers.separating_direction()) contradiction();
    return {Kind::separated, EvidenceFault::separated};
  }
  const bool direction = claim < kDirections;
  if (direction && integers.separated_by(claim))
    return {Kind::separated, EvidenceFault::as_claimed};
  if (integers.separating_direction())
    return {Kind::separated,
            direction ? EvidenceFault::wrong_direction : EvidenceFault::no_evidence};
  if (!integers.is_within()) contradiction();
  return meeting(direction ? EvidenceFault::meets : EvidenceFault::no_evidence);
}

std::string sentence(EvidenceFault finding, int byte, bool clearance) {
  switch (finding) {
    case EvidenceFault::culled_meets:
      return clearance ? "the pair is called culled, and it is within the clearance"
                       : "the pair is called culled, and it meets";
    case EvidenceFault::meets:
      return clearance ? "the pair is called farther apart than the clearance, and it is not"
                       : "the pair is called disjoint, and it meets";
    case EvidenceFault::separated:
      return clearance ? "the pair is said to be within the clearance, and it is farther apart"
                       : "the pair is said to meet, and it is disjoint";
    case EvidenceFault::wrong_direction:
      return "direction " + std::to_string(byte & ~kKept) +
             (clearance
                  ? " does not show that the pair is farther apart than the clearance, as it is"
                  : " does not separate the pair, which is disjoint");
    case EvidenceFault::neighbours:
      return "the pair is said to meet, and these neighbours share only vertices or an edge";
    case EvidenceFault::not_neighbours:
      return "the byte " + std::to_string(byte) +
             " does not say that these are neighbours that share only vertices or an edge";
    case EvidenceFault::no_evidence:
      return "the byte " + std::to_string(byte) + " is no evidence";
    case EvidenceFault::as_claimed:
      break;
  }
  return "";
}

std::vector<std::string> unattested_of(const Certificate::Run& run) {
  std::vector<std::string> out;
  out.push_back("that the method was " + run.method);
  out.push_back("which pairs the run kept: bit 6 of a byte says so, and nothing proves it");
  if (run.resolution > 0) {
    out.push_back("that the resolution was " + std::to_string(run.resolution) + " px");
    out.push_back("the views, " + std::to_string(run.views.size()) + " of them");
    out.push_back("the offset and its radius");
  }
  out.push_back(run.device ? "the device, " + run.device->renderer
                           : "that no device of OpenGL was used");
  out.push_back("the assumptions about the device, on which the proof does not rely");
  out.push_back("any time");
  return out;
}

std::string wrong_count(const Certificate& certificate, const Certificate::Unasked& unasked,
                        const Certificate::Claims& found) {
  if (certificate.not_asked != unasked) {
    return "not_asked is not what the scene leaves out: " + std::to_string(unasked.pairs) +
           " pairs inside " + std::to_string(unasked.objects) + " objects";
  }
  const Certificate::Claims& claimed = certificate.claims;
  for (const auto& [name, count] : kClaims) {
    if (claimed.*count != found.*count) {
      return std::string("the count ") + name + " is " + std::to_string(claimed.*count) +
             " and should be " + std::to_string(found.*count);
    }
  }
  return "";
}

std::string wrong_list(const std::string& claimed, const std::string& found) {
  return claimed == found ? ""
                          : "the certificate is of another list of pairs: list_sha256 is " +
                                claimed + ", and that of the pairs that meet is " + found;
}

/// Counts the decided pairs, and stores the pair that the result names.
class Tally {
 public:
  explicit Tally(bool clearance) : clearance_(clearance) {}

  void add(const TrianglePair& pair, std::uint8_t byte, const Decision& decision) {
    ++result_.found.box_pairs;
    const bool kept = (byte & kKept) != 0;
    ++(kept ? result_.found.kept : result_.found.culled);
    const bool meets = decision.kind == Kind::meeting;
    ++(meets                               ? result_.found.meeting
       : decision.kind == Kind::neighbours ? result_.found.neighbours
                                           : result_.found.separated);
    if (meets) result_.meeting.push_back(pair);
    if (meets && !kept) ++result_.culled_meeting;
    if (decision.finding == EvidenceFault::as_claimed) return;
    // The result names the first pair that refutes the certificate. If there is no such pair, the
    // result names the first pair that is not proved.
    const bool refuted = decision.finding >= EvidenceFault::culled_meets;
    if (result_.pair && (result_.verdict == Verdict::refuted || !refuted)) return;
    result_.verdict = refuted ? Verdict::refuted : Verdict::not_proved;
    result_.pair = pair;
    result_.reason = sentence(decision.finding, byte, clearance_);
  }

  /// Returns the result. Precondition: all pairs were added.
  CheckResult finish(const Certificate& certificate, const Scene& scene, const WholeScene* whole,
                     double decide_ms) {
    result_.decide_ms = decide_ms;
    result_.list_sha256 = pair_list_hash(scene, result_.meeting, whole ? whole->numbers : nullptr);
    if (!result_.pair) {
      result_.reason =
          wrong_count(certificate, whole ? whole->not_asked : unasked_of(scene), result_.found);
      if (result_.reason.empty())
        result_.reason = wrong_list(certificate.list_sha256, result_.list_sha256);
      result_.verdict = result_.reason.empty() ? Verdict::proved : Verdict::not_proved;
    }
    return std::move(result_);
  }

 private:
  CheckResult result_;
  bool clearance_;
};

CheckResult not_proved(std::string reason) {
  CheckResult result;
  result.reason = std::move(reason);
  return result;
}

CheckResult decide_all(const Certificate& certificate, const Scene& scene,
                       const WholeScene* whole) {
  constexpr std::size_t kBlock = 1 << 16;  // pairs decided at a time, to limit memory
  constexpr std::size_t kPerThread = 1024;
  BoxPairs enumeration(scene, certificate.clearance, whole ? whole->tile : Tile());
  const std::vector<std::uint32_t> owner = owners(scene);
  Tally tally(certificate.clearance > 0);
  std::vector<TrianglePair> pairs;
  std::vector<Decision> decisions;
  std::size_t done = 0;
  double decide_ms = 0;
  while (enumeration.next(pairs, kBlock)) {
    if (pairs.size() > certificate.evidence.size() - done) {
      return not_proved(
          "the evidence is too short: " + std::to_string(certificate.evidence.size()) +
          " bytes, and the scene has more pairs with overlapping boxes");
    }
    const Stopwatch start;
    decisions.assign(pairs.size(), {});
    for_chunks(pairs.size(), chunks_for(pairs.size(), kPerThread),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i)
                   decisions[i] = decide(scene, pairs[i], certificate.clearance,
                                         owner[pairs[i].a] == owner[pairs[i].b],
                                         certificate.evidence[done + i]);
               });
    decide_ms += start.ms();
    for (std::size_t i = 0; i < pairs.size(); ++i)
      tally.add(pairs[i], certificate.evidence[done + i], decisions[i]);
    done += pairs.size();
  }
  if (done != certificate.evidence.size()) {
    return not_proved("the evidence is too long: " + std::to_string(certificate.evidence.size()) +
                      " bytes for " + std::to_string(done) + " pairs with overlapping boxes");
  }
  return tally.finish(certificate, scene, whole, decide_ms);
}

// Returns why the certificate is of another scene; empty if the keys are equal but for the name.
std::string other_scene(const Certificate::SceneKey& claimed, const Certificate::SceneKey& found) {
  const auto differ = [](const std::string& what, const std::string& one,
                         const std::string& other) {
    return "the certificate is of another scene: " + what + " " + one + ", given " + other;
  };
  const auto differ_in = [&](const char* what, std::uint64_t one, std::uint64_t other) {
    return differ(what, std::to_string(one), std::to_string(other));
  };
  if (claimed.objects != found.objects) return differ_in("objects", claimed.objects, found.objects);
  if (claimed.triangles != found.triangles)
    return differ_in("triangles", claimed.triangles, found.triangles);
  if (claimed.hash == found.hash) return "";
  return differ("hash (coordinates, or which objects are self)", claimed.hash, found.hash);
}

}  // namespace

std::string to_string(Verdict verdict) {
  constexpr std::array kWords = {"proved", "refuted", "not proved"};
  return kWords.at(static_cast<std::size_t>(verdict));
}

CheckResult check_certificate(const Certificate& certificate, const Scene& scene,
                              const WholeScene* whole) {
  const FloatingPointGuard guard;
  const Stopwatch start;
  if (!(certificate.clearance >= 0 && std::isfinite(certificate.clearance)))
    throw std::logic_error("check_certificate: a clearance must be finite and not negative");
  std::string other = other_scene(certificate.scene, whole ? whole->key : key_of(scene));
  if (other.empty() && certificate.tile != (whole ? std::optional(whole->tile) : std::nullopt))
    other = whole ? "the certificate is not of this tile" : "the certificate is of a tile alone";
  CheckResult result =
      other.empty() ? decide_all(certificate, scene, whole) : not_proved(std::move(other));
  result.unattested = unattested_of(certificate.run);
  result.ms = start.ms();
  return result;
}

}  // namespace farcull
