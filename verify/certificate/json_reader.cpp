// The readers of values, and the pass over the syntax.
#include "verify/certificate/json_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace farcull {

using Json = nlohmann::ordered_json;

std::string printable(std::string_view text, std::size_t most) {
  std::string out;
  for (const char c : text.substr(0, most)) out += c >= ' ' && c <= '~' ? c : '?';
  if (text.size() > most) out += "...";
  return out;
}

bool JsonSyntax::key(string_t& name) {
  if (keys_.back().insert(name).second) return true;
  return stop("the key '" + printable(name, 40) + "' occurs twice");
}

bool JsonSyntax::parse_error(std::size_t position, const std::string&,
                             const nlohmann::json::exception& error) {
  // The library's text between "...column 2: " and "; last read: '...'", which holds the text.
  std::string_view what = error.what();
  for (const std::string_view mark : {"] ", "column "}) {
    const std::size_t found = what.find(mark);
    if (found != std::string_view::npos) what.remove_prefix(found + mark.size());
  }
  const std::size_t number = what.find_first_not_of("0123456789");
  if (number != 0 && what.substr(std::min(number, what.size()), 2) == ": ")
    what.remove_prefix(number + 2);
  what = what.substr(0, what.find("; last read"));
  return stop("not JSON at byte " + std::to_string(position) + ": " + printable(what, 120));
}

bool JsonSyntax::stop(std::string why) {
  reason = std::move(why);
  return false;
}

bool JsonSyntax::count() {
  return ++values_ <= most_values_ || stop("more values than any certificate has");
}

bool JsonSyntax::enter() {
  constexpr std::size_t kDeepest = 8;
  if (keys_.size() == kDeepest) return stop("nested deeper than any certificate is");
  keys_.emplace_back();
  return count();
}

bool JsonSyntax::leave() {
  keys_.pop_back();
  return true;
}

Json JsonReader::parse(std::string_view text, std::uint64_t most_values) const {
  JsonSyntax syntax(most_values);
  if (!Json::sax_parse(text.begin(), text.end(), &syntax)) fail(syntax.reason);
  return Json::parse(text.begin(), text.end());
}

void JsonReader::fail(const std::string& reason) const { throw Error(name_, reason, remedy_); }

void JsonReader::object(const Json& value, const std::string& place,
                        std::initializer_list<const char*> keys) const {
  const std::string of = place.empty() ? "" : place + ".";
  if (!value.is_object()) fail((place.empty() ? "the certificate" : place) + " is no object");
  for (const char* key : keys) {
    if (!value.contains(key)) fail(of + key + " is missing");
  }
  if (value.size() == keys.size()) return;
  for (const auto& item : value.items()) {
    bool known = false;
    for (const char* key : keys) known = known || item.key() == key;
    if (!known) fail("the key '" + of + printable(item.key(), 40) + "' is unknown");
  }
}

const Json& JsonReader::array(const Json& value, const std::string& place) const {
  if (!value.is_array()) fail(place + " is no array");
  return value;
}

std::string JsonReader::text(const Json& value, const std::string& place) const {
  if (!value.is_string()) fail(place + " is no string");
  return value.get<std::string>();
}

std::uint64_t JsonReader::count(const Json& value, const std::string& place) const {
  if (!value.is_number_unsigned()) fail(place + " is no whole number from 0 to 2^64 - 1");
  return value.get<std::uint64_t>();
}

void JsonReader::digits(const std::string& text, std::size_t size, const std::string& place) const {
  if (text.size() != size || text.find_first_not_of("0123456789abcdef") != text.npos)
    fail(place + " is not " + std::to_string(size) + " lower-case hexadecimal digits");
}

double JsonReader::length(const Json& value, const std::string& place) const {
  const double x = value.is_number() ? value.get<double>() : -1;
  if (!(x >= 0) || !std::isfinite(x)) fail(place + " is no finite number of 0 or more");
  return x;
}

Certificate::SceneKey read_scene_key(const JsonReader& reader, const Json& value) {
  reader.object(value, "scene", {"name", "objects", "triangles", "hash"});
  Certificate::SceneKey scene{reader.text(value["name"], "scene.name"),
                              reader.count(value["objects"], "scene.objects"),
                              reader.count(value["triangles"], "scene.triangles"),
                              reader.text(value["hash"], "scene.hash")};
  reader.digits(scene.hash, 16, "scene.hash");
  return scene;
}

Json scene_key_json(const Certificate::SceneKey& scene) {
  return {{"name", scene.name},
          {"objects", scene.objects},
          {"triangles", scene.triangles},
          {"hash", scene.hash}};
}

}  // namespace farcull
