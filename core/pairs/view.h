// Which directions and how many pixels FAR pairs looks with, and a scene as one view sees it. The
// rules are fixed: the same scene and settings give the same views.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/pairs/backend.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

/// Where the objects of a scene can meet, by their boxes alone.
struct PairRegions {
  std::vector<Box>
      objects;  // per object: contains all its points that can belong to a pair; empty: none
  Box reach = Box::empty();              // of all their triangles, grown by the clearance
  std::uint64_t pairs = 0;               // of objects whose boxes overlap (grown by the clearance)
  std::uint64_t self = 0;                // objects that collide with themselves
  std::vector<std::uint32_t> triangles;  // ascending: of the objects that can meet anything
};
/// full: every object can meet anything, anywhere.
PairRegions pair_regions(const Scene& scene, double clearance, bool full = false,
                         unsigned threads = 0);

/// By how much each of two triangles grows so that they meet at that distance: half of it, rounded
/// up.
double half_of(double clearance);
/// The closed box of a triangle, grown outward by at least half the clearance on every side.
Box grown_box(const Scene& scene, std::uint32_t triangle, double clearance);

/// A direction and a resolution, and why.
struct PairChoice {
  View view;
  int resolution = 0;  // px
  std::string reason;
};
/// The best direction of the scene (the axes, and the principal directions of its edges) first.
/// `resolution`: 0 to choose it. Preconditions: regions.triangles is not empty.
std::vector<PairChoice> choose_pair_views(const Scene& scene, const PairRegions& regions,
                                          int resolution);
/// The resolution that the scene's triangles ask for in a given view.
int choose_pair_resolution(const Scene& scene, const PairRegions& regions, const View& view);

/// A window of pixel space, and by how much the triangles grow in it.
struct PairWindow {
  Window window;
  std::array<float, 3> widening;  // px per axis: half the clearance and the error of the map
};
/// Empty where pixel space cannot resolve the regions or the clearance: nothing can be said in this
/// view.
std::optional<PairWindow> pair_window(const PairRegions& regions, const View& view, int resolution,
                                      double clearance);

/// The scene in one view. `task` points into it, so it must not be copied or moved while that is
/// used.
struct PairScene {
  Window window;
  std::vector<PixelVertex> vertices;
  std::vector<std::uint32_t> owners;
  std::vector<std::uint8_t> self;
  std::vector<PixelBox> limits;
  std::vector<std::uint32_t> active;
  std::vector<std::uint32_t> undrawable;  // ascending: triangles that this view cannot show
  PairTask task;
};
/// Fills `out` (whose buffers are used again) with `triangles` as the window shows them.
void look(const Scene& scene, const PairRegions& regions, std::span<const std::uint32_t> triangles,
          const PairWindow& window, unsigned threads, PairScene& out);

}  // namespace farcull
