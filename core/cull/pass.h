// The state of a culling run, and a pass over it. core/cull/cull.h explains passes. Tests include
// this header to run passes by other rules.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/canvas/canvas.h"
#include "core/canvas/fatten.h"

namespace farcull {

enum Bit : std::uint8_t { kF = 1, kL = 2, kCulled = kF | kL };

/// Which live triangles a pass asks and stores. The first index is 0 for the first pass and 1 for
/// the second pass. The second index is the bits of the triangle (NFV, FFV, SFV, BFV).
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

/// One query asks all triangles of a group. The groups of an owner are consecutive.
struct Level {
  std::uint32_t size;                                 // as Stage::level
  const std::vector<std::uint32_t>* group = nullptr;  // per triangle; null: one group per triangle
};

struct CullState {
  std::vector<std::uint8_t> bits;     // per triangle of the scene
  std::vector<std::uint32_t> live;    // grouped by owner, owners ascending
  std::vector<std::uint32_t> owner;   // per triangle of the scene
  std::uint64_t changes[2] = {1, 1};  // for F and for L: 1 + how often the bit was set
  std::uint64_t culled = 0;           // number of triangles that have got both bits

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
  std::uint32_t drawn = 0;       // number of items that have elements
  std::uint32_t undrawable = 0;  // number of items beyond the budget; they are never culled
};

/// The triangles that one visit of a view asks and stores.
struct VisitItems {
  VisitItems() = default;
  /// Takes the live triangles of the state.
  explicit VisitItems(const CullState& state);
  /// Sets `undrawable` and `open`. Precondition: the drawables of the items are made.
  void take_drawables(const Drawables& drawables);
  /// Subtracts an item that has been culled from the counts in `open`.
  void close(std::uint32_t item, const Drawables& drawables);

  std::vector<std::uint32_t> items;  // triangles, in the order of the drawables
  std::vector<std::uint32_t>
      owner_begin;                       // per owner with items: index in items; then items.size()
  std::vector<std::uint8_t> undrawable;  // per item; empty: no item is undrawable
  std::vector<OpenItems> open;           // per owner with items
};

struct PassCost {
  std::uint64_t draws = 0;    // elements drawn
  std::uint64_t queries = 0;  // number of slots
  PassCost& operator+=(const PassCost& other) {
    draws += other.draws;
    queries += other.queries;
    return *this;
  }
};

/// Runs one pass on the canvas, owner by owner. Owners ascend if `ask` is F and descend if it is L.
/// For each owner the rule says which triangles are asked, and then which are stored. An asked
/// triangle that is not seen gets the bit after the pass. A triangle gets the bit without being
/// drawn if it has no elements in this view, or if nothing has been stored before it. Undrawable
/// triangles get no bit and are stored everywhere. Stores that no later query reads are left out.
PassCost run_pass(CullState& state, VisitItems& items, const Drawables& drawables, Bit ask,
                  const PassRule& rule, const Level& level, bool touching, Canvas& canvas);

/// Returns the cost of plain CULLIDE's pass on the same live triangles.
PassCost plain_cost(const CullState& state, const VisitItems& items, const Drawables& drawables,
                    Bit ask, const Level& level);

}  // namespace farcull
