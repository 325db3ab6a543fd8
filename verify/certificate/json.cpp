// Certificates as text. The reader does not trust the text: a first pass checks the syntax alone.
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
// Version 4 is version 3 with a clearance, and version 5 is version 4 with a tile.
constexpr std::uint64_t kVersion = 3, kVersionWithClearance = 4, kVersionOfTile = 5;
constexpr const char* kRemedy =
    "give a file that `{run} ... {certificate}` wrote; docs/certificate.md is the format";

/// The text as printable ASCII of at most `most` characters, for a message.
std::string printable(std::string_view text, std::size_t most) {
  std::string out;
  for (const char c : text.substr(0, most)) out += c >= ' ' && c <= '~' ? c : '?';
  if (text.size() > most) out += "...";
  return out;
}

/// Reads the syntax alone. Bounds the number of values and the depth before anything is built, so
/// that memory stays in proportion to the text.
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
    // Cuts off the end of the message, which quotes the text of the file.
    const std::string_view fault = json_fault(error.what());
    return stop("not JSON at byte " + std::to_string(position) + ": " +
                printable(fault.substr(0, fault.find("; last read")), 120));
  }

  std::string reason;  // why it stopped

 private:
  bool stop(std::string why) {
    reason = std::move(why);
    return false;
  }
  bool count() {
    constexpr std::uint64_t kMostValues = 10'000;  // views and assumptions are few
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
  std::vector<std::set<std::string>> keys_;  // of each enclosing object; empty for arrays
};

/// Functions that read values. place: the path of the value, as in unattested.views[1].width. Each
/// function throws Error naming the file if the value is of another kind.
class Reader {
 public:
  /// name: the name of the file.
  explicit Reader(const std::string& name) : name_(name) {}

  [[noreturn]] void fail(const std::string& reason) const { throw Error(name_, reason, kRemedy); }

  /// Parses the whole text as one JSON value.
  Json parse(std::string_view text) const {
    if (text.find('\0') != text.npos)
      fail("is not JSON, which has no byte 0");  // the parser would stop there
    Syntax syntax;
    if (!Json::sax_parse(text.begin(), text.end(), &syntax)) fail(syntax.reason);
    return Json::parse(text.begin(), text.end());
  }

  /// Throws unless the value is an object with exactly these keys.
  void object(const Json& value, const std::string& place,
              const std::vector<const char*>& keys) const {
    const std::string of = place.empty() ? "" : place + ".";
    if (!value.is_object()) fail((place.empty() ? "the certificate" : place) + " is no object");
    for (const char* key : keys) {
      if (!value.contains(key)) fail(of + key + " is missing");
    }
    for (const auto& item : value.items()) {
      if (std::ranges::find(keys, item.key()) == keys.end())
        fail("the key '" + of + printable(item.key(), 40) + "' is unknown");
    }
  }
  const Json& array(const Json& value, const std::string& place) const {
    if (!value.is_array()) fail(place + " is no array");
    return value;
  }
  std::string text(const Json& value, const std::string& place) const {
    if (!value.is_string()) fail(place + " is no string");
    return value.get<std::string>();
  }
  std::uint64_t count(const Json& value, const std::string& place) const {
    if (!value.is_number_unsigned()) fail(place + " is no whole number from 0 to 2^64 - 1");
    return value.get<std::uint64_t>();
  }
  std::string digits(const Json& value, std::size_t size, const std::string& place) const {
    std::string out = text(value, place);
    if (out.size() != size || out.find_first_not_of("0123456789abcdef") != out.npos)
      fail(place + " is not " + std::to_string(size) + " lower-case hexadecimal digits");
    return out;
  }
  double length(const Json& value, const std::string& place) const {
    const double x = value.is_number() ? value.get<double>() : -1;
    if (!(x >= 0) || !std::isfinite(x)) fail(place + " is no finite number of 0 or more");
    return x;
  }

 private:
  const std::string& name_;
};

Certificate::SceneKey read_scene_key(const Reader& reader, const Json& value) {
  reader.object(value, "scene", {"name", "objects", "triangles", "hash"});
  return {reader.text(value["name"], "scene.name"), reader.count(value["objects"], "scene.objects"),
          reader.count(value["triangles"], "scene.triangles"),
          reader.digits(value["hash"], 16, "scene.hash")};
}

Certificate::Unasked read_not_asked(const Reader& reader, const Json& value) {
  reader.object(value, "not_asked", {"objects", "pairs"});
  return {reader.count(value["objects"], "not_asked.objects"),
          reader.count(value["pairs"], "not_asked.pairs")};
}

Certificate::Claims read_claims(const Reader& reader, const Json& value) {
  reader.object(value, "claims",
                {"box_pairs", "kept", "culled", "separated", "neighbours", "meeting"});
  return {reader.count(value["box_pairs"], "claims.box_pairs"),
          reader.count(value["kept"], "claims.kept"),
          reader.count(value["culled"], "claims.culled"),
          reader.count(value["separated"], "claims.separated"),
          reader.count(value["neighbours"], "claims.neighbours"),
          reader.count(value["meeting"], "claims.meeting")};
}

Certificate::Run read_run(const Reader& reader, const Json& value) {
  const std::string in = "unattested.";
  reader.object(value, "unattested",
                {"method", "resolution", "radius_px", "offset", "views", "device", "assumptions"});
  Certificate::Run run;
  run.method = reader.text(value["method"], in + "method");
  run.resolution = reader.count(value["resolution"], in + "resolution");
  run.radius_px = reader.length(value["radius_px"], in + "radius_px");
  run.offset = reader.text(value["offset"], in + "offset");
  for (const Json& view : reader.array(value["views"], in + "views")) {
    const std::string place = in + "views[" + std::to_string(run.views.size()) + "]";
    reader.object(view, place, {"name", "width", "height", "radius_px"});
    run.views.push_back({reader.text(view["name"], place + ".name"),
                         reader.count(view["width"], place + ".width"),
                         reader.count(view["height"], place + ".height"),
                         reader.length(view["radius_px"], place + ".radius_px")});
  }
  if (const Json& device = value["device"]; !device.is_null()) {
    reader.object(device, in + "device", {"vendor", "renderer", "version", "glsl"});
    run.device = {reader.text(device["vendor"], in + "device.vendor"),
                  reader.text(device["renderer"], in + "device.renderer"),
                  reader.text(device["version"], in + "device.version"),
                  reader.text(device["glsl"], in + "device.glsl")};
  }
  for (const Json& line : reader.array(value["assumptions"], in + "assumptions")) {
    run.assumptions.push_back(
        reader.text(line, in + "assumptions[" + std::to_string(run.assumptions.size()) + "]"));
  }
  return run;
}

constexpr std::string_view kAxes = "xyz";

Tile read_tile(const Reader& reader, const Json& value) {
  reader.object(value, "tile", {"axis", "from", "to"});
  const std::string axis = reader.text(value["axis"], "tile.axis");
  if (axis.size() != 1 || kAxes.find(axis) == kAxes.npos) reader.fail("tile.axis is not x, y or z");
  Tile tile{.axis = static_cast<int>(kAxes.find(axis))};
  const auto place = [&](const char* key, double& to) {
    const Json& at = value[key];
    if (at.is_null()) return;
    if (!at.is_number() || !std::isfinite(at.get<double>()))
      reader.fail(std::string("tile.") + key + " is no finite number and not null");
    to = at.get<double>();
  };
  place("from", tile.from);
  place("to", tile.to);
  // Tiles that run backwards could follow each other and cover places twice.
  if (!(tile.from <= tile.to)) reader.fail("tile.to is less than tile.from");
  return tile;
}

Json tile_json(const Tile& tile) {
  const auto place = [](double at) { return std::isfinite(at) ? Json(at) : Json(nullptr); };
  return {{"axis", std::string(1, kAxes[static_cast<std::size_t>(tile.axis)])},
          {"from", place(tile.from)},
          {"to", place(tile.to)}};
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
  if (certificate.tile) json["tile"] = tile_json(*certificate.tile);
  json["not_asked"] = {{"objects", certificate.not_asked.objects},
                       {"pairs", certificate.not_asked.pairs}};
  json["claims"] = {
      {"box_pairs", certificate.claims.box_pairs},   {"kept", certificate.claims.kept},
      {"culled", certificate.claims.culled},         {"separated", certificate.claims.separated},
      {"neighbours", certificate.claims.neighbours}, {"meeting", certificate.claims.meeting}};
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
  const Reader reader(name);
  const Json root = reader.parse(text);
  // Format and version are checked before the keys, since another version has other keys.
  if (!root.is_object()) reader.fail("the certificate is no object");
  if (root.value("format", Json()) != kFormat) reader.fail(std::string("format is not ") + kFormat);
  const Json version = root.value("version", Json());
  const bool tile = version == kVersionOfTile, clearance = tile || version == kVersionWithClearance;
  if (!version.is_number_unsigned() || (version != kVersion && !clearance))
    reader.fail("version is not 3, 4 or 5");
  Certificate certificate;
  std::vector<const char*> keys = {"format", "version",     "scene",      "not_asked",
                                   "claims", "list_sha256", "unattested", "evidence"};
  if (clearance) keys.push_back("clearance");
  if (tile) keys.push_back("tile");
  reader.object(root, "", keys);
  if (tile) certificate.tile = read_tile(reader, root["tile"]);
  if (clearance) certificate.clearance = reader.length(root["clearance"], "clearance");
  if (clearance && !tile && certificate.clearance == 0)
    reader.fail("clearance is 0, which version 3 is for");
  certificate.scene = read_scene_key(reader, root["scene"]);
  certificate.not_asked = read_not_asked(reader, root["not_asked"]);
  certificate.claims = read_claims(reader, root["claims"]);
  certificate.list_sha256 = reader.digits(root["list_sha256"], 64, "list_sha256");
  certificate.run = read_run(reader, root["unattested"]);
  auto evidence = from_base64(reader.text(root["evidence"], "evidence"));
  if (!evidence) reader.fail("evidence is not base64 (padded, without line breaks)");
  certificate.evidence = std::move(*evidence);
  return certificate;
}

}  // namespace farcull
