// The laboratory with a GL context.
#pragma once

#include "core/gl/base/context.h"
#include "core/gl/canvas/canvas.h"
#include "tests/core/canvas/lab.h"

namespace farcull::lab {

/// One context for all tests of a process, on the default device.
inline const GlContext& context() {
  static const GlContext shared;
  return shared;
}

}  // namespace farcull::lab
