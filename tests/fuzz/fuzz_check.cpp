// The reader and the checker of certificates, against a scene whose truth verify/exact knows.
#include <array>
#include <string_view>
#include <vector>

#include "tests/fuzz/target.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/pair_list.h"
#include "verify/exact.h"

namespace farcull {
namespace {

// JSON takes the most where objects hold many short keys ("a":0, is 6 bytes and 48 in a vector that
// holds 3 times as much while it doubles: 24 a byte) and where they are nested ({"": is 5 bytes
// with its end, a set of keys of 48, tripled, and a key of 80: 45 a byte; but the depth is
// bounded). Strings are held three times, once in a buffer that doubles. The largest single
// allocation is a vector after doubling, 2 * 48 / 6 = 16 a byte. The constant is for deciding the
// pairs of the scene, besides messages and first steps.
constexpr AllocationLimits kLimits = {
    .once_per_byte = 16, .all_per_byte = 64, .constant = 32 << 10};

/// Three objects whose pairs are of every kind: crossing, touching at a corner and along an edge,
/// coplanar, one ulp apart, beside each other with overlapping boxes, and triangles that are a
/// segment or a point.
Scene make_scene() {
  Scene scene;
  scene.name = "fuzz";
  constexpr double kUlp = 0x1p-52;
  add_triangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  add_triangle(scene, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
  end_object(scene, "floor");
  add_triangle(scene, {1, 1, -1}, {1, 1, 1}, {2, 1, 1});     // through the floor
  add_triangle(scene, {0, 0, 0}, {-1, 0, 2}, {0, -1, 2});    // a corner on a corner
  add_triangle(scene, {1, 0, 0}, {3, 0, 0}, {2, -1, 1});     // an edge on an edge
  add_triangle(scene, {3, 3, 0}, {3.5, 3, 0}, {3, 3.5, 0});  // within the plane and inside
  add_triangle(scene, {1, 1, kUlp}, {2, 1, 1}, {1, 2, 1});
  end_object(scene, "things");
  add_triangle(scene, {2, 2, -1}, {2, 2, 1}, {2, 2, 3});  // a segment through the floor
  add_triangle(scene, {1, 1, 0}, {1, 1, 0}, {1, 1, 0});   // a point on it
  add_triangle(scene, {3.9, 3.9, -1}, {4.5, 3.9, 1}, {4.5, 4.5, 1});
  add_triangle(scene, {2, 1 + kUlp, 1}, {1, 2 + 2 * kUlp, 1},
               {2, 2, 1.5});  // one ulp from an edge of a thing
  end_object(scene, "degenerate");
  return scene;
}

/// For a clearance: as verify/exact and boxes in doubles have it.
struct Truth {
  Scene scene = make_scene();
  std::vector<TrianglePair> pairs;    // with overlapping boxes, sorted
  std::vector<TrianglePair> meeting;  // of these
  std::vector<bool> meets;
  std::string list_sha256;
  std::uint64_t not_asked = 0;  // pairs of triangles of one object

  explicit Truth(double clearance) {
    const auto near = [&](const Box& x, const Box& y) {
      if (clearance == 0) return overlap(x, y);
      return ((x.lo - y.hi).array() <= clearance).all() &&
             ((y.lo - x.hi).array() <= clearance).all();
    };
    const std::vector<Box> boxes = triangle_boxes(scene);
    const std::vector<std::uint32_t> owner = owners(scene);
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
      for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
        not_asked += owner[a] == owner[b];
        if (owner[a] == owner[b] || !near(boxes[a], boxes[b])) continue;
        pairs.push_back({a, b});
        meets.push_back(within(scene.corners(a), scene.corners(b), clearance));
        if (meets.back()) meeting.push_back({a, b});
      }
    }
    list_sha256 = pair_list_hash(scene, meeting);
  }
};

const Truth& truth() {
  static const Truth truth(0);
  return truth;
}

bool is_kept(std::uint8_t byte) { return (byte & kKept) != 0; }

/// Whether the byte says of its pair what is not so: culled though it meets, or the wrong one of
/// "meets" and a direction. A byte that says nothing contradicts nothing, but culls.
bool contradicts(std::uint8_t byte, bool meets) {
  const int claim = byte & ~kKept;
  if (!is_kept(byte) && meets) return true;
  return claim == kMeets ? !meets : claim < kMeets && meets;
}

Certificate::Claims count(const Truth& t, const Certificate& certificate) {
  Certificate::Claims claims;
  claims.box_pairs = t.pairs.size();
  for (std::size_t i = 0; i < t.pairs.size(); ++i) {
    ++(is_kept(certificate.evidence[i]) ? claims.kept : claims.culled);
    ++(t.meets[i] ? claims.meeting : claims.separated);
  }
  return claims;
}

Answer judge(const Truth& t, const Certificate& certificate, const CheckResult& result) {
  require(!result.unattested.empty(), "nothing is unattested");
  require(result.reason.empty() == (result.verdict == Verdict::proved), "a reason at odds");
  const bool same_scene = certificate.scene.objects == t.scene.objects.size() &&
                          certificate.scene.triangles == t.scene.triangles.size() &&
                          certificate.scene.hash == scene_hash(t.scene);
  if (!same_scene || certificate.evidence.size() != t.pairs.size()) {
    require(result.verdict == Verdict::not_proved && !result.pair, "another scene or length");
    return Answer::not_proved;
  }
  const Certificate::Claims found = count(t, certificate);
  require(result.found == found, "wrong counts found");
  require(result.meeting == t.meeting && result.list_sha256 == t.list_sha256, "another list");
  std::size_t culled_meeting = 0;
  std::optional<std::size_t> first;  // that contradicts the truth
  bool says_nothing = false;
  for (std::size_t i = 0; i < t.pairs.size(); ++i) {
    const std::uint8_t byte = certificate.evidence[i];
    culled_meeting += !is_kept(byte) && t.meets[i];
    says_nothing |= (byte & ~kKept) > kMeets;
    if (!first && contradicts(byte, t.meets[i])) first = i;
  }
  require(result.culled_meeting == culled_meeting, "wrong number of culled pairs that meet");
  require((result.verdict == Verdict::refuted) == first.has_value(),
          first ? "a false claim that is not refuted" : "a refutation of what is true");
  if (first) {
    require(result.pair == t.pairs[*first], "another pair than the first false one");
    return Answer::refuted;
  }
  if (result.verdict != Verdict::proved) return Answer::not_proved;
  require(!result.pair && !says_nothing && certificate.claims == found &&
              certificate.list_sha256 == t.list_sha256 &&
              certificate.not_asked.pairs == t.not_asked,
          "proved, and it is not so");
  return Answer::proved;
}

Answer check(std::string_view text) {
  const auto certificate =
      answer_of(kLimits, text.size(), [&] { return parse_certificate(text, "fuzz"); });
  if (!certificate) return Answer::refused;
  require(parse_certificate(to_text(*certificate), "again") == *certificate,
          "a certificate that changes when written and read");
  const auto result = answer_of(kLimits, text.size(),
                                [&] { return check_certificate(*certificate, truth().scene); });
  require(result.has_value(), "an Error from the check");
  if (certificate->clearance == 0) return judge(truth(), *certificate, *result);
  return judge(Truth(certificate->clearance), *certificate, *result);
}

/// A certificate of the scene with this evidence. The counts are right but for one that the first
/// byte may name (1 .. 5), then raised by 1.
std::string text_around(const Truth& t, double clearance, std::span<const std::uint8_t> bytes) {
  Certificate certificate;
  certificate.clearance = clearance;
  certificate.scene = {t.scene.name, t.scene.objects.size(), t.scene.triangles.size(),
                       scene_hash(t.scene)};
  certificate.not_asked = {t.scene.objects.size(), t.not_asked};
  certificate.list_sha256 = t.list_sha256;
  if (!bytes.empty()) certificate.evidence.assign(bytes.begin() + 1, bytes.end());
  if (certificate.evidence.size() != t.pairs.size()) return to_text(certificate);
  Certificate::Claims& claims = certificate.claims = count(t, certificate);
  const std::array<std::uint64_t*, 6> counts = {nullptr,        &claims.box_pairs, &claims.kept,
                                                &claims.culled, &claims.separated, &claims.meeting};
  if (bytes[0] > 0 && bytes[0] < counts.size()) ++*counts[bytes[0]];
  return to_text(certificate);
}

}  // namespace

Answer fuzz_check(const std::uint8_t* data, std::size_t size) {
  if (size > 0 && data[0] == 1) return check(text_around(truth(), 0, {data + 1, size - 1}));
  if (size > 0 && data[0] == 2) {
    static const Truth half(0.5);
    return check(text_around(half, 0.5, {data + 1, size - 1}));
  }
  return check({reinterpret_cast<const char*>(data), size});
}

}  // namespace farcull
