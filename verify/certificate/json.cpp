// Certificates as JSON. The reader does not trust the text: a first pass checks only the syntax.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "verify/certificate/certificate.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "farcull-certificate";
// Version 4 adds a clearance to version 3. Version 5 adds a tile to version 4.
constexpr std::uint64_t kVersion = 3, kVersionWithClearance = 4, kVersionOfTile = 5;
constexpr const char* kRemedy =
    "give a file that `{run} ... {certificate}` wrote; docs/certificate.md is the format";

/// Checks only the syntax. Limits the number of values and the depth of nesting before any value is
/// built, so that memory is O(text).
class Syntax : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return count(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool start_object(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool key(string_t& name) override {
    if (keys_.back().insert(name).second) return true;
    return stop("the key '" + printable(name, 40) + "' occurs twice");
  }
  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::json::exception& error) override {
    // The end of the message quotes the text of the file, so it is cut off.
    const std::string_view fault = json_fault(error.what());
    return stop("not JSON at byte " + std::to_string(position) + ": " +
                printable(fault.substr(0, fault.find("; last read")), 120));
  }

  std::string reason;  // why parsing stopped

 private:
  bool stop(std::string why) {
    reason = std::move(why);
    return false;
  }
  bool count() {
    constexpr std::uint64_t kMostValues = 10'000;  // all arrays in a certificate are short
    return ++values_ <= kMostValues || stop("more values than any certificate has");
  }
  bool enter() {
    constexpr std::size_t kDeepest = 8;
    if (keys_.size() == kDeepest) return stop("nested deeper than any certificate is");
    keys_.emplace_back();
    return count();
  }
  bool leave() {
    keys_.pop_back();
    return true;
  }

  std::uint64_t values_ = 0;
  std::vector<std::set<std::string>> keys_;  // keys of each enclosing object; empty for arrays
};

/// Reads the values of a JSON object by their keys. If a value has the wrong type, throws Error
/// naming the file and the path of the value, such as unattested.views[1].width.
class Reader {
 public:
  /// name: the file. place: the path of the object; empty for the top-level object. Throws Error
  /// unless the value is an object with exactly these keys.
  Reader(const std::string& name, const Json& object, const std::string& place,
         const std::vector<const char*>& keys)
      : name_(name), object_(object), in_(place.empty() ? "" : place + ".") {
    if (!object.is_object()) fail(place + " is no object");
    for (const char* key : keys) {
      if (!object.contains(key)) fail(in_ + key + " is missing");
    }
    for (const auto& item : object.items()) {
      if (std::ranges::find(keys, item.key()) == keys.end())
        fail("the key '" + in_ + printable(item.key(), 40) + "' is unknown");
    }
  }

  [[noreturn]] void fail(const std::string& reason) const { throw Error(name_, reason, kRemedy); }
  const Json& operator[](const char* key) const { return object_[key]; }

  Reader object(const char* key, const std::vector<const char*>& keys) const {
    return object(object_[key], in_ + key, keys);
  }
  Reader object(const Json& value, const std::string& place,
                const std::vector<const char*>& keys) const {
    return {name_, value, place, keys};
  }
  /// Calls visit(value, place) for each value of an array.
  void each(const char* key, const auto& visit) const {
    if (!object_[key].is_array()) fail(in_ + key + " is no array");
    std::size_t k = 0;
    for (const Json& value : object_[key])
      visit(value, in_ + key + "[" + std::to_string(k++) + "]");
  }
  std::string text(const char* key) const { return text(object_[key], in_ + key); }
  std::string text(const Json& value, const std::string& place) const {
    if (!value.is_string()) fail(place + " is no string");
    return value.get<std::string>();
  }
  std::uint64_t count(const char* key) const {
    if (!object_[key].is_number_unsigned())
      fail(in_ + key + " is no whole number from 0 to 2^64 - 1");
    return object_[key].get<std::uint64_t>();
  }
  std::string digits(const char* key, std::size_t size) const {
    std::string out = text(key);
    if (out.size() != size || out.find_first_not_of("0123456789abcdef") != out.npos)
      fail(in_ + key + " is not " + std::to_string(size) + " lower-case hexadecimal digits");
    return out;
  }
  double length(const char* key) const {
    const double x = object_[key].is_number() ? object_[key].get<double>() : -1;
    if (!(x >= 0) || !std::isfinite(x)) fail(in_ + key + " is no finite number of 0 or more");
    return x;
  }

 private:
  const std::string& name_;
  const Json& object_;
  std::string in_;
};

Certificate::Run read_run(const Reader& in) {
  Certificate::Run run;
  run.method = in.text("method");
  run.resolution = in.count("resolution");
  run.radius_px = in.length("radius_px");
  run.offset = in.text("offset");
  in.each("views", [&](const Json& value, const std::string& place) {
    const Reader view = in.object(value, place, {"name", "width", "height", "radius_px"});
    run.views.push_back(
        {view.text("name"), view.count("width"), view.count("height"), view.length("radius_px")});
  });
  if (!in["device"].is_null()) {
    const Reader device = in.object("device", {"vendor", "renderer", "version", "glsl"});
    run.device = {device.text("vendor"), device.text("renderer"), device.text("version"),
                  device.text("glsl")};
  }
  in.each("assumptions", [&](const Json& value, const std::string& place) {
    run.assumptions.push_back(in.text(value, place));
  });
  return run;
}

constexpr std::string_view kAxes = "xyz";

Tile read_tile(const Reader& in) {
  const std::string axis = in.text("axis");
  if (axis.size() != 1 || kAxes.find(axis) == kAxes.npos) in.fail("tile.axis is not x, y or z");
  Tile tile{.axis = static_cast<int>(kAxes.find(axis))};
  const auto place = [&](const char* key, double& to) {
    const Json& at = in[key];
    if (at.is_null()) return;
    if (!at.is_number() || !std::isfinite(at.get<double>()))
      in.fail(std::string("tile.") + key + " is no finite number and not null");
    to = at.get<double>();
  };
  place("from", tile.from);
  place("to", tile.to);
  // If a tile could end before its beginning, consecutive tiles could cover a place twice.
  if (!(tile.from <= tile.to)) in.fail("tile.to is less than tile.from");
  return tile;
}

double finite(double length) {
  if (!std::isfinite(length)) throw std::logic_error("to_text: a length that is not finite");
  return length;
}

}  // namespace

std::string to_text(const Certificate& certificate) {
  const Certificate::Run& run = certificate.run;
  Json views = Json::array();
  for (const Certificate::View& view : run.views) {
    views.push_back({{"name", view.name},
                     {"width", view.width},
                     {"height", view.height},
                     {"radius_px", finite(view.radius_px)}});
  }
  Json device = nullptr;
  if (run.device) {
    device = {{"vendor", run.device->vendor},
              {"renderer", run.device->renderer},
              {"version", run.device->version},
              {"glsl", run.device->glsl}};
  }
  const std::uint64_t version = certificate.tile            ? kVersionOfTile
                                : certificate.clearance > 0 ? kVersionWithClearance
                                                            : kVersion;
  const Certificate::SceneKey& scene = certificate.scene;
  Json json = {{"format", kFormat},
               {"version", version},
               {"scene",
                {{"name", scene.name},
                 {"objects", scene.objects},
                 {"triangles", scene.triangles},
                 {"hash", scene.hash}}}};
  if (version > kVersion) json["clearance"] = finite(certificate.clearance);
  if (const std::optional<Tile>& tile = certificate.tile) {
    const auto place = [](double at) { return std::isfinite(at) ? Json(at) : Json(nullptr); };
    json["tile"] = {{"axis", std::string(1, kAxes[static_cast<std::size_t>(tile->axis)])},
                    {"from", place(tile->from)},
                    {"to", place(tile->to)}};
  }
  json["not_asked"] = {{"objects", certificate.not_asked.objects},
                       {"pairs", certificate.not_asked.pairs}};
  for (const auto& [name, count] : kClaims) json["claims"][name] = certificate.claims.*count;
  json["list_sha256"] = certificate.list_sha256;
  json["unattested"] = {{"method", run.method},
                        {"resolution", run.resolution},
                        {"radius_px", finite(run.radius_px)},
                        {"offset", run.offset},
                        {"views", std::move(views)},
                        {"device", std::move(device)},
                        {"assumptions", Json(run.assumptions)}};
  json["evidence"] = to_base64(certificate.evidence);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Certificate parse_certificate(std::string_view text, const std::string& name) {
  const auto fail = [&](const std::string& reason) { throw Error(name, reason, kRemedy); };
  // The parser would end the text at a zero byte.
  if (text.find('\0') != text.npos) fail("is not JSON, which has no byte 0");
  Syntax syntax;
  if (!Json::sax_parse(text.begin(), text.end(), &syntax)) fail(syntax.reason);
  const Json json = Json::parse(text.begin(), text.end());
  // Format and version are checked before the keys, since another version has other keys.
  if (!json.is_object()) fail("the certificate is no object");
  if (json.value("format", Json()) != kFormat) fail(std::string("format is not ") + kFormat);
  const Json version = json.value("version", Json());
  const bool tile = version == kVersionOfTile, clearance = tile || version == kVersionWithClearance;
  if (!version.is_number_unsigned() || (version != kVersion && !clearance))
    fail("version is not 3, 4 or 5");
  std::vector<const char*> keys = {"format", "version",     "scene",      "not_asked",
                                   "claims", "list_sha256", "unattested", "evidence"};
  if (clearance) keys.push_back("clearance");
  if (tile) keys.push_back("tile");
  const Reader root(name, json, "", keys);
  Certificate certificate;
  if (tile) certificate.tile = read_tile(root.object("tile", {"axis", "from", "to"}));
  if (clearance) certificate.clearance = root.length("clearance");
  if (clearance && !tile && certificate.clearance == 0)
    fail("clearance is 0, which version 3 is for");
  const Reader scene = root.object("scene", {"name", "objects", "triangles", "hash"});
  certificate.scene = {scene.text("name"), scene.count("objects"), scene.count("triangles"),
                       scene.digits("hash", 16)};
  const Reader not_asked = root.object("not_asked", {"objects", "pairs"});
  certificate.not_asked = {not_asked.count("objects"), not_asked.count("pairs")};
  const Reader claims =
      root.object("claims", {"box_pairs", "kept", "culled", "separated", "neighbours", "meeting"});
  for (const auto& [key, count] : kClaims) certificate.claims.*count = claims.count(key);
  certificate.list_sha256 = root.digits("list_sha256", 64);
  certificate.run =
      read_run(root.object("unattested", {"method", "resolution", "radius_px", "offset", "views",
                                          "device", "assumptions"}));
  auto evidence = from_base64(root.text("evidence"));
  if (!evidence) fail("evidence is not base64 (padded, without line breaks)");
  certificate.evidence = std::move(*evidence);
  return certificate;
}

}  // namespace farcull
