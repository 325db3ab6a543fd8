// Keeps meshes by their real paths; of a numbered mesh, the frame that was read last.
#include "experiments/scenes/mesh/cache.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "core/base/error.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/system/real_path.h"

namespace farcull {
namespace {

struct Place {
  std::size_t at = std::string::npos;  // of the %
  std::size_t size = 0;
  int digits = 1;
};

// The first place for a number, and whether it is the only one.
std::pair<Place, bool> place_in(const std::string& name) {
  Place found;
  int count = 0;
  for (std::size_t at = name.find('%'); at != std::string::npos; at = name.find('%', at + 1)) {
    const std::string rest = name.substr(at + 1, 3);
    Place place{.at = at};
    if (rest.starts_with('d')) {
      place.size = 2;
    } else if (rest.size() == 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' &&
               rest[2] == 'd') {
      place.size = 4;
      place.digits = rest[1] - '0';
    } else {
      continue;
    }
    if (count++ == 0) found = place;
  }
  return {found, count == 1};
}

}  // namespace

bool is_numbered(const std::string& name) { return place_in(name).second; }

std::string numbered(const std::string& name, long number) {
  const Place place = place_in(name).first;
  return name.substr(0, place.at) + fmt::format("{:0{}}", number, place.digits) +
         name.substr(place.at + place.size);
}

const Mesh& MeshCache::get(const std::string& path) {
  if (frame_ && is_numbered(path)) {
    const std::string file = numbered(path, *frame_);
    const auto found = moving_.find(path);
    if (found == moving_.end())
      return moving_.emplace(path, Moving{*frame_, load_mesh(file)}).first->second.mesh;
    Moving& moving = found->second;
    if (moving.frame != *frame_) moving = {*frame_, load_mesh(file)};
    return moving.mesh;
  }
  std::error_code error;
  if (!frame_ && is_numbered(path) && !std::filesystem::exists(path, error)) {
    throw Error(
        path, "stands for numbered files, and it is not said which",
        "add --frames FIRST:LAST to farcull run or verify, as in --frames 1:100, or name one "
        "file");
  }
  const std::string key = real_path(path);
  auto entry = meshes_.find(key);
  if (entry == meshes_.end()) entry = meshes_.emplace(key, load_mesh(path)).first;
  return entry->second;
}

std::vector<std::string> MeshCache::numbered_paths() const {
  std::vector<std::string> out;
  for (const auto& [path, moving] : moving_) out.push_back(path);
  return out;
}

}  // namespace farcull
