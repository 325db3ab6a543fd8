// All bounds, in the order of docs/proofs.md.
#include "tests/proofs/bounds.h"

namespace farcull::proofs {

std::vector<Bound> bounds() {
  std::vector<Bound> all;
  for (const auto& some : {filter_bounds(), distance_bounds(), map_bounds(), fit_bounds(),
                           slab_bounds(), extent_bounds()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace farcull::proofs
