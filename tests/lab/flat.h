// Scenes as the library takes them.
#pragma once

#include "experiments/library/farcull.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {

struct Flat {
  std::vector<double> vertices;
  std::vector<std::uint32_t> triangles, starts;

  explicit Flat(const Scene& scene) {
    for (const Vec3& p : scene.vertices) vertices.insert(vertices.end(), p.data(), p.data() + 3);
    for (const auto& t : scene.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    for (const Object& object : scene.objects) starts.push_back(object.first_triangle);
  }
  Input input() const { return {vertices, triangles, starts}; }
};

/// Where the call throws an Error, and its reason; both "nothing was thrown" without one.
template <class Call>
std::array<std::string, 2> refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_FALSE(error.reason.empty() || error.remedy.empty());
    EXPECT_TRUE(has_text(error.what(), error.reason));
    return {error.where, error.reason};
  }
  return {"nothing was thrown", "nothing was thrown"};
}

}  // namespace farcull
