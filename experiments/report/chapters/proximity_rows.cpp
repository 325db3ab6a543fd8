// Sorts the rows of the study "proximity" by what they measure.
#include "experiments/report/chapters/proximity_rows.h"

#include <algorithm>
#include <set>

#include "experiments/report/chapters/numbers.h"

namespace farcull::proximity {
namespace {

std::vector<SetScene> scenes_of(const StoredStudy& stored, bool moving) {
  std::vector<SetScene> out;
  std::map<std::string, std::set<std::string>> seeds;
  for (const Row* row : measured(stored)) {
    const PointKey& point = row->point;
    if (!of_sets(*row) || of_counts(*row) || (point.frame >= 0) != moving) continue;
    const std::string name = scene_base(point.scene);
    auto at = std::find_if(out.begin(), out.end(),
                           [&](const SetScene& scene) { return scene.name == name; });
    if (at == out.end()) at = out.insert(at, {.name = name, .of = {}});
    seeds[name].insert(point.scene);
    at->seeds = seeds[name].size();
    SetSums& sums = at->of[name_of(point)][moving ? point.frame : point.resolution];
    sums.objects += number_of(*row, "with_nearest");
    sums.missed += number_of(*row, "missed");
    sums.set_objects += number_of(*row, "set_objects");
    sums.set_triangles += number_of(*row, "set_triangles");
  }
  return out;
}

}  // namespace

std::string name_of(const PointKey& point) {
  static const std::map<std::string, std::string> kNames = {
      {"boxes", kBoxes},
      {"trees", kTrees},
      {"voronoi", kPublished},
      {"voronoi-reliable", kReliable},
      {"voronoi-reliable --widening 0", kNarrow}};
  const auto at = kNames.find(point.method);
  return at != kNames.end() ? at->second : point.method.substr(0, point.method.find(' '));
}

bool of_sets(const Row& row) {
  return !row.point.method.ends_with(" nearest") && !row.point.method.ends_with(" objects");
}

bool of_counts(const Row& row) {
  const std::string& scene = row.point.scene;
  return row.point.frame < 0 && scene.starts_with("crowd:") &&
         scene.find_first_not_of("0123456789", 6) == std::string::npos;
}

const SetSums* SetScene::find(const std::string& method, long at) const {
  const auto rows = of.find(method);
  if (rows == of.end()) return nullptr;
  const auto sums = rows->second.find(at);
  return sums == rows->second.end() ? nullptr : &sums->second;
}

std::vector<SetScene> scenes_at_rest(const StoredStudy& stored) { return scenes_of(stored, false); }
std::vector<SetScene> scenes_in_motion(const StoredStudy& stored) {
  return scenes_of(stored, true);
}

std::vector<NamedRows> distances_by_scene(const StoredStudy& stored) {
  std::vector<NamedRows> out;
  for (NamedRows& scene : rows_by_scene(stored)) {
    std::erase_if(scene.rows, [](const Row* row) { return of_sets(*row) || of_counts(*row); });
    if (!scene.rows.empty()) out.push_back(std::move(scene));
  }
  return out;
}

std::vector<NamedRows> rows_by_count(const StoredStudy& stored, bool sets) {
  std::vector<NamedRows> out;
  for (const Row* row : measured(stored)) {
    if (!of_counts(*row) || of_sets(*row) != sets) continue;
    const std::string name = name_of(row->point);
    auto at = std::find_if(out.begin(), out.end(),
                           [&](const NamedRows& rows) { return rows.name == name; });
    if (at == out.end()) at = out.insert(at, {name, {}});
    at->rows.push_back(row);
  }
  for (NamedRows& rows : out) {
    std::stable_sort(rows.rows.begin(), rows.rows.end(), [](const Row* a, const Row* b) {
      return number_of(*a, "objects") < number_of(*b, "objects");
    });
  }
  return out;
}

}  // namespace farcull::proximity
