#include "experiments/report/pictures.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/report/numbers.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

// Fewer pixels than these make a picture of hardly more than misses.
constexpr int kLeastPixels = 128;

bool measured(const Row& row, const char* method) {
  return row.measurement.left_out.empty() && row.point.method == method &&
         row.point.resolution >= kLeastPixels;
}

// FAR as it promises, of the same scene and resolution.
const Row* partner_of(const StoredStudy& stored, const Row& cullide) {
  for (const Row& row : stored.rows) {
    if (measured(row, "far") && row.point.scene == cullide.point.scene &&
        row.point.resolution == cullide.point.resolution && row.point.offset == "obb" &&
        row.point.radius == "budget") {
      return &row;
    }
  }
  return nullptr;
}

// Meshes are easier to see than slivers.
int rank(const Row& row) { return row.point.scene.starts_with("two-bunnies") ? 0 : 1; }

}  // namespace

std::vector<Picture> accuracy_pictures(const StoredStudy& stored) {
  const Row *cullide = nullptr, *far = nullptr;
  for (const Row& row : stored.rows) {
    if (!measured(row, "cullide") || count_of(row, "missed").value_or(0) <= 0) continue;
    const bool better = cullide == nullptr || rank(row) < rank(*cullide) ||
                        (row.point.scene == cullide->point.scene &&
                         row.point.resolution < cullide->point.resolution);
    const Row* partner = better ? partner_of(stored, row) : nullptr;
    if (partner == nullptr) continue;
    cullide = &row;
    far = partner;
  }
  if (cullide == nullptr) return {};
  const auto number = [](const Row& row, const char* name) {
    return grouped(static_cast<std::uint64_t>(count_of(row, name).value_or(0)));
  };
  Picture out;
  out.name = "accuracy-compare";
  out.caption = fmt::format(
      "CULLIDE and FAR on {} at {} px. CULLIDE misses {} of {} colliding pairs, drawn in the "
      "colour "
      "that nothing else has; FAR misses {}. What collides and was found is coloured, what was "
      "kept "
      "and does not collide is faint",
      cullide->point.scene, cullide->point.resolution, number(*cullide, "missed"),
      number(*cullide, "colliding"), number(*far, "missed"));
  out.command = fmt::format("{} --compare cullide,far --resolution {}", cullide->point.scene,
                            cullide->point.resolution);
  return {std::move(out)};
}

}  // namespace farcull
