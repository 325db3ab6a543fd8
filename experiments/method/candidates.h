// What a method finds: pairs of triangles that may collide.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/stage.h"
#include "core/canvas/canvas.h"
#include "core/cull/cull.h"
#include "core/gl/base/context.h"
#include "core/pairs/pairs.h"
#include "experiments/method/device_verdict.h"
#include "verify/exact.h"

namespace farcull {

/// The device that answered.
struct UsedDevice {
  std::optional<GlInfo> gl;  // empty: none, or the cores of the CPU
  bool cpu = false;          // on the cores of the CPU
  std::string lanes = {};    // the instruction set of the native canvas; empty for others
  int depth_bits = 0;        // of the canvas
  std::string note;          // why no device was used, where none was; for far-pairs, why this one
  std::optional<Reliance> relies;  // on a GL device, for the promise
};

/// Of sweep and prune: triangles of the objects that their boxes leave, which is where I-COLLIDE as
/// published ends.
struct SweptObjects {
  std::uint64_t triangles = 0;
};

struct Candidates {
  std::vector<TrianglePair> pairs;       // sorted; empty where `decided` is set
  std::uint64_t count = 0;               // of candidate pairs
  std::uint64_t ignored = 0;             // candidates that were removed: of objects that are
                                         // ignored
  std::vector<std::uint32_t> triangles;  // the potentially colliding set, ascending; of far-pairs
                                         // filled by run(), from the pairs; empty where
                                         // `decided` is set, which keeps all
  std::uint64_t triangle_count = 0;      // of the potentially colliding set
  std::uint64_t object_count = 0;
  std::optional<Collisions> decided;  // of a method that decides each candidate as it comes
  /// The views of a drawing method, or of far-pairs; or the objects of a sweep.
  std::variant<std::monostate, std::vector<ViewReport>, std::vector<PairView>, SweptObjects> by;
  std::vector<std::uint8_t> bits;  // of a drawing method, per triangle: CullResult::bits
  UsedDevice device;
  CanvasWork asked;  // of a drawing method: of the GL device; all 0 for others
  std::vector<Stage> trace;
  double setup_ms = 0;    // context, shaders; 0 where an earlier run had made them
  double ms = 0;          // of finding, without setup
  double decided_ms = 0;  // of deciding, where `decided` is set; not part of ms

  /// Of the variant; empty for another kind.
  const std::vector<ViewReport>& views() const { return all_of<ViewReport>(); }
  const std::vector<PairView>& pair_views() const { return all_of<PairView>(); }
  std::optional<std::uint64_t> swept_triangles() const {
    const auto* swept = std::get_if<SweptObjects>(&by);
    return swept ? std::optional(swept->triangles) : std::nullopt;
  }

 private:
  template <class View>
  const std::vector<View>& all_of() const {
    static const std::vector<View> none;
    const auto* views = std::get_if<std::vector<View>>(&by);
    return views ? *views : none;
  }
};

}  // namespace farcull
