// The state of a culling run and one pass over it, explained in core/cull/cull.h. They have a
// header of their own so that tests can run passes by other rules.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/canvas/canvas.h"
#include "core/canvas/fatten.h"

namespace farcull {

enum Bit : std::uint8_t { kF = 1, kL = 2, kCulled = kF | kL };

/// Which live triangles a pass asks and stores. Indices: 0 for the first pass, 1 for the second;
/// then the bits of the triangle (NFV, FFV, SFV, BFV).
struct PassRule {
  bool asks[2][4];
  bool stores[2][4];
  bool clears;  // every level begins without bits
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

/// Each group of triangles is asked by one query. The groups of an owner are consecutive.
struct Level {
  std::uint32_t size;                                 // as Stage::level
  const std::vector<std::uint32_t>* group = nullptr;  // per triangle of the scene; null: each alone
};

struct CullState {
  std::vector<std::uint8_t> bits;     // per triangle of the scene
  std::vector<std::uint32_t> live;    // grouped by owner, owners ascending
  std::vector<std::uint32_t> owner;   // per triangle of the scene
  std::uint64_t changes[2] = {1, 1};  // 1 + how often an F bit was set; likewise L
  std::uint64_t culled = 0;           // triangles that have both bits

  /// Sets a bit of a live triangle.
  void set(std::uint32_t triangle, Bit bit);
  /// Removes the culled triangles from `live`.
  void remove_culled();
  /// Clears the bits of all live triangles.
  void clear_bits();
};

/// The items of one owner that are not culled.
struct OpenItems {
  std::uint64_t elements = 0;
  std::uint32_t drawn = 0;       // items that have elements
  std::uint32_t undrawable = 0;  // items beyond the budget; they stay open
};

/// The triangles that one visit of a view asks and stores.
struct VisitItems {
  VisitItems() = default;
  /// Takes the live triangles.
  explicit VisitItems(const CullState& state);
  /// Marks the items that cannot be drawn, and counts all. Call it when their drawables are made.
  void take_drawables(const Drawables& drawables);
  /// Subtracts an item, which has been culled, from the open ones of its owner.
  void close(std::uint32_t item, const Drawables& drawables);

  std::vector<std::uint32_t> items;        // triangles, in the order of the drawables
  std::vector<std::uint32_t> owner_begin;  // index in items per owner with items; then items.size()
  std::vector<std::uint8_t> undrawable;    // per item; empty: none is
  std::vector<OpenItems> open;             // per owner with items
};

struct PassCost {
  std::uint64_t draws = 0;    // elements drawn
  std::uint64_t queries = 0;  // slots asked
  PassCost& operator+=(const PassCost& other) {
    draws += other.draws;
    queries += other.queries;
    return *this;
  }
};

/// Runs one pass on the canvas, owner by owner (ascending if F is asked, descending if L is): asks
/// by the rule, then stores by the rule. Triangles not seen get the bit after the pass. Two kinds
/// get it without being drawn: triangles without elements in this view, and those asked before
/// anything is stored. Undrawable ones get no bit and are stored everywhere. Stores that no later
/// query reads are left out.
PassCost run_pass(CullState& state, VisitItems& items, const Drawables& drawables, Bit ask,
                  const PassRule& rule, const Level& level, bool touching, Canvas& canvas);

/// The cost of plain CULLIDE's pass on the same live triangles: elements drawn and slots asked.
PassCost plain_cost(const CullState& state, const VisitItems& items, const Drawables& drawables,
                    Bit ask, const Level& level);

}  // namespace farcull
