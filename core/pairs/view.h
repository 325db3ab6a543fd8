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
#include "core/pairs/regions.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

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
