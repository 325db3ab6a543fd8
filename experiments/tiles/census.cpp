// The sample holds the triangles whose hashed number has so many zeros at its end; where it becomes
// too large, one zero more is asked for. So it depends neither on parts nor on chance.
#include "experiments/tiles/census.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/tiles/slab.h"

namespace farcull {
namespace {

constexpr std::size_t kSample = 65536;

// The finalizer of splitmix64: all bits of the result depend on all bits of the number.
std::uint64_t scrambled(std::uint64_t n) {
  n += 0x9e3779b97f4a7c15u;
  n = (n ^ (n >> 30)) * 0xbf58476d1ce4e5b9u;
  n = (n ^ (n >> 27)) * 0x94d049bb133111ebu;
  return n ^ (n >> 31);
}

class Sampler {
 public:
  void add(std::uint64_t number, const Box& box) {
    const std::uint64_t hash = scrambled(number);
    if ((hash & mask_) != 0) return;
    sample_.emplace_back(hash, box);
    while (sample_.size() > kSample) {
      mask_ = 2 * mask_ + 1;
      std::erase_if(sample_, [&](const auto& one) { return (one.first & mask_) != 0; });
    }
  }
  std::vector<Box> take() {
    std::vector<Box> out;
    out.reserve(sample_.size());
    for (const auto& [hash, box] : sample_) out.push_back(box);
    return out;
  }

 private:
  std::uint64_t mask_ = 0;
  std::vector<std::pair<std::uint64_t, Box>> sample_;
};

// The tile in which a place lies: the cuts at or before it.
std::size_t tile_at(const Cuts& cuts, double at) {
  return static_cast<std::size_t>(std::upper_bound(cuts.at.begin(), cuts.at.end(), at) -
                                  cuts.at.begin());
}

// How many boxes meet each tile, from the tiles where they begin and end.
class Loads {
 public:
  explicit Loads(const Cuts& cuts) : cuts_(cuts), step_(cuts.tiles() + 1, 0), home_(cuts.tiles()) {}
  void add(const Box& box) {
    const std::size_t first = tile_at(cuts_, box.lo[cuts_.axis]);
    ++home_[first];
    ++step_[first];
    --step_[tile_at(cuts_, box.hi[cuts_.axis]) + 1];
  }
  std::vector<TileCount> counts() const {
    std::vector<TileCount> out(cuts_.tiles());
    std::int64_t now = 0;
    for (std::size_t k = 0; k < out.size(); ++k) {
      now += step_[k];
      out[k] = {.triangles = static_cast<std::uint64_t>(now), .home = home_[k]};
    }
    return out;
  }

 private:
  const Cuts& cuts_;
  std::vector<std::int64_t> step_;
  std::vector<std::uint64_t> home_;
};

}  // namespace

Fnv1a Census::begun_hash() const {
  Fnv1a hash;
  hash.add(objects);
  for (const auto& [word, times] : sizes) {
    for (std::uint64_t k = 0; k < times; ++k) hash.add(word);
  }
  return hash;
}

std::uint64_t size_word(const Object& object) {
  return object.triangle_count | std::uint64_t{object.self} << 32;
}

Census take_census(const SceneSource& source, double clearance, bool names) {
  Census out;
  Sampler sampler;
  out.ignored = source([&](Scene& part) {
    out.name = part.name;
    out.objects += part.objects.size();
    for (const Object& object : part.objects) {
      out.self_objects += object.self;
      const std::uint64_t word = size_word(object);
      if (out.sizes.empty() || out.sizes.back().first != word) out.sizes.emplace_back(word, 0);
      ++out.sizes.back().second;
      if (names) out.names.push_back(object.name);
    }
    const auto count = static_cast<std::uint32_t>(part.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t)
      sampler.add(out.triangles++, grown_box(part, t, clearance));
  });
  out.sample = sampler.take();
  return out;
}

Scene names_of(const Census& census) {
  Scene out;
  out.name = census.name;
  for (const std::string& name : census.names) out.objects.push_back({.name = name});
  return out;
}

Cuts choose_cuts(const Census& census, std::size_t tiles) {
  Cuts best{.axis = 0, .at = std::vector<double>(tiles - 1, 0)};
  if (census.sample.empty()) return best;
  auto least = std::pair(std::numeric_limits<std::uint64_t>::max(), std::uint64_t{0});
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> places;
    for (const Box& box : census.sample) places.push_back(box.lo[axis]);
    std::sort(places.begin(), places.end());
    Cuts cuts{.axis = axis, .at = {}};
    for (std::size_t k = 1; k < tiles; ++k) cuts.at.push_back(places[places.size() * k / tiles]);
    Loads loads(cuts);
    for (const Box& box : census.sample) loads.add(box);
    auto load = std::pair(std::uint64_t{0}, std::uint64_t{0});
    for (const TileCount& count : loads.counts()) {
      load.first = std::max(load.first, count.triangles);
      load.second += count.triangles;
    }
    if (load < least) {
      least = load;
      best = std::move(cuts);
    }
  }
  return best;
}

std::vector<TileCount> count_tiles(const SceneSource& source, const Cuts& cuts, double clearance) {
  Loads loads(cuts);
  source([&](Scene& part) {
    const auto count = static_cast<std::uint32_t>(part.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) loads.add(grown_box(part, t, clearance));
  });
  return loads.counts();
}

}  // namespace farcull
