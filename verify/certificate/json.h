// Shared by the readers of certificates. The readers do not trust the text: a first pass over the
// syntax bounds the number of values and the depth before anything is built, so memory stays in
// proportion to the text. For the sources of this folder alone.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "verify/certificate/certificate.h"

namespace farcull {

/// The text as printable ASCII of at most `most` characters, for a message.
std::string printable(std::string_view text, std::size_t most);

/// Reads the syntax alone, and stops if the text has more values than a certificate can have.
class JsonSyntax : public nlohmann::json_sax<nlohmann::ordered_json> {
 public:
  /// most_values: how many values a certificate may have.
  explicit JsonSyntax(std::uint64_t most_values) : most_values_(most_values) {}

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
  bool key(string_t& name) override;
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::json::exception& error) override;

  std::string reason;  // why it stopped

 private:
  bool stop(std::string why);
  bool count();
  bool enter();
  bool leave();

  std::uint64_t most_values_;
  std::uint64_t values_ = 0;
  std::vector<std::set<std::string>> keys_;  // of each enclosing object; empty for arrays
};

/// Readers of values. place: where the value is, as in unattested.views[1].width. Each throws Error
/// naming the file if the value is of another kind.
class JsonReader {
 public:
  /// name: the file's name; remedy: what the Error advises.
  JsonReader(std::string name, std::string remedy)
      : name_(std::move(name)), remedy_(std::move(remedy)) {}

  /// Parses the whole text as one JSON value.
  nlohmann::ordered_json parse(std::string_view text, std::uint64_t most_values) const;

  [[noreturn]] void fail(const std::string& reason) const;
  /// Throws unless the value is an object with exactly these keys.
  void object(const nlohmann::ordered_json& value, const std::string& place,
              std::initializer_list<const char*> keys) const;
  const nlohmann::ordered_json& array(const nlohmann::ordered_json& value,
                                      const std::string& place) const;
  std::string text(const nlohmann::ordered_json& value, const std::string& place) const;
  std::uint64_t count(const nlohmann::ordered_json& value, const std::string& place) const;
  void digits(const std::string& text, std::size_t size, const std::string& place) const;
  double length(const nlohmann::ordered_json& value, const std::string& place) const;

 private:
  std::string name_, remedy_;
};

/// Read and write the value of the key `scene` of a certificate.
Certificate::SceneKey read_scene_key(const JsonReader& reader, const nlohmann::ordered_json& value);
nlohmann::ordered_json scene_key_json(const Certificate::SceneKey& scene);

}  // namespace farcull
