// The list of all families of pairs, and the seeds of their items.
#include "experiments/generators/pair_makers.h"

#include <iterator>
#include <utility>

namespace farcull {
namespace {

/// The finalizer of splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators,
/// 2014): every bit of the result depends on every bit of x.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

}  // namespace

std::uint64_t seed_of_item(std::uint64_t seed, std::string_view name, std::uint64_t number) {
  std::uint64_t out = mixed(seed + 0x9e3779b97f4a7c15);
  for (const char c : name) out = mixed(out + static_cast<unsigned char>(c));
  return mixed(out + number);
}

const std::vector<PairFamily>& pair_families() {
  static const std::vector<PairFamily> families = [] {
    std::vector<PairFamily> out;
    for (auto* part : {&shape_families, &contact_families, &distance_families}) {
      std::vector<PairFamily> more = part();
      out.insert(out.end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
    }
    return out;
  }();
  return families;
}

}  // namespace farcull
