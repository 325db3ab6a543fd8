// Rows of the study "proximity": their kinds, names of methods, and sums over the seeds of a scene.
// For its chapter alone.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/report/chapters/rows.h"

namespace farcull::proximity {

inline constexpr const char* kBoxes = "boxes of objects";
inline constexpr const char* kTrees = "trees of boxes";
inline constexpr const char* kPublished = "Voronoi (published)";
inline constexpr const char* kReliable = "Voronoi (reliable)";
inline constexpr const char* kNarrow = "Voronoi (not widened)";

/// One of the names above; of a contestant that was asked for distances its own.
std::string name_of(const PointKey& point);
/// Whether a row is of potential neighbour sets; else it is of distances.
bool of_sets(const Row& row);
/// Whether it is of the plot against the number of objects: "crowd:N".
bool of_counts(const Row& row);

/// The rows of one method on one scene at one resolution, which differ in the seed of the scene.
struct SetSums {
  std::uint64_t objects = 0, missed = 0;  // with a nearest neighbour; that lose all of theirs
  std::uint64_t set_objects = 0, set_triangles = 0;  // over these objects
  double objects_each() const { return mean(set_objects); }
  double triangles_each() const { return mean(set_triangles); }

 private:
  double mean(std::uint64_t sum) const {
    return objects == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(objects);
  }
};

/// A scene at rest without its seeds, or a scene that moves; by method and resolution or frame.
struct SetScene {
  std::string name;
  std::size_t seeds = 0;
  std::map<std::string, std::map<long, SetSums>> of;

  /// Null where there is no such row.
  const SetSums* find(const std::string& method, long at) const;
};
/// Of the rows that were measured, in the order of the grid: those without frames, by resolution,
/// or those with frames, by frame.
std::vector<SetScene> scenes_at_rest(const StoredStudy& stored);
std::vector<SetScene> scenes_in_motion(const StoredStudy& stored);

/// The rows of distances by scene, in the order of the grid, but for those of_counts().
std::vector<NamedRows> distances_by_scene(const StoredStudy& stored);
/// The rows of_counts() by name, ascending in the number of objects.
std::vector<NamedRows> rows_by_count(const StoredStudy& stored, bool sets);

}  // namespace farcull::proximity
