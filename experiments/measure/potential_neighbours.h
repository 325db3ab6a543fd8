// The potential neighbours of each object by a discrete Voronoi diagram (docs/voronoi.md), beside
// its nearest objects by exact arithmetic: how many the diagram leaves, and how many it loses.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/gl/base/context.h"
#include "core/scene/scene.h"
#include "core/voronoi/voronoi.h"

namespace farcull {

/// published: of each cell the two nearest objects. reliable: all that may be nearest.
enum class DiagramForm { published, reliable };

struct DiagramOptions {
  DiagramForm form = DiagramForm::published;
  int resolution = 64;   // cells along the longest side of the scene's box; 1 to kVoronoiLargest
  unsigned threads = 0;  // of the CPU; 0: as many as there are cores; changes no answer
  double widening = 1;   // of VoronoiOptions; below 1 the reliable form loses nearest objects
  /// The device that computes the cells. "", "native" or "cpu": on the cores of the CPU; else a GL
  /// device as Session takes it.
  std::string device = {};
};

/// The sets of one object.
struct PotentialNeighbours {
  std::vector<std::uint32_t> nearest;  // the objects at its least distance; none where there is no
                                       // other object with triangles
  double distance = 0;                 // that distance, in world units, rounded once
  /// The objects that the diagram leaves, and the triangles of them: all triangles of these objects
  /// with the published form; with the reliable form those that may be nearest.
  std::uint64_t objects = 0, triangles = 0;
  /// How many of `nearest` are not among those objects. With the reliable form also those of which
  /// the first of the nearest pairs of triangles is not left.
  std::uint64_t lost = 0;
};

struct DiagramRecord {
  DiagramOptions options;
  std::optional<GlInfo> gl = {};  // what answered; empty: the CPU
  std::string probes = {};        // what the probes of that device showed
  std::string scene_hash;
  std::uint64_t degenerate_triangles = 0;
  std::vector<PotentialNeighbours> objects;  // of each object of the scene
  std::uint64_t object_pairs = 0;            // that the diagram leaves, each once
  std::uint64_t triangle_pairs = 0;          // likewise; of the published form all of these objects
  VoronoiCounts work = {};
  double diagram_ms = 0, exact_ms = 0;
};

/// Throws Error as voronoi_neighbours() and reliable_neighbours() do, and where a GL device does
/// not answer, fails, or does not pass the probes (docs/reliability.md). Precondition:
/// the scene satisfies validate().
DiagramRecord potential_neighbours(const Scene& scene, const DiagramOptions& options,
                                   const Progress& progress = {});

/// Sums over all objects.
struct DiagramTotals {
  std::uint64_t objects = 0;       // that have a nearest object
  std::uint64_t nearest = 0;       // their nearest objects
  std::uint64_t lost = 0;          // of these
  std::uint64_t objects_lost = 0;  // objects that lost all of theirs
  std::uint64_t potential_objects = 0, potential_triangles = 0;
  FARCULL_FIELDS(objects, nearest, lost, objects_lost, potential_objects, potential_triangles)
};
DiagramTotals totals_of(const DiagramRecord& record);

const char* to_string(DiagramForm form);

/// The record for programs, for spreadsheets (a row for each object) and for people (of many
/// objects the first ones). seed: what the scene was drawn with, where it is random.
nlohmann::ordered_json diagram_json(const Scene& scene, const DiagramRecord& record,
                                    std::optional<std::uint64_t> seed = {});
std::string diagram_csv(const Scene& scene, const DiagramRecord& record);
std::string diagram_table(const Scene& scene, const DiagramRecord& record);

}  // namespace farcull
