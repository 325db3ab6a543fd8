#include "experiments/report/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/shell_word.h"
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
  Picture out;
  out.name = "accuracy-compare";
  out.caption = fmt::format(
      "CULLIDE and FAR on {} at {} px. Missed pairs are drawn in the colour that nothing else has. "
      "What collides and was found is coloured, what was kept and does not collide is faint.",
      cullide->point.scene, cullide->point.resolution);
  out.command = fmt::format("{} --compare cullide,far --resolution {}",
                            quoted(cullide->point.scene), cullide->point.resolution);
  out.panels = {{"CULLIDE", count_of(*cullide, "missed"), count_of(*cullide, "colliding")},
                {"FAR", count_of(*far, "missed"), count_of(*far, "colliding")}};
  return {std::move(out)};
}

std::vector<std::string> add_counts(Picture& picture, const std::vector<PanelResult>& drawn) {
  if (drawn.size() != picture.panels.size())
    throw std::logic_error("add_counts: panels of another picture");
  std::vector<std::string> said, stored, broken;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const PanelCounts& rows = picture.panels[i];
    const PanelResult& panel = drawn[i];
    said.push_back(fmt::format("{} misses {} colliding pairs", rows.method,
                               of_all(panel.missed, panel.colliding)));
    if (rows.missed != static_cast<double>(panel.missed) ||
        rows.colliding != static_cast<double>(panel.colliding)) {
      const auto words = [](std::optional<double> n) {
        return n ? grouped(static_cast<std::uint64_t>(*n)) : std::string("an unknown number");
      };
      stored.push_back(
          fmt::format("{} of {} by {}", words(rows.missed), words(rows.colliding), rows.method));
    }
    if (panel.broken) {
      broken.push_back(
          fmt::format("{} in the picture {}, {} misses {} colliding pairs, and promises to miss "
                      "none.",
                      kBroken, picture.name, rows.method, of_all(panel.missed, panel.colliding)));
    }
  }
  picture.caption = sentence(picture.caption) + " Here " + listed(said) + ".";
  if (!stored.empty()) {
    picture.caption +=
        " The rows of the study, measured before, say otherwise: " + listed(stored) + " missed.";
  }
  return broken;
}

}  // namespace farcull
