#include "core/cull.h"

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "core/stopwatch.h"

namespace farcull {
namespace {

enum Bit : std::uint8_t { kF = 1, kL = 2, kCulled = kF | kL };
enum class Level { object, triangle };

// The state of a run: who is live, who owns whom, and how often each kind of bit was set (a pass
// whose stored set has not changed since it last ran would give the same answers).
struct State {
  std::vector<std::uint8_t> bits;     // per triangle of the scene
  std::vector<std::uint32_t> live;    // ascending triangle indices
  std::vector<std::uint32_t> owner;   // per triangle of the scene
  std::uint64_t changes[2] = {1, 1};  // how often F, L bits were set
  std::uint64_t deaths = 1;

  void set(std::uint32_t triangle, Bit bit) {
    if (bits[triangle] & bit) return;
    bits[triangle] |= bit;
    ++changes[bit == kL];
    if (bits[triangle] == kCulled) ++deaths;
  }
};

// One pass in the making: the items of each owner, drawn for slots.
class PassBuilder {
 public:
  PassBuilder(State& state, std::span<const std::uint32_t> items, const Drawables& drawables,
              Bit ask, bool economy, Level level)
      : state_(state),
        items_(items),
        drawables_(drawables),
        ask_(ask),
        economy_(economy),
        level_(level) {
    undrawable_.resize(items.size());
    for (const std::uint32_t item : drawables.undrawable) undrawable_[item] = 1;
  }

  // Builds the pass over all owners, ascending where F is asked, descending where L is; sets the
  // bits that need no drawing: of items without elements in this view, and of all that come before
  // anything is stored.
  Pass build() {
    std::size_t begin = 0, end = items_.size();
    while (begin < end) {
      const bool ascending = ask_ == kF;
      const std::uint32_t owner = state_.owner[items_[ascending ? begin : end - 1]];
      std::size_t from = begin, to = end;
      if (ascending) {
        while (begin < end && state_.owner[items_[begin]] == owner) ++begin;
        to = begin;
      } else {
        while (end > begin && state_.owner[items_[end - 1]] == owner) --end;
        from = end;
      }
      add_owner(from, to);
    }
    while (!pass_.steps.empty() &&
           pass_.steps.back().verb == Verb::store) {  // nobody is asked after them
      pass_.draws.resize(pass_.steps.back().first);
      pass_.steps.pop_back();
    }
    pass_.slots = static_cast<std::uint32_t>(slots_.size());
    return std::move(pass_);
  }

  // Sets the bits of the slots that were not seen.
  void apply(const std::vector<std::uint8_t>& seen) {
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
      if (seen[slot]) continue;
      for (const std::uint32_t item : slots_[slot]) state_.set(items_[item], ask_);
    }
  }

  std::size_t slots() const { return slots_.size(); }

 private:
  bool has_bit(std::size_t item, Bit bit) const { return state_.bits[items_[item]] & bit; }
  bool is_live(std::size_t item) const { return state_.bits[items_[item]] != kCulled; }

  void add_owner(std::size_t from, std::size_t to) {
    const Step ask{Verb::ask, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    std::vector<std::uint32_t> asked;
    for (std::size_t i = from; i < to; ++i) {
      if (!is_live(i) || has_bit(i, ask_)) continue;
      if (undrawable_[i]) continue;  // never cleared
      if (!anything_stored_ || drawables_.first[i] == drawables_.first[i + 1]) {
        state_.set(items_[i], ask_);
      } else {
        asked.push_back(static_cast<std::uint32_t>(i));
      }
    }
    if (!asked.empty()) {
      for (const std::uint32_t item : asked) {
        if (level_ == Level::triangle || item == asked.front()) slots_.emplace_back();
        slots_.back().push_back(item);
        add_elements(item, static_cast<std::uint32_t>(slots_.size() - 1));
      }
      push(ask);
    }

    const Step store{Verb::store, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    const Bit own = ask_ == kF ? kL : kF;
    for (std::size_t i = from; i < to; ++i) {
      if (!is_live(i) || (economy_ && has_bit(i, own))) continue;
      if (undrawable_[i]) {
        pass_.draws.push_back({kEverywhere, 0});
      } else {
        add_elements(static_cast<std::uint32_t>(i), 0);
      }
    }
    push(store);
  }

  void add_elements(std::uint32_t item, std::uint32_t slot) {
    for (std::uint32_t e = drawables_.first[item]; e < drawables_.first[item + 1]; ++e)
      pass_.draws.push_back({e, slot});
  }

  void push(Step step) {
    step.count = static_cast<std::uint32_t>(pass_.draws.size()) - step.first;
    if (step.count == 0) return;
    pass_.steps.push_back(step);
    if (step.verb == Verb::store) anything_stored_ = true;
  }

  State& state_;
  std::span<const std::uint32_t> items_;
  const Drawables& drawables_;
  Bit ask_;
  bool economy_;
  Level level_;
  std::vector<std::uint8_t> undrawable_;
  std::vector<std::vector<std::uint32_t>> slots_;
  bool anything_stored_ = false;
  Pass pass_;
};

// Asks `bit` of every live item once; counts draws and queries into `stage`.
void run_pass(State& state, std::span<const std::uint32_t> items, const Drawables& drawables,
              Bit bit, bool economy, Level level, Canvas& canvas, Stage& stage) {
  PassBuilder builder(state, items, drawables, bit, economy, level);
  const Pass pass = builder.build();
  stage.draws += pass.draws.size();
  stage.queries += pass.slots;
  if (pass.steps.empty()) return;
  builder.apply(canvas.run(pass));
}

double radius_of(const RadiusRule& rule, const Budget& budget, double step) {
  const double radius = rule.published ? published_radius(step) : rule.factor * budget.radius();
  // Beyond it floats overflow in the kernels, and a fragment would be lost instead of seen.
  if (!(radius >= 0 && radius <= kMaxRadius)) {
    throw Error("--radius", std::to_string(radius) + " px is beyond the largest ball, 2^20 px",
                "choose a smaller factor");
  }
  return radius;
}

void bury(State& state) {
  std::erase_if(state.live, [&](std::uint32_t t) { return state.bits[t] == kCulled; });
}

// What a view remembers of its last visit: how many changes the stored sets of its two passes had
// seen.
struct Visit {
  std::uint64_t stored_ascending = 0;
  std::uint64_t stored_descending = 0;
};

std::uint64_t stored_version(const State& state, Bit ask, bool economy) {
  if (!economy) return state.deaths;
  return state
      .changes[ask == kF];  // ascending stores the items without L, descending those without F
}

}  // namespace

CullResult cull(const Scene& scene, const Plan& plan, const CullSettings& settings, Canvas& canvas,
                const Progress& progress) {
  if (settings.resolution < 1 || settings.resolution > canvas.limits().max_resolution) {
    throw Error("--resolution",
                std::to_string(settings.resolution) + " is outside 1 .. " +
                    std::to_string(canvas.limits().max_resolution) + ", the limit of this device",
                "choose a resolution in that range");
  }
  CullResult result;
  State state;
  state.bits.assign(scene.triangles.size(), kCulled);
  state.live = plan.triangles;
  for (const std::uint32_t t : state.live) state.bits[t] = 0;
  state.owner = owners(scene);
  const bool fattened = settings.fattener.name != "raw";

  std::vector<std::optional<Window>> windows;
  for (const View& view : settings.views) {
    ViewReport report{.name = view.name, .budget = {}};
    windows.push_back(plan.regions.empty() ? std::nullopt
                                           : fit_window(view, plan.regions, settings.resolution));
    if (windows.back()) {
      const Window& w = *windows.back();
      report.drawn = true;
      report.width = w.width;
      report.height = w.height;
      report.pixel_size = w.pixel_size;
      report.budget = budget_for(canvas.limits(), viewport_side(std::max(w.width, w.height)));
      report.depth_step_px = depth_step(w, canvas.limits().depth_bits);
      report.radius_px =
          fattened ? radius_of(settings.radius, report.budget, report.depth_step_px) : 0;
    } else {
      result.stages.push_back({.name = "view " + view.name,
                               .reason = plan.regions.empty()
                                             ? "no two objects' boxes overlap"
                                             : "double arithmetic cannot resolve the region in "
                                               "pixels; nothing is culled here",
                               .in = state.live.size(),
                               .out = state.live.size(),
                               .unit = "triangles"});
    }
    result.views.push_back(report);
  }

  std::vector<Visit> visits(windows.size());
  std::uint64_t before_round;
  int round = 0;
  do {
    before_round = state.changes[0] + state.changes[1];
    ++round;
    for (std::size_t v = 0; v < windows.size(); ++v) {
      if (!windows[v]) continue;
      Visit& visit = visits[v];
      const auto due = [&](Bit bit) {
        return stored_version(state, bit, settings.economy) !=
               (bit == kF ? visit.stored_ascending : visit.stored_descending);
      };
      if (state.live.empty() || !(due(kF) || due(kL))) continue;
      const std::string at = settings.views[v].name + ", round " + std::to_string(round);
      if (progress) progress("culling along " + at);

      Stopwatch start;
      Stage prepare{.name = "fatten " + at,
                    .ran = true,
                    .reason = settings.fattener.name,
                    .in = state.live.size(),
                    .unit = "triangles"};
      const std::vector<std::uint32_t> items = state.live;
      FattenCounts counts;
      const Drawables drawables =
          fatten(scene, items, *windows[v], settings.fattener, result.views[v].radius_px, counts);
      canvas.begin(*windows[v], drawables);
      prepare.out = drawables.elements();
      if (counts.undrawable > 0) {
        prepare.reason +=
            "; " + std::to_string(counts.undrawable) + " triangles beyond the budget, kept";
      }
      prepare.ms = start.ms();
      result.stages.push_back(prepare);

      const auto level_stage = [&](Level level) {
        start = Stopwatch();
        Stage stage{.name = (level == Level::object ? "cull objects " : "cull triangles ") + at,
                    .ran = true,
                    .reason = "",
                    .in = state.live.size(),
                    .unit = "triangles"};
        int passes = 0;
        const auto pass = [&](Bit bit) {
          const std::uint64_t version = stored_version(state, bit, settings.economy);
          run_pass(state, items, drawables, bit, settings.economy, level, canvas, stage);
          if (level == Level::triangle)
            (bit == kF ? visit.stored_ascending : visit.stored_descending) = version;
          ++passes;
        };
        if (level == Level::object) {
          pass(kF);
          pass(kL);
        } else {
          while (due(kF) || due(kL)) {
            if (due(kF)) pass(kF);
            if (due(kL)) pass(kL);
          }
        }
        bury(state);
        stage.out = state.live.size();
        stage.reason = std::to_string(passes) + " passes";
        stage.ms = start.ms();
        result.stages.push_back(stage);
      };
      if (round == 1) level_stage(Level::object);
      level_stage(Level::triangle);
    }
  } while (state.changes[0] + state.changes[1] != before_round);

  result.live = std::move(state.live);
  return result;
}

}  // namespace farcull
