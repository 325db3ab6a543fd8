// All contacts of a scene: the pairs of triangles within a distance, with points and normals. Trees
// of boxes find the pairs; doubles with error bounds, or else exact arithmetic, decide them and
// give the points (verify/near_contact.h).
#pragma once

#include <vector>

#include "core/base/stage.h"
#include "core/scene/scene.h"
#include "verify/near_contact.h"

namespace farcull {

struct TriangleContact {
  ObjectPair objects;
  TrianglePair triangles;
  NearContact contact;
};

/// The pairs of triangles at most `within` apart (finite, >= 0) that distances() with `all` gives:
/// of different objects that are not ignored, or of one object marked `self` if they are no
/// neighbours. Sorted by objects, then by triangles; split into consecutive parts. threads: 0 for
/// as many as there are cores. Throws Error if there are more than `most` contacts.
std::vector<std::vector<TriangleContact>> contacts_within(const Scene& scene, double within,
                                                          unsigned threads, std::size_t most,
                                                          const Progress& progress = {});

}  // namespace farcull
