// The list of the colliding pairs as text, byte for byte as `farcull run --pairs FILE.csv` writes
// it. A certificate names the list by the SHA-256 of these bytes, and the check compares with them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// object_a,triangle_a,object_b,triangle_b, and a fifth column `neighbours` where an object of the
/// scene is tested against itself; each line ends with a single newline.
std::string pair_list_header(const Scene& scene);

/// The lines of a list, pair after pair: 0-based, in decimal, triangles counted within their
/// object; `neighbours` is 1 for triangles of one object that share a vertex position, else 0.
class PairListRows {
 public:
  /// The scene must outlive the object.
  explicit PairListRows(const Scene& scene);
  /// Appends the line of a pair to `text`. Precondition: both triangles are of the scene.
  void append(const TrianglePair& pair, std::string& text) const;

 private:
  const Scene& scene_;
  std::vector<std::uint32_t> owner_;
  bool self_;
};

/// The whole list: the header, then the lines of the pairs in the order given.
std::string pair_list(const Scene& scene, std::span<const TrianglePair> pairs);

/// SHA-256 of pair_list(): 64 lower-case hexadecimal digits. Memory O(triangles), whatever the
/// number of pairs.
std::string pair_list_hash(const Scene& scene, std::span<const TrianglePair> pairs);

}  // namespace farcull
