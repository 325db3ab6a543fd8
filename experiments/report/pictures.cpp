// Writes the counts of drawn panels into captions and findings.
#include "experiments/report/pictures.h"

#include <fmt/format.h>

#include <stdexcept>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
std::vector<Finding> add_counts(Picture& picture, const std::vector<PanelResult>& drawn) {
  if (drawn.size() != picture.panels.size())
    throw std::logic_error("add_counts: panels of another picture");
  std::vector<std::string> said, stored;
  std::vector<Finding> broken;
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
      broken.push_back(broken_promise(
          fmt::format("in the picture {}, {} misses {} colliding pairs, and promises to miss none.",
                      picture.name, rows.method, of_all(panel.missed, panel.colliding))));
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
