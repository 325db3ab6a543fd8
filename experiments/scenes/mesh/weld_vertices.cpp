// Merges the vertices of a mesh that nearly coincide.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/near_points.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

WeldTolerance parse_weld(const std::string& text, const char* option) {
  WeldTolerance out;
  constexpr std::string_view kSize = "*size";
  out.relative = text.ends_with(kSize);
  const std::string number = text.substr(0, text.size() - (out.relative ? kSize.size() : 0));
  const std::optional<double> value = parse_number<double>(number);
  if (!value || !std::isfinite(*value) || *value < 0) {
    throw Error(option, "'" + text + "' is no tolerance",
                "give a length of 0 or more in the units of the meshes, or one relative to the "
                "diagonal of the "
                "box around them, as in 1e-7*size");
  }
  out.value = *value;
  return out;
}

std::uint64_t weld(Mesh& mesh, const WeldTolerance& tolerance) {
  const Box box = bounds(mesh);
  const double size = std::min((box.hi - box.lo).norm(), std::numeric_limits<double>::max());
  NearPoints near(tolerance.value * (tolerance.relative ? size : 1));
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> now(mesh.vertices.size(), kNone);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) now[v] = v;
  }
  std::uint64_t merged = 0;
  for (std::uint32_t v = 0; v < now.size(); ++v) {
    if (now[v] == kNone) continue;
    now[v] = near.number(mesh.vertices[v], v);
    merged += now[v] != v;
  }
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = now[v];
  }
  return merged;
}

}  // namespace farcull
