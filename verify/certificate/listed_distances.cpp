// Every index is compared with the scene before it is used.
#include "verify/certificate/listed_distances.h"

#include <array>
#include <optional>
#include <stdexcept>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr const char* kOtherScene = "give the scene that the certificate was written for";

}  // namespace

std::vector<Listed> located(const DistanceCertificate& certificate, const Scene& scene,
                            const std::string& name) {
  std::vector<Listed> out;
  for (const DistanceEntry& entry : certificate.distances) {
    const std::string place = "distances[" + std::to_string(out.size()) + "]";
    std::array<std::uint32_t, 2> triangles{};
    for (int side = 0; side < 2; ++side) {
      const std::uint32_t object = entry.objects[side];
      const bool known = object < scene.objects.size();
      if (!known || entry.triangles[side] >= scene.objects[object].triangle_count) {
        throw Error(name,
                    place + " names " +
                        (known ? "triangle " + std::to_string(entry.triangles[side]) + " of object "
                               : std::string("object ")) +
                        std::to_string(object) + ", which the scene does not have",
                    kOtherScene);
      }
      triangles[side] = scene.objects[object].first_triangle + entry.triangles[side];
    }
    const std::optional<Fraction> squared = parse_fraction(entry.squared);
    if (!squared) throw std::logic_error("check_distances: " + place + " has no square");
    out.push_back({{triangles[0], triangles[1]}, Length(*squared)});
  }
  return out;
}

}  // namespace farcull
