// Converts typed counts and times to what a row of a store holds.
#include "experiments/studies/counts.h"

#include <nlohmann/json.hpp>

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

// The fields of a member take its place; an optional that is empty is left out.
template <class Value>
void add(NamedCounts& out, std::string_view name, const Value& value) {
  if constexpr (requires { value.has_value(); }) {
    if (value) add(out, name, *value);
  } else if constexpr (HasFields<Value>) {
    value.fields([&](std::string_view inner, const auto& of) { add(out, inner, of); });
  } else {
    out.emplace_back(name, value);
  }
}

}  // namespace

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

NamedCounts named(const Counts& counts) {
  NamedCounts out;
  std::visit(
      [&](const auto& of) {
        if constexpr (HasFields<std::decay_t<decltype(of)>>) add(out, "", of);
      },
      counts);
  return out;
}

Measurement stored(const PointResult& result) {
  Measurement out{.device = result.device, .left_out = result.left_out};
  for (const auto& [name, value] : named(result.counts))
    std::visit([&, &key = name](const auto& of) { (*out.counts)[key] = of; }, value);
  result.times.fields([&](std::string_view name, const auto& ms) {
    if constexpr (requires { ms.has_value(); }) {
      if (ms) (*out.times)[std::string(name)] = *ms;
    } else if (!ms.empty()) {
      (*out.times)[std::string(name)] = ms;
    }
  });
  return out;
}

bool breaks_promise(const Measurement& measurement) {
  const Json& counts = *measurement.counts;
  if (!counts.value("promises", false)) return false;
  // A contestant breaks its promise by silence as well.
  for (const char* count : {"missed", "missed_pairs", "wrong", "violations", "refused",
                            "unanswered", "not_asked", "crashed", "hung", "no_memory"}) {
    if (counts.value(count, std::uint64_t{0}) > 0) return true;
  }
  return false;
}

}  // namespace farcull
