// The reader and the checker of certificates of distances, against a scene whose answers are found
// here by comparing all pairs (verify/closest.h). A certificate is proved if and only if it has
// these answers.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

#include "tests/fuzz/target.h"
#include "verify/certificate/distance_certificate.h"
#include "verify/closest.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Pairs = DistanceCertificate::Pairs;
using Objects = std::array<std::uint32_t, 2>;

// As for fuzz_check: the reader of JSON takes the most. The constant is for the answers.
constexpr AllocationLimits kLimits = {
    .once_per_byte = 16, .all_per_byte = 96, .constant = 64 << 10};

/// A tetrahedron, a triangle inside it, two squares beside each other that tie, of which the second
/// one is `self`, and a point on the first square.
Scene make_scene() {
  Scene scene;
  scene.name = "fuzz";
  const Vec3 o(0, 0, 0), x(8, 0, 0), y(0, 8, 0), z(0, 0, 8);
  add_triangle(scene, o, y, x);
  add_triangle(scene, o, x, z);
  add_triangle(scene, o, z, y);
  add_triangle(scene, x, y, z);
  end_object(scene, "tetrahedron");
  add_triangle(scene, {1, 1, 1}, {2, 1, 1}, {1, 2, 1.5});
  end_object(scene, "inside");
  add_triangle(scene, {0, 0, -3}, {2, 0, -3}, {0, 2, -3});
  add_triangle(scene, {2, 0, -3}, {2, 2, -3}, {0, 2, -3});
  end_object(scene, "square");
  add_triangle(scene, {0, 0, -4}, {2, 0, -4}, {0, 2, -4});
  add_triangle(scene, {2, 0, -4}, {2, 2, -4}, {0, 2, -4});
  add_triangle(scene, {3, 0, -4}, {4, 0, -4}, {3, 2, -4 - 0x1p-40});
  end_object(scene, "self", true);
  add_triangle(scene, {1, 1, -3}, {1, 1, -3}, {1, 1, -3});
  end_object(scene, "point");
  end_object(scene, "empty");
  return scene;
}

struct Pair {
  DistanceEntry entry;
  SquaredDistance squared;
};

/// All pairs that count, in order, and of each two objects the first of the nearest.
struct Truth {
  Scene scene = make_scene();
  std::vector<Pair> pairs, nearest;

  Truth() {
    const std::vector<std::uint32_t> owner = owners(scene);
    std::map<Objects, Pair> least;
    for (std::uint32_t a = 0; a < scene.triangles.size(); ++a) {
      for (std::uint32_t b = a + 1; b < scene.triangles.size(); ++b) {
        const auto s = scene.corners(a), t = scene.corners(b);
        if (owner[a] == owner[b] && (!scene.objects[owner[a]].self || share_position(s, t)))
          continue;
        const Closest closest = closest_points(s, t);
        const Pair pair = {
            entry_of(scene, {a, b}, closest.squared.text(),
                     {number_of(closest.features[0]), number_of(closest.features[1])}),
            closest.squared};
        pairs.push_back(pair);
        const auto [at, added] = least.try_emplace(pair.entry.objects, pair);
        if (!added && pair.squared < at->second.squared) at->second = pair;
      }
    }
    std::ranges::sort(pairs, {},
                      [](const Pair& p) { return std::pair(p.entry.objects, p.entry.triangles); });
    for (auto& [objects, pair] : least) {
      // Nothing but object 1 is inside another, and the others' boxes do not hold each other but
      // that of the point, which lies on the square.
      if (objects == Objects{0, 1}) {
        pair.entry.inside = InsideClaim::b;
      } else if (objects[0] != objects[1] && !pair.squared.is_zero()) {
        pair.entry.inside = InsideClaim::none;
      }
      nearest.push_back(pair);
    }
  }

  /// The entries that answer the question.
  std::vector<DistanceEntry> answers(const DistanceCertificate& asked) const {
    std::vector<DistanceEntry> out;
    for (const Pair& pair : asked.pairs == Pairs::all ? pairs : nearest) {
      if (within(pair, asked) && (asked.pairs != Pairs::nearest || is_among(pair, asked)))
        out.push_back(pair.entry);
    }
    return out;
  }

 private:
  bool within(const Pair& pair, const DistanceCertificate& asked) const {
    if (std::isinf(asked.within)) return true;
    const auto& [a, b] = pair.entry.objects;
    return farcull::within(scene.corners(scene.objects[a].first_triangle + pair.entry.triangles[0]),
                           scene.corners(scene.objects[b].first_triangle + pair.entry.triangles[1]),
                           asked.within);
  }
  /// Fewer than k come before it, for one of its objects.
  bool is_among(const Pair& pair, const DistanceCertificate& asked) const {
    const auto& [a, b] = pair.entry.objects;
    if (a == b) return false;
    const auto before = [&](std::uint32_t object, std::uint32_t other) {
      std::uint64_t count = 0;
      for (const Pair& x : nearest) {
        const auto& [c, d] = x.entry.objects;
        if (c == d || (c != object && d != object) || !within(x, asked)) continue;
        const auto order = x.squared <=> pair.squared;
        count += order < 0 || (order == 0 && (c == object ? d : c) < other);
      }
      return count;
    };
    return before(a, b) < asked.k || before(b, a) < asked.k;
  }
};

const Truth& truth() {
  static const Truth truth;
  return truth;
}

/// What is left to say of an entry where the certificate does not say what is inside.
bool is_right(const DistanceEntry& claimed, DistanceEntry right) {
  if (claimed.inside == InsideClaim::unknown) right.inside = InsideClaim::unknown;
  return claimed == right;
}

Answer judge(const DistanceCertificate& certificate, const DistanceCheck& result) {
  const Scene& scene = truth().scene;
  require(result.reason.empty() == (result.verdict == Verdict::proved), "a reason at odds");
  require(result.verdict != Verdict::refuted || result.pair, "refuted without a pair");
  const bool same_scene = certificate.scene.objects == scene.objects.size() &&
                          certificate.scene.triangles == scene.triangles.size() &&
                          certificate.scene.hash == scene_hash(scene);
  const bool right = same_scene && std::ranges::equal(certificate.distances,
                                                      truth().answers(certificate), is_right);
  require(right == (result.verdict == Verdict::proved),
          right ? "what is right is not proved" : "proved, and it is not so");
  if (!same_scene) require(result.verdict == Verdict::not_proved, "another scene is refuted");
  switch (result.verdict) {
    case Verdict::proved:
      return Answer::proved;
    case Verdict::refuted:
      return Answer::refuted;
    case Verdict::not_proved:
      break;
  }
  return Answer::not_proved;
}

Answer check(std::string_view text) {
  const auto certificate =
      answer_of(kLimits, text.size(), [&] { return parse_distance_certificate(text, "fuzz"); });
  if (!certificate) return Answer::refused;
  require(parse_distance_certificate(to_text(*certificate), "again") == *certificate,
          "a certificate that changes when written and read");
  const auto result = answer_of(
      kLimits, text.size(), [&] { return check_distances(*certificate, truth().scene, "fuzz"); });
  // An Error alone where an entry names what the scene does not have.
  return result ? judge(*certificate, *result) : Answer::refused;
}

/// The right certificate of a question that the first byte picks, changed as each two of the others
/// say: what, and in which entry.
std::string changed(const std::uint8_t* data, std::size_t size) {
  const Truth& t = truth();
  DistanceCertificate c;
  c.scene = {t.scene.name, t.scene.objects.size(), t.scene.triangles.size(), scene_hash(t.scene)};
  const std::uint8_t question = size > 0 ? data[0] : 0;
  constexpr std::array kPairs = {Pairs::objects, Pairs::nearest, Pairs::all};
  constexpr std::array kWithin = {0.0, 1.0, 3.0, 9.0};
  c.pairs = kPairs[question % 3];
  if (c.pairs == Pairs::nearest) c.k = 1 + question / 3 % 3;
  if (c.pairs == Pairs::all || question >= 128) c.within = kWithin[question / 9 % 4];
  c.distances = t.answers(c);
  for (std::size_t k = 1; k + 1 < size && !c.distances.empty(); k += 2) {
    const std::size_t at = data[k + 1] % c.distances.size();
    DistanceEntry& entry = c.distances[at];
    const auto side = data[k] / 8 % 2;
    switch (data[k] % 8) {
      case 0:
        c.distances.erase(c.distances.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        std::swap(entry, c.distances.back());
        break;
      case 2:
        entry.squared = std::to_string(data[k] / 8) + "/1";
        break;
      case 3:
        entry.features[side] = data[k] / 16 % 7;
        break;
      case 4:
        entry.inside = static_cast<InsideClaim>(data[k] / 8 % 5);
        break;
      case 5:
        entry.triangles[side] = data[k] / 16 % 4;
        break;
      case 6:
        c.distances.push_back(t.nearest[data[k + 1] % t.nearest.size()].entry);
        break;
      default:
        entry.objects[side] = data[k] / 16 % 6;
    }
  }
  return to_text(c);
}

}  // namespace

Answer fuzz_distances(const std::uint8_t* data, std::size_t size) {
  if (size > 0 && data[0] == 1) return check(changed(data + 1, size - 1));
  return check({reinterpret_cast<const char*>(data), size});
}

}  // namespace farcull
