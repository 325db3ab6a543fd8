// Access to the kinds of views.
#include "experiments/method/candidates.h"

namespace farcull {

const std::vector<ViewReport>& Candidates::views() const {
  static const std::vector<ViewReport> none;
  const auto* views = std::get_if<std::vector<ViewReport>>(&by);
  return views ? *views : none;
}

const std::vector<PairView>& Candidates::pair_views() const {
  static const std::vector<PairView> none;
  const auto* views = std::get_if<std::vector<PairView>>(&by);
  return views ? *views : none;
}

std::optional<std::uint64_t> Candidates::swept_triangles() const {
  const auto* swept = std::get_if<SweptObjects>(&by);
  return swept ? std::optional(swept->triangles) : std::nullopt;
}

}  // namespace farcull
