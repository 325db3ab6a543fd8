// Values of scene files, and placements of their objects.
#include "experiments/scenes/scene_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/text.h"
#include "experiments/scenes/mesh/load.h"

namespace farcull {
namespace {

std::string type_of(const nlohmann::json& value) {
  return fmt::format("of type {}", value.type_name());
}

}  // namespace

std::string SceneValues::text(const json& value, const std::string& place) const {
  require(value.is_string(), place, fmt::format("is {}, not a string", type_of(value)),
          "write it in quotes");
  return value.get<std::string>();
}

bool SceneValues::truth(const json& value, const std::string& place) const {
  require(value.is_boolean(), place, fmt::format("is {}, not true or false", type_of(value)),
          "write true or false, without quotes");
  return value.get<bool>();
}

double SceneValues::number(const json& value, const std::string& place) const {
  require(value.is_number(), place, fmt::format("is {}, not a number", type_of(value)),
          "give a finite number");
  const auto x = value.get<double>();
  require(std::isfinite(x), place, "is not finite", "give a finite number");
  return x;
}

Vec3 SceneValues::vec3(const json& value, const std::string& place) const {
  require(value.is_array() && value.size() == 3, place, "must be an array of 3 numbers",
          "write it as [X, Y, Z]");
  Vec3 v;
  for (std::size_t i = 0; i < 3; ++i)
    v[static_cast<int>(i)] = number(value[i], fmt::format("{}[{}]", place, i));
  return v;
}

void SceneValues::check_keys(const json& object, const std::string& place,
                             std::initializer_list<std::string_view> known) const {
  for (const auto& item : object.items()) {
    if (std::find(known.begin(), known.end(), item.key()) != known.end()) continue;
    const std::string at =
        place.empty() ? clean_name(item.key()) : place + "." + clean_name(item.key());
    fail(at, "is an unknown key", fmt::format("use only {}", fmt::join(known, ", ")));
  }
}

void SceneValues::require(bool condition, const std::string& place, const std::string& reason,
                          const std::string& remedy) const {
  if (!condition) fail(place, reason, remedy);
}

void SceneValues::fail(const std::string& place, const std::string& reason,
                       const std::string& remedy) const {
  throw Error(path, place.empty() ? reason : place + " " + reason, remedy);
}

Placement SceneValues::placement_of(const json& object, const std::string& place) const {
  Placement out;
  if (object.contains("matrix")) {
    for (const char* other : {"scale", "rotate", "translate"}) {
      require(!object.contains(other), place + "." + other, "stands beside a matrix",
              "give the matrix alone, or scale, rotate and translate");
    }
    out.matrix = matrix(object["matrix"], place + ".matrix");
  }
  if (object.contains("scale")) {
    const json& scale = object["scale"];
    const std::string at = place + ".scale";
    const std::string form = "give a number or an array of 3 numbers, none of them 0";
    require(scale.is_number() || scale.is_array(), at, "must be a number or an array of 3", form);
    out.scale = scale.is_array() ? vec3(scale, at) : Vec3(Vec3::Constant(number(scale, at)));
    require((out.scale->array() != 0).all(), at, "is 0, which leaves no mesh", form);
  }
  if (object.contains("rotate")) {
    const json& rotate = object["rotate"];
    const std::string at = place + ".rotate";
    const std::string form = "write {\"axis\": [0, 0, 1], \"angle\": RADIANS}";
    require(rotate.is_object(), at, "must be a JSON object", form);
    if (rotate.contains("quaternion")) {
      check_keys(rotate, at, {"quaternion"});
      const json& q = rotate["quaternion"];
      const std::string of = at + ".quaternion";
      const std::string four =
          "write {\"w\": W, \"x\": X, \"y\": Y, \"z\": Z} or [X, Y, Z, W], not all of them 0";
      std::array<double, 4> values{};
      if (q.is_object()) {
        check_keys(q, of, {"w", "x", "y", "z"});
        for (std::size_t i = 0; i < 4; ++i) {
          const std::string key(1, "xyzw"[i]);
          require(q.contains(key), of + "." + key, "is missing", four);
          values[i] = number(q[key], of + "." + key);
        }
      } else {
        require(q.is_array() && q.size() == 4, of, "is neither four named numbers nor an array",
                four);
        for (std::size_t i = 0; i < 4; ++i) values[i] = number(q[i], fmt::format("{}[{}]", of, i));
      }
      require(values != std::array<double, 4>{}, of, "is 0", four);
      out.rotate = Placement::Rotation{.quaternion = values};
    } else {
      out.rotate = rotation(rotate, at);
    }
  }
  if (object.contains("translate")) out.translate = vec3(object["translate"], place + ".translate");
  return out;
}

Placement::Rotation SceneValues::rotation(const json& rotate, const std::string& at) const {
  const std::string form = "write {\"axis\": [0, 0, 1], \"angle\": RADIANS}";
  check_keys(rotate, at, {"axis", "angle"});
  require(rotate.contains("axis"), at + ".axis", "is missing", form);
  require(rotate.contains("angle"), at + ".angle", "is missing", form);
  const Placement::Rotation out{.axis = vec3(rotate["axis"], at + ".axis"),
                                .angle = number(rotate["angle"], at + ".angle")};
  require((out.axis.array() != 0).any(), at + ".axis", "is the zero vector",
          "give a direction of any length");
  if (std::abs(out.angle) > 2 * std::numbers::pi)
    add_reading_notes(path, {fmt::format("{}: {} rad: angles are in radians", at, out.angle)});
  return out;
}

// The upper three rows of a matrix of 4 x 4 numbers, row by row.
std::array<std::array<double, 4>, 3> SceneValues::matrix(const json& value,
                                                         const std::string& place) const {
  const std::string form =
      "write four rows of four numbers, as in [[1,0,0,X],[0,1,0,Y],[0,0,1,Z],[0,0,0,1]]";
  require(value.is_array() && value.size() == 4, place, "must be an array of 4 rows", form);
  std::array<std::array<double, 4>, 3> out{};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string row = fmt::format("{}[{}]", place, i);
    require(value[i].is_array() && value[i].size() == 4, row, "must be an array of 4 numbers",
            form);
    for (std::size_t k = 0; k < 4; ++k) {
      const double x = number(value[i][k], fmt::format("{}[{}]", row, k));
      if (i < 3) out[i][k] = x;
      require(i < 3 || x == (k == 3 ? 1 : 0), row, "must be [0, 0, 0, 1]", form);
    }
  }
  std::array<double, 9> linear{};
  for (std::size_t k = 0; k < 9; ++k) linear[k] = out[k / 3][k % 3];
  require(is_invertible(linear), place, "has no inverse, so it flattens the mesh",
          "give a matrix whose determinant is not 0");
  return out;
}

}  // namespace farcull
