// Vertices get new numbers part by part: no two parts share one.
#include "experiments/tiles/gather.h"

#include <fmt/format.h>

#include <bit>
#include <limits>
#include <vector>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMost = std::size_t{1} << 31;  // triangles and objects, see plan_pairs()

class Gathering {
 public:
  Gathering(const Census& census, const Slab& slab, double clearance)
      : census_(census), slab_(slab), clearance_(clearance), hash_(census.begun_hash()) {
    out_.numbers.self = census.self_objects > 0;
  }

  void add(const Scene& part) {
    out_.scene.name = part.name;
    vertex_.assign(part.vertices.size(), kNone);
    for (const Object& object : part.objects) add(part, object);
    if (out_.scene.triangles.size() + out_.scene.objects.size() >= kMost) {
      throw Error(part.name, "has 2^31 triangles and objects in the tile, or more",
                  "divide it into more tiles");
    }
  }

  TileScene take() {
    if (run_ != census_.sizes.size()) changed();
    out_.hash = hash_.hex();
    out_.faces_hash = faces_.hex();
    return std::move(out_);
  }

 private:
  [[noreturn]] void changed() const {
    throw Error(census_.name,
                fmt::format("is not what it was when it was read first: that had {} triangles of "
                            "{} objects; now object {} is another one",
                            census_.triangles, census_.objects, objects_),
                "do not change its files while a run reads them");
  }

  // The hash began with what the first reading says of all objects, so this reading has to agree.
  void require_known(const Object& object) {
    if (run_ == census_.sizes.size() || census_.sizes[run_].first != size_word(object)) changed();
    if (++of_run_ < census_.sizes[run_].second) return;
    ++run_;
    of_run_ = 0;
  }

  void add(const Scene& part, const Object& object) {
    Scene& to = out_.scene;
    require_known(object);
    const std::uint64_t number = objects_++;
    Object own{.name = {},
               .first_triangle = static_cast<std::uint32_t>(to.triangles.size()),
               .triangle_count = 0,
               .self = object.self};
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      const std::uint32_t t = object.first_triangle + k;
      for (const Vec3& p : part.corners(t)) {
        for (int i = 0; i < 3; ++i) hash_.add(std::bit_cast<std::uint64_t>(p[i]));
      }
      faces_.add(std::uint64_t{part.source_face[t]});
      const Box box = grown_box(part, t, clearance_);
      if (!meets(slab_, box)) continue;
      out_.home += holds(slab_, box.lo[slab_.axis]);
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) corners[i] = vertex(part, part.triangles[t][i]);
      to.triangles.push_back(corners);
      to.source_face.push_back(part.source_face[t]);
      out_.numbers.triangles.push_back(k);
      ++own.triangle_count;
    }
    if (own.triangle_count == 0) return;
    own.name = object.name;
    to.objects.push_back(std::move(own));
    out_.numbers.objects.push_back(number);
  }

  std::uint32_t vertex(const Scene& part, std::uint32_t v) {
    std::uint32_t& to = vertex_[v];
    if (to == kNone) {
      if (out_.scene.vertices.size() == kNone) {
        throw Error(part.name, "has 2^32 vertices in the tile, or more",
                    "divide it into more tiles");
      }
      to = static_cast<std::uint32_t>(out_.scene.vertices.size());
      out_.scene.vertices.push_back(part.vertices[v]);
    }
    return to;
  }

  const Census& census_;
  Slab slab_;
  double clearance_;
  Fnv1a hash_, faces_;
  TileScene out_;
  std::size_t run_ = 0;       // of census_.sizes: that of the next object
  std::uint64_t of_run_ = 0;  // objects before it in the run
  std::uint64_t objects_ = 0;
  std::vector<std::uint32_t> vertex_;  // of the part, in the tile
};

}  // namespace

TileScene gather_tile(const SceneSource& source, const Census& census, const Slab& slab,
                      double clearance) {
  Gathering gathering(census, slab, clearance);
  source([&](Scene& part) { gathering.add(part); });
  return gathering.take();
}

}  // namespace farcull
