// What json_object.h declares, here because it takes the JSON library.
#include "experiments/studies/json_object.h"

#include <nlohmann/json.hpp>

namespace farcull {

using Json = nlohmann::ordered_json;

JsonObject::JsonObject() : value_(std::make_unique<Json>(Json::object())) {}
JsonObject::JsonObject(const JsonObject& other) : value_(std::make_unique<Json>(*other)) {}
JsonObject::JsonObject(JsonObject&& other) noexcept = default;
JsonObject& JsonObject::operator=(const JsonObject& other) {
  value_ = std::make_unique<Json>(*other);
  return *this;
}
JsonObject& JsonObject::operator=(JsonObject&& other) noexcept = default;
JsonObject& JsonObject::operator=(const Json& value) {
  value_ = std::make_unique<Json>(value);
  return *this;
}
JsonObject::~JsonObject() = default;

Json& JsonObject::operator[](const char* key) { return (*value_)[key]; }
const Json& JsonObject::operator[](const char* key) const {
  return static_cast<const Json&>(*value_)[key];
}

}  // namespace farcull
