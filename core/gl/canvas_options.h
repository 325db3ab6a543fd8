// Options of the canvas on OpenGL.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

#include "core/canvas/asked_depth.h"

namespace farcull {

enum class DepthFormat { float32, fixed24 };
/// flags: an asked fragment raises its slot's flag. Proxies compare with the stored depth in the
/// shader (float32 only: a comparison with a texel of a 24-bit texture loses equal depths);
/// triangles at fixed depth rely on early fragment tests. occlusion: GL_ANY_SAMPLES_PASSED, many in
/// flight, as published.
enum class QueryMode { flags, occlusion };

/// The define with which canvas.frag asks, by the bits of the slack.
inline std::string ask_define(float behind = kAskedBehind) {
  return "FAR_ASK uintBitsToFloat(" + std::to_string(std::bit_cast<std::uint32_t>(behind)) + "u)";
}

struct GlCanvasOptions {
  DepthFormat depth_format = DepthFormat::float32;
  QueryMode query = QueryMode::flags;
  /// Triangles have a fragment in each pixel that they touch, by GL_NV_conservative_raster or
  /// GL_INTEL_conservative_rasterization.
  bool conservative = false;
  /// Bytes; as if a storage block held no more than this. 0: the device's own limit.
  long storage_limit = 0;
};

}  // namespace farcull
