// A7 of FAR pairs: lost commands are noticed, and the answer after them is right.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/gl/driver_fault.h"
#include "core/gl/pairs.h"
#include "core/gl/probe_groups.h"
#include "core/gl/probe_target.h"
#include "core/pairs/pairs.h"

namespace farcull::probe {
namespace {

// Two waves of triangles through each other, and a large triangle across both.
Scene waves() {
  constexpr int kSide = 24;
  Scene scene;
  scene.name = "waves";
  for (int object = 0; object < 2; ++object) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    Object o;
    o.name.assign(1, static_cast<char>('a' + object));
    o.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    for (int j = 0; j <= kSide; ++j) {
      for (int i = 0; i <= kSide; ++i)
        scene.vertices.emplace_back(i + 0.3 * object, j + 0.2 * object,
                                    2 * std::sin(0.5 * i + 0.3 * j + 2 * object));
    }
    const auto at = [&](int i, int j) {
      return first + static_cast<std::uint32_t>(j * (kSide + 1) + i);
    };
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        scene.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        scene.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
    scene.triangles.push_back({at(0, 0), at(kSide, 0), at(kSide, kSide)});
    o.triangle_count = static_cast<std::uint32_t>(scene.triangles.size()) - o.first_triangle;
    scene.objects.push_back(o);
  }
  scene.source_face.assign(scene.triangles.size(), 0);
  return scene;
}

}  // namespace

std::vector<ProbeResult> pair_commands(const GlContext& context, const ProbeOptions& options) {
  const Scene scene = waves();
  const PairSettings settings{.views = parse_views("z"), .resolution = 64};
  GlPairs backend(context);
  const std::vector<TrianglePair> right = find_pairs(scene, settings, backend).candidates;
  const std::size_t dispatches = backend.dispatches();
  Worst unnoticed;
  std::uint64_t faults = 0, noticed = 0;
  std::string refusal;
  for (const DriverFaultKind kind :
       {DriverFaultKind::lost_dispatch, DriverFaultKind::oversized_dispatch,
        DriverFaultKind::unfinished_item, DriverFaultKind::wrong_count}) {
    std::optional<DriverFault> fault;
    if (!options.skipped_faults) fault.emplace(kind);
    GlPairs faulty(context);  // its programs are compiled under the fault
    if (fault) fault->strike(dispatches / 2);
    const auto answer_of_faulty = [&] { return find_pairs(scene, settings, faulty).candidates; };
    bool seen = false;
    try {
      answer_of_faulty();
    } catch (const Error&) {
      seen = true;
    }
    fault.reset();
    bool recovered = false;
    try {
      recovered = answer_of_faulty() == right;
    } catch (const Error& error) {
      refusal = std::string("; ") + error.what();
    }
    ++faults;
    noticed += seen;
    unnoticed.count(!seen);
    unnoticed.count(!recovered);
  }
  unnoticed.count(right.empty());
  return {result("A7", "faults are noticed, far-pairs", unnoticed, 0, "unnoticed",
                 std::to_string(noticed) + " of " + std::to_string(faults) +
                     " noticed, in the middle of " + std::to_string(dispatches) +
                     " dispatches; the answer after each is compared, too" + refusal)};
}

}  // namespace farcull::probe
