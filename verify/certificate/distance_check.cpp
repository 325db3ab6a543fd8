// The checker of distances. Only integers, integer_distance, box_pairs, distance_proofs and this
// file, with the files of this folder that they include, have to be right.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "verify/certificate/box_pairs.h"
#include "verify/certificate/distance_certificate.h"
#include "verify/certificate/distance_proofs.h"
#include "verify/certificate/integer_distance.h"
#include "verify/certificate/integers.h"

namespace farcull {
namespace {

using Pairs = DistanceCertificate::Pairs;

constexpr std::size_t kBlock = 1 << 16;  // pairs decided at a time
constexpr std::size_t kPerThread = 256;  // pairs per thread, enough to pay for it

/// The fault that is reported: the first that refutes the certificate, else the first that leaves
/// it unproved.
class Report {
 public:
  void refute(std::string reason, const TrianglePair& pair, const IntegerDistance& exact) {
    add(Verdict::refuted, std::move(reason), pair, exact);
  }
  void leave_unproved(std::string reason, const TrianglePair& pair, const IntegerDistance& exact) {
    add(Verdict::not_proved, std::move(reason), pair, exact);
  }
  bool refuted() const { return out_.verdict == Verdict::refuted; }
  DistanceCheck& result() { return out_; }
  void finish() {
    if (out_.reason.empty()) out_.verdict = Verdict::proved;
  }

 private:
  void add(Verdict verdict, std::string reason, const TrianglePair& pair,
           const IntegerDistance& exact) {
    if (refuted() || (verdict == Verdict::not_proved && !out_.reason.empty())) return;
    out_.verdict = verdict;
    out_.reason = std::move(reason);
    out_.pair = pair;
    out_.squared = text_of(exact.squared);
    out_.distance = root_above(exact.squared);
  }
  DistanceCheck out_;
};

class Checker {
 public:
  Checker(const DistanceCertificate& certificate, const Scene& scene, const std::string& name)
      : certificate_(certificate),
        scene_(scene),
        listed_(located(certificate, scene, name)),
        proof_(scene) {
    if (std::isfinite(certificate.within)) within_.emplace(square_of(certificate.within));
  }

  DistanceCheck run() {
    check_order();
    check_entries();
    if (!report_.refuted()) {
      if (certificate_.pairs == Pairs::all) {
        check_triangles();
      } else {
        check_objects();
      }
    }
    report_.finish();
    return std::move(report_.result());
  }

 private:
  std::array<Vec3, 3> corners(std::uint32_t triangle) const { return scene_.corners(triangle); }
  IntegerDistance exact(const TrianglePair& pair) const {
    return integer_distance(corners(pair.a), corners(pair.b));
  }

  std::string place_of(const Listed& listed) const {
    return "distances[" + std::to_string(&listed - listed_.data()) + "]";
  }

  /// Precondition: the triangles are of one object.
  bool are_neighbours(const TrianglePair& pair) const {
    for (const Vec3& p : corners(pair.a)) {
      for (const Vec3& q : corners(pair.b)) {
        if (p == q) return true;
      }
    }
    return false;
  }

  // ---- the entries by themselves ----

  void check_order() {
    const bool all = certificate_.pairs == Pairs::all;
    const auto& entries = certificate_.distances;
    for (std::size_t i = 1; i < entries.size(); ++i) {
      const auto key = [&](const DistanceEntry& entry) {
        return std::pair(entry.objects, all ? entry.triangles : std::array<std::uint32_t, 2>{});
      };
      if (key(entries[i - 1]) < key(entries[i])) continue;
      report_.leave_unproved("distances[" + std::to_string(i) + "] is there twice, or not in order",
                             listed_[i].pair, exact(listed_[i].pair));
      return;
    }
  }

  /// Whether the certificate's question asks about the pair of entry i.
  bool counts(std::size_t i) const {
    const DistanceEntry& entry = certificate_.distances[i];
    if (entry.objects[0] != entry.objects[1]) return entry.objects[0] < entry.objects[1];
    return certificate_.pairs != Pairs::nearest && scene_.objects[entry.objects[0]].self &&
           entry.triangles[0] < entry.triangles[1] && !are_neighbours(listed_[i].pair);
  }

  /// Whether entry i claims what is inside although that is not asked about this pair.
  bool says_needlessly_what_is_inside(std::size_t i) const {
    const DistanceEntry& entry = certificate_.distances[i];
    if (entry.inside == InsideClaim::unknown) return false;
    return certificate_.pairs == Pairs::all || entry.objects[0] == entry.objects[1] ||
           listed_[i].length.squared.over == 0;
  }

  /// A message if the entry is wrong about which object is inside, else empty. Elsewhere the
  /// distance proves that the objects do not meet.
  static std::string wrong_inside(const IntegerInside& insides, const DistanceEntry& entry) {
    const auto& [a, b] = entry.objects;
    if (entry.inside == InsideClaim::unknown || a == b) return "";
    const std::optional<InsideClaim> found = insides.which(a, b);
    if (found == entry.inside) return "";
    const std::string is = found ? "\"" + inside_text(*found) + "\"" : "nothing: the objects meet";
    return " says that `inside` is \"" + inside_text(entry.inside) + "\", and it is " + is;
  }

  void check_entries() {
    std::vector<IntegerDistance> found(listed_.size());
    std::vector<std::string> inside(listed_.size());
    const IntegerInside insides(scene_);
    for_chunks(listed_.size(), chunks_for(listed_.size(), kPerThread),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   found[i] = exact(listed_[i].pair);
                   inside[i] = wrong_inside(insides, certificate_.distances[i]);
                 }
               });
    for (std::size_t i = 0; i < listed_.size(); ++i) {
      const TrianglePair& pair = listed_[i].pair;
      const std::string place = place_of(listed_[i]);
      if (found[i].squared != listed_[i].length.squared) {
        report_.refute("the square of the distance in " + place + " is not that of its triangles",
                       pair, found[i]);
      } else if (within_ && found[i].squared > within_->squared) {
        report_.refute(place + " is farther apart than the distance asked for", pair, found[i]);
      } else if (!inside[i].empty()) {
        report_.refute(place + inside[i], pair, found[i]);
      } else if (says_needlessly_what_is_inside(i)) {
        report_.leave_unproved(place +
                                   " says what is inside, of triangles, of one object, or of "
                                   "objects that meet",
                               pair, found[i]);
      } else if (!counts(i)) {
        report_.leave_unproved(
            place +
                " is no pair that is asked about: one object, neighbours, or the second "
                "triangle before the first",
            pair, found[i]);
      } else if (found[i].features != certificate_.distances[i].features) {
        report_.leave_unproved(place + " does not say where the nearest points lie: " +
                                   feature_text(found[i].features[0]) + " and " +
                                   feature_text(found[i].features[1]) + " hold the first two",
                               pair, found[i]);
      }
    }
  }

  // ---- all triangles ----

  void check_triangles() {
    std::vector<TrianglePair> sorted;
    for (const Listed& listed : listed_) sorted.push_back(listed.pair);
    std::ranges::sort(sorted);
    const std::vector<std::uint32_t> owner = owners(scene_);
    BoxPairs enumeration(scene_, certificate_.within);
    std::vector<TrianglePair> pairs;
    while (enumeration.next(pairs, kBlock) && !report_.refuted()) {
      for (const TrianglePair& pair : pairs) {
        ++report_.result().decided;
        if (std::ranges::binary_search(sorted, pair)) continue;
        if (owner[pair.a] == owner[pair.b] && are_neighbours(pair)) {
          ++report_.result().neighbours;
          continue;
        }
        proof_.add({pair, &*within_, false, 0, std::nullopt});
      }
      decide();
    }
  }

  // ---- objects ----

  using Objects = std::array<std::uint32_t, 2>;
  /// The pairs of objects that are listed, sorted, each with its entry.
  using Named = std::vector<std::pair<Objects, const Listed*>>;

  /// Leaves out entries that do not count, and of several entries about the same objects all but
  /// the first. A certificate with such entries is not proved, but may be refuted for another
  /// reason.
  Named named_objects() const {
    Named out;
    for (std::size_t i = 0; i < listed_.size(); ++i) {
      if (counts(i)) out.emplace_back(certificate_.distances[i].objects, &listed_[i]);
    }
    std::ranges::sort(out);
    const auto same = std::ranges::unique(out, {}, &Named::value_type::first);
    out.erase(same.begin(), same.end());
    return out;
  }

  /// How far the answers of an object reach: to its kth nearest listed object, or to `within` if
  /// fewer than k are listed.
  struct Reach {
    const Length* length = nullptr;                                    // null: infinite
    std::uint32_t object = std::numeric_limits<std::uint32_t>::max();  // the last one as far away
  };

  /// Whether an object at this distance is within the reach. At the reach's own distance, objects
  /// up to reach.object are within it.
  static bool is_in(const Length& length, std::uint32_t object, const Reach& reach) {
    if (reach.length == nullptr) return true;
    const auto order = length.squared <=> reach.length->squared;
    return order < 0 || (order == 0 && object <= reach.object);
  }

  /// The reach of each object.
  std::vector<Reach> reaches(const Named& named) const {
    std::vector<Reach> out(scene_.objects.size(), {.length = within_ ? &*within_ : nullptr});
    if (certificate_.pairs != Pairs::nearest) return out;
    std::vector<std::vector<Reach>> of(scene_.objects.size());
    for (const auto& [objects, listed] : named) {
      of[objects[0]].push_back({&listed->length, objects[1]});
      of[objects[1]].push_back({&listed->length, objects[0]});
    }
    for (std::size_t o = 0; o < of.size(); ++o) {
      if (of[o].size() < certificate_.k) continue;
      const auto kth = of[o].begin() + static_cast<std::ptrdiff_t>(certificate_.k - 1);
      std::ranges::nth_element(of[o], kth, [](const Reach& x, const Reach& y) {
        return x.object != y.object && is_in(*x.length, x.object, y);
      });
      out[o] = *kth;
    }
    return out;
  }

  void check_objects() {
    const Named named = named_objects();
    NearBoxes boxes(scene_);
    // Listed objects come first: only when their distances are proved, the reaches are known.
    for (const auto& [objects, listed] : named) {
      ask(boxes, objects, &listed->length, false, listed);
      if (report_.refuted()) return;
    }
    decide();
    if (report_.refuted()) return;
    const std::vector<Reach> reach = reaches(named);
    if (certificate_.pairs == Pairs::nearest) check_reaches(named, reach);
    check_unlisted(boxes, named, reach);
  }

  void check_unlisted(NearBoxes& boxes, const Named& named, const std::vector<Reach>& reach) {
    std::vector<std::uint32_t> objects;  // those that have triangles
    for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
      if (scene_.objects[o].triangle_count > 0) objects.push_back(o);
    }
    auto next = named.begin();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const bool self = certificate_.pairs == Pairs::objects && scene_.objects[objects[i]].self;
      for (std::size_t j = self ? i : i + 1; j < objects.size(); ++j) {
        const Objects pair = {objects[i], objects[j]};
        if (next != named.end() && next->first == pair) {
          ++next;
          continue;
        }
        ask_unlisted(boxes, pair, reach);
        if (report_.refuted()) return;
      }
    }
    decide();
  }

  /// Asks about two objects that are not in each other's reach.
  void ask_unlisted(NearBoxes& boxes, const Objects& objects, const std::vector<Reach>& reach) {
    const Reach& of_a = reach[objects[0]];
    const Reach& of_b = reach[objects[1]];
    const Length* far = farther(of_a.length, of_b.length);
    // A pair exactly `far` apart is allowed if for each of the two reaches that is so long, its
    // last object comes before the other object.
    const auto as_far = [&](const Reach& x, std::uint32_t other) {
      return far != nullptr && (x.object < other || x.length->squared < far->squared);
    };
    ask(boxes, objects, far, as_far(of_a, objects[1]) && as_far(of_b, objects[0]), nullptr);
  }

  static const Length* farther(const Length* x, const Length* y) {
    if (x == nullptr || y == nullptr || x == y) return x == nullptr ? x : y;
    return x->squared < y->squared ? y : x;
  }

  /// Asks for the proof that every pair of the two objects that counts is farther apart than the
  /// length. With or_as_far, and for pairs after the listed one, exactly as far is enough.
  void ask(NearBoxes& boxes, const Objects& objects, const Length* length, bool or_as_far,
           const Listed* listed) {
    ++question_;
    if (length == nullptr) {
      if (const auto pair = first_counting(objects))
        proof_.add({*pair, nullptr, false, question_, {}});
    } else {
      std::optional<std::size_t> entry;
      if (listed != nullptr) entry = listed - listed_.data();
      boxes.ask(objects[0], objects[1], length->above);
      std::vector<TrianglePair> pairs;
      for (bool more = true; more && !proof_.nearer();) {
        pairs.clear();
        more = boxes.next(pairs, kBlock);
        report_.result().decided += pairs.size();
        for (const TrianglePair& pair : pairs) {
          if (listed != nullptr && pair == listed->pair) continue;
          if (objects[0] == objects[1] && are_neighbours(pair)) {
            ++report_.result().neighbours;
            continue;
          }
          const bool after = listed != nullptr && listed->pair < pair;
          proof_.add({pair, length, or_as_far || after, question_, entry});
        }
        if (more) proof_.decide();
      }
    }
    if (proof_.waiting() >= kBlock || proof_.nearer()) decide();
  }

  /// The first pair of triangles of the objects that are not neighbours. Precondition: both objects
  /// have triangles.
  std::optional<TrianglePair> first_counting(const Objects& objects) const {
    const Object& x = scene_.objects[objects[0]];
    const Object& y = scene_.objects[objects[1]];
    if (objects[0] != objects[1]) return TrianglePair{x.first_triangle, y.first_triangle};
    const std::uint32_t end = x.first_triangle + x.triangle_count;
    for (std::uint32_t a = x.first_triangle; a < end; ++a) {
      for (std::uint32_t b = a + 1; b < end; ++b) {
        if (!are_neighbours({a, b})) return TrianglePair{a, b};
      }
    }
    return std::nullopt;
  }

  /// Refutes entries whose objects are not within the reach of each other, either way.
  void check_reaches(const Named& named, const std::vector<Reach>& reach) {
    for (const auto& [objects, listed] : named) {
      if (is_in(listed->length, objects[1], reach[objects[0]]) ||
          is_in(listed->length, objects[0], reach[objects[1]])) {
        continue;
      }
      report_.refute(place_of(*listed) + ": neither object is among the nearest of the other",
                     listed->pair, exact(listed->pair));
    }
  }

  // ---- deciding ----

  /// Decides the waiting pairs and reports the faults. To be called only between two questions, not
  /// while the pairs of a question are still added.
  void decide() {
    proof_.decide();
    if (const auto& job = proof_.nearer())
      report_.refute(reason(*job), job->pair, exact(job->pair));
    if (const auto& job = proof_.as_near()) {
      report_.leave_unproved(
          "a pair of triangles is as near as the one that is named, and before it", job->pair,
          exact(job->pair));
    }
  }

  std::string reason(const FarProof::Job& job) const {
    if (job.entry) {
      return place_of(listed_[*job.entry]) + ": these triangles of the two objects are nearer";
    }
    switch (certificate_.pairs) {
      case Pairs::objects:
        return within_ ? "these triangles are within the distance asked for, and their objects are "
                         "not listed"
                       : "the objects of these triangles are not listed";
      case Pairs::nearest:
        return "the objects of these triangles are not listed, and they are no farther apart than "
               "the nearest ones that are listed of one of them";
      case Pairs::all:
        break;
    }
    return "these triangles are within the distance asked for, and are not listed";
  }

  const DistanceCertificate& certificate_;
  const Scene& scene_;
  std::vector<Listed> listed_;
  std::optional<Length> within_;  // none: infinite
  std::uint64_t question_ = 0;    // number of the last question
  FarProof proof_;
  Report report_;
};

}  // namespace

DistanceCheck check_distances(const DistanceCertificate& certificate, const Scene& scene,
                              const std::string& name) {
  const FloatingPointGuard guard;
  const Stopwatch start;
  const bool all = certificate.pairs == Pairs::all;
  if (!(certificate.within >= 0) || (all && !std::isfinite(certificate.within)) ||
      (certificate.pairs == Pairs::nearest) != (certificate.k > 0)) {
    throw std::logic_error("check_distances: a bad question");
  }
  DistanceCheck result;
  result.reason = other_scene(certificate.scene, key_of(scene));
  if (result.reason.empty()) result = Checker(certificate, scene, name).run();
  result.ms = start.ms();
  return result;
}

}  // namespace farcull
