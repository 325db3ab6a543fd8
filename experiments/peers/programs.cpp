// The list of contestants that the study knows, and where their programs are.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "core/base/error.h"
#include "experiments/peers/known.h"

namespace farcull {
namespace {

using Names = std::vector<const char*>;

void add(std::vector<KnownContestant>& all, const char* program, const char* package,
         const Names& names, bool pairs = true, bool meshes = true, bool ours = false) {
  for (const char* name : names) all.push_back({name, program, package, pairs, meshes, ours});
}

std::vector<KnownContestant> make_list() {
  std::vector<KnownContestant> all;
  add(all, "ours", "",
      {"far-pairs", "exact", "far", "i-collide", "cullide", "quick-cullide", "s-cullide"}, true,
      true, true);
  add(all, "cgal", "libcgal-dev", {"cgal-exact", "cgal-self-intersections"});
  add(all, "cgal", "libcgal-dev", {"cgal-do-intersect", "cgal-double"}, true, false);
  add(all, "peers", "libfcl-dev", {"fcl-double", "fcl-float"});
  add(all, "bullet_double", "libbullet-dev",
      {"bullet-gimpact-double", "bullet-gimpact-margin-double"});
  add(all, "bullet_float", "libbullet-dev",
      {"bullet-gimpact-float", "bullet-gimpact-margin-float"});
  add(all, "peers", "libode-dev", {"ode-trimesh"});
  add(all, "libccd", "libccd-dev", {"libccd-gjk", "libccd-mpr"}, true, false);
  add(all, "gts", "libgts-dev", {"gts"});
  add(all, "vtk", "libvtk9-dev", {"vtk-collision"});
  add(all, "vtk", "libvtk9-dev", {"vtk-triangle", "vtk-intersection"}, true, false);
  add(all, "open3d", "libopen3d-dev", {"open3d"});
  add(all, "three_mesh_bvh", "nodejs, npm and then the npm package three-mesh-bvh",
      {"three-mesh-bvh"});
  add(all, "textbook", "",
      {"moeller-double", "moeller-double-0", "moeller-float", "guigue-devillers-double",
       "guigue-devillers-float", "edge-face-double"},
      true, false);
  add(all, "peers", "libcgal-dev", {"cgal-boxes-exact", "cgal-aabb-exact"}, false);
  add(all, "peers", "libfcl-dev", {"fcl-obbrss-exact"}, false);
  add(all, "peers", "libembree-dev", {"embree-medium-exact"}, false);
  add(all, "peers", "libbullet-dev", {"bullet-gimpact-exact"}, false);
  return all;
}

std::string folder() {
  const char* const named = std::getenv("FARCULL_CONTESTANTS");
  if (named != nullptr && *named != '\0') return named;
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return (self.parent_path() / "contestants").string();
}

/// The cards of a program, read once; or why there are none.
struct Cards {
  std::vector<Invited> invited;
  std::string missing;
};
const Cards& cards_of(const std::string& path) {
  static std::map<std::string, Cards> known;
  const auto at = known.find(path);
  if (at != known.end()) return at->second;
  Cards cards;
  if (::access(path.c_str(), X_OK) != 0) {
    cards.missing = "its program was not built";
  } else {
    try {
      cards.invited = invite({path});
    } catch (const Error& error) {
      cards.missing = error.reason;
    }
  }
  return known.emplace(path, std::move(cards)).first->second;
}

}  // namespace

const std::vector<KnownContestant>& known_contestants() {
  static const std::vector<KnownContestant> all = make_list();
  return all;
}

const KnownContestant& known_contestant(const std::string& name) {
  const std::vector<KnownContestant>& all = known_contestants();
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const KnownContestant& of) { return of.name == name; });
  if (at == all.end()) {
    std::string names;
    for (const KnownContestant& of : all) names += (names.empty() ? "" : ", ") + of.name;
    throw Error("contestant", "'" + name + "' is none", "choose of " + names);
  }
  return *at;
}

Invitation invite_known(const KnownContestant& contestant) {
  const Cards& cards = cards_of(folder() + "/farcull_contestant_" + contestant.program);
  for (const Invited& invited : cards.invited) {
    if (invited.card.name == contestant.name) return {invited, ""};
  }
  std::string missing =
      contestant.name + ": " + (cards.missing.empty() ? "not part of this build" : cards.missing);
  if (!contestant.package.empty()) missing += " (Debian: " + contestant.package + ")";
  return {{}, missing};
}

}  // namespace farcull
