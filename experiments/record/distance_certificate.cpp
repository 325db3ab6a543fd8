// Writes what a record answers as a certificate has it.
#include "experiments/record/distance_certificate.h"

namespace farcull {
namespace {

DistanceCertificate::Pairs pairs_of(DistancePairs pairs) {
  switch (pairs) {
    case DistancePairs::objects:
      return DistanceCertificate::Pairs::objects;
    case DistancePairs::nearest:
      return DistanceCertificate::Pairs::nearest;
    case DistancePairs::all:
      break;
  }
  return DistanceCertificate::Pairs::all;
}

}  // namespace

DistanceCertificate certificate_of(const Scene& scene, const DistanceRecord& record) {
  DistanceCertificate out;
  out.scene = {scene.name, scene.objects.size(), scene.triangles.size(), record.scene_hash};
  out.pairs = pairs_of(record.options.pairs);
  if (record.options.pairs == DistancePairs::nearest) out.k = record.options.k;
  out.within = record.options.within;
  out.distances.reserve(record.distances.size());
  for (const Distance& d : record.distances) {
    out.distances.push_back(
        entry_of(scene, d.triangles, d.closest.squared.text(),
                 {number_of(d.closest.features[0]), number_of(d.closest.features[1])}));
    out.distances.back().inside = claim_of(d.inside);
  }
  return out;
}

}  // namespace farcull
