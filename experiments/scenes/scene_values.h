// Values of a scene file, which is JSON, and placements of its objects.
#pragma once

#include <array>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

/// Reads values. Each function takes a value and its place in the file, as in objects[1].scale.
/// Throws Error, which names the file and the place, if the value is not of that type.
struct SceneValues {
  using json = nlohmann::json;

  explicit SceneValues(std::string file) : path(std::move(file)) {}

  std::string text(const json& value, const std::string& place) const;
  bool truth(const json& value, const std::string& place) const;
  double number(const json& value, const std::string& place) const;  // finite
  Vec3 vec3(const json& value, const std::string& place) const;
  Placement placement_of(const json& object, const std::string& place) const;

  void check_keys(const json& object, const std::string& place,
                  std::initializer_list<std::string_view> known) const;
  void require(bool condition, const std::string& place, const std::string& reason,
               const std::string& remedy) const;
  [[noreturn]] void fail(const std::string& place, const std::string& reason,
                         const std::string& remedy) const;

  std::string path;

 private:
  Placement::Rotation rotation(const json& rotate, const std::string& at) const;
  std::array<std::array<double, 4>, 3> matrix(const json& value, const std::string& place) const;
};

}  // namespace farcull
