// Makes the trees from the blocks of core/boxes/triangle_blocks.h. The blocks are sorted, so that
// sixteen consecutive blocks lie near each other. A long search is divided into at most kParts
// parts. After each part has examined some pairs, the parts are joined and divided again.
#include "core/proximity/scene_trees.h"

#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace farcull {

SceneTrees::SceneTrees(const Scene& scene, unsigned threads, Settle settle)
    : scene_(&scene), settle_(std::move(settle)), of_(make_ordered_blocks(scene, 0, threads)) {
  double most = 0;
  for (const Box& box : of_.objects) {
    if (box.is_empty()) continue;
    most = std::max({most, box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff()});
  }
  if (most > 0) scale_ = std::ldexp(1.0, std::clamp(-std::ilogb(most), -1022, 1000));
  make_trees(threads);
  make_object_tree();
}

void SceneTrees::make_trees(unsigned threads) {
  const std::size_t objects = scene_->objects.size();
  std::vector<std::size_t> first(objects);
  std::size_t blocks = 0;
  for (std::size_t o = 0; o < objects; ++o) {
    first[o] = blocks;
    blocks += blocks_of_tree(of_.count(static_cast<std::uint32_t>(o)));
  }
  blocks_.resize(blocks);
  least_.resize(blocks);
  trees_.resize(objects);
  place_.resize(of_.ranges.size());
  for_each_shared(objects, threads, [&](std::size_t o) {
    const std::uint32_t from = of_.first[o], n = of_.count(static_cast<std::uint32_t>(o));
    const auto place = std::span(place_).subspan(from, n);
    spatial_order(std::span(of_.boxes).subspan(from, n), place);
    std::vector<Box> leaves(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Box& box = of_.boxes[place[k] += from];
      leaves[k] = {box.lo * scale_, box.hi * scale_};
    }
    trees_[o] = make_tree<double>(leaves, blocks_, first[o]);
    find_least(static_cast<std::uint32_t>(o));
  });
}

void SceneTrees::find_least(std::uint32_t object) {
  const BoxTree<double>& tree = trees_[object];
  std::vector<std::uint32_t> least(tree.leaves, UINT32_MAX);
  for (std::uint32_t n = 0; n < least.size(); ++n) {
    const std::uint32_t at = leaf(object, n);
    for (std::uint32_t k = 0; k < count(at); ++k) least[n] = std::min(least[n], triangle(at, k));
  }
  for (std::size_t height = 0; height < static_cast<std::size_t>(tree.levels); ++height) {
    const std::size_t n = (least.size() + kWide - 1) / kWide;
    for (std::size_t block = 0; block < n; ++block) {
      auto& of_block = least_[tree.first[height] + block];
      of_block.fill(UINT32_MAX);
      const std::size_t end = std::min(least.size() - kWide * block, std::size_t{kWide});
      std::copy_n(least.begin() + static_cast<std::ptrdiff_t>(kWide * block), end,
                  of_block.begin());
      least[block] = *std::ranges::min_element(of_block);
    }
    least.resize(n);
  }
}

namespace {

constexpr std::size_t kMostParts = 64;

// Node k of an object's tree, at the given height. Height -1 means triangle k of a leaf.
struct Part {
  Box box;
  double square;  // squared length of the box's diagonal
  int height;
  std::uint32_t k;
};
Part part_of(const Box& box, int height, std::uint32_t k) {
  return {box, (box.hi - box.lo).squaredNorm(), height, k};
}

std::vector<Part> children_of(const SceneTrees& trees, std::uint32_t object, const Part& part) {
  std::vector<Part> out;
  if (part.height == 0) {
    const std::uint32_t leaf = trees.leaf(object, part.k);
    for (std::uint32_t k = 0; k < trees.count(leaf); ++k) {
      Box box = Box::empty();
      for (std::size_t c = 0; c < 3; ++c) box.add(trees.corner(trees.triangle(leaf, k), c));
      out.push_back(part_of(box, -1, k));
    }
    return out;
  }
  const auto below = static_cast<std::size_t>(part.height - 1);
  const WideBoxes<double>& block = trees.blocks()[trees.tree(object).first[below] + part.k];
  for (std::uint32_t lane = 0; lane < kWide; ++lane) {
    const Box box = block.get(lane);
    if (!box.is_empty()) out.push_back(part_of(box, part.height - 1, kWide * part.k + lane));
  }
  return out;
}

}  // namespace

// Divides nodes into their children, the largest node first. A node is divided if the squared
// diagonals of its children's boxes sum to less than half the squared diagonal of its own box. A
// compact surface stays one part, because there the sum is about as large as the squared diagonal.
// Triangles far from each other become several parts, because the boxes of children are small.
void SceneTrees::add_parts(std::uint32_t object) {
  const auto is_smaller = [](const Part& x, const Part& y) { return x.square < y.square; };
  std::vector<Part> open = {part_of(trees_[object].box, trees_[object].levels, 0)};
  const std::size_t most = parts_.size() + kMostParts;
  while (!open.empty()) {
    std::ranges::pop_heap(open, is_smaller);
    const Part part = open.back();
    open.pop_back();
    if (part.height >= 0) {
      const std::vector<Part> children = children_of(*this, object, part);
      double sum = 0;
      for (const Part& child : children) sum += child.square;
      const bool divides = sum < part.square / 2 || children.size() == 1;
      if (divides && parts_.size() + open.size() + children.size() <= most) {
        for (const Part& child : children) {
          open.push_back(child);
          std::ranges::push_heap(open, is_smaller);
        }
        continue;
      }
    }
    parts_.push_back(part.box);
  }
}

void SceneTrees::make_object_tree() {
  std::vector<std::uint32_t> objects;
  for (std::uint32_t o = 0; o < trees_.size(); ++o) {
    first_part_.push_back(parts_.size());
    if (trees_[o].levels > 0) add_parts(o);
    objects.resize(parts_.size(), o);
  }
  first_part_.push_back(parts_.size());
  std::vector<std::uint32_t> order(parts_.size());
  spatial_order(parts_, order);
  std::vector<Box> leaves(parts_.size());
  object_of_leaf_.resize(parts_.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    leaves[k] = parts_[order[k]];
    object_of_leaf_[k] = objects[order[k]];
  }
  const std::size_t at = blocks_.size();
  blocks_.resize(at + blocks_of_tree(leaves.size()));
  objects_ = make_tree<double>(leaves, blocks_, at);
}

Reaches::Reaches(const SceneTrees& trees, std::uint32_t object,
                 const std::function<double(std::uint32_t)>& reach) {
  const BoxTree<double>& tree = trees.tree(object);
  triangles.assign(kWide * tree.leaves, -std::numeric_limits<double>::infinity());
  for (std::uint32_t n = 0; n < tree.leaves; ++n) {
    const std::uint32_t leaf = trees.leaf(object, n);
    for (std::uint32_t k = 0; k < trees.count(leaf); ++k)
      triangles[kWide * n + k] = reach(trees.triangle(leaf, k));
  }
  const std::vector<double>* below = &triangles;
  for (int height = 0; height <= tree.levels; ++height) {
    std::vector<double> own((below->size() + kWide - 1) / kWide);
    for (std::size_t k = 0; k < own.size(); ++k) {
      const auto from = below->begin() + static_cast<std::ptrdiff_t>(kWide * k);
      const auto left = below->end() - from;
      own[k] = *std::max_element(from, from + std::min<std::ptrdiff_t>(left, kWide));
    }
    nodes.push_back(std::move(own));
    below = &nodes.back();
  }
}

void load_leaf(const SceneTrees& trees, std::uint32_t leaf, BlockCorners& out) {
  const Scene& scene = trees.scene();
  out.leaf = leaf;
  out.count = trees.count(leaf);
  out.direction = 0;
  // Prefetches, because triangles and their corners may lie anywhere in memory.
  for (std::uint32_t k = 0; k < kWide; ++k) {
    out.triangle[k] = trees.triangle(leaf, std::min(k, out.count - 1));
    __builtin_prefetch(&scene.triangles[out.triangle[k]]);
  }
  for (const std::uint32_t triangle : out.triangle) prefetch(scene, triangle);
  for (std::uint32_t k = 0; k < kWide; ++k) {
    const auto& vertices = scene.triangles[out.triangle[k]];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const double* p = scene.vertices[vertices[corner]].data();
      for (std::size_t axis = 0; axis < 3; ++axis)
        out.corner[3 * corner + axis][k] = p[axis] * trees.scale();
    }
  }
  // The compiler vectorizes these loops over columns.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto &p = out.corner[axis], &q = out.corner[3 + axis], &r = out.corner[6 + axis];
    auto &lo = out.boxes.column[axis], &hi = out.boxes.column[3 + axis];
    for (std::size_t k = 0; k < kWide; ++k) {
      lo[k] = std::min(std::min(p[k], q[k]), r[k]);
      hi[k] = std::max(std::max(p[k], q[k]), r[k]);
    }
    std::fill(lo.begin() + out.count, lo.end(), std::numeric_limits<double>::infinity());
    std::fill(hi.begin() + out.count, hi.end(), -std::numeric_limits<double>::infinity());
  }
}

bool share_position(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const auto &own = scene.triangles[a], &other = scene.triangles[b];
  if (share_index(own, other)) return true;
  for (const std::uint32_t v : own) {
    for (const std::uint32_t w : other) {
      if (scene.vertices[v] == scene.vertices[w]) return true;
    }
  }
  return false;
}

void Others::add(const TrianglePair& pair, double bound) {
  if (bound > upper()) return;
  const std::uint32_t other = other_of(pair);
  const auto same = std::ranges::find(nearest, other, &std::pair<double, std::uint32_t>::second);
  if (same != nearest.end()) {
    if (same->first <= bound) return;
    nearest.erase(same);
  }
  const std::pair entry(bound, other);
  nearest.insert(std::ranges::lower_bound(nearest, entry), entry);
  if (nearest.size() > k) nearest.pop_back();
  if (!ties && upper() == 0) {
    const Object& last = scene.objects[nearest.back().second];
    end = last.first_triangle + last.triangle_count;
  }
}

void settle(const SceneTrees& trees, Search& search) {
  if (!trees.settle()) return;
  std::vector<TrianglePair> pairs;
  pairs.reserve(search.kept.size());
  for (const KeptPair& kept : search.kept) pairs.push_back(kept.pair);
  std::ranges::sort(pairs);
  const SettledPair settled = trees.settle()(pairs);
  KeptPair kept = *std::ranges::find(search.kept, settled.pair, &KeptPair::pair);
  kept.upper =
      std::min(kept.upper, settled.distance == 0 ? 0 : scaled_limit(trees, settled.distance));
  search.upper = std::min(search.upper, kept.upper);
  search.kept.assign(1, kept);
  search.settled = settled.pair;
  if (settled.distance == 0) {
    search.first = std::min(search.first, settled.pair);
  } else if (!search.is_part && (!search.planes || search.planes->pair != settled.pair)) {
    const auto back = [&](std::uint32_t triangle) { return -settled.start(triangle); };
    search.planes = std::make_shared<const Planes>(
        Planes{settled.pair, Reaches(trees, search.objects.a, settled.reach),
               Reaches(trees, search.objects.b, back)});
  }
}

void Search::filter() {
  std::erase_if(kept, [this, most = bound()](const KeptPair& k) {
    return k.lower > most || is_behind(k.pair);
  });
}

namespace {

constexpr std::size_t kParts = 32;

// Moves the open pairs of a search to new searches, which begin with the same bound.
std::vector<Search> divide(Search& search) {
  std::vector<Search> out(std::min(kParts, search.open.size()));
  for (Search& part : out) {
    part.objects = search.objects;
    part.limit = search.limit;
    part.upper = search.upper;
    part.first = search.first;
    part.direction = search.direction;
    part.settled = search.settled;
    part.planes = search.planes;
    part.is_part = true;
    const auto settled = std::ranges::find(search.kept, search.settled, &KeptPair::pair);
    if (settled != search.kept.end()) part.kept.push_back(*settled);
  }
  // A search examines its last open pair first. Each part keeps the order of its pairs.
  const std::size_t n = search.open.size();
  for (std::size_t k = 0; k < n; ++k) out[(n - 1 - k) % out.size()].open.push_back(search.open[k]);
  search.open.clear();
  return out;
}

// Adds a part's kept pairs, open pairs and counts to the search that was divided.
void join(Search& part, Search& search) {
  if (part.upper < search.upper) {
    search.upper = part.upper;
    search.direction = part.direction;
  }
  search.first = std::min(search.first, part.first);
  search.open.insert(search.open.end(), part.open.begin(), part.open.end());
  for (const KeptPair& kept : part.kept) {
    if (kept.pair != search.settled) search.kept.push_back(kept);
  }
  search.counts.add_work(part.counts);
  part = Search();
}

}  // namespace

double scaled_limit(const SceneTrees& trees, double within) {
  // A subnormal product is rounded. The next larger number is at least the exact product.
  return std::nextafter(within * trees.scale(), std::numeric_limits<double>::infinity());
}

void require_room(const SceneTrees& trees, const Search& search, std::size_t most) {
  if (search.kept.size() <= most) return;
  throw Error(trees.scene().name,
              "more than " + std::to_string(most) + " pairs of triangles of the objects " +
                  std::to_string(search.objects.a) + " and " + std::to_string(search.objects.b) +
                  " may be nearest",
              "leave one of the objects out, or drop triangles that are there twice");
}

void go_on_divided(const SceneTrees& trees, unsigned threads, Search& search, std::size_t most) {
  while (!search.open.empty()) {
    std::vector<Search> parts = divide(search);
    for_each_with_memory<SearchMemory>(parts.size(), threads,
                                       [&](std::size_t k, SearchMemory& memory) {
                                         go_on(trees, kLeafPairsAtOnce, parts[k], memory);
                                       });
    for (Search& part : parts) join(part, search);
    search.filter();
    if (2 * search.kept.size() > search.kept_most) settle(trees, search);
    require_room(trees, search, most);
  }
}

NearPairs answer(const SceneTrees& trees, Search& search) {
  search.filter();
  search.counts.kept = search.kept.size();
  NearPairs out;
  out.objects = search.objects;
  double upper = std::numeric_limits<double>::infinity();
  out.pairs.reserve(search.kept.size());
  for (const KeptPair& k : search.kept) {
    out.pairs.push_back(k.pair);
    upper = std::min(upper, k.upper);
  }
  std::ranges::sort(out.pairs);
  // A subnormal quotient is rounded. The next larger number is at least the exact quotient.
  out.upper = std::nextafter(upper / trees.scale(), std::numeric_limits<double>::infinity());
  return out;
}

}  // namespace farcull
