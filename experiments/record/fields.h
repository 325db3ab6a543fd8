// JSON and CSV of a struct that has fields (core/base/fields.h).
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/fields.h"

namespace farcull {

/// A value of a record: an object of its fields, the word of an enumeration, null where there is
/// nothing, else the value itself. A number that is not finite is written as null.
template <class Value>
nlohmann::ordered_json json_of(const Value& value) {
  if constexpr (HasFields<Value>) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    value.fields(
        [&](std::string_view name, const auto& of) { out[std::string(name)] = json_of(of); });
    return out;
  } else if constexpr (requires { value.has_value(); }) {
    return value ? json_of(*value) : nlohmann::ordered_json(nullptr);
  } else if constexpr (std::is_enum_v<Value>) {
    return to_string(value);
  } else {
    return value;
  }
}
template <class Value>
nlohmann::ordered_json json_of(const std::vector<Value>& values) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Value& value : values) out.push_back(json_of(value));
  return out;
}

/// The values of the fields of a struct by commas, as numbers are written in full; nothing for one
/// that is empty.
template <HasFields Value>
std::string csv_of(const Value& row) {
  std::string out;
  row.fields([&](std::string_view, const auto& value) {
    if constexpr (requires { value.has_value(); }) {
      out += value ? fmt::format("{},", *value) : ",";
    } else {
      out += fmt::format("{},", value);
    }
  });
  out.pop_back();
  return out;
}

/// An object of these members of a struct, by their names and in this order.
#define FARCULL_JSON(value, ...)                                                \
  [&] {                                                                         \
    nlohmann::ordered_json out;                                                 \
    const auto& of = value;                                                     \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(FARCULL_JSON_MEMBER, __VA_ARGS__)) \
    return out;                                                                 \
  }()
#define FARCULL_JSON_MEMBER(name) out[#name] = ::farcull::json_of(of.name);

/// The objects that `one` makes of the values.
template <class Values, class One>
nlohmann::ordered_json json_list(const Values& values, const One& one) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& value : values) out.push_back(one(value));
  return out;
}

/// The value where it counts, else null.
template <class Value>
nlohmann::ordered_json json_if(bool counts, const Value& value) {
  return counts ? json_of(value) : nlohmann::ordered_json(nullptr);
}

/// Null for a text that says nothing.
inline nlohmann::ordered_json text_json(const std::string& text) {
  return json_if(!text.empty(), text);
}

}  // namespace farcull
