// Certificates of right results check; forged ones do not.
#include "verify/certificate/certificate.h"

#include <rapidcheck/gtest.h>

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/certificates.h"
#include "tests/lab/reference.h"
#include "verify/certificate/pair_list.h"

namespace farcull {
namespace {

const Case& spheres() {
  static const Case spheres(make_builtin_scene("two-spheres"));
  return spheres;
}

TEST(Certificate, IsProvedOnBuiltinScenes) {
  for (const char* name : {"two-spheres", "two-tori", "random-soup", "needles", "degenerate",
                           "ground", "far-apart", "two-spheres@far"}) {
    SCOPED_TRACE(name);
    const Case c(make_builtin_scene(name));
    const CheckResult result = c.check(c.certificate);
    EXPECT_EQ(result.verdict, Verdict::proved) << result.reason;
    EXPECT_EQ(result.reason, "");
    EXPECT_FALSE(result.pair.has_value());
    EXPECT_EQ(result.found.box_pairs, c.pairs.size());
    EXPECT_EQ(result.found.kept, c.kept.size());
    EXPECT_EQ(result.found.culled, c.pairs.size() - c.kept.size());
    EXPECT_EQ(result.found.meeting, c.meeting.size());
    EXPECT_EQ(result.found.separated, c.pairs.size() - c.meeting.size());
    EXPECT_EQ(result.found.neighbours, 0u);
    EXPECT_EQ(result.found, c.certificate.claims);
    EXPECT_EQ(result.culled_meeting, 0u);
  }
}

TEST(Certificate, OfASceneWithoutPairsIsProved) {
  for (const Scene& scene :
       {Scene{}, reference::scene_of({{}, {}}),
        reference::scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}}, {}})}) {
    const Certificate certificate = make_certificate(scene, {}, {}, {});
    EXPECT_TRUE(certificate.evidence.empty());
    EXPECT_EQ(check_certificate(parse_certificate(to_text(certificate), "empty"), scene).verdict,
              Verdict::proved);
  }
}

TEST(Certificate, NamesWhatItCannotAttest) {
  const CheckResult result = spheres().check(spheres().certificate);
  std::string all;
  for (const std::string& line : result.unattested) all += line + "\n";
  for (const char* what :
       {"method", "far", "resolution", "512", "views", "radius", "device", "renderer", "time"})
    EXPECT_TRUE(has_text(all, what)) << what;
}

// ---- a hundred changes ----

/// Counts the changes and expects each to be caught.
class Changes {
 public:
  explicit Changes(const Case& c) : case_(c), random_(20240608) {}

  template <class Change>
  void expect(Verdict verdict, std::optional<std::size_t> pair, const Change& change) {
    Certificate changed = case_.certificate;
    change(changed);
    ASSERT_NE(changed, case_.certificate);
    const CheckResult result = case_.check(changed);
    ++made;
    EXPECT_EQ(result.verdict, verdict) << result.reason;
    EXPECT_NE(result.reason, "");
    EXPECT_EQ(result.pair.has_value(), pair.has_value()) << result.reason;
    if (pair && result.pair) {
      EXPECT_EQ(*result.pair, case_.pairs[*pair]) << result.reason;
    }
  }
  /// A random pair that meets or not, was kept or not.
  std::size_t pick(bool meets, bool kept) {
    for (;;) {
      const std::size_t i = random_() % case_.pairs.size();
      if (case_.meets(i) == meets && case_.is_kept(i) == kept) return i;
    }
  }
  std::size_t any(std::size_t n) { return random_() % n; }

  int made = 0;

 private:
  const Case& case_;
  std::mt19937_64 random_;
};

TEST(Certificate, AHundredChangesAreCaught) {
  const Case& c = spheres();
  ASSERT_GT(c.meeting.size(), 100u);
  ASSERT_GT(c.pairs.size() - c.kept.size(), 100u);
  Changes changes(c);
  const auto set_kind = [](std::uint8_t& byte, int kind) {
    byte = static_cast<std::uint8_t>((byte & kKept) | kind);
  };

  for (int n = 0; n < 20; ++n) {  // a direction that does not separate its pair
    const std::size_t i = changes.pick(false, n % 2 == 0);
    int direction = static_cast<int>(changes.any(kDirections));
    while (c.integers(i).separated_by(direction)) direction = (direction + 1) % kDirections;
    changes.expect(Verdict::not_proved, i,
                   [&](Certificate& x) { set_kind(x.evidence[i], direction); });
  }
  for (int n = 0; n < 20; ++n) {  // to "meets" and, the counts made to fit, again
    const std::size_t i = changes.pick(false, n % 2 == 0);
    changes.expect(Verdict::refuted, i, [&](Certificate& x) {
      set_kind(x.evidence[i], kMeets);
      if (n >= 10) recount(x);
    });
  }
  for (int n = 0; n < 10; ++n) {  // from "meets"
    const std::size_t i = changes.pick(true, true);
    const auto direction = static_cast<int>(changes.any(kDirections));
    changes.expect(Verdict::refuted, i, [&](Certificate& x) {
      set_kind(x.evidence[i], direction);
      if (n >= 5) recount(x);
    });
  }
  for (int n = 0; n < 10; ++n) {  // a pair culled that meets, said or not said to meet
    const std::size_t i = changes.pick(true, true);
    changes.expect(Verdict::refuted, i, [&](Certificate& x) {
      x.evidence[i] = n % 2 == 0 ? kMeets : static_cast<std::uint8_t>(n);
      if (n >= 5) recount(x);
    });
  }
  for (int n = 0; n < 10; ++n) {  // kept or culled instead, harmlessly, but the counts know
    const std::size_t i = changes.pick(false, n % 2 == 0);
    changes.expect(Verdict::not_proved, std::nullopt,
                   [&](Certificate& x) { x.evidence[i] ^= kKept; });
  }
  for (std::size_t digit = 0; digit < 64; digit += 21) {  // another list
    changes.expect(Verdict::not_proved, std::nullopt, [&](Certificate& x) {
      x.list_sha256[digit] = x.list_sha256[digit] == 'a' ? 'b' : 'a';
    });
  }
  for (const auto count : {&Certificate::Unasked::objects, &Certificate::Unasked::pairs}) {
    changes.expect(Verdict::not_proved, std::nullopt,
                   [&](Certificate& x) { --(x.not_asked.*count); });
  }
  for (const auto count : {&Certificate::Claims::box_pairs, &Certificate::Claims::kept,
                           &Certificate::Claims::culled, &Certificate::Claims::separated,
                           &Certificate::Claims::neighbours, &Certificate::Claims::meeting}) {
    for (const std::uint64_t by : {std::uint64_t{1}, ~std::uint64_t{0}, std::uint64_t{1} << 63}) {
      changes.expect(Verdict::not_proved, std::nullopt,
                     [&](Certificate& x) { x.claims.*count += by; });
    }
  }
  for (int n = 0; n < 4; ++n) {  // a byte dropped or added, at the end or inside
    const std::size_t i = n < 2 ? c.pairs.size() - 1 : changes.any(c.pairs.size());
    changes.expect(Verdict::not_proved, std::nullopt, [&](Certificate& x) {
      x.evidence.erase(x.evidence.begin() + static_cast<std::ptrdiff_t>(i));
      if (n % 2 == 0) recount(x);
    });
    changes.expect(Verdict::not_proved, std::nullopt, [&](Certificate& x) {
      x.evidence.insert(x.evidence.begin() + static_cast<std::ptrdiff_t>(i), kKept | kMeets);
      if (n % 2 == 0) recount(x);
    });
  }
  changes.expect(Verdict::not_proved, std::nullopt, [](Certificate& x) { x.evidence.clear(); });
  changes.expect(Verdict::not_proved, std::nullopt, [](Certificate& x) {
    x.evidence.resize(100'000, kKept | kMeets);
    recount(x);
  });
  for (int n = 0; n < 10; ++n) {  // two bytes of different pairs swapped
    const std::size_t i = changes.pick(true, true);
    const std::size_t j = changes.pick(false, n % 2 == 0);
    changes.expect(Verdict::refuted, std::min(i, j),
                   [&](Certificate& x) { std::swap(x.evidence[i], x.evidence[j]); });
  }
  for (const int kind : {39, 45, 63, 128, 128 + 37, 128 + kMeets}) {  // bytes that mean nothing
    const std::size_t i = changes.pick(false, true);
    changes.expect(Verdict::not_proved, i, [&](Certificate& x) { set_kind(x.evidence[i], kind); });
  }
  for (const int kind : {39, 128 + kMeets}) {  // the same, and the pair is culled and meets
    const std::size_t i = changes.pick(true, true);
    changes.expect(Verdict::refuted, i,
                   [&](Certificate& x) { x.evidence[i] = static_cast<std::uint8_t>(kind); });
  }
  changes.expect(Verdict::not_proved, std::nullopt, [](Certificate& x) { ++x.scene.objects; });
  changes.expect(Verdict::not_proved, std::nullopt, [](Certificate& x) { --x.scene.triangles; });
  for (std::size_t digit = 0; digit < 16; digit += 5) {
    changes.expect(Verdict::not_proved, std::nullopt, [&](Certificate& x) {
      x.scene.hash[digit] = x.scene.hash[digit] == 'a' ? 'b' : 'a';
    });
  }
  EXPECT_GE(changes.made, 100);
}

TEST(Certificate, AnotherSceneIsNotProved) {
  const Case& c = spheres();
  Scene moved = c.scene;
  moved.vertices[7].x() = std::nextafter(moved.vertices[7].x(), 10);
  Scene regrouped = c.scene;
  regrouped.objects[0].triangle_count -= 1;
  regrouped.objects[1].first_triangle -= 1;
  regrouped.objects[1].triangle_count += 1;
  for (const Scene& other :
       {moved, regrouped, make_builtin_scene("two-tori"), make_builtin_scene("two-spheres@far")}) {
    const CheckResult result = check_certificate(c.certificate, other);
    EXPECT_EQ(result.verdict, Verdict::not_proved);
    EXPECT_TRUE(has_text(result.reason, "another scene"));
    // The hash is for the reader. Where it lies, the evidence is still held against the scene.
    Certificate forged = c.certificate;
    forged.scene = {other.name, other.objects.size(), other.triangles.size(), scene_hash(other)};
    const CheckResult held = check_certificate(forged, other);
    if (held.verdict == Verdict::proved) {
      EXPECT_EQ(held.found.meeting, decide(other, box_pairs(other)).pairs.size());
    }
  }
}

TEST(Certificate, ThePairThatRefutesGoesBeforeTheOneThatIsNotProved) {
  const Case& c = spheres();
  std::size_t first = 0;
  while (c.meets(first)) ++first;
  std::size_t last = c.pairs.size() - 1;
  while (!c.meets(last)) --last;
  ASSERT_LT(first, last);
  Certificate changed = c.certificate;
  changed.evidence[first] = 63;
  changed.evidence[last] = kMeets;
  const CheckResult result = c.check(changed);
  EXPECT_EQ(result.verdict, Verdict::refuted);
  EXPECT_EQ(result.pair, c.pairs[last]);
  EXPECT_EQ(result.culled_meeting, 1u);
  EXPECT_EQ(result.found.meeting, c.meeting.size());  // every pair decided, whatever its byte
}

// ---- runs that went wrong ----

TEST(Certificate, OfARunThatMissedAPairIsRefuted) {
  const Case& c = spheres();
  for (const std::size_t missed : {std::size_t{0}, c.meeting.size() / 2, c.meeting.size() - 1}) {
    std::vector<TrianglePair> kept = c.kept;
    std::vector<TrianglePair> colliding = c.meeting;
    kept.erase(std::ranges::find(kept, c.meeting[missed]));
    colliding.erase(colliding.begin() + static_cast<std::ptrdiff_t>(missed));
    const CheckResult result = c.check(make_certificate(c.scene, kept, colliding, some_run()));
    EXPECT_EQ(result.verdict, Verdict::refuted);
    EXPECT_EQ(result.pair, c.meeting[missed]);
    EXPECT_EQ(result.culled_meeting, 1u);
  }
}

TEST(Certificate, RefusesListsThatCannotBeOfARun) {
  const Case& c = spheres();
  const auto make = [&](std::vector<TrianglePair> kept, std::vector<TrianglePair> colliding) {
    make_certificate(c.scene, kept, colliding, {});
  };
  std::vector<TrianglePair> backwards(c.kept.rbegin(), c.kept.rend());
  EXPECT_THROW(make(backwards, {}), std::logic_error);
  EXPECT_THROW(make({c.kept[0], c.kept[0]}, {}), std::logic_error);
  EXPECT_THROW(make({{0, 1}}, {}), std::logic_error);              // of one object
  EXPECT_THROW(make({{0, 4'000'000'000}}, {}), std::logic_error);  // of no object
  EXPECT_THROW(make({}, c.meeting), std::logic_error);             // colliding, but not kept
}

// ---- the text ----

TEST(CertificateText, RoundTrips) {
  const Certificate& certificate = spheres().certificate;
  const std::string text = to_text(certificate);
  EXPECT_EQ(parse_certificate(text, "text"), certificate);
  EXPECT_EQ(to_text(parse_certificate(text, "text")), text);
  Certificate no_device = certificate;
  no_device.run = {};
  EXPECT_EQ(parse_certificate(to_text(no_device), "text"), no_device);
}

RC_GTEST_PROP(CertificateText, RoundTripsAnyEvidenceAndCounts,
              (const std::vector<std::uint8_t>& evidence, std::uint64_t count,
               const std::vector<std::uint8_t>& letters)) {
  Certificate certificate;
  certificate.scene.hash = "0123456789abcdef";
  certificate.evidence = evidence;
  certificate.list_sha256 = std::string(64, 'a');
  certificate.claims.kept = count;
  for (const std::uint8_t letter : letters)
    certificate.run.offset += static_cast<char>(letter & 127);  // control characters and NUL too
  RC_ASSERT(parse_certificate(to_text(certificate), "text") == certificate);
}

TEST(CertificateText, WritesNamesThatAreNotUtf8) {
  Certificate certificate = spheres().certificate;
  certificate.scene.name = "\xff name";
  EXPECT_EQ(parse_certificate(to_text(certificate), "text").scene.name, "\xef\xbf\xbd name");
  certificate.run.radius_px = std::numeric_limits<double>::infinity();
  EXPECT_THROW(to_text(certificate), std::logic_error);
}

std::string changed_text(const std::string& from, const std::string& to) {
  Certificate certificate;
  certificate.scene = {"name", 2, 2, "0123456789abcdef"};
  certificate.list_sha256 = std::string(64, '7');
  certificate.run = some_run();
  certificate.evidence = {1, 2, 3, 4};
  std::string text = to_text(certificate);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

void expect_refused(const std::string& text, const std::string& reason) {
  const Error error = error_of([&] { parse_certificate(text, "some/file.json"); });
  EXPECT_EQ(error.where, "some/file.json");
  EXPECT_TRUE(has_text(error.reason, reason));
  EXPECT_LT(error.reason.size(), 300u);
  EXPECT_TRUE(std::ranges::all_of(error.reason, [](char c) { return c >= ' ' && c <= '~'; }))
      << error.reason;
}

TEST(CertificateText, RefusesWhatIsNoJson) {
  expect_refused("", "not JSON");
  expect_refused(std::string(1, '\0'), "not JSON");
  expect_refused("{\"format\": ", "not JSON");
  expect_refused(changed_text("\"name\"", "\"na\xffme\""), "not JSON");
  expect_refused(changed_text("\"name\"", "\"\xed\xa0\x80\""), "not JSON");  // half a surrogate
  expect_refused(changed_text("\"name\"", "1e999"), "not JSON");
  expect_refused(to_text(spheres().certificate) + "{}", "not JSON");
  expect_refused(to_text(spheres().certificate) + std::string(1, '\0') + "{}", "not JSON");
  expect_refused(to_text(spheres().certificate).substr(0, 700), "not JSON");
  expect_refused("\"" + std::string(100'000, 'x'), "not JSON");
  expect_refused(std::string(1'000'000, '['), "nested deeper");
  std::string many = "[0";
  for (int i = 0; i < 20'000; ++i) many += ",0";
  expect_refused(many + "]", "more values");
  expect_refused(changed_text("\"version\"", "\"format\": 1, \"version\""), "occurs twice");
  expect_refused(changed_text("\"kept\"", "\"box_pairs\": 1, \"kept\""), "occurs twice");
}

TEST(CertificateText, RefusesAnotherForm) {
  for (const char* text : {"null", "7", "\"text\"", "[]"}) expect_refused(text, "no object");
  expect_refused("{}", "format is not");
  expect_refused(changed_text("farcull-certificate", "farcull-record"), "format is not");
  for (const char* version : {"1", "2", "6", "0", "-1", "3.0", "4.0", "\"3\"", "null", "[3]"})
    expect_refused(changed_text("\"version\": 3", std::string("\"version\": ") + version),
                   "version is not");
  expect_refused(changed_text("\"version\": 3", "\"version\": 3, \"more\": 2"),
                 "'more' is unknown");
  expect_refused(changed_text("\"version\": 3", "\"version\": 4"), "clearance is missing");
  expect_refused(changed_text("\"version\": 3", "\"version\": 3, \"clearance\": 1"),
                 "'clearance' is unknown");
  for (const char* clearance : {"0", "0.0", "-0.0", "-1", "\"1\"", "null", "[1]"}) {
    expect_refused(
        changed_text("\"version\": 3", std::string("\"version\": 4, \"clearance\": ") + clearance),
        "clearance is ");
  }
  expect_refused(changed_text("\"version\": 3", "\"version\": 4, \"clearance\": 1e999"),
                 "not JSON");
  expect_refused(changed_text("\"list_sha256\"", "\"list_sha1\""), "list_sha256 is missing");
  expect_refused(changed_text("\"not_asked\"", "\"not\""), "not_asked is missing");
  expect_refused(changed_text("\"pairs\": 0", "\"pairs\": -1"), "not_asked.pairs");
  const std::string hash(64, '7');
  for (const std::string& other : {hash.substr(1), hash + "7", hash.substr(1) + "F", std::string()})
    expect_refused(changed_text(hash, other), "list_sha256 is not 64");
  expect_refused(changed_text("\"kept\": 0", "\"keep\": 0"), "claims.kept is missing");
  expect_refused(changed_text("\"kept\": 0", "\"kept\": 0, \"\xc3\xa9\": 0"), "is unknown");
  for (const char* count : {"-1", "1.5", "1e3", "\"1\"", "null", "{}", "18446744073709551616"})
    expect_refused(changed_text("\"kept\": 0", std::string("\"kept\": ") + count), "claims.kept");
  expect_refused(changed_text("\"name\": \"name\"", "\"name\": 3"), "scene.name is no string");
  expect_refused(changed_text("0123456789abcdef", "0123456789abcdeF"), "scene.hash");
  expect_refused(changed_text("0123456789abcdef", "0123456789abcde"), "scene.hash");
  expect_refused(changed_text("\"radius_px\": 0.71691", "\"radius_px\": -1"), "radius_px");
  expect_refused(changed_text("\"radius_px\": 0.71691", "\"radius_px\": \"1\""), "radius_px");
  expect_refused(changed_text("\"width\": 1,", "\"width\": -1,"), "unattested.views[1].width");
  expect_refused(changed_text("\"vendor\": \"vendor\"", "\"vendor\": {}"), "device.vendor");
  expect_refused(changed_text("\"A1: something\"", "1"), "assumptions[0]");
}

TEST(CertificateText, RefusesWhatIsNoBase64) {
  const std::string good = "AQIDBA==";
  for (const char* bad :
       {"AQIDBA=", "AQIDBA", "AQIDBA===", "AQIDBB==", "AQI=BA==", "====", "A===", "AQIDB A=",
        "AQID\\nBA==", "AQIDB-==", "\\u0000QIDBA==", "=QIDBA==", "AQID\xc3\xa9==", "AQIDBAF="}) {
    SCOPED_TRACE(bad);
    expect_refused(changed_text(good, bad), "evidence is not base64");
  }
  EXPECT_TRUE(parse_certificate(changed_text(good, ""), "text").evidence.empty());
  EXPECT_EQ(parse_certificate(changed_text(good, "/w=="), "text").evidence,
            std::vector<std::uint8_t>{255});
}

}  // namespace
}  // namespace farcull
