// Certificates of distances with one thing changed are not proved: what is false is refuted, what
// is not as the page says is left unproved, and what cannot be read is an Error.
#include <nlohmann/json.hpp>

#include "tests/lab/certificates.h"
#include "verify/certificate/distance_certificate.h"

namespace farcull {
namespace {

using distance_case::Distances;
using Json = nlohmann::ordered_json;
using Pairs = DistanceCertificate::Pairs;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

reference::Triangle shifted(reference::Triangle t, const Vec3& by) {
  for (Vec3& p : t) p += by;
  return t;
}

/// Four objects and an empty one: 0 and 1 face each other at distance 2 in two pairs of triangles
/// each; 2 is 3 above 1; 3, which is `self`, is a strip of four triangles, 5 beside 2.
Scene make_scene() {
  const reference::Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const reference::Triangle u = {Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  Scene scene = reference::scene_of({{t, u},
                                     {shifted(t, Vec3(0.25, 0, 2)), shifted(u, Vec3(0.25, 0, 2))},
                                     {shifted(t, Vec3(0.25, 0.125, 5))},
                                     {shifted(t, Vec3(6, 0, 5)), shifted(u, Vec3(6, 0, 5)),
                                      shifted(t, Vec3(7, 0, 5)), shifted(t, Vec3(8, 0, 5.5))},
                                     {}});
  scene.objects[3].self = true;
  return scene;
}

enum class Outcome : std::uint8_t { proved, refuted, not_proved, error };

std::ostream& operator<<(std::ostream& out, Outcome outcome) {
  return out << std::array{"proved", "refuted", "not proved", "error"}[static_cast<int>(outcome)];
}

Outcome outcome_of(const std::string& text, const Scene& scene) {
  try {
    const DistanceCheck result =
        check_distances(parse_distance_certificate(text, "forged"), scene, "forged");
    EXPECT_EQ(result.reason.empty(), result.verdict == Verdict::proved);
    return result.verdict == Verdict::proved    ? Outcome::proved
           : result.verdict == Verdict::refuted ? Outcome::refuted
                                                : Outcome::not_proved;
  } catch (const Error& error) {
    EXPECT_FALSE(error.reason.empty() || error.remedy.empty());
    return Outcome::error;
  }
}

Json listing(std::array<int, 2> objects, std::array<int, 2> triangles, const char* squared,
             std::array<const char*, 2> features) {
  return {{"objects", objects},
          {"triangles", triangles},
          {"squared", squared},
          {"features", features},
          {"inside", nullptr}};
}

/// Changes the JSON of certificates of one scene, and counts the kinds of changes.
class Forger {
 public:
  Forger() : right(make_scene()) {}

  Json json(Pairs pairs, double within, std::uint64_t k = 0) const {
    return Json::parse(to_text(right.certificate(pairs, within, k)));
  }
  void expect(const std::string& name, Outcome outcome, Json json,
              const std::function<void(Json&)>& forge) {
    SCOPED_TRACE(name);
    ASSERT_EQ(outcome_of(json.dump(), right.scene), Outcome::proved);
    const Json before = json;
    forge(json);
    ASSERT_NE(json, before);
    EXPECT_TRUE(names_.insert(name).second) << "a name twice";
    EXPECT_EQ(outcome_of(json.dump(), right.scene), outcome);
  }
  void expect_text(const std::string& name, Outcome outcome, const std::string& text) {
    EXPECT_TRUE(names_.insert(name).second) << "a name twice";
    EXPECT_EQ(outcome_of(text, right.scene), outcome) << name;
  }
  std::size_t kinds() const { return names_.size(); }

  const Distances right;

 private:
  std::set<std::string> names_;
};

/// Of the entry of these objects.
Json& entry(Json& json, unsigned a, unsigned b) {
  for (Json& one : json["distances"])
    if (one["objects"] == Json{a, b}) return one;
  throw std::logic_error("no such entry");
}

void forge_claims(Forger& f) {
  const Json objects = f.json(Pairs::objects, kInfinity);
  const auto squared = [](const char* to) {
    return [to](Json& j) { entry(j, 0, 1)["squared"] = to; };
  };
  f.expect("a larger numerator", Outcome::refuted, objects, squared("5/1"));
  f.expect("a smaller numerator", Outcome::refuted, objects, squared("3/1"));
  f.expect("a larger denominator", Outcome::refuted, objects, squared("4/3"));
  f.expect("zero", Outcome::refuted, objects, squared("0/1"));
  f.expect("larger by 2^-200", Outcome::refuted, objects,
           squared("6427752177035961102167848369364650410088811975131171341205505/"
                   "1606938044258990275541962092341162602522202993782792835301376"));
  f.expect("a very large numerator", Outcome::refuted, objects,
           [](Json& j) { entry(j, 0, 1)["squared"] = std::string(4000, '9') + "/1"; });
  f.expect("the root", Outcome::refuted, objects, squared("2/1"));
  f.expect("vertex for face", Outcome::not_proved, objects,
           [](Json& j) { entry(j, 0, 1)["features"][1] = "vertex 0"; });
  f.expect("features exchanged", Outcome::not_proved, objects, [](Json& j) {
    Json& features = entry(j, 0, 1)["features"];
    std::swap(features[0], features[1]);
  });
  f.expect("an edge that holds the vertex", Outcome::not_proved, objects, [](Json& j) {
    Json& feature = entry(j, 0, 1)["features"][0];
    feature = "edge " + feature.get<std::string>().substr(7);
  });
  f.expect("a farther pair with its distance", Outcome::refuted, objects, [](Json& j) {
    j["distances"][2] = listing({0, 3}, {0, 3}, "317/4", {"vertex 1", "vertex 0"});
  });
  f.expect("another pair that is as near", Outcome::not_proved, objects, [&](Json& j) {
    const DistanceEntry other = f.right.entry({1, 3});
    EXPECT_EQ(other.squared, entry(j, 0, 1)["squared"]);
    entry(j, 0, 1)["triangles"] = other.triangles;
    entry(j, 0, 1)["features"] = {feature_text(other.features[0]), feature_text(other.features[1])};
  });
  f.expect("the objects of a pair exchanged", Outcome::refuted, objects, [](Json& j) {
    Json& one = entry(j, 0, 1);
    std::swap(one["objects"][0], one["objects"][1]);
    std::swap(one["triangles"][0], one["triangles"][1]);
    std::swap(one["features"][0], one["features"][1]);
  });
  f.expect("two distances exchanged", Outcome::refuted, objects,
           [](Json& j) { std::swap(entry(j, 0, 1)["squared"], entry(j, 1, 2)["squared"]); });
  f.expect("one object twice", Outcome::not_proved, objects, [](Json& j) {
    j["distances"].insert(j["distances"].begin(),
                          listing({0, 0}, {0, 1}, "0/1", {"vertex 1", "vertex 1"}));
  });
}

// Of objects 0 and 1, whose boxes do not hold each other.
void forge_insides(Forger& f) {
  Json objects = f.json(Pairs::objects, kInfinity);
  entry(objects, 0, 1)["inside"] = "none";
  for (const char* const claim : {"a", "b", "not closed"}) {
    f.expect(std::string("inside: ") + claim, Outcome::refuted, objects,
             [&](Json& j) { entry(j, 0, 1)["inside"] = claim; });
  }
  f.expect("inside of one object", Outcome::not_proved, objects,
           [](Json& j) { entry(j, 3, 3)["inside"] = "none"; });
  f.expect("inside of triangles", Outcome::not_proved, f.json(Pairs::all, 2),
           [](Json& j) { j["distances"][0]["inside"] = "none"; });
}

void forge_completeness(Forger& f) {
  const Json objects = f.json(Pairs::objects, kInfinity);
  const Json within = f.json(Pairs::objects, 3);
  const Json nearest = f.json(Pairs::nearest, kInfinity, 1);
  const Json all = f.json(Pairs::all, 2);
  const auto erase_first = [](Json& j) { j["distances"].erase(0); };
  f.expect("two objects left out", Outcome::refuted, objects, erase_first);
  f.expect("nothing listed", Outcome::refuted, objects,
           [](Json& j) { j["distances"] = Json::array(); });
  f.expect("two objects within D left out", Outcome::refuted, within, erase_first);
  f.expect("one of the nearest left out", Outcome::refuted, nearest, erase_first);
  f.expect("a pair of triangles left out", Outcome::refuted, all, erase_first);
  f.expect("the last pair of triangles left out", Outcome::refuted, all,
           [](Json& j) { j["distances"].erase(j["distances"].size() - 1); });
  f.expect("objects beyond D", Outcome::refuted, within,
           [&](Json& j) { j["distances"] = objects["distances"]; });
  f.expect("a smaller D", Outcome::refuted, within, [](Json& j) { j["query"]["within"] = 2.5; });
  f.expect("a larger D", Outcome::refuted, within, [](Json& j) { j["query"]["within"] = 1e300; });
  f.expect("no D", Outcome::refuted, within, [](Json& j) { j["query"]["within"] = nullptr; });
  f.expect("a smaller D for triangles", Outcome::refuted, all,
           [](Json& j) { j["query"]["within"] = 1.875; });
  f.expect("a larger D for triangles", Outcome::refuted, all,
           [](Json& j) { j["query"]["within"] = 5; });
  f.expect("k raised", Outcome::refuted, nearest, [](Json& j) { j["query"]["k"] = 2; });
  f.expect("k reduced", Outcome::refuted, f.json(Pairs::nearest, kInfinity, 3),
           [](Json& j) { j["query"]["k"] = 1; });
  f.expect("k as large as can be", Outcome::refuted, nearest,
           [](Json& j) { j["query"]["k"] = ~std::uint64_t{0}; });
  f.expect("objects that are not nearest", Outcome::refuted, nearest,
           [&](Json& j) { j["distances"] = objects["distances"]; });
  f.expect("nearest called all objects", Outcome::refuted, nearest, [](Json& j) {
    j["query"] = {{"pairs", "objects"}, {"k", nullptr}, {"within", nullptr}};
  });
  f.expect("objects called all triangles", Outcome::refuted, within,
           [](Json& j) { j["query"]["pairs"] = "all"; });
  f.expect("an entry twice", Outcome::not_proved, objects,
           [](Json& j) { j["distances"].insert(j["distances"].begin(), j["distances"][0]); });
  f.expect("an entry twice, of triangles", Outcome::not_proved, all,
           [](Json& j) { j["distances"].push_back(j["distances"].back()); });
  f.expect("two entries exchanged", Outcome::not_proved, objects,
           [](Json& j) { std::swap(j["distances"][0], j["distances"][1]); });
  f.expect("neighbours", Outcome::not_proved, all, [](Json& j) {
    j["distances"].insert(j["distances"].end() - 1,
                          listing({3, 3}, {0, 1}, "0/1", {"vertex 1", "vertex 1"}));
  });
  f.expect("inside an object that is not self", Outcome::not_proved, all, [](Json& j) {
    j["distances"].insert(j["distances"].begin(),
                          listing({0, 0}, {0, 1}, "0/1", {"vertex 1", "vertex 1"}));
  });
  f.expect("a triangle and itself", Outcome::not_proved, all, [](Json& j) {
    j["distances"].push_back(listing({3, 3}, {3, 3}, "0/1", {"vertex 0", "vertex 0"}));
  });
}

void forge_form(Forger& f) {
  const Json objects = f.json(Pairs::objects, kInfinity);
  const auto bad = [&](const std::string& name, const std::function<void(Json&)>& forge) {
    f.expect(name, Outcome::error, objects, forge);
  };
  for (const char* text : {"4/-1", "-4/1", "4/0", "0/0", "4", "4/1/1", "8/2", "4.0/1", "4e0/1",
                           "04/1", "four", "", "/", " 4/1", "+4/1", "0x4/1", "inf", "nan"}) {
    bad(std::string("the square '") + text + "'",
        [&](Json& j) { j["distances"][0]["squared"] = text; });
  }
  bad("a numerator too long",
      [](Json& j) { j["distances"][0]["squared"] = std::string(100'000, '9') + "/1"; });
  bad("the square as a number", [](Json& j) { j["distances"][0]["squared"] = 4; });
  const auto other = [&](const std::string& name, const std::function<void(Json&)>& forge) {
    f.expect(name, Outcome::not_proved, objects, forge);
  };
  other("another hash", [](Json& j) { j["scene"]["hash"] = "0123456789abcdef"; });
  other("more objects", [](Json& j) { j["scene"]["objects"] = 6; });
  other("fewer triangles", [](Json& j) { j["scene"]["triangles"] = 8; });
  bad("a hash of 15 digits", [](Json& j) { j["scene"]["hash"] = "0123456789abcde"; });
  bad("an object out of range", [](Json& j) { j["distances"][0]["objects"][1] = 5; });
  bad("a triangle out of range", [](Json& j) { j["distances"][0]["triangles"][0] = 2; });
  bad("a triangle of an empty object", [](Json& j) { j["distances"][0]["objects"][1] = 4; });
  bad("a negative object", [](Json& j) { j["distances"][0]["objects"][0] = -1; });
  bad("an object of 2^32", [](Json& j) { j["distances"][0]["objects"][0] = 4294967296; });
  bad("a triangle of 0.5", [](Json& j) { j["distances"][0]["triangles"][0] = 0.5; });
  bad("three triangles", [](Json& j) { j["distances"][0]["triangles"] = {0, 0, 0}; });
  bad("a feature that there is not",
      [](Json& j) { j["distances"][0]["features"][0] = "vertex 3"; });
  bad("a feature as a number", [](Json& j) { j["distances"][0]["features"][0] = 0; });
  bad("one feature", [](Json& j) { j["distances"][0]["features"].erase(0); });
  bad("a key too many", [](Json& j) { j["distances"][0]["depth"] = true; });
  bad("an inside that there is not", [](Json& j) { j["distances"][0]["inside"] = "c"; });
  bad("an inside that is no text", [](Json& j) { j["distances"][0]["inside"] = true; });
  bad("no inside", [](Json& j) { j["distances"][0].erase("inside"); });
  bad("a key missing", [](Json& j) { j["distances"][0].erase("features"); });
  bad("another version", [](Json& j) { j["version"] = 1; });
  bad("another format", [](Json& j) { j["format"] = "farcull-certificate"; });
  bad("another kind of query", [](Json& j) { j["query"]["pairs"] = "some"; });
  bad("a k without nearest", [](Json& j) { j["query"]["k"] = 1; });
  bad("nearest without k", [](Json& j) { j["query"]["pairs"] = "nearest"; });
  bad("nearest with k = 0", [](Json& j) {
    j["query"]["pairs"] = "nearest";
    j["query"]["k"] = 0;
  });
  bad("a negative D", [](Json& j) { j["query"]["within"] = -1; });
  bad("all without D", [](Json& j) { j["query"]["pairs"] = "all"; });
  bad("distances as an object", [](Json& j) { j["distances"] = Json::object(); });
  bad("deep nesting", [](Json& j) {
    for (int n = 0; n < 20; ++n) j["distances"] = Json::array({j["distances"]});
  });
  const std::string text = objects.dump();
  f.expect_text("a truncated text", Outcome::error, text.substr(0, text.size() - 1));
  f.expect_text("half a text", Outcome::error, text.substr(0, text.size() / 2));
  f.expect_text("no text", Outcome::error, "");
  f.expect_text("a text twice", Outcome::error, text + text);
  f.expect_text("a key twice", Outcome::error, "{\"version\":1," + text.substr(1));
}

TEST(DistanceCertificate, ForgeriesOfFiftyKindsAreNotProved) {
  Forger forger;
  forge_claims(forger);
  forge_insides(forger);
  forge_completeness(forger);
  forge_form(forger);
  EXPECT_GE(forger.kinds(), 50u);
}

// Of 250,000 pairs that all refute it, the first ones suffice.
TEST(DistanceCertificate, IsRefutedByTheFirstPairsThatAreTooNear) {
  const reference::Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::vector<reference::Triangle> many(500, t);
  const Scene scene = reference::scene_of({many, many});
  const DistanceCertificate none{
      .scene = key_of(scene), .pairs = Pairs::objects, .within = 1, .distances = {}};
  const DistanceCheck result = distance_case::check(none, scene);
  EXPECT_EQ(result.verdict, Verdict::refuted);
  EXPECT_EQ(result.squared, "0/1");
  EXPECT_LT(result.decided, 100'000u);
}

// The scene changes under a certificate, which is given the new scene's hash.
TEST(DistanceCertificate, ANearerPairInTheSceneIsNamedWithItsDistance) {
  Scene scene = make_scene();
  DistanceCertificate c = Distances(scene).certificate(Pairs::objects, kInfinity);
  // Triangle 1 of object 1, which is not the one that is named, comes nearer.
  for (const std::uint32_t v : scene.triangles[3]) scene.vertices[v].z() = 1.5;
  c.scene.hash = scene_hash(scene);
  const DistanceCheck result = distance_case::check(c, scene);
  EXPECT_EQ(result.verdict, Verdict::refuted);
  EXPECT_EQ(result.pair, (TrianglePair{0, 3}));
  EXPECT_EQ(result.squared, "73/32");  // 1.5 above, and 0.25 / sqrt(2) beside
  EXPECT_EQ(result.reason, "distances[0]: these triangles of the two objects are nearer");
  EXPECT_EQ(
      distance_case::check(Distances(scene).certificate(Pairs::objects, kInfinity), scene).verdict,
      Verdict::proved);
}

}  // namespace
}  // namespace farcull
