// Makes the list line by line, so that its hash needs no more memory than one line and the owners
// of the triangles.
#include "verify/certificate/pair_list.h"

#include <algorithm>

#include "verify/certificate/sha256.h"

namespace farcull {
namespace {

bool has_self(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const Object& object) { return object.self; });
}

bool share_corner(const Scene& scene, const TrianglePair& pair) {
  for (const Vec3& p : scene.corners(pair.a)) {
    for (const Vec3& q : scene.corners(pair.b)) {
      if (p == q) return true;
    }
  }
  return false;
}

}  // namespace

std::string pair_list_header(const Scene& scene) {
  return std::string("object_a,triangle_a,object_b,triangle_b") +
         (has_self(scene) ? ",neighbours\n" : "\n");
}

PairListRows::PairListRows(const Scene& scene)
    : scene_(scene), owner_(owners(scene)), self_(has_self(scene)) {}

void PairListRows::append(const TrianglePair& pair, std::string& text) const {
  const std::uint32_t a = owner_[pair.a];
  const std::uint32_t b = owner_[pair.b];
  for (const std::uint32_t number :
       {a, pair.a - scene_.objects[a].first_triangle, b, pair.b - scene_.objects[b].first_triangle})
    text.append(std::to_string(number)).push_back(',');
  if (self_) {
    text += a == b && share_corner(scene_, pair) ? "1\n" : "0\n";
  } else {
    text.back() = '\n';
  }
}

std::string pair_list(const Scene& scene, std::span<const TrianglePair> pairs) {
  std::string out = pair_list_header(scene);
  const PairListRows rows(scene);
  for (const TrianglePair& pair : pairs) rows.append(pair, out);
  return out;
}

std::string pair_list_hash(const Scene& scene, std::span<const TrianglePair> pairs) {
  Sha256 hash;
  hash.add(pair_list_header(scene));
  const PairListRows rows(scene);
  std::string line;
  for (const TrianglePair& pair : pairs) {
    line.clear();
    rows.append(pair, line);
    hash.add(line);
  }
  return hash.digest();
}

}  // namespace farcull
