// The discrete Voronoi diagram rasterized on an OpenGL device (core/voronoi/voronoi.h):
// for each slice of the grid every triangle of a brick is drawn as a rectangle over the brick's
// cells, a pixel a cell, and the depth of a fragment is the distance of the triangle from the
// cell's centre. The depth test keeps the nearest.
//
// The depth test only proposes: a last pass compares every distance with what was kept, and each
// fragment adds a hash of what it read to a sum of its cell. Sums and comparisons are checked
// before anything is answered, so a lost command, a lost fragment or a wrong depth test is an
// Error.
#pragma once

#include <cstddef>
#include <memory>

#include "core/gl/base/context.h"
#include "core/voronoi/voronoi.h"

namespace farcull {

struct GlVoronoiOptions {
  std::size_t list = std::size_t{1}
                     << 16;  // triangles near cells that a slice has room for at first
};

/// The context must outlive the result. Throws Error where the device lacks what this needs. Every
/// function throws Error where a command was lost or the device computes otherwise than it should;
/// the object answers nothing after that.
std::unique_ptr<VoronoiDevice> gl_voronoi_device(const GlContext& context,
                                                 const GlVoronoiOptions& options = {});

}  // namespace farcull
