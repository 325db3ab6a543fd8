// Writes a certificate of distances as text, and reads it.
#include "verify/certificate/distance_certificate.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "verify/certificate/integers.h"
#include "verify/certificate/json.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;
using Pairs = DistanceCertificate::Pairs;

constexpr const char* kDistancesFormat = "farcull-distances";
constexpr std::uint64_t kDistancesVersion = 2;
constexpr const char* kDistancesRemedy =
    "give a file that `farcull distance ... --certificate` wrote; docs/certificate.md is the "
    "format";
constexpr std::uint8_t kFeatures = 7;

/// Two values of an array, each read by `read`.
template <class Value, class Read>
std::array<Value, 2> two(const JsonReader& reader, const Json& value, const std::string& place,
                         const Read& read) {
  if (reader.array(value, place).size() != 2) reader.fail(place + " has not two entries");
  return {read(value[0], place + "[0]"), read(value[1], place + "[1]")};
}

InsideClaim read_inside(const JsonReader& reader, const Json& value, const std::string& place) {
  const std::string text = reader.text(value, place);
  for (const InsideClaim claim :
       {InsideClaim::none, InsideClaim::a, InsideClaim::b, InsideClaim::not_closed}) {
    if (text == inside_text(claim)) return claim;
  }
  reader.fail(place + " is none of null, none, a, b and not closed");
}

DistanceEntry read_entry(const JsonReader& reader, const Json& value, const std::string& place) {
  reader.object(value, place, {"objects", "triangles", "squared", "features", "inside"});
  const auto index = [&](const Json& number, const std::string& at) {
    const std::uint64_t x = reader.count(number, at);
    if (x > std::numeric_limits<std::uint32_t>::max())
      reader.fail(at + " is no whole number below 2^32");
    return static_cast<std::uint32_t>(x);
  };
  const auto feature = [&](const Json& name, const std::string& at) {
    const std::string text = reader.text(name, at);
    for (std::uint8_t n = 0; n < kFeatures; ++n) {
      if (text == feature_text(n)) return n;
    }
    reader.fail(at + " is none of vertex 0 to 2, edge 0 to 2 and face");
  };
  DistanceEntry entry;
  entry.objects = two<std::uint32_t>(reader, value["objects"], place + ".objects", index);
  entry.triangles = two<std::uint32_t>(reader, value["triangles"], place + ".triangles", index);
  entry.squared = reader.text(value["squared"], place + ".squared");
  if (!parse_fraction(entry.squared)) {
    reader.fail(place + ".squared is no fraction of 0 or more in lowest terms, with at most " +
                std::to_string(kMostDigits) + " digits in each part");
  }
  entry.features = two<std::uint8_t>(reader, value["features"], place + ".features", feature);
  if (const Json& inside = value["inside"]; !inside.is_null())
    entry.inside = read_inside(reader, inside, place + ".inside");
  return entry;
}

void read_query(const JsonReader& reader, const Json& value, DistanceCertificate& to) {
  reader.object(value, "query", {"pairs", "k", "within"});
  const std::string pairs = reader.text(value["pairs"], "query.pairs");
  const std::array all = {Pairs::objects, Pairs::nearest, Pairs::all};
  const auto* const found =
      std::ranges::find_if(all, [&](Pairs one) { return to_string(one) == pairs; });
  if (found == all.end()) reader.fail("query.pairs is none of objects, nearest and all");
  to.pairs = *found;
  if (to.pairs == Pairs::nearest) {
    to.k = reader.count(value["k"], "query.k");
    if (to.k == 0) reader.fail("query.k is 0");
  } else if (!value["k"].is_null()) {
    reader.fail("query.k is not null, and goes with pairs nearest alone");
  }
  if (!value["within"].is_null()) to.within = reader.length(value["within"], "query.within");
  if (to.pairs == Pairs::all && !std::isfinite(to.within))
    reader.fail("query.within is null, and pairs all needs a length");
}

}  // namespace

std::string to_string(DistanceCertificate::Pairs pairs) {
  switch (pairs) {
    case Pairs::objects:
      return "objects";
    case Pairs::nearest:
      return "nearest";
    case Pairs::all:
      break;
  }
  return "all";
}

std::string inside_text(InsideClaim inside) {
  switch (inside) {
    case InsideClaim::unknown:
      break;
    case InsideClaim::none:
      return "none";
    case InsideClaim::a:
      return "a";
    case InsideClaim::b:
      return "b";
    case InsideClaim::not_closed:
      return "not closed";
  }
  return "";
}

std::string feature_text(std::uint8_t feature) {
  if (feature >= kFeatures) throw std::logic_error("feature_text: no feature");
  if (feature == kFeatures - 1) return "face";
  return (feature < 3 ? "vertex " : "edge ") + std::to_string(feature % 3);
}

DistanceEntry entry_of(const Scene& scene, const TrianglePair& pair, std::string squared,
                       std::array<std::uint8_t, 2> features) {
  DistanceEntry entry;
  for (int side = 0; side < 2; ++side) {
    const std::uint32_t triangle = side == 0 ? pair.a : pair.b;
    if (triangle >= scene.triangles.size())
      throw std::logic_error("entry_of: a triangle that the scene does not have");
    // An object without triangles starts where the next object does, so the last one that starts at
    // or before the triangle owns it.
    const auto after =
        std::ranges::upper_bound(scene.objects, triangle, {}, &Object::first_triangle);
    entry.objects[side] = static_cast<std::uint32_t>(after - scene.objects.begin() - 1);
    entry.triangles[side] = triangle - scene.objects[entry.objects[side]].first_triangle;
  }
  entry.squared = std::move(squared);
  entry.features = features;
  return entry;
}

std::string to_text(const DistanceCertificate& certificate) {
  const bool nearest = certificate.pairs == Pairs::nearest;
  const bool bounded = std::isfinite(certificate.within);
  const Json head = {{"format", kDistancesFormat},
                     {"version", kDistancesVersion},
                     {"scene", scene_key_json(certificate.scene)},
                     {"query",
                      {{"pairs", to_string(certificate.pairs)},
                       {"k", nearest ? Json(certificate.k) : Json(nullptr)},
                       {"within", bounded ? Json(certificate.within) : Json(nullptr)}}}};
  std::string out = head.dump(2, ' ', false, Json::error_handler_t::replace);
  out.resize(out.size() - 2);  // without the end of the object
  out += ",\n  \"distances\": [";
  bool first = true;
  for (const DistanceEntry& entry : certificate.distances) {
    const Json line = {
        {"objects", entry.objects},
        {"triangles", entry.triangles},
        {"squared", entry.squared},
        {"features", {feature_text(entry.features[0]), feature_text(entry.features[1])}},
        {"inside",
         entry.inside == InsideClaim::unknown ? Json(nullptr) : Json(inside_text(entry.inside))}};
    out += std::exchange(first, false) ? "\n    " : ",\n    ";
    out += line.dump();
  }
  return out + (first ? "]\n}\n" : "\n  ]\n}\n");
}

DistanceCertificate parse_distance_certificate(std::string_view text, const std::string& name) {
  const JsonReader reader(name, kDistancesRemedy);
  // There may be very many answers, so the number of values is limited only by the text's length.
  const Json root = reader.parse(text, text.size());
  if (!root.is_object()) reader.fail("the certificate is no object");
  // Format and version are checked before the keys, since another version may have other keys.
  if (root.value("format", Json()) != kDistancesFormat)
    reader.fail(std::string("format is not ") + kDistancesFormat);
  if (const Json version = root.value("version", Json());
      !version.is_number_unsigned() || version != kDistancesVersion) {
    reader.fail("version is not " + std::to_string(kDistancesVersion));
  }
  reader.object(root, "", {"format", "version", "scene", "query", "distances"});
  DistanceCertificate certificate;
  certificate.scene = read_scene_key(reader, root["scene"]);
  read_query(reader, root["query"], certificate);
  for (const Json& entry : reader.array(root["distances"], "distances")) {
    certificate.distances.push_back(read_entry(
        reader, entry, "distances[" + std::to_string(certificate.distances.size()) + "]"));
  }
  return certificate;
}

bool is_distance_certificate(std::string_view text) {
  for (const std::string_view token : {"{", "\"format\"", ":", "\"farcull-distances\""}) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (!text.starts_with(token)) return false;
    text.remove_prefix(token.size());
  }
  return true;
}

}  // namespace farcull
