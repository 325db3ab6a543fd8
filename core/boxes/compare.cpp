// Compares the boxes of two blocks in floats: one box with as many others at once as a vector
// register holds. Uses comparisons, sums and products of floats, but no fused multiply-add. So
// every instruction set gives the same pairs in the same order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/boxes/compare.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>

#include "core/boxes/compare.h"
#include "core/boxes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Numbers = boxes::Tag<float>;
using Words = hn::RebindToUnsigned<Numbers>;
using WordMask = hn::Mask<Words>;
using OneBox = boxes::OneBox<float>;
constexpr std::size_t kLanes = boxes::kLanes<float>;
static_assert(kWide % kLanes == 0);

// Returns a mask of lanes, from lane `from` on. A lane is set if its triangle and the box overlap
// in the projection on the triangle's normal.
HWY_INLINE hn::Mask<Numbers> near(const NormalLanes& normals, std::size_t from, const OneBox& box) {
  auto lo = hn::Zero(Numbers()), hi = lo;
  const auto add = [&](std::size_t k, hn::Vec<Numbers> low, hn::Vec<Numbers> high) {
    const auto direction = hn::Load(Numbers(), &normals.normal[k][from]);
    const auto p = hn::Mul(direction, low), q = hn::Mul(direction, high);
    lo = hn::Add(lo, hn::Min(p, q));
    hi = hn::Add(hi, hn::Max(p, q));
  };
  add(0, box.x0, box.x1);
  add(1, box.y0, box.y1);
  add(2, box.z0, box.z1);
  return hn::And(hn::Le(lo, hn::Load(Numbers(), &normals.hi[from])),
                 hn::Ge(hi, hn::Load(Numbers(), &normals.lo[from])));
}

HWY_INLINE std::uint32_t near_bits(const NormalLanes& normals, const OneBox& box) {
  std::uint32_t out = 0;
  for (std::size_t from = 0; from < kWide; from += kLanes)
    out |= boxes::bits_of(Numbers(), near(normals, from, box)) << from;
  return out;
}

struct Comparison {
  const BlockLanes& a;
  const BlockLanes& b;
  const VertexBlock* a_vertices;  // null: pairs with a common vertex are kept
  const VertexBlock* b_vertices;
  const NormalLanes* a_normals;  // null: normals are not compared
  const NormalLanes* b_normals;

  // Appends the overlapping pairs. Precondition: each list has room for 272 more pairs.
  HWY_INLINE void write(TrianglePair*& certain, TrianglePair*& perhaps) const {
    const OneBox bound(b.bound);
    std::uint32_t rows = boxes::overlapping_bits(a.boxes, bound);
    if (a_normals != nullptr && rows != 0) {
      rows &= near_bits(*a_normals, bound);
      if (rows == 0 || near_bits(*b_normals, OneBox(a.bound)) == 0) return;
    }
    while (rows != 0) write_row(boxes::next_bit(rows), certain, perhaps);
  }
  HWY_INLINE void write_row(std::size_t row, TrianglePair*& certain, TrianglePair*& perhaps) const {
    const OneBox box(a.boxes, row);
    const bool same = &a == &b;
    for (std::size_t from = same ? row / kLanes * kLanes : 0; from < kWide; from += kLanes) {
      WordMask met = hn::RebindMask(Words(), boxes::overlapping(b.boxes, from, box));
      if (same) met = hn::And(met, behind(row, from));
      if (hn::AllFalse(Words(), met)) continue;
      if (a_vertices != nullptr) {
        met = hn::And(met, hn::Not(neighbours(row, from)));
        if (hn::AllFalse(Words(), met)) continue;
      }
      if (a_normals != nullptr) {
        met = hn::And(met, hn::RebindMask(Words(), near(*b_normals, from, box)));
        if (hn::AllFalse(Words(), met)) continue;
        met = hn::And(met, hn::RebindMask(Words(), near_row(row, from)));
        if (hn::AllFalse(Words(), met)) continue;
      }
      const WordMask inside =
          hn::RebindMask(Words(), boxes::overlapping_inside(b.boxes, from, box));
      put(row, from, hn::And(met, inside), certain);
      const WordMask touching = hn::And(met, hn::Not(inside));
      if (!hn::AllFalse(Words(), touching)) put(row, from, touching, perhaps);
    }
  }
  // Returns a mask of b's boxes that overlap triangle `row` of a in the projection on its normal.
  HWY_INLINE hn::Mask<Numbers> near_row(std::size_t row, std::size_t from) const {
    auto lo = hn::Zero(Numbers()), hi = lo;
    for (std::size_t k = 0; k < 3; ++k) {
      const float n = a_normals->normal[k][row];
      const auto direction = hn::Set(Numbers(), n);
      const std::size_t low = n < 0 ? k + 3 : k, high = n < 0 ? k : k + 3;
      lo = hn::Add(lo, hn::Mul(direction, boxes::column(b.boxes, low, from)));
      hi = hn::Add(hi, hn::Mul(direction, boxes::column(b.boxes, high, from)));
    }
    return hn::And(hn::Le(lo, hn::Set(Numbers(), a_normals->hi[row])),
                   hn::Ge(hi, hn::Set(Numbers(), a_normals->lo[row])));
  }
  // Returns a mask of lanes, from lane `from` on. A lane is set if its index is above `row`.
  HWY_INLINE WordMask behind(std::size_t row, std::size_t from) const {
    return hn::Gt(hn::Iota(Words(), static_cast<std::uint32_t>(from)),
                  hn::Set(Words(), static_cast<std::uint32_t>(row)));
  }
  HWY_INLINE WordMask neighbours(std::size_t row, std::size_t from) const {
    const Words w;
    const auto p = hn::Load(w, &b_vertices->corner[0][from]),
               q = hn::Load(w, &b_vertices->corner[1][from]),
               r = hn::Load(w, &b_vertices->corner[2][from]);
    const auto has = [&](std::size_t corner) {
      const auto v = hn::Set(w, a_vertices->corner[corner][row]);
      return hn::Or(hn::Or(hn::Eq(p, v), hn::Eq(q, v)), hn::Eq(r, v));
    };
    return hn::Or(hn::Or(has(0), has(1)), has(2));
  }
  HWY_INLINE void put(std::size_t row, std::size_t from, WordMask mask, TrianglePair*& out) const {
    const Words w;
    const auto one = hn::Set(w, a.triangles[row]);
    const auto others = hn::Compress(hn::Load(w, &b.triangles[from]), mask);
    hn::StoreInterleaved2(hn::Min(one, others), hn::Max(one, others), w, &out->a);
    out += hn::CountTrue(w, mask);
  }
};

}  // namespace

void compare_blocks_here(const LaneSpans& lanes, std::span<const VertexBlock> vertices,
                         std::span<const NormalLanes> normals, std::span<const LanePair> pairs,
                         BlockFindings& out) {
  constexpr std::size_t kRoom = 17 * 16, kFlush = 4096;
  std::vector<TrianglePair> certain(kFlush + kRoom), perhaps(kFlush + kRoom);
  TrianglePair *next = certain.data(), *next_perhaps = perhaps.data();
  const auto flush = [](std::vector<TrianglePair>& from, TrianglePair*& end, std::size_t least,
                        std::vector<TrianglePair>& to) {
    if (static_cast<std::size_t>(end - from.data()) < least) return;
    to.insert(to.end(), from.data(), end);
    end = from.data();
  };
  const bool along = !normals.empty();
  for (const LanePair& pair : pairs) {
    const bool drops = pair.drops_neighbours;
    Comparison{lanes[pair.a],
               lanes[pair.b],
               drops ? &vertices[pair.a] : nullptr,
               drops ? &vertices[pair.b] : nullptr,
               along ? &normals[pair.a] : nullptr,
               along ? &normals[pair.b] : nullptr}
        .write(next, next_perhaps);
    flush(certain, next, kFlush, out.pairs);
    flush(perhaps, next_perhaps, kFlush, out.perhaps);
  }
  flush(certain, next, 0, out.pairs);
  flush(perhaps, next_perhaps, 0, out.perhaps);
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

HWY_EXPORT(compare_blocks_here);

void compare_blocks(const LaneSpans& lanes, std::span<const VertexBlock> vertices,
                    std::span<const NormalLanes> normals, std::span<const LanePair> pairs,
                    BlockFindings& out) {
  HWY_DYNAMIC_DISPATCH(compare_blocks_here)(lanes, vertices, normals, pairs, out);
}

std::optional<NormalMargin> normal_margin(float reach, double clearance) {
  // No box corner is farther than `farthest` from the origin. kMargin * farthest bounds the
  // rounding error of a comparison with a box (docs/reliability.md, "Boxes of blocks").
  constexpr double kMargin = 0x1p-20;
  const double farthest = 1.74 * static_cast<double>(reach);  // 1.74 > sqrt(3)
  if (!(farthest >= 0x1p-60 && farthest <= 0x1p60)) return std::nullopt;
  return NormalMargin{static_cast<float>(farthest),
                      static_cast<float>(kMargin * farthest + 1.001 * clearance)};
}

void fill_normals(const Scene& scene, std::span<const std::uint32_t> triangles, const Vec3& origin,
                  const NormalMargin& margin, NormalLanes& out) {
  std::array<std::array<std::array<float, kWide>, 3>, 3> corner;  // corner, coordinate, lane
  for (std::size_t lane = 0; lane < kWide; ++lane) {
    // An unused lane repeats the last triangle. The box of an unused lane in BlockLanes is empty.
    const std::uint32_t t = triangles[std::min(lane, triangles.size() - 1)];
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 at = scene.vertices[scene.triangles[t][c]] - origin;
      for (std::size_t k = 0; k < 3; ++k)
        corner[c][k][lane] = static_cast<float>(at[static_cast<Eigen::Index>(k)]);
    }
  }
  const float scale = 1 / margin.reach;
  for (std::size_t lane = 0; lane < kWide; ++lane) {
    std::array<float, 3> u, v, n;
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = scale * (corner[1][k][lane] - corner[0][k][lane]);
      v[k] = scale * (corner[2][k][lane] - corner[0][k][lane]);
    }
    for (std::size_t k = 0; k < 3; ++k)
      n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    // A triangle that is too small or too thin has the normal 0, which separates nothing.
    constexpr float kLeast = 0x1p-100f;
    const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    const float inverse = square > kLeast ? 1 / std::sqrt(square) : 0;
    std::array<float, 3> at = {0, 0, 0};  // positions of the three corners along the normal
    for (std::size_t k = 0; k < 3; ++k) {
      out.normal[k][lane] = inverse * n[k];
      for (std::size_t c = 0; c < 3; ++c) at[c] += out.normal[k][lane] * corner[c][k][lane];
    }
    out.lo[lane] = std::min({at[0], at[1], at[2]}) - margin.margin;
    out.hi[lane] = std::max({at[0], at[1], at[2]}) + margin.margin;
  }
}

}  // namespace farcull
#endif
