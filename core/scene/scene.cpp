// Checks scenes; computes boxes, owners and fingerprints; drops ignored pairs; finds moved corners.
#include "core/scene/scene.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace farcull {

void validate(const Scene& scene, const std::string& where) {
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
    if (!scene.vertices[i].allFinite()) {
      throw Error(where, "vertex " + std::to_string(i) + " is not finite",
                  "give every coordinate a finite value that a double can hold");
    }
  }
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    for (const std::uint32_t v : scene.triangles[t]) {
      if (v >= scene.vertices.size()) {
        throw Error(where,
                    "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                        " of " + std::to_string(scene.vertices.size()),
                    "correct the index");
      }
    }
  }
  std::uint64_t next = 0;
  for (const Object& object : scene.objects) {
    if (object.first_triangle != next) {
      throw Error(where, "object '" + object.name + "' does not start where the one before it ends",
                  "give objects contiguous ranges of triangles");
    }
    next += object.triangle_count;
  }
  if (next != scene.triangles.size() || scene.source_face.size() != scene.triangles.size()) {
    throw Error(where, "the objects do not cover the triangles",
                "give objects contiguous ranges of triangles");
  }
  for (std::size_t k = 0; k < scene.ignored.size(); ++k) {
    const ObjectPair& pair = scene.ignored[k];
    if (pair.a < pair.b && pair.b < scene.objects.size() &&
        (k == 0 || scene.ignored[k - 1] < pair)) {
      continue;
    }
    throw Error(where, "the pairs of ignored objects are not two objects each, sorted",
                "give each pair once, its lower object first");
  }
}

std::vector<Box> triangle_boxes(const Scene& scene, unsigned threads) {
  std::vector<Box> boxes(scene.triangles.size(), Box::empty());
  const std::size_t n = boxes.size();
  for_chunks(n, chunks_for(n, 4096, threads), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto [a, b, c] = scene.corners(static_cast<std::uint32_t>(t));
      boxes[t] = {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
    }
  });
  return boxes;
}

std::vector<Box> object_boxes(const Scene& scene, std::span<const Box> triangle_boxes) {
  std::vector<Box> boxes;
  boxes.reserve(scene.objects.size());
  for (const Object& object : scene.objects) {
    Box box = Box::empty();
    for (const Box& b : triangle_boxes.subspan(object.first_triangle, object.triangle_count))
      box.add(b);
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<std::uint32_t> owners(const Scene& scene) {
  std::vector<std::uint32_t> owner(scene.triangles.size());
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) owner[object.first_triangle + i] = o;
  }
  return owner;
}

std::string scene_hash(const Scene& scene) {
  Fnv1a hash;
  hash.add(std::uint64_t{scene.objects.size()});
  for (const Object& object : scene.objects)
    hash.add(object.triangle_count | std::uint64_t{object.self} << 32);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (const Vec3& p : scene.corners(t)) {
      for (int i = 0; i < 3; ++i) hash.add(std::bit_cast<std::uint64_t>(p[i]));
    }
  }
  return hash.hex();
}

std::vector<std::uint32_t> members_of(std::span<const TrianglePair> pairs, std::size_t triangles) {
  std::vector<std::uint8_t> in(triangles, 0);
  for (const TrianglePair& pair : pairs) in[pair.a] = in[pair.b] = 1;
  std::vector<std::uint32_t> out;
  for (std::uint32_t t = 0; t < in.size(); ++t) {
    if (in[t] != 0) out.push_back(t);
  }
  return out;
}

std::uint64_t count_objects(const Scene& scene, std::span<const std::uint32_t> triangles) {
  std::uint64_t objects = 0;
  std::size_t t = 0;
  for (const Object& object : scene.objects) {
    const std::size_t end = static_cast<std::size_t>(object.first_triangle) + object.triangle_count;
    const std::size_t before = t;
    while (t < triangles.size() && triangles[t] < end) ++t;
    objects += t > before;
  }
  return objects;
}

bool has_self(const Scene& scene) { return std::ranges::any_of(scene.objects, &Object::self); }

std::vector<ObjectPair> in_order(std::vector<ObjectPair> pairs, std::span<const ObjectPair> more) {
  pairs.insert(pairs.end(), more.begin(), more.end());
  for (ObjectPair& pair : pairs) {
    if (pair.a > pair.b) std::swap(pair.a, pair.b);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

IgnoredObjects::IgnoredObjects(const Scene& scene, std::span<const ObjectPair> ignored) {
  if (ignored.empty()) return;
  first_.assign(scene.objects.size() + 1, 0);
  for (const ObjectPair& pair : ignored) {
    if (pair.a >= pair.b || pair.b >= scene.objects.size())
      throw std::logic_error("ignored objects: a pair is not two objects of the scene, a < b");
    ++first_[pair.b + 1];
  }
  for (std::size_t o = 1; o < first_.size(); ++o) first_[o] += first_[o - 1];
  others_.resize(ignored.size());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const ObjectPair& pair : ignored) others_[next[pair.b]++] = pair.a;
  for (std::size_t o = 0; o + 1 < first_.size(); ++o)
    std::sort(others_.begin() + static_cast<std::ptrdiff_t>(first_[o]),
              others_.begin() + static_cast<std::ptrdiff_t>(first_[o + 1]));
  owner_ = owners(scene);
}

bool IgnoredObjects::operator()(const TrianglePair& pair) const {
  if (!any()) return false;
  const auto [a, b] = std::minmax(owner_[pair.a], owner_[pair.b]);
  const std::uint32_t* const list = others_.data();
  return std::binary_search(list + first_[b], list + first_[b + 1], a);
}

void require_nothing_ignored(const Scene& scene, const std::string& who) {
  if (scene.ignored.empty()) return;
  throw Error(scene.name, "the scene ignores pairs of objects, and " + who + " answers about all",
              "leave ignore out of the scene file and of the options");
}

std::uint64_t remove_ignored(const Scene& scene, std::span<const ObjectPair> ignored,
                             std::vector<TrianglePair>& pairs) {
  const IgnoredObjects is_ignored(scene, ignored);
  return is_ignored.any() ? std::erase_if(pairs, is_ignored) : 0;
}

void MovedCorners::update(const Scene& scene, const FrameChange* change) {
  ++frame_;
  triangles_.clear();
  known_ = false;
  FrameChange own;
  if (waits_ > 0) {
    --waits_;
    last_.reset();
    change = &own;
  } else if (change == nullptr) {
    own = compare(scene);
    change = &own;
  } else {
    last_.reset();
  }
  // The number of corners must fit into 32 bits.
  if (!change->same || scene.triangles.size() > UINT32_MAX / 3) {
    first_of_.clear();
    return;
  }
  mark(scene, change->vertices);
  known_ = true;
}

FrameChange MovedCorners::compare(const Scene& scene) {
  constexpr std::size_t kAtOnce = 64;  // vertices compared at once; in most groups, no vertex moved
  // The copy is taken out of last_, so that an allocation that throws leaves no partial copy there.
  std::optional<Copy> copy = std::exchange(last_, {});
  FrameChange out;
  const auto but_its_name = [](const Object& o) {
    return std::tuple(o.first_triangle, o.triangle_count, o.self);
  };
  const std::size_t n = scene.vertices.size();
  out.same = copy && copy->vertices.size() == n && copy->triangles == scene.triangles &&
             std::ranges::equal(copy->objects, scene.objects, {}, but_its_name, but_its_name);
  if (!out.same) {
    last_ = {scene.objects, scene.triangles, scene.vertices};
    return out;
  }
  // Compares bits. So -0.0 differs from 0.0, which at most causes unneeded work.
  const auto equal = [&](std::size_t from, std::size_t count) {
    return std::memcmp(copy->vertices[from].data(), scene.vertices[from].data(),
                       count * sizeof(Vec3)) == 0;
  };
  for (std::size_t from = 0; from < n; from += kAtOnce) {
    const std::size_t end = std::min(from + kAtOnce, n);
    if (equal(from, end - from)) continue;
    for (std::size_t v = from; v < end; ++v) {
      if (!equal(v, 1)) out.vertices.push_back(static_cast<std::uint32_t>(v));
    }
    for (std::size_t v = from; v < end; ++v) copy->vertices[v] = scene.vertices[v];
  }
  last_ = std::move(copy);
  return out;
}

void MovedCorners::mark(const Scene& scene, const std::vector<std::uint32_t>& vertices) {
  if (vertices.empty()) return;
  if (first_of_.empty()) {
    std::vector<std::uint32_t> first(scene.vertices.size() + 2, 0);
    std::vector<std::uint32_t> triangles(3 * scene.triangles.size());
    for (const auto& corners : scene.triangles)
      for (const std::uint32_t v : corners) ++first[v + 2];
    for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
      for (const std::uint32_t v : scene.triangles[t]) triangles[first[v + 1]++] = t;
    of_vertex_ = std::move(triangles);
    first_of_ = std::move(first);
  }
  triangle_moved_.assign(scene.triangles.size(), 0);
  for (const std::uint32_t v : vertices) {
    for (std::uint32_t k = first_of_[v]; k < first_of_[v + 1]; ++k) {
      const std::uint32_t t = of_vertex_[k];
      if (std::exchange(triangle_moved_[t], std::uint8_t{1}) == 0) triangles_.push_back(t);
    }
  }
}

void MovedCorners::notify(bool worth_while) {
  if (!known_) return;
  waits_ = worth_while ? 0 : next_waits_;
  next_waits_ = worth_while ? 1 : std::min(2 * next_waits_, kMostWaits);
}

bool mostly_unmoved(const MovedCorners& moved, std::span<const TrianglePair> pairs) {
  constexpr std::size_t kSampled = 256;
  if (pairs.empty()) return !moved.any();
  const std::size_t count = std::min(kSampled, pairs.size());
  std::size_t unmoved = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const TrianglePair& pair = pairs[pairs.size() * k / count];
    unmoved += !moved.triangle(pair.a) && !moved.triangle(pair.b);
  }
  return 2 * unmoved >= count;
}

bool is_invertible(std::array<double, 9> r) {
  for (int row = 0; row < 9; row += 3) {
    const double most = std::max({std::abs(r[row]), std::abs(r[row + 1]), std::abs(r[row + 2])});
    if (!(most > 0)) return false;
    for (int k = row; k < row + 3; ++k) r[k] /= most;
  }
  double sum = 0, magnitudes = 0;
  for (int k = 0; k < 3; ++k) {
    const int l = 3 + (k + 1) % 3, m = 3 + (k + 2) % 3;
    const double p = r[l] * r[m + 3], q = r[m] * r[l + 3];
    sum += r[k] * (p - q);
    magnitudes += std::abs(r[k]) * (std::abs(p) + std::abs(q));
  }
  return std::abs(sum) > 9 * 0x1p-53 * magnitudes;
}

}  // namespace farcull
