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

/// The contacts that are at most `within` apart (finite, >= 0), of different objects, or of one
/// marked `self` if they are no neighbours, without those of ignored objects: the same pairs as
/// distances() with `all` gives. Sorted by objects, then by triangles, in parts that follow each
/// other. threads: 0 for as many as there are cores. Throws Error if there are more than `most`.
std::vector<std::vector<TriangleContact>> contacts_within(const Scene& scene, double within,
                                                          unsigned threads, std::size_t most,
                                                          const Progress& progress = {});

}  // namespace farcull
