// The state of a culling run, and the function that runs one pass. core/cull/cull.h explains
// passes. Tests include this header to run passes by other rules.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/canvas/canvas.h"
#include "core/canvas/fatten.h"

namespace farcull {

enum Bit : std::uint8_t { kF = 1, kL = 2, kCulled = kF | kL };

/// Which live triangles a pass asks and stores. First index: 0 for the first pass, 1 for the second
/// pass. Second index: the bits of the triangle (0 to 3: NFV, FFV, SFV, BFV).
struct PassRule {
  bool asks[2][4];
  bool stores[2][4];
  bool clears;  // true: the bits are cleared before every level
};
constexpr PassRule kPlainRule = {
    .asks = {{true, true, true, false}, {true, true, true, false}},
    .stores = {{true, true, true, false}, {true, true, true, false}},
    .clears = true,
};
constexpr PassRule kQuickRule = {
    .asks = {{true, false, true, false}, {true, true, false, false}},
    .stores = {{true, true, false, false}, {true, false, true, false}},
    .clears = false,
};

/// At a level, one query tests all triangles of a group. A group belongs to one owner.
struct Level {
  std::uint32_t size;                                 // as Stage::level
  const std::vector<std::uint32_t>* group = nullptr;  // per triangle; null: one group per triangle
};

struct CullState {
  std::vector<std::uint8_t> bits;     // per triangle of the scene
  std::vector<std::uint32_t> live;    // triangles that are not culled, sorted by owner
  std::vector<std::uint32_t> owner;   // per triangle of the scene
  std::uint64_t changes[2] = {1, 1};  // for F and L: 1 + how often set() has set the bit
  std::uint64_t culled = 0;           // how often set() has set the second bit of a triangle

  /// Sets a bit of a live triangle, and updates `changes` and `culled`.
  void set(std::uint32_t triangle, Bit bit);
  /// Removes the culled triangles from `live`.
  void remove_culled();
  /// Clears the bits of all live triangles.
  void clear_bits();
};

/// Counts of the items of one owner that are not culled yet.
struct OpenItems {
  std::uint64_t elements = 0;
  std::uint32_t drawn = 0;       // number of items with elements
  std::uint32_t undrawable = 0;  // number of items beyond the error budget, which are never culled
};

/// The items (live triangles) of one visit of a view.
struct VisitItems {
  VisitItems() = default;
  /// Sets `items` to the live triangles of the state, and sets `owner_begin`.
  explicit VisitItems(const CullState& state);
  /// Sets `undrawable` and `open`. drawables: the drawables of the items.
  void take_drawables(const Drawables& drawables);
  /// Removes a culled item from the counts in `open`.
  void close(std::uint32_t item, const Drawables& drawables);

  std::vector<std::uint32_t> items;  // triangles, in the order of the drawables
  std::vector<std::uint32_t>
      owner_begin;                       // per owner with items: its first item; then items.size()
  std::vector<std::uint8_t> undrawable;  // per item; empty: no item is undrawable
  std::vector<OpenItems> open;           // per owner with items
};

struct PassCost {
  std::uint64_t draws = 0;    // number of elements drawn
  std::uint64_t queries = 0;  // number of slots tested
  PassCost& operator+=(const PassCost& other) {
    draws += other.draws;
    queries += other.queries;
    return *this;
  }
};

/// Runs one pass on the canvas, owner by owner. Owners ascend if `ask` is F and descend if it is L.
/// For each owner, first asks and then stores the triangles that the rule selects. After the pass,
/// sets the bit of each asked triangle that is not seen. An asked triangle without elements, or
/// before the first store, gets the bit without being drawn. Undrawable triangles get no bit and
/// are stored as kEverywhere. Skips stores that no later query reads.
PassCost run_pass(CullState& state, VisitItems& items, const Drawables& drawables, Bit ask,
                  const PassRule& rule, const Level& level, bool touching, Canvas& canvas);

/// Returns what the pass of plain CULLIDE would cost on the same live triangles.
PassCost plain_cost(const CullState& state, const VisitItems& items, const Drawables& drawables,
                    Bit ask, const Level& level);

}  // namespace farcull
