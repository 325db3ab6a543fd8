// A JSON object for structures that many files pass on and few look into.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

namespace farcull {

/// A JSON object that is copied like a value. It is behind a pointer because <nlohmann/json.hpp>
/// takes up to a second of every file that includes it: only the files that look inside have to.
class JsonObject {
 public:
  JsonObject();  // an empty object
  JsonObject(const JsonObject& other);
  JsonObject(JsonObject&& other) noexcept;  // `other` may then only be assigned to or destroyed
  JsonObject& operator=(const JsonObject& other);
  JsonObject& operator=(JsonObject&& other) noexcept;
  JsonObject& operator=(const nlohmann::ordered_json& value);
  ~JsonObject();

  nlohmann::ordered_json& operator*() { return *value_; }
  const nlohmann::ordered_json& operator*() const { return *value_; }
  nlohmann::ordered_json* operator->() { return value_.get(); }
  const nlohmann::ordered_json* operator->() const { return value_.get(); }
  /// As of nlohmann::ordered_json.
  nlohmann::ordered_json& operator[](const char* key);
  const nlohmann::ordered_json& operator[](const char* key) const;

 private:
  std::unique_ptr<nlohmann::ordered_json> value_;
};

}  // namespace farcull
