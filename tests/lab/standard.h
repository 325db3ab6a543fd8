// The standard library and scenes, which nearly every test uses.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cfenv>
#include <cfloat>
#include <chrono>
#include <climits>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <source_location>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace farcull {

/// Adds a triangle with corners of its own, to no object.
inline void add_triangle(Scene& scene, const std::array<Vec3, 3>& corners) {
  const auto v = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(), corners.begin(), corners.end());
  scene.source_face.push_back(static_cast<std::uint32_t>(scene.triangles.size()));
  scene.triangles.push_back({v, v + 1, v + 2});
}

}  // namespace farcull
